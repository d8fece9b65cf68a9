//! Rendering until something other than a number of samples is reached: a time, an error, and with more samples where the noise is.
//!
//! If only time may end a render early, the renderer itself goes over the film until then
//! ([`Batch::deadline`]). Else a picture is rendered in **steps**, the first of which covers the whole film,
//! so that it is whole whenever it ends. The results of the steps are averaged on the host.
//!
//! - With an error to reach, every step renders several **streams** of samples, each with random numbers of its own. Streams are
//!   independent whatever the sampler, so what they differ by tells the error of their mean ([`error`]).
//! - With intervals to state, one sample of each pixel is rendered after the other, all of them independent ([`crate::confidence`]).
//! - With samples that follow the noise, steps belong to **stages** ([`schedule`]). A stage gives every pixel its share, and then some of them
//!   more, by what their neighbours' samples show ([`allocation`]). A pixel has the first samples of one sequence, as many as that makes, and
//!   what it shows is their plain mean: what its own samples saw never decides how many more it gets. Did it, pixels whose first samples
//!   happened to be dark would get few more and stay dark: that estimator is biased.

pub mod allocation;
pub mod batch_sums;
pub mod doublings;
pub mod error;
mod goal;
mod keeping;
mod passes;
pub mod schedule;
mod steps;
mod watching;

use std::io;
use std::time::Instant;

use super::checkpoint::Checkpoint;
use crate::film::Band;
use crate::renderer::{Batch, Observer, RenderError, RenderRequest, Renderer};
use goal::stop_of;
pub use goal::{Goal, Outcome, STREAMS, Stop};
use keeping::WholeBatch;
use passes::Passes;
use steps::Work;
use watching::{Watch, WatchedSink};

/// Renders the whole film of `size` and hands it over as bands from the top. `Band::samples` of an adaptive picture are the samples per
/// pixel that were spent on average.
///
/// # Errors
/// Errors of the renderer.
pub fn render(
    renderer: &mut dyn Renderer,
    size: [u32; 2],
    seed: u32,
    goal: &Goal,
    observer: &dyn Observer,
    on_band: &mut dyn FnMut(Band) -> io::Result<()>,
) -> Result<Outcome, RenderError> {
    render_kept(renderer, size, seed, goal, observer, None, on_band)
}

/// True if a render for this goal is one batch: nothing but time may end it before its last sample, and the
/// device's film has all of the picture where time may.
pub fn is_one_batch(goal: &Goal, holds_whole_film: bool) -> bool {
    goal.target_error.is_none() && goal.interval.is_none() && !goal.adaptive && (goal.deadline.is_none() || holds_whole_film)
}

/// Renders as [`render`] does, from the place of the checkpoint, which gets further states.
///
/// # Errors
/// The errors of [`render`].
pub fn render_kept(
    renderer: &mut dyn Renderer,
    size: [u32; 2],
    seed: u32,
    goal: &Goal,
    observer: &dyn Observer,
    mut checkpoint: Option<&mut Checkpoint>,
    on_band: &mut dyn FnMut(Band) -> io::Result<()>,
) -> Result<Outcome, RenderError> {
    let resume = match &mut checkpoint {
        Some(checkpoint) => checkpoint.resume(on_band)?,
        None => None,
    };
    if let Some(interval) = &goal.interval {
        return Passes { renderer, size, seed, goal, interval, observer, checkpoint }.render(resume, on_band);
    }
    if is_one_batch(goal, renderer.holds_whole_film()) {
        let [x, y, columns, rows] = goal.region.unwrap_or([0, 0, size[0], size[1]]);
        let request = RenderRequest { rows: y..y + rows, samples: goal.samples.clone() };
        let resume = resume.map(|saved| saved.batch);
        let batch = Batch {
            seed: Some(seed),
            columns: Some((x, x + columns)).filter(|_| columns < size[0]),
            deadline: goal.deadline,
            resume: resume.as_ref(),
            ..Batch::of(&request)
        };
        return render_iterations(
            renderer,
            Watch { observer, batch: &batch, width: size[0], region: goal.region },
            checkpoint,
            on_band,
        );
    }
    let start = Instant::now();
    let mut work = Work::new(renderer, size, seed, goal, observer);
    work.keep_in(checkpoint);
    if let Some(saved) = resume {
        let misfit = || RenderError::Internal("the checkpoint does not fit the picture".to_owned());
        work.go_on_from(saved).ok_or_else(misfit)?;
    }
    let stop = work.run();
    // Samples rendered before a device was lost are kept.
    if matches!(stop, Ok(_) | Err(RenderError::DeviceLost(_))) {
        work.deliver(on_band)?;
    }
    Ok(work.outcome(stop?, start.elapsed()))
}

/// Only time may end this render before its last sample, and the device's film has it all: the picture is,
/// bit for bit, the one that no limit would have given, as far as it goes.
fn render_iterations(
    renderer: &mut dyn Renderer,
    watch: Watch<'_>,
    checkpoint: Option<&mut Checkpoint>,
    mut on_band: &mut dyn FnMut(Band) -> io::Result<()>,
) -> Result<Outcome, RenderError> {
    let Watch { batch, observer, .. } = watch;
    // A device that holds the whole film goes on in bands where one that does not began.
    let goes_on_in_bands = batch.resume.is_some_and(|state| state.rows != batch.request.rows);
    let in_bands = goes_on_in_bands || !renderer.holds_whole_film();
    let report = match checkpoint {
        None => renderer.render_into(batch, observer, &mut WatchedSink::new(&mut on_band, watch))?,
        Some(checkpoint) => {
            let mut kept = WholeBatch { checkpoint, on_band, in_bands };
            renderer.render_into(batch, observer, &mut WatchedSink::new(&mut kept, watch))?
        }
    };
    let stop = stop_of(&report).unwrap_or(Stop::Samples);
    Ok(Outcome { report, stop, error: None, interval: None })
}
