//! The picture so far, written by the render and read by whoever shows it. Neither waits for the other longer
//! than it takes to copy a pointer.

use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use gpt::choice::Choice;
use gpt::film::Band;
use gpt::output::Display;
use serde::Serialize;

use super::layers::LayerImage;

/// A page that asked for nothing for so long is closed.
const ABSENCE: Duration = Duration::from_secs(15);
/// Shortest time between two pictures, and the part of a render's time that making them may take.
const INTERVAL: Duration = Duration::from_millis(100);
const LONGEST_INTERVAL: Duration = Duration::from_secs(2);
const SHARE: u32 = 20;

/// The picture as it was at some time.
#[derive(Debug, Clone, Default)]
pub struct LivePicture {
    /// Counts pictures, so that who has seen one knows.
    pub number: u64,
    pub width: u32,
    pub height: u32,
    /// Mean radiance, row by row from the top.
    pub mean: Vec<[f32; 3]>,
    pub samples: Vec<u32>,
    /// Mean of the squared luminance; 0 where it is not known.
    pub second_moment: Vec<f32>,
}

/// The numbers that the page gets beside the picture.
#[derive(Debug, Clone, Default, Serialize)]
pub struct Status {
    pub scene: String,
    pub device: String,
    pub phase: Phase,
    /// Why the last render failed.
    pub message: String,
    /// Samples, over all pixels.
    pub done: u64,
    pub total: u64,
    /// Since the render began, until it was over.
    pub seconds: f64,
    /// Relative mean squared error that is expected, and that with a margin for chance, where there is one to reach.
    pub error: Option<[f64; 2]>,
    /// Half the width of the widest interval, as a share of its value, and the confidence, where intervals are stated.
    pub interval: Option<[f64; 2]>,
    /// How often the scene was rendered.
    pub round: u32,
    pub files: Vec<String>,
    /// How previews show radiance.
    pub exposure: String,
    pub tonemap: &'static str,
}

/// The phase that the program is in.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Phase {
    #[default]
    Preparing,
    /// Layers, which come before the picture.
    Layers,
    Rendering,
    Finished,
    Stopped,
    Failed,
}

#[derive(Default)]
struct LiveContent {
    /// Counts changes of anything.
    version: u64,
    status: Status,
    began: Option<Instant>,
    picture: Arc<LivePicture>,
    layers: Vec<LayerImage>,
    /// The names of those that are light groups.
    groups: Vec<String>,
    /// How often layers were put there.
    layered: u64,
    /// When it was last asked for; who receives every picture counts as always asking.
    asked: Option<Instant>,
    receivers: usize,
    /// When the next picture is due.
    due: Option<Instant>,
    /// There will be nothing new any more.
    is_closed: bool,
}

/// Everything that is shown.
#[derive(Default)]
pub struct LiveState {
    shown: Mutex<LiveContent>,
    changed: Condvar,
}

/// The picture at some time.
#[derive(Clone)]
pub struct View {
    pub version: u64,
    pub status: Status,
    pub picture: Arc<LivePicture>,
    pub layers: Vec<LayerImage>,
    /// The names of those that are light groups.
    pub groups: Vec<String>,
    /// How often layers were put there.
    pub layered: u64,
    /// There will be nothing newer.
    pub is_closed: bool,
}

impl LiveState {
    /// Nothing is there yet; the page begins with the display of previews.
    pub fn new(display: &Display) -> Self {
        let state = Self::default();
        state.change(|shown| {
            shown.status.exposure = display.exposure.to_string();
            shown.status.tonemap = display.tone_curve.name();
        });
        state
    }

    fn lock(&self) -> MutexGuard<'_, LiveContent> {
        // The content is whole whatever panicked while holding it.
        self.shown.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn change(&self, change: impl FnOnce(&mut LiveContent)) {
        let mut shown = self.lock();
        change(&mut shown);
        shown.version += 1;
        drop(shown);
        self.changed.notify_all();
    }

    /// A render begins of a scene with this name. The last picture stays until there is another.
    pub fn begin(&self, scene: &str) {
        self.change(|shown| {
            let round = shown.status.round + 1;
            let Status { device, exposure, tonemap, .. } = std::mem::take(&mut shown.status);
            shown.status = Status { scene: scene.to_owned(), round, device, exposure, tonemap, ..Status::default() };
            (shown.began, shown.due) = (Some(Instant::now()), None);
            shown.layers.clear();
            shown.groups.clear();
        });
    }

    /// Notes the device that renders.
    pub fn on_device(&self, device: &str) {
        self.change(|shown| device.clone_into(&mut shown.status.device));
    }

    /// Layers beside the picture are there, among them those of light groups of these names.
    pub fn layers(&self, layers: Vec<LayerImage>, groups: Vec<String>) {
        self.change(|shown| (shown.layers, shown.groups, shown.layered) = (layers, groups, shown.layered + 1));
    }

