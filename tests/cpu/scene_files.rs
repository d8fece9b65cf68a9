//! Scene files that are right, and what becomes of them.

use std::path::Path;

use crate::common::files::{TRIANGLE, folder_with, png_bytes};
use glam::{DVec3, Vec3};
use gpt::load;
use gpt::scene::{
    self, BlendWeight, ColorInput, Disk, Geometry, Material, MaterialKind, Mesh, MisHeuristic, Plane, Projection, Rectangle,
    SamplerKind, Scene, TextureKind, TextureWrap,
};
use gpt::spectrum::Spectrum;
use proptest::prelude::*;

const CAMERA_AND_LIGHT: &str = r#"
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
vfov = 40
[[light]]
type = "environment"
radiance = 1
"#;

fn read_in(folder: &Path, rest: &str) -> Scene {
    let text = format!("{rest}\n{CAMERA_AND_LIGHT}");
    load::load_toml_str(&text, "folder/test.toml", folder).unwrap_or_else(|error| panic!("{error}"))
}

fn read(rest: &str) -> Scene {
    read_in(Path::new(""), rest)
}

fn model(folder: &Path) -> Scene {
    load::load(folder.join("model.obj").to_str()).unwrap_or_else(|error| panic!("{error}"))
}

fn mesh(scene: &Scene) -> &Mesh {
    match &scene.shapes[0].geometry {
        Geometry::Mesh(mesh) => mesh,
        other => panic!("not a mesh: {other:?}"),
    }
}

fn material<'a>(scene: &'a Scene, name: &str) -> &'a Material {
    scene.materials.iter().find(|material| material.name == name).unwrap_or_else(|| panic!("no material {name}"))
}

