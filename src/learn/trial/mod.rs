//! Settings for drawing from lights, where the scene leaves them open: a trial run renders some pixels and
//! compares error times cost.
//!
//! A trial run decides whether few lights are chosen by cells, how many light samples the first surfaces
//! take, and whether points on rectangles and triangles are drawn by solid angle ([`LightSampling::Auto`]).
//! All ways are tried with the same paths, so they differ by the noise of direct light alone. Random numbers
//! are not those of the picture. Cost is counted, in rays, and not timed. So the choice depends on the scene,
//! its settings and the size of its film, not on its seed. How many pixels are tried, and whether any are, is a
//! matter of the render's length ([`super::budget`]).

mod cost;
mod guiding;
mod sum;
mod trial_path;
mod tried;
mod unguided;

use std::borrow::Cow;

use super::budget::{Budget, TOO_SHORT};
use super::extent::{guide_may_pay, has_flat_lights, has_many_triangles};
use super::light_cells::{self, LightsSettled};
use super::reasons::Reasons;
use super::work_of_path;
use crate::reference::Integrator;
use crate::reference::intersect::Outline;
use crate::reference::work;
use crate::renderer::RenderError;
use crate::sampling::light_strategy::LightStrategy;
use crate::scene::settings::MOST_LIGHT_SAMPLES;
use crate::scene::{Estimator, FEW_PRIMITIVES, LightChoice, LightSampling, NumberOrAuto, RenderSettings, Scene};
use cost::costs;
pub use guiding::loss_with_guide;
use sum::Rays;
use tried::{InView, Loss, MANY_PIXELS, TrialResult, tried_pixels};

/// Gain that a way needs over a simpler one to be chosen, for costs are only about known; and the gain in standard errors of the trial run,
/// of many pixels and of few, whose standard error is itself a guess.
const LEAST_GAIN: f64 = 1.06;
const DOUBT: f64 = 1.0;
const DOUBT_OF_FEW: f64 = 2.0;
/// First surfaces of a path at which several light samples are tried.
const MOST_DEPTH: u32 = 2;
/// Numbers, each twice the one before, that are tried after the best one.
const MOST_IN_VAIN: u32 = 2;

/// Ways that a trial run tries, with what it looks at in view, where most of them are in vain.
const USUAL_WAYS: f64 = 8.0;
/// Work of the first way that is tried, at most, and work after which no further way is: so that a trial run
/// takes seconds, whatever the scene.
const MOST_WORK_OF_WAY: f64 = 8.0 * work::SECOND as f64;
const MOST_WORK: u64 = 32 * work::SECOND;

/// A scene whose settings say how lights are drawn from.
pub struct Chosen<'a> {
    /// The scene with complete settings.
    pub scene: Cow<'a, Scene>,
    /// Reasons for the settings that were open.
    pub because: Reasons,
    /// Paths were traced to find out.
    pub was_tried: bool,
    /// The scene made ready, where that was needed to find out.
    pub integrator: Option<Integrator>,
    /// The budget, without what finding out took.
    pub left: Budget,
    /// The work of a path, where that was judged.
    pub work_of_path: Option<f64>,
}

/// Pixels that the budget lets a trial run try, where a path takes so much work, or 0 before that is known; None where they are too few.
fn affordable_pixels(scene: &Scene, budget: Budget, of_path: f64) -> Option<u32> {
    tried_pixels(scene, budget.of_lights(guide_may_pay(scene)).paths(of_path) / USUAL_WAYS)
}

/// Settings that the scene leaves open.
#[derive(Clone, Copy, PartialEq)]
struct Open {
    /// Cells of lights were learned, and whether lights are chosen by them is open.
    light_choice: bool,
    light_samples: bool,
    light_sampling: bool,
}

impl Open {
    fn of(scene: &Scene, light_choice: bool) -> Self {
        let settings = &scene.render;
        Self {
            light_choice,
            light_samples: settings.light_samples == NumberOrAuto::Auto,
            light_sampling: settings.light_sampling == LightSampling::Auto && has_flat_lights(scene),
        }
    }

    fn is_any(self) -> bool {
        self.light_choice || self.light_samples || self.light_sampling
    }

    /// One reason for all open settings.
    fn reasons(self, because: &str) -> Reasons {
        let because = |is_open: bool| is_open.then(|| because.to_owned());
        Reasons { light_choice: because(self.light_choice), light_samples: because(self.light_samples), ..Reasons::default() }
    }
}

