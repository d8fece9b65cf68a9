//! Meshes as PLY files: every number comes back bit for bit.

use std::fmt::Write;

use crate::scene::Mesh;

/// Binary, little-endian. `groups`: a number of each face that stands for its material.
pub fn ply(mesh: &Mesh, groups: Option<&[u32]>) -> Vec<u8> {
    let with_normals = mesh.smooth && !mesh.normals.is_empty();
    let with_uvs = !mesh.uvs.is_empty();
    let mut header = "ply\nformat binary_little_endian 1.0\n".to_owned();
    // Writing to a text cannot fail.
    let _ = writeln!(header, "element vertex {}", mesh.positions.len());
    let mut properties = |names: &[&str]| names.iter().for_each(|name| header += &format!("property float {name}\n"));
    properties(&["x", "y", "z"]);
    if with_normals {
        properties(&["nx", "ny", "nz"]);
    }
    if with_uvs {
        properties(&["u", "v"]);
    }
    if !mesh.second_uvs.is_empty() {
        properties(&["u1", "v1"]);
    }
    let _ = writeln!(header, "element face {}\nproperty list uchar uint vertex_indices", mesh.faces.len());
    if groups.is_some() {
        header += "property uint material_index\n";
    }
    header += "end_header\n";

    let mut bytes = header.into_bytes();
    for index in 0..mesh.positions.len() {
        let mut floats = |values: &[f32]| values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
        floats(&mesh.positions[index].to_array());
        if with_normals {
            floats(&mesh.normals[index].to_array());
        }
        if with_uvs {
            floats(&mesh.uvs[index].to_array());
        }
        if let Some(uv) = mesh.second_uvs.get(index) {
            floats(&uv.to_array());
        }
    }
    for (index, face) in mesh.faces.iter().enumerate() {
        bytes.push(3);
        face.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
        if let Some(groups) = groups {
            bytes.extend(groups[index].to_le_bytes());
        }
    }
    bytes
}
