//! The path tracing estimator (Kajiya 1986; Veach 1997).
//!
//! Radiance that arrives along a ray leaves the surface it came from: L = Le + ∫ f(wo, wi) L(wi) |cosθi| dwi.
//! Within a medium, the phase function takes the place of f |cosθi|, and the place where light is scattered is drawn.
//! The integral is estimated at every such place by at most two samples: one direction towards a light (next
//! event estimation), which finds emission only, and one direction drawn from the BSDF, along which the path
//! goes on. The product of all weights f·|cosθ| / density so far is the path's throughput. Emission that both
//! samples can find is shared out by multiple importance sampling, see [`crate::sampling::mis`].

mod setup;
mod shadow;

use std::sync::Arc;

use glam::DVec3;

use super::bsdf::{Bsdf, BsdfSample, Density};
use super::camera::CameraRays;
use super::emission::emitted;
use super::free_flight::fly;
use super::guided::GuidedPhase;
use super::intersect::{Hit, PathTime, Ray, Surface, World};
use super::layered::{LayersOfMaterials, SurfaceScatterer};
use super::lights::{LightSample, Lights};
use super::medium::{MediumStack, given_off, left};
use super::phase::Scattering;
use super::roulette::{self, Expectation};
use super::scatterer::{Interaction, Scatterer};
use super::trace::{LightConnection, PathVisitor};
use super::tracking::{Stream, pass_through, track};
use crate::sampling::choice::Choice;
use crate::sampling::hash::mix;
use crate::sampling::mis::Heuristic;
use crate::sampling::sampler::uniform;
use crate::sampling::{Dimension, Guide, LightSampleContext, MediumDimension, PathSampler, VertexDimension};
use crate::scene::{Emitters, Estimator, Filling, LinkMask, Media, MediumGrids, ReceiverId, SEES_ALL, Scene};
use crate::spectrum::Spectrum;