/// Chooses what the scene's settings leave open. A scene whose settings are complete stays as it is.
///
/// # Errors
/// [`RenderError`] for a scene that the reference cannot render.
pub fn choose(scene: &Scene, budget: Budget) -> Result<Chosen<'_>, RenderError> {
    let LightsSettled { scene, integrator, because, is_undecided } =
        light_cells::settle(scene, budget, |of_path| affordable_pixels(scene, budget, of_path).is_some())?;
    let mut chosen = match scene {
        Cow::Borrowed(scene) => choose_the_rest(scene, budget, integrator, is_undecided)?,
        Cow::Owned(scene) => {
            let chosen = choose_the_rest(&scene, budget, integrator, is_undecided)?;
            Chosen { scene: Cow::Owned(chosen.scene.into_owned()), ..chosen }
        }
    };
    chosen.was_tried |= because.is_some();
    chosen.because.light_choice = chosen.because.light_choice.or(because);
    Ok(chosen)
}

/// Chooses what is open after lights were tried; `has_cells`: cells of lights were learned and may be chosen.
fn choose_the_rest(
    scene: &Scene,
    budget: Budget,
    integrator: Option<Integrator>,
    has_cells: bool,
) -> Result<Chosen<'_>, RenderError> {
    let mut open = Open::of(scene, has_cells);
    let as_it_is = |integrator, because, work_of_path| Chosen {
        scene: Cow::Borrowed(scene),
        because,
        was_tried: false,
        integrator,
        left: budget,
        work_of_path,
    };
    if !open.is_any() {
        return Ok(as_it_is(integrator, Reasons::default(), None));
    }
    // Settings that stay open mean one light sample, and the area of flat lights.
    if let Some(because) = not_worth_trying(scene) {
        return Ok(as_it_is(integrator, open.reasons(because), None));
    }
    if affordable_pixels(scene, budget, 0.0).is_none() {
        return Ok(as_it_is(integrator, open.reasons(TOO_SHORT), None));
    }
    let integrator = integrator.map_or_else(|| Integrator::new(scene), Ok)?;
    let of_path = work_of_path::of_path(&integrator);
    let Some(pixels) = affordable_pixels(scene, budget, of_path) else {
        return Ok(as_it_is(Some(integrator), open.reasons(TOO_SHORT), Some(of_path)));
    };
    let mut trial = TrialRun::new(scene, integrator, pixels);
    if of_path * TrialResult::paths(trial.pixels) > MOST_WORK_OF_WAY {
        let because = too_much_work("a trial run", of_path);
        let reasons = Reasons { left_out: Some(because.clone()), ..open.reasons(&because) };
        return Ok(as_it_is(Some(trial.integrator), reasons, Some(of_path)));
    }
    trial.most_work = budget.of_lights(guide_may_pay(scene)).work(of_path).min(MOST_WORK);
    open.light_sampling &= trial.costliest_outline.is_some();
    if !open.is_any() {
        return Ok(as_it_is(Some(trial.integrator), Reasons::default(), Some(of_path)));
    }
    let because = try_ways(&mut trial, open);
    trial.integrator.set_light_choice(trial.settings.light_choice);
    trial.integrator.set_light_sampling(&trial.settings);
    let left = budget.after(trial.spent as f64 / of_path.max(1.0), of_path);
    Ok(Chosen {
        scene: Cow::Owned(Scene { render: trial.settings, ..scene.clone() }),
        because,
        was_tried: true,
        integrator: Some(trial.integrator),
        left,
        work_of_path: Some(of_path),
    })
}

/// Why nothing is tried where paths take so much.
pub fn too_much_work(what: &str, of_path: f64) -> String {
    format!("{what} takes too long where a path takes {of_path:.1e} tests of what it may meet")
}

/// Why nothing is tried, if so.
fn not_worth_trying(scene: &Scene) -> Option<&'static str> {
    if scene.render.estimator == Estimator::Bsdf {
        return Some("no light is sampled");
    }
    if !scene.has_light() {
        return Some("there is no light");
    }
    if scene.render.max_depth == 1 {
        return Some("paths have no second edge");
    }
    has_many_triangles(scene).then_some("a trial run takes too long for so many triangles")
}

