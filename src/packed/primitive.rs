//! The primitives of the packed scene.

use glam::Vec3;

use super::attributes::TriangleAttributes;
use super::constants::NONE;
use super::shape::{PrimitiveGeometry, PrimitiveKind};
use crate::shader::shared::shared_constants;

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
    /// The first of the points that its shape's file makes of it.
    pub p0: [f32; 3],
    /// Bit 31: it moves; kind in the 3 bits below, material in the rest.
    pub kind_and_material: u32,
    pub p1: [f32; 3],
    pub light: u32,
    pub p2: [f32; 3],
    pub attributes: u32,
}

shared_constants!(constants {
    /// Words of a primitive's record.
    pub const PRIMITIVE_RECORD_WORDS: u32 = (size_of::<Primitive>() / 16) as u32;
    /// Words of the record of a triangle's attributes.
    pub const ATTRIBUTE_RECORD_WORDS: u32 = (size_of::<TriangleAttributes>() / 16) as u32;
    /// Kind of a primitive that is an instance, whose number stands in place of the material.
    pub(super) const KIND_INSTANCE: u32 = 7;
    /// Flag beside the kind of a primitive that moves.
    const PRIMITIVE_MOVES: u32 = 1 << 31;
});

/// The kind stands in three bits, of which an instance has the last value.
const _: () = assert!(PrimitiveKind::ALL.len() <= KIND_INSTANCE as usize);

impl WorldPrimitive {
    pub fn new(geometry: PrimitiveGeometry, material: usize) -> Self {
        Self { geometry, material, shape: 0, light: NONE, attributes: NONE, motion: NONE }
    }

    pub fn kind(&self) -> PrimitiveKind {
        self.geometry.kind()
    }

    pub fn is_infinite(&self) -> bool {
        self.kind().is_infinite()
    }

    pub fn moves(&self) -> bool {
        self.motion != NONE
    }

    /// Surface area; infinite for a plane.
    pub fn area(&self) -> f64 {
        self.geometry.area()
    }

    /// Bounds in f32, grown past rounding. Planes have none.
    pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.geometry.bounds()
    }

    pub fn pack(&self) -> Primitive {
        let [p0, p1, p2] = self.geometry.points().map(|point| point.to_array());
        let moves = if self.moves() { PRIMITIVE_MOVES } else { 0 };
        let kind_and_material = moves | (self.kind() as u32) << 28 | self.material as u32;
        Primitive { p0, kind_and_material, p1, light: self.light, p2, attributes: self.attributes }
    }
}

impl Primitive {
    pub fn kind(&self) -> u32 {
        self.kind_and_material >> 28 & 7
    }

    pub fn is(&self, kind: PrimitiveKind) -> bool {
        self.kind() == kind as u32
    }

    pub fn moves(&self) -> bool {
        self.kind_and_material & PRIMITIVE_MOVES != 0
    }

    pub fn material(&self) -> u32 {
        self.kind_and_material & 0x0fff_ffff
    }

    /// The number of the instance that it stands for.
    pub fn instance(&self) -> Option<u32> {
        (self.kind() == KIND_INSTANCE).then(|| self.material())
    }
}
