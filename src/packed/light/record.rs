//! The record of a light in the device's tables.

use glam::DVec3;

use crate::packed::constants::NONE;
use crate::shader::shared::{Constants, shared_constants, shared_kinds};

shared_kinds! {
    /// What a light is. The first four kinds are those of primitives.
    pub enum LightKind {
        Triangle = 0 as LIGHT_TRIANGLE,
        Quad = 1 as LIGHT_QUAD,
        Sphere = 2 as LIGHT_SPHERE,
        Disk = 3 as LIGHT_DISK,
        Point = 4 as LIGHT_POINT,
        Environment = 5 as LIGHT_ENVIRONMENT,
        Spot = 6 as LIGHT_SPOT,
        Directional = 7 as LIGHT_DIRECTIONAL,
        /// Of any of the first four kinds, from bit `PORTAL_SHIFT` on.
        Portal = 8 as LIGHT_PORTAL,
    }
}

shared_constants!(flags {
    /// Words of a light in the tables.
    pub const LIGHT_WORDS: u32 = (size_of::<PackedLight>() / 16) as u32;
    pub(in crate::packed) const LIGHT_TWO_SIDED: u32 = 256;
    /// The radiance is that of the whole material, seen from where the light goes.
    pub(in crate::packed) const LIGHT_VARIES: u32 = 512;
    /// Its points move as its attributes say.
    pub(in crate::packed) const LIGHT_MOVES: u32 = 1024;
    /// Of a portal: where the kind of its shape stands.
    pub(in crate::packed) const PORTAL_SHIFT: u32 = 12;
});

/// Kinds, flags and sizes, for WGSL.
pub fn constants() -> Constants {
    [LightKind::constants(), flags()].concat()
}

/// 80 bytes, the layout of `light_word` in `shaders/shading/light_record.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedLight {
    pub kind_and_flags: u32,
    pub alias_threshold: u32,
    pub alias: u32,
    /// Probability of being chosen.
    pub pmf: f32,
    /// First vertex, corner, center or position. Nothing for lights at infinity.
    pub p0: [f32; 3],
    /// Radius of a sphere, else the area.
    pub size: f32,
    /// Edges from p0; for a disk, two perpendicular radii. Of a light that is no surface, what its module says.
    pub p1: [f32; 3],
    pub padding: u32,
    pub p2: [f32; 3],
    pub attributes: u32,
    /// Radiance of a surface; of a light that is no surface, intensity or irradiance.
    pub radiance: [f32; 3],
    /// Of a surface.
    pub material: u32,
}

impl PackedLight {
    /// A light that is no surface, of no kind yet and with no probability.
    pub(super) fn at(position: DVec3, radiance: DVec3) -> Self {
        Self {
            kind_and_flags: 0,
            alias_threshold: u32::MAX,
            alias: 0,
            pmf: 1.0,
            p0: position.as_vec3().to_array(),
            size: 0.0,
            p1: [0.0; 3],
            padding: 0,
            p2: [0.0; 3],
            attributes: NONE,
            radiance: radiance.as_vec3().to_array(),
            material: NONE,
        }
    }

    /// The light with this kind.
    pub(super) fn of_kind(self, kind: LightKind) -> Self {
        Self { kind_and_flags: self.kind_and_flags | kind as u32, ..self }
    }

    /// Its radiance is looked up in the whole material.
    pub fn varies(&self) -> bool {
        self.kind_and_flags & LIGHT_VARIES != 0
    }

    pub fn moves(&self) -> bool {
        self.kind_and_flags & LIGHT_MOVES != 0
    }

    pub fn kind(&self) -> u32 {
        self.kind_and_flags & 255
    }

    pub fn is(&self, kind: LightKind) -> bool {
        self.kind() == kind as u32
    }
}
