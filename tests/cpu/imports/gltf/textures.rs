//! Textures and vertex colours of glTF.

use super::*;

#[test]
fn textures_are_turned_with_their_coordinates() {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 0.25]);
    let folder = tempfile::tempdir().expect("a folder");
    image::RgbImage::new(2, 2).save(folder.path().join("a.png")).expect("a picture");
    let picture = file.bytes(&std::fs::read(folder.path().join("a.png")).expect("it is there"));
    file.root["images"] = json!([{ "bufferView": picture, "mimeType": "image/png" }]);
    file.root["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    file.root["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33071, "magFilter": 9728 }]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    let base = &mut file.root["materials"][0]["pbrMetallicRoughness"];
    base["baseColorFactor"] = json!([1.0, 1.0, 1.0, 1.0]);
    base["baseColorTexture"] = json!({ "index": 0 });
    assert_eq!(mesh(&file.read(), 0).uvs, [[0.0, 1.0], [1.0, 1.0], [0.5, 0.75]].map(glam::Vec2::from));
    file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["extensions"] =
        json!({ "KHR_texture_transform": { "offset": [0.25, 0.5], "scale": [2.0, 1.0] } });
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).uvs[2], glam::Vec2::new(1.25, 0.25));
    assert!(matches!(scene.materials[0].kind, MaterialKind::Diffuse { .. }));
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    assert_eq!(super::picture(&folder.valid("a.gltf")), super::picture(&folder.written("a.gltf")));
}

/// A file whose base colour and metallic-roughness pictures, of 2 × 2 texels, lie differently on the triangle.
fn with_two_placements(base: Value, roughness: Value, normal: Option<Value>) -> File {
    let mut file = File::new();
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 1.0]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    file.root["images"] = json!([{ "uri": "a.png" }]);
    file.root["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    file.root["samplers"] = json!([{ "magFilter": 9728 }]);
    let info = |transform: Value| json!({ "index": 0, "extensions": { "KHR_texture_transform": transform } });
    file.root["materials"][0] = json!({ "pbrMetallicRoughness": {
        "baseColorTexture": info(base), "metallicRoughnessTexture": info(roughness) } });
    if let Some(normal) = normal {
        file.root["materials"][0]["normalTexture"] = info(normal);
    }
    file
}

/// An equal scene by hand, each texture with a placement of its own.
fn with_placements_by_hand(base: &str, roughness: &str) -> String {
    let texture = |name: &str, space: &str, placement: &str| {
        format!(
            "[[texture]]\nname = \"{name}\"\ntype = \"image\"\nfile = \"a.png\"\ncolor_space = \"{space}\"\nfilter = \"nearest\"\n{placement}\n"
        )
    };
    format!(
        "[film]\nsize = [512, 256]\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = {}\n{}{}\
         [[material]]\nname = \"a\"\ntype = \"principled\"\nbase_color = {{ texture = \"base\" }}\n\
         metallic = {{ texture = \"orm\", channel = \"b\" }}\nroughness = {{ texture = \"orm\", channel = \"g\" }}\nior = 1.5\n\
         [[shape]]\ntype = \"mesh\"\nmaterial = \"a\"\npositions = [[-1, -1, 0], [1, -1, 0.5], [0, 1, 0]]\nfaces = [[0, 1, 2]]\n\
         uvs = [[0, 1], [1, 1], [0.5, 0]]\n[[light]]\ntype = \"point\"\nposition = [1, 2, 3]\nintensity = [40, 20, 10]\n",
        0.7_f64.to_degrees(),
        texture("base", "srgb", base),
        texture("orm", "linear", roughness),
    )
}

