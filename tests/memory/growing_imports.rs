//! Imported scenes of twice the size take twice the work, whichever thing is repeated: elements, attributes, references, buffers, nodes, pictures and
//! names of every format.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::common::files::{folder_with, png_bytes};
use crate::counting::take_turn;
use crate::growth::assert_linear;
use crate::triangle_gltf::gltf;
use gpt::load;

/// Reads a scene of files, the first of which is the scene.
fn read(files: &[(&str, &[u8])]) {
    let folder = folder_with(files);
    let path = folder.path().join(files[0].0);
    load::load(path.to_str()).unwrap_or_else(|error| panic!("{}", error.to_string().chars().take(300).collect::<String>()));
}

fn repeated(count: usize, line: impl Fn(usize) -> String) -> String {
    (0..count).fold(String::new(), |mut text, index| {
        let _ = writeln!(text, "{}", line(index));
        text
    })
}

#[test]
fn pbrt_scenes_of_many_things() {
    let _turn = take_turn();
    type Lines = fn(usize) -> String;
    let nothing: Lines = |_| String::new();
    let rows: [(&str, usize, Lines, Lines); 10] = [
        ("shapes", 2000, |_| "Shape \"sphere\"".to_owned(), nothing),
        ("materials", 1000, |_| "Material \"diffuse\" Shape \"sphere\"".to_owned(), nothing),
        (
            "names of materials",
            1000,
            |i| format!("MakeNamedMaterial \"m{i}\" \"string type\" \"diffuse\""),
            |i| format!("NamedMaterial \"m{i}\" Shape \"sphere\""),
        ),
        (
            "media",
            1000,
            |i| format!("MakeNamedMedium \"m{i}\" \"string type\" \"homogeneous\""),
            |i| format!("MediumInterface \"m{i}\" \"\" Material \"interface\" Shape \"sphere\""),
        ),
        (
            "textures",
            1000,
            |i| format!("Texture \"t{i}\" \"spectrum\" \"checkerboard\""),
            |i| format!("Material \"diffuse\" \"texture reflectance\" \"t{i}\" Shape \"sphere\""),
        ),
        ("blocks", 4000, |_| "AttributeBegin Translate 1 0 0 AttributeEnd".to_owned(), nothing),
        ("blocks within each other", 2000, |_| "AttributeBegin".to_owned(), |_| "AttributeEnd".to_owned()),
        ("objects", 1000, |i| format!("ObjectBegin \"o{i}\" Shape \"sphere\" ObjectEnd"), |i| format!("ObjectInstance \"o{i}\"")),
        ("lights", 1000, |i| format!("LightSource \"point\" \"point3 from\" [ {i} 0 0 ]"), nothing),
        (
            "vertices of a mesh",
            4000,
            |i| if i == 0 { "Shape \"trianglemesh\" \"point3 P\" [".to_owned() } else { format!("{i} {} 0", i * i % 7) },
            |i| if i == 0 { "] \"integer indices\" [".to_owned() } else { format!("0 1 {i}") },
        ),
    ];
    for (what, count, lines, uses) in rows {
        assert_linear(what, count, |count| {
            let used = if what == "vertices of a mesh" { count - 1 } else { count };
            let end = if what == "vertices of a mesh" { "]" } else { "" };
            let scene = format!("WorldBegin\n{}{}{end}\nShape \"disk\"\n", repeated(count, lines), repeated(used, uses));
            read(&[("scene.pbrt", scene.as_bytes())]);
        });
    }
}

