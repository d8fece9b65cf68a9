//! Learning which lights reach which part of a scene, before the first sample
//! ([`crate::sampling::light_cells`]).
//!
//! Training paths, with random numbers of their own, tell where the picture's paths scatter. Space is cut
//! into cells by these points. For each cell, shadow rays go from some of its points to the lights that could
//! send most there if nothing were in between, and what arrives says how often each is worth choosing. Other
//! rays say how much comes from all other lights: where that is much, as under a lamp of thousands of
//! triangles, lists of lights do not help, and `auto` takes the tree. All numbers of things are fixed and
//! results are put together in order, so what is learned depends on the scene, its settings and the size of
//! its film alone, not on its seed.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::budget::{Budget, LEAST_BUDGET};
use super::extent::{has_many_triangles, pixel_count};
use super::paths::{follow, pixel_of};
use super::work_of_path;
use crate::reference::bsdf::{BsdfSample, Density};
use crate::reference::integrator::Integrator;
use crate::reference::intersect::Surface;
use crate::reference::trace::PathVisitor;
use crate::reference::work;
use crate::renderer::RenderError;
use crate::sampling::hash::{dimension_bits, mix};
use crate::sampling::light_cells::{Division, LightCells, Reaching};
use crate::sampling::light_strategy::{LightStrategy, MANY_LIGHTS};
use crate::sampling::{LightSampleContext, LightTree, Sampling};
use crate::scene::{Estimator, Geometry, LightChoice, PixelSampler, ReceiverId, RenderSettings, SamplerKind, Scene, Shape};
use crate::spectrum::Spectrum;

/// Share of the light that may come from lights which are in no list, where nobody says how lights are
/// chosen.
const MOST_UNLISTED: f64 = 0.1;
/// One path for so many pixels says where light is sampled, within these numbers.
const PIXELS_OF_PATH: u64 = 8;
const PATHS: [u64; 2] = [1 << 10, 1 << 14];
/// Share of the paths that may be traced which say it, at most: rays to lights from where they scatter take as long again.
const SHARE: f64 = 0.125;
/// Paths that one task traces.
const PATHS_AT_ONCE: u32 = 128;
/// Work at most of these paths, and work after which no further cell is tried.
const MOST_WORK: u64 = 8 * work::SECOND;
/// Paths that are traced whatever they take.
const FEWEST_AFFORDABLE: u32 = 8;
/// Cells between two looks at the work that is done.
const CELLS_AT_ONCE: usize = 8;
/// Vertices after which a path is given up: few, since what is far along paths matters little for which
/// lights reach a place.
const FIRST_VERTICES: u32 = 16;
/// Lights that are tried in each cell.
const TRIED_LIGHTS: usize = 96;
/// Points of a cell from which lights are tried.
const TRIED_POINTS: usize = 16;
/// Groups of lights at infinity that are tried in each cell.
const TRIED_GROUPS: usize = 16;
/// Shadow rays to each light; to each of those from which something arrived by these; and to others.
const FIRST_RAYS: u32 = 8;
const FURTHER_RAYS: u32 = 8;
const OTHER_RAYS: u32 = 16;
/// Most rounds of these rays, where few lights are tried.
const MOST_ROUNDS: usize = 4;
/// Mean square that a light which seems hidden is taken to send, as a share of that of a light in full view.
const DOUBT: f64 = 0.01;
/// Primitives of a box.
const BOX_PRIMITIVES: usize = 6;

/// A scene whose settings say how lights are chosen.
pub struct LightsSettled<'a> {
    pub scene: Cow<'a, Scene>,
    /// The scene made ready, where that was needed to find out, with what was learned.
    pub integrator: Option<Integrator>,
    /// The reason for the choice, where lights were tried.
    pub because: Option<String>,
    /// Cells of lights were learned, and whether they are better than a choice by power is to be found out.
    pub is_undecided: bool,
}

