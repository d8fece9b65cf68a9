//! Learning which lights reach which part of a scene, before the first sample ([`crate::sampling::light_cells`]).
//!
//! Training paths, with random numbers of their own, tell where the picture's paths scatter. Space is cut into cells by these points. For each
//! cell, shadow rays go from some of its points to the lights that could send most there if nothing were in between, and what arrives says how
//! often each is worth choosing. All numbers of things are fixed and results are put together in order, so what is learned depends on
//! the scene, its settings and the size of its film alone, not on its seed.

use std::sync::Arc;

use glam::DVec3;
use rayon::prelude::*;

use super::bsdf::{BsdfSample, Density};
use super::integrator::Integrator;
use super::intersect::Surface;
use super::trace::PathVisitor;
use super::training::{follow, pixel_of};
use crate::renderer::RenderError;
use crate::sampling::hash::{dimension_bits, mix};
use crate::sampling::light_cells::{Division, Reaching};
use crate::sampling::light_way::LightWay;
use crate::sampling::{LightCells, LitPoint, Sampling, light_tree};
use crate::scene::{Estimator, Geometry, PixelSampler, SamplerKind, Scene, Shape};

/// Paths that say where light is sampled: about half as many as the picture has pixels.
const FEWEST_PATHS: u32 = 1 << 12;
const MOST_PATHS: u32 = 1 << 15;
/// Paths that one task traces.
const PATHS_AT_ONCE: u32 = 256;
/// Vertices after which a path is given up.
const MOST_VERTICES: u32 = 16;
/// Lights that are tried in each cell.
const TRIED_LIGHTS: usize = 64;
/// Points of a cell from which lights are tried.
const TRIED_POINTS: usize = 8;
/// Shadow rays to each light; and to each of those of which one of these arrived.
const FIRST_RAYS: u32 = 2;
const FURTHER_RAYS: u32 = 8;

/// Primitives of a shape that is no mesh, at most.
const MOST_PRIMITIVES: usize = 16;

/// Temporary.
fn tune(name: &str, default: f64) -> f64 {
    std::env::var(name).ok().and_then(|value| value.parse().ok()).unwrap_or(default)
}

/// A point of a surface at which light may be sampled.
#[derive(Clone, Copy)]
struct Shaded {
    at: LitPoint,
    /// None where the surface scatters to either side.
    normal: DVec3,
}

/// As [`learn`], for a device that renders the scene instead: what was learned, if lights are chosen by cells. `integrator`: the scene made ready, where it is;
/// else it is made where it is needed.
///
/// # Errors
/// What the reference cannot render.
pub fn learn_for_device(scene: &Scene, integrator: &mut Option<Integrator>) -> Result<Option<Arc<LightCells>>, RenderError> {
    if LightWay::of(scene, most_local_lights(scene)) != LightWay::Cells || !is_sampled(scene) {
        return Ok(None);
    }
    let integrator = match integrator {
        Some(integrator) => integrator,
        None => integrator.insert(Integrator::new(scene)?),
    };
    learn(integrator);
    Ok(integrator.light_cells().cloned())
}

/// As many lights as may stand inside a scene.
fn most_local_lights(scene: &Scene) -> usize {
    let emits = scene.materials_that(|material| material.emission.is_some());
    let of_shape = |shape: &Shape| match &shape.geometry {
        _ if !shape.materials().any(|id| emits.get(id) == Some(&true)) => 0,
        Geometry::Mesh(mesh) => mesh.faces.len(),
        _ => MOST_PRIMITIVES,
    };
    (scene.shapes.iter().map(of_shape).sum::<usize>() + scene.lights.len()).min(light_tree::MOST_LIGHTS)
}

/// Whether light is sampled at all. Paths of one edge have no vertex to sample it from.
fn is_sampled(scene: &Scene) -> bool {
    scene.render.estimator != Estimator::Bsdf && scene.render.max_depth != 1
}

/// Learns and leaves what was learned in the integrator, if lights are chosen by cells there.
pub fn learn(integrator: &mut Integrator) {
    let is_known = integrator.light_cells().is_none_or(|cells| cells.count() > 0);
    if is_known || !is_sampled(integrator.scene()) {
        return;
    }
    let start = std::time::Instant::now();
    let shaded = shaded_points(integrator);
    let traced = start.elapsed();
    let points: Vec<LitPoint> = shaded.iter().map(|shaded| shaded.at).collect();
    let division = Division::new(&points);
    let divided = start.elapsed();
    let reaching: Vec<Vec<Reaching>> = division
        .cells()
        .par_iter()
        .enumerate()
        .map(|(cell, members)| {
            reaching(integrator, cell as u32, &members.iter().map(|&number| shaded[number as usize]).collect::<Vec<_>>())
        })
        .collect();
    let table = division.table(&reaching);
    eprintln!(
        "{} points, {} cells, {} with lights, {:.1} lights each; {traced:?} {divided:?} {:?}",
        shaded.len(),
        reaching.len(),
        table.count(),
        reaching.iter().map(|lights| lights.len()).sum::<usize>() as f64 / reaching.len() as f64,
        start.elapsed()
    );
    integrator.set_light_cells(Arc::new(table));
}