#[test]
fn mitsuba_scenes_of_many_things() {
    let _turn = take_turn();
    let png = png_bytes([90, 120, 150]);
    let ball = "<shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>";
    // The lines that stand in the scene so many times, and those that use them.
    type Lines = fn(usize) -> String;
    let nothing: Lines = |_| String::new();
    let rows: [(&str, usize, Lines, Lines); 16] = [
        ("shapes", 1000, |_| "<shape type=\"sphere\"><bsdf type=\"diffuse\"/></shape>".to_owned(), nothing),
        (
            "names of materials",
            1000,
            |i| format!("<bsdf type=\"diffuse\" id=\"m{i}\"/>"),
            |i| format!("<shape type=\"sphere\"><ref id=\"m{i}\"/></shape>"),
        ),
        (
            "media",
            1000,
            |i| format!("<medium type=\"homogeneous\" id=\"m{i}\"/>"),
            |i| format!("<shape type=\"sphere\"><bsdf type=\"null\"/><ref name=\"interior\" id=\"m{i}\"/></shape>"),
        ),
        (
            "references to one",
            1000,
            |i| if i == 0 { "<bsdf type=\"diffuse\" id=\"m\"/>".to_owned() } else { String::new() },
            |_| "<shape type=\"sphere\"><ref id=\"m\"/></shape>".to_owned(),
        ),
        (
            "references ahead",
            1000,
            |i| format!("<shape type=\"sphere\"><ref id=\"m{i}\"/></shape>"),
            |i| format!("<bsdf type=\"diffuse\" id=\"m{i}\"/>"),
        ),
        (
            "aliases",
            1000,
            |i| {
                if i == 0 {
                    "<bsdf type=\"diffuse\" id=\"m\"/><alias id=\"m\" as=\"a0\"/>".to_owned()
                } else {
                    format!("<alias id=\"a{}\" as=\"a{i}\"/>", i - 1)
                }
            },
            |i| format!("<shape type=\"sphere\"><ref id=\"a{i}\"/></shape>"),
        ),
        (
            "parameters",
            2000,
            |i| format!("<default name=\"key{i}\" value=\"{i}\"/>"),
            |i| format!("<shape type=\"sphere\"><float name=\"radius\" value=\"1$key{i}\"/></shape>"),
        ),
        (
            "parameters of one key",
            2000,
            |_| "<default name=\"key\" value=\"1\"/>".to_owned(),
            |_| "<shape type=\"sphere\"><float name=\"radius\" value=\"$key\"/></shape>".to_owned(),
        ),
        (
            "properties of one plugin",
            2000,
            |i| if i == 0 { "<integrator type=\"path\">".to_owned() } else { format!("<float name=\"p{i}\" value=\"1\"/>") },
            |i| if i == 0 { "</integrator>".to_owned() } else { String::new() },
        ),
        (
            "steps of a transform",
            4000,
            |i| {
                if i == 0 {
                    "<shape type=\"sphere\"><transform name=\"to_world\">".to_owned()
                } else {
                    "<translate x=\"0.001\"/>".to_owned()
                }
            },
            |i| if i == 0 { "</transform></shape>".to_owned() } else { String::new() },
        ),
        ("lights", 1000, |i| format!("<emitter type=\"point\"><point name=\"position\" x=\"{i}\"/></emitter>"), nothing),
        (
            "textures of one picture",
            500,
            |_| {
                "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"bitmap\" name=\"reflectance\"><string name=\"filename\" value=\"a.png\"/></texture></bsdf></shape>".to_owned()
            },
            nothing,
        ),
        (
            "checkerboards",
            500,
            |_| {
                "<shape type=\"sphere\"><bsdf type=\"diffuse\"><texture type=\"checkerboard\" name=\"reflectance\"/></bsdf></shape>".to_owned()
            },
            nothing,
        ),
        (
            "blends",
            500,
            |i| {
                format!(
                    "<bsdf type=\"blendbsdf\" id=\"b{i}\"><float name=\"weight\" value=\"0.5\"/><bsdf type=\"diffuse\"/><bsdf type=\"plastic\"/></bsdf>"
                )
            },
            |i| format!("<shape type=\"sphere\"><ref id=\"b{i}\"/></shape>"),
        ),
        (
            "instances",
            1000,
            |i| {
                if i == 0 {
                    "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"/></shape>".to_owned()
                } else {
                    String::new()
                }
            },
            |i| {
                format!(
                    "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\"><translate x=\"{i}\"/></transform></shape>"
                )
            },
        ),
        ("unknown plugins", 500, |i| format!("<texture type=\"unknown{i}\" id=\"u{i}\"/>"), nothing),
    ];
    for (what, size, before, after) in rows {
        assert_linear(what, size, |count| {
            let xml = format!("<scene version=\"3.0.0\">\n{ball}{}{}</scene>", repeated(count, before), repeated(count, after));
            read(&[("scene.xml", xml.as_bytes()), ("a.png", &png)]);
        });
    }
}