/// Tries ways to draw from lights, and leaves the best one in the settings of the trial run. Returns the
/// reasons.
fn try_ways(trial: &mut TrialRun<'_>, open: Open) -> Reasons {
    let light_choice = if open.light_choice { LightChoice::Power } else { trial.settings.light_choice };
    let first = Tried { light_choice, sampling: trial.settings.light_sampling, samples: [1, 1], loss: 1.0 };
    let simplest = trial.try_way(first);
    if !simplest.has_noise() {
        trial.settings = trial.way(first);
        return open.reasons("a trial run found no noise");
    }
    let in_view = InView::new(&mut trial.integrator, trial.pixels);
    let (mut chosen, mut best, mut loss_by_cells) = (first, first, 1.0);
    // An environment of one colour is no light that is sampled.
    let samples_lights = simplest.rays().shadow > 0.0;
    if samples_lights {
        if open.light_choice && trial.spent <= trial.most_work {
            let by_cells = Tried { light_choice: LightChoice::Cells, ..first };
            let loss = trial.try_way(by_cells).loss_of_outliers_over(&simplest, &in_view);
            loss_by_cells = loss.value;
            if trial.is_gain(loss, first.loss) {
                chosen = Tried { loss: loss_by_cells, ..by_cells };
            }
        }
        best = best_way(trial, chosen, open, (&simplest, &in_view));
    }
    trial.settings = trial.way(best);
    let found =
        |what: String| if samples_lights { format!("a trial run found {what}") } else { "no light is sampled".to_owned() };
    let of_choice = || found(format!("that cells of lights have {loss_by_cells:.2} of the error × cost of power"));
    let of_samples = || found(format!("{:.2} of the error × cost of one light sample", best.loss / chosen.loss));
    Reasons {
        light_choice: open.light_choice.then(of_choice),
        light_samples: open.light_samples.then(of_samples),
        ..Reasons::default()
    }
}

