//! The bands of a render, put back into single rows for the file formats.

use std::sync::Arc;
use std::sync::mpsc::Receiver;

use crate::film::Band;

/// A message of the render to a file's writer.
pub(super) enum Message {
    Band(Arc<Band>),
    /// No more bands; the file is to be finished with what came.
    Finish(Completeness),
}

/// Tells whether a picture has all that was asked for.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Completeness {
    /// The picture has as many samples as the render's settings give it.
    #[default]
    Finished,
    /// The render broke off: it was interrupted, or the device was lost.
    BrokenOff,
}

/// Rows from the top, each once. Rows that never came are black and count 0 samples.
pub(super) struct Rows {
    messages: Receiver<Message>,
    band: Arc<Band>,
    finished: Option<Completeness>,
    next_row: u32,
    fewest_samples: u32,
    picture_ends: Option<[[f64; 3]; 2]>,
    blank: Vec<[f32; 3]>,
}

/// Samples of a row's pixels.
pub(super) enum Counts<'a> {
    Even(u32),
    Each(&'a [u32]),
}

impl Counts<'_> {
    pub(super) fn of(&self, pixel: usize) -> u32 {
        match self {
            Self::Even(samples) => *samples,
            Self::Each(counts) => counts[pixel],
        }
    }
}

/// A row; what is not known is empty.
pub(super) struct Row<'a> {
    pub(super) mean: &'a [[f32; 3]],
    pub(super) counts: Counts<'a>,
    pub(super) remainder: &'a [[f32; 3]],
    pub(super) second_moment: &'a [f32],
    pub(super) low: &'a [[f32; 3]],
    pub(super) high: &'a [[f32; 3]],
}

/// The render ended without a word, so the file must not be finished.
#[derive(Debug)]
pub(super) struct Abandoned;

impl Rows {
    pub(super) fn new(messages: Receiver<Message>, width: u32) -> Self {
        Self {
            messages,
            band: Arc::default(),
            finished: None,
            next_row: 0,
            fewest_samples: u32::MAX,
            picture_ends: None,
            blank: vec![[0.0; 3]; width as usize],
        }
    }

    /// Waits for the first band. Whether it says how many samples each pixel has; then all do.
    pub(super) fn have_counts(&mut self) -> Result<bool, Abandoned> {
        self.reach(0)?;
        self.picture_ends = self.band.picture_ends;
        Ok(self.band.counts.is_some())
    }

    /// The ends of the interval of the picture's mean, of which the first band knows.
    pub(super) fn picture_ends(&self) -> Option<[[f64; 3]; 2]> {
        self.picture_ends
    }

    /// The next row.
    pub(super) fn next_row(&mut self) -> Result<Row<'_>, Abandoned> {
        let row = self.next_row;
        self.next_row += 1;
        self.reach(row)?;
        if row < self.band.first_row || row >= self.band.first_row + self.band.rows {
            self.fewest_samples = 0;
            return Ok(Row {
                mean: &self.blank,
                counts: Counts::Even(0),
                remainder: &[],
                second_moment: &[],
                low: &[],
                high: &[],
            });
        }
        self.fewest_samples = self.fewest_samples.min(self.band.samples);
        let width = self.blank.len();
        let start = (row - self.band.first_row) as usize * width;
        let Band { mean, counts, remainder, second_moment, samples, low, high, .. } = &*self.band;
        Ok(Row {
            mean: &mean[start..start + width],
            counts: match counts {
                Some(counts) => Counts::Each(&counts[start..start + width]),
                None => Counts::Even(*samples),
            },
            remainder: remainder.get(start..start + width).unwrap_or_default(),
            second_moment: second_moment.get(start..start + width).unwrap_or_default(),
            low: low.get(start..start + width).unwrap_or_default(),
            high: high.get(start..start + width).unwrap_or_default(),
        })
    }

    /// Takes bands until one reaches to the row or beyond.
    fn reach(&mut self, row: u32) -> Result<(), Abandoned> {
        while self.finished.is_none() && row >= self.band.first_row + self.band.rows {
            match self.messages.recv() {
                Ok(Message::Band(band)) => self.band = band,
                Ok(Message::Finish(completeness)) => self.finished = Some(completeness),
                Err(_) => return Err(Abandoned),
            }
        }
        Ok(())
    }

    /// Waits until the render said that it is over.
    pub(super) fn wait_for_finish(&mut self) -> Result<Completeness, Abandoned> {
        loop {
            if let Some(completeness) = self.finished {
                return Ok(completeness);
            }
            match self.messages.recv() {
                Ok(Message::Band(_)) => {}
                Ok(Message::Finish(completeness)) => self.finished = Some(completeness),
                Err(_) => return Err(Abandoned),
            }
        }
    }

    /// Samples that the least finished pixel of the rows so far received.
    pub(super) fn fewest_samples(&self) -> u32 {
        self.fewest_samples
    }
}

#[cfg(test)]
mod tests {
    use std::sync::mpsc::channel;

    use super::*;

    fn band(first_row: u32, rows: u32, samples: u32) -> Message {
        let mean = (0..rows * 2).map(|index| [(first_row * 2 + index) as f32; 3]).collect();
        Message::Band(Arc::new(Band { first_row, width: 2, rows, samples, counts: None, mean, ..Band::default() }))
    }

    #[test]
    fn rows_come_in_order_and_missing_ones_are_black() {
        let (sender, receiver) = channel();
        for message in [band(0, 2, 8), band(2, 1, 8), band(4, 1, 3), Message::Finish(Completeness::Finished)] {
            sender.send(message).unwrap();
        }
        let mut rows = Rows::new(receiver, 2);
        let firsts: Vec<f32> = (0..4).map(|_| rows.next_row().unwrap().mean[0][0]).collect();
        assert_eq!(firsts, [0.0, 2.0, 4.0, 0.0], "the fourth row was never rendered");
        assert_eq!(rows.fewest_samples(), 0);
        assert_eq!(rows.next_row().unwrap().mean, [[8.0; 3], [9.0; 3]]);
        assert_eq!(rows.next_row().unwrap().mean, [[0.0; 3]; 2]);
    }

    #[test]
    fn a_render_that_breaks_off_is_no_finished_one() {
        let (sender, receiver) = channel();
        sender.send(band(0, 1, 8)).unwrap();
        drop(sender);
        let mut rows = Rows::new(receiver, 2);
        assert!(rows.next_row().is_ok());
        assert_eq!(rows.fewest_samples(), 8);
        assert!(rows.next_row().is_err());
        assert!(rows.wait_for_finish().is_err());
    }
}
