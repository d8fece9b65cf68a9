//! The cost of imports: small files that say that they are large, or that name others over and over, are refused in a sentence, within 20 seconds of
//! processor time and in little memory.

use std::io::Write;
use std::time::Duration;

use flate2::Compression;
use flate2::write::{GzEncoder, ZlibEncoder};
use serde_json::json;

use crate::clock;
use crate::common::files::folder_with;
use crate::counting::{Peak, take_turn};
use crate::triangle_gltf::gltf;
use gpt::load;

/// Limits for a scene that is refused.
const MOST_BYTES: usize = 1 << 30;
const MOST_TIME: Duration = Duration::from_secs(20);

/// Reads the first of the files and answers what is said of it, which has to contain `words`.
fn refused(files: &[(&str, &[u8])], words: &str) {
    let folder = folder_with(files);
    let (start, peak) = (clock::of_process(), Peak::from_now());
    let said = match load::load(folder.path().join(files[0].0).to_str()) {
        Ok(_) => panic!("{}: it is read", files[0].0),
        Err(error) => error.to_string(),
    };
    assert!(said.contains(words), "{said}");
    let (time, bytes) = (clock::of_process() - start, peak.bytes());
    assert!(time < MOST_TIME && bytes < MOST_BYTES, "{}: {time:?}, {bytes} bytes: {said}", files[0].0);
}

#[test]
fn parameters_that_stand_for_two_others_each() {
    let _turn = take_turn();
    let scene = |count: usize| {
        let first = "<default name=\"b00\" value=\"0000000000000001\"/>".to_owned();
        let doubled = (1..count).map(|i| format!("<default name=\"b{i:02}\" value=\"$b{0:02}$b{0:02}\"/>", i - 1));
        let use_of_last = format!("<shape type=\"sphere\"><float name=\"radius\" value=\"$b{:02}\"/></shape>", count - 1);
        format!("<scene version=\"3.0.0\">{first}{}{use_of_last}</scene>", doubled.collect::<String>())
    };
    refused(&[("bomb.xml", scene(40).as_bytes())], "longer than the 1024 KiB");
    // The control: one that stands for itself is read.
    let folder = folder_with(&[("scene.xml", scene(1).as_bytes())]);
    assert!(load::load(folder.path().join("scene.xml").to_str()).is_ok());
}

#[test]
fn files_that_are_included_over_and_over() {
    let _turn = take_turn();
    let scene = |within: &str| format!("<scene version=\"3.0.0\">{within}</scene>");
    let spheres = scene(&"<shape type=\"sphere\"/>".repeat(3000));
    let included = scene(&"<include filename=\"spheres.xml\"/>".repeat(900));
    refused(&[("scene.xml", included.as_bytes()), ("spheres.xml", spheres.as_bytes())], "shapes");
}

#[test]
fn files_of_pbrt_that_are_included_over_and_over() {
    let _turn = take_turn();
    let spheres = "Shape \"sphere\"\n".repeat(3000);
    let included = format!("WorldBegin\n{}", "Include \"spheres.pbrt\"\n".repeat(900));
    refused(&[("scene.pbrt", included.as_bytes()), ("spheres.pbrt", spheres.as_bytes())], "shapes");
    let chain = |next: usize| format!("Include \"{next}.pbrt\"\nInclude \"{next}.pbrt\"\n");
    let files: Vec<(String, String)> = (0..30).map(|index| (format!("{index}.pbrt"), chain(index + 1))).collect();
    let start = format!("WorldBegin\n{}", chain(0));
    let last = ("30.pbrt".to_owned(), String::new());
    let all: Vec<(&str, &[u8])> = std::iter::once(("scene.pbrt", start.as_bytes()))
        .chain(files.iter().chain([&last]).map(|(name, text)| (name.as_str(), text.as_bytes())))
        .collect();
    refused(&all, "more than 10000 files");
}

#[test]
fn accessors_without_a_buffer() {
    let _turn = take_turn();
    let zeros = |count: usize| json!({ "componentType": 5126, "count": count, "type": "VEC3" });
    let instances = gltf(|root| {
        root["accessors"] = json!([root["accessors"][0], zeros(10_000_000)]);
        root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": 1 } } });
    });
    refused(&[("instances.gltf", &instances)], "no buffer");
    let primitives = gltf(|root| {
        root["accessors"] = (0..40).map(|_| zeros(1_000_000)).collect();
        root["meshes"][0]["primitives"] = (0..40).map(|index| json!({ "attributes": { "POSITION": index } })).collect();
    });
    refused(&[("primitives.gltf", &primitives)], "no buffer");
}

/// Bytes that many accessors share are not there many times.
#[test]
fn accessors_that_share_their_bytes() {
    let _turn = take_turn();
    let count = 100_000;
    let positions: Vec<u8> = (0..3 * count).flat_map(|index| ((index * 37 % 1000) as f32).to_le_bytes()).collect();
    let shared = gltf(|root| {
        root["buffers"] = json!([{ "uri": "a.bin", "byteLength": positions.len() }]);
        root["bufferViews"][0]["byteLength"] = json!(positions.len());
        root["accessors"][0]["count"] = json!(count);
        // Nothing is made of points.
        root["meshes"][0]["primitives"] =
            (0..100_000).map(|_| json!({ "attributes": { "POSITION": 0 }, "indices": 1 })).collect();
        root["accessors"] =
            json!([root["accessors"][0], { "bufferView": 0, "componentType": 5121, "count": 3, "type": "SCALAR" }]);
    });
    refused(&[("shared.gltf", &shared), ("a.bin", &positions)], "over and over");
}

