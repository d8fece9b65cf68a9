//! Data of meshes that shading looks up.

use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::normal_map::{Tangents, UvSet};
use super::pose::Pose;
use super::ray::Local;
use super::shape::Triangle;
use crate::scene::{Geometry, Mesh, Shape};
use crate::texture::Coordinates;

/// Data that shading needs of a shape besides its primitives; empty where it is no mesh.
#[derive(Debug, Clone, Default)]
pub struct MeshData {
    /// World-space vertex normals of a smooth mesh, else empty.
    normals: Vec<Vec3>,
    mesh: Option<Arc<Mesh>>,
    /// Faces of a mesh, counter-clockwise seen from the front in the world.
    faces: Vec<[u32; 3]>,
}

impl MeshData {
    pub fn new(shape: &Shape) -> Self {
        let Geometry::Mesh(mesh) = &shape.geometry else { return Self::default() };
        Self {
            normals: if mesh.smooth { shape.world_normals() } else { Vec::new() },
            mesh: Some(mesh.clone()),
            faces: shape.world_faces(),
        }
    }

    /// Second texture coordinates on a face of a mesh that has some.
    pub fn second_uv(&self, face: usize, local: Local) -> Option<DVec2> {
        let [a, b, c] = self.corners(&self.mesh.as_ref()?.second_uvs, face)?;
        Some(a * (1.0 - local.x - local.y) + b * local.x + c * local.y)
    }

    /// Texture coordinates of a face's corners, where there are some.
    pub fn uv_corners(&self, face: usize) -> Option<[DVec2; 3]> {
        self.corners(&self.mesh.as_ref()?.uvs, face)
    }

    /// Both sets of texture coordinates at the corners; the first stands for a second that there is not.
    pub fn coordinates_of_corners(&self, face: usize) -> Option<[Coordinates; 3]> {
        let first = self.uv_corners(face)?;
        let second = self.corners(&self.mesh.as_ref()?.second_uvs, face).unwrap_or(first);
        Some(std::array::from_fn(|corner| Coordinates { first: first[corner], second: second[corner] }))
    }

    /// Directions of one of the sets of texture coordinates on a face of a mesh.
    pub fn tangents(&self, face: usize, triangle: &Triangle, set: UvSet) -> Option<Tangents> {
        let mesh = self.mesh.as_ref()?;
        let uvs = match set {
            UvSet::Second if !mesh.second_uvs.is_empty() => self.corners(&mesh.second_uvs, face)?,
            _ => self.uv_corners(face)?,
        };
        Tangents::of_triangle(triangle.corners.map(|corner| corner.as_dvec3()), uvs)
    }

    fn corners(&self, uvs: &[Vec2], face: usize) -> Option<[DVec2; 3]> {
        let [a, b, c] = self.faces.get(face)?.map(|corner| uvs.get(corner as usize).map(|uv| uv.as_dvec2()));
        Some([a?, b?, c?])
    }

    /// Normal and texture coordinates on a face of a mesh.
    pub fn interpolate(&self, face: usize, local: Local, geometric_normal: DVec3, pose: Option<&Pose>) -> (DVec3, DVec2) {
        let Some(mesh) = &self.mesh else { return (geometric_normal, DVec2::ZERO) };
        let [a, b, c] = self.faces[face].map(|corner| corner as usize);
        let weights = [1.0 - local.x - local.y, local.x, local.y];
        let normal = if self.normals.is_empty() {
            geometric_normal
        } else {
            // Moved one by one, as those of a shape at rest are transformed.
            let corners = [a, b, c].map(|corner| {
                let at_rest = self.normals[corner].as_dvec3();
                pose.map_or(at_rest, |pose| pose.normal(at_rest))
            });
            let sum = corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2];
            sum.try_normalize().unwrap_or(geometric_normal)
        };
        if mesh.uvs.is_empty() {
            return (normal, DVec2::ZERO);
        }
        let corners = [a, b, c].map(|corner| mesh.uvs[corner].as_dvec2());
        (normal, corners[0] * weights[0] + corners[1] * weights[1] + corners[2] * weights[2])
    }
}