/// By hand: v runs upward here, so that (u, 1 - v) is looked up; a turn of 90 degrees leads (u, v) to (v, -u) there.
#[test]
fn each_texture_lies_as_its_own_transform_says() {
    let base = json!({ "offset": [0.25, 0.5], "scale": [2.0, 3.0] });
    let turned = json!({ "rotation": std::f64::consts::FRAC_PI_2 });
    let mut pixels = image::RgbImage::new(2, 2);
    for (place, colour) in pixels.pixels_mut().zip([[250, 20, 30], [40, 250, 60], [70, 80, 250], [200, 190, 20]]) {
        *place = image::Rgb(colour);
    }
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("memory can be written to");
    let file = with_two_placements(base.clone(), turned.clone(), None);
    let by_hand =
        with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]", "rotation = 90\noffset = [1, 1]");
    let wrong = with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]", "");
    let folder = Folder::new(&[
        ("a.png", &png.into_inner()),
        ("a.gltf", &file.text()),
        ("b.toml", by_hand.as_bytes()),
        ("c.toml", wrong.as_bytes()),
        ("d.gltf", &with_two_placements(base.clone(), base.clone(), None).text()),
        ("e.gltf", &with_two_placements(base.clone(), turned.clone(), Some(turned)).text()),
        ("f.gltf", &with_two_placements(base, json!({}), Some(json!({ "rotation": 0.5 }))).text()),
    ]);
    let scene = folder.valid("a.gltf");
    assert_eq!(report(&scene), "");
    let expected = picture(&folder.valid("b.toml"));
    assert_eq!(picture(&scene), expected);
    assert_eq!(picture(&folder.written("a.gltf")), expected);
    assert_ne!(picture(&folder.valid("c.toml")), expected, "the control");
    // A placement that all textures share is applied to the mesh.
    let alike = folder.valid("d.gltf");
    assert!(mesh(&alike, 0).uvs[1].abs_diff_eq(glam::Vec2::new(2.25, 0.5), 1e-6), "{:?}", mesh(&alike, 0).uvs);
    // A normal map that is turned has the mesh's coordinates, so that its directions are turned as well.
    let turned = folder.valid("e.gltf");
    assert!(mesh(&turned, 0).uvs[1].abs_diff_eq(glam::Vec2::new(0.0, 2.0), 1e-6), "{:?}", mesh(&turned, 0).uvs);
    assert_eq!(report(&turned), "");
    assert!(report(&folder.valid("f.gltf")).contains("KHR_texture_transform of the base colour x1"), "a shear");
}

/// A colour by the second set and a roughness by the first, as by hand; a third set is approximated.
#[test]
fn textures_lie_by_two_sets_of_coordinates() {
    let file = |sets: [u64; 3], normal: bool| {
        let mut file = with_two_placements(
            json!({ "offset": [0.25, 0.5], "scale": [2.0, 3.0], "texCoord": sets[0] }),
            json!({ "texCoord": sets[1] }),
            None,
        );
        for set in [1, 2] {
            let uvs = file.add("VEC2", &[0.3, 0.1, 0.9, 0.4, 0.2, 0.8]);
            file.root["meshes"][0]["primitives"][0]["attributes"][format!("TEXCOORD_{set}")] = json!(uvs);
        }
        if normal {
            file.root["materials"][0]["normalTexture"] = json!({ "index": 0, "texCoord": sets[2] });
        }
        file
    };
    let pixels = image::RgbImage::from_fn(2, 2, |x, y| {
        image::Rgb([(200 - 90 * x) as u8, (60 + 120 * y) as u8, (40 + 70 * x + 90 * y) as u8])
    });
    let mut png = std::io::Cursor::new(Vec::new());
    pixels.write_to(&mut png, image::ImageFormat::Png).expect("memory can be written to");
    let by_hand = |uvs: &str| {
        with_placements_by_hand("scale = [2, 3]\nrotation = 0\noffset = [0.25, -2.5]\nsecond_uvs = true", "")
            .replace("uvs = [[0, 1], [1, 1], [0.5, 0]]", uvs)
    };
    let right = by_hand("uvs = [[0, 1], [1, 1], [0.5, 0]]\nsecond_uvs = [[0.3, 0.9], [0.9, 0.6], [0.2, 0.2]]");
    let wrong = by_hand("uvs = [[0, 1], [1, 1], [0.5, 0]]\nsecond_uvs = [[0.3, 0.9], [0.9, 0.6], [0.2, 0.3]]");
    let without = file([1, 0, 0], false).text();
    let folder = Folder::new(&[
        ("a.png", &png.into_inner()),
        ("a.gltf", &without),
        ("b.toml", right.as_bytes()),
        ("c.toml", wrong.as_bytes()),
        ("d.gltf", &file([0, 1, 1], true).text()),
        ("e.gltf", &file([0, 1, 2], true).text()),
    ]);
    let scene = folder.valid("a.gltf");
    assert_eq!(report(&scene), "");
    // The first texture's set is the mesh's first.
    assert_eq!(scene.textures.iter().filter(|texture| texture.by_second_uvs).count(), 1);
    let expected = picture(&folder.valid("b.toml"));
    assert_eq!(picture(&scene), expected);
    assert_eq!(picture(&folder.written("a.gltf")), expected);
    assert_ne!(picture(&folder.valid("c.toml")), expected, "the control");
    // Directions follow the first set, so that is the normal map's.
    let with_normals = folder.valid("d.gltf");
    assert_eq!(report(&with_normals), "");
    assert_eq!(mesh(&with_normals, 0).uvs[0], glam::Vec2::new(0.3, 0.9));
    assert!(report(&folder.valid("e.gltf")).contains("set of texture coordinates of the"), "{}", report(&folder.valid("e.gltf")));
}