/// Many textures show one picture, by different samplers.
#[test]
fn textures_of_one_picture_are_looked_through_once() {
    let _turn = take_turn();
    let mut picture = std::io::Cursor::new(Vec::new());
    image::RgbImage::from_fn(1500, 1500, |x, y| image::Rgb([x as u8, y as u8, 7]))
        .write_to(&mut picture, image::ImageFormat::Png)
        .expect("memory");
    let scene = gltf(|root| {
        let count = 300;
        root["nodes"] = (0..count).map(|mesh| json!({ "mesh": mesh })).collect();
        root["scenes"] = json!([{ "nodes": (0..count).collect::<Vec<_>>() }]);
        root["images"] = (0..count).map(|_| json!({ "uri": "a.png" })).collect();
        root["textures"] = (0..count).map(|index| json!({ "source": index, "sampler": index })).collect();
        let wraps = [10_497, 33_071, 33_648];
        root["samplers"] = (0..count).map(|index| json!({ "wrapS": wraps[index % 3] })).collect();
        let look = |index: usize| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": index } } });
        root["materials"] = (0..count).map(look).collect();
        let mesh =
            |index: usize| json!({ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": index }] });
        root["meshes"] = (0..count).map(mesh).collect();
        root["accessors"] = json!([root["accessors"][0], { "componentType": 5126, "count": 3, "type": "VEC2" }]);
    });
    let folder = folder_with(&[("scene.gltf", &scene), ("a.png", picture.get_ref())]);
    let start = clock::of_process();
    let scene = load::load(folder.path().join("scene.gltf").to_str()).unwrap_or_else(|error| panic!("{error}"));
    let time = clock::of_process() - start;
    assert!(time < MOST_TIME && scene.textures.len() == 300, "{time:?}");
}

#[test]
fn scenes_that_are_imported_over_and_over() {
    let _turn = take_turn();
    let count = 100_000;
    let positions: Vec<u8> = (0..3 * count).flat_map(|index| ((index * 37 % 1000) as f32).to_le_bytes()).collect();
    let imported = gltf(|root| {
        root["buffers"] = json!([{ "uri": "a.bin", "byteLength": positions.len() }]);
        root["bufferViews"][0]["byteLength"] = json!(positions.len());
        root["accessors"][0]["count"] = json!(count);
    });
    let scene =
        "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n"
            .to_owned()
            + &"[[import]]\nfile = \"a.gltf\"\n".repeat(2000);
    refused(&[("scene.toml", scene.as_bytes()), ("a.gltf", &imported), ("a.bin", &positions)], "over and over");
}

#[test]
fn buffers_that_are_one_file() {
    let _turn = take_turn();
    let bytes = vec![0; 4 << 20];
    let scene = gltf(|root| {
        root["buffers"] = (0..2000).map(|_| json!({ "uri": "a.bin", "byteLength": bytes.len() })).collect();
    });
    // Nothing of it has area; it is read once.
    refused(&[("buffers.gltf", &scene), ("a.bin", &bytes)], "nothing to render");
}

fn packed_ply(header: &str, megabytes: usize) -> Vec<u8> {
    let mut packer = GzEncoder::new(Vec::new(), Compression::best());
    packer.write_all(header.as_bytes()).expect("memory");
    let zeros = vec![0; 1 << 20];
    (0..megabytes).for_each(|_| packer.write_all(&zeros).expect("memory"));
    packer.finish().expect("memory")
}

#[test]
fn packed_models_of_nothing() {
    let _turn = take_turn();
    let vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let faces = format!(
        "ply\nformat binary_little_endian 1.0\n{vertices}element face 4000000000\nproperty list uchar int vertex_indices\nend_header\n"
    );
    refused(&[("faces.ply.gz", &packed_ply(&faces, 200))], "unpacked, it is more than");
    refused(&[("line.ply.gz", &packed_ply("ply\nformat ascii 1.0\ncomment ", 200))], "PLY");
}

/// Three thousand shapes of one file whose faces have no area.
#[test]
fn meshes_of_nothing_are_read_once() {
    let _turn = take_turn();
    let count = 200_000_u32;
    let mut packer = ZlibEncoder::new(Vec::new(), Compression::best());
    let mut write = |bytes: &[u8]| packer.write_all(bytes).expect("memory");
    write(&0x1000_u32.to_le_bytes());
    write(&[0]);
    write(&u64::from(count).to_le_bytes());
    write(&u64::from(count).to_le_bytes());
    write(&vec![0; 12 * count as usize]);
    (0..count).for_each(|index| [0, 1, 2].iter().for_each(|corner| write(&((index + corner) % count).to_le_bytes())));
    let file = [&[0x1c, 0x04, 4, 0][..], &packer.finish().expect("memory"), &[0; 8], &1_u32.to_le_bytes()].concat();
    let shape = "<shape type=\"serialized\"><string name=\"filename\" value=\"a.serialized\"/></shape>";
    let scene = format!("<scene version=\"3.0.0\">{}</scene>", shape.repeat(3000));
    refused(&[("scene.xml", scene.as_bytes()), ("a.serialized", &file)], "nothing to render");
}
