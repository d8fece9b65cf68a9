//! The path tracing estimator (Kajiya 1986; Veach 1997).
//!
//! Radiance that arrives along a ray leaves the surface it came from: L = Le + ∫ f(wo, wi) L(wi) |cosθi| dwi. The integral is
//! estimated at every surface by at most two samples: one direction towards a light (next event estimation), which finds emission
//! only, and one direction drawn from the BSDF, along which the path goes on. The product of all weights f·|cosθ| / density so far
//! is the path's throughput. Emission that both samples can find is shared out by multiple importance sampling, see
//! [`super::mis`].

use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::bsdf::{Bsdf, BsdfSample, Density};
use super::camera::ProjectiveCamera;
use super::emission::{emitted, null_weight};
use super::guided::GuidedBsdf;
use super::intersect::{Hit, Outline, Owner, PathTime, Ray, Surface, World};
use super::lights::{LightSample, Lights};
use super::mis;
use super::roulette::{self, Expectation};
use super::trace::{LightConnection, PathVisitor};
use super::volume::{Volumes, transmittance};
use crate::math::luminance;
use crate::renderer::RenderError;
use crate::sampling::light_way::LightWay;
use crate::sampling::{CameraDimension, Dimension, Guide, LightCells, LitPoint, PathSampler, VertexDimension};
use crate::scene::{ColorInput, Emission, Emitters, Estimator, LightChoice, MaterialId, RenderSettings, Scene};

/// A scene made ready for tracing paths.
#[derive(Debug, Clone)]
pub struct Integrator {
    scene: Scene,
    /// What the scene was moved by.
    center: DVec3,
    world: World,
    lights: Lights,
    camera: ProjectiveCamera,
    /// Something does.
    moves: bool,
    /// By material: it, or a part of its blend, gives light, and the camera does not see it.
    hidden: Vec<bool>,
    volumes: Volumes,
    /// From where light arrives, where that was learned.
    guide: Option<Arc<Guide>>,
}

/// A path under construction.
struct Path {
    ray: Ray,
    /// When it sees the scene.
    time: PathTime,
    /// Product of f·|cosθ| / density over the surfaces so far, roulette included.
    throughput: DVec3,
    /// What the path has found.
    radiance: DVec3,
    /// Product of eta² over the refractions so far: undoes the scaling of radiance, so that roulette does not end paths for being
    /// inside glass.
    eta_scale: f64,
    /// By which roulette ends guided paths.
    expectation: Expectation,
    /// How the ray's direction was sampled at the last vertex that is no null surface, and where the ray began there. Shadow rays from there
    /// go on through null surfaces as the path does, so both are weighed against each other by the densities that they have there.
    previous: Density,
    lit_from: LitPoint,
    /// Of what the ray goes through.
    extinction: DVec3,
    /// Edges of the path up to the end of the ray: the camera's has 1.
    depth: u32,
    /// Number of the next vertex, from 0: each has random numbers of its own. Null surfaces end no edge, else it would be depth − 1.
    vertex: u32,
}

