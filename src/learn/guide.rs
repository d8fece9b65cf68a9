//! Learning where light comes from, before the first sample of the picture.
//!
//! Training paths have random numbers of their own, so the picture's samples do not depend on them and are
//! unbiased whatever was learned. They are traced in rounds, each twice as large as the one before and guided
//! by what that one found, because light that is hard to find is found sooner so. The last two rounds make
//! the guide. How many paths they have is a matter of the settings and, where a guide has to pay, of the render's
//! length ([`super::budget`]); their results are put together in order. So the guide does not depend on the seed,
//! on threads or on how a device rounds.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::budget::{Budget, TOO_SHORT};
use super::extent::{has_many_triangles, paths_scatter, pixel_count};
use super::paths::{MOST_VERTICES, follow, pixel_of};
use super::trial;
use super::work_of_path;
use crate::reference::bsdf::{BsdfSample, Density, View};
use crate::reference::integrator::Integrator;
use crate::reference::intersect::Surface;
use crate::reference::trace::{LightConnection, PathVisitor};
use crate::reference::work;
use crate::sampling::Sampling;
use crate::sampling::guide::{Arrival, Guide, learn};
use crate::sampling::hash::mix;
use crate::scene::{Guiding, NumberOrAuto, PixelSampler, SamplerKind, Scene};
use crate::spectrum::Spectrum;

/// Rounds, each of twice as many paths as the one before.
const ROUNDS: usize = 5;
/// After so many of them a trial run looks whether guiding pays, where it has to. Error × cost with the
/// guide, over that without one, may be so much at most, or learning ends and paths are not guided. A guide
/// still improves, so early looks allow more.
const MOST_LOSSES: [(usize, f64); 4] = [(2, 1.4), (3, 1.1), (4, 0.9), (ROUNDS, MOST_LOSS)];
/// Largest such ratio for a guide of all rounds. Learning is over by then, so that the guide has to gain no more than the noise of the trial run.
const MOST_LOSS: f64 = 0.9;
/// Paths of the last round for each pixel of the picture, where the scene does not say how many there are.
const PATHS_OF_PIXEL: u32 = 8;
const FEWEST_PATHS: u32 = 1 << 14;
const MOST_PATHS: u32 = 1 << 19;
/// Paths that learning and trial runs together have at least, where a guide has to pay: fewer teach too little.
const LEAST_PATHS: f64 = 65_536.0;
/// Share of these that trial runs take.
const SHARE_OF_TRIALS: f64 = 0.4;
/// Paths of a trial run for each pixel that it tries, with those that look at what is in view.
const PATHS_OF_TRIED_PIXEL: f64 = 96.0;
/// Pixels of a trial run: fewer tell too little, and more tell nothing new.
const TRIED_PIXELS: [f64; 2] = [64.0, 1024.0];
/// Work of all rounds at most: a guide may be asked to learn for minutes, and does where paths take what they
/// usually do.
const MOST_WORK: f64 = 600.0 * work::SECOND as f64;
/// A path that takes more meets thousands of surfaces in one place; then learning takes no longer than a
/// trial run does.
const UNUSUAL_WORK: f64 = 16_384.0;
const MOST_WORK_OF_UNUSUAL: f64 = 8.0 * work::SECOND as f64;
/// Paths that one task traces.
const PATHS_AT_ONCE: u32 = 256;
/// Largest light per throughput that a surface is noted to send on.
const LARGEST_SENT_ON: f64 = 1e30;

/// The result of training.
#[derive(Debug, Clone, Default)]
pub struct Learned {
    /// None where paths are not guided.
    pub guide: Option<Arc<Guide>>,
    /// The reason why paths are guided or are not, where guiding was asked for.
    pub because: Option<String>,
}

/// Why no guide is learned, with the reason where guiding was not turned off; None where it is learned.
pub fn why_none(scene: &Scene, budget: Budget) -> Option<Option<String>> {
    let has_to_pay = scene.render.guiding == Guiding::Auto;
    let because = match scene.render.guiding {
        Guiding::Off => return Some(None),
        _ if !paths_scatter(scene) => "paths have no bounce that light depends on",
        _ if has_to_pay && has_many_triangles(scene) => "learning takes too long for so many triangles",
        _ if has_to_pay && budget.most_paths() < LEAST_PATHS => TOO_SHORT,
        _ => return None,
    };
    Some(Some(because.to_owned()))
}