#[test]
fn every_built_in_scene_loads_without_warnings() {
    for name in load::builtin_names() {
        let scene = load::load(Some(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(scene.name, name);
        assert_eq!(scene.warnings, Vec::<String>::new());
        assert!(!scene.shapes.is_empty());
    }
    assert_eq!(load::load(None).unwrap_or_else(|error| panic!("{error}")).name, "cornell");
}

#[test]
fn settings_have_the_documented_defaults_and_can_be_written() {
    let scene = read("");
    assert_eq!(scene.name, "test");
    assert_eq!((scene.film.size, scene.render.spp, scene.render.max_depth), ([512, 512], 256, 16));
    assert_eq!((scene.render.sampler, scene.render.first_roulette(false)), (SamplerKind::Sobol, Some(5)));
    let scene =
        read("[film]\nsize = [8, 6]\n[render]\nspp = 7\nmax_depth = 3\nsampler = \"independent\"\nheuristic = \"balance\"");
    assert_eq!((scene.film.size, scene.render.spp, scene.render.max_depth), ([8, 6], 7, 3));
    assert_eq!((scene.render.sampler, scene.render.heuristic), (SamplerKind::Independent, MisHeuristic::Balance));
    assert_eq!(scene.camera.projection, Projection::Perspective { vertical_fov_degrees: 40.0 });
    assert_eq!(scene.camera.up, DVec3::Y);
}

#[test]
fn every_shape_and_supported_material_is_read() {
    let scene = read(
        r#"
        material = [
            { name = "a", type = "diffuse", reflectance = [0.1, 0.2, 0.3], emission = 2, emission_two_sided = true },
            { name = "b", type = "mirror" },
            { name = "c", type = "glass", ior = 1.33 },
            { name = "d", type = "emissive", radiance = [1, 2, 3] },
            { name = "e", type = "pass" },
        ]
        shape = [
            { type = "sphere", center = [0, 0, 0], radius = 2, material = "a" },
            { type = "rectangle", corner = [0, 0, 0], edge_u = [1, 0, 0], edge_v = [0, 1, 0], material = "b" },
            { type = "disk", center = [0, 0, 0], normal = [0, 0, 2], radius = 1, material = "c" },
            { type = "box", min = [0, 0, 0], max = [1, 1, 0], material = "d" },
            { type = "plane", point = [0, -1, 0], normal = [0, 3, 0], material = "e" },
            { type = "mesh", positions = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], faces = [[0, 1, 2]], material = "a" },
        ]
        "#,
    );
    assert_eq!(scene.shapes.len(), 6);
    let emission = material(&scene, "a").emission.unwrap_or_else(|| panic!("a emits"));
    assert!(emission.two_sided && emission.radiance == ColorInput::grey(2.0));
    assert!(matches!(material(&scene, "b").kind, MaterialKind::Mirror { reflectance } if reflectance == ColorInput::grey(1.0)));
    assert!(matches!(material(&scene, "c").kind, MaterialKind::Glass { ior, .. } if ior == 1.33));
    let emission = material(&scene, "d").emission.unwrap_or_else(|| panic!("d emits"));
    assert!(!emission.two_sided && emission.radiance == ColorInput::Constant(Spectrum::new(1.0, 2.0, 3.0)));
    assert!(matches!(scene.shapes[2].geometry, Geometry::Disk(Disk { normal, .. }) if normal == DVec3::Z));
    assert!(matches!(scene.shapes[4].geometry, Geometry::Plane(Plane { normal, .. }) if normal == DVec3::Y));
}

const SQUARE: &str = r#"
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "mesh"
positions = [[1, 0, 0], [2, 0, 0], [2, 1, 0], [1, 1, 0]]
faces = [[0, 1, 2], [0, 2, 3]]
material = "grey"
"#;

#[test]
fn transform_steps_are_applied_in_their_order() {
    let steps = "transform = [{ scale = 2 }, { rotate = [0, 0, 1], degrees = 90 }, { translate = [0, 0, 5] }]";
    let scene = read(&format!("{SQUARE}{steps}"));
    // (1, 0, 0) → (2, 0, 0) → (0, 2, 0) → (0, 2, 5).
    assert!(scene.shapes[0].world_positions()[0].abs_diff_eq(Vec3::new(0.0, 2.0, 5.0), 1e-6));
    let matrix = "transform = { matrix = [0, -2, 0, 0, 2, 0, 0, 0, 0, 0, 2, 5, 0, 0, 0, 1] }";
    let same = read(&format!("{SQUARE}{matrix}"));
    for (a, b) in scene.shapes[0].world_positions().into_iter().zip(same.shapes[0].world_positions()) {
        assert!(a.abs_diff_eq(b, 1e-6));
    }
}

#[test]
fn a_mirrored_mesh_keeps_its_front() {
    let front = |scene: &Scene| {
        let shape = &scene.shapes[0];
        let (positions, [a, b, c]) = (shape.world_positions(), shape.world_faces()[0].map(|index| index as usize));
        (positions[b] - positions[a]).cross(positions[c] - positions[a]).normalize()
    };
    assert_eq!(front(&read(SQUARE)), Vec3::Z);
    // Mirrored in x, what faced +z still does; mirrored in z, it faces -z.
    assert_eq!(front(&read(&format!("{SQUARE}transform = [{{ scale = [-1, 1, 1] }}]"))), Vec3::Z);
    assert_eq!(front(&read(&format!("{SQUARE}transform = [{{ scale = [1, 1, -1] }}]"))), Vec3::NEG_Z);
}

#[test]
fn normals_follow_the_file_and_the_wish() {
    let with_normals = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0.6 0.8\nf 1//1 2//1 3//1\n";
    let folder = folder_with(&[("plain.obj", TRIANGLE.as_bytes()), ("normals.obj", with_normals.as_bytes())]);
    let smooth = |file: &str, wish: &str| {
        let shape = format!("[[shape]]\ntype = \"mesh\"\nfile = \"{file}.obj\"\n{wish}");
        let scene = read_in(folder.path(), &shape);
        (mesh(&scene).smooth, mesh(&scene).normals.first().copied())
    };
    assert_eq!(smooth("plain", ""), (false, None));
    assert_eq!(smooth("plain", "smooth = true"), (true, Some(Vec3::Z)));
    assert_eq!(smooth("normals", ""), (true, Some(Vec3::new(0.0, 0.6, 0.8))));
    assert_eq!(smooth("normals", "smooth = false"), (false, None));
}

#[test]
fn polygons_relative_indices_and_degenerate_triangles_are_read() {
    let text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -1 0.5 0\nf -5 -4 -3 -2 -1\nf 1 1 2\nl 1 2 3\n";
    let folder = folder_with(&[("model.obj", text.as_bytes())]);
    let scene = model(folder.path());
    assert_eq!(mesh(&scene).faces.len(), 3);
    let told = |what: &str| scene.warnings.iter().any(|warning| warning.ends_with(what));
    assert!(told("model.obj: 1 triangles without area were left out"), "{:?}", scene.warnings);
}

const LIBRARY: &str = "
newmtl wall
Kd 0.5 0.4 0.3
newmtl lamp
Kd 0 0 0
Ke 3 2 1
newmtl glass
illum 7
Ni 1.5
newmtl water
d 0.3
Ni 1.33
newmtl mirror
illum 3
Ks 0.9 0.8 0.7
newmtl nothing
d 0
newmtl gloss
Kd 0.2 0.2 0.2
Ks 0.5 0.5 0.5
Ns 30
illum 2
newmtl bright
Kd 0.8 0.4 0.1
Ks 0.5 0.5 0.5
Ns 10
newmtl veil
Kd 0.5 0.5 0.5
d 0.25
newmtl wood
map_Kd -s 2 3 -clamp on wood.png
Kd 0.5 0.5 0.5
";

#[test]
fn material_libraries_become_materials() {
    let names = ["wall", "lamp", "glass", "water", "mirror", "nothing", "gloss", "bright", "veil", "wood", "absent"];
    let faces: String = names.iter().map(|name| format!("usemtl {name}\nf 1/1 2/2 3/3\n")).collect();
    let text = format!("mtllib a.mtl b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n{faces}");
    let png = png_bytes([128, 0, 255]);
    let folder = folder_with(&[("model.obj", text.as_bytes()), ("a.mtl", LIBRARY.as_bytes()), ("wood.png", &png)]);
    let scene = model(folder.path());
    let kind = |name| &material(&scene, name).kind;
    assert!(
        matches!(kind("wall"), MaterialKind::Diffuse { reflectance: ColorInput::Constant(c) } if *c == Spectrum::new(0.5, 0.4, 0.3))
    );
    let emission = material(&scene, "lamp").emission.map(|emission| (emission.radiance, emission.two_sided));
    assert_eq!(emission, Some((ColorInput::Constant(Spectrum::new(3.0, 2.0, 1.0)), false)));
    assert!(matches!(kind("glass"), MaterialKind::Glass { ior, .. } if *ior == 1.5));
    assert!(matches!(kind("water"), MaterialKind::Glass { ior, .. } if (ior - 1.33).abs() < 1e-6));
    assert!(
        matches!(kind("mirror"), MaterialKind::Mirror { reflectance } if *reflectance == ColorInput::Constant(Spectrum::new(0.9, 0.8, 0.7)))
    );
    assert!(matches!(kind("nothing"), MaterialKind::Pass));
    let grey = |value| ColorInput::Constant(Spectrum::grey(value));
    assert!(matches!(kind("gloss"), MaterialKind::Phong { diffuse, specular, exponent }
        if (*diffuse, *specular, *exponent) == (grey(0.2), grey(0.5), grey(30.0))));
    // Kd + Ks would be 1.3: Ks gives way.
    assert!(
        matches!(kind("bright"), MaterialKind::Phong { diffuse: ColorInput::Constant(diffuse), specular: ColorInput::Constant(specular), .. }
        if diffuse.distance(Spectrum::new(0.8, 0.4, 0.1)) < 1e-9 && specular.distance(Spectrum::grey(0.2)) < 1e-9)
    );
    assert!(matches!(kind("veil"), MaterialKind::Diffuse { .. }));
    let MaterialKind::Blend { materials: [veil, behind], weight: BlendWeight::Constant { value: 0.25 } } =
        *kind("veil (d = 0.25)")
    else {
        panic!("the veil is no blend")
    };
    assert_eq!(scene.materials[veil].name, "veil");
    assert!(matches!(scene.materials[behind].kind, MaterialKind::Pass));
    let MaterialKind::Diffuse { reflectance: ColorInput::ScaledTexture(texture, tint) } = *kind("wood") else {
        panic!("wood has no tinted texture");
    };
    assert_eq!(tint, Spectrum::grey(0.5));
    let TextureKind::Image(image) = &scene.textures[texture].kind else { panic!("not an image") };
    assert_eq!((image.scale, image.wrap), ([2.0, 3.0], [TextureWrap::Clamp; 2]));
    // 128/255 decoded from sRGB.
    assert!(image.image.texels.color(0).abs_diff_eq(Vec3::new(0.215_860_5, 0.0, 1.0), 1e-6));
    let face_materials: Vec<&str> = mesh(&scene).face_materials.iter().map(|&id| scene.materials[id].name.as_str()).collect();
    assert_eq!(face_materials[..8], names[..8]);
    assert_eq!(face_materials[8..], ["veil (d = 0.25)", "wood", "absent (missing)"]);
    let warnings = scene.warnings.join("\n");
    assert!(
        warnings.contains("Kd + Ks of the material `bright` is above 1, which makes energy: Ks is multiplied by 0.400"),
        "{warnings}"
    );
    assert!(warnings.contains("b.mtl cannot be read"), "{warnings}");
    assert!(warnings.contains("no material library has absent; their faces are magenta"), "{warnings}");
}

#[test]
fn a_material_of_the_scene_wins_over_the_model() {
    let text = format!("mtllib absent.mtl\nusemtl a\n{TRIANGLE}");
    let folder = folder_with(&[("model.obj", text.as_bytes())]);
    let shape =
        "[[material]]\nname = \"m\"\ntype = \"mirror\"\n[[shape]]\ntype = \"mesh\"\nfile = \"model.obj\"\nmaterial = \"m\"";
    let scene = read_in(folder.path(), shape);
    assert_eq!(scene.materials.len(), 1);
    assert!(mesh(&scene).face_materials.is_empty() && scene.warnings.is_empty());
}

#[test]
fn colour_spaces_follow_the_format_and_the_wish() {
    let exr = |path: &Path| {
        exr::prelude::write_rgb_file(path, 2, 1, |_, _| (0.5_f32, 4.0_f32, 0.0_f32)).unwrap_or_else(|error| panic!("{error}"));
    };
    let folder = folder_with(&[("a.png", &png_bytes([128, 0, 255]))]);
    exr(&folder.path().join("a.exr"));
    let first = |file: &str, space| load::read_image(&folder.path().join(file), space).map(|image| image.texels.color(0));
    assert_eq!(first("a.exr", None), Ok(Vec3::new(0.5, 4.0, 0.0)));
    let linear = first("a.png", Some(scene::ColorSpace::Linear));
    assert!(linear.is_ok_and(|texel| texel.abs_diff_eq(Vec3::new(128.0 / 255.0, 0.0, 1.0), 1e-6)));
    assert!(first("a.png", None).is_ok_and(|texel| texel.abs_diff_eq(Vec3::new(0.215_860_5, 0.0, 1.0), 1e-6)));
}

#[test]
fn a_model_alone_is_framed() {
    let text = TRIANGLE.replace("v 0 1 0", "v 0 100 0");
    let folder = folder_with(&[("model.obj", text.as_bytes())]);
    let scene = model(folder.path());
    assert_eq!(scene.name, "model");
    assert!(scene.has_light());
    // Every vertex is in the picture: within half the field of view of the axis, square picture.
    let [right, up, backward] = scene.camera.frame();
    for point in scene.shapes[0].world_positions() {
        let ray = point.as_dvec3() - scene.camera.position;
        let limit = -ray.dot(backward) * 15.0_f64.to_radians().tan();
        assert!(ray.dot(right).abs() < limit && ray.dot(up).abs() < limit);
    }
    // The light faces the model, the ground faces up and touches it.
    let Geometry::Plane(Plane { point, normal }) = scene.shapes[1].geometry else { panic!("the ground is a plane") };
    assert!(normal == DVec3::Y && point.y == 0.0);
    let Geometry::Rectangle(Rectangle { corner, edge_u, edge_v }) = scene.shapes[2].geometry else {
        panic!("the light is a rectangle")
    };
    let light = (corner + 0.5 * (edge_u + edge_v), edge_u.cross(edge_v).normalize());
    assert!(light.1.dot((DVec3::new(0.5, 50.0, 0.0) - light.0).normalize()) > 0.999);
}

/// A text of a built-in scene with some bytes cut out, doubled or replaced.
fn mutated() -> impl Strategy<Value = String> {
    let scene = prop::sample::select(load::builtin_names().collect::<Vec<_>>());
    let pieces =
        prop::sample::select(vec!["-1", "nan", "inf", "1e308", "0", "[", "]", "{", "\"", "=", ".", "type", "\n", "9e99", ""]);
    let edits = prop::collection::vec((any::<prop::sample::Index>(), 0_usize..12, pieces), 1..6);
    (scene, edits).prop_map(|(name, edits)| {
        let mut text = load::builtin_text(name).unwrap_or_default().to_owned();
        for (place, length, piece) in edits {
            let starts: Vec<usize> = text.char_indices().map(|(at, _)| at).collect();
            let start = place.index(starts.len());
            let end = starts.get(start + length).copied().unwrap_or(text.len());
            text.replace_range(starts[start]..end, piece);
        }
        text
    })
}

/// The folder of the models that some built-in scenes name.
fn scenes_folder() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes")
}

/// The scenes that the test below damages load undamaged: otherwise every damaged scene would be refused for
/// another reason.
#[test]
fn scenes_that_are_not_mutated_load() {
    for name in load::builtin_names() {
        let text = load::builtin_text(name).expect("it is built in");
        assert!(load::load_toml_str(text, "mutated.toml", &scenes_folder()).is_ok(), "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn mutated_scenes_load_or_complain_with_their_name(text in mutated()) {
        if let Err(error) = load::load_toml_str(&text, "mutated.toml", &scenes_folder()) {
            prop_assert!(error.to_string().starts_with("mutated.toml"));
            prop_assert!(!error.message().is_empty());
        }
    }
}
