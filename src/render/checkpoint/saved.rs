//! The state of a render that is saved: the batch under way, and the sum of the batches before it.

use std::path::Path;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::file::{self, Content, DAMAGED};
use super::identity::Identity;
use crate::confidence::sums::{PixelSums, Shared};
use crate::output::OutputError;
use crate::render::error_estimate::ErrorEstimate;
use crate::renderer::state::{BatchState, FilmState, MOST_SAMPLES_PER_ITERATION, Tally};

/// How far a render is.
#[derive(Debug, Clone)]
pub struct Saved {
    /// Seconds that went into it.
    pub seconds: f64,
    /// The device that rendered.
    pub device: String,
    /// The batch under way.
    pub batch: BatchState,
    /// The sum of the earlier batches, for a render in steps.
    pub steps: Option<StepsState>,
    /// The file with the rows that are finished, and how many bytes of it count.
    pub rows: Option<(String, u64)>,
}

/// A render in steps, before the batch under way.
#[derive(Debug, Clone, Default)]
pub struct StepsState {
    pub place: StepPosition,
    pub tally: Tally,
    /// Sums of the picture: means by their numbers of samples, and these.
    pub radiance: Vec<[f32; 3]>,
    pub counts: Vec<u32>,
    /// Per row: the samples per pixel that are spent.
    pub row_samples: Vec<f64>,
    /// For each stream, the sums of the pixels that are looked at.
    pub streams: Vec<Vec<[f64; 4]>>,
    /// Times that the error was looked at, and the last estimate.
    pub looks: u32,
    pub error: Option<ErrorEstimate>,
    /// Mean luminances of the doublings, and how often each pixel's share was doubled before the stage.
    pub doublings: Vec<Vec<f32>>,
    pub levels: Vec<u8>,
    /// Each pixel's sums for intervals, and the numbers that all share.
    pub intervals: Vec<PixelSums>,
    pub shared: Shared,
}

/// The position of a render in its steps.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct StepPosition {
    /// The stage and the interval of the doublings, where samples follow the noise.
    pub stage: usize,
    pub interval: usize,
    /// The step's first request, how many it has, and the stream under way.
    pub next: u32,
    pub requests: u32,
    pub stream: u32,
}

#[derive(Serialize, Deserialize)]
struct Header {
    identity: Identity,
    seconds: f64,
    device: String,
    rows: Option<(String, u64)>,
    batch: BatchHeader,
    steps: Option<StepsHeader>,
}

#[derive(Serialize, Deserialize)]
struct BatchHeader {
    rows: [u32; 2],
    done: u32,
    /// Checkpoints hold it by its old name.
    #[serde(rename = "sweep")]
    iteration: u32,
    reached: u32,
    tally: [u64; 5],
    pixels: usize,
    is_single: bool,
}

#[derive(Serialize, Deserialize)]
struct StepsHeader {
    place: StepPosition,
    tally: [u64; 5],
    pixels: usize,
    rows: usize,
    streams: Vec<usize>,
    looks: u32,
    error: Option<ErrorEstimate>,
    doublings: Vec<usize>,
    levels: usize,
    #[serde(default)]
    intervals: usize,
    #[serde(default)]
    shared: Shared,
}

impl StepsHeader {
    /// Its arrays are those of a picture of this size: the sums of batches, or those of intervals.
    fn fits(&self, pixels: usize, rows: usize) -> bool {
        let of_batches = self.pixels == pixels && self.rows == rows && self.intervals == 0;
        of_batches || (self.intervals == pixels && self.pixels == 0 && self.rows == 0)
    }
}

/// Why a checkpoint is none for this render.
pub enum Refusal {
    /// The file is damaged, in words.
    Unreadable(String),
    /// The file belongs to another render, named here.
    Other(String),
}

fn numbers(tally: Tally) -> [u64; 5] {
    let Tally { rays, samples, non_finite_samples, clamped_samples, clamped_units } = tally;
    [rays, samples, non_finite_samples, clamped_samples, clamped_units]
}

