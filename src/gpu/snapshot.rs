//! A band as it was a while ago, kept on the host: a device that is lost takes its film along.

use std::io;
use std::time::{Duration, Instant};

use super::film::{Reached, deliver_band};
use crate::film::Band;
use crate::renderer::state::BatchState;
use crate::renderer::{Batch, RenderError};

/// Time between two snapshots, at least.
const INTERVAL: Duration = Duration::from_secs(2);
/// And so many times what the last one took: they cost a hundredth of the render.
const SHARE: u32 = 100;

/// The last snapshot of a band, if there is one.
pub struct Snapshot {
    /// The part of the band that was rendered, and its sums.
    kept: Option<(Reached, BatchState)>,
    taken: Instant,
    took: Duration,
}

impl Snapshot {
    /// None yet.
    pub fn new() -> Self {
        Self { kept: None, taken: Instant::now(), took: Duration::ZERO }
    }

    /// Says that it is time for the next snapshot.
    pub fn is_due(&self) -> bool {
        self.taken.elapsed() >= INTERVAL.max(self.took * SHARE)
    }

    /// Takes one. If that fails, the last one stays.
    ///
    /// # Errors
    /// [`RenderError`] that `read` reports.
    pub fn take(
        &mut self,
        reached: Reached,
        read: impl FnOnce() -> Result<BatchState, RenderError>,
    ) -> Result<&BatchState, RenderError> {
        let start = Instant::now();
        let state = read()?;
        self.taken = Instant::now();
        self.took = self.taken - start;
        Ok(&self.kept.insert((reached, state)).1)
    }

    /// The sums, from which a render can go on.
    pub fn state(&self) -> Option<&BatchState> {
        self.kept.as_ref().map(|(_, state)| state)
    }

    /// Hands over what the band was like, from this row of the picture on.
    ///
    /// # Errors
    /// [`io::Error`] of the receiver.
    pub fn deliver(
        &self,
        width: u32,
        batch: &Batch<'_>,
        first_row: u32,
        on_band: &mut dyn FnMut(Band) -> io::Result<()>,
    ) -> Result<(), RenderError> {
        let Some((reached, state)) = &self.kept else { return Ok(()) };
        let read = |rows: std::ops::Range<u32>| {
            let pixels = rows.start as usize * width as usize..rows.end as usize * width as usize;
            Ok(pixels.map(|pixel| state.film.single(pixel)).unzip())
        };
        deliver_band(width, reached, batch, &read, &mut |band| if band.first_row >= first_row { on_band(band) } else { Ok(()) })
    }
}
