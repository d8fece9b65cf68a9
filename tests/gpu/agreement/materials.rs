//! Every material, its textures and what bends its normals: the device's paths against the reference's.

use std::sync::LazyLock;

use glam::DVec3;
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::scene::{Geometry, MaterialKind, Rectangle, Relief, Scene};
use gpt::verify::path::compare_path;

use super::lights::compare_unequal;
use super::test_grid::TestGrid;
use super::{DEVICE, assert_agrees};

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

pub fn stage(material: &str) -> Scene {
    let is_used = |name: &str| material.contains(&format!("\"{name}\""));
    let textures: String = TEXTURES.into_iter().filter(|(name, _)| is_used(name)).map(|(_, text)| text).collect();
    let text = format!("{STAGE}{}{textures}\n[[material]]\nname = \"m\"\n{material}\n", load::file::example_materials());
    load::load_toml_str(&text, "stage.toml", BUMPS.path()).unwrap_or_else(|error| panic!("{error}\n{material}"))
}

/// A folder with a picture of 8 × 8 normals, up to 35 degrees askew.
pub static BUMPS: LazyLock<tempfile::TempDir> = LazyLock::new(|| {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let texel = |x: u32, y: u32| image::Rgb([128 + (x * 37 + y * 11) as u8 % 70, 90 + (x * 23 + y * 51) as u8 % 80, 240]);
    image::RgbImage::from_fn(8, 8, texel).save(folder.path().join("bumps.png")).expect("the folder can be written");
    folder
});

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

/// On a rectangle where the others have a sphere, which has no edges.
const RELIEFS: &[(&str, &str)] = &[
    ("heights of a picture", "type = \"diffuse\"\nreflectance = 0.7\nbump_map = \"bumps\"\nbump_scale = 0.3"),
    ("heights of noise", "type = \"conductor\"\npreset = \"gold\"\nroughness = 0.4\nbump_map = \"clouds\"\nbump_scale = 0.05"),
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
];

/// The materials and textures of the stage, but for the place of its shapes.
fn tables() -> String {
    let start = STAGE.find("[[material]]").expect("there are materials");
    let end = STAGE.find("[[shape]]").expect("there are shapes");
    STAGE[start..end].to_owned() + &load::file::example_materials() + &TEXTURES.map(|(_, text)| text).concat()
}

/// A grid of materials: each on a sphere, or a rectangle where it bends normals, and on a smooth, textured tetrahedron.
pub fn grid(columns: usize, materials: &[(String, String)]) -> TestGrid {
    let tetrahedron = &STAGE[STAGE.rfind("[[shape]]").expect("there are shapes")..];
    let names = materials.iter().map(|(name, _)| name.clone()).collect();
    TestGrid::new(columns, &tables(), names, |index, [x, y]| {
        let (name, material) = &materials[index];
        let first = if RELIEFS.iter().any(|(relief, _)| relief == name) {
            format!(
                "type = \"rectangle\"\ncorner = [{}, {}, 0.1]\nedge_u = [0.45, 0.02, 0]\nedge_v = [0.02, 0.8, -0.15]\n",
                x - 0.48,
                y - 0.42
            )
        } else {
            format!(
                "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.3\ntransform = [{{ rotate = [1, 2, 0.5], degrees = 50 }}, {{ translate = [{}, {}, 0] }}]\n",
                x - 0.2,
                y + 0.15
            )
        };
        format!(
            "[[material]]\nname = \"m{index}\"\n{material}\n[[shape]]\nmaterial = \"m{index}\"\n{first}\
             {}transform = [{{ translate = [-1.2, 0, 0] }}, {{ scale = 0.24 }}, {{ translate = [{}, {}, 0.3] }}]\n",
            tetrahedron.replace("material = \"m\"", &format!("material = \"m{index}\"")),
            x + 0.2,
            y - 0.15
        )
    })
}

pub fn owned(materials: &[(&str, &str)]) -> Vec<(String, String)> {
    materials.iter().map(|(name, material)| ((*name).to_owned(), (*material).to_owned())).collect()
}

/// The index of the material of a cell.
pub fn of_cell(scene: &Scene, grid: &[(String, String)], name: &str) -> usize {
    let index = grid.iter().position(|(other, _)| other == name).expect("the grid has it");
    let name = format!("m{index}");
    scene.materials.iter().position(|material| material.name == name).expect("it is a material")
}

/// The first two are in the built-in scene `examples` as well, which `every_built_in_scene_agrees_path_by_path` compares.
#[test]
fn every_lobe_and_texture_agrees() {
    let materials = [owned(LOBES), owned(RELIEFS)].concat();
    grid(8, &materials).assert_agrees("lobes and textures", &PlanOptions::default(), |_| {});
}

