//! A scene made ready on a device, which hands over rows of the picture as they are finished.

use std::io;
use std::time::{Duration, Instant};

use super::checkpoint::{Checkpoint, Identity};
use super::free_memory::FreeMemory;
use super::image::Image;
use super::intervals::interval_goal;
use super::options::RenderOptions;
use super::progressive::{self, Goal, Outcome};
use crate::confidence::IntervalGoal;
use crate::device::{ChosenDevice, ChosenRenderer};
use crate::error::Error;
use crate::film::Band;
use crate::output::Provenance;
use crate::renderer::{self, Change, Observer, RenderError};
use crate::scene::{BulkDigest, Scene};

/// A scene made ready on a device: packed, uploaded, its kernels compiled. It may be rendered any number of times.
///
/// ```no_run
/// let scene = gpt::Scene::load("veach-mis")?;
/// let mut renderer = gpt::Renderer::new(&scene, &gpt::RenderOptions::default())?;
/// println!("on {}", renderer.device());
/// let outcome = renderer.render(&gpt::Silent, &mut |band: gpt::Band| {
///     println!("rows {} to {} are finished", band.first_row, band.first_row + band.rows);
///     Ok(())
/// })?;
/// println!("{} rays", outcome.report.rays);
/// # Ok::<(), gpt::Error>(())
/// ```
pub struct Renderer {
    renderer: Box<dyn renderer::Renderer>,
    notice: Option<String>,
    options: RenderOptions,
    /// Width and height of the whole picture, and of the region that is rendered.
    film: [u32; 2],
    size: [u32; 2],
    provenance: Provenance,
    bulk: BulkDigest,
    interval: Option<IntervalGoal>,
    /// Dropped behind the renderer.
    memory: FreeMemory,
}

impl Renderer {
    /// Opens the device and makes the scene ready on it.
    ///
    /// # Errors
    /// Options that contradict each other, no such device, or a scene that does not fit it.
    pub fn new(scene: &Scene, options: &RenderOptions) -> Result<Self, Error> {
        let scene = options.applied(scene)?;
        let choice = ChosenDevice::begin(&options.device, &options.plan_options());
        Ok(Self::on(choice, &scene, options)?)
    }

    /// Begins to open the device, so that it opens while the scene is read.
    #[doc(hidden)]
    pub fn begin(options: &RenderOptions) -> ChosenDevice {
        ChosenDevice::begin(&options.device, &options.plan_options())
    }

    /// Does the work of [`Renderer::new`] with a choice that began with these options and a scene to which
    /// they are applied.
    ///
    /// # Errors
    /// The errors of [`Renderer::new`].
    #[doc(hidden)]
    pub fn on(choice: ChosenDevice, scene: &Scene, options: &RenderOptions) -> Result<Self, RenderError> {
        let ChosenRenderer { renderer, notice } = choice.renderer(scene, &options.plan_options())?;
        let bulk = BulkDigest::of(scene);
        let provenance = Self::provenance_with(&bulk, scene, options, renderer.device());
        let film = scene.film.size;
        let size = options.crop.map_or(film, |[_, _, width, height]| [width, height]);
        let interval = options.interval.map(|interval| interval_goal(scene, &interval));
        Ok(Self { renderer, notice, options: options.clone(), film, size, provenance, bulk, interval, memory: FreeMemory })
    }

    /// Goes on to another frame of the scene, on the same device and with all that does not change. Both are [`Scene::at_frame`] of one scene, with
    /// one size and the same settings.
    ///
    /// # Errors
    /// The errors of [`Renderer::new`]. There is no renderer any more then.
    #[doc(hidden)]
    pub fn at_frame(self, before: &Scene, scene: &Scene) -> Result<Self, RenderError> {
        let Self { renderer, notice, options, film, size, bulk, memory, .. } = self;
        let same_meshes = scene.has_meshes_of(before);
        let bulk = if same_meshes { bulk } else { BulkDigest::of(scene) };
        let change = if same_meshes && scene.shapes_stand_as_in(before) { Change::Camera } else { Change::Shapes };
        let renderer = renderer.with_scene(scene, change)?;
        let provenance = Self::provenance_with(&bulk, scene, &options, renderer.device());
        let interval = options.interval.map(|interval| interval_goal(scene, &interval));
        Ok(Self { renderer, notice, options, film, size, provenance, bulk, interval, memory })
    }

    /// Goes on to another scene, on the same device and with the kernels whose text is the same. `before`: the scene that it had; where they
    /// differ in their cameras alone, all else stays. Options are those that it was made with, applied to the scene.
    ///
    /// # Errors
    /// The errors of [`Renderer::new`]. There is no renderer any more then.
    #[doc(hidden)]
    pub fn with_scene(self, before: &Scene, scene: &Scene) -> Result<Self, RenderError> {
        let Self { renderer, notice, options, film, provenance: earlier, memory, .. } = self;
        let bulk = BulkDigest::of(scene);
        let as_before = Scene { camera: before.camera.clone(), exposure: before.exposure.clone(), ..scene.clone() };
        let same_settings = earlier.settings == scene.render && earlier.filter == scene.film.filter && film == scene.film.size;
        let is_camera = same_settings
            && bulk.digest(&as_before) == earlier.scene_hash
            && scene.shapes_stand_as_in(before)
            && scene.camera.aperture == before.camera.aperture
            && scene.camera.has_kernels_of(&before.camera);
        let change = if is_camera { Change::Camera } else { Change::Shapes };
        let renderer = renderer.with_scene(scene, change)?;
        let provenance = Self::provenance_with(&bulk, scene, &options, renderer.device());
        let film = scene.film.size;
        let size = options.crop.map_or(film, |[_, _, width, height]| [width, height]);
        let interval = options.interval.map(|interval| interval_goal(scene, &interval));
        Ok(Self { renderer, notice, options, film, size, provenance, bulk, interval, memory })
    }

