//! `TANGENT`: the directions in which texture coordinates grow, for materials that need them and have no normal map that says them.

use glam::{Vec3, Vec4};

use crate::scene::Mesh;

/// The mesh with normals at all vertices, and the direction in which u grows at each; v grows to the left of it, seen from the front, where the
/// fourth number is 1.
pub fn with_tangents(mut mesh: Mesh) -> (Mesh, Vec<[f32; 4]>) {
    if !mesh.smooth || mesh.normals.is_empty() {
        mesh.compute_flat_normals();
        mesh.smooth = true;
    }
    let mut sums = vec![(Vec3::ZERO, Vec3::ZERO); mesh.positions.len()];
    for face in &mesh.faces {
        let corners = face.map(|corner| corner as usize);
        let [a, b, c] = corners.map(|corner| mesh.positions[corner]);
        let [uv_a, uv_b, uv_c] = corners.map(|corner| mesh.uvs.get(corner).copied().unwrap_or_default());
        let ((edge_b, edge_c), (uv_b, uv_c)) = ((b - a, c - a), (uv_b - uv_a, uv_c - uv_a));
        let sign = uv_b.perp_dot(uv_c).signum();
        let along_u = ((edge_b * uv_c.y - edge_c * uv_b.y) * sign).normalize_or_zero();
        let along_v = ((edge_c * uv_b.x - edge_b * uv_c.x) * sign).normalize_or_zero();
        for corner in corners {
            sums[corner].0 += along_u;
            sums[corner].1 += along_v;
        }
    }
    let tangent = |((along_u, along_v), normal): (&(Vec3, Vec3), &Vec3)| -> [f32; 4] {
        let normal = normal.normalize_or(Vec3::Y);
        let across = along_u.reject_from_normalized(normal).normalize_or(normal.any_orthonormal_vector());
        let hand = if normal.cross(across).dot(*along_v) < 0.0 { -1.0 } else { 1.0 };
        Vec4::from((across, hand)).to_array()
    };
    let tangents = sums.iter().zip(&mesh.normals).map(tangent).collect();
    (mesh, tangents)
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;

    #[test]
    fn tangents_point_where_u_grows() {
        let positions = vec![Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0)];
        let uvs = vec![Vec2::ZERO, Vec2::Y, Vec2::new(-1.0, 1.0)];
        let mesh = Mesh { positions, uvs, faces: vec![[0, 1, 2]], ..Mesh::default() };
        let (made, tangents) = with_tangents(mesh.clone());
        // u grows downward and v to the right.
        assert_eq!((made.smooth, made.normals[0], tangents[2]), (true, Vec3::Z, [0.0, -1.0, 0.0, 1.0]));
        let mirrored = Mesh { uvs: mesh.uvs.iter().map(|uv| Vec2::new(-uv.x, uv.y)).collect(), ..mesh };
        assert_eq!(with_tangents(mirrored).1[2], [0.0, 1.0, 0.0, -1.0], "the control");
    }
}