    pub fn progress(&self, phase: Phase, done: u64, total: u64) {
        self.change(|shown| {
            let status = &mut shown.status;
            (status.phase, status.done, status.total) = (phase, done, total);
        });
    }

    pub fn interval(&self, widest: f64, confidence: f64) {
        self.change(|shown| shown.status.interval = Some([widest, confidence]));
    }

    pub fn error(&self, expected: f64, upper: f64) {
        self.change(|shown| shown.status.error = Some([expected, upper]));
    }

    /// The render is over, for this reason.
    pub fn end(&self, phase: Phase, message: &str, files: &[String]) {
        self.change(|shown| {
            shown.status.seconds = seconds_since(shown.began.take());
            shown.status.phase = phase;
            shown.status.message = message.to_owned();
            shown.status.files = files.to_vec();
        });
    }

    /// True if somebody looks and a picture is due.
    pub fn wants_picture(&self) -> bool {
        let shown = self.lock();
        let is_watched = shown.receivers > 0 || shown.asked.is_some_and(|asked| asked.elapsed() < ABSENCE);
        is_watched && shown.due.is_none_or(|due| due <= Instant::now())
    }

    /// Rows of a picture of this size replace those that are shown. `made_since`: when the making of them began.
    pub fn rows(&self, rows: Band, height: u32, made_since: Instant) {
        let is_whole = rows.first_row == 0 && rows.rows == height;
        let mut picture = LivePicture::default();
        let mut part = None;
        if is_whole {
            picture.take(rows, height)
        } else {
            part = Some(rows)
        }
        self.change(|shown| {
            let number = shown.picture.number + 1;
            match part {
                None => shown.picture = Arc::new(picture),
                // Copied where somebody reads it at this moment.
                Some(rows) => Arc::make_mut(&mut shown.picture).take(rows, height),
            }
            // Nobody else has it yet, or no longer.
            Arc::make_mut(&mut shown.picture).number = number;
            let took = made_since.elapsed();
            shown.due = Some(Instant::now() + (took * SHARE).clamp(INTERVAL, LONGEST_INTERVAL.max(took * SHARE)));
        });
    }

    /// Waits until there is something newer than `version`, at most so long. `is_page`: somebody looks at the page.
    pub fn view_after(&self, version: u64, patience: Duration, is_page: bool) -> View {
        let mut shown = self.lock();
        if is_page {
            shown.asked = Some(Instant::now());
        }
        let (mut shown, _) = self
            .changed
            .wait_timeout_while(shown, patience, |shown| shown.version <= version && !shown.is_closed)
            .unwrap_or_else(PoisonError::into_inner);
        if is_page {
            shown.asked = Some(Instant::now());
        }
        let mut status = shown.status.clone();
        if shown.began.is_some() {
            status.seconds = seconds_since(shown.began);
        }
        let (picture, layers, groups) = (shown.picture.clone(), shown.layers.clone(), shown.groups.clone());
        View { version: shown.version, status, picture, layers, groups, layered: shown.layered, is_closed: shown.is_closed }
    }

    /// There will be nothing new any more.
    pub fn close(&self) {
        self.change(|shown| shown.is_closed = true);
    }

    /// One more, or one less, receives every picture.
    pub fn receivers(&self, difference: isize) {
        let mut shown = self.lock();
        shown.receivers = shown.receivers.saturating_add_signed(difference);
    }
}

fn seconds_since(began: Option<Instant>) -> f64 {
    began.map_or(0.0, |began| began.elapsed().as_secs_f64())
}

impl LivePicture {
    /// Takes rows over, in a picture of their width and of this height.
    fn take(&mut self, rows: Band, height: u32) {
        let pixels = rows.width as usize * height as usize;
        if (self.width, self.height) != (rows.width, height) {
            *self = Self { number: self.number, width: rows.width, height, ..Self::default() };
        }
        let first = rows.first_row as usize * rows.width as usize;
        let count = rows.mean.len().min(pixels.saturating_sub(first));
        let samples = rows.counts.unwrap_or_else(|| vec![rows.samples; rows.mean.len()]);
        if first == 0 && rows.mean.len() == pixels {
            (self.mean, self.samples, self.second_moment) = (rows.mean, samples, rows.second_moment);
        } else {
            self.mean.resize(pixels, [0.0; 3]);
            self.samples.resize(pixels, 0);
            self.mean[first..first + count].copy_from_slice(&rows.mean[..count]);
            self.samples[first..first + count].copy_from_slice(&samples[..count]);
            self.second_moment.resize(pixels, 0.0);
            let known = count.min(rows.second_moment.len());
            self.second_moment[first..first + known].copy_from_slice(&rows.second_moment[..known]);
        }
        self.second_moment.resize(pixels, 0.0);
    }

