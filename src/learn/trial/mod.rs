//! How lights are drawn from, and where Russian roulette begins, where nobody says so: a pilot renders some pixels and compares error times cost.
//!
//! It decides whether few lights are chosen by cells, how many light samples the first surfaces take, and whether points on rectangles and triangles are
//! drawn by solid angle ([`LightSampling::Auto`]): all ways are tried with the same paths, so they differ by the noise of direct light alone. Then it decides from which depth on
//! roulette ends paths, by what that would do to the paths of the best way. Random numbers are not those of the picture. Cost is counted, in rays, and not timed. So what is chosen depends on the scene, its settings and the size of its
//! film: not on the seed, the number of samples, the device or the machine.

mod cost;
mod extent;
mod guiding;
mod rays;
mod roulette;
mod sum;
mod tried;
mod unguided;
mod watched;

use std::borrow::Cow;

use super::light_cells::{self, LightsSettled};
use super::work_of_path;
use crate::plan::UNROLL_LIMIT;
use crate::reference::integrator::Integrator;
use crate::reference::intersect::Outline;
use crate::reference::work;
use crate::renderer::RenderError;
use crate::sampling::light_way::LightWay;
use crate::scene::settings::MOST_LIGHT_SAMPLES;
use crate::scene::{Estimator, Guiding, LightChoice, LightSampling, NumberOrAuto, RenderSettings, Scene};
use cost::{SIMPLE, TRAVERSED};
use extent::{has_few_pixels, has_many_triangles, tried_pixels};
pub use guiding::{loss_with_guide, why_no_guide};
use rays::Rays;
use roulette::{Effects, ROULETTE_DEPTHS};
use tried::{Found, InView, losses_of_roulette};

/// What is chosen in place of something simpler has to be so much better: less is noise of the pilot.
const LEAST_GAIN: f64 = 1.06;
/// First surfaces of a path at which several light samples are tried.
const MOST_DEPTH: u32 = 2;
/// Numbers, each twice the one before, that are tried after the best one.
const MOST_IN_VAIN: u32 = 2;
/// Edges of a path at most where one that no roulette ends is considered.
const MOST_EDGES_WITHOUT_ROULETTE: u32 = 16;

/// Work of the first way that is tried, at most, and work after which no further way is: so that a pilot takes seconds, whatever the scene.
const MOST_WORK_OF_WAY: f64 = 8.0 * work::SECOND as f64;
const MOST_WORK: u64 = 32 * work::SECOND;

/// A scene whose settings say how lights are drawn from and where roulette begins.
pub struct Settled<'a> {
    pub scene: Cow<'a, Scene>,
    pub because: Reasons,
    /// Paths were traced to find out.
    pub is_piloted: bool,
    /// The scene made ready, where that was needed to find out.
    pub integrator: Option<Integrator>,
}

/// Why settings are what they are; None where the scene says what they are.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Reasons {
    /// How lights are chosen; None where nothing was tried to find out.
    pub light_choice: Option<String>,
    /// How many light samples there are.
    pub light_samples: Option<String>,
    /// Where roulette begins.
    pub roulette: Option<String>,
    /// Why nothing was tried, where paths take too much work.
    pub left_out: Option<String>,
}

/// What settings leave open.
#[derive(Clone, Copy, PartialEq)]
struct Open {
    /// Whether lights are chosen by cells, which were learned.
    light_choice: bool,
    light_samples: bool,
    light_sampling: bool,
    roulette: bool,
}

impl Open {
    fn of(settings: &RenderSettings, light_choice: bool) -> Self {
        Self {
            light_choice,
            light_samples: settings.light_samples == NumberOrAuto::Auto,
            light_sampling: settings.light_sampling == LightSampling::Auto,
            // Guided paths are ended by other means, which a pilot does not know.
            roulette: settings.roulette_depth == NumberOrAuto::Auto && settings.guiding == Guiding::Off,
        }
    }

    fn draws_from_lights(self) -> bool {
        self.light_choice || self.light_samples || self.light_sampling
    }

    /// The same reason for each of them.
    fn reasons(self, because: &str) -> Reasons {
        let because = |is_open: bool| is_open.then(|| because.to_owned());
        Reasons {
            light_choice: because(self.light_choice),
            light_samples: because(self.light_samples),
            roulette: because(self.roulette),
            left_out: None,
        }
    }
}

