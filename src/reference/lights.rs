//! What light is sampled from: emitting primitives, then lights that are no surfaces, then portals, chosen by [`LightChoice`].
//!
//! Portals are one more way of drawing directions to the environment. A direction to it then has one density, that of all ways together,
//! whichever of them drew it.

mod primitive;

use std::f64::consts::PI;

use glam::DVec3;

use super::emission::{emitted, mean_exitance};
use super::environment::Environment;
use super::intersect::{Moment, Owner, PreparedRay, Primitive, Ray, Surface, SurfaceId, World};
use crate::math::luminance;
use crate::sampling::sampler::uniform;
use crate::sampling::{AliasTable, Lamp, LightChoice};
use crate::scene::{Estimator, Light, LightSampling, Scene};
use primitive::{pdf_of_direction, pdf_solid_angle, sample_primitive};

/// Relative amount by which a shadow segment stops short of the light's point, so that what the light lies upon does not block it.
const SHADOW_MARGIN: f64 = 1e-12;

/// Something that can be chosen for light sampling.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Source {
    /// An emitting primitive, by its place in the hierarchy's leaf order.
    Area(usize),
    Point {
        position: DVec3,
        intensity: DVec3,
    },
    Spot {
        position: DVec3,
        axis: DVec3,
        intensity: DVec3,
        /// Of the angles at which there is no light and at which there is all.
        cosines: [f64; 2],
    },
    Directional {
        to_light: DVec3,
        irradiance: DVec3,
    },
    Environment,
    /// By its place among the world's portals.
    Portal(usize),
}

impl Source {
    fn of(light: &Light) -> Option<Self> {
        match *light {
            Light::Point { position, intensity } => Some(Self::Point { position, intensity }),
            Light::Spot { position, direction, intensity, angle_degrees, falloff_degrees } => Some(Self::Spot {
                position,
                axis: direction,
                intensity,
                cosines: [angle_degrees, falloff_degrees].map(|angle| angle.to_radians().cos()),
            }),
            Light::Directional { direction, irradiance } => Some(Self::Directional { to_light: -direction, irradiance }),
            Light::Environment(_) => None,
        }
    }

    /// Luminous power of a light inside the scene.
    fn power(&self) -> f64 {
        match self {
            Self::Point { intensity, .. } => 4.0 * PI * luminance(*intensity),
            // The smooth step between the angles has the mean ½ over the solid angle.
            Self::Spot { intensity, cosines: [outer, inner], .. } => {
                2.0 * PI * (1.0 - 0.5 * (outer + inner)) * luminance(*intensity)
            }
            _ => 0.0,
        }
    }

    /// Only one direction leads to it.
    fn is_delta(&self) -> bool {
        matches!(self, Self::Point { .. } | Self::Spot { .. } | Self::Directional { .. })
    }
}

/// All lights of a scene, with the table they are chosen from.
#[derive(Debug, Clone)]
pub struct Lights {
    sources: Vec<Source>,
    table: AliasTable,
    /// Index into `sources` by leaf-order place of the primitive.
    of_primitive: Vec<Option<u32>>,
    environment: Environment,
    /// Place of the environment among the sources, where it is one.
    environment_source: Option<usize>,
    /// Place of the first portal among the sources.
    first_portal: usize,
    sphere_sampling: LightSampling,
}

/// Light arriving at a reference point from one sampled direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LightSample {
    /// Index of the light among those that can be chosen.
    pub light: usize,
    pub wi: DVec3,
    /// Length of the segment that must be free.
    pub distance: f64,
    /// Radiance; for a point light, intensity over squared distance.
    pub radiance: DVec3,
    /// Probability of the light times density of the direction per steradian; for a point light, the probability alone.
    pub pdf: f64,
    /// The direction was the only one the light has.
    pub delta: bool,
    /// The primitive the segment ends on. It is convex seen from outside and hollow from inside, so it cannot block itself.
    pub target: Option<usize>,
}

impl Lights {
    pub fn new(scene: &Scene, world: &World) -> Self {
        let (mut sources, mut choice) = (Vec::new(), LightChoice::default());
        let mut of_primitive = vec![None; world.places_in_scene_order().len()];
        // Once a material, not once a primitive: a texture's mean looks at all of it.
        let exitances: Vec<f64> = (0..scene.materials.len()).map(|material| mean_exitance(scene, material)).collect();
        for &place in world.places_in_scene_order() {
            let Owner { shape, material, .. } = world.owner(SurfaceId::Primitive(place));
            let power = world.primitive(place).area() * exitances[material];
            if power > 0.0 {
                of_primitive[place] = Some(sources.len() as u32);
                sources.push(Source::Area(place));
                choice.add(Lamp::Surface { shape, material }, power);
            }
        }
        for source in scene.lights.iter().filter_map(Source::of).filter(|source| source.power() > 0.0) {
            choice.add(Lamp::Alone, source.power());
            sources.push(source);
        }
        for source in scene.lights.iter().filter_map(Source::of) {
            if let Source::Directional { irradiance, .. } = source
                && luminance(irradiance) > 0.0
            {
                choice.add_at_infinity(Lamp::Alone, luminance(irradiance));
                sources.push(source);
            }
        }
        let environment = Environment::new(scene);
        let from_environment = PI * environment.mean_luminance();
        let mut environment_source = None;
        // Where BSDF sampling takes part, it finds a constant environment better than light sampling does.
        let is_sampled = scene.render.estimator == Estimator::Nee || !environment.is_constant();
        if from_environment > 0.0 && is_sampled {
            environment_source = Some(sources.len());
            sources.push(Source::Environment);
            choice.add_at_infinity(Lamp::Environment, from_environment);
        }
        let first_portal = sources.len();
        let areas: Vec<f64> = world.portals().iter().map(Primitive::area).collect();
        if from_environment > 0.0 {
            let total: f64 = areas.iter().sum();
            for (portal, area) in areas.iter().enumerate() {
                sources.push(Source::Portal(portal));
                choice.add_at_infinity(Lamp::Environment, from_environment * area / total);
            }
        }
        let sphere_sampling = scene.render.light_sampling;
        Self { sources, table: choice.table(), of_primitive, environment, environment_source, first_portal, sphere_sampling }
    }

