//! Every material, blend weight, blend and procedural texture: the device's paths against the reference's.

use std::sync::LazyLock;

use glam::DVec3;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode, TraversalChoice};
use gpt::scene::{BlendMode, Estimator, Geometry, Rectangle, Relief, Scene};
use gpt::verify::path::compare_path;

use super::lights::compare_unequal;
use super::{DEVICE, assert_agrees, compare};

/// A sphere and a smooth, textured tetrahedron of the material `m` on a floor, under a lamp, a point light and an environment.
const STAGE: &str = r#"
[film]
size = [32, 32]
[render]
spp = 16
max_depth = 6
[camera]
position = [0, 1.6, 6]
look_at = [0, 0.4, 0]
vfov = 40
[[light]]
type = "environment"
radiance = [0.2, 0.3, 0.4]
[[light]]
type = "point"
position = [-2, 3, 2]
intensity = [6, 5, 4]
[[material]]
name = "floor"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "lamp"
type = "emissive"
radiance = [8, 7, 6]
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.8
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.7, 0.1, 0.05]
[[material]]
name = "mirror"
type = "mirror"
reflectance = 0.9
[[material]]
name = "gold"
type = "conductor"
preset = "gold"
roughness = 0.4
[[material]]
name = "glow"
type = "emissive"
radiance = [2, 1, 0.5]
[[material]]
name = "glow-both"
type = "emissive"
radiance = [0.5, 1, 2]
two_sided = true
[[material]]
name = "gone"
type = "pass"
[[shape]]
type = "plane"
point = [0, -1, 0]
normal = [0, 1, 0]
material = "floor"
[[shape]]
type = "rectangle"
corner = [-1, 3, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "lamp"
[[shape]]
type = "sphere"
center = [-1.1, 0.2, 0]
radius = 1
material = "m"
transform = [{ rotate = [1, 2, 0.5], degrees = 50 }]
[[shape]]
type = "mesh"
positions = [[0.2, -0.8, 0.8], [2.2, -0.8, 0.6], [1.2, -0.9, -1.0], [1.2, 1.3, 0.1]]
normals = [[-0.6, -0.5, 0.6], [0.6, -0.5, 0.6], [0, -0.5, -0.8], [0, 1, 0]]
uvs = [[0, 0], [1, 0], [0.5, 1], [0.4, 0.6]]
faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3], [0, 2, 1]]
material = "m"
"#;

/// By name. A scene gets those it uses: each adds to what the device has to compile.
const TEXTURES: [(&str, &str); 5] = [
    ("checks", "[[texture]]\nname = \"checks\"\ntype = \"checker\"\na = [0.9, 0.2, 0.1]\nb = [0.1, 0.3, 0.8]\nscale = [6, 4]\n"),
    ("clouds", "[[texture]]\nname = \"clouds\"\ntype = \"perlin\"\nscale = 5\noctaves = 4\na = 0\nb = 1\nseed = 3\n"),
    ("cells", "[[texture]]\nname = \"cells\"\ntype = \"worley\"\nscale = 7\na = [1, 0.9, 0.2]\nb = [0, 0.1, 0.4]\nseed = 5\n"),
    ("bumps", "[[texture]]\nname = \"bumps\"\ntype = \"image\"\nfile = \"bumps.png\"\ncolor_space = \"linear\"\n"),
    (
        "facets",
        "[[texture]]\nname = \"facets\"\ntype = \"image\"\nfile = \"bumps.png\"\ncolor_space = \"linear\"\nfilter = \"triangle\"\n",
    ),
];

fn stage(material: &str) -> Scene {
    let is_used = |name: &str| material.contains(&format!("\"{name}\""));
    let textures: String = TEXTURES.into_iter().filter(|(name, _)| is_used(name)).map(|(_, text)| text).collect();
    let text = format!("{STAGE}{textures}\n[[material]]\nname = \"m\"\n{material}\n");
    load::load_toml_str(&text, "stage.toml", BUMPS.path()).unwrap_or_else(|error| panic!("{error}\n{material}"))
}

/// A folder with a picture of 8 × 8 normals, up to 35 degrees askew.
pub static BUMPS: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texel = |x: u32, y: u32| image::Rgb([128 + (x * 37 + y * 11) as u8 % 70, 90 + (x * 23 + y * 51) as u8 % 80, 240]);
    image::RgbImage::from_fn(8, 8, texel).save(folder.path().join("bumps.png")).expect("the folder can be written");
    folder
});

