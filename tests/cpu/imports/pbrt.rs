//! Scenes of pbrt: they make the picture that a scene file of ours makes, and what is exported comes back.

use gpt::scene::Scene;
use gpt::{DeviceChoice, Render, RenderOptions};

use super::{Folder, picture, report};

const SCENE: &str = r#"Scale -1 1 1
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 40 "integer yresolution" 30
PixelFilter "triangle" "float xradius" 1 "float yradius" 1
Sampler "halton" "integer pixelsamples" 2
Integrator "volpath" "integer maxdepth" 3
WorldBegin
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.7 0.2 0.1 ]
NamedMaterial "red"
AttributeBegin
Translate 0.1 0.25 -0.5
Shape "sphere" "float radius" 0.75
AttributeEnd
Shape "trianglemesh" "point3 P" [ -1 -1 -2  1 -1 -2  1 1 -2  -1 1 -2 ] "integer indices" [ 0 1 2 0 2 3 ]
LightSource "point" "rgb I" [ 10 20 30 ] "point3 from" [ 1 2 3 ]
MORE
"#;

const SAME: &str = r#"
[film]
size = [40, 30]
filter = { type = "tent", radius = 1 }
[render]
max_depth = 4
spp = 2
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
vfov = 40
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.7, 0.2, 0.1]
[[shape]]
type = "sphere"
center = [0.1, 0.25, -0.5]
radius = 0.75
material = "red"
[[shape]]
type = "mesh"
positions = [[-1, -1, -2], [1, -1, -2], [1, 1, -2], [-1, 1, -2]]
faces = [[0, 1, 2], [0, 2, 3]]
material = "red"
[[light]]
type = "point"
position = [1, 2, 3]
intensity = [10, 20, 30]
"#;

#[test]
fn a_scene_and_its_likeness_make_the_same_picture() {
    let text = SCENE.replace("MORE", "");
    let other = text.replace("0.75", "0.7500001");
    let folder = Folder::new(&[("a.pbrt", text.as_bytes()), ("b.toml", SAME.as_bytes()), ("c.pbrt", other.as_bytes())]);
    let (scene, same) = (folder.valid("a.pbrt"), folder.valid("b.toml"));
    assert_eq!((&scene.film, &scene.render), (&same.film, &same.render));
    assert_eq!(report(&scene), "");
    assert_eq!(picture(&scene), picture(&same));
    // The control: a sphere a little larger.
    assert_ne!(picture(&folder.valid("c.pbrt")), picture(&same));
}

#[test]
fn what_is_written_makes_the_same_picture() {
    let more = r#"
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [ .1 .2 .3 ] "rgb sigma_s" [ 1 1 1 ] "float g" .3
MakeNamedMaterial "paint" "string type" "coateddiffuse" "float roughness" .05 "rgb reflectance" [ .2 .5 .8 ]
Texture "tiles" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 4 "rgb tex1" [ .8 .1 .1 ] "rgb tex2" [ .1 .8 .1 ]
Texture "faded" "spectrum" "mix" "texture tex1" "tiles" "rgb tex2" [ .5 .5 .5 ]
ObjectBegin "thing"
NamedMaterial "paint"
Shape "sphere" "float radius" .2
ObjectEnd
AttributeBegin
Translate -.6 -.6 .5
ObjectInstance "thing"
AttributeEnd
AttributeBegin
MediumInterface "fog" ""
Material "interface"
Translate .6 -.5 .6
Shape "sphere" "float radius" .4
AttributeEnd
AttributeBegin
Material "diffuse" "texture reflectance" "faded"
Translate -.5 .7 0
Shape "sphere" "float radius" .3 "float zmax" .2
AttributeEnd
AttributeBegin
AreaLightSource "diffuse" "blackbody L" 4000 "float scale" 5 "bool twosided" true
Translate 0 1.2 0
Shape "disk" "float radius" .3
AttributeEnd
LightSource "infinite" "string filename" "sky.png" "float scale" .5"#;
    let folder = Folder::new(&[("a.pbrt", SCENE.replace("MORE", more).as_bytes())]);
    image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([x as u8 * 30, y as u8 * 30, 90]))
        .save(folder.path("sky.png"))
        .expect("a picture");
    let scene = folder.valid("a.pbrt");
    assert_eq!(picture(&scene), picture(&folder.written("a.pbrt")));
}

