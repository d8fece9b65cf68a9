//! How lights are drawn from where nobody says so: a pilot renders some pixels in several ways and compares error times cost.
//!
//! It decides how many light samples the first surfaces take ([`LightSamples::Auto`]), and whether points on rectangles and triangles are drawn by solid angle
//! ([`LightSampling::Auto`]). All ways are tried with the same paths, so they differ by the noise of direct light alone. Random numbers are
//! not those of the picture. Cost is counted, in rays, and not timed. So what is chosen depends on the scene, its settings and the size of its
//! film: not on the seed, the number of samples, the device or the machine.

use std::borrow::Cow;

use glam::DVec3;
use rayon::prelude::*;

use super::integrator::Integrator;
use super::intersect::Surface;
use super::trace::{LightConnection, PathVisitor};
use super::training::pixel_of;
use crate::compare::metrics::relative_weight;
use crate::plan::UNROLL_LIMIT;
use crate::renderer::RenderError;
use crate::sampling::hash::mix;
use crate::sampling::{PathSampler, Sampling, SequencePoint};
use crate::scene::settings::MOST_LIGHT_SAMPLES;
use crate::scene::{Estimator, LightSamples, LightSampling, RenderSettings, Scene, SceneSummary};

/// Pixels of a film below which a pilot would take longer than it saves.
const FEWEST_PIXELS: u64 = 1 << 16;
/// Triangles above which the reference's hierarchy, which the pilot needs, takes seconds to build.
const MOST_TRIANGLES: usize = 1 << 20;
/// One of so many pixels is tried, within these numbers, each by so many independent pictures of so many samples.
const ONE_OF_PIXELS: u64 = 1 << 10;
const TRIED_PIXELS: [u64; 2] = [1 << 7, 1 << 10];
const PICTURES: u32 = 4;
const SAMPLES: u32 = 16;
/// Vertices after which a path is given up.
const MOST_VERTICES: u32 = 64;
/// What is chosen in place of something simpler has to be so much better: less is noise of the pilot.
const LEAST_GAIN: f64 = 1.03;
/// First surfaces of a path at which several light samples are tried.
const MOST_DEPTH: u32 = 2;
/// Numbers, each twice the one before, that are tried after the best one.
const MOST_IN_VAIN: u32 = 2;
/// Of the random numbers.
const SEED: u32 = 0x7069_6c6f;

/// What things take, in rays of paths with the surfaces that they meet.
struct Costs {
    /// A light sample with its shadow ray.
    light_sample: f64,
    /// Drawing its point by solid angle, with the density of what paths find: of rectangles, and where there are triangles.
    solid_angle: [f64; 2],
}

/// Measured on lavapipe (docs/strategies.md): geometry that is code, and geometry in a hierarchy; there, of triangles in the same proportion.
const SIMPLE: Costs = Costs { light_sample: 1.0, solid_angle: [0.75, 2.2] };
const TRAVERSED: Costs = Costs { light_sample: 1.2, solid_angle: [0.2, 0.6] };

