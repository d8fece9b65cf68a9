//! Sinks for bands and states of batches while a render is saved in a checkpoint.

use std::io;

use super::batch_sums::BatchSums;
use super::doublings::Doublings;
use super::error::ErrorEstimator;
use super::watching::Watch;
use crate::film::Band;
use crate::render::checkpoint::Checkpoint;
use crate::render::checkpoint::saved::{StepPosition, StepsState};
use crate::render::error_estimate::ErrorEstimate;
use crate::renderer::sink::Sink;
use crate::renderer::state::{BatchState, Tally};

/// The sink of a render that is one batch: bands go to whoever wants the picture.
pub struct WholeBatch<'a> {
    pub checkpoint: &'a mut Checkpoint,
    pub on_band: &'a mut dyn FnMut(Band) -> io::Result<()>,
    /// Bands are finished one after the other, and those that are finished are kept.
    pub in_bands: bool,
}

impl Sink for WholeBatch<'_> {
    fn band(&mut self, band: Band) -> io::Result<()> {
        if self.in_bands {
            self.checkpoint.keep_band(&band)?;
        }
        (self.on_band)(band)
    }

    fn takes_states(&self) -> bool {
        true
    }

    fn wants_state(&self) -> bool {
        self.checkpoint.is_due()
    }

    fn state(&mut self, state: BatchState) -> io::Result<()> {
        if state.tally.samples > 0 {
            self.checkpoint.keep(state, None);
        }
        Ok(())
    }
}

/// The sink of one batch of a render in steps: bands are added to the sum of earlier batches.
pub struct StepBatch<'a> {
    pub checkpoint: Option<&'a mut Checkpoint>,
    pub watch: Watch<'a>,
    pub picture: &'a mut BatchSums,
    pub estimator: Option<&'a mut ErrorEstimator>,
    pub error: Option<ErrorEstimate>,
    pub doublings: Option<&'a mut Doublings>,
    pub levels: &'a [u8],
    pub place: StepPosition,
    /// The counts of earlier batches.
    pub tally: Tally,
    pub selection: Option<&'a [bool]>,
    /// The share of the pixels that take part, and of a pixel's mean that the batch brings.
    pub share: f64,
    pub part_of_mean: f32,
}

impl Sink for StepBatch<'_> {
    fn band(&mut self, band: Band) -> io::Result<()> {
        if let Some(estimator) = &mut self.estimator {
            estimator.add(self.place.stream, &band, self.selection);
        }
        if let Some(doublings) = &mut self.doublings {
            doublings.add(self.place.interval, &band, self.part_of_mean);
        }
        self.picture.add(&band, self.selection, self.share);
        Ok(())
    }

    fn takes_states(&self) -> bool {
        self.checkpoint.is_some()
    }

    fn wants_state(&self) -> bool {
        self.watch.observer.wants_rows() || self.checkpoint.as_ref().is_some_and(|checkpoint| checkpoint.is_due())
    }

    fn state(&mut self, state: BatchState) -> io::Result<()> {
        if self.watch.observer.wants_rows() {
            self.watch.show(&state, Some(self.picture));
            // A render that breaks off brings a state unasked, which is kept.
            if self.checkpoint.as_ref().is_none_or(|checkpoint| !checkpoint.is_due()) && !self.watch.observer.stop_requested() {
                return Ok(());
            }
        }
        if self.tally.samples + state.tally.samples == 0 {
            return Ok(());
        }
        let steps = StepsState {
            place: self.place,
            tally: self.tally,
            radiance: self.picture.radiance().to_vec(),
            counts: self.picture.counts().to_vec(),
            row_samples: self.picture.row_samples().to_vec(),
            streams: self.estimator.as_ref().map_or_else(Vec::new, |estimator| estimator.sums().to_vec()),
            looks: self.estimator.as_ref().map_or(0, |estimator| estimator.looks()),
            error: self.error,
            doublings: self.doublings.as_ref().map_or_else(Vec::new, |doublings| doublings.means().to_vec()),
            levels: self.levels.to_vec(),
            ..StepsState::default()
        };
        if let Some(checkpoint) = &mut self.checkpoint {
            checkpoint.keep(state, Some(steps));
        }
        Ok(())
    }
}