/// Chooses what the scene's settings leave open. A scene whose settings are complete is as it was.
///
/// # Errors
/// What the reference cannot render.
pub fn settle(scene: &Scene) -> Result<Settled<'_>, RenderError> {
    let LightsSettled { scene, integrator, because, is_undecided } = light_cells::settle(scene)?;
    let mut settled = match scene {
        Cow::Borrowed(scene) => settle_the_rest(scene, integrator, is_undecided)?,
        Cow::Owned(scene) => {
            let settled = settle_the_rest(&scene, integrator, is_undecided)?;
            Settled { scene: Cow::Owned(settled.scene.into_owned()), ..settled }
        }
    };
    settled.is_piloted |= because.is_some();
    settled.because.light_choice = settled.because.light_choice.or(because);
    Ok(settled)
}

/// As [`settle`], after lights were tried; `has_cells`: cells of lights were learned and may be chosen.
fn settle_the_rest(scene: &Scene, integrator: Option<Integrator>, has_cells: bool) -> Result<Settled<'_>, RenderError> {
    let mut open = Open::of(&scene.render, has_cells);
    let as_it_is = |integrator, because| Settled { scene: Cow::Borrowed(scene), because, is_piloted: false, integrator };
    if !open.draws_from_lights() && !open.roulette {
        return Ok(as_it_is(integrator, Reasons::default()));
    }
    // What nobody has chosen is one light sample, the area of flat lights, and the default of roulette.
    if let Some(because) = not_worth_trying(scene, open) {
        return Ok(as_it_is(integrator, open.reasons(because)));
    }
    let mut pilot = Pilot::new(scene, integrator)?;
    let of_path = work_of_path::of_path(&pilot.integrator);
    if of_path * Found::paths(pilot.pixels) > MOST_WORK_OF_WAY {
        let because = too_much_work("a pilot", of_path);
        let reasons = Reasons { left_out: Some(because.clone()), ..open.reasons(&because) };
        return Ok(as_it_is(Some(pilot.integrator), reasons));
    }
    open.light_sampling &= pilot.costliest_outline.is_some();
    if !open.draws_from_lights() && !open.roulette {
        return Ok(as_it_is(Some(pilot.integrator), Reasons::default()));
    }
    let because = choose(&mut pilot, open);
    pilot.integrator.set_light_choice(pilot.settings.light_choice);
    pilot.integrator.set_light_sampling(&pilot.settings);
    pilot.integrator.set_roulette_depth(pilot.settings.roulette_depth);
    Ok(Settled {
        scene: Cow::Owned(Scene { render: pilot.settings, ..scene.clone() }),
        because,
        is_piloted: true,
        integrator: Some(pilot.integrator),
    })
}

/// Why nothing is tried where paths take so much.
pub fn too_much_work(what: &str, of_path: f64) -> String {
    format!("{what} takes too long where a path takes {of_path:.1e} tests of what it may meet")
}

/// Why nothing is tried, if so.
fn not_worth_trying(scene: &Scene, open: Open) -> Option<&'static str> {
    if scene.render.estimator == Estimator::Bsdf && !open.roulette {
        return Some("no light is sampled");
    }
    if !scene.has_light() {
        return Some("there is no light");
    }
    if scene.render.max_depth == 1 {
        return Some("paths have no second edge");
    }
    if has_few_pixels(scene) {
        return Some("a pilot takes too long for so few pixels");
    }
    has_many_triangles(scene).then_some("a pilot takes too long for so many triangles")
}