impl Integrator {
    /// Takes positions relative to the scene's [center](Scene::center). Fails on what the reference cannot render.
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        scene.validate()?;
        let center = scene.center();
        let scene = &*scene.centered();
        let world = World::new(scene)?;
        let lights = Lights::new(scene, &world);
        let camera = ProjectiveCamera::of(scene);
        let instances_move = scene.instances.iter().any(|instances| instances.motion.is_some());
        let moves = instances_move || scene.shapes.iter().any(|shape| shape.motion.is_some());
        let hides = scene.render.emitters == Emitters::Hidden;
        let is_bright = |emission: &Emission| emission.radiance != ColorInput::Constant(DVec3::ZERO);
        let hidden = scene.materials_that(|material| hides && material.emission.as_ref().is_some_and(is_bright));
        let volumes = Volumes::new(scene);
        Ok(Self { scene: scene.clone(), center, world, lights, camera, moves, hidden, volumes, guide: None })
    }

    /// Draws directions by a guide as well, or by none.
    pub fn set_guide(&mut self, guide: Option<Arc<Guide>>) {
        self.guide = guide;
    }

    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_deref()
    }

    /// Looks at the scene as another frame's camera does; false where the scene is then to be moved elsewhere, and nothing has changed.
    pub fn set_camera(&mut self, scene: &Scene) -> bool {
        if scene.center() != self.center {
            return false;
        }
        let centered = scene.centered();
        (self.scene.camera, self.scene.exposure) = (centered.camera.clone(), centered.exposure.clone());
        self.camera = ProjectiveCamera::of(&self.scene);
        true
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Where the camera stands, relative to the scene's center, and where it looks.
    pub fn view_axis(&self) -> [DVec3; 2] {
        let camera = &self.scene.camera;
        [camera.position, -camera.frame()[2]]
    }

    /// What the ray through the middle of a pixel and of the lens meets when the shutter opens.
    pub fn owner_at_centre(&self, x: u32, y: u32) -> Option<Owner> {
        let ray = self.camera.ray(f64::from(x) + 0.5, f64::from(y) + 0.5, DVec2::ZERO, 0.0);
        let time = if self.moves { PathTime::new(&self.scene, self.scene.camera.shutter[0]) } else { PathTime::default() };
        let mut ray = ray;
        loop {
            let hit = self.world.closest(ray, &time)?;
            let surface = self.world.surface(&ray, &hit, &time);
            if !self.hidden[surface.owner.material] {
                return Some(surface.owner);
            }
            ray.origin = surface.point.leave_towards(ray.direction);
        }
    }

    /// Draws from lights as these settings say; all others stay.
    pub fn set_light_sampling(&mut self, settings: &RenderSettings) {
        let own = &mut self.scene.render;
        own.light_sampling = settings.light_sampling;
        (own.light_samples, own.light_samples_depth) = (settings.light_samples, settings.light_samples_depth);
        self.lights.set_sampling(settings.light_sampling);
    }

    /// Chooses lights in another one of the ways that were made ready; `auto` is power.
    pub fn set_light_choice(&mut self, choice: LightChoice) {
        if choice == self.scene.render.light_choice {
            return;
        }
        self.scene.render.light_choice = choice;
        self.lights.set_way(match choice {
            LightChoice::Auto | LightChoice::Power => LightWay::Power,
            LightChoice::Tree => LightWay::Tree,
            LightChoice::Cells => LightWay::Cells,
        });
    }

    /// What lights are chosen from.
    pub fn lights(&self) -> &Lights {
        &self.lights
    }

    /// What was learned of lights that are chosen by cells; None where they are chosen otherwise.
    pub fn light_cells(&self) -> Option<&Arc<LightCells>> {
        self.lights.in_cells().filter(|_| self.lights.way() == LightWay::Cells).map(|(choice, _)| &choice.cells)
    }

    /// Keeps what was learned, where lights may be chosen by cells.
    pub fn set_light_cells(&mut self, learned: Arc<LightCells>) {
        self.lights.set_cells(learned);
    }

    /// What a light brings to a point of a surface when the shutter opens: an estimate by two random numbers of the integral of luminance and cosine, without
    /// what stands in between and with it. No normal: whatever the cosine.
    pub fn light_reaching(&self, (from, normal): (LitPoint, DVec3), chosen: (usize, f64), numbers: [u32; 2]) -> [f64; 2] {
        let time = if self.moves { PathTime::new(&self.scene, self.scene.camera.shutter[0]) } else { PathTime::default() };
        let Some(sample) = self.lights.sample_light(&self.scene, (&self.world, &time), from, chosen, numbers) else {
            return [0.0; 2];
        };
        let cosine = if normal == DVec3::ZERO { 1.0 } else { sample.wi.dot(normal) };
        if cosine <= 0.0 {
            return [0.0; 2];
        }
        let unstopped = self.unstopped(Ray { origin: from.point, direction: sample.wi }, &sample, &time);
        let free = luminance(sample.radiance) * cosine / sample.pdf;
        [free, free * unstopped]
    }

    /// The share of a sample's light that comes through everything between the origin of its shadow ray and the light.
    fn unstopped(&self, shadow_ray: Ray, light: &LightSample, time: &PathTime) -> f64 {
        let share = |surface: &Surface| null_weight(&self.scene, surface, -shadow_ray.direction);
        let lets_through = |material: MaterialId| self.lights.lets_through(material);
        self.world.transmittance(shadow_ray, light.distance, light.target, time, lets_through, share)
    }

    /// How lights are chosen.
    pub fn light_way(&self) -> LightWay {
        self.lights.way()
    }

    /// Lets paths have so many edges; returns how many they had.
    pub fn set_max_depth(&mut self, max_depth: u32) -> u32 {
        std::mem::replace(&mut self.scene.render.max_depth, max_depth)
    }

    /// Of all surfaces.
    pub fn primitive_count(&self) -> usize {
        self.world.indices_in_scene_order().len()
    }

    /// Of lights that can be drawn from by solid angle as well as by area, what takes most to be drawn so. None: there are none.
    pub fn costliest_outline(&self) -> Option<Outline> {
        self.lights.costliest_outline(&self.scene, &self.world)
    }

    /// Changes what stratified random numbers depend on; nothing that was built from the scene does.
    pub fn set_samples_per_pixel(&mut self, spp: u32) {
        self.scene.render.spp = spp;
    }

    /// The radiance one sample of one pixel sees. `visitor` is told everything that happens.
    pub fn radiance<V: PathVisitor>(&self, x: u32, y: u32, sampler: &PathSampler, visitor: &mut V) -> DVec3 {
        let mut ray = self.camera.sample(x, y, sampler);
        visitor.round_ray(&mut ray, None);
        let mut path = Path {
            lit_from: ray.origin.into(),
            ray,
            time: self.path_time(sampler),
            throughput: DVec3::ONE,
            radiance: DVec3::ZERO,
            eta_scale: 1.0,
            expectation: Expectation::default(),
            previous: Density::Delta,
            extinction: DVec3::ZERO,
            depth: 1,
            vertex: 0,
        };
        while self.extend(&mut path, sampler, visitor) && !visitor.gives_up(path.vertex) {}
        path.radiance
    }

    /// Uniform over the time for which the shutter is open.
    fn path_time(&self, sampler: &PathSampler) -> PathTime {
        if !self.moves {
            return PathTime::default();
        }
        let [open, close] = self.scene.camera.shutter;
        PathTime::new(&self.scene, open + (close - open) * sampler.uniform(Dimension::camera(CameraDimension::Time)))
    }

    /// The first surface that a path's ray meets; where others are as close but for rounding, one of them.
    fn first_hit<V: PathVisitor>(&self, ray: &Ray, time: &PathTime, visitor: &mut V) -> Option<Hit> {
        let first = self.world.closest(*ray, time)?;
        if !V::ROUNDS {
            return Some(first);
        }
        let magnitude = ray.origin.abs().max(ray.at(first.distance).abs()).max_element();
        let (farther, number) = visitor.round_first(magnitude);
        if farther == 0.0 {
            return Some(first);
        }
        let mut met = self.world.hits_before(*ray, first.distance + farther, time);
        // At an edge, the limit may be what keeps the first from being met again.
        (!met.is_empty()).then(|| met.swap_remove(number as usize % met.len())).or(Some(first))
    }

    /// Follows the path's ray to the next surface, adds the light found there, and chooses the next ray. False where the path ends.
    fn extend<V: PathVisitor>(&self, path: &mut Path, sampler: &PathSampler, visitor: &mut V) -> bool {
        visitor.ray(&path.ray);
        let Some(hit) = self.first_hit(&path.ray, &path.time, visitor) else {
            path.throughput *= transmittance(path.extinction, f64::INFINITY);
            if path.depth == 1 && self.scene.render.emitters == Emitters::Hidden {
                visitor.escaped(DVec3::ZERO, 1.0, DVec3::ZERO);
            } else {
                self.add_environment(path, visitor);
            }
            return false;
        };
        let mut surface = self.world.surface(&path.ray, &hit, &path.time);
        surface.by_camera = path.depth == 1;
        visitor.round_surface(&mut surface);
        let wo = -path.ray.direction;
        path.throughput *= transmittance(path.extinction, surface.point.position.distance(path.ray.origin));
        visitor.surface(path.depth, &surface, wo, path.throughput);
        if path.depth == 1 && self.hidden[surface.owner.material] {
            self.go_behind(path, &surface, visitor);
            return true;
        }
        self.add_emission(path, &surface, wo, visitor);
        // At the greatest depth the ray goes on through null surfaces alone, and only blends have those: plain `pass` surfaces are not in the world.
        let is_last = path.depth == self.scene.render.max_depth;
        if is_last && !self.scene.materials[surface.owner.material].is_blend() {
            return false;
        }
        let vertex = path.vertex;
        let random = |dimension| sampler.uniform(Dimension::vertex(vertex, dimension));
        let bsdf = Bsdf::new(&self.scene, &surface, wo, visitor.round_number(random(VertexDimension::Blend)));
        visitor.view(&bsdf.view);
        let guided = GuidedBsdf::new(self.guide(), &surface, &bsdf);
        // By which cells of lights are told apart.
        let mut lit_normal = surface.point.normal_towards(wo);
        if V::ROUNDS {
            visitor.round_direction(&mut lit_normal);
        }
        if !is_last && V::LIGHTS {
            let depth = path.depth;
            for number in 0..self.scene.render.light_samples_at(depth) {
                self.add_direct_light(
                    path,
                    (&surface, lit_normal),
                    (&bsdf, &guided),
                    || sampler.light_bits(vertex, depth, number),
                    visitor,
                );
            }
        }
        let [u1, u2] = [VertexDimension::BsdfU, VertexDimension::BsdfV].map(|number| visitor.round_number(random(number)));
        let u_lobe = visitor.round_number(random(VertexDimension::Lobe));
        let Some(mut scattered) = guided.sample(u_lobe, u1, u2) else { return false };
        if V::ROUNDS {
            round_sample(&mut scattered, &guided, visitor);
        }
        if is_last && !scattered.is_null {
            return false;
        }
        if V::COMPARES {
            visitor.unguided(guided.unguided(scattered.wi, scattered.density));
        }
        visitor.scattered(&scattered);
        let BsdfSample { wi, weight, density, eta, is_null } = scattered;
        let arriving = path.throughput;
        path.throughput *= weight;
        path.eta_scale *= eta * eta;
        path.ray = Ray { origin: surface.point.leave_towards(wi), direction: wi };
        visitor.round_ray(&mut path.ray, Some(&surface.point));
        path.vertex += 1;
        if is_null {
            return true;
        }
        path.extinction = self.volumes.extinction_towards(&surface, bsdf.view.front, wi, path.extinction);
        path.previous = density;
        path.lit_from = LitPoint::new(path.ray.origin, lit_normal);
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
        visitor.scattered(&BsdfSample { wi, weight: DVec3::ONE, density: Density::Delta, eta: 1.0, is_null: true });
        path.ray = Ray { origin: surface.point.leave_towards(wi), direction: wi };
        visitor.round_ray(&mut path.ray, Some(&surface.point));
        path.vertex += 1;
    }

    /// A ray that left the scene finds the environment, shared with the light sample of the surface before.
    fn add_environment<V: PathVisitor>(&self, path: &mut Path, visitor: &mut V) {
        let radiance = self.lights.outside().radiance(path.ray.direction);
        let light_pdf = || self.lights.environment_pdf(&self.world, path.lit_from, path.ray.direction);
        let weight = self.weight_of_found(path, light_pdf);
        let contribution = path.throughput * radiance * weight;
        path.radiance += contribution;
        visitor.escaped(radiance, weight, contribution);
    }

    /// Emission found by following the path, shared with the light sample of the surface before.
    fn add_emission<V: PathVisitor>(&self, path: &mut Path, surface: &Surface, wo: DVec3, visitor: &mut V) {
        let radiance = emitted(&self.scene, surface, wo);
        if radiance == DVec3::ZERO {
            return;
        }
        let weight = self.weight_of_found(path, || self.lights.pdf((&self.world, &path.time), path.lit_from, surface));
        let contribution = path.throughput * radiance * weight;
        path.radiance += contribution;
        visitor.emission(radiance, weight, contribution);
    }

    /// The weight of light that a path's ray found, where one light sample of the surface before has the density `light_pdf`.
    fn weight_of_found(&self, path: &Path, light_pdf: impl Fn() -> f64) -> f64 {
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

    /// Next event estimation: one light, one direction to it, f·|cosθ|·L / (probability · density), if nothing is in between.
    fn add_direct_light<V: PathVisitor>(
        &self,
        path: &mut Path,
        (surface, lit_normal): (&Surface, DVec3),
        (bsdf, guided): (&Bsdf, &GuidedBsdf),
        bits: impl Fn() -> [u32; 3],
        visitor: &mut V,
    ) {
        let settings = &self.scene.render;
        if settings.estimator == Estimator::Bsdf || self.lights.is_empty() || !bsdf.has_non_delta_lobe() {
            return;
        }
        let [choice, u, v] = bits();
        let wo = bsdf.view.wo;
        let mut lit = surface.point.leave_towards(wo);
        visitor.round_point(&mut lit, surface.point.magnitude());
        let reference = LitPoint::new(lit, lit_normal);
        let magnified = if V::ROUNDS { self.lights.magnifies((&self.world, &path.time), reference, choice) } else { 1.0 };
        let [u, v] = [u, v].map(|bits| visitor.round_bits(bits, magnified));
        let Some(light) = self.lights.sample(&self.scene, (&self.world, &path.time), reference, choice, [u, v]) else { return };
        // Several samples are as dense together as one of as many times its density.
        let mut light = LightSample { pdf: light.pdf * f64::from(settings.light_samples_at(path.depth)), ..light };
        if V::ROUNDS {
            self.round_light(&mut light, visitor);
        }
        let scattering = guided.evaluate(light.wi);
        if scattering.value == DVec3::ZERO {
            return;
        }
        // A point light is found by no BSDF sample; with `nee`, BSDF samples leave all emission to this one.
        let weight = if light.delta || settings.estimator == Estimator::Nee {
            1.0
        } else {
            mis::weight(settings.heuristic, light.pdf, scattering.pdf)
        };
        // Light that comes through the surface arrives on its other side.
        let mut ray = Ray { origin: surface.point.leave_towards(light.wi), direction: light.wi };
        visitor.round_ray(&mut ray, Some(&surface.point));
        visitor.ray(&ray);
        let unstopped = self.unstopped(ray, &light, &path.time);
        let unshadowed = path.throughput * scattering.value * light.radiance * (weight / light.pdf);
        let extinction = self.volumes.extinction_towards(surface, bsdf.view.front, light.wi, path.extinction);
        let contribution = unshadowed * unstopped * transmittance(extinction, light.distance);
        path.radiance += contribution;
        if V::COMPARES {
            visitor.unguided(guided.unguided(light.wi, Density::SolidAngle(scattering.pdf)));
        }
        visitor.light(&LightConnection { light, bsdf_pdf: scattering.pdf, weight, visible: unstopped > 0.0, contribution });
    }

    /// A sample of a light, its direction and length rounded. What comes from outside the scene depends on the direction alone.
    fn round_light<V: PathVisitor>(&self, light: &mut LightSample, visitor: &mut V) {
        visitor.round_direction(&mut light.wi);
        visitor.round_length(&mut light.distance);
        if light.distance.is_infinite() && !light.delta {
            light.radiance = self.lights.outside().radiance(light.wi);
        }
    }

    /// Russian roulette: the path goes on with probability q and then counts 1/q times as much, which leaves the mean as it is.
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

/// A sampled direction, rounded, with the density that belongs to it. Of a narrow lobe that changes much faster than the direction.
fn round_sample<V: PathVisitor>(sample: &mut BsdfSample, bsdf: &GuidedBsdf, visitor: &mut V) {
    let exact = bsdf.evaluate(sample.wi).pdf;
    visitor.round_direction(&mut sample.wi);
    let rounded = bsdf.evaluate(sample.wi).pdf;
    if let Density::SolidAngle(pdf) = &mut sample.density
        && exact > 0.0
        && rounded > 0.0
    {
        *pdf *= rounded / exact;
    }
}
