//! Meshes of shapes that scene files do not have, and normals of meshes that come without.

use std::f64::consts::TAU;

use glam::{DVec3, Vec2, Vec3};

use crate::scene::Mesh;

/// Sides of a circle.
const SIDES: u32 = 128;

/// Gives every vertex the mean of its faces' normals, weighted by angle, without joining vertices at the same place: files of other programs
/// give a hard edge two vertices.
pub fn smooth_by_index(mesh: &mut Mesh) {
    let mut sums = vec![DVec3::ZERO; mesh.positions.len()];
    for &face in &mesh.faces {
        let Some(normal) = mesh.face_normal(face) else { continue };
        let corners = face.map(|index| mesh.positions[index as usize].as_dvec3());
        for corner in 0..3 {
            let (at, next, previous) = (corners[corner], corners[(corner + 1) % 3], corners[(corner + 2) % 3]);
            sums[face[corner] as usize] += (next - at).angle_between(previous - at) * normal;
        }
    }
    mesh.normals = sums.into_iter().map(|sum| sum.try_normalize().unwrap_or(DVec3::Y).as_vec3()).collect();
    mesh.smooth = true;
}

/// Fronts become backs.
pub fn turn_inside_out(mesh: &mut Mesh) {
    mesh.faces.iter_mut().for_each(|face| face.swap(1, 2));
    mesh.normals.iter_mut().for_each(|normal| *normal = -*normal);
}

/// Gives every face corners of its own, with these texture coordinates.
pub fn barycentric_coordinates(mesh: &mut Mesh, of_corners: [Vec2; 3]) {
    let corners: Vec<usize> = mesh.faces.iter().flatten().map(|corner| *corner as usize).collect();
    mesh.positions = corners.iter().map(|corner| mesh.positions[*corner]).collect();
    if !mesh.normals.is_empty() {
        mesh.normals = corners.iter().map(|corner| mesh.normals[*corner]).collect();
    }
    mesh.uvs = of_corners.into_iter().cycle().take(corners.len()).collect();
    mesh.faces = (0..mesh.faces.len() as u32).map(|face| [3 * face, 3 * face + 1, 3 * face + 2]).collect();
}

/// A sheet of vertices, `columns` by `rows` quads, that `point` places; with texture coordinates from 0 to 1.
pub fn sheet(columns: u32, rows: u32, point: impl Fn(f64, f64) -> (DVec3, DVec3)) -> Mesh {
    let mut mesh = Mesh { smooth: true, ..Mesh::default() };
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            let (position, normal) = point(u, v);
            mesh.positions.push(position.as_vec3());
            mesh.normals.push(normal.as_vec3());
            mesh.uvs.push(Vec2::new(u as f32, v as f32));
        }
    }
    let width = columns + 1;
    for row in 0..rows {
        for column in 0..columns {
            let a = row * width + column;
            mesh.faces.extend([[a, a + 1, a + width + 1], [a, a + width + 1, a + width]]);
        }
    }
    mesh.drop_degenerate_faces();
    mesh
}

/// The unit sphere about +Z: u is the turn about the axis, v the angle from it over half a turn.
pub fn grid_sphere() -> Mesh {
    let mut mesh = sheet(SIDES, SIDES / 2, |u, v| {
        let ((sine, cosine), (polar_sine, polar_cosine)) = ((TAU * u).sin_cos(), (0.5 * TAU * v).sin_cos());
        let at = DVec3::new(polar_sine * cosine, polar_sine * sine, polar_cosine);
        (at, at)
    });
    // Rows go down while columns turn to the left: seen from outside that is clockwise.
    mesh.faces.iter_mut().for_each(|face| face.swap(1, 2));
    mesh
}

/// The open cylinder of radius 1 about +Z from 0 to 1, its front outside.
pub fn cylinder() -> Mesh {
    sheet(SIDES, 1, |u, v| {
        let (sine, cosine) = (TAU * u).sin_cos();
        (DVec3::new(cosine, sine, v), DVec3::new(cosine, sine, 0.0))
    })
}