/// The best way to draw from lights, from a simple one on.
fn best_way(trial: &mut TrialRun<'_>, simple: Tried, open: Open, beside: (&TrialResult, &InView)) -> Tried {
    let mut best = simple;
    if open.light_sampling {
        best = trial.better(best, Tried { sampling: LightSampling::Cone, ..best }, beside);
    }
    for depth in (1..=most_depth(&trial.settings)).filter(|_| open.light_samples) {
        let (mut in_vain, fewest) = (0, best.samples[0]);
        for count in [2, 4, 8, MOST_LIGHT_SAMPLES].into_iter().filter(|&count| count >= fewest) {
            let better = trial.better(best, Tried { samples: [count, depth], ..best }, beside);
            in_vain = if better == best { in_vain + 1 } else { 0 };
            best = better;
            // A way that gains makes a sample of the picture longer, and so affords trying the next one.
            if in_vain == MOST_IN_VAIN || (in_vain > 0 && trial.spent > trial.most_work) {
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

struct TrialRun<'a> {
    integrator: Integrator,
    scene: &'a Scene,
    /// The scene's, with what was chosen so far.
    settings: RenderSettings,
    /// Geometry is few primitives.
    is_simple: bool,
    /// The costliest outline of a light whose points can be drawn by solid angle.
    costliest_outline: Option<Outline>,
    /// Pixels that are tried.
    pixels: u32,
    /// Shadow rays of the first way that was tried.
    shadow_rays: f64,
    /// Work of all ways that were tried, and work after which no further one is where they gain nothing.
    spent: u64,
    most_work: u64,
}

impl<'a> TrialRun<'a> {
    fn new(scene: &'a Scene, integrator: Integrator, pixels: u32) -> Self {
        let is_simple = integrator.primitive_count() <= FEW_PRIMITIVES;
        let costliest_outline = integrator.costliest_outline();
        let settings = scene.render.clone();
        Self {
            integrator,
            scene,
            settings,
            is_simple,
            costliest_outline,
            pixels,
            shadow_rays: 0.0,
            spent: 0,
            most_work: MOST_WORK,
        }
    }

    /// Says that a loss is less than another by more than the noise of the trial run.
    fn is_gain(&self, loss: Loss, than: f64) -> bool {
        let doubt = if self.pixels < MANY_PIXELS { DOUBT_OF_FEW } else { DOUBT };
        loss.value * LEAST_GAIN < than && loss.value + doubt * loss.standard_error < than
    }

    /// The better of two ways, both beside the simplest.
    fn better(&mut self, best: Tried, other: Tried, (simplest, in_view): (&TrialResult, &InView)) -> Tried {
        if self.spent > MOST_WORK {
            return best;
        }
        let loss = self.try_way(other).loss_over(simplest, in_view);
        if self.is_gain(loss, best.loss) { Tried { loss: loss.value, ..other } } else { best }
    }

    /// The settings with another way to draw from lights; a number of light samples that is given stays.
    fn way(&self, Tried { light_choice, sampling, samples: [count, depth], .. }: Tried) -> RenderSettings {
        let mut settings = RenderSettings { light_choice, light_sampling: sampling, ..self.settings.clone() };
        if settings.light_samples == NumberOrAuto::Auto {
            (settings.light_samples, settings.light_samples_depth) = (count.into(), depth);
        }
        settings
    }

    fn set_strategy(&mut self, tried: Tried) -> RenderSettings {
        let settings = self.way(tried);
        self.integrator.set_light_choice(settings.light_choice);
        self.integrator.set_light_sampling(&settings);
        settings
    }

    fn try_way(&mut self, tried: Tried) -> TrialResult {
        let settings = self.set_strategy(tried);
        let mut found = TrialResult::new(&self.integrator, self.pixels);
        self.spent += found.work;
        if self.shadow_rays == 0.0 {
            self.shadow_rays = found.rays().shadow;
        }
        found.cost = self.cost(found.rays(), &settings);
        found
    }

    /// The cost of rays, in rays of paths, as kernels have it on software devices, where lanes wait for each
    /// other.
    fn cost(&self, rays: Rays, settings: &RenderSettings) -> f64 {
        // Lanes that go on to their next paths by themselves wait for one that is at its first surface.
        let light_samples =
            if self.is_simple { f64::from(settings.several_light_samples()[0]) * self.shadow_rays } else { rays.shadow };
        rays.path + self.cost_of_light_sample(settings) * light_samples
    }

    fn cost_of_light_sample(&self, settings: &RenderSettings) -> f64 {
        let by_solid_angle =
            settings.light_sampling == LightSampling::Cone && self.scene.render.light_sampling == LightSampling::Auto;
        let costs = costs(self.is_simple);
        let of_point = match self.costliest_outline.filter(|_| by_solid_angle) {
            None => 0.0,
            Some(Outline::Rectangle) => costs.of_rectangle,
            Some(Outline::Triangle) => costs.of_triangle,
        };
        let of_choice = match self.integrator.light_strategy() {
            LightStrategy::Power => 0.0,
            LightStrategy::Tree => costs.tree_of_lights,
            LightStrategy::Cells => costs.cells_of_lights,
        };
        costs.light_sample + of_choice + of_point
    }
}

#[cfg(test)]
mod tests {
    use super::super::budget::{Effort, LEAST_BUDGET};
    use super::*;
    use crate::load;

    /// Under an environment map the least budget pays for a trial run; elsewhere it takes four times as much.
    #[test]
    fn the_least_budget_pays_for_the_shortest_trial_run() {
        let affordable = |name: &str, paths: f64| {
            let scene = load::load(Some(name)).expect("a built-in scene");
            tried_pixels(&scene, paths / USUAL_WAYS).is_some()
        };
        for (name, least) in [("terrace", LEAST_BUDGET), ("cornell", 4.0 * LEAST_BUDGET)] {
            assert!(affordable(name, least) && !affordable(name, 0.99 * least), "{name}");
        }
    }

    /// Nothing is made ready for a trial run that the cheapest paths do not let fit into the time.
    #[test]
    fn before_a_path_is_judged_it_counts_as_the_cheapest() {
        let mut scene = load::load(Some("cornell")).expect("a built-in scene");
        scene.render.spp = 1 << 14;
        let affordable = |milliseconds: u64, of_path: f64| {
            let time_limit = Some(std::time::Duration::from_millis(milliseconds));
            affordable_pixels(&scene, Budget::new(&scene, Effort { time_limit, ..Effort::default() }), of_path)
        };
        let limits = (100..4000).step_by(100);
        assert!(limits.clone().all(|limit| affordable(limit, 0.0) == affordable(limit, 128.0)));
        // The control: paths that take more do not fit into all of them.
        assert!(limits.clone().any(|limit| affordable(limit, 0.0).is_some() && affordable(limit, 1000.0).is_none()));
        assert!(limits.clone().any(|limit| affordable(limit, 1000.0).is_some()));
    }

    /// Cells of few lights are learned where a path turns out to be cheap enough for a trial run of them, and only there.
    #[test]
    fn cells_are_not_learned_where_judged_paths_take_too_much() {
        let scene = load::load(Some("veach-mis")).expect("a built-in scene");
        let budget = Budget::new(&scene, Effort::default());
        let is_undecided = |most_work: f64| {
            let settled = light_cells::settle(&scene, budget, |of_path| of_path <= most_work).expect("a valid scene");
            settled.is_undecided
        };
        assert!(is_undecided(f64::INFINITY) && !is_undecided(100.0));
    }

    /// The standard error of few pixels is itself a guess, and a gain has to be twice as large beside it.
    #[test]
    fn few_pixels_need_a_larger_gain() {
        let scene = load::load(Some("cornell")).expect("a built-in scene");
        let with = |pixels: u32, value: f64, standard_error: f64| {
            let integrator = Integrator::new(&scene).expect("the reference can render the scene");
            TrialRun::new(&scene, integrator, pixels).is_gain(Loss { value, standard_error }, 1.0)
        };
        assert!(with(MANY_PIXELS, 0.85, 0.1) && !with(MANY_PIXELS - 1, 0.85, 0.1));
        assert!(with(MANY_PIXELS - 1, 0.75, 0.1) && !with(MANY_PIXELS, 0.95, 0.01));
    }
}
