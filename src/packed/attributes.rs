//! Attributes of a primitive besides its three points.

use glam::{Vec2, Vec3};

use super::constants::NONE;

/// Normals and texture coordinates of a triangle's vertices, and how it moves; 64 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct TriangleAttributes {
    pub n0: [f32; 3],
    pub u0: f32,
    pub n1: [f32; 3],
    pub v0: f32,
    pub n2: [f32; 3],
    pub u1: f32,
    pub v1: f32,
    pub u2: f32,
    pub v2: f32,
    /// First word of its motion, or NONE.
    pub motion: u32,
}

impl TriangleAttributes {
    pub fn new(normals: [Vec3; 3], uvs: [Vec2; 3]) -> Self {
        let [n0, n1, n2] = normals.map(|n| n.to_array());
        let [uv0, uv1, uv2] = uvs;
        Self { n0, u0: uv0.x, n1, v0: uv0.y, n2, u1: uv1.x, v1: uv1.y, u2: uv2.x, v2: uv2.y, motion: NONE }
    }
}