/// Seeds with which a scene is rendered, to know how far its mean deviates.
const SEEDS: u32 = 8;

/// The mean of a small picture in each channel, and its standard error.
fn mean(scene: &Scene) -> [[f64; 2]; 3] {
    let of_seed = |seed: u32| {
        let options = RenderOptions {
            device: DeviceChoice::Cpu,
            size: Some([24, 18]),
            samples: Some(64),
            seed: Some(seed),
            ..RenderOptions::default()
        };
        let image = scene.render(&options).unwrap_or_else(|error| panic!("{error}"));
        let count = image.pixels().len() as f64;
        [0, 1, 2].map(|channel| image.pixels().iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / count)
    };
    let means: Vec<[f64; 3]> = (0..SEEDS).map(of_seed).collect();
    let count = f64::from(SEEDS);
    [0, 1, 2].map(|channel| {
        let mean = means.iter().map(|mean| mean[channel]).sum::<f64>() / count;
        let squares: f64 = means.iter().map(|one| (one[channel] - mean).powi(2)).sum();
        [mean, (squares / (count - 1.0) / count).sqrt()]
    })
}

/// The largest difference of two means in their errors, of any channel.
fn deviation(a: [[f64; 2]; 3], b: [[f64; 2]; 3]) -> f64 {
    let of_channel = |channel: usize| {
        let ([a, a_error], [b, b_error]) = (a[channel], b[channel]);
        // Pictures of the same light everywhere have no errors but rounding.
        (a - b).abs() / (a_error.hypot(b_error) + 1e-4 * a.abs())
    };
    (0..3).map(of_channel).fold(0.0, f64::max)
}

/// Scenes that pbrt's text says exactly come back as they were. The control: 4 % more light would be noticed.
#[test]
#[ignore = "slow"]
fn exported_scenes_come_back() {
    let folder = Folder::new(&[]);
    for name in ["cornell", "furnace-lambert", "furnace-box", "furnace-glass"] {
        let scene = gpt::load::load(Some(name)).expect("a built-in scene");
        let target = folder.path(&format!("{name}.pbrt"));
        let written = gpt::scene_writer::as_pbrt(&scene, name, &target);
        assert!(written.report.is_empty(), "{name}: {:?}", written.report);
        written.write(&target, &gpt::load::FileLog::default()).unwrap_or_else(|error| panic!("{error}"));
        let back = folder.valid(&format!("{name}.pbrt"));
        assert_eq!(report(&back), "", "{name}");
        assert_eq!((back.film.size, back.render.max_depth), (scene.film.size, scene.render.max_depth), "{name}");
        let (before, after) = (mean(&scene), mean(&back));
        assert!(deviation(before, after) < 5.0, "{name}: {before:?} {after:?}");
        let brighter = after.map(|[mean, error]| [1.04 * mean, error]);
        assert!(deviation(before, brighter) > 6.0, "{name}, the control: {before:?} {after:?}");
    }
}

#[test]
fn a_scene_file_takes_a_scene_of_pbrt_in() {
    let text = "[[import]]\nfile = \"a.pbrt\"\nmaterials = { red = \"blue\" }\n[[material]]\nname = \"blue\"\ntype = \"diffuse\"\nreflectance = 0.3\n";
    let folder = Folder::new(&[("a.pbrt", SCENE.replace("MORE", "").as_bytes()), ("scene.toml", text.as_bytes())]);
    let scene = folder.valid("scene.toml");
    assert_eq!((scene.shapes.len(), scene.lights.len()), (2, 1));
    assert_eq!(scene.materials[scene.shapes[0].material].name, "blue");
}
