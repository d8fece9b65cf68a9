//! Lights that next event estimation samples: those of [`LightList`], in its order.
//!
//! Portals are one more way of drawing directions to the environment. A direction to it then has one density, that of all ways together,
//! whichever of them drew it.

mod delta;
mod directional;
mod environment;
mod outside;
mod point;
mod projected_picture;
mod projector;
mod sky;
mod spot;

use std::collections::HashMap;
use std::f64::consts::PI;
use std::ops::Range;
use std::sync::Arc;

use glam::{DVec2, DVec3};

use super::emission::{emitted, mean_exitance};
use super::intersect::{Outline, Owner, PathTime, PreparedRay, Primitive, Ray, Surface, SurfaceId, World};
use super::work;
use crate::emission_map::{EmissionMaps, EmitterPart, Unrolled};
use crate::sampling::light_cells::{LightCellChoice, LightCells, LightSampleContext};
use crate::sampling::light_list::{EmittingSurface, LightList, LightSource, OutsideLight, links_of};
use crate::sampling::light_strategy::LightStrategy;
use crate::sampling::light_tree::Emitter;
use crate::sampling::sampler::uniform;
use crate::sampling::{AliasTable, HierarchicalWarp, LightTree};
use crate::scene::light::light_table;
use crate::scene::{Light, LightSampling, LinkMask, MaterialId, MaterialKind, ReceiverId, Scene};
use crate::spectrum::Spectrum;
use delta::DeltaLight;
pub use outside::Outside;

/// Relative amount by which a shadow segment stops short of the light's point, so that what the light lies upon does not block it.
const SHADOW_MARGIN: f64 = 1e-12;

/// Dispatch over the rows of the table of lights, which are a module each.
macro_rules! modules {
    (environment { $($environment:ident($_outside:ident) $environment_module:ident $_switch:ident $($_needed:ident)*,)* }
     delta { $($delta:ident($_type:ident) $delta_module:ident $_number:ident $($_delta_needed:ident)*,)* }) => {
        fn outside_light(light: &Light) -> Option<Outside> {
            match light {
                $(Light::$environment(light) => Some($environment_module::new(light)),)*
                $(Light::$delta(_) => None,)*
            }
        }

        fn delta_light(scene: &Scene, light: &Light) -> Option<Arc<dyn DeltaLight>> {
            match light {
                $(Light::$environment(_) => None,)*
                $(Light::$delta(light) => Some(Arc::new($delta_module::new(light, scene))),)*
            }
        }
    };
}
light_table!(modules);

/// Something that can be chosen for light sampling.
#[derive(Debug, Clone)]
enum SampledLight {
    /// An emitting primitive, by its index in the hierarchy's leaf order.
    Area(usize),
    Delta(Arc<dyn DeltaLight>),
    Environment,
    /// By its index among the world's portals.
    Portal(usize),
}

/// All lights of a scene, with the table they are chosen from.
#[derive(Debug, Clone)]
pub struct Lights {
    lights: Vec<SampledLight>,
    /// How many of them stand inside the scene; those at infinity are numbered behind.
    local_count: usize,
    /// How many groups they make.
    group_count: usize,
    strategy: LightStrategy,
    table: AliasTable,
    /// The tree of several lights inside the scene, where they may be chosen by it or by cells, which are
    /// learned by its help. Lights at infinity have the
    /// probabilities of the table all the same.
    tree: Option<LightTree>,
    /// The choice by cells, where lights may be chosen by them.
    cells: Option<LightCellChoice>,
    /// Index into `lights` by leaf-order index of the primitive.
    of_primitive: Vec<Option<u32>>,
    outside: Outside,
    /// The light from outside is to be seen.
    shows_outside: bool,
    /// By light, the number in the scene of a delta light.
    delta_numbers: Vec<Option<usize>>,
    /// By light: it is a delta light that is not to be seen.
    is_hidden: Vec<bool>,
    /// By light, which receivers it lights; empty where each lights all.
    links: Vec<LinkMask>,
    /// Index of the environment among the lights, where it is one.
    environment_light: Option<usize>,
    /// Index of the first portal among the lights.
    first_portal: usize,
    /// By material: light comes through, so a surface of it hides no part of itself from light samples.
    lets_through: Vec<bool>,
    sampling: LightSampling,
    /// By material and way: what points of shapes that are unrolled so are drawn by, where that is not evenly.
    warps: HashMap<(MaterialId, Unrolled), Arc<HierarchicalWarp>>,
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
    pub radiance: Spectrum,
    /// Probability of the light times density of the direction per steradian; for a point light, the probability alone.
    pub pdf: f64,
    /// The direction was the only one the light has.
    pub delta: bool,
    /// The primitive the segment ends on. Where it is opaque, the direction leads to a part of it that it does not hide.
    pub target: Option<usize>,
}

