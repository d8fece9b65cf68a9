//! Shows a render to its observer while it goes on.

use std::cell::Cell;
use std::io;

use super::batch_sums::BatchSums;
use crate::film::{Band, rounded};
use crate::renderer::sink::Sink;
use crate::renderer::state::BatchState;
use crate::renderer::{Batch, Observer};

/// Passes everything on to another sink, and what the observer wants to see to the observer.
pub struct WatchedSink<'a> {
    sink: &'a mut dyn Sink,
    watch: Watch<'a>,
    /// The next state is the observer's alone.
    is_for_observer: Cell<bool>,
}

/// Who watches what.
#[derive(Clone, Copy)]
pub struct Watch<'a> {
    pub observer: &'a dyn Observer,
    pub batch: &'a Batch<'a>,
    /// Width of the film in pixels.
    pub width: u32,
    /// The region that is rendered, first column and row, width and height.
    pub region: Option<[u32; 4]>,
}

impl<'a> WatchedSink<'a> {
    pub fn new(sink: &'a mut dyn Sink, watch: Watch<'a>) -> Self {
        Self { sink, watch, is_for_observer: Cell::new(false) }
    }
}

impl Sink for WatchedSink<'_> {
    fn band(&mut self, band: Band) -> io::Result<()> {
        self.sink.band(band)
    }

    fn takes_states(&self) -> bool {
        self.sink.takes_states()
    }

    fn wants_state(&self) -> bool {
        let (sink, observer) = (self.sink.wants_state(), self.watch.observer.wants_rows());
        self.is_for_observer.set(observer && !sink);
        sink || observer
    }

    fn state(&mut self, state: BatchState) -> io::Result<()> {
        if self.watch.observer.wants_rows() {
            self.watch.show(&state, None);
        }
        if self.is_for_observer.take() { Ok(()) } else { self.sink.state(state) }
    }
}

impl Watch<'_> {
    /// Shows what the film has, together with what earlier batches brought.
    pub fn show(&self, state: &BatchState, before: Option<&BatchSums>) {
        let rows = state.rows.clone();
        let band = rows_of(state, self.batch, self.width, before);
        if state.film.is_empty() && before.is_none() {
            return;
        }
        match self.region {
            // Rows of a film in bands may begin or end outside of the region.
            Some(region) if rows.start >= region[1] => self.observer.rows_so_far(band.cropped(region)),
            Some(_) => {}
            None => self.observer.rows_so_far(band),
        }
    }
}

/// Rows as means. Of pixels that have no samples of the batch, the film may hold something else.
fn rows_of(state: &BatchState, batch: &Batch<'_>, width: u32, before: Option<&BatchSums>) -> Band {
    let first = state.rows.start as usize * width as usize;
    let pixels = state.rows.len() * width as usize;
    let mut band = Band {
        first_row: state.rows.start,
        width,
        rows: state.rows.len() as u32,
        mean: Vec::with_capacity(pixels),
        ..Band::default()
    };
    let mut counts = Vec::with_capacity(pixels);
    for pixel in 0..pixels {
        let has_samples = state.done > 0 || (pixel as u32) < state.reached;
        let is_known = has_samples && pixel < state.film.len() && batch.takes_part(first + pixel, width);
        let (sums, count) = if is_known { state.film.double(pixel) } else { ([0.0; 4], 0) };
        let [r, g, b] = before.map_or([0.0; 3], |picture| picture.radiance()[first + pixel].map(f64::from));
        let samples = count.saturating_add(before.map_or(0, |picture| picture.counts()[first + pixel]));
        let share = if samples > 0 { f64::from(samples).recip() } else { 0.0 };
        band.mean.push(rounded([(sums[0] + r) * share, (sums[1] + g) * share, (sums[2] + b) * share]).0);
        counts.push(samples);
        // Sums of squares are those of this batch alone.
        if before.is_none() {
            band.second_moment.push((sums[3] * share) as f32);
        }
    }
    band.samples = counts.iter().copied().min().unwrap_or(0);
    band.counts = Some(counts);
    band
}

#[cfg(test)]
mod tests {
    use std::sync::atomic::{AtomicBool, Ordering};
    use std::sync::{Arc, Mutex};

