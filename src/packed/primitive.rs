//! The primitives of the packed scene.

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::constants::NONE;
use crate::math::outward;
use crate::shader::shared::{shared_constants, shared_kinds};

shared_kinds! {
    /// What a primitive is.
    pub enum PrimitiveKind {
        Triangle = 0 as KIND_TRIANGLE,
        Quad = 1 as KIND_QUAD,
        Sphere = 2 as KIND_SPHERE,
        Disk = 3 as KIND_DISK,
        Plane = 4 as KIND_PLANE,
    }
}

/// Where a primitive is, in world space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum PrimitiveGeometry {
    /// Already f32: vertices shared between triangles must round alike.
    Triangle([Vec3; 3]),
    Quad {
        corner: DVec3,
        edge_u: DVec3,
        edge_v: DVec3,
    },
    Sphere {
        center: DVec3,
        radius: f64,
    },
    Disk {
        center: DVec3,
        normal: DVec3,
        radius: f64,
    },
    Plane {
        point: DVec3,
        normal: DVec3,
    },
}

/// A primitive before packing.
#[derive(Debug, Clone, Copy)]
pub struct WorldPrimitive {
    pub geometry: PrimitiveGeometry,
    /// Index into the scene's materials, in the end into the packed ones.
    pub material: usize,
    /// Index into the scene's shapes.
    pub shape: usize,
    /// Index of the light it is, or NONE.
    pub light: u32,
    /// Index into the attributes, or NONE.
    pub attributes: u32,
    /// Index of its shape's motion, or NONE. What moves has attributes.
    pub motion: u32,
}

/// 48 bytes: three points and, in their fourth words, what belongs to the primitive.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct Primitive {
    /// First vertex, corner, center, center or point.
    pub p0: [f32; 3],
    /// Bit 31: it moves; kind in the 3 bits below, material in the rest.
    pub kind_and_material: u32,
    /// Second vertex, edge u, (radius, 0, 0), normal or normal.
    pub p1: [f32; 3],
    pub light: u32,
    /// Third vertex, edge v, -, (radius, 0, 0), -.
    pub p2: [f32; 3],
    pub attributes: u32,
}

shared_constants!(constants {
    /// Words of a primitive's record.
    pub const PRIMITIVE_RECORD_WORDS: u32 = (size_of::<Primitive>() / 16) as u32;
    /// Words of the record of a triangle's attributes.
    pub const ATTRIBUTE_RECORD_WORDS: u32 = (size_of::<TriangleAttributes>() / 16) as u32;
    /// Flag beside the kind of a primitive that moves.
    const PRIMITIVE_MOVES: u32 = 1 << 31;
    /// Quads overlap their neighbours by this share of their edges.
    const QUAD_OVERLAP: f32 = 1.0e-6;
});

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

impl PrimitiveGeometry {
    /// Where a motion takes it. Round shapes are scaled by the same factor along every axis.
    pub fn moved(&self, map: &DAffine3) -> Self {
        let scale = map.matrix3.x_axis.length();
        let point = |p: DVec3| map.transform_point3(p);
        let vector = |v: DVec3| map.transform_vector3(v);
        match *self {
            Self::Triangle(corners) => Self::Triangle(corners.map(|corner| point(corner.as_dvec3()).as_vec3())),
            Self::Quad { corner, edge_u, edge_v } => {
                Self::Quad { corner: point(corner), edge_u: vector(edge_u), edge_v: vector(edge_v) }
            }
            Self::Sphere { center, radius } => Self::Sphere { center: point(center), radius: radius * scale },
            Self::Disk { center, normal, radius } => {
                Self::Disk { center: point(center), normal: vector(normal) / scale, radius: radius * scale }
            }
            // Planes never move.
            Self::Plane { point, normal } => Self::Plane { point, normal },
        }
    }