fn tally([rays, samples, non_finite_samples, clamped_samples, clamped_units]: [u64; 5]) -> Tally {
    Tally { rays, samples, non_finite_samples, clamped_samples, clamped_units }
}

impl Saved {
    /// Writes it, whole or not at all.
    ///
    /// # Errors
    /// The errors of [`file::write`].
    pub fn write(&self, path: &Path, identity: &Identity) -> Result<(), OutputError> {
        let BatchState { rows, done, iteration, reached, film, tally } = &self.batch;
        let batch = BatchHeader {
            rows: [rows.start, rows.end],
            done: *done,
            iteration: *iteration,
            reached: *reached,
            tally: numbers(*tally),
            pixels: film.len(),
            is_single: matches!(**film, FilmState::Single { .. }),
        };
        let mut arrays: Vec<&[u8]> = match &**film {
            FilmState::Single { sums, compensations } => vec![bytemuck::cast_slice(sums), bytemuck::cast_slice(compensations)],
            FilmState::Double { sums, samples } => vec![bytemuck::cast_slice(sums), bytemuck::cast_slice(samples)],
        };
        let steps = self.steps.as_ref().map(|steps| {
            arrays.push(bytemuck::cast_slice(&steps.radiance));
            arrays.push(bytemuck::cast_slice(&steps.counts));
            arrays.push(bytemuck::cast_slice(&steps.row_samples));
            arrays.extend(steps.streams.iter().map(|sums| bytemuck::cast_slice(sums)));
            arrays.extend(steps.doublings.iter().map(|means| bytemuck::cast_slice(means)));
            arrays.push(&steps.levels);
            arrays.push(bytemuck::cast_slice(&steps.intervals));
            StepsHeader {
                place: steps.place,
                tally: numbers(steps.tally),
                pixels: steps.radiance.len(),
                rows: steps.row_samples.len(),
                streams: steps.streams.iter().map(Vec::len).collect(),
                looks: steps.looks,
                error: steps.error,
                doublings: steps.doublings.iter().map(Vec::len).collect(),
                levels: steps.levels.len(),
                intervals: steps.intervals.len(),
                shared: steps.shared,
            }
        });
        let Self { seconds, device, rows, .. } = self;
        let identity = identity.clone();
        let header = Header { identity, seconds: *seconds, device: device.clone(), rows: rows.clone(), batch, steps };
        file::write(path, &header, &arrays)
    }

    /// Reads the checkpoint of a render of this identity and size; None where there is none.
    ///
    /// # Errors
    /// A file that is damaged, or of another render.
    pub fn read(path: &Path, identity: &Identity, size: [u32; 2]) -> Result<Option<Self>, Refusal> {
        let Some(mut content) = file::read::<Header>(path).map_err(Refusal::Unreadable)? else { return Ok(None) };
        if let Some(difference) = identity.difference(&content.header.identity) {
            return Err(Refusal::Other(difference.to_string()));
        }
        Self::of(&mut content, size).map(Some).map_err(Refusal::Unreadable)
    }

