//! Files as older and careless writers left them.

use super::*;

/// A binary file of chunks as they are given, with the lengths that are stated.
fn binary(total: usize, json: (&[u8], usize), data: (&[u8], usize)) -> Vec<u8> {
    let mut bytes = b"glTF".to_vec();
    [2, total, json.1].into_iter().for_each(|number| bytes.extend((number as u32).to_le_bytes()));
    bytes.extend(b"JSON");
    bytes.extend(json.0);
    bytes.extend((data.1 as u32).to_le_bytes());
    bytes.extend(b"BIN\0");
    bytes.extend(data.0);
    bytes
}

/// The JSON of the file with its data in a binary chunk, and the data. The JSON's length is no multiple of 4.
fn parts(file: &File, stated: usize) -> (Vec<u8>, Vec<u8>) {
    let mut root = file.root.clone();
    root["buffers"] = json!([{ "byteLength": stated }]);
    let mut text = root.to_string().into_bytes();
    while text.len() % 4 != 1 {
        text.push(b' ');
    }
    (text, file.data.clone())
}

#[test]
fn containers_that_were_packed_badly_show_the_same() {
    let file = File::new();
    let expected = picture(&file.read());
    let (json, data) = parts(&file, file.data.len());
    let (lengthy, _) = parts(&file, file.data.len() + 3);
    let padded = |bytes: &[u8], with: u8| {
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(4), with);
        padded
    };
    let blank = padded(&json, b' ');
    let zeros = padded(&json, 0);
    let marked = [&b"\xef\xbb\xbf"[..], &blank].concat();
    let total = 28 + blank.len() + data.len();
    let rows = [
        ("as it should be", binary(total, (&blank, blank.len()), (&data, data.len())), false),
        ("padded by zeros", binary(total, (&zeros, zeros.len()), (&data, data.len())), false),
        ("a mark before the JSON", binary(total + 3, (&marked, marked.len()), (&data, data.len())), false),
        ("not padded", binary(28 + json.len() + data.len(), (&json, json.len()), (&data, data.len())), false),
        ("a padding that no length counts", binary(total, (&blank, json.len()), (&data, data.len())), false),
        ("a length of 0", binary(0, (&blank, blank.len()), (&data, data.len())), true),
        ("a length beyond the end", binary(total + 99, (&blank, blank.len()), (&data, data.len())), true),
        ("a chunk beyond the end", binary(total, (&blank, blank.len()), (&data, data.len() + 2)), true),
        (
            "a buffer that counts padding",
            binary(28 + lengthy.len() + data.len(), (&lengthy, lengthy.len()), (&data, data.len())),
            false,
        ),
        (
            "data that are too many",
            binary(total + 8, (&blank, blank.len()), (&[&data[..], &[0; 8]].concat(), data.len() + 8)),
            false,
        ),
    ];
    for (what, bytes, is_told) in rows {
        let scene = Folder::new(&[("a.glb", &bytes)]).valid("a.glb");
        assert_eq!(picture(&scene), expected, "{what}");
        assert_eq!(report(&scene).contains("container"), is_told, "{what}: {}", report(&scene));
    }
    for text in [[b"\xef\xbb\xbf", &file.text()[..]].concat(), [&file.text()[..], b" \r\n\0\0\0"].concat()] {
        assert_eq!(picture(&Folder::new(&[("a.gltf", &text)]).valid("a.gltf")), expected);
    }
}

#[test]
fn numbers_and_nulls_of_loose_writers_are_taken_as_they_are_meant() {
    let file = File::new();
    let expected = picture(&file.read());
    let text = String::from_utf8(file.text()).expect("it is a text");
    let loose = text.replace("\"mesh\":0", "\"mesh\":0.0,\"skin\":null,\"name\":null").replace("\"scene\":0", "\"scene\":0.0");
    assert!(loose != text);
    assert_eq!(picture(&Folder::new(&[("a.gltf", loose.as_bytes())]).valid("a.gltf")), expected);
    // A fraction is no index.
    let wrong = text.replace("\"mesh\":0", "\"mesh\":0.5");
    assert!(refusal(Folder::new(&[("a.gltf", wrong.as_bytes())]).load("a.gltf")).contains("is not valid glTF"));
}

#[test]
fn versions_are_told_plainly() {
    let mut file = File::new();
    file.root["asset"] = json!({ "generator": "by hand" });
    let scene = file.read();
    assert!(report(&scene).contains("asset.version"), "{}", report(&scene));
    file.root.as_object_mut().expect("an object").remove("asset");
    assert!(report(&file.read()).contains("asset.version"));
    file.root["asset"] = json!({ "version": 2.0 });
    assert!(!report(&file.read()).contains("asset.version"));
    // glTF 1.0 has tables, and may forget to say so.
    for asset in [json!({ "version": "1.0" }), json!({}), json!({ "version": "1.1" }), json!({ "version": 0.8 })] {
        let old = json!({ "asset": asset, "nodes": { "a": { "meshes": ["b"] } }, "meshes": { "b": {} }, "scene": "s" });
        let error = Folder::new(&[("a.gltf", old.to_string().as_bytes())]).load("a.gltf").expect_err("it is refused");
        let message = format!("{error} {}", error.help_text().unwrap_or_default());
        assert!(message.contains("is glTF of version") && message.contains("gltf-pipeline"), "{message}");
    }
    let mut first = b"glTF".to_vec();
    [1_u32, 40, 20, 0].into_iter().for_each(|number| first.extend(number.to_le_bytes()));
    first.extend([b' '; 20]);
    let error = Folder::new(&[("a.glb", &first)]).load("a.glb").expect_err("it is refused");
    assert!(
        error.to_string().contains("version 1") && error.help_text().is_some_and(|help| help.contains("gltf-pipeline")),
        "{error}"
    );
}

/// Keys that nothing reads are named, each with its place.
#[test]
fn what_is_not_read_is_named() {
    let mut file = File::new();
    file.root["nodes"][0]["extensions"] = json!({ "ACME_wobble": {}, "KHR_xmp_json_ld": { "packet": 0 } });
    file.root["materials"][0]["shininess"] = json!(4);
    file.root["meshes"][0]["primitives"][0]["attributes"]["COLOR_1"] = json!(0);
    file.root["meshes"][0]["primitives"][0]["attributes"]["_own"] = json!(0);
    file.root["asset"]["copyright"] = json!("nobody");
    file.root["extras"] = json!({ "anything": 1 });
    let scene = file.read();
    let items: Vec<(String, String)> =
        scene.import_report.dropped.iter().map(|item| (item.what.clone(), item.place.clone())).collect();
    let expected = [("COLOR_1", "attributes"), ("`shininess`", "materials[0]"), ("ACME_wobble", "nodes[0].extensions")];
    assert_eq!(items.len(), expected.len(), "{items:?}");
    for (what, place) in expected {
        assert!(items.iter().any(|(found, at)| found == what && at.contains(place)), "{what}: {items:?}");
    }
}