    /// Bounds in f32, grown past rounding. Planes have none.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        match *self {
            Self::Triangle([a, b, c]) => Some(outward(a.min(b).min(c).as_dvec3(), a.max(b).max(c).as_dvec3())),
            Self::Quad { corner, edge_u, edge_v } => {
                let zero = DVec3::ZERO;
                let low = edge_u.min(zero) + edge_v.min(zero);
                let high = edge_u.max(zero) + edge_v.max(zero);
                let overlap = (edge_u.abs() + edge_v.abs()) * (2.0 * f64::from(QUAD_OVERLAP));
                Some(outward(corner + low - overlap, corner + high + overlap))
            }
            Self::Sphere { center, radius } => Some(outward(center - radius, center + radius)),
            Self::Disk { center, normal, radius } => {
                let reach = (DVec3::ONE - normal * normal).max(DVec3::ZERO).map(f64::sqrt) * radius;
                Some(outward(center - reach, center + reach))
            }
            Self::Plane { .. } => None,
        }
    }
}

impl WorldPrimitive {
    pub fn new(geometry: PrimitiveGeometry, material: usize) -> Self {
        Self { geometry, material, shape: 0, light: NONE, attributes: NONE, motion: NONE }
    }

    pub fn kind(&self) -> PrimitiveKind {
        match self.geometry {
            PrimitiveGeometry::Triangle(_) => PrimitiveKind::Triangle,
            PrimitiveGeometry::Quad { .. } => PrimitiveKind::Quad,
            PrimitiveGeometry::Sphere { .. } => PrimitiveKind::Sphere,
            PrimitiveGeometry::Disk { .. } => PrimitiveKind::Disk,
            PrimitiveGeometry::Plane { .. } => PrimitiveKind::Plane,
        }
    }

    pub fn is_plane(&self) -> bool {
        self.kind() == PrimitiveKind::Plane
    }

    pub fn moves(&self) -> bool {
        self.motion != NONE
    }

    /// Surface area; infinite for a plane.
    pub fn area(&self) -> f64 {
        use std::f64::consts::PI;
        match self.geometry {
            PrimitiveGeometry::Triangle([a, b, c]) => {
                0.5 * (b.as_dvec3() - a.as_dvec3()).cross(c.as_dvec3() - a.as_dvec3()).length()
            }
            PrimitiveGeometry::Quad { edge_u, edge_v, .. } => edge_u.cross(edge_v).length(),
            PrimitiveGeometry::Sphere { radius, .. } => 4.0 * PI * radius * radius,
            PrimitiveGeometry::Disk { radius, .. } => PI * radius * radius,
            PrimitiveGeometry::Plane { .. } => f64::INFINITY,
        }
    }

    /// Bounds in f32, grown past rounding. Planes have none.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.geometry.bounds()
    }

    pub fn pack(&self) -> Primitive {
        let single = |v: DVec3| v.as_vec3().to_array();
        let (p0, p1, p2) = match self.geometry {
            PrimitiveGeometry::Triangle([a, b, c]) => (a.to_array(), b.to_array(), c.to_array()),
            PrimitiveGeometry::Quad { corner, edge_u, edge_v } => (single(corner), single(edge_u), single(edge_v)),
            PrimitiveGeometry::Sphere { center, radius } => (single(center), [radius as f32, 0.0, 0.0], [0.0; 3]),
            PrimitiveGeometry::Disk { center, normal, radius } => (single(center), single(normal), [radius as f32, 0.0, 0.0]),
            PrimitiveGeometry::Plane { point, normal } => (single(point), single(normal), [0.0; 3]),
        };
        let moves = if self.moves() { PRIMITIVE_MOVES } else { 0 };
        let kind_and_material = moves | (self.kind() as u32) << 28 | self.material as u32;
        Primitive { p0, kind_and_material, p1, light: self.light, p2, attributes: self.attributes }
    }
}

impl Primitive {
    pub fn kind(&self) -> u32 {
        self.kind_and_material >> 28 & 7
    }

    pub fn moves(&self) -> bool {
        self.kind_and_material & PRIMITIVE_MOVES != 0
    }

    pub fn material(&self) -> u32 {
        self.kind_and_material & 0x0fff_ffff
    }
}