/// Where training paths scatter, in their order.
fn shaded_points(integrator: &Integrator) -> Vec<Shaded> {
    let scene = integrator.scene();
    let sampling = Sampling {
        path: SamplerKind::Independent,
        pixel: PixelSampler::SameAsPath,
        seed: mix(0x6c69_6768),
        ..Sampling::from(&scene.render)
    };
    let [width, height] = scene.film.size;
    let count = (width.saturating_mul(height) / 2).clamp(FEWEST_PATHS, MOST_PATHS).next_power_of_two();
    let count = (f64::from(count) * tune("PATHS", 1.0)) as u32;
    let tasks: Vec<u32> = (0..count).step_by(PATHS_AT_ONCE as usize).collect();
    let of_task = |&start: &u32| {
        let mut walker = Walker::default();
        for path in start..start + PATHS_AT_ONCE {
            follow(integrator, &sampling, pixel_of(path, scene.film.size), path, &mut walker);
        }
        walker.shaded
    };
    tasks.par_iter().map(of_task).collect::<Vec<_>>().concat()
}

/// What reaches a cell from lights, whose points are given.
fn reaching(integrator: &Integrator, cell: u32, members: &[Shaded]) -> Vec<Reaching> {
    let Some((choice, tree)) = integrator.lights().in_cells() else { return Vec::new() };
    let tried = tune("POINTS", TRIED_POINTS as f64) as usize;
    let step = members.len().div_ceil(tried).max(1);
    let points: Vec<Shaded> = members.iter().step_by(step).copied().collect();
    let place = |shaded: &Shaded| shaded.at.point;
    let [low, high] =
        points.iter().map(place).fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    let sphere = (0.5 * (low + high), 0.5 * low.distance(high));
    // One of the points may face it.
    let is_before = |light: u32| {
        let (center, radius) = tree.sphere(light);
        let before =
            |shaded: &Shaded| shaded.normal == DVec3::ZERO || (center - shaded.at.point).dot(shaded.normal) + radius > 0.0;
        points.iter().any(before)
    };
    let lights = tree.strongest(sphere, tune("LIGHTS", TRIED_LIGHTS as f64) as usize, is_before);
    let key = mix(cell ^ 0x6365_6c6c);
    let mean_square = |light: u32, rays: std::ops::Range<u32>| {
        let arrived = |ray: u32| {
            let number = |dimension| dimension_bits(mix(key ^ light.wrapping_mul(0x9e37_79b9)), 2 * ray + dimension);
            let from = &points[ray as usize % points.len()];
            integrator.light_reaching((from.at.point, from.normal), light as usize, [number(0), number(1)])
        };
        let power = tune("POWER", 2.0);
        let sums = rays.map(arrived).filter(|[free, _]| (free * free).is_finite());
        sums.fold([0.0; 2], |sums: [f64; 2], sent| std::array::from_fn(|index| sums[index] + sent[index].powf(power)))
    };
    let first = tune("FIRST", f64::from(FIRST_RAYS)) as u32;
    let all = first + tune("FURTHER", f64::from(FURTHER_RAYS)) as u32;
    let of_light = |&light: &u32| {
        let [free, stopped] = mean_square(light, 0..first);
        let square = if stopped > 0.0 {
            (stopped + mean_square(light, first..all)[1]) / f64::from(all)
        } else {
            free / f64::from(first) * tune("PRIOR", 0.0)
        };
        let worth = square.powf(1.0 / tune("POWER", 2.0));
        (worth > 0.0).then(|| Reaching { light, worth, by_power: choice.by_power()[light as usize] })
    };
    lights.iter().filter_map(of_light).collect()
}

/// Notes where paths scatter.
#[derive(Default)]
struct Walker {
    shaded: Vec<Shaded>,
    at: Option<Shaded>,
}

impl PathVisitor for Walker {
    const LIGHTS: bool = false;

    fn surface(&mut self, _depth: u32, surface: &Surface, wo: DVec3, _throughput: DVec3) {
        let normal = surface.point.normal_towards(wo);
        self.at = Some(Shaded { at: LitPoint::new(surface.point.leave_towards(wo), normal), normal });
    }

    fn scattered(&mut self, sample: &BsdfSample) {
        if let (Density::SolidAngle(_), false, Some(mut at)) = (sample.density, sample.is_null, self.at) {
            // What one path goes through is lit from behind.
            if sample.wi.dot(at.normal) < 0.0 {
                at.normal = DVec3::ZERO;
            }
            self.shaded.push(at);
        }
    }

    fn gives_up(&mut self, vertices: u32) -> bool {
        vertices >= MOST_VERTICES
    }
}