/// Chooses how lights are chosen, where the scene's settings leave that open and its lights are many, and
/// learns what that needs. Of few lights it learns what a trial run compares with a choice by power.
///
/// Without a trial run, cells of few lights would be learned for nothing. `may_be_tried` says whether there may be one, where a path takes so much work.
///
/// # Errors
/// [`RenderError`] for a scene that the reference cannot render.
pub fn settle(scene: &Scene, budget: Budget, may_be_tried: impl Fn(f64) -> bool) -> Result<LightsSettled<'_>, RenderError> {
    let is_open = scene.render.light_choice == LightChoice::Auto;
    let with = |light_choice| Scene { render: RenderSettings { light_choice, ..scene.render.clone() }, ..scene.clone() };
    let as_it_is = LightsSettled { scene: Cow::Borrowed(scene), integrator: None, because: None, is_undecided: false };
    let wanted = is_open || scene.render.light_choice == LightChoice::Cells;
    let is_in_vain = || is_open && !may_be_tried(0.0) && most_lights(scene) < MANY_LIGHTS;
    if !wanted || is_in_vain() || !is_sampled(scene) || most_lights(scene) < 2 || (is_open && !is_worth_learning(scene, budget)) {
        return Ok(as_it_is);
    }
    let by_cells = if is_open { Cow::Owned(with(LightChoice::Cells)) } else { Cow::Borrowed(scene) };
    let mut integrator = Integrator::new(&by_cells)?;
    let (count, groups) = (integrator.lights().local_count(), integrator.lights().group_count());
    let has_few = count < MANY_LIGHTS;
    let no_cells = integrator.light_strategy() != LightStrategy::Cells || (is_open && has_few && groups < 2);
    let of_path = if no_cells { 0.0 } else { work_of_path::of_path(&integrator) };
    if no_cells || (is_open && has_few && !may_be_tried(of_path)) {
        integrator.set_light_choice(scene.render.light_choice);
        return Ok(LightsSettled { integrator: Some(integrator), ..as_it_is });
    }
    let Some(Learned { table, unlisted }) = learned(&integrator, of_path, is_open.then_some(budget)) else {
        return Ok(without_cells(integrator, has_few, with));
    };
    integrator.set_light_cells(Arc::new(table));
    if is_open && has_few {
        integrator.set_light_choice(LightChoice::Auto);
        return Ok(LightsSettled { integrator: Some(integrator), is_undecided: true, ..as_it_is });
    }
    let percent = 100.0 * unlisted;
    if is_open && unlisted > MOST_UNLISTED {
        integrator.set_light_choice(LightChoice::Tree);
        let because = format!("{percent:.0} % of the light comes from more lights than a place can name");
        return Ok(LightsSettled {
            scene: Cow::Owned(with(LightChoice::Tree)),
            integrator: Some(integrator),
            because: Some(because),
            is_undecided: false,
        });
    }
    let asked_for = if is_open { "" } else { "asked for; " };
    let because = format!("{asked_for}cells name the lights that {:.1} % of the light comes from", 100.0 - percent);
    Ok(LightsSettled { scene: by_cells, integrator: Some(integrator), because: Some(because), is_undecided: false })
}

/// The choice of `auto` where learning takes too long: a tree of many lights, and power of few.
fn without_cells<'a>(mut integrator: Integrator, has_few: bool, with: impl Fn(LightChoice) -> Scene) -> LightsSettled<'a> {
    let choice = if has_few { LightChoice::Power } else { LightChoice::Tree };
    integrator.set_light_choice(choice);
    LightsSettled {
        scene: Cow::Owned(with(choice)),
        integrator: Some(integrator),
        because: Some("which lights reach a place takes too long to learn, since paths meet so much".to_owned()),
        is_undecided: false,
    }
}

/// An upper bound of the number of lights.
fn most_lights(scene: &Scene) -> usize {
    let emits = scene.materials_that(|material| material.emission.is_some());
    let of_shape = |shape: &Shape| match &shape.geometry {
        _ if !shape.materials().any(|id| emits.get(id) == Some(&true)) => 0,
        Geometry::Mesh(mesh) => mesh.faces.len(),
        Geometry::Box(_) => BOX_PRIMITIVES,
        _ => 1,
    };
    scene.shapes.iter().map(of_shape).sum::<usize>() + scene.lights.len()
}