fn blend(first: &str, second: &str, weight: &str) -> String {
    format!("type = \"blend\"\nmaterials = [\"{first}\", \"{second}\"]\nweight = {weight}")
}

/// Besides the examples of every type of material.
const LOBES: &[(&str, &str)] = &[
    ("smooth rough glass", "type = \"rough_glass\"\nroughness = 0"),
    ("textured mirror", "type = \"mirror\"\nreflectance = { texture = \"checks\" }"),
    ("textured glass", "type = \"glass\"\ntransmittance = { texture = \"cells\" }"),
    ("textured width", "type = \"conductor\"\npreset = \"gold\"\nalpha = { texture = \"clouds\" }"),
    ("textured roughness", "type = \"rough_glass\"\nroughness = { texture = \"clouds\" }"),
    (
        "textured widths",
        "type = \"conductor\"\npreset = \"gold\"\nroughness_u = { texture = \"clouds\" }\nroughness_v = { texture = \"cells\" }",
    ),
    ("brushed and bumpy", "type = \"conductor\"\npreset = \"gold\"\nalpha_u = 0.1\nalpha_v = 0.5\nnormal_map = \"bumps\""),
    ("textured factor", "type = \"conductor\"\npreset = \"gold\"\nspecular_reflectance = { texture = \"cells\" }"),
    (
        "textured plastic",
        "type = \"plastic\"\nreflectance = { texture = \"checks\" }\nalpha = 0.3\nspecular_reflectance = { texture = \"clouds\" }",
    ),
    ("black from behind", "type = \"glass\"\ntwo_sided = false"),
    (
        "textured principled",
        "type = \"principled\"\nbase_color = { texture = \"checks\" }\nmetallic = { texture = \"clouds\" }\nroughness = { texture = \"cells\" }",
    ),
    (
        "textured sheen",
        "type = \"principled\"\nmetallic = 0\nroughness = 0.5\nsheen_color = { texture = \"checks\" }\nsheen_roughness = { texture = \"clouds\" }",
    ),
    ("textured and compensated", "type = \"principled\"\nroughness = { texture = \"clouds\" }\nenergy_compensation = true"),
    (
        "brushed by a texture",
        "type = \"principled\"\nroughness = 0.4\nanisotropy = { texture = \"bumps\", channel = \"b\", factor = 0.8 }\nanisotropy_direction = \"bumps\"\nanisotropy_rotation = 40",
    ),
    (
        "brushed, coated and bumpy",
        "type = \"principled\"\nroughness = 0.3\nanisotropy = 0.9\nanisotropy_direction = \"bumps\"\nnormal_map = \"bumps\"\nclearcoat = 0.6\nclearcoat_roughness = 0.2\ncoat_normal_map = \"bumps\"",
    ),
    (
        "coat over bumps",
        "type = \"principled\"\nbase_color = [0.8, 0.3, 0.2]\nmetallic = 0.5\nroughness = 0.5\nnormal_map = \"bumps\"\nclearcoat = 1\nclearcoat_roughness = 0.3",
    ),
    (
        "bumpy coat",
        "type = \"principled\"\nmetallic = 0.5\nroughness = 0.4\nclearcoat = { texture = \"clouds\" }\nclearcoat_roughness = 0.4\ncoat_normal_map = \"bumps\"\ncoat_normal_scale = 0.7",
    ),
    (
        "bumpy smooth coat over bumps",
        "type = \"principled\"\nmetallic = 0\nroughness = 0.6\ntransmission = 0.5\nnormal_map = \"bumps\"\nclearcoat = 1\ncoat_normal_map = \"bumps\"\ncoat_normal_scale = -1.5\nopacity = 0.8",
    ),
    ("normal map", "type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\""),
    ("normal map of a mirror", "type = \"mirror\"\nnormal_map = \"bumps\""),
    ("textured exponent", "type = \"glossy\"\nreflectance = 0.8\nexponent = { texture = \"cells\" }"),
    ("checker", "type = \"diffuse\"\nreflectance = { texture = \"checks\" }"),
    ("perlin", "type = \"diffuse\"\nreflectance = { texture = \"clouds\" }"),
    ("worley", "type = \"diffuse\"\nreflectance = { texture = \"cells\" }"),
];