    /// Standard error of the luminance of each pixel, if its samples were independent; not a number where that is not known.
    pub fn standard_errors(&self) -> impl Iterator<Item = f32> + '_ {
        self.mean.iter().zip(&self.samples).zip(&self.second_moment).map(|((mean, &samples), &square)| {
            let luminance = 0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2];
            if samples < 2 || square <= 0.0 {
                return if luminance == 0.0 && samples > 1 { 0.0 } else { f32::NAN };
            }
            ((square - luminance * luminance).max(0.0) / (samples - 1) as f32).sqrt()
        })
    }

    /// Fewest and most samples of a pixel.
    pub fn sample_range(&self) -> [u32; 2] {
        let fewest = self.samples.iter().copied().min().unwrap_or(0);
        [fewest, self.samples.iter().copied().max().unwrap_or(0)]
    }

    /// The relative mean squared error that would be expected if all samples were independent; None where it is not known.
    pub fn expected_error(&self) -> Option<f64> {
        let (mut sum, mut pixels) = (0.0, 0_u64);
        for (error, mean) in self.standard_errors().zip(&self.mean) {
            let luminance = f64::from(0.2126 * mean[0] + 0.7152 * mean[1] + 0.0722 * mean[2]);
            if error.is_finite() {
                sum += f64::from(error).powi(2) / (luminance * luminance + gpt::compare::RELATIVE_EPSILON);
                pixels += 1;
            }
        }
        (pixels > 0 && 2 * pixels as usize >= self.mean.len()).then(|| sum / pixels as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows(first_row: u32, count: u32, value: f32) -> Band {
        let pixels = 2 * count as usize;
        let mean = vec![[value; 3]; pixels];
        let second_moment = vec![value * value + 0.75; pixels];
        Band { first_row, width: 2, rows: count, samples: 4, mean, second_moment, ..Band::default() }
    }

    #[test]
    fn rows_stand_where_they_belong_and_errors_are_those_of_means() {
        let state = LiveState::default();
        state.rows(rows(0, 3, 1.0), 3, Instant::now());
        state.rows(rows(1, 1, 2.0), 3, Instant::now());
        let view = state.view_after(0, Duration::ZERO, false);
        let picture = view.picture;
        assert_eq!((picture.number, picture.width, picture.height), (2, 2, 3));
        assert_eq!(picture.mean.iter().map(|mean| mean[0]).collect::<Vec<_>>(), [1.0, 1.0, 2.0, 2.0, 1.0, 1.0]);
        assert_eq!((picture.sample_range(), view.version), ([4, 4], 2));
        // Variance of a sample 0.75 · 4/3 = 1, of the mean of four a quarter.
        assert!(picture.standard_errors().all(|error| (error - 0.5).abs() < 1e-6));
        let expected =
            (4.0 * 0.25 / (1.0 + gpt::compare::RELATIVE_EPSILON) + 2.0 * 0.25 / (4.0 + gpt::compare::RELATIVE_EPSILON)) / 6.0;
        assert!((picture.expected_error().expect("it is known") - expected).abs() < 1e-6);
        let unknown = Band { second_moment: Vec::new(), ..rows(0, 3, 1.0) };
        state.rows(unknown, 3, Instant::now());
        assert_eq!(state.view_after(0, Duration::ZERO, false).picture.expected_error(), None);
        // Another size: nothing of the old picture stays.
        state.rows(Band { width: 1, ..rows(0, 1, 5.0) }, 4, Instant::now());
        assert_eq!(state.view_after(0, Duration::ZERO, false).picture.mean[2..], [[0.0; 3]; 2]);
    }

    #[test]
    fn pictures_are_made_for_somebody_and_not_too_often() {
        let state = LiveState::default();
        assert!(!state.wants_picture(), "nobody looks");
        let _ = state.view_after(0, Duration::ZERO, true);
        assert!(state.wants_picture());
        state.rows(rows(0, 3, 1.0), 3, Instant::now());
        assert!(!state.wants_picture(), "there was one just now");
        state.begin("next");
        assert!(state.wants_picture(), "the first of a render is due at once");
        let other = LiveState::default();
        other.receivers(1);
        assert!(other.wants_picture());
        other.receivers(-1);
        assert!(!other.wants_picture());
    }

    #[test]
    fn who_waits_is_woken() {
        let state = Arc::new(LiveState::default());
        let waiting = state.clone();
        let waiter = std::thread::spawn(move || waiting.view_after(0, Duration::from_secs(60), true).status.done);
        while state.lock().asked.is_none() {
            std::thread::yield_now();
        }
        state.progress(Phase::Rendering, 7, 9);
        assert_eq!(waiter.join().expect("it does not panic"), 7);
    }
}