fn list(count: usize, item: impl Fn(usize) -> Value) -> Value {
    Value::Array((0..count).map(item).collect())
}

#[test]
fn gltf_scenes_of_many_things() {
    let _turn = take_turn();
    type Fill = fn(&mut Value, usize);
    let shown: Fill = |root, count| {
        root["nodes"] = list(count, |i| json!({ "mesh": i }));
        root["scenes"] = json!([{ "nodes": (0..count).collect::<Vec<_>>() }]);
    };
    type Row = (&'static str, usize, Box<dyn Fn(&mut Value, usize) + Sync>);
    let rows: [Row; 17] = [
        (
            "nodes in a row",
            2000,
            Box::new(|root, count| {
                root["nodes"] = list(count, |i| if i + 1 < count { json!({ "children": [i + 1] }) } else { json!({ "mesh": 0 }) })
            }),
        ),
        (
            "nodes of one mesh",
            2000,
            Box::new(|root, count| {
                root["nodes"] = list(count, |i| json!({ "mesh": 0, "name": "n", "translation": [i, 0, 0] }));
                root["scenes"] = json!([{ "nodes": (0..count).collect::<Vec<_>>() }]);
            }),
        ),
        (
            "meshes",
            1000,
            Box::new(move |root, count| {
                shown(root, count);
                root["meshes"] = list(count, |_| json!({ "name": "m", "primitives": [{ "attributes": { "POSITION": 0 } }] }));
            }),
        ),
        (
            "primitives",
            1000,
            Box::new(|root, count| root["meshes"][0]["primitives"] = list(count, |_| json!({ "attributes": { "POSITION": 0 } }))),
        ),
        (
            "materials of one name",
            1000,
            Box::new(move |root, count| {
                shown(root, count);
                root["materials"] = list(count, |_| json!({ "name": "m" }));
                root["meshes"] = list(count, |i| json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "material": i }] }));
            }),
        ),
        (
            "materials with odd numbers",
            1000,
            Box::new(move |root, count| {
                shown(root, count);
                root["materials"] =
                    list(count, |i| json!({ "name": format!("m{i}"), "pbrMetallicRoughness": { "roughnessFactor": 7 } }));
                root["meshes"] = list(count, |i| json!({ "primitives": [{ "attributes": { "POSITION": 0 }, "material": i }] }));
            }),
        ),
        (
            "textures of one picture",
            500,
            Box::new(move |root, count| {
                shown(root, count);
                root["images"] = json!([{ "uri": "a.png" }]);
                root["textures"] = list(count, |_| json!({ "source": 0 }));
                root["materials"] = list(count, |i| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } }));
                root["meshes"] = list(
                    count,
                    |i| json!({ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": i }] }),
                );
                root["accessors"] = json!([root["accessors"][0], { "componentType": 5126, "count": 3, "type": "VEC2" }]);
            }),
        ),
        (
            "images of one file",
            300,
            Box::new(move |root, count| {
                shown(root, count);
                root["images"] = list(count, |_| json!({ "uri": "a.png" }));
                root["textures"] = list(count, |i| json!({ "source": i }));
                root["materials"] = list(count, |i| json!({ "pbrMetallicRoughness": { "baseColorTexture": { "index": i } } }));
                root["meshes"] = list(
                    count,
                    |i| json!({ "primitives": [{ "attributes": { "POSITION": 0, "TEXCOORD_0": 1 }, "material": i }] }),
                );
                root["accessors"] = json!([root["accessors"][0], { "componentType": 5126, "count": 3, "type": "VEC2" }]);
            }),
        ),
        (
            "accessors and views",
            1000,
            Box::new(move |root, count| {
                shown(root, count);
                root["bufferViews"] = list(count, |_| json!({ "buffer": 0, "byteLength": 36 }));
                root["accessors"] =
                    list(count, |i| json!({ "bufferView": i, "componentType": 5126, "count": 3, "type": "VEC3" }));
                root["meshes"] = list(count, |i| json!({ "primitives": [{ "attributes": { "POSITION": i } }] }));
            }),
        ),
        (
            "buffers",
            1000,
            Box::new(|root, count| {
                let buffer = root["buffers"][0].clone();
                root["buffers"] = list(count, |_| buffer.clone());
            }),
        ),
        (
            "attributes",
            2000,
            Box::new(|root, count| {
                for index in 0..count {
                    root["meshes"][0]["primitives"][0]["attributes"][format!("_A{index}")] = json!(0);
                }
            }),
        ),
        (
            "lights",
            1000,
            Box::new(|root, count| {
                root["extensionsUsed"] = json!(["KHR_lights_punctual"]);
                root["extensions"] =
                    json!({ "KHR_lights_punctual": { "lights": list(count, |_| json!({ "type": "point", "name": "l" })) } });
                root["nodes"] = list(count + 1, |i| {
                    if i == 0 {
                        json!({ "mesh": 0 })
                    } else {
                        json!({ "extensions": { "KHR_lights_punctual": { "light": i - 1 } } })
                    }
                });
                root["scenes"] = json!([{ "nodes": (0..=count).collect::<Vec<_>>() }]);
            }),
        ),
        (
            "cameras",
            1000,
            Box::new(|root, count| {
                root["cameras"] = list(count, |_| json!({ "type": "perspective", "perspective": { "yfov": 0.7, "znear": 0.1 } }));
                root["nodes"] = list(count + 1, |i| {
                    if i == 0 { json!({ "mesh": 0 }) } else { json!({ "camera": i - 1, "name": "c", "translation": [0, 0, 5] }) }
                });
                root["scenes"] = json!([{ "nodes": (0..=count).collect::<Vec<_>>() }]);
            }),
        ),
        (
            "morph targets",
            500,
            Box::new(|root, count| {
                root["meshes"][0]["primitives"][0]["targets"] = list(count, |_| json!({ "POSITION": 0 }));
                root["meshes"][0]["weights"] = list(count, |_| json!(0.001));
            }),
        ),
        (
            "unknown extensions",
            1000,
            Box::new(|root, count| root["extensionsUsed"] = list(count, |i| json!(format!("EXT_unknown_{i}")))),
        ),
        (
            "unknown keys",
            2000,
            Box::new(|root, count| {
                for index in 0..count {
                    root["nodes"][0][format!("key{index}")] = json!(1);
                }
            }),
        ),
        ("scenes", 2000, Box::new(|root, count| root["scenes"] = list(count, |_| json!({ "nodes": [0] })))),
    ];
    let png = png_bytes([90, 120, 150]);
    for (what, size, fill) in &rows {
        assert_linear(what, *size, |count| read(&[("scene.gltf", &gltf(|root| fill(root, count))), ("a.png", &png)]));
    }
}

#[test]
fn ply_models_of_many_things() {
    let _turn = take_turn();
    type Row = (&'static str, usize, fn(usize) -> String);
    let rows: [Row; 4] = [
        ("comments", 20_000, |count| {
            let comments = repeated(count, |i| format!("comment {i}"));
            format!(
                "ply\nformat ascii 1.0\n{comments}element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
            )
        }),
        ("properties", 1000, |count| {
            let properties = repeated(count, |i| format!("property float p{i}"));
            let values = " 0".repeat(count);
            format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n{properties}element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0{values}\n1 0 0{values}\n0 1 0{values}\n3 0 1 2\n"
            )
        }),
        ("elements", 1000, |count| {
            let elements = repeated(count, |i| format!("element e{i} 1\nproperty float a"));
            let values = repeated(count, |_| "1".to_owned());
            format!(
                "ply\nformat ascii 1.0\n{elements}element vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n{values}0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
            )
        }),
        ("faces of two corners", 20_000, |count| {
            let faces = repeated(count, |_| "2 0 1".to_owned());
            format!(
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n{faces}",
                count + 1
            )
        }),
    ];
    for (what, size, text) in rows {
        assert_linear(what, size, |count| read(&[("model.ply", text(count).as_bytes())]));
    }
}
