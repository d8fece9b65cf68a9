//! Weights of a blend, as the device reads them.

use glam::DVec3;

use super::constants::NONE;
use super::texture::mention;
use crate::math::octahedron;
use crate::scene::material::AXIS_STEPS;
use crate::scene::{BlendWeight, Channel};
use crate::shader::shared::{Constants, shared_constants, shared_kinds};

shared_kinds! {
    /// The quantity that decides a weight.
    pub(super) enum WeightKind {
        Constant = 0 as WEIGHT_CONSTANT,
        Facing = 1 as WEIGHT_FACING,
        FresnelSchlick = 2 as WEIGHT_FRESNEL_SCHLICK,
        FresnelExact = 3 as WEIGHT_FRESNEL_EXACT,
        /// The luminance of a texture.
        Texture = 4 as WEIGHT_TEXTURE,
        /// The first channel of a texture times the value.
        Channel = 5 as WEIGHT_CHANNEL,
        /// 1 from the front, 0 from behind.
        Front = 6 as WEIGHT_FRONT,
        /// 1 for rays of the camera that nothing has scattered, else 0.
        Camera = 7 as WEIGHT_CAMERA,
        /// By the normal and an axis, whose place on an octahedron stands for the texture, 16 bits a coordinate.
        Up = 8 as WEIGHT_UP,
    }
}

shared_constants!(flags {
    // Applied in this order: 1 − w; w ≥ threshold; 1 − w.
    const REVERSED_WITHIN: u32 = 256;
    const THRESHOLDED: u32 = 512;
    const REVERSED: u32 = 1024;
});

/// All of these.
pub(super) const FLAGS: u32 = REVERSED_WITHIN | THRESHOLDED | REVERSED;

/// Kinds and flags, for WGSL.
pub fn constants() -> Constants {
    [WeightKind::constants(), flags()].concat()
}

/// The weight of a blend, 16 bytes.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct PackedBlendWeight {
    pub kind_and_flags: u32,
    /// Value, power or index of refraction.
    pub value: f32,
    pub threshold: f32,
    pub texture: u32,
}

/// An axis as WGSL's `unpack2x16snorm` reads it.
fn axis_bits(axis: DVec3) -> u32 {
    let [x, y] = octahedron::place_of(axis).map(|x| u32::from((x * AXIS_STEPS).round() as i16 as u16));
    x | y << 16
}

/// The weight where it is the same at every hit.
pub(super) fn constant_weight(weight: &BlendWeight) -> Option<f64> {
    match weight {
        BlendWeight::Constant { value } => Some(*value),
        BlendWeight::Reverse { of } => constant_weight(of).map(|value| 1.0 - value),
        BlendWeight::Threshold { tau, of } => constant_weight(of).map(|value| f64::from(u8::from(value >= *tau))),
        // Baked weights are textures.
        BlendWeight::Open { .. } => Some(1.0),
        // x⁰
        BlendWeight::Facing { power } if *power == 0.0 => Some(1.0),
        BlendWeight::Facing { .. }
        | BlendWeight::Fresnel { .. }
        | BlendWeight::Front
        | BlendWeight::Camera
        | BlendWeight::Up { .. }
        | BlendWeight::Texture { .. }
        | BlendWeight::Channel { .. } => None,
    }
}

impl PackedBlendWeight {
    /// Packs the weight of a blend's first material; `reversed` for that of its second.
    pub(super) fn new(weight: &BlendWeight, reversed: bool) -> Self {
        let plain = |kind: WeightKind, value: f64, texture| Self {
            kind_and_flags: kind as u32,
            value: value as f32,
            threshold: 0.0,
            texture,
        };
        let packed = match weight {
            BlendWeight::Constant { value } => plain(WeightKind::Constant, *value, NONE),
            BlendWeight::Facing { power } => plain(WeightKind::Facing, *power, NONE),
            BlendWeight::Fresnel { ior, exact: false } => plain(WeightKind::FresnelSchlick, *ior, NONE),
            BlendWeight::Fresnel { ior, exact: true } => plain(WeightKind::FresnelExact, *ior, NONE),
            BlendWeight::Front => plain(WeightKind::Front, 0.0, NONE),
            BlendWeight::Camera => plain(WeightKind::Camera, 0.0, NONE),
            BlendWeight::Up { axis, power } => plain(WeightKind::Up, *power, axis_bits(*axis)),
            BlendWeight::Open { .. } => plain(WeightKind::Constant, 1.0, NONE),
            BlendWeight::Texture { texture } => plain(WeightKind::Texture, 0.0, *texture as u32),
            BlendWeight::Channel { texture, channel, factor } => {
                // The first one stands there anyway.
                plain(WeightKind::Channel, *factor, mention(*texture, Some(*channel).filter(|channel| *channel != Channel::R)))
            }
            BlendWeight::Reverse { of } => Self::new(of, true),
            BlendWeight::Threshold { tau, of } => Self::new(of, false).thresholded(*tau),
        };
        if reversed { Self { kind_and_flags: packed.kind_and_flags ^ REVERSED, ..packed } } else { packed }
    }

    /// True where the weight depends on the angle from which the surface is seen.
    pub(super) fn is_by_angle(&self) -> bool {
        self.is_one_of(&[WeightKind::Facing, WeightKind::FresnelSchlick, WeightKind::FresnelExact])
    }

    /// True where the weight depends on the side from which the surface is seen.
    pub(super) fn is_by_side(&self) -> bool {
        self.is_one_of(&[WeightKind::Front])
    }

    /// True where the weight depends on the viewer of the surface: the camera, or something else.
    pub(super) fn is_by_viewer(&self) -> bool {
        self.is_one_of(&[WeightKind::Camera])
    }

    /// True where the weight depends on the direction of the surface's normal.
    pub(super) fn is_by_direction(&self) -> bool {
        self.is_one_of(&[WeightKind::Up])
    }

    /// True where `texture` is one.
    pub(super) fn looks_up(&self) -> bool {
        self.is_one_of(&[WeightKind::Texture, WeightKind::Channel])
    }

    fn is_one_of(&self, kinds: &[WeightKind]) -> bool {
        kinds.iter().any(|kind| *kind as u32 == self.kind_and_flags & !FLAGS)
    }

    /// 1 where the weight is at least tau, else 0.
    fn thresholded(self, tau: f64) -> Self {
        let reversed = self.kind_and_flags & REVERSED != 0;
        if self.kind_and_flags & THRESHOLDED == 0 {
            let within = if reversed { REVERSED_WITHIN } else { 0 };
            let kind_and_flags = self.kind_and_flags & !REVERSED | within | THRESHOLDED;
            return Self { kind_and_flags, threshold: tau as f32, ..self };
        }
        // A threshold of a threshold: 0 and 1 stay as they are where 0 < tau ≤ 1, and all is 1 or 0 beyond.
        if tau > 0.0 && tau <= 1.0 {
            return self;
        }
        let value = if tau <= 0.0 { 1.0 } else { 0.0 };
        Self { kind_and_flags: WeightKind::Constant as u32, value, threshold: 0.0, texture: NONE }
    }
}
