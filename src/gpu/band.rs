//! How far a band is, on the device and in a state from which another render goes on.

use std::cell::Cell;
use std::ops::Range;
use std::sync::Arc;

use super::film::Reached;
use crate::renderer::state::{BatchState, FilmState, Tally};
use crate::renderer::{Batch, Stopping};
use crate::sampling::Sampling;

/// A band being rendered.
pub struct BandProgress {
    pub first_row: u32,
    pub rows: u32,
    /// Pixels that take part, and how many of them have samples, from the first.
    pub pixels: u32,
    pub reached: u32,
    /// Samples per pixel of the iterations that are over.
    pub done: u32,
    /// Samples per pixel of the iteration under way, 0 where none is, and how many of the pixels have them.
    pub iteration: u32,
    pub next_pixel: u32,
    /// Finished samples of this render, over all pixels of the band.
    pub samples_done: u64,
}

impl BandProgress {
    /// A band without samples.
    pub fn new([first_row, rows]: [u32; 2], pixels: u32) -> Self {
        Self { first_row, rows, pixels, reached: 0, done: 0, iteration: 0, next_pixel: 0, samples_done: 0 }
    }

    /// Goes on from a state of these rows.
    pub fn resume(&mut self, state: &BatchState, batch: &Batch<'_>, width: u32) {
        self.done = state.done;
        self.iteration = state.iteration;
        let reached = state.reached.min(self.rows * width);
        let first = (self.first_row * width) as usize;
        self.next_pixel = if batch.selects() {
            (first..first + reached as usize).filter(|pixel| batch.takes_part(*pixel, width)).count() as u32
        } else {
            reached
        };
        self.reached = if self.done > 0 { self.pixels } else { self.next_pixel };
    }

    /// Pixels may differ in their numbers of samples.
    pub fn is_uneven(&self) -> bool {
        self.next_pixel > 0
    }

    /// The part of the band that has samples.
    pub fn reached(&self, with_counts: bool) -> Reached {
        Reached { first_row: self.first_row, rows: self.rows, pixels: self.reached, least: self.done, with_counts }
    }

    /// The band as a state, with the sums of its rows.
    pub fn state(&self, batch: &Batch<'_>, width: u32, film: FilmState, tally: Tally) -> BatchState {
        let first = (self.first_row * width) as usize;
        let end = first + (self.rows * width) as usize;
        // The list of pixels is in the order of the film.
        let reached = if batch.selects() && self.next_pixel > 0 {
            let mut taking_part = (first..end).filter(|pixel| batch.takes_part(*pixel, width));
            taking_part.nth(self.next_pixel as usize).map_or(end - first, |pixel| pixel - first) as u32
        } else {
            self.next_pixel
        };
        BatchState {
            rows: self.first_row..self.first_row + self.rows,
            done: self.done,
            iteration: if self.next_pixel > 0 { self.iteration } else { 0 },
            reached,
            film: Arc::new(film),
            tally,
        }
    }
}

/// Facts that all bands of a batch share.
pub struct BatchContext<'a> {
    pub batch: &'a Batch<'a>,
    pub samples: Range<u32>,
    pub sampling: Sampling,
    pub stopping: Stopping<'a>,
    /// Is told how many samples of the band are done.
    pub progress: &'a dyn Fn(u64),
    /// Counts from before this render.
    pub before: Tally,
    /// Samples of the bands that are over, over all pixels, those before this render included.
    pub finished: &'a Cell<u64>,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::renderer::RenderRequest;

    /// Positions in a list of pixels and in the film are the same place.
    #[test]
    fn a_band_goes_on_where_it_was() {
        let request = RenderRequest { rows: 0..4, samples: 0..8 };
        let selection: Vec<bool> = (0..4 * 5).map(|pixel| pixel % 3 != 0).collect();
        for selection in [None, Some(selection.as_slice())] {
            let batch = Batch { selection, ..Batch::of(&request) };
            let pixels = (10..20).filter(|pixel| batch.takes_part(*pixel, 5)).count() as u32;
            for next_pixel in 0..pixels {
                for done in [0, 3] {
                    let mut band = BandProgress::new([2, 2], pixels);
                    (band.done, band.iteration, band.next_pixel) = (done, 2, next_pixel);
                    let state = band.state(&batch, 5, FilmState::empty(), Tally::default());
                    let mut again = BandProgress::new([2, 2], pixels);
                    again.resume(&state, &batch, 5);
                    assert_eq!((again.done, again.next_pixel), (done, next_pixel));
                    assert_eq!(again.iteration, if next_pixel > 0 { 2 } else { 0 });
                    assert_eq!(again.reached, if done > 0 { pixels } else { next_pixel });
                }
            }
        }
    }
}