const BLEND_WEIGHTS: &[(&str, &str)] = &[
    ("constant", "{ type = \"constant\", value = 0.3 }"),
    ("facing", "{ type = \"facing\", power = 0.4 }"),
    ("schlick", "{ type = \"fresnel\", ior = 1.6 }"),
    ("exact fresnel", "{ type = \"fresnel\", ior = 1.6, exact = true }"),
    ("texture", "{ type = \"texture\", texture = \"clouds\" }"),
    ("reverse", "{ type = \"reverse\", of = { type = \"facing\", power = 2 } }"),
    ("threshold", "{ type = \"threshold\", tau = 0.6, of = { type = \"facing\" } }"),
    (
        "threshold of reverse, reversed",
        "{ type = \"reverse\", of = { type = \"threshold\", tau = 0.4, of = { type = \"reverse\", of = { type = \"facing\" } } } }",
    ),
    (
        "threshold of threshold",
        "{ type = \"threshold\", tau = 0.5, of = { type = \"reverse\", of = { type = \"threshold\", tau = 0.6, of = { type = \"facing\" } } } }",
    ),
];

#[test]
fn every_lobe_and_texture_agrees() {
    for (name, material) in load::file::material_examples() {
        assert_agrees(name, &stage(&material), &PlanOptions::default());
    }
    for (name, material) in LOBES {
        assert_agrees(name, &stage(material), &PlanOptions::default());
    }
}

#[test]
fn every_blend_weight_agrees_for_both_ways_to_blend() {
    for (name, weight) in BLEND_WEIGHTS {
        for mode in [BlendMode::Mixture, BlendMode::Pick] {
            let mut scene = stage(&blend("red", "mirror", weight));
            scene.render.blend = mode;
            assert_agrees(&format!("{name}, {mode:?}"), &scene, &PlanOptions::default());
        }
    }
}

/// Pairs of every kind, nested blends, emission inside and beside blends, and what lets rays pass.
#[test]
fn every_kind_of_blend_agrees_in_every_way_to_run() {
    let inner = |name: &str, body: &str| format!("\n[[material]]\nname = \"{name}\"\n{body}\n");
    let half = "{ type = \"constant\", value = 0.5 }";
    let facing = "{ type = \"facing\", power = 0.7 }";
    let nested = blend("b", "c", facing)
        + &inner("b", &blend("white", "gold", "{ type = \"texture\", texture = \"cells\" }"))
        + &inner("c", &(blend("mirror", "d", half) + "\nemission = [0.3, 0.1, 0.2]"))
        + &inner("d", &blend("red", "glow", "{ type = \"threshold\", tau = 0.5, of = { type = \"facing\" } }"));
    let glass = "type = \"rough_glass\"\nroughness = 0.5";
    let scenes = [
        ("smooth and smooth", blend("red", "gold", facing)),
        ("smooth and delta", blend("gold", "mirror", half)),
        ("transmission", blend("red", "g", facing) + &inner("g", glass)),
        ("nested", nested),
        ("emission", blend("glow", "white", facing)),
        ("emission from both sides", blend("glow-both", "mirror", "{ type = \"texture\", texture = \"checks\" }")),
        ("textured emission", "type = \"emissive\"\nradiance = { texture = \"cells\" }".to_owned()),
        ("emission beside", blend("red", "white", half) + "\nemission = { texture = \"cells\" }\nemission_two_sided = true"),
        (
            "black from behind",
            blend("front", "mirror", half)
                + &inner("front", "type = \"plastic\"\nreflectance = [0.7, 0.3, 0.1]\ntwo_sided = false"),
        ),
        ("black from behind as a whole", blend("red", "gold", facing) + "\ntwo_sided = false"),
        (
            "plastic and principled",
            blend("p", "q", facing)
                + &inner("p", "type = \"plastic\"\nreflectance = 0.6")
                + &inner("q", "type = \"principled\"\nroughness = 0.5\nmetallic = 0.5"),
        ),
        ("volume in a blend", blend("red", "v", facing) + &inner("v", AMBER)),
        ("volume with holes", blend("v", "gone", half) + &inner("v", AMBER)),
        ("pass", blend("red", "gone", half)),
        (
            "pass through a mask",
            blend("gone", "gold", "{ type = \"threshold\", tau = 0.5, of = { type = \"texture\", texture = \"clouds\" } }"),
        ),
    ];
    let ways = [
        PlanOptions::default(),
        PlanOptions { traversal: TraversalChoice::Bvh, stages: Some(StageMode::Wavefront), ..PlanOptions::default() },
    ];
    for (index, (name, material)) in scenes.iter().enumerate() {
        for (mode, way) in [(BlendMode::Mixture, &ways[index % 2]), (BlendMode::Pick, &ways[(index + 1) % 2])] {
            let mut scene = stage(material);
            scene.render.blend = mode;
            scene.render.estimator = [Estimator::Mis, Estimator::Nee, Estimator::Bsdf][index % 3];
            assert_agrees(&format!("{name}, {mode:?}"), &scene, way);
        }
    }
}

