//! Shapes as triangles, in their own space.

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::mesh::Mesh;

/// Half the side of the square that stands for an infinite plane.
pub const PLANE: f64 = 10_000.0;
/// Segments around a round shape, and half as many from pole to pole of a sphere.
pub const SEGMENTS: u32 = 128;

/// Triangles in place of a shape.
pub struct Tessellated {
    /// Fronts are the shape's fronts, and texture coordinates the shape's, where it has some.
    pub mesh: Arc<Mesh>,
    /// The largest distance between the triangles and the shape, in units of the shape's space; 0 where they are the same.
    pub deviation: f64,
}

impl Tessellated {
    /// Triangles that are the shape itself.
    pub fn exact(mesh: Mesh) -> Self {
        Self { mesh: mesh.into(), deviation: 0.0 }
    }
}

/// The faces of the mesh with one of its materials, and only the vertices that those use.
pub fn part_of(mesh: &Mesh, is_wanted: impl Fn(usize) -> bool) -> Mesh {
    let mut place = vec![None; mesh.positions.len()];
    let mut part = Mesh { smooth: mesh.smooth, ..Mesh::default() };
    for (_, face) in mesh.faces.iter().enumerate().filter(|(index, _)| is_wanted(*index)) {
        let corners = face.map(|vertex| {
            let vertex = vertex as usize;
            *place[vertex].get_or_insert_with(|| {
                part.positions.push(mesh.positions[vertex]);
                part.normals.extend(mesh.normals.get(vertex));
                part.uvs.extend(mesh.uvs.get(vertex));
                part.second_uvs.extend(mesh.second_uvs.get(vertex));
                part.positions.len() as u32 - 1
            })
        });
        part.faces.push(corners);
    }
    part
}

/// A mesh of parallelograms: corner and edges of each, edge_u × edge_v along its front.
pub fn of_quads(quads: &[[DVec3; 3]], has_uvs: bool) -> Mesh {
    let mut mesh = Mesh::default();
    for [corner, edge_u, edge_v] in quads {
        let first = mesh.positions.len() as u32;
        for [u, v] in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] {
            mesh.positions.push((*corner + u * *edge_u + v * *edge_v).as_vec3());
            mesh.uvs.extend(has_uvs.then(|| DVec2::new(u, v).as_vec2()));
        }
        mesh.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    }
    mesh
}

/// A mesh of rows of vertices, which are counter-clockwise along a row and upward from row to row.
pub fn of_rows(columns: u32, rows: u32, vertex: impl Fn(f64, f64) -> [DVec3; 2]) -> Mesh {
    let mut mesh = Mesh { smooth: true, ..Mesh::default() };
    for row in 0..=rows {
        for column in 0..=columns {
            let (u, v) = (f64::from(column) / f64::from(columns), f64::from(row) / f64::from(rows));
            let [position, normal] = vertex(u, v);
            mesh.positions.push(position.as_vec3());
            mesh.normals.push(normal.as_vec3());
            mesh.uvs.push(DVec2::new(u, v).as_vec2());
        }
    }
    for row in 0..rows {
        for column in 0..columns {
            let lower = row * (columns + 1) + column;
            let upper = lower + columns + 1;
            mesh.faces.extend([[lower, lower + 1, upper + 1], [lower, upper + 1, upper]]);
        }
    }
    mesh.drop_degenerate_faces();
    mesh
}

/// The faces turned so that their fronts look along the vertices' normals.
pub fn facing_normals(mut mesh: Mesh) -> Mesh {
    for index in 0..mesh.faces.len() {
        let face = mesh.faces[index];
        let along: DVec3 = face.iter().map(|&vertex| mesh.normals[vertex as usize].as_dvec3()).sum();
        if mesh.face_normal(face).is_some_and(|normal| normal.dot(along) < 0.0) {
            mesh.faces[index] = [face[0], face[2], face[1]];
        }
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::file::shape_examples;
    use crate::load::load_toml_str;
    use crate::scene::{Cuboid, Cylinder, Geometry, Sphere};

    /// Fronts look outward, vertices lie on the shape, and no triangle is farther from it than is said.
    #[test]
    fn round_shapes_are_as_near_as_they_say() {
        let sphere = Sphere { center: DVec3::new(1.0, 2.0, 3.0), radius: 2.0 };
        let Tessellated { mesh, deviation } = Geometry::Sphere(sphere).tessellated();
        let mut deepest = 0.0_f64;
        for &face in &mesh.faces {
            let corners = face.map(|vertex| mesh.positions[vertex as usize].as_dvec3());
            let middle = (corners[0] + corners[1] + corners[2]) / 3.0;
            let normal = mesh.face_normal(face).expect("it has an area");
            assert!(normal.dot(middle - sphere.center) > 0.0);
            // The plane of a triangle is nearest to the middle of the circle through its corners.
            deepest = deepest.max(sphere.radius - (corners[0] - sphere.center).dot(normal));
        }
        assert!(deepest <= deviation * (1.0 + 1e-4) && deepest > 0.4 * deviation, "{deepest} {deviation}");
        let tube = Cylinder { from: DVec3::new(0.0, 1.0, 0.0), to: DVec3::new(1.0, 3.0, 0.5), radius: 0.5 };
        let Tessellated { mesh, deviation } = Geometry::Cylinder(tube).tessellated();
        let axis = (tube.to - tube.from).normalize();
        for &face in &mesh.faces {
            let middle: DVec3 = face.iter().map(|&vertex| mesh.positions[vertex as usize].as_dvec3()).sum::<DVec3>() / 3.0;
            let across = (middle - tube.from).reject_from(axis);
            let normal = mesh.face_normal(face).expect("it has an area");
            assert!(normal.dot(across) > 0.0 && tube.radius - across.length() <= deviation * (1.0 + 1e-4));
        }
    }

    #[test]
    fn every_shape_has_triangles() {
        for (name, keys) in shape_examples() {
            let text = format!(
                "camera = {{ position = [0, 0, 1], look_at = [0, 0, 0], vfov = 40 }}\n[[material]]\nname = \"m\"\ntype = \"emissive\"\n\
                 radiance = 1\n{keys}material = \"m\"\n"
            );
            let scene = load_toml_str(&text, "example", std::path::Path::new("")).unwrap();
            let made = scene.shapes[0].geometry.tessellated();
            assert!(!made.mesh.faces.is_empty() && made.deviation.is_finite(), "{name}");
            assert_eq!(made.deviation > 0.0, scene.shapes[0].geometry.is_round(), "{name}");
        }
    }

    #[test]
    fn parts_have_the_vertices_that_they_use() {
        let made = Geometry::Box(Cuboid { min: DVec3::ZERO, max: DVec3::ONE }).tessellated();
        let whole = &*made.mesh;
        assert_eq!((whole.positions.len(), whole.faces.len()), (24, 12));
        let part = part_of(whole, |face| face >= 10);
        assert_eq!((part.positions.len(), part.uvs.len(), part.faces.len()), (4, 4, 2));
        assert!(part.positions.iter().all(|at| at.z == 1.0), "{part:?}");
        assert_eq!(part_of(whole, |_| true), *whole, "the control");
    }
}
