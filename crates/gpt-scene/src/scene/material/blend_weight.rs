//! The weight of each material in a blend.

use glam::DVec3;

use crate::math::octahedron;
use crate::scene::image::Channel;
use crate::scene::texture::TextureId;

/// The weight w0 of a blend's first material.
#[derive(Debug, Clone, PartialEq)]
pub enum BlendWeight {
    Constant {
        value: f64,
    },
    /// w0 = clamp(|N·ωo|^power, 0, 1)
    Facing {
        power: f64,
    },
    /// w0 = 1 − R; R by Schlick, or by the dielectric equations where `exact`.
    Fresnel {
        ior: f64,
        exact: bool,
    },
    /// w0 = 1 where the front is seen, 0 from behind.
    Front,
    /// w0 = 1 for rays of the camera that nothing has scattered, 0 for others and for light.
    Camera,
    /// w0 = max(0, N·axis)^power, N the shading normal on the side that is seen and the axis of length 1, one of [`rounded_axis`].
    Up {
        axis: DVec3,
        power: f64,
    },
    /// w0 = o^power, o the share of the directions over a surface, by their cosines, in which nothing is nearer than the distance: baked at the vertices
    /// of meshes before a render, when a texture takes its place. Without that it is 1.
    Open {
        distance: f64,
        power: f64,
    },
    /// w0 = luminance of the texture.
    Texture {
        texture: TextureId,
    },
    /// w0 = a channel of the texture times a factor.
    Channel {
        texture: TextureId,
        channel: Channel,
        factor: f64,
    },
    /// w0' = 1 − w0
    Reverse {
        of: Box<BlendWeight>,
    },
    /// w0' = 1 where w0 >= tau, else 0
    Threshold {
        tau: f64,
        of: Box<BlendWeight>,
    },
}

/// The direction as blends keep it: a place on an octahedron, of 16 bits a coordinate, which leads along the axes exactly and elsewhere within 10⁻⁴.
pub fn rounded_axis(direction: DVec3) -> DVec3 {
    octahedron::direction_at(octahedron::place_of(direction).map(|x| (x * AXIS_STEPS).round() / AXIS_STEPS))
}

/// Steps of a rounded axis' coordinate from 0 to 1: those of WGSL's `unpack2x16snorm`.
pub const AXIS_STEPS: f64 = 32767.0;

impl BlendWeight {
    /// The distance and the power of a weight by openness, at some depth.
    pub fn openness(&self) -> Option<[f64; 2]> {
        match self {
            Self::Open { distance, power } => Some([*distance, *power]),
            Self::Reverse { of } | Self::Threshold { of, .. } => of.openness(),
            _ => None,
        }
    }

    /// The weight comes from a texture at some depth.
    pub fn uses_texture(&self) -> bool {
        match self {
            Self::Texture { .. } | Self::Channel { .. } => true,
            Self::Reverse { of } | Self::Threshold { of, .. } => of.uses_texture(),
            Self::Constant { .. }
            | Self::Facing { .. }
            | Self::Fresnel { .. }
            | Self::Front
            | Self::Camera
            | Self::Up { .. }
            | Self::Open { .. } => false,
        }
    }
}
