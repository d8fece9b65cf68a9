//! The lights that next event estimation samples, and their order, for both devices.

use std::f64::consts::PI;

use super::light_sampler::{LightGroup, LightSampler};
use crate::scene::{Estimator, Light, LightStrength, LinkMask, Scene};

/// A light that is sampled.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LightSource {
    /// A surface, by its number among the emitting ones.
    Surface(usize),
    /// A light that is no surface and is seen from one direction, by its number among the scene's.
    Delta(usize),
    /// The environment by itself.
    Environment,
    /// A portal to the environment, by its number.
    Portal(usize),
}

/// A primitive that emits and that points can be drawn on.
#[derive(Debug, Clone, Copy)]
pub struct EmittingSurface {
    pub shape: usize,
    pub material: usize,
    /// Luminous power, above 0.
    pub power: f64,
}

/// Light from outside the scene.
#[derive(Debug, Clone, Copy)]
pub struct OutsideLight {
    /// The mean over all directions.
    pub mean_luminance: f64,
    /// Its radiance is the same in all directions.
    pub is_constant: bool,
}

/// All lights that are sampled, in their order: surfaces, delta lights inside the scene, delta lights at
/// infinity, the environment and its portals. [`LightSampler`] holds their weights. Empty where the estimator
/// samples none.
#[derive(Debug, Default)]
pub struct LightList {
    pub sources: Vec<LightSource>,
    pub sampler: LightSampler,
}

/// The masks of what each light of a list lights, in its order; empty where each lights all.
pub fn links_of(scene: &Scene, sources: &[LightSource], surfaces: &[EmittingSurface]) -> Vec<LinkMask> {
    if scene.light_links.is_empty() {
        return Vec::new();
    }
    let link = |source: &LightSource| match *source {
        LightSource::Surface(number) => scene.light_links.of_material(surfaces[number].material),
        LightSource::Delta(number) => scene.light_links.of_light(number),
        LightSource::Environment | LightSource::Portal(_) => scene.link_of_outside(),
    };
    sources.iter().map(link).collect()
}

impl LightList {
    /// The lights of a scene with these emitting surfaces, in the scene's order, and with portals of these
    /// areas.
    pub fn new(scene: &Scene, surfaces: &[EmittingSurface], outside: OutsideLight, portals: &[f64]) -> Self {
        let mut list = Self::default();
        if scene.render.estimator == Estimator::Bsdf {
            return list;
        }
        for (number, &EmittingSurface { shape, material, power }) in surfaces.iter().enumerate() {
            list.add(LightSource::Surface(number), LightGroup::Surface { shape, material }, LightStrength::Power(power));
        }
        let strength = |light: &Light| light.delta().map(|light| light.strength).filter(|strength| strength.is_positive());
        let delta_lights = (0..).zip(&scene.lights).filter_map(|(number, light)| Some((number, strength(light)?)));
        let (local, at_infinity): (Vec<_>, Vec<_>) =
            delta_lights.partition(|(_, strength)| matches!(strength, LightStrength::Power(_)));
        for (number, strength) in local.into_iter().chain(at_infinity) {
            list.add(LightSource::Delta(number), LightGroup::Alone, strength);
        }
        let irradiance = PI * outside.mean_luminance;
        if irradiance == 0.0 {
            return list;
        }
        let mut add = |source, irradiance| list.add(source, LightGroup::Environment, LightStrength::Irradiance(irradiance));
        // BSDF sampling, where it takes part, finds a constant environment better than light sampling does,
        // without a shadow ray.
        if scene.render.estimator == Estimator::Nee || !outside.is_constant {
            add(LightSource::Environment, irradiance);
        }
        let total: f64 = portals.iter().sum();
        for (number, area) in portals.iter().enumerate() {
            add(LightSource::Portal(number), irradiance * area / total);
        }
        list
    }

    fn add(&mut self, source: LightSource, group: LightGroup, strength: LightStrength) {
        self.sources.push(source);
        self.sampler.add(group, strength);
    }
}
