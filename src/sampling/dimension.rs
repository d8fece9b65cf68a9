//! The named dimensions of a path.
//!
//! Dimensions come in blocks of four so that the device loads a block at once: block 0 is the camera's, every bounce has two.

/// What a random number of the camera is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum CameraDimension {
    PixelX = 0,
    PixelY = 1,
    LensU = 2,
    LensV = 3,
    Time = 4,
}

/// What a random number at a surface is used for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u32)]
pub enum BounceDimension {
    LightChoice = 0,
    LightU = 1,
    LightV = 2,
    /// Which lobe of the material: reflection or transmission, a leaf of a blend.
    Lobe = 3,
    BsdfU = 4,
    BsdfV = 5,
    Roulette = 6,
    /// Which material of a blend (`pick`).
    Blend = 7,
}

/// One coordinate of the path's point in primary sample space.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Dimension(pub u32);

/// Dimensions before the first bounce's.
pub const CAMERA_DIMENSIONS: u32 = 8;
/// Dimensions of each bounce.
pub const BOUNCE_DIMENSIONS: u32 = 8;

impl Dimension {
    pub const fn camera(dimension: CameraDimension) -> Self {
        Self(dimension as u32)
    }

    /// `bounce` counts surfaces from 0, the first one the camera sees.
    pub const fn bounce(bounce: u32, dimension: BounceDimension) -> Self {
        Self(CAMERA_DIMENSIONS + bounce * BOUNCE_DIMENSIONS + dimension as u32)
    }
}
