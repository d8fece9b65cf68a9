//! The path tracing estimator (Kajiya 1986; Veach 1997).
//!
//! Radiance that arrives along a ray leaves the surface it came from: L = Le + ∫ f(wo, wi) L(wi) |cosθi| dwi.
//! The integral is estimated at every surface by at most two samples: one direction towards a light (next
//! event estimation), which finds emission only, and one direction drawn from the BSDF, along which the path
//! goes on. The product of all weights f·|cosθ| / density so far is the path's throughput. Emission that both
//! samples can find is shared out by multiple importance sampling, see [`super::mis`].

mod setup;

use std::sync::Arc;

use glam::DVec3;

use super::bsdf::{Bsdf, BsdfSample, Density};
use super::camera::ProjectiveCamera;
use super::emission::{emitted, null_weight};
use super::guided::GuidedBsdf;
use super::intersect::{Hit, PathTime, Ray, Surface, World};
use super::lights::{LightSample, Lights};
use super::medium::{MediumStack, transmittance};
use super::mis;
use super::roulette::{self, Expectation};
use super::trace::{LightConnection, PathVisitor};
use crate::sampling::{CameraDimension, Dimension, Guide, LitPoint, PathSampler, VertexDimension};
use crate::scene::{Emitters, Estimator, MaterialId, Media, Scene};
use crate::spectrum::Spectrum;

/// A scene made ready for tracing paths.
#[derive(Debug, Clone)]
pub struct Integrator {
    scene: Scene,
    /// The vector by which the scene was moved.
    center: DVec3,
    world: World,
    lights: Lights,
    camera: ProjectiveCamera,
    /// Something does.
    moves: bool,
    /// By material: it, or a part of its blend, gives light, and the camera does not see it.
    hidden: Vec<bool>,
    media: Media,
    /// From where light arrives, where that was learned.
    guide: Option<Arc<Guide>>,
}

/// A path under construction.
struct Path {
    ray: Ray,
    /// When it sees the scene.
    time: PathTime,
    /// Product of f·|cosθ| / density over the surfaces so far, roulette included.
    throughput: Spectrum,
    /// Radiance that the path has found.
    radiance: Spectrum,
    /// Product of eta² over the refractions so far: undoes the scaling of radiance, so that roulette does not
    /// end paths for being inside glass.
    eta_scale: f64,
    /// By which roulette ends guided paths.
    expectation: Expectation,
    /// How the ray's direction was sampled at the last vertex that is no null surface, and where the ray
    /// began there. Shadow rays from there go on through null surfaces as the path does, so both are weighed
    /// against each other by the densities that they have there.
    previous: Density,
    lit_from: LitPoint,
    /// The media that the ray is in.
    stack: MediumStack,
    /// Edges of the path up to the end of the ray: the camera's has 1.
    depth: u32,
    /// Number of the next vertex, from 0: each has random numbers of its own. Null surfaces end no edge, else
    /// it would be depth − 1.
    vertex: u32,
}

impl Integrator {
    /// The radiance one sample of one pixel sees. `visitor` is told everything that happens.
    pub fn radiance<V: PathVisitor>(&self, x: u32, y: u32, sampler: &PathSampler, visitor: &mut V) -> Spectrum {
        let mut path = self.camera_path(x, y, sampler, visitor);
        loop {
            visitor.ray(&path.ray);
            let hit = visitor.first_hit(&self.world, &path.ray, &path.time);
            let goes_on = self.shade_vertex(&mut path, hit, sampler, visitor);
            if !goes_on || visitor.gives_up(path.vertex) {
                return path.radiance;
            }
        }
    }

    /// A path of which only the camera's ray is there.
    fn camera_path<V: PathVisitor>(&self, x: u32, y: u32, sampler: &PathSampler, visitor: &mut V) -> Path {
        let mut ray = self.camera.sample(x, y, sampler);
        visitor.round_ray(&mut ray, None);
        Path {
            lit_from: ray.origin.into(),
            ray,
            time: self.path_time(sampler),
            throughput: Spectrum::WHITE,
            radiance: Spectrum::BLACK,
            eta_scale: 1.0,
            expectation: Expectation::default(),
            previous: Density::Delta,
            stack: MediumStack::default(),
            depth: 1,
            vertex: 0,
        }
    }

    /// Uniform over the time for which the shutter is open.
    fn path_time(&self, sampler: &PathSampler) -> PathTime {
        if !self.moves {
            return PathTime::default();
        }
        let [open, close] = self.scene.camera.shutter;
        PathTime::new(&self.scene, open + (close - open) * sampler.uniform(Dimension::camera(CameraDimension::Time)))
    }

