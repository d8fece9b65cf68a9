//! How lights are drawn from where nobody says so: a pilot renders some pixels in several ways and compares error times cost.
//!
//! It decides how many light samples the first surfaces take ([`LightSamples::Auto`]), and whether points on rectangles and triangles are drawn by solid angle
//! ([`LightSampling::Auto`]). All ways are tried with the same paths, so they differ by the noise of direct light alone. Random numbers are
//! not those of the picture. Cost is counted, in rays, and not timed. So what is chosen depends on the scene, its settings and the size of its
//! film: not on the seed, the number of samples, the device or the machine.

mod tried;

use std::borrow::Cow;

use super::integrator::Integrator;
use super::intersect::Outline;
use super::light_cells::{self, LightsSettled};
use crate::plan::UNROLL_LIMIT;
use crate::renderer::RenderError;
use crate::scene::settings::MOST_LIGHT_SAMPLES;
use crate::scene::{Estimator, LightSamples, LightSampling, RenderSettings, Scene, SceneSummary};
use tried::{Found, InView, Rays};

/// Pixels of a film below which a pilot would take longer than it saves.
const FEWEST_PIXELS: u64 = 1 << 16;
/// Triangles above which the reference's hierarchy, which the pilot needs, takes seconds to build.
const MOST_TRIANGLES: usize = 1 << 20;
/// One of so many pixels is tried, within these numbers.
const ONE_OF_PIXELS: u64 = 1 << 10;
const TRIED_PIXELS: [u64; 2] = [1 << 8, 1 << 10];
/// What is chosen in place of something simpler has to be so much better: less is noise of the pilot.
const LEAST_GAIN: f64 = 1.06;
/// First surfaces of a path at which several light samples are tried.
const MOST_DEPTH: u32 = 2;
/// Numbers, each twice the one before, that are tried after the best one.
const MOST_IN_VAIN: u32 = 2;
/// What things take, in rays of paths with the surfaces that they meet.
struct Costs {
    /// A light sample with its shadow ray.
    light_sample: f64,
    /// The way down a tree of lights, and its probability for what paths find.
    tree_of_lights: f64,
    /// Drawing its point by solid angle, with the density of what paths find.
    of_rectangle: f64,
    of_triangle: f64,
}

/// Measured on lavapipe (docs/strategies.md): geometry that is code, and geometry in a hierarchy; of triangles there, and of trees where geometry is code,
/// by what they take in the other.
const SIMPLE: Costs = Costs { light_sample: 1.0, tree_of_lights: 1.4, of_rectangle: 0.75, of_triangle: 2.2 };
const TRAVERSED: Costs = Costs { light_sample: 0.8, tree_of_lights: 1.4, of_rectangle: 0.2, of_triangle: 0.6 };

/// A scene whose settings say how lights are drawn from.
pub struct Settled<'a> {
    pub scene: Cow<'a, Scene>,
    /// Why lights are chosen as they are; None where nothing was tried to find out.
    pub light_choice: Option<String>,
    /// Why light samples are as many as they are; None where the scene says how many.
    pub because: Option<String>,
    /// Paths were traced to find out.
    pub is_piloted: bool,
    /// The scene made ready, where that was needed to find out.
    pub integrator: Option<Integrator>,
}

/// Chooses what the scene's settings leave open. A scene whose settings are complete is as it was.
///
/// # Errors
/// What the reference cannot render.
pub fn settle(scene: &Scene) -> Result<Settled<'_>, RenderError> {
    let LightsSettled { scene, integrator, because } = light_cells::settle(scene)?;
    let settled = match scene {
        Cow::Borrowed(scene) => settle_samples(scene, integrator)?,
        Cow::Owned(scene) => {
            let settled = settle_samples(&scene, integrator)?;
            Settled { scene: Cow::Owned(settled.scene.into_owned()), ..settled }
        }
    };
    Ok(Settled { is_piloted: settled.is_piloted || because.is_some(), light_choice: because, ..settled })
}

/// As [`settle`], where it is settled how lights are chosen.
fn settle_samples(scene: &Scene, integrator: Option<Integrator>) -> Result<Settled<'_>, RenderError> {
    let settings = &scene.render;
    let [no_count, no_way] = [settings.light_samples == LightSamples::Auto, settings.light_sampling == LightSampling::Auto];
    let nothing_chosen = |integrator, because: Option<&str>| Settled {
        scene: Cow::Borrowed(scene),
        light_choice: None,
        because: because.map(str::to_owned),
        is_piloted: false,
        integrator,
    };
    if !no_count && !no_way {
        return Ok(nothing_chosen(integrator, None));
    }
    // What nobody has chosen is one light sample, and the area of flat lights.
    if let Some(because) = not_worth_trying(scene) {
        return Ok(nothing_chosen(integrator, Some(because).filter(|_| no_count)));
    }
    let mut pilot = Pilot::new(scene, integrator)?;
    let open = [no_count, no_way && pilot.costliest_outline.is_some()];
    if open == [false; 2] {
        return Ok(nothing_chosen(Some(pilot.integrator), None));
    }
    let (settings, because) = choose(&mut pilot, open);
    pilot.integrator.set_light_sampling(&settings);
    Ok(Settled {
        scene: Cow::Owned(Scene { render: settings, ..scene.clone() }),
        light_choice: None,
        because: no_count.then_some(because),
        is_piloted: true,
        integrator: Some(pilot.integrator),
    })
}

