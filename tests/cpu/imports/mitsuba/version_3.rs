//! Rules of Mitsuba's version 3 that differ from what one would guess, or from its versions before 2.

use gpt::scene::{Camera, EnvironmentRadiance, Geometry, Light, MaterialKind, Projection, Texture, TextureKind};
use gpt::spectrum::Spectrum;
use gpt::{DeviceChoice, Render, RenderOptions};

use super::super::{Folder, picture, report};
use super::{SCENE, with};

/// A PNG of so many pixels.
fn png(width: u32, height: u32, pixel: impl Fn(u32, u32) -> [u8; 3]) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbImage::from_fn(width, height, |x, y| image::Rgb(pixel(x, y)));
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("memory can be written to");
    bytes.into_inner()
}

/// Red, green, blue and yellow, from the upper left row by row.
fn quarters() -> Vec<u8> {
    png(2, 2, |x, y| [[[255, 0, 0], [0, 255, 0]], [[0, 0, 255], [255, 255, 0]]][y as usize][x as usize])
}

/// A scene of these elements, seen from z = 5 in a square picture.
fn seen(more: &str) -> String {
    seen_by("perspective", "<float name=\"fov\" value=\"10\"/>", "", more)
}

fn seen_by(sensor: &str, keys: &str, steps: &str, more: &str) -> String {
    format!(
        r#"<scene version="3.0.0"><sensor type="{sensor}">{keys}<transform name="to_world">{steps}<lookat origin="0,0,5" target="0,0,0" up="0,1,0"/>
        </transform><film type="hdrfilm"><integer name="width" value="8"/><integer name="height" value="8"/><rfilter type="box"/></film></sensor>
        {more}</scene>"#
    )
}

/// The picture's quarters, each as the mean of its middle, from the upper left row by row.
fn means(scene: &gpt::scene::Scene, samples: u32) -> [[f32; 3]; 4] {
    let options = RenderOptions { device: DeviceChoice::Cpu, samples: Some(samples), ..RenderOptions::default() };
    let image = scene.render(&options).unwrap_or_else(|error| panic!("{error}"));
    let pixels = image.pixels();
    [[1, 1], [5, 1], [1, 5], [5, 5]].map(|[x, y]: [usize; 2]| {
        let within = [0, 1].map(|row| [0, 1].map(|column| pixels[(y + row) * 8 + x + column]));
        std::array::from_fn(|channel| within.iter().flatten().map(|pixel| pixel[channel]).sum::<f32>() / 4.0)
    })
}

fn folder(xml: &str) -> Folder {
    let colour = png(2, 2, |_, _| [200, 100, 50]);
    let grey = png(2, 2, |_, _| [128; 3]);
    Folder::new(&[("a.xml", xml.as_bytes()), ("grey.png", &grey), ("colour.png", &colour), ("quarters.png", &quarters())])
}

fn first_texel(texture: &Texture) -> [f32; 3] {
    let TextureKind::Image(image) = &texture.kind else { panic!("no image") };
    let [red, green, blue, _] = image.image.texels.get(0);
    [red, green, blue]
}