    /// Extends a path whose ray met `hit`: adds the light found there, and chooses the next ray. False where
    /// the path ends.
    fn shade_vertex<V: PathVisitor>(&self, path: &mut Path, hit: Option<Hit>, sampler: &PathSampler, visitor: &mut V) -> bool {
        // Add light from outside where the ray left the scene
        let Some(hit) = hit else {
            self.add_escaped_radiance(path, visitor);
            return false;
        };

        // Look up the surface that the ray met
        let mut surface = self.world.surface(&path.ray, &hit, &path.time);
        surface.by_camera = path.depth == 1;
        visitor.round_surface(&mut surface);
        let wo = -path.ray.direction;
        path.throughput *= transmittance(&self.media, path.stack.innermost(), surface.point.position.distance(path.ray.origin));
        surface.carried = path.throughput;
        visitor.surface(path.depth, &surface, wo, path.throughput);

        // Let the camera look through emitters that it is not to see
        if path.depth == 1 && self.hidden[surface.owner.material] {
            self.go_behind(path, &surface, visitor);
            return true;
        }

        // Add the emission of the surface
        self.add_emitted_radiance(path, &surface, wo, visitor);

        // End the path at its greatest depth: only blends, which may hold null surfaces, let its last edge go
        // on
        let last_edge = path.depth == self.scene.render.max_depth;
        if last_edge && !self.scene.materials[surface.owner.material].is_blend() {
            return false;
        }

        // Look up how the surface scatters
        let vertex = path.vertex;
        let random = |dimension| sampler.uniform(Dimension::vertex(vertex, dimension));
        let bsdf = Bsdf::new(&self.scene, &surface, wo, visitor.round_number(random(VertexDimension::Blend)));
        visitor.view(&bsdf.view);
        let guided = GuidedBsdf::new(self.guide(), &surface, &bsdf);
        // Cells of lights are told apart by this normal.
        let mut lit_normal = surface.point.normal_towards(wo);
        visitor.round_direction(&mut lit_normal);

        // Sample lights for direct lighting
        if !last_edge && V::LIGHTS && self.samples_light(&bsdf) {
            for number in 0..self.scene.render.light_samples_at(path.depth) {
                let bits = sampler.light_bits(vertex, path.depth, number);
                self.add_direct_light(path, (&surface, lit_normal), &guided, bits, visitor);
            }
        }

        // Sample the direction in which the path goes on
        let [u1, u2] = [VertexDimension::BsdfU, VertexDimension::BsdfV].map(|number| visitor.round_number(random(number)));
        let u_lobe = visitor.round_number(random(VertexDimension::Lobe));
        let Some(mut drawn) = guided.sample(u_lobe, u1, u2) else { return false };
        visitor.round_sample(&mut drawn, &guided);
        if last_edge && !drawn.is_null {
            return false;
        }
        if V::COMPARES {
            visitor.unguided(guided.unguided(drawn.wi, drawn.density));
        }
        visitor.scattered(&drawn);

        // Extend the path
        let arriving = path.throughput;
        path.throughput *= drawn.weight;
        path.eta_scale *= drawn.eta * drawn.eta;
        path.ray = Ray { origin: surface.point.leave_towards(drawn.wi), direction: drawn.wi };
        visitor.round_ray(&mut path.ray, Some(&surface.point));
        path.vertex += 1;
        // Null surfaces end no edge
        if drawn.is_null {
            return true;
        }
        path.stack = path.stack.towards(&self.media, &surface, bsdf.view.front, drawn.wi);
        path.previous = drawn.density;
        path.lit_from = LitPoint::new(path.ray.origin, lit_normal);

        // Let Russian roulette end the path
        let u_roulette = visitor.round_number(random(VertexDimension::Roulette));
        let survival = match self.guide {
            Some(_) => path.expectation.survival(arriving, guided.sent_on(), path.depth),
            None => roulette::survival(path.throughput * path.eta_scale, path.depth),
        };
        let survives = self.survives_roulette(path, survival, u_roulette, visitor);
        path.depth += 1;
        survives
    }

    /// The camera's ray goes through a surface that is not to be seen, as through a null surface.
    fn go_behind<V: PathVisitor>(&self, path: &mut Path, surface: &Surface, visitor: &mut V) {
        let wi = path.ray.direction;
        visitor.scattered(&BsdfSample { wi, weight: Spectrum::WHITE, density: Density::Delta, eta: 1.0, is_null: true });
        path.ray = Ray { origin: surface.point.leave_towards(wi), direction: wi };
        visitor.round_ray(&mut path.ray, Some(&surface.point));
        path.vertex += 1;
    }

    /// A ray that left the scene finds the environment, shared with the light sample of the surface before.
    fn add_escaped_radiance<V: PathVisitor>(&self, path: &mut Path, visitor: &mut V) {
        path.throughput *= transmittance(&self.media, path.stack.innermost(), f64::INFINITY);
        if path.depth == 1 && self.scene.render.emitters == Emitters::Hidden {
            return visitor.escaped(Spectrum::BLACK, 1.0, Spectrum::BLACK);
        }
        let radiance = self.lights.outside().radiance(path.ray.direction);
        let light_pdf = || self.lights.environment_pdf(&self.world, path.lit_from, path.ray.direction);
        let weight = self.emission_weight(path, light_pdf);
        let contribution = path.throughput * radiance * weight;
        path.radiance += contribution;
        visitor.escaped(radiance, weight, contribution);
    }

