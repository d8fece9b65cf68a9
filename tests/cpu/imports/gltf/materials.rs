//! Materials of glTF.

use super::*;

/// KHR_materials_sheen and KHR_materials_volume, whose defaults have no effect.
#[test]
fn sheen_and_volumes_are_read() {
    let material = |sheen: Value, volume: Value| {
        let mut file = File::new();
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_sheen": sheen, "KHR_materials_volume": volume });
        file.root["extensionsUsed"] =
            json!(["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_sheen", "KHR_materials_volume"]);
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("sheen") && !report(&scene).contains("volume"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        (**principled).clone()
    };
    let written = material(
        json!({ "sheenColorFactor": [0.5, 0.25, 1.0], "sheenRoughnessFactor": 0.75 }),
        json!({ "thicknessFactor": 1.0, "attenuationColor": [1.0, 0.5, 0.0], "attenuationDistance": 2.5 }),
    );
    assert_eq!(written.sheen_color, ColorInput::Constant(Spectrum::new(0.5, 0.25, 1.0)));
    assert_eq!(written.sheen_roughness, ColorInput::grey(0.75));
    assert_eq!(written.attenuation, Some(Attenuation { color: Spectrum::new(1.0, 0.5, 0.0), distance: 2.5 }));
    let plain = material(json!({}), json!({ "thicknessFactor": 1.0, "attenuationColor": [0.5, 0.5, 0.5] }));
    assert_eq!((plain.sheen_color, plain.attenuation, plain.thin), (ColorInput::grey(0.0), None, false));
}

/// KHR_materials_volume_scatter: of what the attenuation takes, a share is scattered.
#[test]
fn volumes_scatter() {
    let read = |scatter: Value, volume: Value| {
        let mut file = File::new();
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_transmission": { "transmissionFactor": 1.0 }, "KHR_materials_volume_scatter": scatter, "KHR_materials_volume": volume });
        file.root["extensionsUsed"] =
            json!(["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_volume_scatter", "KHR_materials_volume"]);
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        scene
    };
    let volume = || json!({ "thicknessFactor": 1.0, "attenuationColor": [0.5, 0.25, 1.0], "attenuationDistance": 2.0 });
    let milk = json!({ "multiscatterColor": [0.5, 1.0, 0.5], "scatterAnisotropy": -0.25 });
    let scene = read(milk.clone(), volume());
    assert_eq!(report(&scene), "");
    let medium = &scene.media[scene.materials[0].interior.expect("a medium")];
    let extinction = Spectrum::new(0.5_f64.ln() / -2.0, 0.25_f64.ln() / -2.0, 0.0);
    assert!((medium.extinction() - extinction).map(f64::abs).max_component() < 1e-12, "{medium:?}");
    // By the extension's formula, of 0.5 and of 1.
    let albedo = [medium.scattering.r() / extinction.r(), medium.scattering.g() / extinction.g()];
    assert!((albedo[0] - 0.911_708_85).abs() < 1e-8 && (albedo[1] - 1.0).abs() < 1e-9, "{albedo:?}");
    assert_eq!(medium.phase, Phase::of(PhaseKind::HenyeyGreenstein { g: -0.25 }));
    let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
    assert_eq!(principled.attenuation, None, "it would count twice");
    // The controls: one that scatters nothing absorbs, and what cannot be is told.
    let dark = read(json!({ "multiscatterColor": [0, 0, 0] }), volume());
    assert!(dark.media.is_empty() && report(&dark).is_empty());
    assert_ne!(picture(&dark), picture(&scene));
    for volume in [json!({ "thicknessFactor": 1.0 }), json!({ "attenuationColor": [0.5, 0.5, 0.5], "attenuationDistance": 2.0 })]
    {
        let scene = read(milk.clone(), volume);
        assert!(scene.media.is_empty() && report(&scene).contains("KHR_materials_volume_scatter"), "{}", report(&scene));
    }
}

/// A coat has the normals of its own texture, and without one those of the surface, whatever bends the normals below it.
/// KHR_materials_dispersion: 20 over Abbe's number, where light goes into a volume.
#[test]
fn dispersion_is_read() {
    let read = |dispersion: f64, thickness: f64| {
        let mut file = File::new();
        file.root["materials"][0]["extensions"] = json!({
            "KHR_materials_transmission": { "transmissionFactor": 1.0 },
            "KHR_materials_dispersion": { "dispersion": dispersion },
            "KHR_materials_volume": { "thicknessFactor": thickness },
        });
        file.root["extensionsUsed"] =
            json!(["KHR_lights_punctual", "KHR_materials_transmission", "KHR_materials_dispersion", "KHR_materials_volume"]);
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        (principled.iors().map(Spectrum::to_rgb), report(&scene))
    };
    let (iors, told) = read(2.0, 1.0);
    let [red, green, blue] = iors.expect("they differ");
    // Abbe's number is 10: F and C are 0.05 apart about 1.5, and the channels lie at 611, 549 and 464 nm.
    let cauchy = |wavelength: f64| {
        let [c, d, f] = [0.6563_f64, 0.5876, 0.4861].map(|line| line.powi(-2));
        1.5 + 0.05 * (wavelength.powi(-2) - d) / (f - c)
    };
    for (found, wavelength) in [(red, 0.6114), (green, 0.5491), (blue, 0.4642)] {
        assert!((found - cauchy(wavelength)).abs() < 2e-4, "{iors:?} at {wavelength}");
    }
    assert_eq!(told, "");
    // Nothing is bent where there is no volume or no dispersion.
    assert_eq!([read(2.0, 0.0), read(0.0, 1.0)], [(None, String::new()), (None, String::new())]);
    let (iors, told) = read(1e6, 1.0);
    assert!(iors.is_some() && told.contains("KHR_materials_dispersion"), "{told}");
}

#[test]
fn coats_have_normal_maps_of_their_own() {
    let coated = |normal: Option<Value>| {
        let mut file = with_normals();
        let mut coat = json!({ "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1 });
        normal.into_iter().for_each(|normal| coat["clearcoatNormalTexture"] = normal);
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_clearcoat": coat });
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("clearcoat"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        assert!(scene.materials[0].normal_map.is_some());
        (principled.coat_normal_map, picture(&scene))
    };
    let (none, even) = coated(None);
    assert_eq!(none, None);
    let (weak, bent) = coated(Some(json!({ "index": 0, "scale": 0.5 })));
    assert_eq!(weak.map(|map| map.scale), Some(0.5));
    let (full, bent_more) = coated(Some(json!({ "index": 0 })));
    assert_eq!(full.map(|map| map.scale), Some(1.0));
    assert!(even != bent && bent != bent_more, "the pictures are alike");
    // By coordinates of its own.
    let mut file = with_normals();
    let uvs = file.add("VEC2", &[0.3, 0.0, 0.0, 1.0, 1.0, 0.5]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_1"] = json!(uvs);
    file.root["materials"][0]["extensions"] = json!({ "KHR_materials_clearcoat": {
        "clearcoatFactor": 0.9, "clearcoatRoughnessFactor": 0.1, "clearcoatNormalTexture": { "index": 0, "texCoord": 1 } } });
    let scene = file.read();
    let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
    let map = principled.coat_normal_map.expect("it has one");
    assert!(scene.textures[map.texture].by_second_uvs && report(&scene).is_empty(), "{}", report(&scene));
    assert!(picture(&scene) != bent_more, "the pictures are alike");
}

/// Red and green of the texture are the direction, and blue is the strength.
#[test]
fn directions_of_anisotropy_are_read() {
    let brushed = |anisotropy: Value| {
        let mut file = with_normals();
        file.root["materials"][0]["extensions"] = json!({ "KHR_materials_anisotropy": anisotropy });
        let folder = Folder::new(&[("a.gltf", &file.text())]);
        let scene = folder.valid("a.gltf");
        assert!(!report(&scene).contains("anisotropy"), "{}", report(&scene));
        assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        ((**principled).clone(), picture(&scene))
    };
    let (even, plain) = brushed(json!({ "anisotropyStrength": 0.75 }));
    assert_eq!((even.anisotropy, even.anisotropy_direction), (Some(ColorInput::grey(0.75)), None));
    let texture = json!({ "anisotropyStrength": 0.75, "anisotropyRotation": 0.5, "anisotropyTexture": { "index": 0 } });
    let (textured, turned) = brushed(texture);
    let direction = textured.anisotropy_direction.expect("it has a direction");
    let strength = ChannelInput { texture: direction, channel: Channel::B, factor: Spectrum::grey(0.75), is_squared: false };
    assert_eq!(textured.anisotropy, Some(ColorInput::Channel(strength)));
    assert!((textured.anisotropy_rotation_degrees - 0.5_f64.to_degrees()).abs() < 1e-12);
    assert!(plain != turned, "the pictures are alike");
    // Without a strength there is none.
    let (none, _) = brushed(json!({ "anisotropyTexture": { "index": 0 } }));
    assert_eq!((none.anisotropy, none.anisotropy_direction), (None, None));
}

/// A triangle with a normal map of 4 × 4 texels.
fn with_normals() -> File {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let mut png = Vec::new();
    let texels = image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([100 + 30 * x as u8, 90 + 40 * y as u8, 230]));
    texels.write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png).expect("encoding to memory works");
    let picture = file.bytes(&png);
    file.root["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    file.root["textures"] = json!([{ "source": 0 }]);
    file.root["materials"][0] = json!({
        "pbrMetallicRoughness": { "baseColorFactor": [0.7, 0.4, 0.2, 1.0], "metallicFactor": 0.5, "roughnessFactor": 0.6 },
        "normalTexture": { "index": 0, "scale": 2.0 },
        "doubleSided": true,
    });
    file
}

/// One of several materials is chosen by its variant's name; an unknown name is told with those that there are.
#[test]
fn variants_of_materials_are_chosen_by_name() {
    let mut file = File::new();
    let mut green = file.root["materials"][0].clone();
    green["pbrMetallicRoughness"]["baseColorFactor"] = json!([0.1, 0.8, 0.2, 1.0]);
    file.root["materials"].as_array_mut().expect("a list").push(green);
    file.root["extensionsUsed"].as_array_mut().expect("a list").push(json!("KHR_materials_variants"));
    file.root["extensions"]["KHR_materials_variants"] = json!({ "variants": [{ "name": "worn" }, { "name": "new" }] });
    file.root["meshes"][0]["primitives"][0]["extensions"] =
        json!({ "KHR_materials_variants": { "mappings": [{ "material": 1, "variants": [1] }] } });
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let of =
        |variant: &str| folder.load_as("a.gltf", &LoadOptions { variant: Some(variant.to_owned()), ..LoadOptions::default() });
    let red_of = |scene: Scene| match scene.materials[scene.shapes[0].material].kind {
        MaterialKind::Diffuse { reflectance: gpt::scene::ColorInput::Constant(colour) } => colour.r(),
        ref other => panic!("{other:?}"),
    };
    assert_eq!(of("new").map(red_of).ok(), Some(0.1));
    // Primitives that a variant does not mention stay as they are.
    assert_eq!(of("worn").map(red_of).ok(), Some(0.7));
    let plain = folder.valid("a.gltf");
    assert!(report(&plain).contains("--variant chooses worn, new"), "{}", report(&plain));
    assert_eq!(red_of(plain), 0.7);
    let message = refusal(of("old"));
    assert!(message.contains("old") && message.contains("worn") && message.contains("new"), "{message}");
}