/// A scene whose settings say how lights are drawn from.
pub struct Settled<'a> {
    pub scene: Cow<'a, Scene>,
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
    let settings = &scene.render;
    let [no_count, no_way] = [settings.light_samples == LightSamples::Auto, settings.light_sampling == LightSampling::Auto];
    let as_it_is = Settled { scene: Cow::Borrowed(scene), because: None, is_piloted: false, integrator: None };
    if !no_count && !no_way {
        return Ok(as_it_is);
    }
    // What nobody has chosen is one light sample, and the area of flat lights.
    if let Some(because) = not_worth_trying(scene) {
        return Ok(Settled { because: no_count.then(|| because.to_owned()), ..as_it_is });
    }
    let mut pilot = Pilot::new(scene)?;
    let open = [no_count, no_way && pilot.integrator.has_flat_lights()];
    if open == [false; 2] {
        return Ok(Settled { integrator: Some(pilot.integrator), ..as_it_is });
    }
    let (settings, because) = choose(&mut pilot, open);
    pilot.integrator.set_light_sampling(&settings);
    Ok(Settled {
        scene: Cow::Owned(Scene { render: settings, ..scene.clone() }),
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
    let simplest = pilot.loss(best.sampling, best.samples);
    // An environment of one colour is no light that is sampled.
    let nothing_to_gain = [(pilot.shadow_rays == 0, "no light is sampled"), (simplest == 0.0, "a pilot found no noise")];
    if let Some((_, because)) = nothing_to_gain.into_iter().find(|(holds, _)| *holds) {
        return (way(settings, best.sampling, best.samples), because.to_owned());
    }
    if no_way {
        best = pilot.better(best, Tried { sampling: LightSampling::Cone, ..best }, simplest);
    }
    for depth in (1..=most_depth(settings)).filter(|_| no_count) {
        let (mut in_vain, fewest) = (0, best.samples[0]);
        for count in [2, 4, 8, MOST_LIGHT_SAMPLES].into_iter().filter(|&count| count >= fewest) {
            let better = pilot.better(best, Tried { samples: [count, depth], ..best }, simplest);
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
    /// Some lamps are triangles.
    has_triangles: bool,
    /// Pixels that are tried.
    pixels: u32,
    /// Of the first way that was tried: what the squared errors of a pixel's channels are multiplied by, and shadow rays.
    weights: Vec<DVec3>,
    shadow_rays: u64,
}

impl<'a> Pilot<'a> {
    fn new(scene: &'a Scene) -> Result<Self, RenderError> {
        let integrator = Integrator::new(scene)?;
        let is_simple = integrator.primitive_count() <= UNROLL_LIMIT;
        let has_triangles = integrator.has_triangle_lights();
        let [fewest, most] = TRIED_PIXELS;
        let pixels = (pixel_count(scene) / ONE_OF_PIXELS).clamp(fewest, most) as u32;
        Ok(Self { integrator, scene, is_simple, has_triangles, pixels, weights: Vec::new(), shadow_rays: 0 })
    }

    /// The better of two ways.
    fn better(&mut self, best: Tried, other: Tried, simplest: f64) -> Tried {
        let loss = self.loss(other.sampling, other.samples) / simplest;
        if loss * LEAST_GAIN < best.loss { Tried { loss, ..other } } else { best }
    }

    /// Error times cost.
    fn loss(&mut self, sampling: LightSampling, samples: [u32; 2]) -> f64 {
        let settings = way(&self.scene.render, sampling, samples);
        self.integrator.set_light_sampling(&settings);
        let pictures: Vec<Picture> = (0..PICTURES).map(|number| Picture::new(&settings, number)).collect();
        let of_pixel = |number| TriedPixel::of(&self.integrator, &pictures, number);
        let pixels: Vec<TriedPixel> = (0..self.pixels).into_par_iter().map(of_pixel).collect();
        let rays = pixels.iter().fold(Rays::default(), |sum, pixel| sum.and(pixel.rays));
        if self.weights.is_empty() {
            self.weights = pixels.iter().map(|pixel| DVec3::from_array(pixel.mean.to_array().map(relative_weight))).collect();
            self.shadow_rays = rays.shadow;
        }
        let error: f64 = pixels.iter().zip(&self.weights).map(|(pixel, weight)| pixel.variance.dot(*weight)).sum();
        error * self.cost(rays, &settings)
    }

    /// What rays take, in rays of paths, by what kernels take on software devices, where lanes wait for each other.
    fn cost(&self, rays: Rays, settings: &RenderSettings) -> f64 {
        let by_solid_angle =
            settings.light_sampling == LightSampling::Cone && self.scene.render.light_sampling == LightSampling::Auto;
        let costs = if self.is_simple { SIMPLE } else { TRAVERSED };
        let a_light_sample =
            costs.light_sample + if by_solid_angle { costs.solid_angle[usize::from(self.has_triangles)] } else { 0.0 };
        // Where a lane goes on to its next path by itself, all wait for one that is at its first surface.
        let light_samples =
            if self.is_simple { u64::from(settings.several_light_samples()[0]) * self.shadow_rays } else { rays.shadow };
        rays.path as f64 + a_light_sample * light_samples as f64
    }
}

/// The random numbers of one of the independent pictures.
struct Picture {
    sampling: Sampling,
    points: Vec<SequencePoint>,
}

impl Picture {
    fn new(settings: &RenderSettings, number: u32) -> Self {
        let sampling = Sampling { seed: mix(SEED.wrapping_add(number)), samples: SAMPLES, ..Sampling::from(settings) };
        Self { sampling, points: (0..SAMPLES).map(|sample| SequencePoint::new(&sampling, sample)).collect() }
    }
}

/// What came of a pixel.
struct TriedPixel {
    mean: DVec3,
    /// Of one of the pictures.
    variance: DVec3,
    rays: Rays,
}

impl TriedPixel {
    fn of(integrator: &Integrator, pictures: &[Picture], number: u32) -> Self {
        let size = integrator.scene().film.size;
        let [x, y] = pixel_of(number, size);
        let pixel = y.wrapping_mul(size[0]).wrapping_add(x);
        let mut rays = Rays::default();
        let mut radiance = |picture: &Picture| {
            let of_sample = |point| {
                let found = integrator.radiance(x, y, &PathSampler::new(&picture.sampling, pixel, point), &mut rays);
                // The film leaves out what is not finite, too.
                if found.is_finite() { found } else { DVec3::ZERO }
            };
            picture.points.iter().map(of_sample).sum::<DVec3>() / f64::from(SAMPLES)
        };
        let found: Vec<DVec3> = pictures.iter().map(&mut radiance).collect();
        let count = found.len() as f64;
        let mean = found.iter().sum::<DVec3>() / count;
        let variance = found.iter().map(|one| (*one - mean) * (*one - mean)).sum::<DVec3>() / (count - 1.0);
        Self { mean, variance, rays }
    }
}

/// Counts rays of paths and shadow rays.
#[derive(Debug, Clone, Copy, Default)]
struct Rays {
    path: u64,
    shadow: u64,
}

impl Rays {
    fn and(self, other: Self) -> Self {
        Self { path: self.path + other.path, shadow: self.shadow + other.shadow }
    }
}

impl PathVisitor for Rays {
    fn surface(&mut self, _: u32, _: &Surface, _: DVec3, _: DVec3) {
        self.path += 1;
    }

    fn escaped(&mut self, _: DVec3, _: f64, _: DVec3) {
        self.path += 1;
    }

    fn light(&mut self, _: &LightConnection) {
        self.shadow += 1;
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices > MOST_VERTICES
    }
}
