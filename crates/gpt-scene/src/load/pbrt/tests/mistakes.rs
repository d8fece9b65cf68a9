//! Mistakes are told with their places, and none ends the program.

use std::io::Write as _;

use flate2::Compression;
use flate2::write::GzEncoder;

use super::{Folder, SCENE, read, report, valid};

#[test]
fn mistakes_are_shown_where_they_are() {
    // The line in which what is tested begins.
    const LINE: usize = 11;
    for (more, words, column) in [
        ("Shap \"sphere\"", "no directive `Shap`", 1),
        ("[ 1 ]", "a directive is expected", 1),
        ("Shape sphere", "a text in quotes is expected", 7),
        ("Shape \"sphere\" \"float radius\" x", "expects numbers", 31),
        ("Shape \"sphere\" \"float radius\" -1", "`radius` is above 0", 16),
        ("Shape \"sphere\" \"radius\" 1", "its type and its name", 16),
        ("Translate 1 2", "the file ends where 3 numbers", 1),
        ("Translate 1 2 x", "3 numbers are expected", 15),
        ("Scale 1 0 1", "leaves nothing", 1),
        ("Rotate 10 0 0 0", "no length", 1),
        ("LookAt 0 0 0 0 0 0 0 1 0", "which way is up", 1),
        ("Transform [ 1 0 0 1 0 1 0 0 0 0 1 0 0 0 0 1 ]", "last row", 1),
        ("AttributeEnd", "without a begin", 1),
        ("AttributeBegin", "no AttributeEnd", 1),
        ("ObjectBegin \"a\"", "no ObjectEnd", 1),
        ("ObjectInstance \"b\"", "no object `b`", 1),
        ("NamedMaterial \"m\" Shape \"sphere\"", "no material `m`", 19),
        ("WorldBegin", "before WorldBegin", 1),
        ("Camera \"perspective\"", "before WorldBegin", 1),
        ("Include \"absent.pbrt\"", "there is no file absent.pbrt", 1),
        ("ColorSpace \"adobe\"", "no colour space", 1),
        ("CoordSysTransform \"b\"", "no coordinate system", 1),
        ("Material \"diffuse\" \"rgb reflectance\" [ 2 0 0 ]\nShape \"sphere\"", "above 1", 20),
        ("Material \"diffuse\" \"texture reflectance\" \"t\"\nShape \"sphere\"", "no texture of spectrum `t`", 20),
        ("Material \"dielectric\" \"float eta\" 20\nShape \"sphere\"", "an index of refraction", 23),
        ("Material \"dielectric\" \"spectrum eta\" \"glass-X\"\nShape \"sphere\"", "no spectrum `glass-X`", 23),
        ("Material \"mix\" Shape \"sphere\"", "names of two materials", 1),
        ("LightSource \"spot\" \"float coneangle\" 10 \"float conedeltaangle\" 20", "`conedeltaangle`", 41),
        ("MakeNamedMedium \"fog\" \"float g\" 0", "string type", 1),
        ("MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\"", "no medium `fog`", 47),
        ("Shape \"trianglemesh\" \"point3 P\" [ 0 0 0 1 0 0 0 1 0 ] \"integer indices\" [ 0 1 3 ]", "the vertex 3", 55),
        ("Shape \"trianglemesh\" \"integer indices\" [ 0 1 2 ]", "needs \"point3 P\"", 1),
        ("Shape \"plymesh\" \"string filename\" \"a.ply\"", "there is no file a.ply", 17),
        ("Shape \"sphere\" \"string s\" \"open", "a text in quotes ends", 27),
    ] {
        let error = read(more).map(|_| ()).expect_err(more);
        assert!(error.message().contains(words), "{more}: {error}");
        assert_eq!((error.line(), error.column()), (Some(LINE), Some(column)), "{more}: {error}");
        assert!(error.excerpt().is_some(), "{more}");
    }
    assert!(read("Shape \"sphere\"").is_ok(), "the control");
}

#[test]
fn names_that_are_nearly_right_are_suggested() {
    for (more, help) in [
        ("Shap \"sphere\"", "Shape"),
        ("MakeNamedMaterial \"copper\" \"string type\" \"conductor\" NamedMaterial \"coper\" Shape \"sphere\"", "copper"),
        ("ColorSpace \"adobe\"", "rec2020"),
    ] {
        let error = read(more).map(|_| ()).expect_err(more);
        assert!(error.help_text().is_some_and(|text| text.contains(help)), "{more}: {:?}", error.help_text());
    }
}

