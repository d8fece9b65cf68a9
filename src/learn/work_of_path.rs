//! The work of one path of a scene, judged by a few of them, and the time that it takes on this machine.

use rayon::prelude::*;

use super::paths::{MOST_VERTICES, follow, pixel_of};
use crate::reference::integrator::Integrator;
use crate::reference::trace::PathVisitor;
use crate::reference::work;
use crate::sampling::Sampling;
use crate::sampling::hash::mix;
use crate::scene::{PixelSampler, SamplerKind};

/// The work of each vertex of a path that meets nothing that is counted.
const VERTEX: u64 = 64;

/// Paths by which work is judged, in batches: a batch is traced where those before it took less than
/// [`MOST_JUDGING`].
const BATCHES: [u32; 4] = [2, 6, 24, 96];
/// Work after which judging ends.
const MOST_JUDGING: u64 = work::SECOND;
/// Work after which a path is given up. It then took more than anything that is traced thousands of times may
/// take.
const MOST_OF_PATH: u64 = work::SECOND / 4;

/// The work of a path of this scene, light samples included, by the mean of a few that are spread over the
/// film: the same ones, whatever the seed.
pub fn of_path(integrator: &Integrator) -> f64 {
    let scene = integrator.scene();
    let sampling = Sampling {
        path: SamplerKind::Independent,
        pixel: PixelSampler::SameAsPath,
        seed: mix(0x776f_726b),
        ..Sampling::from(&scene.render)
    };
    let (mut total, mut first) = (0, 0);
    for count in BATCHES {
        let works = (first..first + count).into_par_iter().map(|path| {
            let mut judge = Judge { start: work::so_far(), vertices: 0 };
            let (_, work) = work::of(|| follow(integrator, &sampling, pixel_of(path, scene.film.size), path, &mut judge));
            work + VERTEX * u64::from(judge.vertices + 1)
        });
        total += works.sum::<u64>();
        first += count;
        if total > MOST_JUDGING {
            break;
        }
    }
    total as f64 / f64::from(first)
}

/// Follows a path that is judged.
struct Judge {
    /// The thread's count where it began.
    start: u64,
    vertices: u32,
}

impl PathVisitor for Judge {
    fn gives_up(&mut self, vertices: u32) -> bool {
        self.vertices = vertices;
        vertices >= MOST_VERTICES || work::so_far().wrapping_sub(self.start) > MOST_OF_PATH
    }
}

/// How long the picture takes on this machine, as far as a few paths of it tell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TimeOfPath {
    pub seconds: f64,
    /// Paths were given up, which take longer than this.
    pub is_least: bool,
}

impl Integrator {
    /// The time that a path takes, with all cores at work, by `paths` of them that are spread over the film,
    /// or by those that end within `limit` seconds. It decides nothing about the picture.
    pub fn time_of_path(&self, paths: u32, limit: f64) -> TimeOfPath {
        let start = std::time::Instant::now();
        let sampling = Sampling::from(&self.scene().render);
        let (mut done, mut gave_up) = (0, 0);
        for first in (0..paths).step_by(PATHS_AT_ONCE as usize) {
            let last = (first + PATHS_AT_ONCE).min(paths);
            let given_up = (first..last).into_par_iter().map(|path| {
                let mut timed = Timed { start, limit, gave_up: false };
                follow(
                    self,
                    &sampling,
                    pixel_of(path, self.scene().film.size),
                    path % self.scene().render.spp.max(1),
                    &mut timed,
                );
                u32::from(timed.gave_up)
            });
            gave_up += given_up.sum::<u32>();
            done = last;
            if start.elapsed().as_secs_f64() > limit {
                break;
            }
        }
        TimeOfPath { seconds: start.elapsed().as_secs_f64() / f64::from(done.max(1)), is_least: gave_up > 0 }
    }
}

/// Paths between two looks at the clock.
const PATHS_AT_ONCE: u32 = 16;

/// Follows a path until the time is up.
struct Timed {
    start: std::time::Instant,
    limit: f64,
    gave_up: bool,
}

impl PathVisitor for Timed {
    fn gives_up(&mut self, _vertices: u32) -> bool {
        self.gave_up = self.start.elapsed().as_secs_f64() > self.limit;
        self.gave_up
    }
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::load;

    /// So many triangles in one place, of a material.
    fn pile(count: usize, material: &str) -> Integrator {
        let faces = "[0, 1, 2], ".repeat(count);
        let text = format!(
            "[camera]\nposition = [0.3, 0.3, 5]\nlook_at = [0.3, 0.3, 0]\nvfov = 10\n[[light]]\ntype = \"point\"\nposition = [1, 1, 4]\nintensity = 1\n\
             [[material]]\nname = \"m\"\ntype = \"diffuse\"\n{material}\n[[shape]]\ntype = \"mesh\"\nmaterial = \"m\"\n\
             positions = [[0,0,0],[1,0,0],[0,1,0]]\nfaces = [{faces}]\n"
        );
        let scene = load::load_toml_str(&text, "pile.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
        Integrator::new(&scene).expect("the reference renders it")
    }

    #[test]
    fn work_grows_as_surfaces_in_one_place_do() {
        let [few, many] = [100, 10_000].map(|count| of_path(&pile(count, "reflectance = 0.5")));
        assert!((50.0..200.0).contains(&(many / few)) || (few < 1000.0 && many > 5000.0), "{few} and {many}");
        // Paths and light go on through them, and each is looked at as it is passed.
        let [opaque, translucent] =
            ["", "\nopacity = 0.5"].map(|opacity| of_path(&pile(1000, &format!("reflectance = 0.5{opacity}"))));
        assert!(translucent > opaque, "{translucent} and {opaque}");
    }

    /// Threads count for themselves, and the judgement is the same however many there are.
    #[test]
    fn work_does_not_depend_on_threads() {
        let scene = pile(500, "reflectance = 0.5\nopacity = 0.7");
        let with = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
            pool.install(|| of_path(&scene))
        };
        assert_eq!(with(1), with(3));
    }
}