impl Lights {
    pub fn new(scene: &Scene, world: &World) -> Self {
        // Once a material, not once a primitive: a texture's mean looks at all of it.
        let emits = scene.materials_that(|material| material.emission.is_some());
        let exitances: Vec<f64> = (0..emits.len()).map(|id| if emits[id] { mean_exitance(scene, id) } else { 0.0 }).collect();
        let two_sided = scene.materials_that(|material| material.emission.is_some_and(|emission| emission.two_sided));
        let maps = EmissionMaps::new(scene);
        let (mut indices, mut surfaces, mut warps) = (Vec::new(), Vec::new(), HashMap::new());
        for &index in world.indices_in_scene_order() {
            let Owner { shape, material, .. } = world.owner(SurfaceId::Primitive(index));
            if exitances[material] == 0.0 {
                continue;
            }
            let of_part =
                world.emitter_part(index).and_then(|part| exitance_of_part(&maps, (material, two_sided[material]), &part));
            let power = world.primitive(index).area() * of_part.unwrap_or(exitances[material]);
            if power > 0.0 {
                if let Some(unrolled) = world.primitive(index).element().unrolled() {
                    warps.extend(maps.warp(material, unrolled).map(|warp| ((material, unrolled), warp.clone())));
                }
                indices.push(index);
                surfaces.push(EmittingSurface { shape, material, power });
            }
        }
        let outside = Outside::of(scene.lights.iter().filter_map(outside_light));
        let outside_light = OutsideLight { mean_luminance: outside.mean_luminance(), is_constant: outside.is_constant() };
        let areas: Vec<f64> = world.portals().iter().map(Primitive::area).collect();
        let LightList { sources, sampler } = LightList::new(scene, &surfaces, outside_light, &areas);
        let mut of_primitive = vec![None; world.indices_in_scene_order().len()];
        let sampled = |(light, source): (usize, &LightSource)| match *source {
            LightSource::Surface(number) => {
                of_primitive[indices[number]] = Some(light as u32);
                Some(SampledLight::Area(indices[number]))
            }
            LightSource::Delta(number) => delta_light(scene, &scene.lights[number]).map(SampledLight::Delta),
            LightSource::Environment => Some(SampledLight::Environment),
            LightSource::Portal(number) => Some(SampledLight::Portal(number)),
        };
        let lights: Vec<SampledLight> = sources.iter().enumerate().filter_map(sampled).collect();
        let delta_number = |source: &LightSource| match *source {
            LightSource::Delta(number) => Some(number),
            _ => None,
        };
        let delta_numbers: Vec<Option<usize>> = sources.iter().map(delta_number).collect();
        let is_hidden = vec![false; delta_numbers.len()];
        let links = links_of(scene, &sources, &surfaces);
        let local_count = sampler.local_count();
        let environment_light = sources.iter().position(|source| *source == LightSource::Environment);
        let first_portal = sources.iter().position(|source| matches!(source, LightSource::Portal(_))).unwrap_or(sources.len());
        let sampling = scene.render.light_sampling;
        let (strategy, group_count) = (LightStrategy::of(scene.render.light_choice, &sampler), sampler.group_count());
        let has_tree = strategy != LightStrategy::Power && local_count > 1;
        let tree = has_tree.then(|| LightTree::new(&emitters(scene, world, &indices, &surfaces), sampler.table_at_infinity()));
        let table = sampler.table();
        let cells = (strategy == LightStrategy::Cells).then(|| LightCellChoice::new(table.clone()));
        Self {
            lights,
            local_count,
            group_count,
            strategy,
            table,
            tree,
            cells,
            of_primitive,
            outside,
            shows_outside: true,
            delta_numbers,
            is_hidden,
            links,
            environment_light,
            first_portal,
            lets_through: scene.materials_that(|material| matches!(material.kind, MaterialKind::Pass)),
            sampling,
            warps,
        }
    }

