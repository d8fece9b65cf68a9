//! Meshes of glTF.

use super::*;

#[test]
fn copies_of_instances_stand_where_they_say() {
    let mut file = File::new();
    let translations = file.add("VEC3", &[1.0, 0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 3.0]);
    file.root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    let scene = file.read();
    let places: Vec<glam::DVec3> = scene.shapes.iter().map(|shape| shape.origin()).collect();
    assert_eq!(places, [glam::DVec3::X, glam::DVec3::Y * 2.0, glam::DVec3::Z * 3.0]);
}

/// Many copies of a mesh, by an extension and by nodes, are stored once; a mesh that gives light is not.
#[test]
fn meshes_that_stand_in_many_places_become_instances() {
    let mut file = File::new();
    let places: Vec<f32> = (0..1002).flat_map(|index| [index as f32, 0.0, 0.5]).collect();
    let translations = file.add("VEC3", &places);
    file.root["nodes"][0]["extensions"] = json!({ "EXT_mesh_gpu_instancing": { "attributes": { "TRANSLATION": translations } } });
    let nodes = file.root["nodes"].as_array_mut().expect("a list");
    nodes.push(json!({ "mesh": 0, "scale": [-2.0, 1.0, 1.0] }));
    file.root["scenes"][0]["nodes"] = json!([0, 1, 2, 3]);
    let scene = file.read();
    assert_eq!((scene.shapes.len(), scene.groups.len(), scene.instance_count()), (0, 1, 1003));
    let maps: Vec<glam::DAffine3> = scene.instances[0].maps().collect();
    assert_eq!(maps[7].translation, glam::DVec3::new(7.0, 0.0, 0.5));
    assert_eq!(maps[1002].matrix3.determinant(), -2.0);
    file.root["materials"][0]["emissiveFactor"] = json!([1.0, 1.0, 1.0]);
    let lamps = file.read();
    assert_eq!((lamps.shapes.len(), lamps.instance_count()), (1003, 0));
}

#[test]
fn strips_indices_and_sparse_values_are_read() {
    let mut file = File::new();
    let indices = file.bytes(&[0, 0, 1, 0, 2, 0, 0, 0]);
    let indices = file.enter(json!({ "bufferView": indices, "componentType": 5123, "type": "SCALAR", "count": 3 }));
    file.root["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    file.root["meshes"][0]["primitives"][0]["mode"] = json!(5);
    let places = file.bytes(&[2, 0, 0, 0]);
    let values: Vec<u8> = [0.0_f32, 5.0, 0.0].iter().flat_map(|number| number.to_le_bytes()).collect();
    let values = file.bytes(&values);
    file.root["accessors"][0]["sparse"] = json!({
        "count": 1, "indices": { "bufferView": places, "componentType": 5121 }, "values": { "bufferView": values },
    });
    let scene = file.read();
    assert_eq!(mesh(&scene, 0).positions[2], glam::Vec3::new(0.0, 5.0, 0.0));
    assert_eq!(mesh(&scene, 0).faces, [[0, 1, 2]]);
    file.root["accessors"][0]["sparse"]["count"] = json!(2);
    assert!(file.refused().contains("do not fit"));
}

#[test]
fn quantized_numbers_are_fractions() {
    let mut file = File::new();
    let bytes = file.bytes(&[0, 0, 0, 0, 0xff, 0x7f, 0, 0, 0, 0, 0, 0, 0, 0, 0xff, 0x7f, 0, 0, 0, 0]);
    file.root["bufferViews"][bytes]["byteStride"] = json!(8);
    let quantized = json!({ "bufferView": bytes, "componentType": 5122, "type": "VEC3", "count": 2, "normalized": true });
    file.root["accessors"][0] = quantized;
    // Two vertices are too few for a triangle.
    assert!(report_or_refusal(&file).contains("nothing to render"));
    let bytes = file.bytes(&[0, 0, 0, 0, 127, 0, 0, 0, 0, 127, 0, 0]);
    file.root["bufferViews"][bytes]["byteStride"] = json!(4);
    file.root["accessors"][0] =
        json!({ "bufferView": bytes, "componentType": 5120, "type": "VEC3", "count": 3, "normalized": true });
    assert_eq!(mesh(&file.read(), 0).positions, [glam::Vec3::ZERO, glam::Vec3::X, glam::Vec3::Y]);
}
