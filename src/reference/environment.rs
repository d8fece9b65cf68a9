//! Light from outside the scene: how bright it is in a direction, and how directions to it are drawn.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec3;

use super::warp;
use crate::math::luminance;
use crate::sampling::{MapDistribution, sampler::uniform};
use crate::scene::{self, EnvironmentRadiance, ImageData, ImageTexture, Light, Scene, TextureFilter, TextureWrap};

/// Everything outside the scene.
#[derive(Debug, Clone)]
pub enum Environment {
    /// The same from everywhere; black where there is no environment.
    Constant(DVec3),
    Map(Map),
    Sky(Sky),
}

/// A direction that was drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EnvironmentSample {
    pub wi: DVec3,
    pub radiance: DVec3,
    /// Per steradian.
    pub pdf: f64,
}

impl Environment {
    pub fn new(scene: &Scene) -> Self {
        let mut constant = DVec3::ZERO;
        for light in &scene.lights {
            let Light::Environment(environment) = light else { continue };
            match &environment.radiance {
                EnvironmentRadiance::Constant(radiance) => constant += *radiance,
                EnvironmentRadiance::Map(image) => {
                    return Map::new(image, environment).map_or(Self::Constant(DVec3::ZERO), Self::Map);
                }
                &EnvironmentRadiance::Sky { zenith, horizon, ground } => return Self::Sky(Sky { zenith, horizon, ground }),
            }
        }
        Self::Constant(constant)
    }

    /// Radiance that arrives against a direction of length 1.
    pub fn radiance(&self, wi: DVec3) -> DVec3 {
        match self {
            Self::Constant(radiance) => *radiance,
            Self::Map(map) => {
                let (u, v) = map.coordinates(wi);
                map.lookup(u, v)
            }
            Self::Sky(sky) => sky.radiance(wi),
        }
    }

    /// Draws a direction by 32 bits each.
    pub fn sample(&self, bits_u: u32, bits_v: u32) -> Option<EnvironmentSample> {
        match self {
            Self::Constant(radiance) => {
                let wi = warp::uniform_sphere(uniform(bits_u), uniform(bits_v));
                Some(EnvironmentSample { wi, radiance: *radiance, pdf: warp::UNIFORM_SPHERE_PDF })
            }
            Self::Map(map) => Some(map.sample(bits_u, bits_v)),
            Self::Sky(sky) => sky.sample(uniform(bits_u), uniform(bits_v)),
        }
    }

    /// Density of [`Environment::sample`] per steradian.
    pub fn pdf(&self, wi: DVec3) -> f64 {
        match self {
            Self::Constant(_) => warp::UNIFORM_SPHERE_PDF,
            Self::Map(map) => {
                let (u, v) = map.coordinates(wi);
                map.distribution.warp.density(u, v) * per_steradian(wi.x.hypot(wi.z))
            }
            Self::Sky(sky) => luminance(sky.radiance(wi)) / sky.integral(),
        }
    }

    /// Luminance averaged over all directions.
    pub fn mean_luminance(&self) -> f64 {
        match self {
            Self::Constant(radiance) => luminance(*radiance),
            Self::Map(map) => map.distribution.mean_luminance,
            Self::Sky(sky) => sky.integral() / (4.0 * PI),
        }
    }

    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}

/// A lat-long picture, interpolated bilinearly; it goes round at its sides and ends at the poles.
#[derive(Debug, Clone)]
pub struct Map {
    texture: ImageTexture,
    distribution: MapDistribution,
    /// Whole turns.
    rotation: f64,
}

impl Map {
    /// None for a black picture.
    fn new(image: &Arc<ImageData>, environment: &scene::Environment) -> Option<Self> {
        let distribution = MapDistribution::new(image)?;
        let texture = ImageTexture {
            image: image.clone(),
            wrap: TextureWrap::Repeat,
            filter: TextureFilter::Bilinear,
            scale: [1.0; 2],
            offset: [0.0; 2],
        };
        Some(Self { texture, distribution, rotation: environment.rotation_degrees / 360.0 })
    }