/// A scene made ready for tracing paths.
#[derive(Debug, Clone)]
pub struct Integrator {
    scene: Scene,
    /// The vector by which the scene was moved.
    center: DVec3,
    world: World,
    lights: Lights,
    camera: CameraRays,
    /// Something does.
    moves: bool,
    /// By material: it, or a part of its blend, gives light, and the camera does not see it.
    hidden: Vec<bool>,
    media: Media,
    layers: LayersOfMaterials,
    /// Receivers of all shapes, and behind them of all instances; empty where every lamp lights everything.
    receivers: Vec<ReceiverId>,
    link_of_outside: LinkMask,
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
    reference: LightSampleContext,
    /// The receiver of that vertex, which only lamps light that are linked to it.
    receiver: ReceiverId,
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
        let Some(mut path) = self.camera_path(x, y, sampler, visitor) else { return Spectrum::BLACK };
        loop {
            visitor.ray(&path.ray);
            let hit = visitor.first_hit(&self.world, &path.ray, &path.time);
            let goes_on = self.shade_vertex(&mut path, hit, sampler, visitor);
            if !goes_on || visitor.gives_up(path.vertex) {
                return path.radiance;
            }
        }
    }

    /// A path of which only the camera's ray is there; None where the camera sees nothing.
    fn camera_path<V: PathVisitor>(&self, x: u32, y: u32, sampler: &PathSampler, visitor: &mut V) -> Option<Path> {
        let mut ray = self.camera.sample(x, y, sampler)?;
        visitor.round_ray(&mut ray, None);
        Some(Path {
            reference: ray.origin.into(),
            ray,
            time: self.path_time(y, sampler),
            throughput: Spectrum::WHITE,
            radiance: Spectrum::BLACK,
            eta_scale: 1.0,
            expectation: Expectation::default(),
            previous: Density::Delta,
            receiver: SEES_ALL,
            stack: MediumStack::around(self.media.around_camera),
            depth: 1,
            vertex: 0,
        })
    }

    /// Uniform over the time for which the pixel's row is exposed.
    fn path_time(&self, y: u32, sampler: &PathSampler) -> PathTime {
        if !self.moves {
            return PathTime::default();
        }
        self.time_within_exposure(self.camera.time(y, sampler))
    }

    /// A time between those at which the shutter opens, 0, and closes, 1.
    fn time_within_exposure(&self, share: f64) -> PathTime {
        let [open, close] = self.scene.camera.shutter;
        PathTime::new(&self.scene, open + (close - open) * share)
    }

    /// Extends a path whose ray met `hit`: adds the light found there, and chooses the next ray. False where
    /// the path ends.
    fn shade_vertex<V: PathVisitor>(&self, path: &mut Path, hit: Option<Hit>, sampler: &PathSampler, visitor: &mut V) -> bool {
        // Look up the surface that the ray met
        let surface = hit.map(|hit| {
            let mut surface = self.world.surface(&path.ray, &hit, &path.time);
            surface.by_camera = path.depth == 1;
            visitor.round_surface(&mut surface);
            surface
        });
        let length = surface.as_ref().map_or(f64::INFINITY, |surface| surface.point.position.distance(path.ray.origin));

        // Go through the medium on the way, which may scatter the path before it comes to the end of its ray
        if let Some(position) = self.fly_through_medium(path, length, sampler, visitor) {
            return self.scatter_in_medium(path, position, sampler, visitor);
        }

        // Add light from outside where the ray left the scene
        let Some(mut surface) = surface else {
            self.add_escaped_radiance(path, visitor);
            return false;
        };
        let wo = -path.ray.direction;
        surface.carried = path.throughput;
        visitor.surface(path.depth, &surface, wo, path.throughput);

        // Let the camera look through emitters that it is not to see
        if path.depth == 1 && self.hidden[surface.owner.material] {
            self.go_behind(path, &surface, visitor);
            return true;
        }

        // Add the emission of the surface
        self.add_emitted_radiance(path, &surface, wo, visitor);

        // End the path at its greatest depth: only blends, which may hold null surfaces, and null surfaces that
        // bound media let its last edge go on
        let last_edge = path.depth == self.scene.render.max_depth;
        let material = surface.owner.material;
        if last_edge && !self.scene.materials[material].is_blend() && !self.media.is_open(material) {
            return false;
        }

        // Look up how the surface scatters
        let vertex = path.vertex;
        let random = |dimension| sampler.uniform(Dimension::vertex(vertex, dimension));
        let u_blend = visitor.round_number(random(VertexDimension::Blend));
        let bsdf = Bsdf::new(&self.scene, &surface, wo, u_blend);
        visitor.view(&bsdf.view);
        let [key, other] =
            [VertexDimension::Blend, VertexDimension::Lobe].map(|dimension| sampler.bits(Dimension::vertex(vertex, dimension)));
        let (layers, key) = ((&self.scene, &self.layers), mix(key ^ mix(other)));
        let scatterer = SurfaceScatterer::new(layers, self.guide(), (&surface, &bsdf), u_blend, key);
        let scatterer = Scatterer::Surface(scatterer);
        self.scatter(path, &Interaction::surface(&surface, &bsdf), &scatterer, sampler, visitor)
    }

    /// The medium around the path's ray takes of its throughput and adds what it gives off, up to the ray's end or to
    /// the place, returned, where it scatters the path.
    fn fly_through_medium<V: PathVisitor>(
        &self,
        path: &mut Path,
        length: f64,
        sampler: &PathSampler,
        visitor: &mut V,
    ) -> Option<DVec3> {
        let filling = self.media.filling(path.stack.innermost())?;
        if let Some(grids) = &filling.grids {
            return self.fly_through_grids(path, (filling, grids), length, sampler, visitor);
        }
        if self.media.emit() && self.scene.light_groups.shows(filling.light_group) {
            let contribution = path.throughput * given_off(filling, length);
            path.radiance += contribution;
            visitor.given_off(contribution);
        }
        if !filling.scatters() {
            path.throughput *= left(filling.extinction, length);
            return None;
        }
        let random = |dimension| sampler.open(Dimension::medium(path.vertex, dimension));
        let numbers =
            [MediumDimension::Event, MediumDimension::Distance].map(|dimension| visitor.round_number(random(dimension)));
        let pivot = || {
            let mut pivot = if filling.is_light_sampled { self.pivot(path, filling, length, sampler) } else { None }?;
            let magnitude = pivot.abs().max(path.ray.origin.abs()).max_element();
            visitor.round_point(&mut pivot, magnitude);
            Some(pivot)
        };
        let flight = fly(filling, path.throughput, (&path.ray, length), pivot, self.scene.render.distance_sampling, numbers);
        path.throughput *= flight.weight;
        flight.scattered_at.map(|distance| path.ray.at(distance))
    }

    /// Such a flight through a medium that differs from place to place.
    fn fly_through_grids<V: PathVisitor>(
        &self,
        path: &mut Path,
        medium: (&Filling, &MediumGrids),
        length: f64,
        sampler: &PathSampler,
        visitor: &mut V,
    ) -> Option<DVec3> {
        let (filling, _) = medium;
        let stream = |dimension| Stream::new(sampler.bits(Dimension::medium(path.vertex, dimension)));
        let emits = !filling.emission.is_black();
        if emits || !filling.scatters() {
            let mut numbers = stream(MediumDimension::Pass);
            let passage = pass_through(medium, (&path.ray, length), emits, || visitor.round_number(numbers.draw()));
            if emits && self.scene.light_groups.shows(filling.light_group) {
                let contribution = path.throughput * passage.given_off;
                path.radiance += contribution;
                visitor.given_off(contribution);
            }
            if !filling.scatters() {
                path.throughput *= passage.left;
                return None;
            }
        }
        let mut numbers = stream(MediumDimension::Track);
        let flight = track(medium, path.throughput, (&path.ray, length), || visitor.round_number(numbers.draw()));
        path.throughput *= flight.weight;
        flight.scattered_at.map(|distance| path.ray.at(distance))
    }

    /// The place of a light about which the place of scattering is drawn: of the light that light sample 0 of the next
    /// vertex chooses, but at the middle of the ray, or as far as light goes. None where it is at infinity.
    fn pivot(&self, path: &Path, filling: &Filling, length: f64, sampler: &PathSampler) -> Option<DVec3> {
        if self.scene.render.estimator == Estimator::Bsdf || self.lights.is_empty() {
            return None;
        }
        let middle = path.ray.at((0.5 * length).min(3.0 / filling.extinction.sum()));
        let [choice, u, v] = sampler.light_bits(path.vertex, path.depth, 0);
        let from = LightSampleContext::new(middle, -path.ray.direction);
        self.lights.place((&self.world, &path.time), from, choice, [u, v])
    }

    /// Extends a path that a medium scatters at `position`. False where the path ends.
    fn scatter_in_medium<V: PathVisitor>(
        &self,
        path: &mut Path,
        position: DVec3,
        sampler: &PathSampler,
        visitor: &mut V,
    ) -> bool {
        let wo = -path.ray.direction;
        visitor.medium(path.depth, position, wo, path.throughput);
        let filling = self.media.filling(path.stack.innermost());
        let (Some(filling), true) = (filling, path.depth != self.scene.render.max_depth) else { return false };
        let scattering = Scattering { phase: &filling.phase, wo, is_dark: filling.is_dark };
        let scatterer = Scatterer::Medium(GuidedPhase::new(self.guide(), position, scattering));
        self.scatter(path, &Interaction::medium(position, wo, filling.receiver), &scatterer, sampler, visitor)
    }

    /// Extends a path where it is scattered: samples lights, and chooses the next ray. False where the path ends.
    fn scatter<V: PathVisitor>(
        &self,
        path: &mut Path,
        interaction: &Interaction<'_>,
        scatterer: &Scatterer<'_>,
        sampler: &PathSampler,
        visitor: &mut V,
    ) -> bool {
        let vertex = path.vertex;
        let random = |dimension| sampler.uniform(Dimension::vertex(vertex, dimension));
        let last_edge = path.depth == self.scene.render.max_depth;
        let receiver = interaction.receiver(&self.receivers);
        visitor.receiver(receiver);
        // Cells of lights are told apart by this normal.
        let mut reference_normal = interaction.point().normal_towards(scatterer.wo());
        visitor.round_direction(&mut reference_normal);

        // Choose between light sampling and going on, where the estimator does not do both
        let samples_light = !last_edge && self.samples_light(scatterer);
        let roulette_bits = sampler.bits(Dimension::vertex(vertex, VertexDimension::Roulette));
        let choice = (samples_light && self.scene.render.estimator == Estimator::Choose).then(|| Choice::of(roulette_bits));
        if choice.is_some() {
            path.throughput *= Choice::TIMES;
        }

        // Sample lights for direct lighting
        if V::LIGHTS && samples_light && choice != Some(Choice::Path) {
            for number in 0..self.scene.render.light_samples_at(path.depth) {
                let bits = sampler.light_bits(vertex, path.depth, number);
                self.add_direct_light(path, (interaction, reference_normal, receiver), scatterer, bits, visitor);
            }
        }
        if choice == Some(Choice::Light) {
            return false;
        }

        // Sample the direction in which the path goes on
        let [u1, u2] = [VertexDimension::BsdfU, VertexDimension::BsdfV].map(|number| visitor.round_number(random(number)));
        let u_lobe = visitor.round_number(random(VertexDimension::Lobe));
        let drawn = scatterer.sample(u_lobe, u1, u2).filter(|drawn| !drawn.weight.is_black());
        let Some(mut drawn) = drawn else { return false };
        visitor.round_sample(&mut drawn, scatterer);
        if last_edge && !drawn.is_null {
            return false;
        }
        if V::COMPARES {
            visitor.unguided(scatterer.unguided(drawn.wi, drawn.density));
        }
        visitor.scattered(&drawn);

        // Extend the path
        let arriving = path.throughput;
        path.throughput *= drawn.weight;
        path.eta_scale *= drawn.eta * drawn.eta;
        path.ray = Ray { origin: interaction.point().leave_towards(drawn.wi), direction: drawn.wi };
        visitor.round_ray(&mut path.ray, Some(interaction.point()));
        path.vertex += 1;
        if !drawn.is_null || interaction.is_open_boundary(&self.media) {
            path.stack = interaction.media_towards(path.stack, &self.media, drawn.wi);
        }
        // Null surfaces end no edge
        if drawn.is_null {
            return true;
        }
        path.previous = drawn.density;
        path.receiver = receiver;
        path.reference = LightSampleContext::new(path.ray.origin, reference_normal);

        // Let Russian roulette end the path
        let u_roulette = visitor.round_number(uniform(choice.map_or(roulette_bits, |_| Choice::bits_left(roulette_bits))));
        let survival = match self.guide {
            // In fog a guide says too little of what a path will bring yet: paths that ended by it made twice the noise
            Some(_) => {
                let sent_on = scatterer.sent_on().filter(|_| !self.media.scatter());
                path.expectation.survival(arriving, sent_on, path.depth)
            }
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
        if self.media.is_open(surface.owner.material) {
            path.stack = path.stack.towards(&self.media, surface, surface.point.normal.dot(wi) < 0.0, wi);
        }
    }

    /// A ray that left the scene finds the environment, shared with the light sample of the surface before.
    fn add_escaped_radiance<V: PathVisitor>(&self, path: &mut Path, visitor: &mut V) {
        let is_hidden = path.depth == 1 && self.scene.render.emitters == Emitters::Hidden;
        if !self.lights.shows_outside() || is_hidden || !self.link_of_outside.lights(path.receiver) {
            return visitor.escaped(Spectrum::BLACK, 1.0, Spectrum::BLACK);
        }
        let radiance = self.lights.outside().radiance(path.ray.direction);
        let light_pdf = || self.lights.environment_pdf(&self.world, path.reference, path.ray.direction);
        let weight = self.emission_weight(path, light_pdf);
        let contribution = path.throughput * radiance * weight;
        path.radiance += contribution;
        visitor.escaped(radiance, weight, contribution);
    }

    /// Emission found by following the path, shared with the light sample of the surface before.
    fn add_emitted_radiance<V: PathVisitor>(&self, path: &mut Path, surface: &Surface, wo: DVec3, visitor: &mut V) {
        let radiance = emitted(&self.scene, surface, wo);
        if radiance.is_black() || !self.scene.light_links.of_material(surface.owner.material).lights(path.receiver) {
            return;
        }
        let weight = self.emission_weight(path, || self.lights.pdf((&self.world, &path.time), path.reference, surface));
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
                (light_pdf, Estimator::Mis | Estimator::Choose | Estimator::Bsdf) => {
                    Heuristic::from(settings).weight(pdf, light_pdf)
                }
            },
        }
    }

    /// Light is sampled where it is scattered so.
    fn samples_light(&self, scatterer: &Scatterer<'_>) -> bool {
        self.scene.render.estimator != Estimator::Bsdf && !self.lights.is_empty() && scatterer.has_non_delta_lobe()
    }

    /// Next event estimation: one light, one direction to it, f·|cosθ|·L / (probability · density), if
    /// nothing is in between.
    fn add_direct_light<V: PathVisitor>(
        &self,
        path: &mut Path,
        (interaction, reference_normal, receiver): (&Interaction<'_>, DVec3, ReceiverId),
        scatterer: &Scatterer<'_>,
        [choice, u, v]: [u32; 3],
        visitor: &mut V,
    ) {
        // Sample a light and a direction to it
        let settings = &self.scene.render;
        let point = interaction.point();
        let mut origin = point.leave_towards(scatterer.wo());
        visitor.round_point(&mut origin, point.magnitude());
        let reference = LightSampleContext::new(origin, reference_normal).of_receiver(receiver);
        let moment = (&self.world, &path.time);
        let numbers = visitor.round_light_numbers([u, v], || self.lights.magnifies(moment, reference, choice));
        let Some(light) = self.lights.sample(&self.scene, moment, reference, choice, numbers) else { return };
        // Several samples are as dense together as one of as many times its density
        let mut light = LightSample { pdf: light.pdf * f64::from(settings.light_samples_at(path.depth)), ..light };
        visitor.round_light(&mut light, &self.lights);

        // Weigh the sample: no BSDF sample finds a point light, and with `nee` BSDF samples leave all
        // emission to light samples
        let numbers = mix(choice ^ mix(u ^ mix(v)));
        let scattering = scatterer.evaluate(light.wi, numbers);
        if scattering.value.is_black() {
            return;
        }
        let weight = if light.delta || settings.estimator == Estimator::Nee {
            1.0
        } else {
            Heuristic::from(settings).weight(light.pdf, scattering.pdf)
        };

        // Trace the shadow ray: light that comes through the surface arrives on its other side
        let mut ray = Ray { origin: point.leave_towards(light.wi), direction: light.wi };
        visitor.round_ray(&mut ray, Some(point));
        visitor.ray(&ray);
        let stack = interaction.media_towards(path.stack, &self.media, light.wi);
        let through = self.shadow_transmittance(ray, &light, (stack, numbers), &path.time);
        let contribution = path.throughput * scattering.value * light.radiance * (weight / light.pdf) * through;
        path.radiance += contribution;
        if V::COMPARES {
            visitor.unguided(scatterer.unguided(light.wi, Density::SolidAngle(scattering.pdf)));
        }
        visitor.light(&LightConnection { light, bsdf_pdf: scattering.pdf, weight, visible: !through.is_black(), contribution });
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
