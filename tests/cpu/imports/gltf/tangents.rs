//! `TANGENT`, and textures that say more than a mesh's coordinates.

use super::*;

/// A picture of one colour.
fn plain(pixel: [u8; 4]) -> Vec<u8> {
    let mut png = std::io::Cursor::new(Vec::new());
    image::RgbaImage::from_pixel(2, 2, image::Rgba(pixel)).write_to(&mut png, image::ImageFormat::Png).expect("it is written");
    png.into_inner()
}

/// A square with a map that bends its normal along the tangent, of rough metal, lit from one side.
fn bent(coordinates: [[f32; 2]; 4], tangent: Option<[f32; 4]>) -> File {
    let mut file = File::new();
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [1.0, 1.0, 0.0], [-1.0, 1.0, 0.0]];
    let order = [0, 1, 2, 0, 2, 3];
    let positions = file.add("VEC3", &order.map(|corner: usize| corners[corner]).concat());
    let uvs = file.add("VEC2", &order.map(|corner: usize| coordinates[corner]).concat());
    let normals = file.add("VEC3", &[[0.0, 0.0, 1.0]; 6].concat());
    let picture = file.bytes(&plain([210, 160, 220, 255]));
    let mut attributes = json!({ "POSITION": positions, "TEXCOORD_0": uvs, "NORMAL": normals });
    if let Some(tangent) = tangent {
        attributes["TANGENT"] = json!(file.add("VEC4", &[tangent; 6].concat()));
    }
    file.root["meshes"][0]["primitives"][0]["attributes"] = attributes;
    file.root["images"] = json!([{ "bufferView": picture }]);
    file.root["textures"] = json!([{ "source": 0 }]);
    file.root["materials"][0] = json!({ "doubleSided": true, "normalTexture": { "index": 0 },
        "pbrMetallicRoughness": { "roughnessFactor": 0.6, "baseColorTexture": { "index": 0 } } });
    file
}

fn brightness(file: &File) -> f64 {
    let scene = file.read();
    let pixels = super::picture(&scene);
    pixels.iter().flatten().map(|bits| f64::from(f32::from_bits(*bits))).sum()
}

/// Directions are those of TANGENT: what has the coordinates that grow so, and no tangents, looks the same.
#[test]
fn tangents_say_along_what_normals_are_bent() {
    // v runs downward in glTF.
    let upright = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
    let turned = [[0.0, 0.0], [0.0, 1.0], [1.0, 1.0], [1.0, 0.0]]; // u along +Y, v upward along −X
    let mirrored = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]; // u along +X, v upward along −Y
    let rows = [([1.0, 0.0, 0.0, 1.0], upright), ([0.0, 1.0, 0.0, 1.0], turned), ([1.0, 0.0, 0.0, -1.0], mirrored)];
    let looks: Vec<f64> = rows
        .iter()
        .map(|(tangent, alike)| {
            let (own, expected) = (brightness(&bent(upright, Some(*tangent))), brightness(&bent(*alike, None)));
            assert!((own / expected - 1.0).abs() < 1e-4, "{tangent:?}: {own} {expected}");
            own
        })
        .collect();
    // The control: they are three different pictures.
    assert!((looks[0] / looks[1] - 1.0).abs() > 1e-2 && (looks[0] / looks[2] - 1.0).abs() > 1e-2, "{looks:?}");
    let folder = Folder::new(&[("a.gltf", &bent(upright, Some([0.0, 1.0, 0.0, 1.0])).text())]);
    assert_eq!(super::picture(&folder.valid("a.gltf")), super::picture(&folder.written("a.gltf")));
}

#[test]
fn wrapping_differs_between_s_and_t() {
    let mut file = bent([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], None);
    file.root["textures"][0]["sampler"] = json!(0);
    file.root["samplers"] = json!([{ "wrapS": 33071, "wrapT": 33648, "minFilter": 9984 }]);
    let folder = Folder::new(&[("a.gltf", &file.text())]);
    let scene = folder.valid("a.gltf");
    let gpt::scene::TextureKind::Image(image) = &scene.textures[0].kind else { panic!("no image") };
    assert_eq!(image.wrap, [gpt::scene::TextureWrap::Clamp, gpt::scene::TextureWrap::Mirror]);
    assert_eq!(image.filter, gpt::scene::TextureFilter::Nearest);
    assert_eq!(report(&scene), "");
    assert_eq!(super::picture(&folder.written("a.gltf")), super::picture(&scene));
}

