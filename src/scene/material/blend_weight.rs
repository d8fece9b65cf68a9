//! What decides how much of each material a blend shows.

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
    /// w0 = 1 where the surface is seen from its front, else 0.
    Front,
    /// w0 = 1 − R; R by Schlick, or by the dielectric equations where `exact`.
    Fresnel {
        ior: f64,
        exact: bool,
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

impl BlendWeight {
    /// The weight comes from a texture at some depth.
    pub fn uses_texture(&self) -> bool {
        match self {
            Self::Texture { .. } | Self::Channel { .. } => true,
            Self::Reverse { of } | Self::Threshold { of, .. } => of.uses_texture(),
            Self::Constant { .. } | Self::Facing { .. } | Self::Front | Self::Fresnel { .. } => false,
        }
    }
}
