//! The messages at the end of a render.

use std::path::Path;

use gpt::output::AtomicFile;
use gpt::render::stats::Stats;
use gpt::{ErrorEstimate, Scene, Stop};
use serde::Serialize;

use super::arguments::RenderArguments;
use super::exit::Failure;
use super::pictures::{PictureSummary, is_stdout};
use super::terminal;

/// Says how good the picture is where that was asked for, and what the answer is worth.
pub fn tell_of_error(arguments: &RenderArguments, scene: &Scene, error: Option<ErrorEstimate>, stop: Stop) {
    let (Some(target), Some(error)) = (arguments.goal.target_error, error) else { return };
    if stop != Stop::TargetError {
        terminal::warn(&format!("the relative mean squared error of {target} was not reached: {}", in_words(error)));
    } else if !arguments.quiet {
        terminal::note(&format!("relative mean squared error: {}", in_words(error)));
    }
    if error.tails_decide() {
        terminal::warn(FEW_PATHS_DECIDE);
    } else if scene.has_light_by_chance() {
        terminal::warn(LIGHT_BY_CHANCE);
    }
}

/// The estimate with its margin.
pub fn in_words(ErrorEstimate { mean, upper, .. }: ErrorEstimate) -> String {
    format!("{mean:.3e} by what was sampled, below {upper:.3e} with a margin for chance (95 %)")
}

/// The warning where the samples show that an estimate is worth little.
pub const FEW_PATHS_DECIDE: &str =
    "few bright paths, or few pixels, make most of the estimated error: it is rough, and mostly too low; more samples tell more";
/// The warning where the scene shows it.
const LIGHT_BY_CHANCE: &str = "lamps shine through glass or by mirrors in this scene, which paths find by chance: light that none has found is not in the \
    estimate, and the error may be far larger";

/// Writes statistics to a file, or to standard output.
///
/// # Errors
/// A file that cannot be written.
pub fn write_stats(path: &Path, stats: &impl Serialize) -> Result<(), Failure> {
    if is_stdout(path) {
        return terminal::answer_json(stats);
    }
    let json = serde_json::to_string_pretty(stats).map_err(|error| Failure::Other(error.to_string()))?;
    Ok(AtomicFile::write(path, (json + "\n").as_bytes())?)
}

/// Prints a summary, and warnings about the result.
pub fn tell(stats: &Stats, summary: &PictureSummary, quiet: bool) {
    if stats.non_finite_samples > 0 {
        terminal::warn(&format!("{} samples were not finite and are left out of the picture", stats.non_finite_samples));
    }
    if let (Some(samples), Some(light), false) = (stats.clamped_samples, stats.clamped_light, quiet) {
        terminal::note(&format!("--clamp darkened {samples} samples, which took {:.3} % of the light", 100.0 * light));
    }
    if summary.black && !stats.interrupted {
        terminal::warn("every pixel is black: does the camera look at the scene, and does light reach what it sees?");
    }
    let broken_off = summary.places.iter().filter(|_| stats.interrupted);
    for place in broken_off.filter(|place| place.file_stem().is_some_and(|stem| stem.to_string_lossy().contains(".incomplete"))) {
        terminal::note(&format!("{} is written beside a finished picture, which stays as it is", place.display()));
    }
    if stats.interrupted && summary.places.is_empty() && summary.failures.is_empty() {
        terminal::note("interrupted before anything was rendered; nothing is saved");
    } else if !quiet && !summary.places.is_empty() {
        terminal::note(&summary_line(stats, summary.samples));
    }
}

/// The number of samples, and how fast they were rendered in the time beside it.
fn summary_line(stats: &Stats, [fewest, most]: [u32; 2]) -> String {
    let done = match stats.adaptive {
        true => stats.spp_done.to_string(),
        false if fewest == most => fewest.to_string(),
        false => format!("{fewest} to {most}"),
    };
    let of_wanted = |why: &str| format!(" of {} {why}", stats.settings.spp);
    format!(
        "{}: {}x{}, {done} spp{} in {:.2} s ({}), {:.2} s in all, on {}",
        stats.outputs.join(", "),
        stats.width,
        stats.height,
        match stats.stopped_by {
            "interrupted" => of_wanted("when it was interrupted"),
            "time_limit" => of_wanted("when time was up"),
            "target_error" => of_wanted("when the error was reached"),
            "target_interval" => of_wanted("when the intervals were narrow enough"),
            _ => String::new(),
        },
        stats.seconds.render,
        terminal::with_unit(stats.samples_per_second, "sample/s"),
        stats.seconds.total,
        stats.device,
    )
}
