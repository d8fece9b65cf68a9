//! Models with an odd statement: it is mended and told with its place and how often there is such a thing, and `--strict` refuses it.

use super::*;

/// A quad that fills the picture.
const QUAD: &str = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl a\n";
const FACE: &str = "f 1/1 2/2 3/3 4/4\n";
const SCENE: &str = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 10\n[film]\nsize = [8, 8]\n[render]\nspp = 4\n\
    [[light]]\ntype = \"environment\"\nradiance = 1\n[[shape]]\ntype = \"mesh\"\nfile = \"m.obj\"\n";

/// Heights that rise to the right and fall again.
fn heights() -> image::GrayImage {
    image::GrayImage::from_fn(8, 8, |x, _| image::Luma([(32 * if x < 4 { x } else { 8 - x }) as u8]))
}

fn place() -> Workplace {
    let place = Workplace::new();
    place.write("m.obj", format!("{QUAD}{FACE}"));
    place.write("m.mtl", "newmtl a\nKd 0.5 0.5 0.5\n");
    place.write("scene.toml", SCENE);
    place
}

fn pixels(place: &Workplace, scene: &str) -> Vec<[f32; 3]> {
    place.expect(0, &format!("render {scene} --device cpu -q -o a.exr"));
    place.image("a.exr").pixels
}

/// Models that were refused or lost a face before render as the plain quad does, with a warning that `--strict` makes an error.
#[test]
#[ignore = "slow"]
fn the_rest_of_a_model_is_rendered() {
    let place = place();
    let plain = pixels(&place, "scene.toml");
    assert!(plain.iter().all(|pixel| (pixel[0] - 0.5).abs() < 0.1), "{plain:?}");
    assert_eq!(place.expect(0, "check scene.toml --json --strict"), "");
    for (statements, said) in [
        ("f 1 2", "m.obj:11:1: faces of fewer than three corners are left out: `f 1 2`"),
        ("f 0 1 2", "m.obj:11:1: faces with a corner that is no vertex"),
        (
            "v nan 0 0\nf 1 2 5\nf 5 3 4",
            "m.obj:11:1: faces with a corner whose position is no three numbers within 1e18 are left out: `v nan 0 0`; 2 in all",
        ),
        ("call other.obj", "m.obj:11:1: free-form"),
        ("nonsense 1", "m.obj:11:1: lines that are not understood"),
    ] {
        place.write("m.obj", format!("{QUAD}{statements}\n{FACE}"));
        let stderr = place.expect(0, "check scene.toml --json");
        assert!(stderr.contains(said), "{statements}: {stderr}");
        assert!(pixels(&place, "scene.toml") == plain, "{statements}");
        let stderr = place.expect(3, "check scene.toml --json --strict");
        assert!(stderr.contains(said), "{statements}: {stderr}");
    }
    // A face that a comment swallowed, and what nobody uses, are no matter.
    for text in [
        format!("{QUAD}# a comment \\\n{FACE}"),
        format!("{QUAD}v nan nan nan\nvn x\n{FACE}"),
        format!("{QUAD}{FACE}").replace('\n', "\r"),
    ] {
        place.write("m.obj", &text);
        assert_eq!(place.expect(0, "check scene.toml --json --strict"), "", "{text:?}");
        assert!(pixels(&place, "scene.toml") == plain, "{text:?}");
    }
}

#[test]
#[ignore = "slow"]
fn the_rest_of_a_material_counts() {
    let place = place();
    let plain = pixels(&place, "scene.toml");
    for (library, said) in [
        ("newmtl a\nKd 0.5 0.5\n", "m.mtl:2:1: a colour of two numbers"),
        ("newmtl a\nKd 0.5\nKs spectral file.rfl\n", "m.mtl:3:1: a spectrum in a file is not read"),
        ("newmtl a\nKd 0.5\nillum\n", "m.mtl:3:1: `illum`"),
        ("newmtl a\nKd 0.5\nKs nan nan nan\n", "m.mtl:3:1: a colour that cannot be read"),
        ("newmtl a\nKd 0.5\nd 1.5\n", "m.mtl:3:1: the nearest number"),
        ("newmtl a\nKd 0.5\nmap_Bump absent.png\n", "m.mtl:3:1: the material `a`: map_Bump"),
        ("Kd 1\nnewmtl a\nKd 0.5\n", "m.mtl:1:1: what stands before the first `newmtl`"),
        ("newmtl a\nKd 0.5\nnewmtl a\nKd 1 0 0\n", "m.mtl:3:1: a material is there twice"),
    ] {
        place.write("m.mtl", library);
        let stderr = place.expect(0, "check scene.toml --json");
        assert!(stderr.contains(said), "{library}: {stderr}");
        assert!(pixels(&place, "scene.toml") == plain, "{library}");
        let stderr = place.expect(3, "check scene.toml --json --strict");
        assert!(stderr.contains(said), "{library}: {stderr}");
    }
    for library in
        ["newmtl a # grey\nKd .5 0.5 5e-1 # as before\nKa\n", "\u{feff}NEWMTL a\rkd 0.5\r", "newmtl a\nKd 0.5 \\\n0.5 0.5\n"]
    {
        place.write("m.mtl", library);
        assert_eq!(place.expect(0, "check scene.toml --json --strict"), "", "{library:?}");
        assert!(pixels(&place, "scene.toml") == plain, "{library:?}");
    }
}

