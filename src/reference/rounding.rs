//! Effects that rounding to single precision may have on a path.
//!
//! A device computes in f32, the reference in f64. Where the two differ on a path, the question is whether rounding explains it: it does
//! where the path is so steep, or so close to a decision, that errors of rounding's size move the reference itself as far. So the
//! reference follows the path again and again, and each time every ray, point, normal and direction on the way is off by a few units in the last
//! place of f32, at random.

use glam::DVec3;

use super::bsdf::{BsdfSample, Density};
use super::intersect::{Hit, PathTime, Ray, Surface, SurfacePoint, World};
use super::lights::{LightSample, Lights};
use super::scatterer::Scatterer;
use super::trace::{LightConnection, PathVisitor};
use crate::math::POINT_ERROR;
use crate::sampling::hash::mix;
use crate::sampling::sampler::LARGEST_NUMBER;
use crate::spectrum::Spectrum;

/// Relative size of one rounding to f32.
const UNIT: f64 = 0.5 * f32::EPSILON as f64;

/// Follows a path with intermediate results that are off by rounding errors, and notes which decisions were taken.
#[derive(Debug, Clone)]
pub struct Rounding {
    /// Relative size of the errors.
    size: f64,
    state: u32,
    decisions: u64,
}

impl Rounding {
    /// No errors: the path as it is, with its decisions.
    pub fn none() -> Self {
        Self { size: 0.0, state: 0, decisions: 0 }
    }

    /// Errors of up to `units` roundings each, drawn by `seed`.
    pub fn of_units(units: f64, seed: u32) -> Self {
        Self { size: units * UNIT, state: mix(seed ^ 0x9e37_79b9), decisions: 0 }
    }

    /// Two paths with the same number have met the same primitives, chosen the same lights and lobes, and seen or not seen the same
    /// lights.
    pub fn decisions(&self) -> u64 {
        self.decisions
    }

    fn decided(&mut self, what: u64) {
        // FNV-1a, a word at a time.
        self.decisions = (self.decisions ^ what).wrapping_mul(0x0000_0100_0000_01b3).rotate_left(23);
    }

    /// Uniform in [−1, 1).
    fn draw(&mut self) -> f64 {
        self.state = self.state.wrapping_add(0x9e37_79b9);
        f64::from(mix(self.state)) / 2_147_483_648.0 - 1.0
    }

    /// A vector inside the cube of side 2.
    fn draw_vector(&mut self) -> DVec3 {
        DVec3::new(self.draw(), self.draw(), self.draw())
    }
}

impl PathVisitor for Rounding {
    fn surface(&mut self, _depth: u32, surface: &Surface, _wo: DVec3, _throughput: Spectrum) {
        self.decided(1 + ((surface.owner.shape as u64) << 32 | surface.owner.part as u64));
    }

    fn medium(&mut self, _depth: u32, _position: DVec3, _wo: DVec3, _throughput: Spectrum) {
        self.decided(6);
    }

    fn light(&mut self, connection: &LightConnection) {
        self.decided(2 + 4 * (2 * connection.light.light as u64 + u64::from(connection.visible)));
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        let refracted = u64::from(sample.eta != 1.0);
        let delta = u64::from(sample.density == Density::Delta);
        self.decided(3 + 4 * (4 * u64::from(sample.is_null) + 2 * delta + refracted));
    }

    fn roulette(&mut self, _survival: f64, survived: bool) {
        self.decided(5 + 4 * u64::from(survived));
    }

    fn escaped(&mut self, _radiance: Spectrum, _weight: f64, _contribution: Spectrum) {
        self.decided(7);
    }

    fn round_ray(&mut self, ray: &mut Ray, left: Option<&SurfacePoint>) {
        self.round_direction(&mut ray.direction);
        let magnitude = left.map_or_else(|| ray.origin.abs().max_element(), SurfacePoint::magnitude);
        let mut error = self.draw_vector() * (self.size * magnitude);
        if let Some(point) = left {
            // Along the surface by errors, and above it by as much as kernels lift their rays, up to twice that: by the error along the normal, which
            // is nothing on a floor at height 0, and elsewhere no more than the largest.
            let along_normal = point.normal.abs().dot(point.position.abs());
            let magnitude = if self.draw() < 0.0 { magnitude } else { along_normal };
            let lift = if self.size > 0.0 { (self.draw() + 1.0) * magnitude * POINT_ERROR } else { 0.0 };
            let up = point.normal * ray.direction.dot(point.normal).signum();
            error += up * (lift - error.dot(up));
        }
        ray.origin += error;
    }

    fn first_hit(&mut self, world: &World, ray: &Ray, time: &PathTime) -> Option<Hit> {
        let first = world.closest(*ray, time)?;
        let magnitude = ray.origin.abs().max(ray.at(first.distance).abs()).max_element();
        self.state = self.state.wrapping_add(0x9e37_79b9);
        let (farther, number) = (self.size * magnitude, mix(self.state));
        if farther == 0.0 {
            return Some(first);
        }
        let mut met = world.hits_before(*ray, first.distance + farther, time);
        // At an edge, the limit may be what keeps the first from being met again.
        (!met.is_empty()).then(|| met.swap_remove(number as usize % met.len())).or(Some(first))
    }

    fn round_point(&mut self, point: &mut DVec3, magnitude: f64) {
        *point += self.draw_vector() * (self.size * magnitude);
    }

    fn round_surface(&mut self, surface: &mut Surface) {
        self.round_direction(&mut surface.shading_normal);
        if let Some(normal) = &mut surface.coat_normal {
            self.round_direction(normal);
        }
        surface.uv *= 1.0 + self.size * self.draw();
        if let Some(uv) = &mut surface.second_uv {
            *uv *= 1.0 + self.size * self.draw();
        }
    }

    fn round_direction(&mut self, direction: &mut DVec3) {
        *direction = (*direction + self.draw_vector() * self.size).normalize();
    }

    fn round_number(&mut self, number: f64) -> f64 {
        (number + self.size * self.draw()).clamp(0.0, LARGEST_NUMBER)
    }

    fn round_light_numbers(&mut self, bits: [u32; 2], magnified: impl FnOnce() -> f64) -> [u32; 2] {
        let magnified = magnified();
        // A cast to an integer ends at the smallest and the largest.
        bits.map(|bits| (f64::from(bits) + magnified * self.size * self.draw() * 4_294_967_296.0) as u32)
    }

    fn round_light(&mut self, light: &mut LightSample, lights: &Lights) {
        self.round_direction(&mut light.wi);
        // Kernels end shadow rays early, by an error of their own.
        light.distance *= 1.0 - (self.draw() + 1.0) * self.size;
        // Light from outside the scene depends on the direction alone.
        if light.distance.is_infinite() && !light.delta {
            light.radiance = lights.outside().radiance(light.wi);
        }
    }

    fn round_sample(&mut self, sample: &mut BsdfSample, scatterer: &Scatterer<'_>) {
        // The density of a narrow lobe changes much faster than the direction.
        let exact = scatterer.pdf(sample.wi);
        self.round_direction(&mut sample.wi);
        let rounded = scatterer.pdf(sample.wi);
        if let Density::SolidAngle(pdf) = &mut sample.density
            && exact > 0.0
            && rounded > 0.0
        {
            *pdf *= rounded / exact;
        }
    }
}