/// Learns a guide for the scene of an integrator, and leaves it there. There has to be no reason against it
/// ([`why_none`]). `work_of_path`: the work of a path, where that was judged before.
pub fn train(integrator: &mut Integrator, budget: Budget, work_of_path: Option<f64>) -> Learned {
    let not_at_all = |because: String| Learned { guide: None, because: Some(because) };
    let has_to_pay = integrator.scene().render.guiding == Guiding::Auto;
    let of_path = work_of_path.unwrap_or_else(|| work_of_path::of_path(integrator));
    if has_to_pay && budget.paths(of_path) < LEAST_PATHS {
        return not_at_all(TOO_SHORT.to_owned());
    }
    // A guide that was asked for is learned in any case, and by as many paths as it takes unless time is short.
    let is_bounded = has_to_pay || budget.is_limited_by_time();
    let budget = is_bounded.then(|| budget.paths(of_path).max(LEAST_PATHS));
    let Some(rounds) = affordable(rounds(integrator.scene(), budget), of_path, has_to_pay) else {
        return not_at_all(trial::too_much_work("learning", of_path));
    };
    let Trained { guide, paths, loss } = trained(integrator, rounds, has_to_pay);
    if let Some(loss) = loss.filter(|loss| *loss > MOST_LOSS) {
        integrator.set_guide(None);
        return not_at_all(format!("a trial run found {loss:.2} of the error × cost without a guide"));
    }
    integrator.set_guide(guide.clone());
    let Some(found) = &guide else { return not_at_all(format!("{paths} paths found no light")) };
    let why = loss.map_or("asked for".to_owned(), |loss| format!("a trial run found {loss:.2} of the error × cost without one"));
    let because = format!("{why}; {} cells of {paths} paths", found.cells());
    Learned { guide, because: Some(because) }
}

/// Paths of each round, as whole tasks; all of them within the budget, where there is one.
fn rounds(scene: &Scene, budget: Option<f64>) -> [u32; ROUNDS] {
    let last = match scene.render.guiding_paths {
        NumberOrAuto::Number(paths) => paths,
        NumberOrAuto::Auto => {
            let of_pixels = pixel_count(scene).saturating_mul(u64::from(PATHS_OF_PIXEL));
            let of_pixels = of_pixels.clamp(u64::from(FEWEST_PATHS), u64::from(MOST_PATHS)).next_power_of_two() as u32;
            budget.map_or(of_pixels, |paths| of_pixels.min(last_round(paths)))
        }
    };
    std::array::from_fn(|round| (last >> (ROUNDS - 1 - round)).next_multiple_of(PATHS_AT_ONCE))
}

/// Paths of the last round where all rounds and trial runs take so many: a power of two.
fn last_round(paths: f64) -> u32 {
    // Each round has half as many as the next, so all have less than twice as many as the last.
    let last = ((1.0 - SHARE_OF_TRIALS) * 0.5 * paths) as u32;
    1 << last.max(1).ilog2()
}

/// Pixels that each trial run tries, beside rounds of so many paths.
fn pixels_of_trial(scene: &Scene, rounds: &[u32; ROUNDS]) -> u32 {
    let of_rounds = f64::from(rounds.iter().sum::<u32>());
    let of_trials = of_rounds * SHARE_OF_TRIALS / (1.0 - SHARE_OF_TRIALS);
    let [fewest, most] = TRIED_PIXELS;
    let pixels = of_trials / (MOST_LOSSES.len() as f64 * PATHS_OF_TRIED_PIXEL);
    pixels.clamp(fewest, most).min(pixel_count(scene) as f64) as u32
}

/// The rounds, or smaller ones where paths take so much work that all would take longer than a person waits.
/// None: even those would, or a guide that has to pay would be learned from fewer paths than it is worth.
fn affordable(rounds: [u32; ROUNDS], of_path: f64, has_to_pay: bool) -> Option<[u32; ROUNDS]> {
    let most = if of_path > UNUSUAL_WORK { MOST_WORK_OF_UNUSUAL } else { MOST_WORK };
    let fits = |rounds: &[u32; ROUNDS]| f64::from(rounds.iter().sum::<u32>()) * of_path <= most;
    let halves = std::iter::successors(Some(rounds), |rounds| Some(rounds.map(|count| count / 2)));
    let smaller = halves.take_while(|rounds| rounds[0] >= PATHS_AT_ONCE).find(fits);
    smaller
        .filter(|smaller| !has_to_pay || *smaller == rounds)
        .map(|rounds| rounds.map(|count| count.next_multiple_of(PATHS_AT_ONCE)))
}

/// The result of all rounds, or of those up to which it may pay to go on.
struct Trained {
    guide: Option<Arc<Guide>>,
    /// How many paths the guide is made of.
    paths: u32,
    /// Error × cost with the guide over that without one, where it has to pay and there is one.
    loss: Option<f64>,
}

fn trained(integrator: &mut Integrator, rounds: [u32; ROUNDS], has_to_pay: bool) -> Trained {
    let pixels = pixels_of_trial(integrator.scene(), &rounds);
    let mut trained = Trained { guide: None, paths: 0, loss: None };
    let mut first = 0;
    let mut before: (Vec<Arrival>, u32) = Default::default();
    for (round, count) in rounds.into_iter().enumerate() {
        let (mut arrivals, earlier) = std::mem::take(&mut before);
        let found = arrivals_of(integrator, first, count);
        arrivals.extend_from_slice(&found);
        trained.guide = learn(&arrivals).map(Arc::new);
        trained.paths = earlier + count;
        integrator.set_guide(trained.guide.clone());
        let look = MOST_LOSSES.iter().find(|(rounds, _)| has_to_pay && trained.guide.is_some() && *rounds == round + 1);
        if let Some((_, most)) = look {
            let loss = trial::loss_with_guide(integrator, pixels);
            trained.loss = Some(loss);
            if loss > *most {
                break;
            }
        }
        before = (found, count);
        first += count;
    }
    trained
}