const AMBER: &str = "type = \"principled\"\nmetallic = 0\nroughness = 0.5\ntransmission = 1\nattenuation_color = [0.9, 0.5, 0.1]\nattenuation_distance = 0.6";

/// Light and what it shines on, both within a volume.
#[test]
fn a_light_within_a_volume_agrees() {
    let within = |material: &str| {
        stage(&format!(
            "{material}\n[[shape]]\ntype = \"box\"\nmin = [-1.8, -0.9, 0.8]\nmax = [1.8, 0.5, 1.9]\nmaterial = \"m\"\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [-0.9, -0.2, 1.3]\nradius = 0.3\nmaterial = \"glow\"\n\
             [[shape]]\ntype = \"sphere\"\ncenter = [0.8, -0.3, 1.3]\nradius = 0.4\nmaterial = \"white\""
        ))
    };
    let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
    for (name, options) in [("amber", &PlanOptions::default()), ("amber, wavefront", &wavefront)] {
        assert_agrees(name, &within(AMBER), options);
    }
    // A volume a hundredth thicker is noticed.
    let (scene, off) = (within(AMBER), within(&AMBER.replace("distance = 0.6", "distance = 0.594")));
    let Some(device) = DEVICE.as_ref() else { return };
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &off, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = gpt::reference::ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// Passing through a surface is no edge: what lies behind is seen even by paths of one edge.
#[test]
fn passing_does_not_use_up_the_depth() {
    for depth in [1, 2] {
        let mut scene = stage(&blend("red", "gone", "{ type = \"constant\", value = 0.5 }"));
        scene.render.max_depth = depth;
        assert_agrees(&format!("depth {depth}"), &scene, &PlanOptions::default());
        let wavefront = PlanOptions { stages: Some(StageMode::Wavefront), ..PlanOptions::default() };
        assert_agrees(&format!("depth {depth}, wavefront"), &scene, &wavefront);
    }
}

/// The comparison notices a weight that is off by 1 %.
#[test]
fn a_weight_off_by_a_hundredth_is_noticed() {
    let scene = stage(&blend("white", "mirror", "{ type = \"constant\", value = 0.5 }"));
    let off = stage(&blend("white", "mirror", "{ type = \"constant\", value = 0.51 }"));
    let Some(device) = DEVICE.as_ref() else { return };
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &off, &PlanOptions::default()).expect("the scene fits");
    let mut cpu = gpt::reference::ReferenceRenderer::new(&scene).expect("the scene is supported");
    let verdict = gpt::verify::compare(&scene, &mut gpu, &mut cpu, None).expect("both render");
    assert!(!verdict.agrees, "{verdict:#?}");
    assert!(compare(&scene, &PlanOptions::default()).is_some_and(|verdict| verdict.agrees));
}

/// Bumps where the other tests have a sphere, which has no edges: a rectangle.
fn with_edges(material: &str) -> Scene {
    let mut scene = stage(material);
    let bumpy = scene.shapes.iter_mut().filter(|shape| matches!(shape.geometry, Geometry::Sphere(_)));
    for shape in bumpy {
        let (corner, edge_u, edge_v) = (DVec3::new(-2.1, -0.8, 0.3), DVec3::new(1.8, 0.1, 0.0), DVec3::new(0.1, 2.0, -0.6));
        shape.geometry = Geometry::Rectangle(Rectangle { corner, edge_u, edge_v });
    }
    scene
}