    fn of(content: &mut Content<Header>, [width, height]: [u32; 2]) -> Result<Self, String> {
        let pixels = width as usize * height as usize;
        let damaged = || DAMAGED.to_owned();
        let BatchHeader { rows, done, iteration, reached, tally: counted, pixels: of_batch, is_single } = content.header.batch;
        let rows = rows[0]..rows[1];
        let is_whole = of_batch == 0 || of_batch == rows.len() * width as usize;
        let is_empty_start = of_batch > 0 || (done == 0 && reached == 0);
        let fits = rows.start <= rows.end && rows.end <= height && reached as usize <= rows.len() * width as usize;
        if !(fits && is_whole && is_empty_start && iteration <= MOST_SAMPLES_PER_ITERATION && (iteration > 0 || reached == 0)) {
            return Err(damaged());
        }
        let film = if is_single {
            FilmState::Single { sums: content.array(of_batch)?, compensations: content.array(of_batch)? }
        } else {
            FilmState::Double { sums: content.array(of_batch)?, samples: content.array(of_batch)? }
        };
        let batch = BatchState { rows, done, iteration, reached, film: Arc::new(film), tally: tally(counted) };
        let steps = match content.header.steps.take() {
            None => None,
            Some(header) if header.fits(pixels, height as usize) => Some(StepsState {
                place: header.place,
                tally: tally(header.tally),
                radiance: content.array(header.pixels)?,
                counts: content.array(header.pixels)?,
                row_samples: content.array(header.rows)?,
                streams: header.streams.iter().map(|items| content.array(*items)).collect::<Result<_, _>>()?,
                looks: header.looks,
                error: header.error,
                doublings: header.doublings.iter().map(|items| content.array(*items)).collect::<Result<_, _>>()?,
                levels: content.array(header.levels)?,
                intervals: content.array(header.intervals)?,
                shared: header.shared,
            }),
            Some(_) => return Err(damaged()),
        };
        let Header { seconds, ref device, ref rows, .. } = content.header;
        Ok(Self { seconds, device: device.clone(), batch, steps, rows: rows.clone() })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::Provenance;
    use crate::scene::{Filter, RenderSettings};

    fn identity(seed: u32) -> Identity {
        let provenance = Provenance {
            scene: String::new(),
            scene_hash: "01".to_owned(),
            settings: RenderSettings { seed, ..RenderSettings::default() },
            filter: Filter::default(),
            first_sample: 0,
            target_error: None,
            adaptive: false,
            interval: None,
            device: String::new(),
        };
        Identity::new(&provenance, [2, 3], None, true)
    }

    #[test]
    fn everything_comes_back() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.checkpoint");
        let films = [
            FilmState::Single { sums: vec![[1.0, 2.0, 3.0, 4.0]; 4], compensations: vec![[0.1; 4]; 4] },
            FilmState::Double { sums: vec![[0.1; 4]; 4], samples: vec![3; 4] },
            FilmState::empty(),
        ];
        for film in films {
            let (done, reached) = if film.is_empty() { (0, 0) } else { (5, 3) };
            let batch =
                BatchState { rows: 1..3, done, iteration: 2, reached, film: Arc::new(film), tally: tally([1, 2, 3, 4, 5]) };
            let steps = StepsState {
                place: StepPosition { stage: 1, interval: 2, next: 3, requests: 4, stream: 5 },
                tally: tally([4, 5, 6, 7, 8]),
                radiance: vec![[0.5; 3]; 6],
                counts: vec![3; 6],
                row_samples: vec![1.0, 2.0, 3.0],
                streams: vec![vec![[1.0; 4]; 2], vec![[2.0; 4]; 2]],
                looks: 7,
                error: Some(ErrorEstimate { mean: 0.1, upper: 0.2, by_one: 0.3, effective_pixels: 0.4 }),
                doublings: vec![vec![1.0; 6], vec![2.0; 6]],
                levels: vec![1; 6],
                ..StepsState::default()
            };
            let of_intervals = StepsState {
                place: StepPosition { next: 9, ..StepPosition::default() },
                intervals: vec![PixelSums { warm_up: [1.0; 3], sum: [2.0; 3], squares: [3.0; 3] }; 6],
                shared: [0.5; 6],
                ..StepsState::default()
            };
            for steps in [None, Some(steps), Some(of_intervals)] {
                let saved =
                    Saved { seconds: 1.5, device: "d".to_owned(), batch: batch.clone(), steps, rows: Some(("r".to_owned(), 9)) };
                saved.write(&path, &identity(1)).expect("it is written");
                let Ok(Some(found)) = Saved::read(&path, &identity(1), [2, 3]) else { panic!("it is not read") };
                assert_eq!(format!("{found:?}"), format!("{saved:?}"));
                assert!(matches!(Saved::read(&path, &identity(2), [2, 3]), Err(Refusal::Other(why)) if why.contains("--seed")));
                // The identity holds the size; a file that contradicts its own identity is damaged.
                assert!(matches!(Saved::read(&path, &identity(1), [2, 2]), Err(Refusal::Unreadable(_))));
            }
        }
        assert!(matches!(Saved::read(&folder.path().join("none"), &identity(1), [2, 3]), Ok(None)));
    }
}