/// Says that light is sampled. Paths of one edge have no vertex to sample it from.
fn is_sampled(scene: &Scene) -> bool {
    scene.render.estimator != Estimator::Bsdf && scene.render.max_depth != 1
}

fn is_worth_learning(scene: &Scene, budget: Budget) -> bool {
    budget.most_paths() >= LEAST_BUDGET && !has_many_triangles(scene)
}

/// A point of a surface at which light may be sampled.
#[derive(Clone, Copy)]
struct Shaded {
    at: LightSampleContext,
    /// Zero where the surface scatters to either side.
    normal: DVec3,
}

/// The result of learning.
struct Learned {
    table: LightCells,
    /// The share of the light from inside the scene that comes from lights in no list, as a mean over cells.
    unlisted: f64,
}

/// Learns from a scene whose lights are chosen by cells. None where that is to be done `within` a budget and takes too much
/// work, a path `of_path`; where it is asked for, less is learned then, and cells that were not tried choose by power.
fn learned(integrator: &Integrator, of_path: f64, within: Option<Budget>) -> Option<Learned> {
    let wanted = path_count(integrator.scene(), within);
    let has_to_be_whole = within.is_some();
    let affordable = (MOST_WORK as f64 / of_path.max(1.0)) as u32;
    if has_to_be_whole && affordable < wanted {
        return None;
    }
    let shaded = shaded_points(integrator, wanted.min(affordable.max(FEWEST_AFFORDABLE)));
    let points: Vec<LightSampleContext> = shaded.iter().map(|shaded| shaded.at).collect();
    let division = Division::new(&points);
    let of_cell = |(cell, members): (usize, &Vec<u32>)| {
        let step = members.len().div_ceil(TRIED_POINTS).max(1);
        let points: Vec<Shaded> = members.iter().step_by(step).map(|&number| shaded[number as usize]).collect();
        Trial { integrator, points, key: mix(cell as u32 ^ 0x6365_6c6c) }.reaching()
    };
    let cells: Vec<(usize, &Vec<u32>)> = division.cells().iter().enumerate().collect();
    let (mut found, mut spent): (Vec<(Vec<Reaching>, f64)>, u64) = (Vec::with_capacity(cells.len()), 0);
    for some in cells.chunks(CELLS_AT_ONCE) {
        if spent > MOST_WORK {
            if has_to_be_whole {
                return None;
            }
            break;
        }
        let tried: Vec<_> = some.par_iter().map(|cell| work::of(|| of_cell(*cell))).collect();
        for (reaching, work) in tried {
            found.push(reaching);
            spent += work;
        }
    }
    found.resize_with(cells.len(), Default::default);
    let unlisted = found.iter().map(|(_, unlisted)| unlisted).sum::<f64>() / found.len().max(1) as f64;
    let reaching: Vec<Vec<Reaching>> = found.into_iter().map(|(reaching, _)| reaching).collect();
    Some(Learned { table: division.table(&reaching), unlisted })
}

/// How many paths say where light is sampled: fewer, and so fewer cells, where the render is short.
fn path_count(scene: &Scene, within: Option<Budget>) -> u32 {
    let [fewest, most] = PATHS;
    // Finer cells are worth what they take where lights are many.
    let within = within.filter(|_| most_lights(scene) < MANY_LIGHTS);
    let affordable = within.map_or(most, |budget| (SHARE * budget.most_paths()) as u64).clamp(fewest, most);
    let affordable = 1 << affordable.ilog2();
    (pixel_count(scene) / PIXELS_OF_PATH).clamp(fewest, most).next_power_of_two().min(affordable) as u32
}