#[test]
fn maps_of_heights_and_scaled_normals_agree() {
    for (name, material) in [
        ("heights of a picture", "type = \"diffuse\"\nreflectance = 0.7\nbump_map = \"bumps\"\nbump_scale = 0.3"),
        (
            "heights of noise",
            "type = \"conductor\"\npreset = \"gold\"\nroughness = 0.4\nbump_map = \"clouds\"\nbump_scale = 0.05",
        ),
        ("heights of cells", "type = \"diffuse\"\nreflectance = 0.7\nbump_map = \"cells\"\nbump_scale = 0.1"),
        ("heights of triangles", "type = \"diffuse\"\nreflectance = 0.7\nbump_map = \"facets\"\nbump_scale = 0.3"),
        (
            "shadowed normals",
            "type = \"conductor\"\npreset = \"gold\"\nroughness = 0.5\nnormal_map = \"bumps\"\nnormal_scale = 1.5\nnormal_shadowing = true",
        ),
        (
            "mirrored normals",
            "type = \"conductor\"\npreset = \"gold\"\nroughness = 0.5\nnormal_map = \"bumps\"\nnormal_scale = 4\nnormal_shadowing = true\nnormal_mirroring = true",
        ),
        ("strong normals", "type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\"\nnormal_scale = 2.5"),
    ] {
        assert_agrees(name, &with_edges(material), &PlanOptions::default());
    }
}

/// The control: with the surface's own in place of normals that look away, the picture is another one.
#[test]
fn missing_mirrors_of_bent_normals_are_noticed() {
    let theirs = with_edges(
        "type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\"\nnormal_scale = 4\nnormal_shadowing = true\nnormal_mirroring = true",
    );
    let mut ours = theirs.clone();
    ours.textures.iter_mut().for_each(|texture| texture.mirrors_bent_normals = false);
    let Some(verdict) = compare_unequal(&ours, &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: a coat without its map, and one that lies as the base below it, make another picture.
#[test]
fn missing_normals_of_coats_are_noticed() {
    let coated =
        "type = \"principled\"\nbase_color = 0.1\nmetallic = 0\nroughness = 0.5\nclearcoat = 1\nclearcoat_roughness = 0.3\n";
    let theirs = stage(&format!("{coated}coat_normal_map = \"bumps\""));
    let Some(verdict) = compare_unequal(&stage(coated), &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
    let over_bumps = format!("{coated}normal_map = \"bumps\"\n");
    let as_the_base = stage(&format!("{over_bumps}coat_normal_map = \"bumps\""));
    let Some(verdict) = compare_unequal(&as_the_base, &stage(&over_bumps)) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: with the direction of u in place of a texture's, the picture is another one.
#[test]
fn missing_directions_of_anisotropy_are_noticed() {
    let brushed = "type = \"principled\"\nroughness = 0.4\nanisotropy = 0.9\n";
    let theirs = stage(&format!("{brushed}anisotropy_direction = \"bumps\""));
    let Some(verdict) = compare_unequal(&stage(brushed), &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: without the shadow of the surface, the picture is another one.
#[test]
fn missing_shadows_of_bent_normals_are_noticed() {
    let theirs =
        with_edges("type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\"\nnormal_scale = 1.5\nnormal_shadowing = true");
    let mut ours = theirs.clone();
    ours.textures.iter_mut().for_each(|texture| texture.shadows_bent_normals = false);
    let Some(verdict) = compare_unequal(&ours, &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: a tenth more height is noticed.
#[test]
fn other_heights_are_noticed() {
    let theirs = with_edges("type = \"diffuse\"\nreflectance = 0.7\nbump_map = \"bumps\"\nbump_scale = 0.3");
    let mut ours = theirs.clone();
    for texture in &mut ours.textures {
        if let Relief::Heights(scale) = &mut texture.relief {
            *scale *= 1.1;
        }
    }
    let Some(verdict) = compare_unequal(&ours, &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// Across the view, the slopes of Beckmann's facets have no end. This path's is so steep that its number was not finite on lavapipe.
#[test]
fn the_steepest_of_beckmanns_facets_is_finite() {
    let Some(device) = DEVICE.as_ref() else { return };
    let text = "[film]\nsize = [64, 48]\n[render]\nseed = 11\nspp = 256\nmax_depth = 2\n\
                [camera]\nposition = [0, 1, 5]\nlook_at = [0, 1, 0]\nvfov = 32\n\
                [[material]]\nname = \"m\"\ntype = \"conductor\"\npreset = \"gold\"\nalpha = 0.3\ndistribution = \"beckmann\"\n\
                [[shape]]\ntype = \"sphere\"\ncenter = [0, 1, 0]\nradius = 1\nmaterial = \"m\"\n\
                [[light]]\ntype = \"environment\"\nradiance = 1\n";
    let scene = load::load_toml_str(text, "steepest.toml", std::path::Path::new("")).expect("the scene is valid");
    let path = compare_path(device, &scene, [31, 17], 137, &PlanOptions::default()).expect("both follow it");
    assert!(path.rows.len() > 3 && path.rows.iter().all(|row| !row.parts), "{path}");
}
