//! Lights from one point that shine into a part of the directions: cones and pictures.

use std::f64::consts::PI;

use glam::DVec3;

use super::model::{DeltaLight, LightParameters, LightStrength, SceneLight, amounts, placed, stands};
use super::profile::AimedProfile;
use crate::math::Frame;
use crate::scene::check::{Check, is_direction};
use crate::scene::light_at::LightAt;
use crate::scene::texture::TextureId;
use crate::spectrum::Spectrum;

/// A point light cut to a cone: full `intensity` inside `falloff_degrees` of the axis, none past `angle_degrees`, between them as its curve
/// says.
#[derive(Debug, Clone, PartialEq)]
pub struct SpotLight {
    pub position: DVec3,
    pub direction: DVec3,
    /// With a profile, for each candela of it.
    pub intensity: Spectrum,
    pub angle_degrees: f64,
    pub falloff_degrees: f64,
    pub curve: FalloffCurve,
    /// The picture that multiplies the intensity and fills the square around the cone.
    pub picture: Option<ProjectedTexture>,
    /// Its nadir is the light's direction.
    pub profile: Option<AimedProfile>,
}

/// How the intensity of a spot light falls from 1 to 0 between its two angles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum FalloffCurve {
    /// t²(3 − 2t), t in proportion to the cosine.
    #[default]
    Smooth,
    /// t², t in proportion to the cosine, as in glTF.
    Square,
    /// In proportion to the angle, as in Mitsuba.
    Linear,
}

/// A texture that a light projects.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProjectedTexture {
    pub texture: TextureId,
    /// The direction in which the texture's v grows, projected across the light's direction; u grows to the right, as seen from the light.
    pub up: DVec3,
}

/// The turn of a picture's frame about the axis of a light, against [`Frame::around`] of that axis: cosine and sine. `x` to the right and `y` up
/// are x = c·a + s·b and y = s·a − c·b of coordinates a and b along that frame's tangent and bitangent.
pub fn picture_turn(direction: DVec3, up: DVec3) -> [f64; 2] {
    let frame = Frame::around(direction);
    let right = direction.cross(up).normalize_or(frame.tangent);
    [right.dot(frame.tangent), right.dot(frame.bitangent)]
}

/// A texture's v grows somewhere across this direction.
fn has_up(direction: DVec3, up: DVec3) -> bool {
    up.is_finite() && direction.cross(up).length() > 1e-6 * up.length()
}

impl SpotLight {
    /// The integral of the linear falloff over the cosine of the angle.
    fn linear_share(&self) -> f64 {
        let [outer, inner] = [self.angle_degrees, self.falloff_degrees].map(f64::to_radians);
        if outer > inner { 1.0 - (outer.sin() - inner.sin()) / (outer - inner) } else { 1.0 - outer.cos() }
    }

    /// The integral of the intensity over all directions where it is 1 on the axis, without a picture.
    fn solid_angle(&self) -> f64 {
        let angles @ [outer, inner] = [self.angle_degrees, self.falloff_degrees];
        if let Some(aimed) = &self.profile {
            let factor = |degrees: f64| self.curve.share(degrees.to_radians().cos(), angles.map(f64::to_radians));
            return aimed.profile.integral(factor, &angles);
        }
        let [outer, inner] = [outer, inner].map(solid);
        match self.curve {
            FalloffCurve::Smooth => PI * (outer + inner),
            FalloffCurve::Square => 2.0 * PI * (inner + (outer - inner) / 3.0),
            FalloffCurve::Linear => 2.0 * PI * self.linear_share(),
        }
    }

    /// Some of its profile's light lies within its cone.
    pub fn shines(&self) -> bool {
        self.solid_angle() > 0.0
    }

    /// The light without its profile, and as strong.
    pub fn without_profile(&self) -> Self {
        let plain = Self { profile: None, ..self.clone() };
        let share = self.solid_angle() / plain.solid_angle();
        Self { intensity: self.intensity * if share.is_finite() { share } else { 0.0 }, ..plain }
    }
}

/// 1 − cosine of an angle in degrees. Written this way, narrow cones keep their precision.
fn solid(degrees: f64) -> f64 {
    2.0 * (0.5 * degrees).to_radians().sin().powi(2)
}

impl FalloffCurve {
    /// How much of a spot light's intensity goes in a direction whose cosine with the axis is `cosine`: 1 within the inner angle, 0 past the outer;
    /// `angles` are the outer and the inner one in radians.
    pub fn share(self, cosine: f64, angles: [f64; 2]) -> f64 {
        let [outer, inner] = angles.map(f64::cos);
        if cosine >= inner {
            return 1.0;
        }
        if cosine <= outer {
            return 0.0;
        }
        let t = (cosine - outer) / (inner - outer);
        match self {
            Self::Smooth => t * t * (3.0 - 2.0 * t),
            Self::Square => t * t,
            Self::Linear => (angles[0] - cosine.acos()) / (angles[0] - angles[1]),
        }
    }
}

