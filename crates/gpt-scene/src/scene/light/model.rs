//! The contract of every light with the layers that it goes through.

use std::sync::Arc;

use glam::DVec3;

use super::profile::AimedProfile;
use crate::scene::check::{Check, is_amount, within_range};
use crate::scene::image::ImageData;
use crate::scene::light_at::LightAt;
use crate::scene::texture::TextureId;
use crate::spectrum::Spectrum;

/// The questions of a scene to a light, whatever its kind.
pub trait SceneLight {
    /// Checks its numbers; the error is the mistake, in words.
    fn check(&self) -> Check;

    /// Moves it by an offset, with all of the scene.
    fn translate(&mut self, _offset: DVec3) {}

    /// Makes it what it is at a frame, as far as that says something of it.
    fn set(&mut self, _at: &LightAt) {}

    /// Its picture, if it has one.
    fn image_mut(&mut self) -> Option<&mut Arc<ImageData>> {
        None
    }

    /// Its picture, if it has one, to read.
    fn image(&self) -> Option<&ImageData> {
        None
    }

    /// The texture that it projects, if it does.
    fn texture(&self) -> Option<TextureId> {
        None
    }

    /// The profile by which its intensity differs from direction to direction, if it has one.
    fn profile(&self) -> Option<&AimedProfile> {
        None
    }
}

/// By what a light is weighed among all that are sampled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LightStrength {
    /// Luminous power, of a light inside the scene.
    Power(f64),
    /// The irradiance that a light at infinity could make.
    Irradiance(f64),
}

impl LightStrength {
    /// The light gives any.
    pub fn is_positive(self) -> bool {
        let (Self::Power(strength) | Self::Irradiance(strength)) = self;
        strength > 0.0
    }
}

/// A light to which one direction leads from each point.
pub trait DeltaLight {
    fn parameters(&self) -> LightParameters;
}

/// The parameters of a delta light for samplers and shaders, in the slots that the device's tables have for
/// it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightParameters {
    pub strength: LightStrength,
    /// Radiant intensity, or the irradiance of a light at infinity.
    pub color: Spectrum,
    /// Nothing of a light at infinity.
    pub position: DVec3,
    /// The direction that it shines in, and the angles from there, in radians, up to which it is full and at which it ends. None: it
    /// shines in all directions.
    pub cone: Option<(DVec3, [f64; 2])>,
    /// Further vectors that its shader reads.
    pub vectors: [DVec3; 2],
    /// One number more.
    pub number: f64,
    /// Which of the forms of its kind it has, from 0 to 3.
    pub form: u32,
}

impl LightParameters {
    /// The parameters of a light that is the only form of its kind, shines in all directions and has nothing
    /// else to read.
    pub fn new(strength: LightStrength, color: Spectrum, position: DVec3) -> Self {
        Self { strength, color, position, cone: None, vectors: [DVec3::ZERO; 2], number: 0.0, form: 0 }
    }
}

pub fn amounts(lights: &[Spectrum]) -> Check {
    let possible = lights.iter().copied().all(is_amount);
    if possible { Ok(()) } else { Err("its light must be finite and not negative".to_owned()) }
}

pub fn stands(position: DVec3) -> Check {
    placed(position.is_finite())?;
    within_range(position.length())
}

pub fn placed(possible: bool) -> Check {
    if possible { Ok(()) } else { Err("its position must be finite and its direction of length 1".to_owned()) }
}