/// The points where so many training paths scatter, in their order.
fn shaded_points(integrator: &Integrator, count: u32) -> Vec<Shaded> {
    let scene = integrator.scene();
    let sampling = Sampling {
        path: SamplerKind::Independent,
        pixel: PixelSampler::SameAsPath,
        seed: mix(0x6c69_6768),
        ..Sampling::from(&scene.render)
    };
    let tasks: Vec<u32> = (0..count).step_by(PATHS_AT_ONCE as usize).collect();
    let of_task = |&start: &u32| {
        let mut walker = Walker::default();
        for path in start..(start + PATHS_AT_ONCE).min(count) {
            follow(integrator, &sampling, pixel_of(path, scene.film.size), path, &mut walker);
        }
        walker.shaded
    };
    tasks.par_iter().map(of_task).collect::<Vec<_>>().concat()
}

/// Lights tried from some points of a cell.
struct Trial<'a> {
    integrator: &'a Integrator,
    points: Vec<Shaded>,
    /// The key of the cell's random numbers.
    key: u32,
}

/// A light, or a group of lights, that is tried on its own.
enum Source {
    /// A light inside the scene.
    Inside(usize),
    /// Lights at infinity of which any may draw a direction that others could draw as well.
    Outside(Range<usize>),
}

impl Trial<'_> {
    /// The light that each light sends to the points, and the share of light from inside the scene that comes
    /// from lights which were not tried.
    fn reaching(&self) -> (Vec<Reaching>, f64) {
        let lights = self.integrator.lights();
        let Some((choice, tree)) = lights.in_cells() else { return Default::default() };
        let inside = tree.map_or_else(|| (0..lights.local_count() as u32).collect(), |tree| self.strongest(tree));
        let outside: Vec<Range<usize>> = lights.groups_at_infinity().take(TRIED_GROUPS).collect();
        let rounds = (TRIED_LIGHTS / (inside.len() + outside.len()).max(1)).clamp(1, MOST_ROUNDS) as u32;
        let sent = |source: &Source| {
            let first = FIRST_RAYS * rounds;
            let sent = self.sent(source, 0..first);
            if sent.arrived > 0.0 { sent + self.sent(source, first..first + FURTHER_RAYS * rounds) } else { sent }
        };
        let mut reaching = Vec::new();
        let mut add = |light: usize, worth: f64| {
            reaching.extend((worth > 0.0).then(|| Reaching { light: light as u32, worth, by_power: choice.by_power()[light] }));
        };
        let mut listed = 0.0;
        for &light in &inside {
            let sent = sent(&Source::Inside(light as usize));
            listed += sent.arrived / sent.rays;
            add(light as usize, sent.worth());
        }
        for group in outside {
            let worth = sent(&Source::Outside(group.clone())).worth();
            let whole: f64 = choice.by_power()[group.clone()].iter().sum();
            group.for_each(|light| add(light, worth * choice.by_power()[light] / whole));
        }
        // Lights chosen by power say what those send that were not tried.
        let others = (0..OTHER_RAYS).map(|ray| {
            let light = choice.choose_by_power(dimension_bits(mix(!self.key), ray));
            if light >= lights.local_count() || inside.contains(&(light as u32)) {
                return 0.0;
            }
            self.sent(&Source::Inside(light), ray..ray + 1).arrived / choice.by_power()[light]
        });
        let unlisted = others.sum::<f64>() / f64::from(OTHER_RAYS);
        (reaching, if unlisted > 0.0 { unlisted / (unlisted + listed) } else { 0.0 })
    }

    /// The lights that could send most to the points if nothing were in between.
    fn strongest(&self, tree: &LightTree) -> Vec<u32> {
        let places = self.points.iter().map(|shaded| shaded.at.point);
        let [low, high] = places.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
        let faces = |light: u32| self.points.iter().any(|shaded| shaded.may_see(tree.sphere(light)));
        tree.strongest((0.5 * (low + high), 0.5 * low.distance(high)), TRIED_LIGHTS, faces)
    }

    /// The light that a source sends to the points along some rays.
    fn sent(&self, source: &Source, rays: Range<u32>) -> Sent {
        let first = match source {
            Source::Inside(light) => *light,
            Source::Outside(group) => group.start,
        };
        let key = mix(self.key ^ (first as u32).wrapping_mul(0x9e37_79b9));
        let along = |ray: u32| {
            let from = &self.points[ray as usize % self.points.len()];
            let numbers = [0, 1].map(|number| dimension_bits(key, 2 * ray + number));
            let (chosen, whole) = match source {
                Source::Inside(light) => ((*light, 1.0), 1.0),
                Source::Outside(group) => self.out_of(group.clone(), dimension_bits(mix(key), ray)),
            };
            let [free, arrived] =
                self.integrator.light_reaching((from.at, from.normal), chosen, numbers).map(|sent| sent * whole);
            // The square counts.
            if (free * free).is_finite() {
                Sent { arrived, square: arrived * arrived, free_square: free * free, rays: 1.0 }
            } else {
                Sent { rays: 1.0, ..Sent::default() }
            }
        };
        rays.map(along).fold(Sent::default(), |sum, sent| sum + sent)
    }

    /// The light of a group that random bits choose by power, with its probability among all lights, and that
    /// of the group. While nothing is learned, lights that draw the same directions have these probabilities
    /// as well.
    fn out_of(&self, group: Range<usize>, bits: u32) -> ((usize, f64), f64) {
        let by_power = self.integrator.lights().in_cells().map_or(&[][..], |(choice, _)| choice.by_power());
        let whole: f64 = group.clone().map(|light| by_power[light]).sum();
        let mut left = whole * f64::from(bits) / 4_294_967_296.0;
        let is_it = |&light: &usize| {
            left -= by_power[light];
            left < 0.0
        };
        let light = group.clone().find(is_it).unwrap_or(group.end - 1);
        ((light, by_power[light]), whole)
    }
}