/// The base colour of a painted primitive is a texture of its own, that a scene file says as well.
#[test]
fn vertex_colours_become_a_texture() {
    let mut file = File::new();
    assert!(file.read().textures.is_empty());
    file.paint();
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let scene = folder.valid("a.gltf");
    assert_eq!(scene.textures.len(), 1);
    let painted = &scene.materials[scene.shapes[0].material];
    assert!(painted.kind.lobe().is_some_and(|lobe| lobe.color0.texture() == Some(0)), "{painted:?}");
    let gpt::scene::TextureKind::Image(image) = &scene.textures[0].kind else { panic!("no image") };
    let texels: Vec<_> = image.image.texels.colors().take(3).map(|texel| texel.to_array()).collect();
    assert_eq!(texels, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]]);
    assert_eq!(picture(&folder.written("a.gltf")), picture(&scene));
    assert!(!report(&scene).contains("COLOR_0"));
}

/// Vertex colours multiply the base colour's texture, whatever it is, and their alpha the texture's.
#[test]
fn vertex_colours_multiply_textures() {
    let file = |texture: Option<&str>, alpha: [f32; 3], mode: &str| {
        let mut file = File::new();
        file.paint();
        let colours = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.5, 1.0]];
        let numbers: Vec<f32> = colours.into_iter().zip(alpha).flat_map(|([r, g, b], a)| [r, g, b, a]).collect();
        let colours = file.add("VEC4", &numbers);
        let uvs = file.add("VEC2", &[0.3, 0.1, 0.9, 0.4, 0.2, 0.8]);
        let attributes = &mut file.root["meshes"][0]["primitives"][0]["attributes"];
        attributes["COLOR_0"] = json!(colours);
        attributes["TEXCOORD_0"] = json!(uvs);
        file.root["materials"][0] = json!({ "alphaMode": mode, "pbrMetallicRoughness": { "metallicFactor": 0.0 },
            "extensions": { "KHR_materials_specular": { "specularFactor": 0.0 } } });
        if let Some(uri) = texture {
            file.root["images"] = json!([{ "uri": uri }]);
            file.root["textures"] = json!([{ "source": 0 }]);
            file.root["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = json!({ "index": 0 });
        }
        file.text()
    };
    let picture_of = |colour: [u8; 4]| {
        let mut png = std::io::Cursor::new(Vec::new());
        image::RgbaImage::from_pixel(2, 2, image::Rgba(colour)).write_to(&mut png, image::ImageFormat::Png).expect("it fits");
        png.into_inner()
    };
    let (opaque, seen) = ([1.0; 3], [1.0, 0.5, 0.0]);
    let folder = Folder::new(&[
        ("white.png", &picture_of([255; 4])),
        ("red.png", &picture_of([255, 0, 0, 255])),
        ("clear.png", &picture_of([255, 255, 255, 0])),
        ("plain.gltf", &file(None, opaque, "OPAQUE")),
        ("white.gltf", &file(Some("white.png"), opaque, "OPAQUE")),
        ("red.gltf", &file(Some("red.png"), opaque, "OPAQUE")),
        ("ignored.gltf", &file(Some("white.png"), seen, "OPAQUE")),
        ("seen.gltf", &file(None, seen, "BLEND")),
        ("white-seen.gltf", &file(Some("white.png"), seen, "BLEND")),
        ("clear.gltf", &file(Some("clear.png"), seen, "BLEND")),
        ("nothing.gltf", &file(Some("clear.png"), opaque, "BLEND")),
    ]);
    let white = folder.valid("white.gltf");
    assert_eq!(report(&white), "");
    assert_eq!(white.textures.iter().filter(|texture| texture.times.is_some()).count(), 1);
    let of = |name: &str| picture(&folder.valid(name));
    let plain = of("plain.gltf");
    assert_eq!(picture(&white), plain);
    assert_eq!(picture(&folder.written("white.gltf")), plain);
    assert_eq!(of("ignored.gltf"), plain, "alpha of what is opaque");
    assert_ne!(of("red.gltf"), plain, "the control");
    let green = |name: &str| of(name).iter().map(|pixel| f32::from_bits(pixel[1])).fold(0.0, f32::max);
    assert_eq!(green("red.gltf"), 0.0);
    assert!(green("white.gltf") > 0.0);
    // The surface behind shows through as far as alpha says.
    let seen = of("seen.gltf");
    assert_ne!(seen, plain, "the control");
    assert_eq!(of("white-seen.gltf"), seen);
    assert_eq!(of("clear.gltf"), of("nothing.gltf"));
    assert_ne!(of("clear.gltf"), seen, "the control");
}
