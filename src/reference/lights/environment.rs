//! An environment of one colour, or a lat-long map.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::{DMat3, DVec3};

use super::outside::{Environment, EnvironmentSample, Outside};
use crate::sampling::MapDistribution;
use crate::scene::{self, EnvironmentRadiance, ImageData, MapRows};
use crate::spectrum::Spectrum;

pub fn new(light: &scene::Environment) -> Outside {
    match &light.radiance {
        EnvironmentRadiance::Constant(radiance) => Outside::Constant(*radiance),
        EnvironmentRadiance::Map(image) => match MapDistribution::new(image, light.rows) {
            Some(distribution) => {
                let rotation = light.rotation_degrees / 360.0;
                Outside::Varying(Arc::new(Map {
                    image: image.clone(),
                    distribution,
                    turn: light.turn(),
                    rotation,
                    rows: light.rows,
                }))
            }
            // A black picture.
            None => Outside::Constant(Spectrum::BLACK),
        },
    }
}

/// A lat-long picture, interpolated bilinearly; it goes round at its sides and ends at the poles.
#[derive(Debug)]
struct Map {
    image: Arc<ImageData>,
    distribution: MapDistribution,
    /// From the map's space to the world, for a map that is turned about another axis than +Y.
    turn: Option<DMat3>,
    /// About +Y, in whole turns.
    rotation: f64,
    rows: MapRows,
}

impl Map {
    /// A direction in the map's space.
    fn turned_back(&self, wi: DVec3) -> DVec3 {
        self.turn.map_or(wi, |turn| turn.transpose() * wi)
    }

    /// (u, v) of a direction in the map's space: u = atan2(x, −z)/2π after turning back the rotation, v = acos(y)/π.
    fn coordinates(&self, wi: DVec3) -> (f64, f64) {
        let u = (wi.x.atan2(-wi.z) / TAU + self.rotation).rem_euclid(1.0);
        (u, wi.x.hypot(wi.z).atan2(wi.y) / PI)
    }

    fn lookup(&self, u: f64, v: f64) -> Spectrum {
        let image = &*self.image;
        let (scale, offset) = self.rows.scale_and_offset(image.height);
        let (x, y) = (u * f64::from(image.width) - 0.5, v * scale + offset);
        let (left, top) = (x.floor(), y.floor());
        let texel = |column: f64, row: f64| {
            let column = (column as i64).rem_euclid(i64::from(image.width)) as usize;
            let row = (row as i64).clamp(0, i64::from(image.height) - 1) as usize;
            Spectrum::from_f32(image.texels.color(row * image.width as usize + column).to_array())
        };
        let row = |row: f64| texel(left, row).lerp(texel(left + 1.0, row), x - left);
        row(top).lerp(row(top + 1.0), y - top)
    }
}

impl Environment for Map {
    fn radiance(&self, wi: DVec3) -> Spectrum {
        let (u, v) = self.coordinates(self.turned_back(wi));
        self.lookup(u, v)
    }

    fn sample(&self, bits_u: u32, bits_v: u32) -> Option<EnvironmentSample> {
        let point = self.distribution.warp.sample(bits_u, bits_v);
        let (sine, cosine) = (PI * point.v).sin_cos();
        let (x, minus_z) = (TAU * (point.u - self.rotation)).sin_cos();
        let in_map = DVec3::new(sine * x, cosine, -sine * minus_z);
        Some(EnvironmentSample {
            wi: self.turn.map_or(in_map, |turn| turn * in_map),
            radiance: self.lookup(point.u, point.v),
            pdf: point.density * per_steradian(sine),
        })
    }

    fn pdf(&self, wi: DVec3) -> f64 {
        let in_map = self.turned_back(wi);
        let (u, v) = self.coordinates(in_map);
        self.distribution.warp.density(u, v) * per_steradian(in_map.x.hypot(in_map.z))
    }

    fn mean_luminance(&self) -> f64 {
        self.distribution.mean_luminance
    }
}

/// From a density over the unit square of (u, v) to one per steradian: dω = 2π du · π dv · sinθ. At the poles it grows without bound,
/// in a solid angle that is nothing.
fn per_steradian(sine: f64) -> f64 {
    1.0 / (2.0 * PI * PI * sine.max(1e-6))
}