/// Why nothing is tried, if so.
fn not_worth_trying(scene: &Scene) -> Option<&'static str> {
    if scene.render.estimator == Estimator::Bsdf || !scene.has_light() {
        return Some("no light is sampled");
    }
    if scene.render.max_depth == 1 {
        return Some("paths have no second edge");
    }
    if pixel_count(scene) < FEWEST_PIXELS {
        return Some("a pilot takes too long for so few pixels");
    }
    let SceneSummary { triangles, group_triangles, .. } = SceneSummary::of(scene);
    (triangles + group_triangles > MOST_TRIANGLES).then_some("a pilot takes too long for so many triangles")
}

fn pixel_count(scene: &Scene) -> u64 {
    scene.film.size.map(u64::from).iter().product()
}

/// The settings with another way to draw from lights; a number of light samples that is given stays.
fn way(settings: &RenderSettings, sampling: LightSampling, [count, depth]: [u32; 2]) -> RenderSettings {
    let mut settings = RenderSettings { light_sampling: sampling, ..settings.clone() };
    if settings.light_samples == LightSamples::Auto {
        (settings.light_samples, settings.light_samples_depth) = (LightSamples::Count(count), depth);
    }
    settings
}

/// Tries what the settings leave open, the number of light samples or how flat lights are drawn from or both, from the simplest way on: the settings
/// with the best, and why.
fn choose(pilot: &mut Pilot<'_>, [no_count, no_way]: [bool; 2]) -> (RenderSettings, String) {
    let settings = &pilot.scene.render;
    let mut best = Tried { sampling: settings.light_sampling, samples: [1, 1], loss: 1.0 };
    let simplest = pilot.try_way(best.sampling, best.samples);
    // An environment of one colour is no light that is sampled.
    let nothing_to_gain = [(pilot.shadow_rays == 0, "no light is sampled"), (!simplest.has_noise(), "a pilot found no noise")];
    if let Some((_, because)) = nothing_to_gain.into_iter().find(|(holds, _)| *holds) {
        return (way(settings, best.sampling, best.samples), because.to_owned());
    }
    let beside = (&simplest, &InView::new(&mut pilot.integrator, pilot.pixels));
    if no_way {
        best = pilot.better(best, Tried { sampling: LightSampling::Cone, ..best }, beside);
    }
    for depth in (1..=most_depth(settings)).filter(|_| no_count) {
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
    let because = format!("a pilot found {:.2} of the error × cost of one light sample", best.loss);
    (way(settings, best.sampling, best.samples), because)
}

/// How many first surfaces of a path can take light samples, up to those that are tried.
fn most_depth(settings: &RenderSettings) -> u32 {
    if settings.max_depth == 0 { MOST_DEPTH } else { (settings.max_depth - 1).min(MOST_DEPTH) }
}

/// A way to draw from lights.
#[derive(Clone, Copy, PartialEq)]
struct Tried {
    sampling: LightSampling,
    /// How many light samples at how many first surfaces.
    samples: [u32; 2],
    /// Error times cost, beside that of the simplest way.
    loss: f64,
}

struct Pilot<'a> {
    integrator: Integrator,
    scene: &'a Scene,
    /// Geometry is few primitives.
    is_simple: bool,
    /// Of lamps that can be drawn from by solid angle.
    costliest_outline: Option<Outline>,
    /// Pixels that are tried.
    pixels: u32,
    /// Of the first way that was tried.
    shadow_rays: u64,
}

impl<'a> Pilot<'a> {
    fn new(scene: &'a Scene, integrator: Option<Integrator>) -> Result<Self, RenderError> {
        let integrator = integrator.map_or_else(|| Integrator::new(scene), Ok)?;
        let is_simple = integrator.primitive_count() <= UNROLL_LIMIT;
        let costliest_outline = integrator.costliest_outline();
        let [fewest, most] = TRIED_PIXELS;
        let pixels = (pixel_count(scene) / ONE_OF_PIXELS).clamp(fewest, most) as u32;
        Ok(Self { integrator, scene, is_simple, costliest_outline, pixels, shadow_rays: 0 })
    }

    /// The better of two ways, both beside the simplest.
    fn better(&mut self, best: Tried, other: Tried, (simplest, in_view): (&Found, &InView)) -> Tried {
        let loss = self.try_way(other.sampling, other.samples).loss_over(simplest, in_view);
        if loss * LEAST_GAIN < best.loss { Tried { loss, ..other } } else { best }
    }

    fn try_way(&mut self, sampling: LightSampling, samples: [u32; 2]) -> Found {
        let settings = way(&self.scene.render, sampling, samples);
        self.integrator.set_light_sampling(&settings);
        let mut found = Found::new(&self.integrator, self.pixels);
        if self.shadow_rays == 0 {
            self.shadow_rays = found.rays().shadow;
        }
        found.cost = self.cost(found.rays(), &settings);
        found
    }

    /// What rays take, in rays of paths, by what kernels take on software devices, where lanes wait for each other.
    fn cost(&self, rays: Rays, settings: &RenderSettings) -> f64 {
        let by_solid_angle =
            settings.light_sampling == LightSampling::Cone && self.scene.render.light_sampling == LightSampling::Auto;
        let costs = if self.is_simple { SIMPLE } else { TRAVERSED };
        let of_point = match self.costliest_outline.filter(|_| by_solid_angle) {
            None => 0.0,
            Some(Outline::Rectangle) => costs.of_rectangle,
            Some(Outline::Triangle) => costs.of_triangle,
        };
        let of_choice = if self.integrator.chooses_lights_by_tree() { costs.tree_of_lights } else { 0.0 };
        let a_light_sample = costs.light_sample + of_choice + of_point;
        // Where a lane goes on to its next path by itself, all wait for one that is at its first surface.
        let light_samples =
            if self.is_simple { u64::from(settings.several_light_samples()[0]) * self.shadow_rays } else { rays.shadow };
        rays.path as f64 + a_light_sample * light_samples as f64
    }
}
