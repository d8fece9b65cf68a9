//! Meshes as PLY files that read back the same to the last bit.

use std::fmt::Write as _;

use crate::scene::Mesh;

/// The mesh as a binary PLY file. Materials of faces have no place in it.
pub fn write_ply(mesh: &Mesh) -> Vec<u8> {
    let mut header = String::from("ply\nformat binary_little_endian 1.0\n");
    // Writing to a text cannot fail.
    let _ = writeln!(header, "element vertex {}", mesh.positions.len());
    let mut properties = vec!["x", "y", "z"];
    if !mesh.normals.is_empty() {
        properties.extend(["nx", "ny", "nz"]);
    }
    if !mesh.uvs.is_empty() {
        properties.extend(["u", "v"]);
    }
    if !mesh.second_uvs.is_empty() {
        properties.extend(["u1", "v1"]);
    }
    for property in properties {
        let _ = writeln!(header, "property float {property}");
    }
    let _ = writeln!(header, "element face {}\nproperty list uchar uint vertex_indices\nend_header", mesh.faces.len());
    let mut bytes = header.into_bytes();
    for (index, position) in mesh.positions.iter().enumerate() {
        let normal = mesh.normals.get(index).map(|normal| normal.to_array());
        let uv = mesh.uvs.get(index).map(|uv| uv.to_array());
        let numbers = position.to_array().into_iter().chain(normal.into_iter().flatten()).chain(uv.into_iter().flatten());
        let numbers = numbers.chain(mesh.second_uvs.get(index).into_iter().flat_map(|uv| uv.to_array()));
        numbers.for_each(|number| bytes.extend(number.to_le_bytes()));
    }
    for face in &mesh.faces {
        bytes.push(3);
        face.iter().for_each(|corner| bytes.extend(corner.to_le_bytes()));
    }
    bytes
}