    use super::*;
    use crate::renderer::RenderRequest;
    use crate::renderer::state::{FilmState, Tally};

    #[derive(Default)]
    struct Eyes {
        wants: AtomicBool,
        seen: Mutex<Vec<Band>>,
    }

    impl Observer for Eyes {
        fn progress(&self, _done: u64, _total: u64) {}
        fn stop_requested(&self) -> bool {
            false
        }
        fn wants_rows(&self) -> bool {
            self.wants.load(Ordering::Relaxed)
        }
        fn rows_so_far(&self, rows: Band) {
            self.seen.lock().expect("one thread").push(rows);
        }
    }

    #[derive(Default)]
    struct Checkpoints {
        wants: Cell<bool>,
        states: u32,
    }

    impl Sink for Checkpoints {
        fn band(&mut self, _band: Band) -> io::Result<()> {
            Ok(())
        }
        fn takes_states(&self) -> bool {
            true
        }
        fn wants_state(&self) -> bool {
            self.wants.get()
        }
        fn state(&mut self, _state: BatchState) -> io::Result<()> {
            self.states += 1;
            Ok(())
        }
    }

    fn state() -> BatchState {
        let sums = vec![[2.0, 4.0, 6.0, 8.0]; 6];
        let film = FilmState::Double { sums, samples: vec![2; 6] };
        BatchState { rows: 1..3, done: 0, iteration: 2, reached: 4, film: Arc::new(film), tally: Tally::default() }
    }

    #[test]
    fn each_gets_the_states_that_it_wants() {
        let (eyes, request) = (Eyes::default(), RenderRequest { rows: 0..3, samples: 0..8 });
        let batch = Batch::of(&request);
        let mut checkpoints = Checkpoints::default();
        for (sink_wants, eyes_want) in [(false, false), (true, false), (false, true), (true, true)] {
            checkpoints.wants.set(sink_wants);
            eyes.wants.store(eyes_want, Ordering::Relaxed);
            let (kept, seen) = (checkpoints.states, eyes.seen.lock().expect("one thread").len());
            let watch = Watch { observer: &eyes, batch: &batch, width: 3, region: None };
            let mut watched = WatchedSink::new(&mut checkpoints, watch);
            if watched.wants_state() {
                watched.state(state()).expect("nothing is written");
            }
            assert_eq!(checkpoints.states - kept, u32::from(sink_wants));
            assert_eq!(eyes.seen.lock().expect("one thread").len() - seen, usize::from(eyes_want));
        }
        // The last state of a render that breaks off comes unasked.
        eyes.wants.store(false, Ordering::Relaxed);
        let watch = Watch { observer: &eyes, batch: &batch, width: 3, region: None };
        WatchedSink::new(&mut checkpoints, watch).state(state()).expect("nothing is written");
        assert_eq!(checkpoints.states, 3);
    }

    #[test]
    fn rows_are_means_where_there_are_samples() {
        let request = RenderRequest { rows: 0..3, samples: 0..8 };
        let selection: Vec<bool> = (0..9).map(|pixel| pixel != 4).collect();
        let batch = Batch { selection: Some(&selection), ..Batch::of(&request) };
        let band = rows_of(&state(), &batch, 3, None);
        assert_eq!((band.first_row, band.rows, band.samples), (1, 2, 0));
        assert_eq!(band.counts, Some(vec![2, 0, 2, 2, 0, 0]), "one takes no part, and two are not reached");
        assert_eq!((band.mean[0], band.mean[1], band.second_moment[0]), ([1.0, 2.0, 3.0], [0.0; 3], 4.0));
        let before = BatchSums::with_sums([3, 3], vec![[4.0; 3]; 9], vec![2; 9], vec![2.0; 3]).expect("its size");
        let band = rows_of(&state(), &batch, 3, Some(&before));
        assert_eq!((band.mean[0], band.mean[1]), ([1.5, 2.0, 2.5], [2.0; 3]));
        assert_eq!(band.counts, Some(vec![4, 2, 4, 4, 2, 2]));
        assert!(band.second_moment.is_empty());
    }
}