    /// The density by which points of a primitive are drawn, where that is not even.
    fn warp(&self, world: &World, index: usize) -> Option<(Unrolled, &HierarchicalWarp)> {
        if self.warps.is_empty() {
            return None;
        }
        let unrolled = world.primitive(index).element().unrolled()?;
        let warp: &HierarchicalWarp = self.warps.get(&(world.owner(SurfaceId::Primitive(index)).material, unrolled))?;
        Some((unrolled, warp))
    }

    /// The light that 32 random bits choose at a point, and the probability of that.
    fn choose(&self, from: LightSampleContext, bits: u32) -> (usize, f64) {
        match (self.strategy, &self.cells, &self.tree) {
            (LightStrategy::Cells, Some(cells), _) => cells.choose(from, bits),
            (LightStrategy::Tree, _, Some(tree)) => tree.choose(from.point, bits),
            _ => {
                let light = self.table.choose(bits);
                (light, self.table.pmf[light])
            }
        }
    }

    /// By how much drawing a direction to the light that these bits choose magnifies rounding errors of its random numbers.
    pub fn magnifies(&self, (world, time): (&World, &PathTime), from: LightSampleContext, choice: u32) -> f64 {
        match self.lights[self.choose(from, choice).0] {
            SampledLight::Area(index) => {
                let pose = world.pose(index, time);
                world.primitive(index).element().magnifies(pose, self.sampling, from.point)
            }
            _ => 1.0,
        }
    }

    /// The probability with which a light is chosen at a point.
    fn probability(&self, from: LightSampleContext, light: usize) -> f64 {
        match (self.strategy, &self.cells, &self.tree) {
            (LightStrategy::Cells, Some(cells), _) => cells.probability(from, light),
            (LightStrategy::Tree, _, Some(tree)) if light < self.local_count => tree.probability(from.point, light),
            _ => self.table.pmf[light],
        }
    }

    /// How many lights inside the scene there are.
    pub fn local_count(&self) -> usize {
        self.local_count
    }

    /// How many lights there are that differ by more than where on one surface they lie, or by which way one environment is drawn from.
    pub fn group_count(&self) -> usize {
        self.group_count
    }

    /// Lights at infinity, the environment and its portals together.
    pub fn groups_at_infinity(&self) -> impl Iterator<Item = Range<usize>> {
        let environment = self.environment_light.unwrap_or(self.first_portal)..self.lights.len();
        let alone = (self.local_count..environment.start).map(|light| light..light + 1);
        alone.chain((!environment.is_empty()).then_some(environment))
    }

    /// How lights are chosen by cells, where they may be, and a tree of those inside the scene, where they are several.
    pub fn in_cells(&self) -> Option<(&LightCellChoice, Option<&LightTree>)> {
        Some((self.cells.as_ref()?, self.tree.as_ref()))
    }

    /// Keeps what was learned, where lights may be chosen by cells.
    pub fn set_cells(&mut self, learned: Arc<LightCells>) {
        if let Some(cells) = &mut self.cells {
            cells.cells = learned;
        }
    }

    /// Chooses lights in another way, out of those that were made ready.
    pub fn set_strategy(&mut self, strategy: LightStrategy) {
        self.strategy = strategy;
    }

    /// Sees no light but that of surfaces, whose materials say it, and of what the scene shows.
    pub fn hide_other_groups(&mut self, scene: &Scene) {
        self.shows_outside = scene.shows_outside();
        let groups = &scene.light_groups;
        let is_hidden = |number: &Option<usize>| number.is_some_and(|number| !groups.shows(groups.of_light(number)));
        self.is_hidden = self.delta_numbers.iter().map(is_hidden).collect();
    }

    /// How lights are chosen.
    pub fn strategy(&self) -> LightStrategy {
        self.strategy
    }

    /// Some light goes straight through surfaces of this material.
    pub fn lets_through(&self, material: MaterialId) -> bool {
        self.lets_through[material]
    }

    pub fn is_empty(&self) -> bool {
        self.lights.is_empty()
    }

    /// Draws points of surfaces in another way.
    pub fn set_sampling(&mut self, sampling: LightSampling) {
        self.sampling = sampling;
    }

