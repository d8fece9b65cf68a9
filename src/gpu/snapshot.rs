//! What a band was like a while ago, kept on the host: a device that is lost takes its film along.

use std::io;
use std::time::{Duration, Instant};

use crate::film::Band;
use crate::renderer::{Batch, RenderError};

/// Time between two snapshots, at least.
const INTERVAL: Duration = Duration::from_secs(2);
/// And so many times what the last one took: they cost a hundredth of the render.
const SHARE: u32 = 100;

/// The last snapshot of a band, if there is one.
pub struct Snapshot<'a> {
    batch: &'a Batch<'a>,
    bands: Vec<Band>,
    taken: Instant,
    took: Duration,
}

impl<'a> Snapshot<'a> {
    /// None yet.
    pub fn new(batch: &'a Batch<'a>) -> Self {
        Self { batch, bands: Vec::new(), taken: Instant::now(), took: Duration::ZERO }
    }

    /// Whether it is time for the next one.
    pub fn is_due(&self) -> bool {
        self.taken.elapsed() >= INTERVAL.max(self.took * SHARE)
    }

    /// Takes one: `deliver` hands over what the film holds. If it fails, the last one stays.
    pub fn take(
        &mut self,
        deliver: impl FnOnce(&Batch<'_>, &mut dyn FnMut(Band) -> io::Result<()>) -> Result<(), RenderError>,
    ) -> Result<(), RenderError> {
        let start = Instant::now();
        let mut bands = Vec::new();
        deliver(self.batch, &mut |band| {
            bands.push(band);
            Ok(())
        })?;
        self.bands = bands;
        self.taken = Instant::now();
        self.took = self.taken - start;
        Ok(())
    }

    /// Hands it over, from this row of the picture on.
    pub fn deliver(self, first_row: u32, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        self.bands.into_iter().filter(|band| band.first_row >= first_row).try_for_each(on_band)
    }
}