    pub fn is_empty(&self) -> bool {
        self.sources.is_empty()
    }

    pub fn environment(&self) -> &Environment {
        &self.environment
    }

    /// Chooses a light by 32 random bits and draws a direction to it by 32 each. None where no light comes from there.
    pub fn sample(
        &self,
        scene: &Scene,
        (world, moment): (&World, &Moment),
        reference: DVec3,
        choice: u32,
        [u, v]: [u32; 2],
    ) -> Option<LightSample> {
        let light = self.table.choose(choice);
        let probability = self.table.pmf[light];
        let (u1, u2) = (uniform(u), uniform(v));
        let source = self.sources[light];
        let sample = |wi, distance, radiance, pdf, target| {
            (radiance != DVec3::ZERO).then_some(LightSample {
                light,
                wi,
                distance,
                radiance,
                pdf,
                delta: source.is_delta(),
                target,
            })
        };
        // Intensity over squared distance, towards a point.
        let from_point = |position: DVec3, intensity: &dyn Fn(DVec3) -> DVec3| {
            let to_light = position - reference;
            let squared = to_light.length_squared();
            let distance = squared.sqrt();
            let wi = to_light / distance;
            if squared > 0.0 { sample(wi, distance, intensity(wi) / squared, probability, None) } else { None }
        };
        match source {
            Source::Area(place) => {
                let direction =
                    sample_primitive(world.primitive(place), world.pose(place, moment), self.sphere_sampling, reference, u1, u2)?;
                let surface = world.surface_at(place, direction.point, direction.local, moment);
                let radiance = emitted(scene, &surface, -direction.wi);
                let distance = direction.distance * (1.0 - SHADOW_MARGIN);
                let pdf = direction.pdf_solid_angle;
                let usable = pdf > 0.0 && pdf.is_finite();
                if usable { sample(direction.wi, distance, radiance, probability * pdf, Some(place)) } else { None }
            }
            Source::Point { position, intensity } => from_point(position, &|_| intensity),
            Source::Spot { position, axis, intensity, cosines } => {
                from_point(position, &|wi| intensity * falloff(-wi.dot(axis), cosines))
            }
            Source::Directional { to_light, irradiance } => sample(to_light, f64::INFINITY, irradiance, probability, None),
            Source::Environment => {
                let drawn = self.environment.sample(u, v)?;
                let pdf = probability * drawn.pdf + self.portal_pdf(world, reference, drawn.wi);
                sample(drawn.wi, f64::INFINITY, drawn.radiance, pdf, None)
            }
            Source::Portal(portal) => {
                let wi = sample_primitive(&world.portals()[portal], None, LightSampling::Cone, reference, u1, u2)?.wi;
                let pdf = self.environment_pdf(world, reference, wi);
                // By rounding, a direction to a portal's very edge may miss it.
                if pdf > 0.0 { sample(wi, f64::INFINITY, self.environment.radiance(wi), pdf, None) } else { None }
            }
        }
    }

    /// Density, per steradian, with which [`Lights::sample`] draws the direction `wi` for the environment, by whichever way; 0 where it
    /// cannot.
    pub fn environment_pdf(&self, world: &World, reference: DVec3, wi: DVec3) -> f64 {
        let itself = self.environment_source.map_or(0.0, |source| self.table.pmf[source] * self.environment.pdf(wi));
        itself + self.portal_pdf(world, reference, wi)
    }

    fn portal_pdf(&self, world: &World, reference: DVec3, wi: DVec3) -> f64 {
        let chosen = &self.table.pmf[self.first_portal.min(self.table.pmf.len())..];
        if chosen.is_empty() || world.portals().is_empty() {
            return 0.0;
        }
        let ray = PreparedRay::new(Ray { origin: reference, direction: wi });
        world.portals().iter().zip(chosen).map(|(portal, pmf)| pmf * pdf_of_direction(portal, &ray)).sum()
    }

    /// Density, per steradian, with which [`Lights::sample`] finds the point `surface` from `reference`; 0 where it cannot.
    pub fn pdf(&self, (world, moment): (&World, &Moment), reference: DVec3, surface: &Surface) -> f64 {
        let SurfaceId::Primitive(place) = surface.id else { return 0.0 };
        let Some(light) = self.of_primitive[place] else { return 0.0 };
        let pose = world.pose(place, moment);
        let pdf = pdf_solid_angle(world.primitive(place), pose, self.sphere_sampling, reference, &surface.point);
        self.table.pmf[light as usize] * pdf
    }
}

/// How much of a spot light's intensity goes in a direction whose cosine with the axis is `cosine`: 1 within the inner angle, 0 past the
/// outer, between them Hermite's smooth step t²(3 − 2t) in the cosine.
fn falloff(cosine: f64, [outer, inner]: [f64; 2]) -> f64 {
    if cosine >= inner {
        return 1.0;
    }
    if cosine <= outer {
        return 0.0;
    }
    let t = (cosine - outer) / (inner - outer);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests;
