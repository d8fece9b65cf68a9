//! How much may be learned before the first sample: at most a fifth of what the render takes.
//!
//! The render's length is its pixels times its samples per pixel, or its time limit. Lengths are counted in paths of the reference, which
//! learns, and each device follows paths so many times as fast. So the choice depends on the scene, its settings, and whether a graphics card
//! renders: not on how fast a machine is, unless a time limit says how long the render is.

use std::time::Duration;

use super::extent::{pixel_count, triangle_count};
use crate::reference::work;
use crate::scene::{FEW_PRIMITIVES, NumberOrAuto, Scene};

/// Share of a render that learning may take.
const SHARE: f64 = 0.2;
/// Share of that which goes to the choice of how lights are drawn from, where a guide may be learned too; and paths that the choice needs,
/// which it has first.
const SHARE_OF_LIGHTS: f64 = 0.5;
const PATHS_OF_LIGHTS: f64 = 65_536.0;
/// Paths of the reference in whose time a software device follows one path, where geometry is code, and where it is in a hierarchy; and in
/// whose time a graphics card does (docs/performance.md, "How many samples a second?" and "How fast is a graphics card?").
const PATHS_AS_CODE: f64 = 6.0;
const PATHS_IN_A_HIERARCHY: f64 = 2.0;
const PATHS_OF_A_CARD: f64 = 100.0;
/// Paths in whose time the reference's hierarchy takes in a triangle.
const PATHS_OF_TRIANGLE: f64 = 0.1;

/// Paths below which nothing is learned: even the least that can be found out takes the time of as many.
pub const LEAST_BUDGET: f64 = 16_384.0;

/// Why nothing is tried, or learned, in short renders.
pub const TOO_SHORT: &str = "the render is too short to learn for";

/// How fast a device follows paths, beside the reference on the same machine.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Pace {
    /// A processor renders: by the reference or by a software driver. Both have one pace, so that they learn the same.
    #[default]
    Processor,
    /// A graphics card renders.
    Card,
}

/// The length of a render, as far as it is known beside its scene.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Effort {
    /// How fast the device is.
    pub pace: Pace,
    /// The time after which the render ends.
    pub time_limit: Option<Duration>,
}

/// Paths of the reference that may be traced before the first sample.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    paths: f64,
    /// Counted work that the time limit leaves for learning, over all threads.
    work: Option<f64>,
}

impl Budget {
    /// The budget of a render of this scene.
    pub fn new(scene: &Scene, effort: Effort) -> Self {
        let samples = match scene.render.expected_spp {
            NumberOrAuto::Number(samples) => samples,
            NumberOrAuto::Auto => scene.render.spp,
        };
        let triangles = triangle_count(scene);
        let pace = match effort.pace {
            Pace::Card => PATHS_OF_A_CARD,
            Pace::Processor if triangles + scene.shapes.len() <= FEW_PRIMITIVES => PATHS_AS_CODE,
            Pace::Processor => PATHS_IN_A_HIERARCHY,
        };
        let paths = SHARE * pixel_count(scene) as f64 * f64::from(samples) / pace - PATHS_OF_TRIANGLE * triangles as f64;
        let threads = rayon::current_num_threads() as f64;
        let work = effort.time_limit.map(|limit| SHARE * limit.as_secs_f64() * threads * work::SECOND as f64);
        Self { paths: paths.max(0.0), work }
    }

    /// Paths that may be traced in all, before it is known what one of them takes.
    pub fn most_paths(self) -> f64 {
        self.paths
    }

    /// Paths that may be traced in all, where one of them takes so much work.
    pub fn paths(self, work_of_path: f64) -> f64 {
        self.work.map_or(self.paths, |work| self.paths.min(work / work_of_path.max(1.0)))
    }

    /// The budget without so many paths.
    #[must_use]
    pub fn after(self, paths: f64, work_of_path: f64) -> Self {
        Self { paths: (self.paths - paths).max(0.0), work: self.work.map(|work| (work - paths * work_of_path).max(0.0)) }
    }

    /// The part of it for the choice of how lights are drawn from, where a guide `is_wanted` too.
    #[must_use]
    pub fn of_lights(self, guide_is_wanted: bool) -> Self {
        if !guide_is_wanted {
            return self;
        }
        let paths = (SHARE_OF_LIGHTS * self.paths).max(PATHS_OF_LIGHTS.min(self.paths));
        Self { paths, work: self.work.map(|work| work * if self.paths > 0.0 { paths / self.paths } else { 0.0 }) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load;

    fn scene(name: &str, size: [u32; 2], spp: u32) -> Scene {
        let mut scene = load::load(Some(name)).expect("a built-in scene");
        (scene.film.size, scene.render.spp) = (size, spp);
        scene
    }

    #[test]
    fn learning_takes_its_share_of_the_render() {
        let cornell = scene("cornell", [256, 256], 60);
        let paths = |effort| Budget::new(&cornell, effort).paths(1000.0);
        let share = |pace: f64| 0.2 * 256.0 * 256.0 * 60.0 / pace;
        // The boxes of the Cornell box are twelve triangles' worth of rectangles: geometry that is code.
        assert!((paths(Effort::default()) - share(6.0)).abs() < 1.0, "{}", paths(Effort::default()));
        let on_card = Effort { pace: Pace::Card, ..Effort::default() };
        assert!((paths(on_card) - share(100.0)).abs() < 1.0);
        // A second of a thread is 2²⁶ units of work: of paths of 1,000 units each, a fifth.
        let limited = Effort { time_limit: Some(Duration::from_secs(1)), ..Effort::default() };
        let of_a_second = 0.2 * f64::from(1 << 26) / 1000.0 * rayon::current_num_threads() as f64;
        assert!((paths(limited) - of_a_second.min(share(6.0))).abs() < 1.0);
        let very_limited = Effort { time_limit: Some(Duration::from_millis(10)), ..Effort::default() };
        assert!((paths(very_limited) - 0.01 * of_a_second).abs() < 1.0);
    }

    #[test]
    fn a_hierarchy_is_part_of_what_learning_takes() {
        let town = scene("teapot-plastic", [256, 256], 1);
        let triangles = triangle_count(&town) as f64;
        assert!(triangles > 64.0);
        let without = 0.2 * 256.0 * 256.0 / PATHS_IN_A_HIERARCHY;
        let budget = Budget::new(&town, Effort::default()).most_paths();
        assert!((budget - (without - PATHS_OF_TRIANGLE * triangles)).abs() < 1.0, "{budget} of {without}");
    }

    #[test]
    fn a_part_learns_for_the_whole() {
        let mut part = scene("cornell", [64, 64], 4);
        let alone = Budget::new(&part, Effort::default()).most_paths();
        part.render.expected_spp = 400.into();
        let of_whole = Budget::new(&part, Effort::default());
        let close = |paths: f64, times: f64| (paths / (times * alone) - 1.0).abs() < 0.02;
        assert!(close(of_whole.most_paths(), 100.0));
        assert!(close(of_whole.after(50.0 * alone, 1.0).most_paths(), 50.0));
        // The choice of lights has what it needs first, and half of what there is in long renders.
        let of_lights = |paths: f64| Budget { paths, work: None }.of_lights(true).most_paths();
        assert_eq!([30_000.0, 80_000.0, 1e6].map(of_lights), [30_000.0, 65_536.0, 5e5]);
    }
}