/// Chooses what the settings leave open, and leaves it in the pilot's: how lights are drawn from, then where roulette begins. Returns why.
fn choose(pilot: &mut Pilot<'_>, open: Open) -> Reasons {
    let light_choice = if open.light_choice { LightChoice::Power } else { pilot.settings.light_choice };
    let first = Tried { light_choice, sampling: pilot.settings.light_sampling, samples: [1, 1], loss: 1.0 };
    let (simplest, effects) = pilot.try_with_roulette(first);
    if !simplest.has_noise() {
        pilot.settings = pilot.way(first);
        if open.roulette {
            pilot.settings.roulette_depth = ROULETTE_DEPTHS[0].into();
        }
        return open.reasons("a pilot found no noise");
    }
    let in_view = InView::new(&mut pilot.integrator, pilot.pixels);
    let (mut chosen, mut best, mut loss_by_cells) = (first, first, 1.0);
    // An environment of one colour is no light that is sampled.
    let samples_lights = simplest.rays().shadow > 0.0;
    if open.draws_from_lights() && samples_lights {
        if open.light_choice && pilot.spent <= MOST_WORK {
            let by_cells = Tried { light_choice: LightChoice::Cells, ..first };
            loss_by_cells = pilot.try_way(by_cells).loss_of_outliers_over(&simplest, &in_view);
            if loss_by_cells * LEAST_GAIN < first.loss {
                chosen = Tried { loss: loss_by_cells, ..by_cells };
            }
        }
        best = best_way(pilot, chosen, open, (&simplest, &in_view));
    }
    let found = |what: String| if samples_lights { format!("a pilot found {what}") } else { "no light is sampled".to_owned() };
    let of_choice = || found(format!("that cells of lights have {loss_by_cells:.2} of the error × cost of power"));
    let of_samples = || found(format!("{:.2} of the error × cost of one light sample", best.loss / chosen.loss));
    let mut reasons = Reasons {
        light_choice: open.light_choice.then(of_choice),
        light_samples: open.light_samples.then(of_samples),
        roulette: None,
        left_out: None,
    };
    pilot.settings = pilot.way(best);
    if open.roulette && best != first && pilot.spent > MOST_WORK {
        reasons.roulette = Some("a pilot had no time left to try it".to_owned());
    } else if open.roulette {
        let (found, effects) = if best == first { (simplest, effects) } else { pilot.try_with_roulette(best) };
        let losses = losses_of_roulette(&found, &effects, &in_view, |rays| pilot.cost_of_roulette(rays));
        let (depth, because) = best_roulette(losses, pilot.settings.max_depth);
        pilot.settings.roulette_depth = depth.into();
        reasons.roulette = Some(because);
    }
    reasons
}

/// The depth with the least error times cost, if that is clearly less than by default, and why.
fn best_roulette(losses: [f64; ROULETTE_DEPTHS.len()], max_depth: u32) -> (u32, String) {
    let by_default = (ROULETTE_DEPTHS[0], 1.0);
    let can_be = |depth: u32| depth > 0 || (1..=MOST_EDGES_WITHOUT_ROULETTE).contains(&max_depth);
    let candidates = ROULETTE_DEPTHS.into_iter().zip(losses).filter(|&(depth, _)| can_be(depth));
    let best = candidates.fold(by_default, |best, other| if other.1 < best.1 { other } else { best });
    let (depth, loss) = if best.1 * LEAST_GAIN < 1.0 { best } else { by_default };
    (depth, format!("a pilot found {loss:.2} of the error × cost of depth {}", by_default.0))
}

/// The best way to draw from lights, from a simple one on.
fn best_way(pilot: &mut Pilot<'_>, simple: Tried, open: Open, beside: (&Found, &InView)) -> Tried {
    let mut best = simple;
    if open.light_sampling {
        best = pilot.better(best, Tried { sampling: LightSampling::Cone, ..best }, beside);
    }
    for depth in (1..=most_depth(&pilot.settings)).filter(|_| open.light_samples) {
        let (mut in_vain, fewest) = (0, best.samples[0]);
        for count in [2, 4, 8, MOST_LIGHT_SAMPLES].into_iter().filter(|&count| count >= fewest) {
            let better = pilot.better(best, Tried { samples: [count, depth], ..best }, beside);
            in_vain = if better == best { in_vain + 1 } else { 0 };
            best = better;
            if in_vain == MOST_IN_VAIN {
                break;
            }
        }
    }
    best
}

/// How many first surfaces of a path can take light samples, up to those that are tried.
fn most_depth(settings: &RenderSettings) -> u32 {
    if settings.max_depth == 0 { MOST_DEPTH } else { (settings.max_depth - 1).min(MOST_DEPTH) }
}

/// A way to draw from lights.
#[derive(Clone, Copy, PartialEq)]
struct Tried {
    light_choice: LightChoice,
    sampling: LightSampling,
    /// How many light samples at how many first surfaces.
    samples: [u32; 2],
    /// Error times cost, beside that of the simplest way.
    loss: f64,
}