/// A texture that cannot be read has another colour in its place, and is told.
#[test]
fn pictures_that_cannot_be_read_have_stand_ins() {
    let broken: &[u8] = &[0x89, b'P', b'N', b'G', 1, 2, 3];
    let base64 = |bytes: &[u8]| base64::engine::general_purpose::STANDARD.encode(bytes);
    let rows = [
        ("a file that is missing", json!([{ "uri": "absent.png" }]), false),
        ("a file that is broken", json!([{ "uri": "broken.png" }]), true),
        ("data that are broken", json!([{ "uri": format!("data:image/png;base64,{}", base64(broken)) }]), true),
        ("no base64", json!([{ "uri": "data:image/png;base64,?" }]), false),
        ("another machine", json!([{ "uri": "https://example.com/a.png" }]), false),
        ("another format", json!([{ "uri": format!("data:image/ktx2;base64,{}", base64(b"\xabKTX 20\xbb\r\n\x1a\n")) }]), false),
        ("nothing", json!([{}]), false),
        ("no image", json!([]), false),
    ];
    for (what, images, is_found_late) in rows {
        let mut file = bent([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], None);
        file.root["materials"][0]["pbrMetallicRoughness"] = json!({ "baseColorTexture": { "index": 0 }, "roughnessFactor": 0.5,
            "metallicRoughnessTexture": { "index": 0 } });
        file.root["images"] = images;
        let folder = Folder::new(&[("a.gltf", &file.text()), ("broken.png", broken)]);
        let scene = folder.valid("a.gltf");
        let colour = |at: usize| match scene.textures[at].kind {
            gpt::scene::TextureKind::Image(ref image) => image.mean(),
            ref other => other.mean(),
        };
        let colours: Vec<Spectrum> = (0..scene.textures.len()).map(colour).collect();
        for expected in [Spectrum::new(1.0, 0.0, 1.0), Spectrum::WHITE, Spectrum::new(0.5, 0.5, 1.0)] {
            assert!(colours.iter().any(|colour| colour.distance(expected) < 1e-4), "{what}: {colours:?}");
        }
        assert!(scene.warnings.iter().any(|warning| warning.contains("stands for it")), "{what}: {:?}", scene.warnings);
        let strict = LoadOptions { strict: true, ..LoadOptions::default() };
        assert!(folder.load_as("a.gltf", &strict).is_err(), "{what}");
        if !is_found_late {
            assert!(report(&scene).contains("picture that cannot be read"), "{what}: {}", report(&scene));
        }
        assert_eq!(super::picture(&folder.written("a.gltf")), super::picture(&scene), "{what}");
    }
    // The bytes say what a picture is, whatever its name and its type say.
    let mut file = bent([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]], None);
    file.root["images"][0]["mimeType"] = json!("image/jpeg");
    assert_eq!((report(&file.read()), file.read().warnings.len()), (String::new(), 0));
}

/// KHR_materials_pbrSpecularGlossiness: reflectances along the normal, and 1 less the glossiness.
#[test]
fn specular_and_glossiness_take_the_place_of_metal_and_roughness() {
    let mut file = File::new();
    let glossy = |file: &mut File, glossy: Value| {
        file.root["materials"][0] = json!({ "doubleSided": true, "pbrMetallicRoughness": { "baseColorFactor": [0.0, 1.0, 0.0, 1.0] },
            "extensions": { "KHR_materials_pbrSpecularGlossiness": glossy } });
        let scene = file.read();
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("{:?}", scene.materials[0]) };
        assert_eq!(report(&scene), "");
        (**principled).clone()
    };
    let made = glossy(
        &mut file,
        json!({ "diffuseFactor": [0.5, 0.25, 0.1, 1.0], "specularFactor": [0.2, 0.3, 0.4], "glossinessFactor": 0.75 }),
    );
    let reflected = |ior: f64| ((ior - 1.0) / (ior + 1.0)).powi(2);
    let ColorInput::Constant(specular) = made.specular_color else { panic!("{:?}", made.specular_color) };
    assert_eq!((made.base_color, made.roughness), (ColorInput::Constant(Spectrum::new(0.5, 0.25, 0.1)), ColorInput::grey(0.25)));
    assert_eq!(made.metallic, ColorInput::grey(0.0));
    assert!((specular * reflected(made.ior)).distance(Spectrum::new(0.2, 0.3, 0.4)) < 1e-9, "{specular} {}", made.ior);
    let made = glossy(&mut file, json!({}));
    assert_eq!((made.base_color, made.roughness), (ColorInput::grey(1.0), ColorInput::grey(0.0)));
    // Alpha of the texture is glossiness.
    let picture = file.bytes(&plain([128, 128, 128, 102]));
    let uvs = file.add("VEC2", &[0.0, 0.0, 1.0, 0.0, 0.5, 0.25]);
    file.root["meshes"][0]["primitives"][0]["attributes"]["TEXCOORD_0"] = json!(uvs);
    file.root["images"] = json!([{ "bufferView": picture }]);
    file.root["textures"] = json!([{ "source": 0 }]);
    let made = glossy(&mut file, json!({ "glossinessFactor": 0.5, "specularGlossinessTexture": { "index": 0 } }));
    let texture = made.roughness.texture().expect("a texture");
    let gpt::scene::TextureKind::Image(image) = &file.read().textures[texture].kind else { panic!("no image") };
    // 1 − 0.5 · 102/255
    assert!((image.mean().r() - 0.8).abs() < 2e-3, "{}", image.mean());
}

/// An index of refraction of 0 stands for a surface that reflects all that its specular colour says.
#[test]
fn an_index_of_nothing_reflects_everything() {
    let reflectance = |ior: f64| {
        let mut file = File::new();
        file.root["materials"][0] = json!({ "doubleSided": true, "pbrMetallicRoughness": { "metallicFactor": 0.0 },
            "extensions": { "KHR_materials_ior": { "ior": ior }, "KHR_materials_specular": { "specularColorFactor": [0.5, 0.5, 0.5] } } });
        let scene = file.read();
        let MaterialKind::Principled(principled) = &scene.materials[0].kind else { panic!("no principled") };
        let ColorInput::Constant(colour) = principled.specular_color else { panic!("no colour") };
        (((principled.ior - 1.0) / (principled.ior + 1.0)).powi(2) * colour.r(), report(&scene))
    };
    for (ior, expected, is_told) in
        [(0.0, 0.5, false), (1.5, 0.02, false), (1.0, 0.0, false), (0.5, 0.0, true), (39.0, 0.45125, true)]
    {
        let (found, report) = reflectance(ior);
        assert!((found - expected).abs() < 1e-9 && report.is_empty() != is_told, "{ior}: {found} {report}");
    }
}
