//! `TANGENT`: directions along which a normal map bends normals, where they are not those in which texture coordinates grow.
//!
//! Meshes have no directions of their own here: directions follow texture coordinates. So what has others gets texture coordinates for them,
//! made for each face, and its textures lie by the second ones, which are those of the file.

use glam::{Vec2, Vec3, Vec4};

use super::importer::Importer;
use super::json::Primitive;
use super::made::Coordinates;
use super::primitive::accessor;
use crate::scene::Mesh;

/// Cosine of the angle up to which directions are taken for those of the texture coordinates: those of smooth meshes are means over faces.
const ALIKE: f32 = 0.98;

impl Importer<'_> {
    /// Gives the mesh of a primitive texture coordinates that grow along its own tangents, if those are others. Whether it did.
    pub fn frame(
        &mut self,
        primitive: &Primitive,
        coordinates: Option<Coordinates>,
        mesh: &mut Mesh,
        can_be_split: bool,
        key: &str,
    ) -> Result<bool, String> {
        let material = primitive.material.and_then(|index| self.root.materials.get(index));
        let uses_directions = |of: &str, key: &str| material.and_then(|material| material.extensions.get(of)?.get(key)).is_some();
        let has_normal_map = material.is_some_and(|material| material.normal_texture.is_some())
            || uses_directions("KHR_materials_clearcoat", "clearcoatNormalTexture")
            || uses_directions("KHR_materials_anisotropy", "anisotropyStrength");
        let Some(index) = accessor(&primitive.attributes, "TANGENT")?.filter(|_| has_normal_map && !mesh.uvs.is_empty()) else {
            return Ok(false);
        };
        let (numbers, _) = self.buffers.numbers(index, &["VEC4"])?;
        let tangents: Vec<Vec4> = numbers.as_chunks::<4>().0.iter().map(|xyzw| Vec4::from_array(*xyzw)).collect();
        if tangents.len() != mesh.positions.len() {
            return Err(format!("there are {} TANGENT for {} positions", tangents.len(), mesh.positions.len()));
        }
        let frames: Vec<Option<Frame>> = mesh.faces.iter().map(|face| Frame::of(mesh, &tangents, *face)).collect();
        let differs = |(face, frame): (&[u32; 3], &Option<Frame>)| frame.is_some_and(|frame| !frame.grows_along(mesh, *face));
        if !mesh.faces.iter().zip(&frames).any(differs) {
            return Ok(false);
        }
        if !can_be_split || coordinates.is_some_and(|coordinates| coordinates.second.is_some()) {
            self.approximate("TANGENT", key, "directions are those in which texture coordinates grow");
            return Ok(false);
        }
        *mesh = split(mesh, &frames);
        Ok(true)
    }
}

/// Directions of a face, of length 1.
#[derive(Clone, Copy)]
struct Frame {
    tangent: Vec3,
    bitangent: Vec3,
}

impl Frame {
    /// Means over the face's corners, in its plane; None where nothing is left of them.
    fn of(mesh: &Mesh, tangents: &[Vec4], face: [u32; 3]) -> Option<Self> {
        let normal = mesh.face_normal(face)?.as_vec3();
        let sum: Vec4 = face.iter().map(|&corner| tangents[corner as usize]).sum();
        let tangent = sum.truncate().reject_from_normalized(normal).try_normalize()?;
        // Written normals may look to the other side.
        let written: Vec3 = face.iter().filter_map(|&corner| mesh.normals.get(corner as usize)).sum();
        let upright = if written.dot(normal) < 0.0 { -normal } else { normal };
        let hand = if sum.w < 0.0 { -1.0 } else { 1.0 };
        Some(Self { tangent, bitangent: upright.cross(tangent) * hand })
    }

    /// The face's texture coordinates grow along these directions.
    fn grows_along(&self, mesh: &Mesh, face: [u32; 3]) -> bool {
        let [a, b, c] = face.map(|corner| mesh.positions[corner as usize]);
        let [uv_a, uv_b, uv_c] = face.map(|corner| mesh.uvs[corner as usize]);
        let ((edge_b, edge_c), (uv_b, uv_c)) = ((b - a, c - a), (uv_b - uv_a, uv_c - uv_a));
        let sign = uv_b.perp_dot(uv_c).signum();
        let along_u = ((edge_b * uv_c.y - edge_c * uv_b.y) * sign).normalize_or_zero();
        let along_v = (edge_c * uv_b.x - edge_b * uv_c.x) * sign;
        uv_b.perp_dot(uv_c) != 0.0 && along_u.dot(self.tangent) > ALIKE && along_v.dot(self.bitangent) > 0.0
    }
}

/// The mesh with corners of their own for each face, and coordinates that grow along the frames before those that it has.
fn split(mesh: &Mesh, frames: &[Option<Frame>]) -> Mesh {
    let mut made = Mesh { smooth: mesh.smooth, ..Mesh::default() };
    for (face, frame) in mesh.faces.iter().zip(frames) {
        let first = made.positions.len() as u32;
        let origin = mesh.positions[face[0] as usize];
        for &corner in face {
            let corner = corner as usize;
            let (position, uv) = (mesh.positions[corner], mesh.uvs[corner]);
            made.positions.push(position);
            made.normals.extend(mesh.normals.get(corner));
            made.second_uvs.push(uv);
            made.uvs.push(frame.map_or(uv, |frame| {
                let from_origin = position - origin;
                Vec2::new(frame.tangent.dot(from_origin), frame.bitangent.dot(from_origin))
            }));
        }
        made.faces.push([first, first + 1, first + 2]);
    }
    made
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coordinates_grow_along_the_frames() {
        let mut mesh = Mesh {
            positions: vec![Vec3::ZERO, Vec3::X * 2.0, Vec3::Y],
            uvs: vec![Vec2::ZERO, Vec2::X, Vec2::Y],
            faces: vec![[0, 1, 2]],
            ..Mesh::default()
        };
        let frame = |tangent: Vec4, mesh: &Mesh| Frame::of(mesh, &[tangent; 3], [0, 1, 2]).expect("a frame");
        assert!(frame(Vec4::new(1.0, 0.0, 0.0, 1.0), &mesh).grows_along(&mesh, [0, 1, 2]));
        for tangent in [Vec4::new(1.0, 0.0, 0.0, -1.0), Vec4::new(0.0, -1.0, 0.0, 1.0), Vec4::new(-0.6, 0.8, 0.0, -1.0)] {
            let own = frame(tangent, &mesh);
            assert!(!own.grows_along(&mesh, [0, 1, 2]));
            assert!(own.grows_along(&split(&mesh, &[Some(own)]), [0, 1, 2]));
        }
        mesh.uvs = vec![Vec2::ZERO; 3];
        assert!(!frame(Vec4::new(1.0, 0.0, 0.0, 1.0), &mesh).grows_along(&mesh, [0, 1, 2]));
    }
}