#[test]
fn files_include_each_other_with_an_end() {
    let scene = |more: &str| SCENE.replace("MORE", more);
    let files = |more: &str, part: &str| Folder::new(&[("a.pbrt", scene(more).as_bytes()), ("b.pbrt", part.as_bytes())]);
    // The state goes on behind what is included, and not behind what is imported.
    let part = "Translate 5 0 0\nShape \"sphere\"";
    let position = |directive: &str| {
        let scene = files(&format!("{directive} \"b.pbrt\"\nShape \"sphere\""), part).valid("a.pbrt");
        scene.shapes.iter().map(|shape| shape.transform.to_affine().translation.x).collect::<Vec<_>>()
    };
    assert_eq!((position("Include"), position("Import")), (vec![5.0, 5.0], vec![5.0, 0.0]));
    let error = files("Include \"b.pbrt\"", "\nInclude \"b.pbrt\"").load("a.pbrt").map(|_| ()).expect_err("a circle");
    assert!(error.message().contains("includes itself") && error.line() == Some(2), "{error}");
    let chain: Vec<(String, String)> = (0..40).map(|i| (format!("{i}.pbrt"), format!("Include \"{}.pbrt\"", i + 1))).collect();
    let chain: Vec<(&str, &[u8])> = chain.iter().map(|(name, text)| (name.as_str(), text.as_bytes())).collect();
    let whole = scene("Include \"0.pbrt\"");
    let folder = Folder::new(&[&[("a.pbrt", whole.as_bytes())][..], &chain].concat());
    let error = folder.load("a.pbrt").map(|_| ()).expect_err("too deep");
    assert!(error.message().contains("more than 32 deep"), "{error}");
    let error = files("Include \"b.pbrt\"", "AttributeBegin").load("a.pbrt").map(|_| ()).expect_err("it has no end");
    assert!(error.message().contains("in its file") && error.file().ends_with("b.pbrt"), "{error}");
    let error = Folder::new(&[("b.pbrt", b"# nothing")]).load("b.pbrt").map(|_| ()).expect_err("a part");
    assert!(error.message().contains("no WorldBegin"), "{error}");
}

#[test]
fn packed_files_are_read() {
    let packed = |text: &[u8]| {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::default());
        encoder.write_all(text).expect("memory");
        encoder.finish().expect("memory")
    };
    let part = packed(b"Shape \"sphere\"");
    let scene = SCENE.replace("MORE", "Include \"b.pbrt.gz\"");
    let folder = Folder::new(&[("a.pbrt.gz", &packed(scene.as_bytes())), ("b.pbrt.gz", &part)]);
    assert_eq!(folder.valid("a.pbrt.gz").shapes.len(), 1);
    // One that unpacks to a thousand times its size is refused.
    let bomb = packed(&vec![b' '; 1 << 26]);
    let error = Folder::new(&[("a.pbrt.gz", &bomb)]).load("a.pbrt.gz").map(|_| ()).expect_err("too large");
    assert!(error.message().contains("unpacked"), "{error}");
}

#[test]
fn nothing_is_left_out_silently() {
    let cases = [
        ("Shape \"sphere\" \"float zmim\" 1", "Shape `sphere`: `zmim` x1: it has no effect\n"),
        ("Shape \"curve\" \"float width\" 1", "Shape `curve` x1: it is left out\n"),
        ("LightSource \"projection\" \"float fov\" 1", "LightSource `projection` x1: it gives no light\n"),
        ("Option \"bool forcediffuse\" true", "Option `bool forcediffuse` x1: it has no effect\n"),
        ("Option \"seed\" 3", ""),
        ("Material \"hair\" Shape \"sphere\"", "Material `hair` x1: a diffuse grey of 0.5 stands for it\n"),
        (
            "Material \"matte\" Shape \"sphere\"",
            "Material `matte` x1: a diffuse grey of 0.5 stands for it; version 4 has no material of this name\n",
        ),
        ("AreaLightSource \"tube\" Shape \"sphere\"", "AreaLightSource `tube` x1: the shape gives no light\n"),
        (
            "AreaLightSource \"diffuse\" Material \"interface\" Shape \"sphere\"",
            "AreaLightSource of a shape of the material `interface` x1: it gives no light, as there\n",
        ),
    ];
    for (more, expected) in cases {
        let more = format!("{more}\nShape \"disk\"");
        let more = if expected.starts_with("AreaLight") { more.replace("\nShape \"disk\"", "") } else { more };
        assert_eq!(report(&valid(&more)), expected, "{more}");
    }
    // Parameters that attributes set need not be of use.
    assert_eq!(report(&valid("Attribute \"shape\" \"float innerradius\" 0\nShape \"sphere\"")), "");
    let scene = SCENE.replace("Film", "Accelerator \"bvh\" \"integer maxnodeprims\" 4\nFilm").replace("MORE", "Shape \"sphere\"");
    assert_eq!(report(&super::whole(&scene)), "", "how rays find surfaces changes nothing");
}

