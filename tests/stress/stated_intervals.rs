//! Stated intervals and whether they hold: pictures of small scenes, once for each of many seeds, whose intervals are looked at at every doubling of
//! the samples, against a long render. One look that misses the truth is a miss of the whole render.
//!
//! Beside it stands the bound of `--target-error` on the relative mean squared error, which is made of variances, at each of its looks.

use std::sync::Mutex;

use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::render::intervals::interval_goal;
use gpt::render::progressive::{self, Goal, Outcome};
use gpt::renderer::{Observer, Silent};
use gpt::scene::SamplerKind;
use gpt::{IntervalBasis, IntervalOptions, IntervalScope};

use super::stated_errors::{SIDE, relative_error, scene};

/// Looks at so many samples per pixel.
const LOOKS: [u32; 5] = [8, 16, 32, 64, 128];
const CONFIDENCE: f64 = 0.95;
/// The scenes, and whether light is rare in them: found by few paths, which carry much of it.
const CASES: [(&str, bool); 6] = [
    ("cornell", false),
    ("spheres", true),
    ("knot-plastic", false),
    ("veach-mis", true),
    ("behind glass", true),
    ("caustic", true),
];

/// The outcome of a scene's renders.
pub struct Coverage {
    pub name: &'static str,
    pub light_is_rare: bool,
    pub by: IntervalBasis,
    pub renders: u32,
    /// Renders with a look at which the picture's interval missed the truth, and those with one at which any pixel's did.
    pub missed: [u32; 2],
    /// Renders with a look at which the relative mean squared error was above the bound that was stated for it.
    pub exceeded: u32,
    /// Half the width of the picture's interval at the last look, as a share of its value, on average.
    pub half_width: f64,
}

/// Hears the bounds of errors while it sees the picture.
#[derive(Default)]
struct Looks {
    rows: Mutex<Vec<[f32; 3]>>,
    truth: Vec<[f64; 3]>,
    exceeded: Mutex<bool>,
}

impl Observer for Looks {
    fn progress(&self, _done: u64, _total: u64) {}
    fn stop_requested(&self) -> bool {
        false
    }
    fn wants_rows(&self) -> bool {
        true
    }
    fn rows_so_far(&self, band: Band) {
        let first = (band.first_row * band.width) as usize;
        let mut rows = self.rows.lock().expect("one thread");
        rows.resize((SIDE * SIDE) as usize, [0.0; 3]);
        rows[first..first + band.mean.len()].copy_from_slice(&band.mean);
    }
    fn error_so_far(&self, _expected: f64, upper: f64) {
        let rows = self.rows.lock().expect("one thread");
        let pixels: Vec<[f64; 3]> = rows.iter().map(|pixel| pixel.map(f64::from)).collect();
        *self.exceeded.lock().expect("one thread") |= relative_error(&pixels, &self.truth) > upper;
    }
}

fn goal(samples: u32) -> Goal {
    Goal { samples: 0..samples, region: None, deadline: None, target_error: None, adaptive: false, interval: None }
}

fn render(
    renderer: &mut ReferenceRenderer,
    seed: u32,
    goal: &Goal,
    observer: &dyn Observer,
    on_band: &mut dyn FnMut(Band),
) -> Outcome {
    let rendered = progressive::render(renderer, [SIDE; 2], seed, goal, observer, &mut |band| {
        on_band(band);
        Ok(())
    });
    rendered.expect("it renders")
}

fn measure((name, light_is_rare): (&'static str, bool), seeds: u32, truth_samples: u32) -> Coverage {
    let plain = scene(name);
    let mut renderer = ReferenceRenderer::new(&plain).expect("the scene fits");
    let mut truth: Vec<[f64; 3]> = Vec::new();
    render(&mut renderer, 1, &goal(truth_samples), &Silent, &mut |band| {
        truth.extend(band.mean.iter().map(|pixel| pixel.map(f64::from)));
    });
    let of_picture: [f64; 3] =
        std::array::from_fn(|channel| truth.iter().map(|pixel| pixel[channel]).sum::<f64>() / truth.len() as f64);
    let mut looks = Looks { truth: truth.clone(), ..Looks::default() };
    let mut exceeded = 0;
    for seed in 0..seeds {
        *looks.exceeded.get_mut().expect("one thread") = false;
        let until = Goal { target_error: Some(1e-9), ..goal(LOOKS[LOOKS.len() - 1]) };
        render(&mut renderer, 1000 + seed, &until, &looks, &mut |_| ());
        exceeded += u32::from(*looks.exceeded.get_mut().expect("one thread"));
    }

    let mut independent = plain.clone();
    let options =
        IntervalOptions { confidence: CONFIDENCE, of: IntervalScope::Picture, layers: true, ..IntervalOptions::default() };
    options.apply(&mut independent.render);
    assert_eq!(independent.render.sampler, SamplerKind::Independent);
    let interval = interval_goal(&independent, &options);
    let mut renderer = ReferenceRenderer::new(&independent).expect("the scene fits");
    let (mut missed, mut half_width) = ([0; 2], 0.0);
    for seed in 0..seeds {
        let mut misses = [false; 2];
        for samples in LOOKS {
            let until = Goal { interval: Some(interval), ..goal(samples) };
            let outcome = render(&mut renderer, 1000 + seed, &until, &Silent, &mut |band| {
                let first = (band.first_row * band.width) as usize;
                for (pixel, truth) in truth[first..first + band.mean.len()].iter().enumerate() {
                    let ends = [band.low[pixel], band.high[pixel]].map(|end| end.map(f64::from));
                    misses[1] |= (0..3).any(|channel| !(ends[0][channel]..=ends[1][channel]).contains(&truth[channel]));
                }
            });
            let found = outcome.interval.expect("it was asked for");
            assert_eq!(found.refuted_by, None, "{name}: a sample is brighter than its bound {:?}", found.sample_bound);
            let ends = |channel: usize| found.picture_low[channel]..=found.picture_high[channel];
            misses[0] |= (0..3).any(|channel| !ends(channel).contains(&of_picture[channel]));
            if samples == LOOKS[LOOKS.len() - 1] {
                half_width += found.widest / f64::from(seeds);
            }
        }
        (0..2).for_each(|of| missed[of] += u32::from(misses[of]));
    }
    let by = interval.options.by.expect("it is settled");
    Coverage { name, light_is_rare, by, renders: seeds, missed, exceeded, half_width }
}

/// All scenes, with so many seeds each, against pictures of so many samples per pixel.
pub fn measure_all(seeds: u32, truth_samples: u32) -> Vec<Coverage> {
    CASES.iter().map(|case| measure(*case, seeds, truth_samples)).collect()
}

/// The rows of the table in docs/strategies.md.
pub fn table(rows: &[Coverage]) -> String {
    let row = |c: &Coverage| {
        let [picture, pixels, exceeded] = [c.missed[0], c.missed[1], c.exceeded]
            .map(|count| format!("{:.1} %", 100.0 * f64::from(count) / f64::from(c.renders)));
        let by = gpt::choice::Choice::name(c.by);
        format!("| {} | {by} | {picture} | {pixels} | ± {:.1} % | {exceeded} |\n", c.name, 100.0 * c.half_width)
    };
    rows.iter().map(row).collect()
}