    /// The costliest outline of a light whose points can be drawn by solid angle as well as by area. None:
    /// there is no such light.
    pub fn costliest_outline(&self, scene: &Scene, world: &World) -> Option<Outline> {
        let opening = PathTime::new(scene, 0.0);
        let outline = |light: &SampledLight| match *light {
            SampledLight::Area(index) if world.pose(index, &opening).is_none() && self.warp(world, index).is_none() => {
                world.primitive(index).element().flat().map(|flat| flat.outline)
            }
            _ => None,
        };
        self.lights.iter().filter_map(outline).max()
    }

    /// The light from outside the scene is to be seen.
    pub fn shows_outside(&self) -> bool {
        self.shows_outside
    }

    /// Everything outside the scene.
    pub fn outside(&self) -> &Outside {
        &self.outside
    }

    /// Chooses a light by 32 random bits and draws a direction to it by 32 each. None where no light comes from there.
    pub fn sample(
        &self,
        scene: &Scene,
        moment: (&World, &PathTime),
        from: impl Into<LightSampleContext>,
        choice: u32,
        numbers: [u32; 2],
    ) -> Option<LightSample> {
        let from = from.into();
        self.sample_light(scene, moment, from, self.choose(from, choice), numbers)
    }

    /// [`Lights::sample`] for a light that was chosen with a probability.
    pub fn sample_light(
        &self,
        scene: &Scene,
        (world, time): (&World, &PathTime),
        from: LightSampleContext,
        (light, probability): (usize, f64),
        [u, v]: [u32; 2],
    ) -> Option<LightSample> {
        if !self.are_linked(light, from.receiver) {
            return None;
        }
        let reference = from.point;
        let (u1, u2) = (uniform(u), uniform(v));
        let sampled = &self.lights[light];
        let sample = |wi, distance, radiance: Spectrum, pdf, target| {
            (!radiance.is_black()).then_some(LightSample {
                light,
                wi,
                distance,
                radiance,
                pdf,
                delta: matches!(sampled, SampledLight::Delta(_)),
                target,
            })
        };
        match *sampled {
            SampledLight::Area(index) => {
                let (element, pose) = (world.primitive(index).element(), world.pose(index, time));
                let place = (pose, !self.lets_through(world.owner(SurfaceId::Primitive(index)).material));
                let (direction, density) = match self.warp(world, index) {
                    None => (element.sample(place, self.sampling, reference, u1, u2)?, 1.0),
                    Some((unrolled, warp)) => {
                        let drawn = warp.sample(u, v);
                        let (below, area) = unrolled.area_below(drawn.v, warp.height);
                        let numbers = element.numbers_of_place(pose, DVec2::new(drawn.u, below));
                        (element.sample(place, LightSampling::Area, reference, numbers.x, numbers.y)?, drawn.density / area)
                    }
                };
                let surface = world.surface_at(index, direction.point, direction.local, time);
                let radiance = emitted(scene, &surface, -direction.wi);
                let distance = direction.distance * (1.0 - SHADOW_MARGIN);
                let pdf = density * direction.pdf_solid_angle;
                let usable = pdf > 0.0 && pdf.is_finite();
                if usable { sample(direction.wi, distance, radiance, probability * pdf, Some(index)) } else { None }
            }
            SampledLight::Delta(_) if self.is_hidden[light] => None,
            SampledLight::Environment | SampledLight::Portal(_) if !self.shows_outside => None,
            SampledLight::Delta(ref light) => {
                let arriving = light.arriving(reference)?;
                sample(arriving.wi, arriving.distance, arriving.irradiance, probability, None)
            }
            SampledLight::Environment => {
                let drawn = self.outside.sample(u, v)?;
                let pdf = probability * drawn.pdf + self.portal_pdf(world, from, drawn.wi);
                sample(drawn.wi, f64::INFINITY, drawn.radiance, pdf, None)
            }
            SampledLight::Portal(portal) => {
                let wi = world.portals()[portal].element().sample_through(LightSampling::Cone, reference, u1, u2)?.wi;
                let pdf = self.environment_pdf(world, from, wi);
                // By rounding, a direction to a portal's very edge may miss it.
                if pdf > 0.0 { sample(wi, f64::INFINITY, self.outside.radiance(wi), pdf, None) } else { None }
            }
        }
    }

    /// A light lights a receiver.
    fn are_linked(&self, light: usize, receiver: ReceiverId) -> bool {
        self.links.get(light).is_none_or(|mask| mask.lights(receiver))
    }