/// Sums over rays to a light: what arrived along them, its square, and the square of what would have if
/// nothing were in between.
#[derive(Clone, Copy, Default)]
struct Sent {
    arrived: f64,
    square: f64,
    free_square: f64,
    rays: f64,
}

impl std::ops::Add for Sent {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            arrived: self.arrived + other.arrived,
            square: self.square + other.square,
            free_square: self.free_square + other.free_square,
            rays: self.rays + other.rays,
        }
    }
}

impl Sent {
    /// The weight of the light in lists: the root of the mean square, with some doubt where nothing arrived.
    fn worth(self) -> f64 {
        let square = if self.arrived > 0.0 { self.square } else { DOUBT * self.free_square };
        (square / self.rays).sqrt()
    }
}

impl Shaded {
    /// Something in a sphere may be before the surface.
    fn may_see(&self, (center, radius): (DVec3, f64)) -> bool {
        self.normal == DVec3::ZERO || (center - self.at.point).dot(self.normal) + radius > 0.0
    }
}

/// Notes where paths scatter.
#[derive(Default)]
struct Walker {
    shaded: Vec<Shaded>,
    at: Option<Shaded>,
}

impl PathVisitor for Walker {
    const LIGHTS: bool = false;

    fn surface(&mut self, _depth: u32, surface: &Surface, wo: DVec3, _throughput: Spectrum) {
        let normal = surface.point.normal_towards(wo);
        self.at = Some(Shaded { at: LightSampleContext::new(surface.point.leave_towards(wo), normal), normal });
    }

    fn medium(&mut self, _depth: u32, position: DVec3, wo: DVec3, _throughput: Spectrum) {
        self.at = Some(Shaded { at: LightSampleContext::new(position, wo), normal: DVec3::ZERO });
    }

    fn receiver(&mut self, receiver: ReceiverId) {
        if let Some(shaded) = &mut self.at {
            shaded.at = shaded.at.of_receiver(receiver);
        }
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        if let (Density::SolidAngle(_), false, Some(mut at)) = (sample.density, sample.is_null, self.at) {
            // A surface that the path goes through is lit from behind.
            if sample.wi.dot(at.normal) < 0.0 {
                at.normal = DVec3::ZERO;
            }
            self.shaded.push(at);
        }
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices >= FIRST_VERTICES
    }
}