impl SceneLight for SpotLight {
    fn check(&self) -> Check {
        stands(self.position)?;
        placed(is_direction(self.direction))?;
        let (falloff, angle) = (self.falloff_degrees, self.angle_degrees);
        if !(0.0 <= falloff && falloff <= angle && angle <= 180.0) {
            return Err(format!("its light falls off from {falloff} to {angle} degrees"));
        }
        if let Some(picture) = &self.picture {
            placed(has_up(self.direction, picture.up))?;
            if !(angle > 0.0 && angle < 90.0) {
                return Err(format!("its picture fills a cone of {angle} degrees"));
            }
        }
        if let Some(aimed) = &self.profile {
            placed(aimed.nadir == self.direction)?;
            aimed.check(self.intensity)?;
            if !self.shines() {
                return Err(format!("its profile gives no light within {angle} degrees of its direction"));
            }
        }
        amounts(&[self.intensity])
    }

    fn translate(&mut self, offset: DVec3) {
        self.position += offset;
    }

    fn set(&mut self, at: &LightAt) {
        at.place(&mut self.position);
        at.turn(&mut self.direction);
        self.intensity = at.strength.unwrap_or(self.intensity);
        if let Some(picture) = &mut self.picture {
            at.take_along(&mut picture.up);
        }
        if let Some(aimed) = &mut self.profile {
            aimed.nadir = self.direction;
            at.take_along(&mut aimed.front);
        }
    }

    fn profile(&self) -> Option<&AimedProfile> {
        self.profile.as_ref()
    }

    fn texture(&self) -> Option<TextureId> {
        self.picture.map(|picture| picture.texture)
    }
}

/// Forms of a spot light, for shaders: those of [`FalloffCurve`].
pub const FALLOFF_SQUARE: u32 = 1;
/// Its angles are whole turns.
pub const FALLOFF_LINEAR: u32 = 2;

/// Vectors: the axis; then 1 − cosine of the angle at which the light ends, and of the one up to which it is full. Written that way, narrow cones
/// keep their precision. A linear falloff has the angles themselves, in whole turns. Last, and as the number, the turn of the picture. The
/// smooth step between the angles has the mean ½ over the solid angle, the square ⅓.
impl DeltaLight for SpotLight {
    fn parameters(&self) -> LightParameters {
        let [outer, inner] = [self.angle_degrees, self.falloff_degrees].map(solid);
        let power = self.solid_angle();
        let form = match self.curve {
            FalloffCurve::Smooth => 0,
            FalloffCurve::Square => FALLOFF_SQUARE,
            FalloffCurve::Linear => FALLOFF_LINEAR,
        };
        let limits = if self.curve == FalloffCurve::Linear {
            [self.angle_degrees / 360.0, self.falloff_degrees / 360.0]
        } else {
            [outer, inner]
        };
        let [cosine, sine] = self.picture.map_or([1.0, 0.0], |picture| picture_turn(self.direction, picture.up));
        LightParameters {
            cone: Some((self.direction, [self.falloff_degrees, self.angle_degrees].map(f64::to_radians))),
            vectors: [self.direction, DVec3::new(limits[0], limits[1], cosine)],
            number: sine,
            form,
            ..LightParameters::new(LightStrength::Power(power * self.intensity.luminance()), self.intensity, self.position)
        }
    }
}

/// A light from one point that projects a rectangular picture: on a plane across its direction at distance 1, which faces it, the picture makes
/// `irradiance` times the texture's colour.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Projector {
    pub position: DVec3,
    pub direction: DVec3,
    /// The direction of the picture's upper edge, projected across the light's direction.
    pub up: DVec3,
    pub irradiance: Spectrum,
    /// The angle of the whole picture.
    pub vertical_fov_degrees: f64,
    /// Width of the picture over its height.
    pub aspect: f64,
    /// None: all of the picture is white.
    pub texture: Option<TextureId>,
}

impl Projector {
    /// Half the picture's width and height at distance 1.
    pub fn half_extent(&self) -> [f64; 2] {
        let half_height = (0.5 * self.vertical_fov_degrees).to_radians().tan();
        [half_height * self.aspect, half_height]
    }
}

impl SceneLight for Projector {
    fn check(&self) -> Check {
        stands(self.position)?;
        placed(is_direction(self.direction) && has_up(self.direction, self.up))?;
        let fov = self.vertical_fov_degrees;
        if !(fov > 0.0 && fov < 180.0 && self.aspect.is_finite() && self.aspect > 0.0) {
            return Err(format!("its picture is {fov} degrees high and {} times as wide", self.aspect));
        }
        amounts(&[self.irradiance])
    }

    fn translate(&mut self, offset: DVec3) {
        self.position += offset;
    }

    fn set(&mut self, at: &LightAt) {
        at.place(&mut self.position);
        at.turn(&mut self.direction);
        at.take_along(&mut self.up);
        self.irradiance = at.strength.unwrap_or(self.irradiance);
    }

    fn texture(&self) -> Option<TextureId> {
        self.texture
    }
}

/// Vectors: the axis; then half of 1 over half the width and half the height of the picture at distance 1, and, with the number, the turn of the
/// picture. The power of the picture is its area at distance 1 times the irradiance.
impl DeltaLight for Projector {
    fn parameters(&self) -> LightParameters {
        let [half_width, half_height] = self.half_extent();
        let [cosine, sine] = picture_turn(self.direction, self.up);
        let power = 4.0 * half_width * half_height * self.irradiance.luminance();
        LightParameters {
            cone: Some((self.direction, [half_width.hypot(half_height).atan(); 2])),
            vectors: [self.direction, DVec3::new(0.5 / half_width, 0.5 / half_height, cosine)],
            number: sine,
            ..LightParameters::new(LightStrength::Power(power), self.irradiance, self.position)
        }
    }
}