    /// The place of the light that is chosen at a point, by bits as [`Lights::sample`] has them: a point of its surface, the centre of a sphere, or
    /// its position. None of lights at infinity.
    pub fn place(
        &self,
        (world, time): (&World, &PathTime),
        from: LightSampleContext,
        choice: u32,
        [u, v]: [u32; 2],
    ) -> Option<DVec3> {
        let (light, probability) = self.choose(from, choice);
        match &self.lights[light] {
            _ if probability == 0.0 => None,
            SampledLight::Area(index) => {
                world.primitive(*index).element().place(world.pose(*index, time), uniform(u), uniform(v))
            }
            SampledLight::Delta(light) => light.position(),
            SampledLight::Environment | SampledLight::Portal(_) => None,
        }
    }

    /// Density, per steradian, with which [`Lights::sample`] draws the direction `wi` for the environment, by whichever way; 0 where it
    /// cannot.
    pub fn environment_pdf(&self, world: &World, from: impl Into<LightSampleContext>, wi: DVec3) -> f64 {
        let from = from.into();
        let itself = self.environment_light.map_or(0.0, |light| self.probability(from, light) * self.outside.pdf(wi));
        itself + self.portal_pdf(world, from, wi)
    }

    fn portal_pdf(&self, world: &World, from: LightSampleContext, wi: DVec3) -> f64 {
        let portals = self.first_portal..self.lights.len();
        if portals.is_empty() {
            return 0.0;
        }
        work::add(work::PART * portals.len() as u64);
        let ray = PreparedRay::new(Ray { origin: from.point, direction: wi });
        let through = |portal: &Primitive| portal.element().pdf_through(LightSampling::Cone, &ray);
        world.portals().iter().zip(portals).map(|(portal, light)| self.probability(from, light) * through(portal)).sum()
    }

    /// Density, per steradian, with which [`Lights::sample`] finds the point `surface` from `reference`; 0 where it cannot.
    pub fn pdf(&self, (world, time): (&World, &PathTime), from: impl Into<LightSampleContext>, surface: &Surface) -> f64 {
        let from = from.into();
        let reference = from.point;
        let SurfaceId::Primitive(index) = surface.id else { return 0.0 };
        let Some(light) = self.of_primitive[index] else { return 0.0 };
        let pose = world.pose(index, time);
        let element = world.primitive(index).element();
        let pdf = match self.warp(world, index) {
            None => element.pdf(pose, self.sampling, reference, &surface.point),
            Some((unrolled, warp)) => {
                let (_, area) = unrolled.area_below(surface.uv.y, warp.height);
                let density = warp.density(surface.uv.x, surface.uv.y) / area;
                density * element.pdf(pose, LightSampling::Area, reference, &surface.point)
            }
        };
        self.probability(from, light as usize) * pdf
    }
}

/// [`mean_exitance`] for the part of a material that lies between these texture coordinates; None: nothing
/// more is known of it.
fn exitance_of_part(maps: &EmissionMaps, (material, two_sided): (MaterialId, bool), part: &EmitterPart) -> Option<f64> {
    Some(PI * maps.luminance(material, part)? * if two_sided { 2.0 } else { 1.0 })
}

/// The lights inside the scene for the tree, in their order; the surfaces among them are these primitives.
fn emitters(scene: &Scene, world: &World, indices: &[usize], surfaces: &[EmittingSurface]) -> Vec<Emitter> {
    let two_sided = scene.materials_that(|material| material.emission.is_some_and(|emission| emission.two_sided));
    let of_surface = |(&index, &EmittingSurface { shape, material, power }): (&usize, &EmittingSurface)| {
        let (element, shape) = (world.primitive(index).element(), &scene.shapes[shape]);
        let bounds = element.bounds().unwrap_or_default();
        if shape.motion.is_some() {
            return Emitter::moving(shape, scene.camera.shutter, bounds, power);
        }
        Emitter::surface(bounds, element.normal(), two_sided[material], power)
    };
    let delta_lights = scene.lights.iter().filter_map(Light::delta).filter(|light| light.strength.is_positive());
    indices.iter().zip(surfaces).map(of_surface).chain(delta_lights.filter_map(|light| Emitter::delta(&light))).collect()
}

#[cfg(test)]
mod environment_tests;
#[cfg(test)]
mod tests;