    /// u = atan2(x, −z)/2π after turning back the rotation, v = acos(y)/π.
    fn coordinates(&self, wi: DVec3) -> (f64, f64) {
        let u = (wi.x.atan2(-wi.z) / TAU + self.rotation).rem_euclid(1.0);
        (u, wi.x.hypot(wi.z).atan2(wi.y) / PI)
    }

    fn lookup(&self, u: f64, v: f64) -> DVec3 {
        let image = &*self.texture.image;
        let (x, y) = (u * f64::from(image.width) - 0.5, v * f64::from(image.height) - 0.5);
        let (left, top) = (x.floor(), y.floor());
        let texel = |column: f64, row: f64| {
            let column = (column as i64).rem_euclid(i64::from(image.width)) as usize;
            let row = (row as i64).clamp(0, i64::from(image.height) - 1) as usize;
            image.texels[row * image.width as usize + column].as_dvec3()
        };
        let row = |row: f64| texel(left, row).lerp(texel(left + 1.0, row), x - left);
        row(top).lerp(row(top + 1.0), y - top)
    }

    fn sample(&self, bits_u: u32, bits_v: u32) -> EnvironmentSample {
        let point = self.distribution.warp.sample(bits_u, bits_v);
        let (sine, cosine) = (PI * point.v).sin_cos();
        let (x, minus_z) = (TAU * (point.u - self.rotation)).sin_cos();
        EnvironmentSample {
            wi: DVec3::new(sine * x, cosine, -sine * minus_z),
            radiance: self.lookup(point.u, point.v),
            pdf: point.density * per_steradian(sine),
        }
    }
}

/// From a density over the unit square of (u, v) to one per steradian: dω = 2π du · π dv · sinθ. At the poles it grows without bound,
/// in a solid angle that is nothing.
fn per_steradian(sine: f64) -> f64 {
    1.0 / (2.0 * PI * PI * sine.max(1e-6))
}

/// From the horizon up, `horizon` to `zenith` in proportion to the direction's height y; `ground` below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    pub zenith: DVec3,
    pub horizon: DVec3,
    pub ground: DVec3,
}

impl Sky {
    fn radiance(&self, wi: DVec3) -> DVec3 {
        if wi.y >= 0.0 { self.horizon.lerp(self.zenith, wi.y) } else { self.ground }
    }

    /// Integral of luminance over the upper and the lower half.
    fn halves(&self) -> [f64; 2] {
        [PI * (luminance(self.zenith) + luminance(self.horizon)), TAU * luminance(self.ground)]
    }

    fn integral(&self) -> f64 {
        self.halves().iter().sum()
    }

    /// In proportion to luminance: the half first, then, above, a height whose density is linear.
    fn sample(&self, u1: f64, u2: f64) -> Option<EnvironmentSample> {
        let [upper, lower] = self.halves();
        let share = upper / (upper + lower);
        let height = if u1 < share {
            let (h, z) = (luminance(self.horizon), luminance(self.zenith));
            let xi = u1 / share;
            // The root of h·y + (z − h)·y²/2 = ξ·(h + z)/2 that does not cancel; a black horizon has ξ = 0 only where nothing comes
            // from.
            let denominator = h + (h * h + xi * (z * z - h * h)).max(0.0).sqrt();
            if denominator > 0.0 { (xi * (h + z) / denominator).min(1.0) } else { 0.0 }
        } else {
            (u1 - 1.0) / (1.0 - share)
        };
        let sine = ((1.0 - height) * (1.0 + height)).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (TAU * u2).sin_cos();
        let wi = DVec3::new(sine * cos_phi, height, sine * sin_phi);
        let radiance = if u1 < share { self.horizon.lerp(self.zenith, height) } else { self.ground };
        let pdf = luminance(radiance) / (upper + lower);
        (pdf > 0.0).then_some(EnvironmentSample { wi, radiance, pdf })
    }
}

#[cfg(test)]
mod tests;
