//! The weight of each material in a blend.

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
            Self::Constant { .. } | Self::Facing { .. } | Self::Fresnel { .. } | Self::Front | Self::Camera => false,
        }
    }
}
