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
/// whose time a graphics card does (docs/performance.md).
const PATHS_AS_CODE: f64 = 6.0;
const PATHS_IN_A_HIERARCHY: f64 = 2.0;
const PATHS_OF_A_CARD: f64 = 100.0;
/// Paths in whose time the reference's hierarchy takes in a triangle.
const PATHS_OF_TRIANGLE: f64 = 0.25;
/// Seconds of a time limit that pass before the first sample, without learning: the driver, and for each triangle reading, packing and the
/// device's hierarchy (two cores, where nothing else runs).
const SECONDS_OF_SET_UP: f64 = 0.15;
const SECONDS_OF_TRIANGLE: f64 = 1.7e-6;
/// Seconds in which the hierarchy that learning needs takes in a triangle.
const SECONDS_OF_HIERARCHY: f64 = 6e-7;

/// Counted work of the cheapest paths, of two vertices that meet next to nothing, where geometry is few primitives, and where it is in a hierarchy. The
/// means of whole pictures are 178 at least, and 228 (`spheres`, `ogre-environment`).
const LEAST_WORK_AS_CODE: f64 = 128.0;
const LEAST_WORK_IN_A_HIERARCHY: f64 = 220.0;

/// Paths below which nothing is learned: a trial run of the fewest pixels takes the time of as many.
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
    /// Counted work that a path takes at least.
    least_work_of_path: f64,
    /// A guide is to be learned too, so that the choice of how lights are drawn from has a part of this alone.
    keeps_a_part_for_the_guide: bool,
}

impl Budget {
    /// The budget of a render of this scene.
    pub fn new(scene: &Scene, effort: Effort) -> Self {
        let samples = match scene.render.expected_spp {
            NumberOrAuto::Number(samples) => samples,
            NumberOrAuto::Auto => scene.render.spp,
        };
        let triangles = triangle_count(scene);
        let is_code = triangles + scene.shapes.len() <= FEW_PRIMITIVES;
        let pace = match effort.pace {
            Pace::Card => PATHS_OF_A_CARD,
            Pace::Processor if is_code => PATHS_AS_CODE,
            Pace::Processor => PATHS_IN_A_HIERARCHY,
        };
        let least_work_of_path = if is_code { LEAST_WORK_AS_CODE } else { LEAST_WORK_IN_A_HIERARCHY };
        let paths = SHARE * pixel_count(scene) as f64 * f64::from(samples) / pace - PATHS_OF_TRIANGLE * triangles as f64;
        let threads = rayon::current_num_threads() as f64;
        let work = effort.time_limit.map(|limit| seconds(limit.as_secs_f64(), triangles as f64) * threads * work::SECOND as f64);
        Self { paths: paths.max(0.0), work, least_work_of_path, keeps_a_part_for_the_guide: false }
    }

    /// Paths that may be traced in all, before it is known what one of them takes: where not even the cheapest are affordable, nothing is made
    /// ready to find out.
    pub fn most_paths(self) -> f64 {
        self.paths(self.least_work_of_path)
    }

    /// Paths that may be traced in all, where one of them takes so much work.
    pub fn paths(self, work_of_path: f64) -> f64 {
        let paths = self.work.map_or(self.paths, |work| self.paths.min(work / work_of_path.max(self.least_work_of_path)));
        if self.keeps_a_part_for_the_guide { (SHARE_OF_LIGHTS * paths).max(PATHS_OF_LIGHTS.min(paths)) } else { paths }
    }

    /// Counted work that may go into paths in all, where one of them takes so much.
    pub fn work(self, work_of_path: f64) -> u64 {
        (self.paths(work_of_path) * work_of_path) as u64
    }

    /// A time limit ends the render.
    pub fn is_limited_by_time(self) -> bool {
        self.work.is_some()
    }

    /// The budget without so many paths.
    #[must_use]
    pub fn after(self, paths: f64, work_of_path: f64) -> Self {
        let work = self.work.map(|work| (work - paths * work_of_path).max(0.0));
        Self { paths: (self.paths - paths).max(0.0), work, ..self }
    }

    /// The part of it for the choice of how lights are drawn from, where a guide `is_wanted` too.
    #[must_use]
    pub fn of_lights(self, guide_is_wanted: bool) -> Self {
        Self { keeps_a_part_for_the_guide: guide_is_wanted, ..self }
    }
}

/// Seconds that may be spent on learning where a render of so many triangles ends after `limit` seconds: a share of what set-up leaves, of
/// which the hierarchy for learning takes the first part.
fn seconds(limit: f64, triangles: f64) -> f64 {
    let of_samples = limit - SECONDS_OF_SET_UP - SECONDS_OF_TRIANGLE * triangles;
    (SHARE * of_samples - SECONDS_OF_HIERARCHY * triangles).max(0.0)
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
        let share = |pace: f64| 0.2 * 256.0 * 256.0 * 60.0 / pace - PATHS_OF_TRIANGLE * triangle_count(&cornell) as f64;
        // The boxes of the Cornell box are twelve triangles' worth of rectangles: geometry that is code.
        assert!((paths(Effort::default()) - share(6.0)).abs() < 1.0, "{}", paths(Effort::default()));
        let on_card = Effort { pace: Pace::Card, ..Effort::default() };
        assert!((paths(on_card) - share(100.0)).abs() < 1.0);
        // A second of a thread is 2²⁶ units of work: of paths of 1,000 units each, a fifth of what set-up leaves.
        let limited = |milliseconds| paths(Effort { time_limit: Some(Duration::from_millis(milliseconds)), ..Effort::default() });
        let of_a_second = 0.2 * f64::from(1 << 26) / 1000.0 * rayon::current_num_threads() as f64;
        let of_set_up = SECONDS_OF_SET_UP + SECONDS_OF_TRIANGLE * triangle_count(&cornell) as f64;
        assert!((limited(1000) - ((1.0 - of_set_up) * of_a_second).min(share(6.0))).abs() < 20.0);
        assert!((limited(250) - (0.25 - of_set_up) * of_a_second).abs() < 20.0);
        assert_eq!(limited(100), 0.0);
        // 100,000 triangles leave a part of the fifth of a second, most of that of ten seconds, and nothing of a third of one.
        assert_eq!([0.33, 1.0, 10.0].map(|limit| (100.0 * seconds(limit, 1e5)).round()), [0.0, 8.0, 188.0]);
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
        let of_lights = |paths: f64, work: Option<f64>| {
            Budget { paths, work, least_work_of_path: LEAST_WORK_AS_CODE, keeps_a_part_for_the_guide: false }
                .of_lights(true)
                .paths(1000.0)
        };
        assert_eq!([30_000.0, 80_000.0, 1e6].map(|paths| of_lights(paths, None)), [30_000.0, 65_536.0, 5e5]);
        // A time limit decides by work, and the choice of lights comes first there too.
        assert_eq!([30_000.0, 80_000.0, 1e6].map(|paths| of_lights(1e9, Some(1000.0 * paths))), [30_000.0, 65_536.0, 5e5]);
    }
}