/// The unit disk in the plane z = 0 with its front at +Z: u is the distance from the middle, v the turn.
pub fn disk() -> Mesh {
    let mut mesh = sheet(1, SIDES, |u, v| {
        let (sine, cosine) = (TAU * v).sin_cos();
        (DVec3::new(u * cosine, u * sine, 0.0), DVec3::Z)
    });
    mesh.normals.clear();
    mesh.smooth = false;
    mesh
}

/// The square from −1 to 1 in the plane z = 0 with its front at +Z and texture coordinates from 0 to 1.
pub fn square() -> Mesh {
    let mut mesh = Mesh::default();
    side(&mut mesh, Vec3::new(-1.0, -1.0, 0.0), Vec3::X, Vec3::Y);
    mesh
}

/// The cube from −1 to 1 with texture coordinates from 0 to 1 on every side, which lie as Mitsuba has them: seen from outside, mirrored.
pub fn unit_cube() -> Mesh {
    let mut mesh = Mesh::default();
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    // The point where u and v are 0, and the directions in which they grow.
    let sides = [
        (-x - y - z, z, x),
        (x + y + z, -x, -z),
        (x - y + z, y, -z),
        (-x - y + z, y, x),
        (-x - y - z, y, z),
        (-x + y - z, -y, x),
    ];
    sides.into_iter().for_each(|(corner, along_u, along_v)| side(&mut mesh, corner, along_u, along_v));
    mesh
}

/// Adds a square of side 2 whose front is away from the origin, or at +Z around it.
fn side(mesh: &mut Mesh, corner: Vec3, along_u: Vec3, along_v: Vec3) {
    let first = mesh.positions.len() as u32;
    for (u, v) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
        mesh.positions.push(corner + 2.0 * (u * along_u + v * along_v));
        mesh.uvs.push(Vec2::new(u, v));
    }
    let middle = corner + along_u + along_v;
    let outward = if middle == Vec3::ZERO { Vec3::Z } else { middle };
    let faces = [[first, first + 1, first + 2], [first, first + 2, first + 3]];
    let is_turned = along_u.cross(along_v).dot(outward) < 0.0;
    mesh.faces.extend(faces.map(|[a, b, c]| if is_turned { [a, c, b] } else { [a, b, c] }));
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fronts face away from the middle, or along +Z.
    #[test]
    fn fronts_are_outside() {
        for mesh in [grid_sphere(), cylinder(), unit_cube(), disk(), square()] {
            assert!(mesh.faces.len() >= 2 && mesh.uvs.len() == mesh.positions.len());
            for &face in &mesh.faces {
                let normal = mesh.face_normal(face).expect("it has area");
                let middle: DVec3 = face.iter().map(|&index| mesh.positions[index as usize].as_dvec3()).sum::<DVec3>() / 3.0;
                let outward = if mesh.normals.is_empty() && mesh.faces.len() != 12 {
                    DVec3::Z
                } else {
                    middle - DVec3::new(0.0, 0.0, middle.z.clamp(0.0, 1.0) * 0.5)
                };
                assert!(normal.dot(outward) > 0.0, "{face:?}: {normal} at {middle}");
                let mut normals = face.iter().filter_map(|&index| mesh.normals.get(index as usize));
                assert!(normals.all(|at_corner| normal.dot(at_corner.as_dvec3()) > 0.0));
            }
        }
    }

    #[test]
    fn seams_stay_hard() {
        let mut mesh = unit_cube();
        smooth_by_index(&mut mesh);
        assert!(mesh.normals.iter().all(|normal| normal.abs().max_element() == 1.0));
        mesh.compute_smooth_normals();
        assert!(mesh.normals.iter().all(|normal| normal.abs().max_element() < 0.6));
    }
}
