//! `gpt merge`.

use std::path::PathBuf;

use gpt::denoise::library::Library;
use gpt::merge::{MergeError, Merged, PartHeader, merge};
use gpt::output::{PictureFormat, PictureSpec};
use gpt::renderer::RenderError;
use serde::Serialize;

use super::arguments::MergeArguments;
use super::exit::{Exit, Failure};
use super::pictures::{Pictures, output_formats};
use super::render_summary::{FEW_PATHS_DECIDE, in_words};
use super::{denoise, terminal};

/// The report of a merge for other programs. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Report {
    parts: usize,
    width: u32,
    height: u32,
    /// Absolute indices of the first sample and the one after the last.
    first_sample: u32,
    end_sample: u32,
    /// The missing samples or regions, in words.
    missing: Option<String>,
    /// Relative mean squared error: the estimate by what parts differ by, and with a margin for chance.
    expected_error: Option<f64>,
    error_bound: Option<f64>,
    /// Few bright paths, or few pixels, make most of it: it is rough, and mostly too low.
    tails_decide: Option<bool>,
    target_error: Option<f64>,
    /// How many more parts as long as the longest it would take to reach the target.
    parts_to_target: Option<u64>,
    outputs: Vec<String>,
}

/// Joins parts to a picture.
pub fn run(arguments: &MergeArguments) -> Result<Exit, Failure> {
    let beside = denoise::files_beside(arguments.denoise, &arguments.outputs);
    let parts = arguments.parts.iter().map(PathBuf::as_path);
    let outputs = output_formats(&arguments.outputs, beside.iter().map(PathBuf::as_path), parts)?;
    if arguments.denoise {
        denoise::raw_output(&outputs)?;
        // Its absence is reported before anything is read.
        Library::open()?;
    }
    let parts = arguments.parts.iter().map(|path| PartHeader::read(path)).collect::<Result<Vec<_>, _>>()?;
    let count = parts.len();
    let merged = merge(parts, arguments.spp, arguments.partial)?;
    let [width, height] = merged.size;
    let has_file_of_layers = outputs.iter().any(|(_, format)| *format == PictureFormat::Exr);
    let layers = if has_file_of_layers { merged.layer_channels().map_err(RenderError::Output)? } else { Vec::new() };
    let spec = PictureSpec {
        width,
        height,
        layers,
        layer_names: merged.layers.clone(),
        notes: merged.notes.clone(),
        provenance: Some(merged.provenance.clone()),
        ..PictureSpec::default()
    };
    let mut pictures = Pictures::create(&outputs, &spec)?;
    for band in merged.bands() {
        if pictures.write_band(band).is_err() {
            break;
        }
    }
    let summary = pictures.finish(false);
    let report = report(arguments, count, &merged, summary.places.iter().map(|path| path.display().to_string()).collect());
    if arguments.json {
        terminal::answer_json(&report)?;
    } else {
        tell(&report, &merged);
    }
    if !summary.failures.is_empty() {
        return Err(Failure::Outputs(summary.failures));
    }
    if arguments.denoise {
        denoise::denoise_render(&Library::open()?, &outputs, spec.display, arguments.json)?;
    }
    Ok(Exit::Done)
}

fn report(arguments: &MergeArguments, parts: usize, merged: &Merged, outputs: Vec<String>) -> Report {
    Report {
        parts,
        width: merged.size[0],
        height: merged.size[1],
        first_sample: merged.samples.start,
        end_sample: merged.samples.end,
        missing: merged.missing.as_ref().map(ToString::to_string),
        expected_error: merged.error.map(|error| error.mean),
        error_bound: merged.error.map(|error| error.upper),
        tails_decide: merged.error.map(|error| error.tails_decide()),
        target_error: arguments.target_error,
        parts_to_target: arguments.target_error.and_then(|target| merged.parts_to_reach(target)),
        outputs,
    }
}

fn tell(report: &Report, merged: &Merged) {
    let Report { parts, width, height, first_sample, end_sample, .. } = report;
    let samples = end_sample - first_sample;
    let files = report.outputs.join(", ");
    terminal::note(&format!("{files}: {width}x{height}, {samples} spp of {parts} parts"));
    if let Some(missing) = &report.missing {
        terminal::warn(&format!("the picture is not whole: {missing}"));
    }
    if let Some(error) = merged.error {
        terminal::note(&format!("relative mean squared error: {}", in_words(error)));
        if error.tails_decide() {
            terminal::warn(FEW_PATHS_DECIDE);
        }
    }
    match (report.target_error, report.parts_to_target) {
        (Some(target), Some(0)) => terminal::note(&format!("the error of {target} is reached")),
        (Some(target), Some(more)) => terminal::note(&format!(
            "an error of {target} would take about {more} more parts of {} samples per pixel",
            merged.longest
        )),
        (Some(_), None) => terminal::warn("the error is not known: a pixel needs two parts for that"),
        (None, _) => {}
    }
}

impl From<MergeError> for Failure {
    fn from(error: MergeError) -> Self {
        Self::Merge(error)
    }
}
