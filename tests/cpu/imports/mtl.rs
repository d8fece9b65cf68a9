//! MTL's keys of physically based materials.

use gpt::scene::{BlendWeight, Channel, ColorInput, MaterialKind, Principled};

use super::Folder;

const MODEL: &str = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";

/// The material of a library's keys, and the warnings.
fn material(keys: &str) -> (MaterialKind, Vec<String>) {
    let png = |picture: image::DynamicImage| {
        let mut bytes = std::io::Cursor::new(Vec::new());
        picture.write_to(&mut bytes, image::ImageFormat::Png).expect("memory can be written to");
        bytes.into_inner()
    };
    let with_alpha = png(image::RgbaImage::from_pixel(2, 2, image::Rgba([255, 255, 255, 128])).into());
    let png = png(image::RgbImage::new(2, 2).into());
    let library = format!("newmtl m\nKd 0.5 0.25 0.125\n{keys}\n");
    let folder =
        Folder::new(&[("a.obj", MODEL.as_bytes()), ("a.mtl", library.as_bytes()), ("h.png", &png), ("a.png", &with_alpha)]);
    let scene = folder.valid("a.obj");
    let shape = &scene.shapes[0];
    let id = shape.materials().next().expect("it has one");
    (scene.materials[id].kind.clone(), scene.warnings.clone())
}

fn principled(keys: &str) -> Principled {
    match material(keys) {
        (MaterialKind::Principled(principled), warnings) => {
            assert!(warnings.is_empty(), "{warnings:?}");
            *principled
        }
        (other, _) => panic!("{other:?}"),
    }
}

#[test]
fn sheen_is_read() {
    let with = principled("Pr 0.3\nPs 0.75");
    assert_eq!((with.sheen_color, with.sheen_roughness), (ColorInput::grey(0.75), ColorInput::grey(0.5)));
    assert!(principled("Pr 0.3\nPs 0.75\nmap_Ps h.png").sheen_color.is_texture());
    // Blender writes this where there is no sheen.
    let without = principled("Pr 0.3\nPs 0");
    assert_eq!((without.sheen_color, without.sheen_roughness), (ColorInput::grey(0.0), ColorInput::grey(0.0)));
}

#[test]
fn a_coat_sheen_or_direction_makes_a_material_principled() {
    for keys in ["Ps 0.1", "Pc 0.1", "aniso 0.1", "map_Ps h.png"] {
        principled(keys);
    }
    assert!(matches!(material("Ps 0\nPc 0.0\naniso 0").0, MaterialKind::Diffuse { .. }), "the control");
}

#[test]
fn what_has_no_effect_is_named_once() {
    let (_, warnings) = material("Pr 0.3\nPl 1\nPl 2\ndisp h.png");
    assert_eq!(warnings.len(), 1, "{warnings:?}");
    assert!(warnings[0].contains("keys that have no effect: Pl, disp"), "{warnings:?}");
}

#[test]
fn masks_are_blends_with_what_is_behind() {
    let weight = |keys: &str| match material(keys) {
        (MaterialKind::Blend { weight, .. }, warnings) => {
            assert!(warnings.is_empty(), "{warnings:?}");
            weight
        }
        (other, _) => panic!("{other:?}"),
    };
    let channel = |weight: BlendWeight| match weight {
        BlendWeight::Channel { channel, factor, .. } => (channel, factor),
        other => panic!("{other:?}"),
    };
    assert_eq!(channel(weight("map_d h.png")), (Channel::R, 1.0));
    assert_eq!(channel(weight("map_d a.png")), (Channel::A, 1.0));
    assert_eq!(channel(weight("d 0.5\nmap_d -imfchan g a.png")), (Channel::G, 0.5));
    // Beside a map, 0 says nothing.
    assert_eq!(channel(weight("d 0\nmap_d h.png")), (Channel::R, 1.0));
    assert!(matches!(weight("d 0.5"), BlendWeight::Constant { value: 0.5 }));
    // A map that cannot be read hides nothing.
    let (kind, warnings) = material("map_d absent.png");
    assert!(matches!(kind, MaterialKind::Diffuse { .. }) && warnings.iter().any(|said| said.contains("map_d")), "{warnings:?}");
}
