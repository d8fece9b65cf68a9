//! Images in every way in which texels are kept, any channel of them, turned and moved; cut into chunks, too.

use std::path::Path;

use gpt::load;
use gpt::plan::chunks::TEXELS;
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::{Channel, ColorInput, MaterialKind, Scene};

use super::{assert_agrees, compare_on};
use crate::common::device::{DEVICE, with_limits};
use crate::common::pixel_bits::pixel_bits;

const HEAD: &str = r#"
[film]
size = [60, 40]
[render]
spp = 4
max_depth = 3
[camera]
position = [0, 0, 4]
look_at = [0, 0, 0]
projection = "orthographic"
height = 2
[[light]]
type = "environment"
radiance = [0.8, 0.9, 1]
[[light]]
type = "point"
position = [0.4, 0.7, 2]
intensity = [1, 1, 0.8]
"#;

/// Name and file of the textures, with the keys of each.
const TEXTURES: [(&str, &str, &str); 7] = [
    ("bytes", "bytes.png", "wrap = \"mirror\"\nscale = [1.3, 0.8]\noffset = [0.1, -0.4]"),
    ("turned", "bytes.png", "scale = [1.5, 1.1]\nrotation = 30\noffset = [0.2, 0.3]"),
    ("codes", "bytes.png", "color_space = \"linear\"\nfilter = \"nearest\""),
    ("shorts", "shorts.png", "wrap = \"clamp\""),
    ("linear shorts", "shorts.png", "color_space = \"linear\"\nfilter = \"nearest\"\nscale = [2, 2]"),
    ("half", "half.exr", "rotation = -100\nfilter = \"nearest\""),
    ("float", "float.exr", ""),
];

/// The patterns: neighbours, channels and rows differ, and alpha is of use.
fn write_images(folder: &Path) {
    let wave = |x: u32, y: u32, channel: u32| 0.5 + 0.45 * f64::from(3 * x + 5 * y + 7 * channel * channel + x * y).sin();
    let texel = |x: u32, y: u32| [0, 1, 2, 3].map(|channel| wave(x, y, channel));
    let bytes = image::RgbaImage::from_fn(7, 5, |x, y| image::Rgba(texel(x, y).map(|value| (255.0 * value) as u8)));
    bytes.save(folder.join("bytes.png")).expect("the image is written");
    let shorts = image::ImageBuffer::from_fn(6, 9, |x, y| image::Rgba(texel(x, y).map(|value| (65_535.0 * value) as u16)));
    shorts.save(folder.join("shorts.png")).expect("the image is written");
    for (file, round) in [("half.exr", true), ("float.exr", false)] {
        let value = |value: f64| {
            let value = value as f32;
            // Sixteen bits: ten digits behind the first.
            if round { f32::from_bits(value.to_bits() & !0x1fff) } else { value }
        };
        let pixel = |x: usize, y: usize| {
            let [red, green, blue, alpha] = texel(x as u32, y as u32).map(value);
            (red, green, blue, alpha)
        };
        exr::prelude::write_rgba_file(folder.join(file), 8, 6, pixel).expect("the image is written");
    }
}

/// A grid of squares, each of a material.
fn grid(materials: &[(&str, String)], folder: &Path) -> Scene {
    let mut text = HEAD.to_owned();
    for (name, file, keys) in TEXTURES {
        text += &format!("[[texture]]\nname = \"{name}\"\ntype = \"image\"\nfile = \"{file}\"\n{keys}\n");
    }
    text += "[[texture]]\nname = \"clouds\"\ntype = \"perlin\"\nscale = 4\na = [0.1, 0.5, 0.9]\nb = [0.9, 0.2, 0.4]\n\
             rotation = 70\noffset = [3, 1]\n\
             [[texture]]\nname = \"product\"\ntype = \"image\"\nfile = \"shorts.png\"\ntimes = \"turned\"\n\
             [[texture]]\nname = \"cloudy\"\ntype = \"checker\"\na = [0.9, 0.5, 0.7]\nb = 0.3\nscale = [3, 3]\ntimes = \"clouds\"\n";
    for (number, (name, keys)) in materials.iter().enumerate() {
        let [x, y] = [number % 6, number / 6].map(|place| place as f64 * 0.5);
        text += &format!(
            "[[material]]\nname = \"{name}\"\n{keys}\n[[shape]]\ntype = \"rectangle\"\nmaterial = \"{name}\"\n\
             corner = [{}, {}, 0]\nedge_u = [0.5, 0, 0]\nedge_v = [0, 0.5, 0.1]\n",
            x - 1.5,
            y - 1.0
        );
    }
    load::load_toml_str(&text, "textures", folder).unwrap_or_else(|error| panic!("{error}"))
}