/// The random numbers of training: others than those of the picture, whatever its seed.
fn training_numbers(scene: &Scene) -> Sampling {
    let seed = mix(mix(scene.render.seed.wrapping_add(0x6775_6964)));
    Sampling { path: SamplerKind::Independent, pixel: PixelSampler::SameAsPath, seed, ..Sampling::from(&scene.render) }
}

/// The light that arrives along a round of training paths, in their order.
fn arrivals_of(integrator: &Integrator, first: u32, count: u32) -> Vec<Arrival> {
    let sampling = training_numbers(integrator.scene());
    let size = integrator.scene().film.size;
    let tasks: Vec<u32> = (first..first + count).step_by(PATHS_AT_ONCE as usize).collect();
    let of_task = |&start: &u32| {
        let mut trainee = Trainee::default();
        for path in start..start + PATHS_AT_ONCE {
            trainee.begin();
            follow(integrator, &sampling, pixel_of(path, size), path, &mut trainee);
            trainee.end();
        }
        trainee.arrivals
    };
    tasks.par_iter().map(of_task).collect::<Vec<_>>().concat()
}

/// A direction in which a path went on, before it is known what arrives along it.
struct Departure {
    arrival: Arrival,
    /// The path's throughput behind it, and the radiance found before, both as sums over the channels.
    throughput: f64,
    radiance: f64,
    /// The throughput in front of the surface, and the radiance found before a light was sampled there.
    incoming: f64,
    radiance_before: f64,
}

/// Watches training paths.
#[derive(Default)]
struct Trainee {
    arrivals: Vec<Arrival>,
    departures: Vec<Departure>,
    /// The radiance of the path so far, as a sum over the channels.
    radiance: f64,
    position: DVec3,
    normal: DVec3,
    throughput: Spectrum,
    /// The radiance before a light was sampled at the last surface, as in [`Departure`].
    radiance_before: f64,
}

impl Trainee {
    fn begin(&mut self) {
        self.radiance = 0.0;
    }

    /// Light that was found behind a departure, over the throughput up to there, is an estimate of the
    /// radiance that arrives.
    fn end(&mut self) {
        let radiance = self.radiance;
        for departure in self.departures.drain(..) {
            let arrived = (radiance - departure.radiance) / departure.throughput;
            let since = |before: f64| ((radiance - before).max(0.0) / departure.incoming).min(LARGEST_SENT_ON) as f32;
            let sent_on = [departure.radiance, departure.radiance_before].map(since);
            let arrived = arrived.max(0.0) as f32;
            if arrived.is_finite() {
                self.arrivals.push(Arrival { radiance: arrived, sent_on, ..departure.arrival });
            }
        }
    }

    fn found(&mut self, contribution: Spectrum) {
        self.radiance += contribution.sum();
    }
}

impl PathVisitor for Trainee {
    fn surface(&mut self, _depth: u32, surface: &Surface, _wo: DVec3, throughput: Spectrum) {
        self.position = surface.point.position;
        self.throughput = throughput;
    }

    fn medium(&mut self, _depth: u32, position: DVec3, _wo: DVec3, throughput: Spectrum) {
        (self.position, self.normal, self.throughput) = (position, DVec3::ZERO, throughput);
        self.radiance_before = self.radiance;
    }

    fn emission(&mut self, _radiance: Spectrum, _weight: f64, contribution: Spectrum) {
        self.found(contribution);
    }

    fn given_off(&mut self, contribution: Spectrum) {
        self.found(contribution);
    }

    fn view(&mut self, view: &View) {
        self.radiance_before = self.radiance;
        self.normal = view.normal();
    }

    fn light(&mut self, connection: &LightConnection) {
        self.found(connection.contribution);
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        let throughput = (self.throughput * sample.weight).sum();
        if let Density::SolidAngle(pdf) = sample.density
            && throughput > 0.0
            && (self.normal == DVec3::ZERO || sample.wi.dot(self.normal) > 0.0)
        {
            let [position, normal, wi] = [self.position, self.normal, sample.wi].map(|vector| vector.as_vec3());
            let arrival = Arrival { position, normal, wi, radiance: 0.0, pdf: pdf as f32, sent_on: [0.0; 2] };
            let (incoming, radiance_before) = (self.throughput.sum(), self.radiance_before);
            self.departures.push(Departure { arrival, throughput, radiance: self.radiance, incoming, radiance_before });
        }
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices >= MOST_VERTICES
    }

    fn escaped(&mut self, _radiance: Spectrum, _weight: f64, contribution: Spectrum) {
        self.found(contribution);
    }
}
