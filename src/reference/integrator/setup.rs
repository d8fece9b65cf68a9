//! An integrator made ready: what it is made of, what may be changed afterwards, and what may be asked of it.

use std::sync::Arc;

use glam::DVec3;

use super::Integrator;
use crate::reference::camera::CameraRays;
use crate::reference::intersect::{Outline, Owner, PathTime, Ray, World};
use crate::reference::layer::DepthMeasure;
use crate::reference::layered::LayersOfMaterials;
use crate::reference::lights::Lights;
use crate::reference::medium::MediumStack;
use crate::renderer::RenderError;
use crate::sampling::hash::mix;
use crate::sampling::light_strategy::LightStrategy;
use crate::sampling::{Guide, LightCells, LightSampleContext};
use crate::scene::{ColorInput, Emission, Emitters, LightChoice, Media, RenderSettings, Scene};
use crate::spectrum::Spectrum;

impl Integrator {
    /// Takes positions relative to the scene's [center](Scene::center). Fails on what the reference cannot
    /// render.
    pub fn new(scene: &Scene) -> Result<Self, RenderError> {
        scene.validate()?;
        let center = scene.center();
        let scene = &*scene.centered();
        let world = World::new(scene)?;
        let lights = Lights::new(scene, &world);
        let camera = CameraRays::of(scene);
        let instances_move = scene.instances.iter().any(|instances| instances.motion.is_some());
        let moves = instances_move || scene.shapes.iter().any(|shape| shape.motion.is_some());
        let hides = scene.render.emitters == Emitters::Hidden;
        let is_bright = |emission: &Emission| emission.radiance != ColorInput::Constant(Spectrum::BLACK);
        let hidden = scene.materials_that(|material| hides && material.emission.as_ref().is_some_and(is_bright));
        let media = Media::of(scene);
        let layers = LayersOfMaterials::new(scene);
        let (receivers, link_of_outside) = (scene.receivers(), scene.link_of_outside());
        let scene = scene.clone();
        Ok(Self { scene, center, world, lights, camera, moves, hidden, media, layers, receivers, link_of_outside, guide: None })
    }

    /// Sees light of one group alone, where the scene says so ([`Scene::in_light_of`]). All that was learned and made ready of all light stays: paths and
    /// weights are those of the picture.
    pub fn hide_other_groups(&mut self) {
        let groups = &self.scene.light_groups;
        for (id, material) in self.scene.materials.iter_mut().enumerate() {
            if let Some(emission) = material.emission.as_mut().filter(|_| !groups.shows(groups.of_material(id))) {
                emission.radiance = ColorInput::grey(0.0);
            }
        }
        self.lights.hide_other_groups(&self.scene);
    }

    /// Draws directions by a guide as well, or by none.
    pub fn set_guide(&mut self, guide: Option<Arc<Guide>>) {
        self.guide = guide;
    }

    pub fn guide(&self) -> Option<&Guide> {
        self.guide.as_deref()
    }

    /// Looks at the scene as another frame's camera does; false where the scene is then to be moved
    /// elsewhere, and nothing has changed.
    pub fn set_camera(&mut self, scene: &Scene) -> bool {
        if scene.center() != self.center {
            return false;
        }
        let centered = scene.centered();
        (self.scene.camera, self.scene.exposure) = (centered.camera.clone(), centered.exposure.clone());
        self.camera = CameraRays::of(&self.scene);
        true
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// How depth is measured, relative to the scene's center.
    pub fn depth_measure(&self) -> DepthMeasure {
        let camera = &self.scene.camera;
        let forward = camera.measures_depth_along_axis().then(|| -camera.frame()[2]);
        DepthMeasure { origin: camera.position, forward }
    }

    /// The owner of the surface that the ray through the middle of a pixel and of the lens meets when the
    /// pixel is first exposed.
    pub fn owner_at_centre(&self, x: u32, y: u32) -> Option<Owner> {
        let mut ray = self.camera.middle(x, y)?;
        let time = if self.moves { self.time_within_exposure(self.camera.start(y)) } else { PathTime::default() };
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
        self.lights.set_strategy(match choice {
            LightChoice::Auto | LightChoice::Power => LightStrategy::Power,
            LightChoice::Tree => LightStrategy::Tree,
            LightChoice::Cells => LightStrategy::Cells,
        });
    }

    /// The lights that are sampled.
    pub fn lights(&self) -> &Lights {
        &self.lights
    }

    /// The cells by which lights are chosen; None where they are chosen otherwise.
    pub fn light_cells(&self) -> Option<&Arc<LightCells>> {
        self.lights.in_cells().filter(|_| self.lights.strategy() == LightStrategy::Cells).map(|(choice, _)| &choice.cells)
    }

    /// Keeps what was learned, where lights may be chosen by cells.
    pub fn set_light_cells(&mut self, learned: Arc<LightCells>) {
        self.lights.set_cells(learned);
    }

    /// Light that one of the lights brings to a point of a surface when the shutter opens: an estimate, by two
    /// random numbers, of the integral of luminance and cosine, without what stands in between and with it.
    /// Without a normal the cosine counts as 1.
    pub fn light_reaching(
        &self,
        (from, normal): (LightSampleContext, DVec3),
        chosen: (usize, f64),
        numbers: [u32; 2],
    ) -> [f64; 2] {
        let time = if self.moves { PathTime::new(&self.scene, self.scene.camera.shutter[0]) } else { PathTime::default() };
        let Some(sample) = self.lights.sample_light(&self.scene, (&self.world, &time), from, chosen, numbers) else {
            return [0.0; 2];
        };
        let cosine = if normal == DVec3::ZERO { 1.0 } else { sample.wi.dot(normal) };
        if cosine <= 0.0 {
            return [0.0; 2];
        }
        let ray = Ray { origin: from.point, direction: sample.wi };
        let media = (MediumStack::around(self.media.around_camera), mix(numbers[0] ^ mix(numbers[1])));
        let through = self.shadow_transmittance(ray, &sample, media, &time);
        let free = sample.radiance.luminance() * cosine / sample.pdf;
        // Surfaces let as much of every channel through.
        [free, free * through.max_component()]
    }

    /// How lights are chosen.
    pub fn light_strategy(&self) -> LightStrategy {
        self.lights.strategy()
    }

    /// Lets paths have so many edges; returns how many they had.
    pub fn set_max_depth(&mut self, max_depth: u32) -> u32 {
        std::mem::replace(&mut self.scene.render.max_depth, max_depth)
    }

    /// Primitives of all surfaces.
    pub fn primitive_count(&self) -> usize {
        self.world.indices_in_scene_order().len()
    }

    /// The costliest outline of a light whose points can be drawn by solid angle as well as by area. None: there
    /// is no such light.
    pub fn costliest_outline(&self) -> Option<Outline> {
        self.lights.costliest_outline(&self.scene, &self.world)
    }

    /// Changes what stratified random numbers depend on; nothing that was built from the scene does.
    pub fn set_samples_per_pixel(&mut self, spp: u32) {
        self.scene.render.spp = spp;
    }
}