/// Colours of every image, and every channel of it, as colour, roughness, exponent and weight.
fn everything(folder: &Path) -> Scene {
    write_images(folder);
    let mut materials = Vec::new();
    for (name, ..) in TEXTURES {
        materials.push((name, format!("type = \"diffuse\"\nreflectance = {{ texture = \"{name}\", factor = [1, 0.7, 0.4] }}")));
    }
    let grey = |texture: &str, channel: &str| {
        format!("type = \"diffuse\"\nreflectance = {{ texture = \"{texture}\", channel = \"{channel}\" }}")
    };
    for (name, texture, channel) in [
        ("alpha of bytes", "bytes", "a"),
        ("green of shorts", "shorts", "g"),
        ("alpha of shorts", "shorts", "a"),
        ("blue of half", "half", "b"),
        ("alpha of float", "float", "a"),
        ("blue of clouds", "clouds", "b"),
        ("red of bytes", "turned", "r"),
        ("alpha of a product", "product", "a"),
        ("blue of a product", "cloudy", "b"),
    ] {
        materials.push((name, grey(texture, channel)));
    }
    materials.push((
        "metal",
        "type = \"conductor\"\npreset = \"gold\"\nroughness = { texture = \"codes\", channel = \"g\", factor = 0.8 }".into(),
    ));
    materials.push((
        "wide metal",
        "type = \"conductor\"\npreset = \"gold\"\nalpha = { texture = \"float\", channel = \"b\", factor = 0.6 }".into(),
    ));
    materials.push((
        "shiny",
        "type = \"glossy\"\nreflectance = 0.8\nexponent = { texture = \"linear shorts\", channel = \"b\", factor = 50 }".into(),
    ));
    materials.push((
        "mixed",
        "type = \"blend\"\nmaterials = [\"metal\", \"float\"]\n\
         weight = { type = \"texture\", texture = \"bytes\", channel = \"a\", factor = 0.9 }"
            .into(),
    ));
    materials.push(("product", "type = \"diffuse\"\nreflectance = { texture = \"product\", factor = [1, 0.7, 0.4] }".into()));
    materials.push((
        "mixed by a product",
        "type = \"blend\"\nmaterials = [\"metal\", \"float\"]\n\
         weight = { type = \"texture\", texture = \"product\", channel = \"a\" }"
            .into(),
    ));
    grid(&materials, folder)
}

#[test]
fn every_way_of_keeping_texels_agrees() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = everything(folder.path());
    let kinds: std::collections::BTreeSet<_> = scene
        .textures
        .iter()
        .filter_map(|texture| match &texture.kind {
            gpt::scene::TextureKind::Image(image) => Some((image.image.texels.words(), image.image.texels.code(false))),
            _ => None,
        })
        .collect();
    assert_eq!(kinds.len(), 6, "{kinds:?}");
    for stages in [StageMode::Fused, StageMode::Wavefront] {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        assert_agrees(&format!("textures, {stages:?}"), &scene, &options);
    }
}

/// The texture of an image that is multiplied by another.
fn product(scene: &mut Scene) -> &mut gpt::scene::Texture {
    scene.textures.iter_mut().find(|texture| texture.name == "product").expect("it is there")
}

/// The test must notice another channel, a texture that is turned the other way, one that is not as far away,
/// and other products.
#[test]
#[ignore = "slow"]
fn another_channel_and_another_place_are_noticed() {
    let Some(device) = DEVICE.as_ref() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    let scene = everything(folder.path());
    let faults: [fn(&mut Scene); 5] = [
        |scene| {
            for material in &mut scene.materials {
                if let MaterialKind::Diffuse { reflectance: ColorInput::Channel(input) } = &mut material.kind
                    && input.channel == Channel::A
                {
                    input.channel = Channel::G;
                }
            }
        },
        |scene| scene.textures[1].transform.rotation_degrees *= -1.0,
        |scene| scene.textures[0].transform.offset[1] += 0.2,
        |scene| product(scene).times = None,
        |scene| product(scene).times = Some(0),
    ];
    // The reference has the fault, so that the device needs no kernel for each.
    let mut gpu = gpt::gpu::GpuRenderer::on(device, &scene, &PlanOptions::default()).expect("the scene fits");
    for (number, fault) in faults.into_iter().enumerate() {
        let mut faulty = scene.clone();
        fault(&mut faulty);
        let mut cpu = gpt::cpu::ReferenceRenderer::new(&faulty).expect("the scene is supported");
        let verdict = gpt::verify::compare(&faulty, &mut gpu, &mut cpu, None).expect("both render");
        assert!(!verdict.agrees, "fault {number}");
    }
    assert!(compare_on(device, &scene, &PlanOptions::default()).agrees);
}

/// Texels that one binding cannot hold are looked up in several, and the picture is the same bit for bit.
#[test]
fn texels_in_chunks_give_the_same_picture() {
    let Some(device) = DEVICE.as_ref() else { return };
    let folder = tempfile::tempdir().expect("a temporary folder");
    // Without images of sixteen bits, whose values alone would fill most chunks.
    let scene = {
        write_images(folder.path());
        let colors = |name: &'static str| (name, format!("type = \"diffuse\"\nreflectance = {{ texture = \"{name}\" }}"));
        grid(&["bytes", "codes", "half", "float", "turned"].map(colors), folder.path())
    };
    let options = PlanOptions { stages: Some(StageMode::Fused), ..PlanOptions::default() };
    let (whole, plan) = pixel_bits(device, &scene, &options, 0..4);
    let texels = |plan: &gpt::plan::Plan| plan.chunks.iter().find(|chunks| chunks.array == TEXELS).map(|chunks| chunks.count);
    assert_eq!(texels(&plan), Some(1));
    // Chunks end within images and within the values of their integers.
    let Some(small) = with_limits(|limits| limits.max_array = 500) else { return };
    let (cut, plan) = pixel_bits(&small, &scene, &options, 0..4);
    assert!(texels(&plan) >= Some(6), "{plan}");
    assert!(whole == cut);
}