    /// Emission found by following the path, shared with the light sample of the surface before.
    fn add_emitted_radiance<V: PathVisitor>(&self, path: &mut Path, surface: &Surface, wo: DVec3, visitor: &mut V) {
        let radiance = emitted(&self.scene, surface, wo);
        if radiance.is_black() {
            return;
        }
        let weight = self.emission_weight(path, || self.lights.pdf((&self.world, &path.time), path.lit_from, surface));
        let contribution = path.throughput * radiance * weight;
        path.radiance += contribution;
        visitor.emission(radiance, weight, contribution);
    }

    /// The weight of light that a path's ray found, where one light sample of the surface before has the
    /// density `light_pdf`.
    fn emission_weight(&self, path: &Path, light_pdf: impl Fn() -> f64) -> f64 {
        let settings = &self.scene.render;
        let light_pdf = || light_pdf() * f64::from(settings.light_samples_at(path.depth - 1));
        match (path.previous, settings.estimator) {
            (Density::Delta, _) | (_, Estimator::Bsdf) => 1.0,
            (Density::SolidAngle(pdf), estimator) => match (light_pdf(), estimator) {
                (0.0, _) => 1.0,
                (_, Estimator::Nee) => 0.0,
                (light_pdf, Estimator::Mis | Estimator::Bsdf) => mis::weight(settings.heuristic, pdf, light_pdf),
            },
        }
    }

    /// Light is sampled at surfaces with this BSDF.
    fn samples_light(&self, bsdf: &Bsdf) -> bool {
        self.scene.render.estimator != Estimator::Bsdf && !self.lights.is_empty() && bsdf.has_non_delta_lobe()
    }

    /// Next event estimation: one light, one direction to it, f·|cosθ|·L / (probability · density), if
    /// nothing is in between.
    fn add_direct_light<V: PathVisitor>(
        &self,
        path: &mut Path,
        (surface, lit_normal): (&Surface, DVec3),
        guided: &GuidedBsdf,
        [choice, u, v]: [u32; 3],
        visitor: &mut V,
    ) {
        // Sample a light and a direction to it
        let settings = &self.scene.render;
        let view = guided.view();
        let mut lit = surface.point.leave_towards(view.wo);
        visitor.round_point(&mut lit, surface.point.magnitude());
        let reference = LitPoint::new(lit, lit_normal);
        let moment = (&self.world, &path.time);
        let numbers = visitor.round_light_numbers([u, v], || self.lights.magnifies(moment, reference, choice));
        let Some(light) = self.lights.sample(&self.scene, moment, reference, choice, numbers) else { return };
        // Several samples are as dense together as one of as many times its density
        let mut light = LightSample { pdf: light.pdf * f64::from(settings.light_samples_at(path.depth)), ..light };
        visitor.round_light(&mut light, &self.lights);

        // Weigh the sample: no BSDF sample finds a point light, and with `nee` BSDF samples leave all
        // emission to light samples
        let scattering = guided.evaluate(light.wi);
        if scattering.value.is_black() {
            return;
        }
        let weight = if light.delta || settings.estimator == Estimator::Nee {
            1.0
        } else {
            mis::weight(settings.heuristic, light.pdf, scattering.pdf)
        };

        // Trace the shadow ray: light that comes through the surface arrives on its other side
        let mut ray = Ray { origin: surface.point.leave_towards(light.wi), direction: light.wi };
        visitor.round_ray(&mut ray, Some(&surface.point));
        visitor.ray(&ray);
        let medium = path.stack.towards(&self.media, surface, view.front, light.wi).innermost();
        let through = self.shadow_transmittance(ray, &light, medium, &path.time);
        let contribution = path.throughput * scattering.value * light.radiance * (weight / light.pdf) * through;
        path.radiance += contribution;
        if V::COMPARES {
            visitor.unguided(guided.unguided(light.wi, Density::SolidAngle(scattering.pdf)));
        }
        visitor.light(&LightConnection { light, bsdf_pdf: scattering.pdf, weight, visible: !through.is_black(), contribution });
    }

    /// The share of a sample's light that comes along its shadow ray: through all surfaces on the way, and through the medium where the ray
    /// begins. Boundaries of media let no shadow ray through, so it stays in that one.
    fn shadow_transmittance(&self, ray: Ray, light: &LightSample, medium: usize, time: &PathTime) -> Spectrum {
        let share = |surface: &Surface| null_weight(&self.scene, surface, -ray.direction);
        let lets_through = |material: MaterialId| self.lights.lets_through(material);
        let through_surfaces = self.world.transmittance(ray, light.distance, light.target, time, lets_through, share);
        transmittance(&self.media, medium, light.distance) * through_surfaces
    }

    /// Russian roulette: the path goes on with probability q and then counts 1/q times as much, which leaves
    /// the mean as it is.
    fn survives_roulette<V: PathVisitor>(&self, path: &mut Path, survival: f64, u: f64, visitor: &mut V) -> bool {
        if self.scene.render.first_roulette(self.guide.is_some()).is_none_or(|first| path.depth < first) {
            return true;
        }
        visitor.roulette(survival, u < survival);
        if u >= survival {
            return false;
        }
        path.throughput /= survival;
        true
    }
}