/// A picture in place of a number is decoded unless it is raw, and its luminance counts.
#[test]
fn numbers_of_pictures_are_decoded() {
    let blend = r#"<bsdf type="blendbsdf">TEXTURE<bsdf type="diffuse"/><bsdf type="null"/></bsdf>"#;
    let places = [
        ("weight", blend),
        ("opacity", r#"<bsdf type="mask">TEXTURE<bsdf type="diffuse"/></bsdf>"#),
        ("alpha", r#"<bsdf type="roughconductor">TEXTURE</bsdf>"#),
        ("alpha", r#"<bsdf type="roughdielectric">TEXTURE</bsdf>"#),
        ("roughness", r#"<bsdf type="principled">TEXTURE</bsdf>"#),
        ("metallic", r#"<bsdf type="principled">TEXTURE</bsdf>"#),
    ];
    // Values of sRGB's curve: 128, and 200, 100 and 50 by the luminance of Rec.709.
    let rows = [
        ("grey.png", false, 0.215_861),
        ("grey.png", true, 0.501_961),
        ("colour.png", false, 0.212_671 * 0.577_580 + 0.715_160 * 0.127_438 + 0.072_169 * 0.031_896),
        ("colour.png", true, (0.212_671 * 200.0 + 0.715_160 * 100.0 + 0.072_169 * 50.0) / 255.0),
    ];
    for (name, bsdf) in places {
        for (file, raw, expected) in rows {
            let texture = format!(
                r#"<texture type="bitmap" name="{name}"><string name="filename" value="{file}"/><boolean name="raw" value="{raw}"/></texture>"#
            );
            let folder = folder(&with(&format!(r#"<shape type="rectangle">{}</shape>"#, bsdf.replace("TEXTURE", &texture))));
            let scene = folder.valid("a.xml");
            let found = first_texel(&scene.textures[0])[0];
            assert!((found - expected).abs() < 2e-6, "{name}: {file}, raw {raw}: {found} instead of {expected}");
            assert_eq!(picture(&folder.written("a.xml")), picture(&scene), "{name}: {file}, raw {raw}");
        }
    }
}

/// A colour in place of a number is the mean of its channels.
#[test]
fn numbers_of_colours_are_means() {
    let weight = r#"<rgb name="weight" value="0.1, 0.2, 0.6"/>"#;
    let blend = format!(
        r#"<shape type="rectangle"><bsdf type="blendbsdf">{weight}<bsdf type="null"/><bsdf type="diffuse"/></bsdf></shape>"#
    );
    let scene = folder(&with(&blend)).valid("a.xml");
    let blended = scene.materials.iter().find_map(|material| match &material.kind {
        MaterialKind::Blend { weight: gpt::scene::BlendWeight::Constant { value }, .. } => Some(*value),
        _ => None,
    });
    assert!(blended.is_some_and(|value| (value - 0.3).abs() < 1e-12), "{blended:?}");
}

/// A spectrum of one value is a light of equal energy, which is not white; a number, and the plugin `uniform`, are.
#[test]
fn spectra_of_lights_keep_their_colour() {
    let equal_energy = [1.204_794, 0.948_291, 0.908_916];
    let rows = [
        (r#"<float name="radiance" value="2"/>"#, [2.0; 3]),
        (r#"<rgb name="radiance" value="2"/>"#, [2.0; 3]),
        (r#"<spectrum name="radiance" value="2"/>"#, equal_energy.map(|channel| 2.0 * channel)),
        (r#"<spectrum type="uniform" name="radiance"><float name="value" value="2"/></spectrum>"#, [2.0; 3]),
        (r#"<spectrum type="d65" name="radiance"><float name="scale" value="2"/></spectrum>"#, [2.0; 3]),
        (
            r#"<spectrum type="d65" name="radiance"><rgb name="color" value="1, 2, 3"/><float name="scale" value="2"/></spectrum>"#,
            [2.0, 4.0, 6.0],
        ),
        // In modes of three colours it has no factor.
        (
            r#"<spectrum type="d65" name="radiance"><texture type="rgb"><rgb name="value" value="1, 2, 3"/></texture><float name="scale" value="2"/></spectrum>"#,
            [1.0, 2.0, 3.0],
        ),
    ];
    for (radiance, expected) in rows {
        let scene = folder(&seen(&format!(r#"<emitter type="constant">{radiance}</emitter>"#))).valid("a.xml");
        let Light::Environment(environment) = &scene.lights[0] else { panic!("no environment") };
        let EnvironmentRadiance::Constant(found) = environment.radiance else { panic!("a map") };
        let off = (found - Spectrum::from_rgb(expected)).map(f64::abs).max_component();
        assert!(off < 1e-6, "{radiance}: {found}");
    }
    let surface = r#"<shape type="rectangle"><bsdf type="diffuse"><spectrum name="reflectance" value="0.25"/></bsdf></shape>"#;
    let scene = folder(&seen(&format!(r#"{surface}<emitter type="constant"/>"#))).valid("a.xml");
    assert!(means(&scene, 16).iter().flatten().all(|channel| (channel - 0.25).abs() < 1e-6));
}

/// Without a material a rough conductor reflects all light, and a shape that gives light without a BSDF reflects none.
#[test]
fn what_is_not_said_is_as_there() {
    let of = |bsdf: &str| {
        picture(&folder(&seen(&format!(r#"<shape type="rectangle">{bsdf}</shape><emitter type="constant"/>"#))).valid("a.xml"))
    };
    let material = |name: &str| of(&format!(r#"<bsdf type="roughconductor"><string name="material" value="{name}"/></bsdf>"#));
    assert_eq!(of(r#"<bsdf type="roughconductor"/>"#), material("none"));
    assert_ne!(of(r#"<bsdf type="roughconductor"/>"#), material("Cu"), "the control");
    let tint = r#"<rgb name="specular_reflectance" value="0.5, 0.25, 1"/>"#;
    let tinted =
        format!(r#"<shape type="rectangle"><bsdf type="roughconductor">{tint}</bsdf></shape><emitter type="constant"/>"#);
    let scene = folder(&seen(&tinted)).valid("a.xml");
    assert_eq!(report(&scene), "");
    for mean in means(&scene, 64) {
        assert!((mean[1] / mean[0] - 0.5).abs() < 1e-4 && (mean[2] / mean[0] - 2.0).abs() < 1e-4, "{mean:?}");
    }
    let lamp = r#"<shape type="rectangle"><emitter type="area"/></shape><emitter type="constant"/>"#;
    let scene = folder(&seen(lamp)).valid("a.xml");
    assert!(means(&scene, 16).iter().flatten().all(|channel| *channel == 1.0));
    let scene = folder(&seen(&lamp.replace("/></shape>", r#"/><bsdf type="diffuse"/></shape>"#))).valid("a.xml");
    assert!(means(&scene, 16).iter().flatten().all(|channel| (channel - 1.5).abs() < 1e-5), "the control");
    let xml = seen_by(
        "thinlens",
        r#"<float name="fov" value="10"/><float name="aperture_radius" value="0.1"/>"#,
        "",
        r#"<emitter type="constant"/>"#,
    );
    assert_eq!(folder(&xml).valid("a.xml").camera.focus_distance, 1e4);
}

const RED: [f32; 3] = [1.0, 0.0, 0.0];
const GREEN: [f32; 3] = [0.0, 1.0, 0.0];
const BLUE: [f32; 3] = [0.0, 0.0, 1.0];
const YELLOW: [f32; 3] = [1.0, 1.0, 0.0];

/// The quarters of each face of a cube that is turned to the camera, as Mitsuba 3.9.1 shows them.
#[test]
fn pictures_lie_on_cubes_as_there() {
    let rows = [
        ("", [GREEN, YELLOW, RED, BLUE]),
        (r#"<rotate y="1" angle="180"/>"#, [BLUE, RED, YELLOW, GREEN]),
        (r#"<rotate y="1" angle="90"/>"#, [GREEN, YELLOW, RED, BLUE]),
        (r#"<rotate y="1" angle="-90"/>"#, [GREEN, YELLOW, RED, BLUE]),
        (r#"<rotate x="1" angle="90"/>"#, [YELLOW, BLUE, GREEN, RED]),
        (r#"<rotate x="1" angle="-90"/>"#, [GREEN, YELLOW, RED, BLUE]),
    ];
    for (turn, expected) in rows {
        let xml = seen(&format!(
            r#"<shape type="cube"><transform name="to_world">{turn}<translate z="-1"/></transform><emitter type="area"><texture type="bitmap" name="radiance">
            <string name="filename" value="quarters.png"/><string name="filter_type" value="nearest"/></texture></emitter></shape>"#
        ));
        let found = means(&folder(&xml).valid("a.xml"), 1);
        assert_eq!(found, expected, "{turn}");
    }
    // A rectangle whose normal is turned keeps its texture where it was.
    for flip in [false, true] {
        let turn = if flip { r#"<rotate y="1" angle="180"/>"# } else { "" };
        let xml = seen(&format!(
            r#"<shape type="rectangle"><boolean name="flip_normals" value="{flip}"/><transform name="to_world">{turn}</transform><emitter type="area">
            <texture type="bitmap" name="radiance"><string name="filename" value="quarters.png"/><string name="filter_type" value="nearest"/></texture>
            </emitter></shape>"#
        ));
        let expected = if flip { [YELLOW, BLUE, GREEN, RED] } else { [BLUE, YELLOW, RED, GREEN] };
        assert_eq!(means(&folder(&xml).valid("a.xml"), 1), expected, "{flip}");
    }
}

/// A mirror turns spheres inside out, and meshes unless their files have normals; not cubes, rectangles, disks and cylinders.
#[test]
fn mirrors_turn_what_they_turn_there() {
    let object = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n";
    let normals = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    let file = |name: &str| format!(r#"<string name="filename" value="{name}"/>"#);
    let rows = [
        ("sphere", String::new(), true),
        ("obj", file("flat.obj"), true),
        ("obj", file("flat.obj") + r#"<boolean name="face_normals" value="true"/>"#, true),
        ("obj", file("normals.obj"), false),
        ("obj", file("normals.obj") + r#"<boolean name="face_normals" value="true"/>"#, true),
        ("cube", String::new(), false),
        ("rectangle", String::new(), false),
        ("disk", String::new(), false),
        ("cylinder", r#"<point name="p0" value="0, -1, 0"/><point name="p1" value="0, 1, 0"/>"#.to_owned(), false),
    ];
    for (shape, keys, turns) in rows {
        for (mirrored, flipped) in [(false, false), (true, false), (false, true), (true, true)] {
            let scale = if mirrored { r#"<scale x="-1"/>"# } else { "" };
            let xml = seen(&format!(
                r#"<shape type="{shape}">{keys}<boolean name="flip_normals" value="{flipped}"/><transform name="to_world">{scale}</transform>
                <emitter type="area"/></shape>"#
            ));
            let folder =
                Folder::new(&[("a.xml", xml.as_bytes()), ("flat.obj", object.as_bytes()), ("normals.obj", normals.as_bytes())]);
            let scene = folder.valid("a.xml");
            let is_bright = means(&scene, 1) == [[1.0; 3]; 4];
            assert_eq!(is_bright, flipped == (mirrored && turns), "{shape}{keys}: mirrored {mirrored}, flipped {flipped}");
            assert_eq!(picture(&folder.written("a.xml")), picture(&scene), "{shape}");
        }
    }
}

/// Meshes without normals get them where `to_world` puts them: an uneven scale makes other ones.
#[test]
fn normals_are_made_once_a_mesh_is_placed() {
    let roof = |z: f64| format!("v -1 -1 0\nv 0 -1 {z}\nv 0 1 {z}\nv -1 1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3 4\nf 2 5 6 3\n");
    let of = |scale: &str| {
        format!(
            r#"<shape type="obj"><string name="filename" value="{}"/><transform name="to_world">{scale}</transform><bsdf type="diffuse"/></shape>
            <emitter type="directional"><vector name="direction" value="-1, 0, -0.2"/></emitter>"#,
            if scale.is_empty() { "steep.obj" } else { "flat.obj" }
        )
    };
    let draw = |scale: &str| {
        let folder = Folder::new(&[
            ("a.xml", seen(&of(scale)).as_bytes()),
            ("steep.obj", roof(3.0).as_bytes()),
            ("flat.obj", roof(1.0).as_bytes()),
        ]);
        means(&folder.valid("a.xml"), 16)
    };
    let (placed, written) = (draw(r#"<scale z="3"/>"#), draw(""));
    for (placed, written) in placed.iter().flatten().zip(written.iter().flatten()) {
        assert!((placed - written).abs() < 1e-4, "{placed} {written}");
    }
}

/// A sphere that is scaled unevenly is as wide as along x.
#[test]
fn uneven_spheres_stay_round() {
    let xml = seen(r#"<shape type="sphere"><transform name="to_world"><scale x="0.3" y="2" z="0.1"/></transform></shape>"#);
    let scene = folder(&xml).valid("a.xml");
    assert!(report(&scene).contains("scaled unevenly"));
    let shape = scene.shapes.last().expect("it is there");
    assert!(matches!(shape.geometry, Geometry::Sphere(_)));
    let map = shape.transform.to_affine();
    assert!((map.transform_vector3(glam::DVec3::Z).length() - 0.3).abs() < 1e-12);
}

/// `<ref>` may name what stands further down, and a document may name its type.
#[test]
fn references_lead_anywhere() {
    let more = r#"<shape type="instance"><ref id="group"/></shape>
      <shape type="shapegroup" id="group"><shape type="rectangle"><ref id="again"/></shape></shape>
      <bsdf type="twosided" id="both"><ref id="green"/></bsdf>
      <bsdf type="diffuse" id="green"><rgb name="reflectance" value="0.1, 0.9, 0.2"/></bsdf><alias id="both" as="again"/>"#;
    let text = with(more);
    let scene = folder(&format!("<?xml version=\"1.0\"?>\n<!DOCTYPE scene>\n{text}")).valid("a.xml");
    let material = &scene.materials[scene.shapes[2].material];
    assert!(matches!(material.kind, MaterialKind::Diffuse { .. }) && material.name == "both", "{}", material.name);
    for (more, said) in [
        (
            r#"<bsdf type="twosided" id="a"><ref id="b"/></bsdf><bsdf type="twosided" id="b"><ref id="a"/></bsdf>"#,
            "within itself: a, b, a",
        ),
        (r#"<bsdf type="twosided" id="a"><ref id="a"/></bsdf>"#, "within itself"),
        (r#"<alias id="a" as="b"/><alias id="b" as="a"/><shape type="sphere"><ref id="a"/></shape>"#, "no plugin with the id `"),
        (r#"<alias id="absent" as="b"/>"#, "no plugin with the id `absent`"),
        (r#"<alias id="red" as="red"/>"#, "a second plugin has the id `red`"),
    ] {
        let message = super::refusal(folder(&with(more)).load("a.xml"));
        assert!(message.contains(said) && message.contains("a.xml:"), "{more}: {message}");
    }
    let chain: String = (0..5000).map(|n| format!(r#"<bsdf type="twosided" id="n{n}"><ref id="n{}"/></bsdf>"#, n + 1)).collect();
    let message = super::refusal(folder(&with(&format!(r#"{chain}<bsdf type="diffuse" id="n5000"/>"#))).load("a.xml"));
    assert!(message.contains("deep within each other"), "{message}");
}

/// Surroundings are a scene; nothing at all is none.
#[test]
fn surroundings_alone_are_a_scene() {
    let light = r#"<emitter type="constant"><rgb name="radiance" value="0.1, 0.2, 0.3"/></emitter>"#;
    for xml in [seen(light), format!("<scene version=\"3.0.0\">{light}</scene>")] {
        let scene = folder(&xml).valid("a.xml");
        assert_eq!(scene.shapes.len(), 0);
        assert_eq!(means(&scene, 1)[0], [0.1, 0.2, 0.3]);
    }
    let gltf = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"camera":0}],
        "cameras":[{"type":"perspective","perspective":{"yfov":0.7,"znear":0.1}}]}"#;
    let scene = Folder::new(&[("a.gltf", gltf.as_bytes())]).valid("a.gltf");
    assert!(scene.shapes.is_empty() && picture(&scene).iter().flatten().all(|bits| f32::from_bits(*bits) > 0.0));
    let nothing = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{}]}"#;
    assert!(super::refusal(Folder::new(&[("a.gltf", nothing.as_bytes())]).load("a.gltf")).contains("nothing to render"));
}

/// A sphere at the upper left.
const BALL: &str = r#"<shape type="sphere"><point name="center" x="-0.3" y="0.3" z="0"/><float name="radius" value="0.25"/><emitter type="area">
    <rgb name="radiance" value="1, 0, 0"/></emitter></shape>"#;

fn camera(sensor: &str, steps: &str) -> (Camera, [bool; 4]) {
    let keys = if sensor == "orthographic" { "" } else { r#"<float name="fov" value="10"/>"# };
    let folder = folder(&seen_by(sensor, keys, steps, BALL));
    let scene = folder.valid("a.xml");
    assert_eq!(report(&scene), "");
    assert_eq!(folder.written("a.xml").camera, scene.camera);
    let found = means(&scene, 4).map(|mean| mean[0] > 0.1);
    (scene.camera, found)
}

/// A mirrored sensor shows a mirrored picture, and a window that is scaled unevenly is as wide and as high as it is there.
#[test]
fn sensors_mirror_and_stretch() {
    let (upper_left, upper_right, lower_left) =
        ([true, false, false, false], [false, true, false, false], [false, false, true, false]);
    for sensor in ["perspective", "orthographic"] {
        assert_eq!(camera(sensor, "").1, upper_left, "{sensor}");
        assert_eq!(camera(sensor, r#"<scale x="-1"/>"#).1, upper_right, "{sensor}");
        assert_eq!(camera(sensor, r#"<scale y="-1"/>"#).1, lower_left, "{sensor}");
    }
    let (uneven, _) = camera("orthographic", r#"<scale x="3" y="0.5" z="0.7"/>"#);
    assert!(matches!(uneven.projection, Projection::Orthographic { height } if (height - 1.0).abs() < 1e-12));
    assert!((uneven.stretch - 6.0).abs() < 1e-12);
    assert!((camera("orthographic", r#"<scale x="-3" y="0.5"/>"#).0.stretch + 6.0).abs() < 1e-12);
}

/// Sensors of Mitsuba 0.6 with distortion, and with all directions in the picture. A distorted one sees what OpenCV's formula says of its `kc`.
#[test]
fn lenses_and_panoramas_are_read() {
    let look = |sensor: &str, keys: &str| folder(&seen_by(sensor, keys, "", BALL)).valid("a.xml");
    let panorama = look("spherical", "");
    assert_eq!((report(&panorama), panorama.camera.projection), (String::new(), Projection::Equirectangular(Default::default())));
    let fov = r#"<float name="fov" value="60"/>"#;
    let lens = |kc: &str| look("perspective_rdist", &format!(r#"{fov}<string name="kc" value="{kc}"/>"#));
    let scene = lens("-0.2, 0.05");
    assert_eq!(report(&scene), "");
    let focal = 4.0 / 30_f64.to_radians().tan();
    let keys = format!(
        "[film]\nsize = [8, 8]\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nprojection = \"brown_conrady\"\nfocal = [{focal:?}, {focal:?}]\n\
         principal_point = [4, 4]\nimage_size = [8, 8]\nradial = [-0.2, 0.05]\n[[light]]\ntype = \"environment\"\nradiance = 1\n"
    );
    let by_hand = gpt::load::load_toml_str(&keys, "test.toml", std::path::Path::new("")).expect("it is right");
    let off = |scene: &gpt::scene::Scene| match (scene.camera.projection, by_hand.camera.projection) {
        (Projection::BrownConrady(read), Projection::BrownConrady(hand)) => format!("{read:.9?}") != format!("{hand:.9?}"),
        _ => true,
    };
    assert!(!off(&scene), "{:?}", scene.camera.projection);
    assert!(off(&lens("-0.2, 0.06")) && off(&lens("0, 0")), "the control");
    assert!(matches!(lens("0, 0").camera.projection, Projection::Perspective { .. }));
    let message = super::refusal(
        folder(&seen_by("perspective_rdist", &format!(r#"{fov}<string name="kc" value="1"/>"#), "", BALL)).load("a.xml"),
    );
    assert!(message.contains("`kc` is two numbers"), "{message}");
}

/// A mirrored map shows ahead of the camera what the plain one shows on the other side.
#[test]
fn maps_are_mirrored() {
    let map = |steps: &str| {
        let xml = seen(&format!(
            r#"<emitter type="envmap"><string name="filename" value="m.hdr"/><transform name="to_world">{steps}</transform></emitter>"#
        ));
        let folder = Folder::new(&[("a.xml", xml.as_bytes())]);
        let image = image::Rgb32FImage::from_fn(16, 8, |x, y| image::Rgb([x as f32 / 16.0, y as f32 / 8.0, 0.5]));
        image::DynamicImage::from(image).save(folder.path("m.hdr")).expect("a picture");
        let scene = folder.valid("a.xml");
        assert_eq!(report(&scene), "");
        assert_eq!(picture(&folder.written("a.xml")), picture(&scene));
        means(&scene, 64).map(|mean| mean[0])
    };
    let near = |a: [f32; 4], b: [f32; 4]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 4e-3);
    let turned = |degrees: f64| map(&format!(r#"<rotate y="1" angle="{degrees}"/>"#));
    let mirrored = |degrees: f64| map(&format!(r#"<scale x="-1"/><rotate y="1" angle="{degrees}"/>"#));
    let exchanged = |[a, b, c, d]: [f32; 4]| [b, a, d, c];
    for degrees in [40.0, -75.0] {
        let (plain, reflected) = (turned(degrees), mirrored(-degrees));
        assert!(near(reflected, exchanged(plain)), "{plain:?} {reflected:?}");
        assert!(!near(reflected, plain), "the control: {plain:?}");
    }
    // One that is mirrored upside down is turned about another axis as well.
    assert!(near(map(r#"<scale z="-1"/>"#), exchanged(map(r#"<rotate y="1" angle="180"/>"#))));
}

/// The camera looks through what gives light, and past it there is nothing; mirrors and floors show it.
#[test]
fn emitters_can_be_hidden() {
    let scene_of = |integrator: &str| {
        let shapes = r#"<shape type="rectangle"><bsdf type="diffuse"><float name="reflectance" value="0.5"/></bsdf>
            <transform name="to_world"><scale x="0.5" y="2"/><translate x="-0.5"/></transform></shape>
            <shape type="rectangle"><emitter type="area"><float name="radiance" value="7"/></emitter><transform name="to_world">
            <scale value="3"/><rotate y="1" angle="180"/><translate z="2"/></transform></shape>"#;
        let folder = folder(&seen(&format!(r#"{integrator}{shapes}<emitter type="constant"/>"#)));
        let scene = folder.valid("a.xml");
        assert_eq!(report(&scene), "");
        assert_eq!(picture(&folder.written("a.xml")), picture(&scene));
        scene
    };
    let hidden = scene_of(r#"<integrator type="path"><boolean name="hide_emitters" value="true"/></integrator>"#);
    let [left, right, ..] = means(&hidden, 256);
    assert!(left[0] > 1.0 && left[0] < 3.6 && right == [0.0; 3], "{left:?} {right:?}");
    let [left, right, ..] = means(&scene_of(r#"<integrator type="path"/>"#), 4);
    assert!(left == [0.0; 3] && right == [0.0; 3], "the control: the lamp's back is in the way: {left:?} {right:?}");
}

/// Each side has its own BSDF.
#[test]
fn two_sides_differ() {
    let sided = |turn: &str| {
        let diffuse = |colour: &str| format!(r#"<bsdf type="diffuse"><rgb name="reflectance" value="{colour}"/></bsdf>"#);
        let xml = seen(&format!(
            r#"<shape type="rectangle"><bsdf type="twosided">{}{}</bsdf><transform name="to_world">{turn}</transform></shape>
            <emitter type="constant"/>"#,
            diffuse("0.8, 0.1, 0.2"),
            diffuse("0.1, 0.6, 0.3")
        ));
        let folder = folder(&xml);
        let scene = folder.valid("a.xml");
        assert_eq!(report(&scene), "");
        assert_eq!(picture(&folder.written("a.xml")), picture(&scene));
        means(&scene, 16)[0]
    };
    let near = |found: [f32; 3], expected: [f32; 3]| found.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-5);
    assert!(near(sided(""), [0.8, 0.1, 0.2]), "{:?}", sided(""));
    assert!(near(sided(r#"<rotate y="1" angle="180"/>"#), [0.1, 0.6, 0.3]));
}

/// Versions before 2 added `uoffset` last, and took the axis of a rotation for one of length 1.
#[test]
fn old_files_are_read_by_the_rules_of_version_3() {
    let texture = r#"<shape type="rectangle"><bsdf type="diffuse"><texture type="bitmap" name="reflectance"><string name="filename" value="grey.png"/>
        <float name="uscale" value="2"/><float name="uoffset" value="0.25"/></texture></bsdf></shape>"#;
    let scene = folder(&SCENE.replace("3.0.0", "0.6.0").replace("MORE", texture)).valid("a.xml");
    assert_eq!(scene.textures[0].transform.offset[0], 0.5);
    let turned = r#"<shape type="sphere"><transform name="to_world"><rotate y="2" angle="90"/></transform></shape>"#;
    let scene = folder(&with(turned)).valid("a.xml");
    assert!(report(&scene).contains("axis of a rotation"), "{}", report(&scene));
    let unit = r#"<shape type="sphere"><transform name="to_world"><rotate y="1" angle="90"/></transform></shape>"#;
    assert_eq!(report(&folder(&with(unit)).valid("a.xml")), "", "the control");
}