struct Pilot<'a> {
    integrator: Integrator,
    scene: &'a Scene,
    /// The scene's, with what was chosen so far.
    settings: RenderSettings,
    /// Geometry is few primitives.
    is_simple: bool,
    /// Of lamps that can be drawn from by solid angle.
    costliest_outline: Option<Outline>,
    /// Pixels that are tried.
    pixels: u32,
    /// Of the first way that was tried.
    shadow_rays: f64,
    /// Work of all ways that were tried.
    spent: u64,
}

impl<'a> Pilot<'a> {
    fn new(scene: &'a Scene, integrator: Option<Integrator>) -> Result<Self, RenderError> {
        let integrator = integrator.map_or_else(|| Integrator::new(scene), Ok)?;
        let is_simple = integrator.primitive_count() <= UNROLL_LIMIT;
        let costliest_outline = integrator.costliest_outline();
        let pixels = tried_pixels(scene);
        let settings = scene.render.clone();
        Ok(Self { integrator, scene, settings, is_simple, costliest_outline, pixels, shadow_rays: 0.0, spent: 0 })
    }

    /// The better of two ways, both beside the simplest.
    fn better(&mut self, best: Tried, other: Tried, (simplest, in_view): (&Found, &InView)) -> Tried {
        if self.spent > MOST_WORK {
            return best;
        }
        let loss = self.try_way(other).loss_over(simplest, in_view);
        if loss * LEAST_GAIN < best.loss { Tried { loss, ..other } } else { best }
    }

    /// The settings with another way to draw from lights; a number of light samples that is given stays.
    fn way(&self, Tried { light_choice, sampling, samples: [count, depth], .. }: Tried) -> RenderSettings {
        let mut settings = RenderSettings { light_choice, light_sampling: sampling, ..self.settings.clone() };
        if settings.light_samples == NumberOrAuto::Auto {
            (settings.light_samples, settings.light_samples_depth) = (count.into(), depth);
        }
        settings
    }

    fn set_way(&mut self, tried: Tried) -> RenderSettings {
        let settings = self.way(tried);
        self.integrator.set_light_choice(settings.light_choice);
        self.integrator.set_light_sampling(&settings);
        settings
    }

    fn try_way(&mut self, tried: Tried) -> Found {
        let settings = self.set_way(tried);
        let mut found = Found::new(&self.integrator, self.pixels);
        self.spent += found.work;
        found.cost = self.cost(found.rays(), &settings);
        found
    }

    /// As [`Pilot::try_way`], with what roulette would do to its paths. The first way is tried so.
    fn try_with_roulette(&mut self, tried: Tried) -> (Found, Vec<Effects>) {
        let settings = self.set_way(tried);
        let (mut found, effects) = Found::with_roulette(&self.integrator, self.pixels);
        self.spent += found.work;
        if self.shadow_rays == 0.0 {
            self.shadow_rays = found.rays().shadow;
        }
        found.cost = self.cost(found.rays(), &settings);
        (found, effects)
    }

    /// What rays take, in rays of paths, by what kernels take on software devices, where lanes wait for each other.
    fn cost(&self, rays: Rays, settings: &RenderSettings) -> f64 {
        // Where a lane goes on to its next path by itself, all wait for one that is at its first surface.
        let light_samples =
            if self.is_simple { f64::from(settings.several_light_samples()[0]) * self.shadow_rays } else { rays.shadow };
        rays.path + self.cost_of_light_sample(settings) * light_samples
    }

    /// The same of rays that another roulette leaves.
    fn cost_of_roulette(&self, rays: Rays) -> f64 {
        rays.path + self.cost_of_light_sample(&self.settings) * rays.shadow
    }

    fn cost_of_light_sample(&self, settings: &RenderSettings) -> f64 {
        let by_solid_angle =
            settings.light_sampling == LightSampling::Cone && self.scene.render.light_sampling == LightSampling::Auto;
        let costs = if self.is_simple { SIMPLE } else { TRAVERSED };
        let of_point = match self.costliest_outline.filter(|_| by_solid_angle) {
            None => 0.0,
            Some(Outline::Rectangle) => costs.of_rectangle,
            Some(Outline::Triangle) => costs.of_triangle,
        };
        let of_choice = match self.integrator.light_way() {
            LightWay::Power => 0.0,
            LightWay::Tree => costs.tree_of_lights,
            LightWay::Cells => costs.cells_of_lights,
        };
        costs.light_sample + of_choice + of_point
    }
}