/// A scene in which every kind of thing is.
const EVERYTHING: &str = r#"
Texture "tiles" "spectrum" "checkerboard" "float uscale" 3 "rgb tex1" [ .1 .2 .3 ]
Texture "rough" "float" "bilerp" "float v00" .1
Texture "both" "spectrum" "mix" "texture tex1" "tiles" "rgb tex2" [ .5 .5 .5 ] "float amount" .25
MakeNamedMaterial "wall" "string type" "diffuse" "texture reflectance" "both"
MakeNamedMaterial "paint" "string type" "coateddiffuse" "float roughness" .1 "texture reflectance" "tiles" "integer maxdepth" 100
MakeNamedMaterial "foil" "string type" "coatedconductor" "spectrum conductor.eta" "metal-Al-eta" "spectrum conductor.k" "metal-Al-k"
MakeNamedMaterial "metal" "string type" "conductor" "texture roughness" "rough"
MakeNamedMaterial "mix" "string type" "mix" "string materials" [ "wall" "metal" ] "float amount" .3
MakeNamedMaterial "skin" "string type" "subsurface" "string name" "Skin1" "float scale" 10
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .1 .1 .1 ] "spectrum sigma_s" [ 400 .1 700 .3 ] "float g" .3
MakeNamedMedium "smoke" "string type" "uniformgrid" "integer nx" 2 "float density" [ 0 1 ] "rgb Le" [ 1 1 1 ]
ObjectBegin "thing"
NamedMaterial "paint"
Shape "trianglemesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 ] "normal N" [ 0 0 1 0 0 1 0 0 1 ] "point2 uv" [ 0 0 1 0 0 1 ]
Shape "sphere" "float radius" .2
ObjectEnd
AttributeBegin
Translate 1 0 0
ActiveTransform EndTime
Rotate 30 0 1 0
ActiveTransform All
ObjectInstance "thing"
AttributeEnd
AttributeBegin
CoordinateSystem "here"
ReverseOrientation
AreaLightSource "diffuse" "blackbody L" 3000 "float power" 10 "bool twosided" true
NamedMaterial "mix"
Shape "cylinder" "float phimax" 90 "float alpha" .5
AttributeEnd
AttributeBegin
MediumInterface "fog" ""
Material "dielectric" "spectrum eta" "glass-BK7" "float uroughness" .2 "float vroughness" .1
Shape "sphere" "float zmax" .5
Material "interface"
MediumInterface "smoke" ""
Shape "sphere"
AttributeEnd
NamedMaterial "skin"
Shape "loopsubdiv" "integer levels" 1 "point3 P" [ 0 0 0 1 0 0 0 1 0 0 0 1 ] "integer indices" [ 0 2 1 0 1 3 1 2 3 2 0 3 ]
NamedMaterial "foil"
Shape "bilinearmesh" "point3 P" [ 0 0 0 1 0 0 0 1 0 1 1 1 ]
LightSource "infinite" "rgb L" [ .1 .2 .3 ] "float illuminance" 2
LightSource "distant" "float illuminance" 2
LightSource "spot" "spectrum I" "stdillum-A" "float power" 3
Material "thindielectric"
Shape "disk" "float innerradius" .5
"#;

#[test]
fn a_scene_of_everything_is_read() {
    let scene = valid(EVERYTHING);
    assert!(scene.shapes.len() >= 8 && scene.media.len() >= 3 && scene.lights.len() == 4, "{}", scene.shapes.len());
}

/// Files that end early, or have other bytes in them, are read or refused: nothing hangs, and nothing ends the program.
#[test]
fn damaged_scenes_are_read_or_refused() {
    let whole = SCENE.replace("MORE", EVERYTHING);
    let folder = Folder::new(&[]);
    let mut outcomes = [0, 0];
    let mut load = |bytes: &[u8]| {
        std::fs::write(folder.path("a.pbrt"), bytes).expect("it is written");
        outcomes[usize::from(folder.load("a.pbrt").is_ok())] += 1;
    };
    for end in (0..whole.len()).step_by(7) {
        load(&whole.as_bytes()[..end]);
    }
    // A linear congruential generator (Knuth, MMIX).
    let mut state = 1_u64;
    let mut random = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    for round in 0..600 {
        let mut bytes = whole.clone().into_bytes();
        for _ in 0..=round % 4 {
            let at = random(bytes.len());
            match random(4) {
                0 => bytes[at] = random(256) as u8,
                1 => bytes[at] = b"[]\"#-9 \n"[random(8)],
                2 => {
                    bytes.drain(at..(at + random(40)).min(bytes.len()));
                }
                _ => {
                    let piece = bytes[at..(at + random(60)).min(bytes.len())].to_vec();
                    let to = random(bytes.len());
                    bytes.splice(to..to, piece);
                }
            }
        }
        load(&bytes);
    }
    assert!(outcomes.iter().all(|count| *count > 30), "{outcomes:?}");
}