#[test]
#[ignore = "long: each example of a material, each lobe and each texture alone"]
fn long_every_lobe_and_texture_agrees_alone() {
    for (name, material) in load::file::material_examples() {
        assert_agrees(name, &stage(&material), &PlanOptions::default());
    }
    for (name, material) in LOBES {
        assert_agrees(name, &stage(material), &PlanOptions::default());
    }
}

/// The controls of the grid: one of its materials is a little different.
#[test]
#[ignore = "slow"]
fn another_material_on_the_wall_is_noticed() {
    let materials = [owned(LOBES), owned(RELIEFS)].concat();
    let grid = grid(8, &materials);
    let texture = |scene: &Scene, name: &str| {
        let normal_map = scene.materials[of_cell(scene, &materials, name)].normal_map;
        normal_map.expect("normals are perturbed by it")
    };
    let heights = |scene: &mut Scene| {
        let map = texture(scene, "heights of a picture");
        let Relief::Heights(scale) = &mut scene.textures[map].relief else { panic!("it has heights") };
        *scale *= 1.2;
    };
    let shadows = |scene: &mut Scene| {
        let map = texture(scene, "shadowed normals");
        scene.textures[map].shadows_perturbed_normals = false;
    };
    let mirrors = |scene: &mut Scene| {
        let map = texture(scene, "mirrored normals");
        scene.textures[map].mirrors_perturbed_normals = false;
    };
    let coat = |scene: &mut Scene| {
        let coated = of_cell(scene, &materials, "bumpy coat");
        let MaterialKind::Principled(coat) = &mut scene.materials[coated].kind else { panic!("it is principled") };
        coat.coat_normal_map = None;
    };
    let direction = |scene: &mut Scene| {
        let brushed = of_cell(scene, &materials, "brushed by a texture");
        let MaterialKind::Principled(brushed) = &mut scene.materials[brushed].kind else { panic!("it is principled") };
        brushed.anisotropy_direction = None;
    };
    grid.assert_notices(&[
        ("heights a fifth higher", &heights),
        ("normals without shadows", &shadows),
        ("normals without mirrors", &mirrors),
        ("a coat without its map", &coat),
        ("a brush without its direction", &direction),
    ]);
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
#[ignore = "long: each map of heights or normals alone"]
fn long_maps_of_heights_and_scaled_normals_agree() {
    for (name, material) in RELIEFS {
        assert_agrees(name, &with_edges(material), &PlanOptions::default());
    }
}

/// The control: with the surface's own in place of normals that look away, the picture is another one.
#[test]
#[ignore = "long: perturbed normals, coats, brushes and heights that are noticed alone, not on a grid"]
fn long_missing_mirrors_of_perturbed_normals_are_noticed() {
    let theirs = with_edges(
        "type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\"\nnormal_scale = 4\nnormal_shadowing = true\nnormal_mirroring = true",
    );
    let mut ours = theirs.clone();
    ours.textures.iter_mut().for_each(|texture| texture.mirrors_perturbed_normals = false);
    let Some(verdict) = compare_unequal(&ours, &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: a coat without its map, and one that lies as the base below it, make another picture.
#[test]
#[ignore = "long: perturbed normals, coats, brushes and heights that are noticed alone, not on a grid"]
fn long_missing_normals_of_coats_are_noticed() {
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
#[ignore = "long: perturbed normals, coats, brushes and heights that are noticed alone, not on a grid"]
fn long_missing_directions_of_anisotropy_are_noticed() {
    let brushed = "type = \"principled\"\nroughness = 0.4\nanisotropy = 0.9\n";
    let theirs = stage(&format!("{brushed}anisotropy_direction = \"bumps\""));
    let Some(verdict) = compare_unequal(&stage(brushed), &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: without the shadow of the surface, the picture is another one.
#[test]
#[ignore = "long: perturbed normals, coats, brushes and heights that are noticed alone, not on a grid"]
fn long_missing_shadows_of_perturbed_normals_are_noticed() {
    let theirs =
        with_edges("type = \"diffuse\"\nreflectance = 0.7\nnormal_map = \"bumps\"\nnormal_scale = 1.5\nnormal_shadowing = true");
    let mut ours = theirs.clone();
    ours.textures.iter_mut().for_each(|texture| texture.shadows_perturbed_normals = false);
    let Some(verdict) = compare_unequal(&ours, &theirs) else { return };
    assert!(!verdict.agrees, "{verdict:#?}");
}

/// The control: a tenth more height is noticed.
#[test]
#[ignore = "long: perturbed normals, coats, brushes and heights that are noticed alone, not on a grid"]
fn long_other_heights_are_noticed() {
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