#[test]
fn names_are_one_whether_accents_are_taken_apart_or_not() {
    let place = place();
    let plain = pixels(&place, "scene.toml");
    place.write("m.obj", format!("{QUAD}{FACE}").replace("usemtl a", "usemtl Möbel"));
    place.write("m.mtl", "newmtl Mo\u{308}bel\nKd 0.5\n");
    assert_eq!(place.expect(0, "check scene.toml --json --strict"), "");
    assert!(pixels(&place, "scene.toml") == plain);
}

#[test]
fn a_ply_file_is_mended_as_well() {
    let place = place();
    let plain = pixels(&place, "scene.toml");
    let header = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty float nx\nproperty float ny\n\
        property float nz\nelement face 2\nproperty list uchar int vertex_indices\nend_header\n";
    let material = "material = \"a\"\n[[material]]\nname = \"a\"\ntype = \"diffuse\"\nreflectance = 0.5\n";
    place.write("scene.toml", SCENE.replace("m.obj", "m.ply") + material);
    for (data, said) in [
        ("-1 -1 0 0 0 1\n\n1 -1 0 0\n0 1\n1 1 0 0 0 1\n-1 1 0 0 0 1\n3 0 1 2\n3 0\n2 3\n", ""),
        (
            "-1 -1 0 0 0 1\n1 -1 0 nan nan nan\n1 1 0 0 0 1\n-1 1 0 0 0 1\n3 0 1 2\n3 0 2 3\n",
            "m.ply:14:1: normals that are no three numbers",
        ),
        (
            "-1 -1 0 0 0 1\n1 -1 0 0 0 1\n1 1 0 0 0 1\n-1 1 0 0 0 1\n4 0 1 2 3\n3 0 1 4\n",
            "m.ply: faces with a corner that is no vertex",
        ),
    ] {
        place.write("m.ply", format!("{header}{data}"));
        let stderr = place.expect(0, "check scene.toml --json");
        assert!(if said.is_empty() { stderr.is_empty() } else { stderr.contains(said) }, "{data}: {stderr}");
        let picture = pixels(&place, "scene.toml");
        assert!(picture.iter().zip(&plain).all(|(ours, plain)| (ours[0] - plain[0]).abs() < 1e-3), "{data}");
        place.expect(if said.is_empty() { 0 } else { 3 }, "check scene.toml --json --strict");
    }
}

/// Heights of an MTL file are those of a scene file's `bump_map`, in scene units.
#[test]
fn bump_maps_take_effect() {
    let place = place();
    heights().save(place.path("h.png")).expect("a picture");
    // Light from one side shows slopes.
    let scene = SCENE.replace(
        "[[light]]\ntype = \"environment\"\nradiance = 1",
        "[[light]]\ntype = \"directional\"\ndirection = [-1, 0, -1]\nirradiance = 3",
    );
    place.write("scene.toml", &scene);
    let flat = pixels(&place, "scene.toml");
    let map = "[[texture]]\nname = \"h\"\ntype = \"image\"\nfile = \"h.png\"\ncolor_space = \"linear\"\n";
    let material = "[[material]]\nname = \"a\"\ntype = \"diffuse\"\nreflectance = 0.5\nbump_map = \"h\"\nbump_scale = 0.25\n";
    place.write("written.toml", format!("{scene}material = \"a\"\n{material}{map}"));
    let written = pixels(&place, "written.toml");
    assert!(written != flat, "the control");
    for key in ["bump -bm 0.25", "map_Bump -bm .25", "map_bump -mm 0 0.25", "BUMP -bm 0.5 -mm 0.5 0.5"] {
        place.write("m.mtl", format!("newmtl a\nKd 0.5\n{key} h.png\n"));
        assert_eq!(place.expect(0, "check scene.toml --json --strict"), "", "{key}");
        assert!(pixels(&place, "scene.toml") == written, "{key}");
    }
    place.write("m.mtl", "newmtl a\nKd 0.5\nbump h.png -bm 0.25\n");
    assert!(pixels(&place, "scene.toml") == written, "the option behind the name");
    place.write("m.mtl", "newmtl a\nKd 0.5\nbump h.png\n");
    assert!(pixels(&place, "scene.toml") != written, "the control: another height");
    // Blender writes maps of normals there.
    image::RgbImage::from_fn(8, 8, |x, _| image::Rgb(if x < 4 { [64, 128, 238] } else { [192, 128, 238] }))
        .save(place.path("n.png"))
        .expect("a picture");
    place.write("m.mtl", "newmtl a\nKd 0.5\nmap_Bump -bm 1 n.png\n");
    assert!(place.expect(0, "check scene.toml --json").contains("is a map of normals, and taken as one"));
    let bumped = pixels(&place, "scene.toml");
    place.write("m.mtl", "newmtl a\nKd 0.5\nnorm n.png\n");
    assert!(pixels(&place, "scene.toml") == bumped && bumped != flat);
}