    /// A fingerprint of the scene's meshes and pictures, which all of its frames share but those in which meshes are deformed.
    #[doc(hidden)]
    pub fn bulk_digest(&self) -> &BulkDigest {
        &self.bulk
    }

    /// The header entries of pictures that are rendered of the scene with these options on a device of this
    /// name.
    #[doc(hidden)]
    pub fn provenance_of(scene: &Scene, options: &RenderOptions, device: &str) -> Provenance {
        Self::provenance_with(&BulkDigest::of(scene), scene, options, device)
    }

    /// The provenance, computed with a digest of the scene's meshes and pictures that is known already.
    #[doc(hidden)]
    pub fn provenance_with(bulk: &BulkDigest, scene: &Scene, options: &RenderOptions, device: &str) -> Provenance {
        Provenance {
            scene: scene.name.clone(),
            scene_hash: bulk.digest(scene),
            settings: scene.render.clone(),
            filter: scene.film.filter,
            first_sample: options.first_sample,
            target_error: options.target_error,
            adaptive: options.adaptive,
            interval: options.interval.map(|interval| interval_goal(scene, &interval).options),
            device: device.to_owned(),
        }
    }

    /// The device's name, or `CPU reference`.
    pub fn device(&self) -> &str {
        self.renderer.device()
    }

    /// Why the CPU renders, where [`DeviceChoice::Auto`](crate::DeviceChoice::Auto) found no adapter that can be used.
    pub fn notice(&self) -> Option<&str> {
        self.notice.as_deref()
    }

    /// Width and height of the picture in pixels; of a region of it, of that.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Renders, and hands over finished rows from the top, each once. Where the observer stops it, the rows hold what was done until then.
    ///
    /// # Errors
    /// Errors of the device and of `on_band`. If the device is lost, rows hold what was read from it before, and the error follows.
    pub fn render(&mut self, observer: &dyn Observer, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> Result<Outcome, Error> {
        Ok(self.render_from(Instant::now(), observer, None, on_band)?)
    }

    /// Renders the whole picture into memory.
    ///
    /// # Errors
    /// Errors of the device.
    pub fn image(&mut self, observer: &dyn Observer) -> Result<Image, Error> {
        let mut bands = Vec::new();
        let outcome = self.render(observer, &mut |band| {
            bands.push(band);
            Ok(())
        })?;
        Ok(Image::rendered(self.size, &bands, self.provenance.clone(), outcome))
    }

    /// Renders as [`Renderer::render`] does, with a time limit that counts from `start`, and saves its state
    /// in a checkpoint; the time of earlier renders counts too.
    ///
    /// # Errors
    /// The errors of [`Renderer::render`].
    #[doc(hidden)]
    pub fn render_from(
        &mut self,
        start: Instant,
        observer: &dyn Observer,
        checkpoint: Option<&mut Checkpoint>,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> Result<Outcome, RenderError> {
        let before = checkpoint.as_ref().map_or(0.0, |checkpoint| checkpoint.seconds_before());
        let left = |limit: Duration| limit.saturating_sub(Duration::try_from_secs_f64(before).unwrap_or_default());
        // A limit beyond what the clock can tell is none.
        let deadline = self.options.time_limit.and_then(|limit| start.checked_add(left(limit)));
        let goal = Goal { deadline, ..self.goal() };
        self.render_for(&goal, observer, checkpoint, on_band)
    }

    /// Renders the first samples of every pixel alone, for a look at the picture before the rest of it is rendered.
    ///
    /// # Errors
    /// The errors of [`Renderer::render`].
    #[doc(hidden)]
    pub fn render_first(
        &mut self,
        samples: u32,
        observer: &dyn Observer,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> Result<Outcome, RenderError> {
        let Goal { samples: all, region, .. } = self.goal();
        let first = all.start..all.end.min(all.start.saturating_add(samples));
        let goal = Goal { samples: first, region, deadline: None, target_error: None, adaptive: false, interval: None };
        self.render_for(&goal, observer, None, on_band)
    }

    fn render_for(
        &mut self,
        goal: &Goal,
        observer: &dyn Observer,
        checkpoint: Option<&mut Checkpoint>,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> Result<Outcome, RenderError> {
        let (renderer, seed) = (self.renderer.as_mut(), self.provenance.settings.seed);
        let crop = self.options.crop;
        let mut cropped = |band: Band| match crop {
            Some(region) => on_band(band.cropped(region)),
            None => on_band(band),
        };
        progressive::render_kept(renderer, self.film, seed, goal, observer, checkpoint, &mut cropped)
    }

    /// The goal that the options set; a deadline is some time.
    fn goal(&self) -> Goal {
        let RenderOptions { first_sample, time_limit, target_error, adaptive, .. } = self.options;
        let samples = first_sample..first_sample + self.provenance.settings.spp;
        let deadline = time_limit.map(|_| Instant::now());
        Goal { samples, region: self.options.crop, deadline, target_error, adaptive, interval: self.interval }
    }

    /// The values that decide the picture, and that a state must share so that a render can go on from it.
    #[doc(hidden)]
    pub fn identity(&self) -> Identity {
        let is_one_batch = progressive::is_one_batch(&self.goal(), self.renderer.holds_whole_film());
        Identity::new(&self.provenance, self.film, self.options.crop, is_one_batch)
    }

    /// Width and height of the whole picture.
    #[doc(hidden)]
    pub fn film(&self) -> [u32; 2] {
        self.film
    }

    /// The header entries of the picture's files.
    #[doc(hidden)]
    pub fn provenance(&self) -> &Provenance {
        &self.provenance
    }
}
