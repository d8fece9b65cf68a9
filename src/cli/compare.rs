//! `gpt compare`.

use std::fmt::Write;
use std::path::Path;

use gpt::choice::Choice;
use gpt::compare::flip::{PIXELS_PER_DEGREE, flip};
use gpt::compare::intervals::{LargestSure, StatedIntervals, SureDifference, sure_difference};
use gpt::compare::{Comparison, ImageView, Metric, TileSettings, compare, compare_paired};
use gpt::output::{
    AtomicFile, CONFIDENCE_KEY, Channels, HIGH, Image, LOW, PICTURE_HIGH_KEY, PICTURE_LOW_KEY, PictureKind, read_picture,
};
use serde::Serialize;

use super::arguments::CompareArguments;
use super::bench::command;
use super::denoise::{BIAS_KEY, DENOISER_KEY};
use super::difference_page::{self, PicturePair, Section, Tone};
use super::exit::{Exit, Failure};
use super::{outputs, shares, terminal};

/// Pixels along the side of the page's tiles.
const PAGE_TILE: u32 = 8;

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The JSON that `--json` prints.
#[derive(Serialize)]
struct ComparisonReport<'a> {
    equal: bool,
    tolerance: f64,
    metric: Option<Metric>,
    warnings: &'a [String],
    /// By how much they differ at least, where a picture states intervals.
    intervals: Option<&'a SureDifference>,
    #[serde(flatten)]
    comparison: &'a Comparison,
}

/// Compares two pictures and prints the verdict.
pub fn run(arguments: &CompareArguments) -> Result<Exit, Failure> {
    let tolerance = tolerance(arguments)?;
    outputs::check(arguments.html.as_deref(), [arguments.picture.as_path(), arguments.reference.as_path()])?;
    let [picture, reference] = [&arguments.picture, &arguments.reference].map(|path| read_picture(path));
    let (picture, reference) = (picture?, reference?);
    let mut warnings = picture.warnings(&arguments.picture);
    warnings.extend(reference.warnings(&arguments.reference));
    let (picture, reference) = (picture.image, reference.image);
    let comparison = compare(&picture, &reference)?;
    warnings.extend(different_kinds(arguments));
    warnings.iter().for_each(|warning| terminal::warn(warning));
    [&arguments.picture, &arguments.reference].into_iter().for_each(|path| tell_of_denoising(path));
    let equal = comparison.within(arguments.metric, tolerance);
    let sure = by_intervals(arguments, (&picture, &reference));
    if let Some(path) = &arguments.html {
        AtomicFile::write(path, page(arguments, (&picture, &reference), &comparison, equal)?.as_bytes())?;
    }
    if arguments.json {
        terminal::answer_json(&ComparisonReport {
            equal,
            tolerance,
            metric: arguments.metric,
            warnings: &warnings,
            intervals: sure.as_ref(),
            comparison: &comparison,
        })?;
    } else {
        let told = sure.as_ref().map_or_else(String::new, in_words);
        terminal::answer(&(told + &text(&comparison, arguments.metric, equal)))?;
    }
    Ok(if equal { Exit::Done } else { Exit::Difference })
}

/// By how much the pictures differ at least, where one of them states intervals; one that states none is taken as the truth.
fn by_intervals(arguments: &CompareArguments, (picture, reference): (&Image, &Image)) -> Option<SureDifference> {
    let [first, second] = [(&arguments.picture, picture), (&arguments.reference, reference)].map(|(path, image)| {
        let file = Channels::read(path).ok()?;
        let confidence = file.attribute(CONFIDENCE_KEY)?.parse().ok()?;
        let mean = [ends_of_header(&file, PICTURE_LOW_KEY)?, ends_of_header(&file, PICTURE_HIGH_KEY)?];
        let pixels = file.colours(LOW).zip(file.colours(HIGH)).filter(|(low, _)| low.len() == image.pixels.len());
        Some(StatedIntervals { mean, pixels: pixels.map(|(low, high)| [low, high]), confidence })
    });
    if first.is_none() && second.is_none() {
        return None;
    }
    let [first, second] = [(first, picture), (second, reference)]
        .map(|(intervals, image)| intervals.unwrap_or_else(|| StatedIntervals::exact(&image.pixels)));
    Some(sure_difference(picture.width, &first, &second))
}

/// Three numbers of a header, with blanks between them.
fn ends_of_header(file: &Channels, key: &str) -> Option<[f64; 3]> {
    let numbers: Vec<f64> = file.attribute(key)?.split(' ').map(|number| number.parse().ok()).collect::<Option<_>>()?;
    numbers.try_into().ok()
}

fn in_words(sure: &SureDifference) -> String {
    let confidence = shares::whole_percent(sure.confidence);
    let of_means = if sure.relative > 0.0 {
        let [red, green, blue] = sure.means.map(f64::abs);
        let share =
            if sure.relative.is_finite() { format!(", {:.3} % where it is most", 100.0 * sure.relative) } else { String::new() };
        format!("the means differ by at least {red:.6e}, {green:.6e}, {blue:.6e}{share} ({confidence} confidence)\n")
    } else {
        format!("by their intervals, the means may be equal ({confidence} confidence)\n")
    };
    let of_pixels = match (sure.pixels, sure.largest) {
        (Some(pixels), Some(LargestSure { x, y, channel, at_least })) => {
            let (most, color) = (at_least.abs(), CHANNELS[channel]);
            format!(
                "{pixels} pixels differ for sure, by at least {most:.6e} in {color} at column {x}, row {y} ({confidence} confidence)\n"
            )
        }
        (Some(_), None) => format!("no pixel differs for sure ({confidence} confidence)\n"),
        (None, _) => String::new(),
    };
    of_means + &of_pixels
}

/// The page that shows both, with the differences of tiles judged by what their pixels' differences scatter by.
fn page(
    arguments: &CompareArguments,
    (picture, reference): (&Image, &Image),
    comparison: &Comparison,
    equal: bool,
) -> Result<String, Failure> {
    let pictures = [reference, picture].map(|image| ImageView { width: image.width, pixels: &image.pixels });
    let settings = TileSettings { tile: PAGE_TILE, ..TileSettings::default() };
    let tiles = compare_paired(pictures[0], pictures[1], &settings).map_err(|error| Failure::BadScene(error.to_string()))?;
    let map = flip(picture, reference, PIXELS_PER_DEGREE)?;
    let metrics = Metric::VALUES.iter().map(|metric| format!("{} {:.6e}", metric.name(), comparison.value(*metric).all));
    let section = Section {
        title: format!("{} and {}", arguments.picture.display(), arguments.reference.display()),
        verdict: if equal { "equal" } else { "different" }.to_owned(),
        tone: Tone::of(!equal),
        facts: metrics.chain([format!("ꟻLIP {:.5}", map.mean())]).collect(),
        findings: tiles.rejected().map(|finding| (finding.region, finding.to_string())).collect(),
        commands: vec![command()],
        shown: Some(PicturePair { labels: ["reference", "picture"], images: [reference, picture], tiles: &tiles, flip: &map }),
    };
    let method = "Tiles are judged by Student's t on the differences of their pixels, with a false alarm in a hundred pages.";
    Ok(difference_page::page("gpt compare", &command(), method, &[section]))
}

/// Says of a picture that was denoised by what, and what that did to it.
fn tell_of_denoising(path: &Path) {
    let Ok(file) = Channels::read(path) else { return };
    if let Some(denoiser) = file.attribute(DENOISER_KEY) {
        let bias = file.attribute(BIAS_KEY).unwrap_or("its bias is not known");
        terminal::note(&format!("{} was denoised by {denoiser}: {bias}", path.display()));
    }
}

/// A note on comparing a render with a preview.
fn different_kinds(arguments: &CompareArguments) -> Option<String> {
    let (a, b) = (&arguments.picture, &arguments.reference);
    let (linear, preview) = match (PictureKind::of(a)?, PictureKind::of(b)?) {
        (PictureKind::Linear, PictureKind::Encoded) => (a, b),
        (PictureKind::Encoded, PictureKind::Linear) => (b, a),
        _ => return None,
    };
    Some(format!(
        "{} holds linear light, and {} holds 8-bit or 16-bit sRGB colours, which end at 1 and may be brightened by --exposure: they differ even \
         where they show the same; compare two EXR files",
        linear.display(),
        preview.display()
    ))
}

/// Without `--tolerance` only pictures without any difference are equal, whatever the metric.
fn tolerance(arguments: &CompareArguments) -> Result<f64, Failure> {
    match (arguments.metric, arguments.tolerance) {
        (Some(Metric::Psnr), None) => Ok(f64::INFINITY),
        (_, None) => Ok(0.0),
        (Some(Metric::Psnr), Some(tolerance)) => Ok(tolerance),
        (_, Some(tolerance)) if tolerance < 0.0 => Err(Failure::usage("--tolerance must not be negative")),
        (_, Some(tolerance)) => Ok(tolerance),
    }
}

fn text(comparison: &Comparison, metric: Option<Metric>, equal: bool) -> String {
    let mut text = String::new();
    let mut row = |label: &str, channels: [f64; 3], all: Option<f64>| {
        let _ = write!(text, "{label:<12}");
        for value in channels.into_iter().chain(all) {
            let _ = write!(text, " {value:>13.6e}");
        }
        text.push('\n');
    };
    let shown = Metric::VALUES.iter().filter(|each| metric.is_none_or(|wanted| wanted == **each));
    if metric.is_none() {
        row("mean of A", comparison.means[0], None);
        row("mean of B", comparison.means[1], None);
    }
    for each in shown {
        let value = comparison.value(*each);
        row(each.name(), value.channels, Some(value.all));
    }
    let largest = comparison.largest;
    let header = format!("{:<12} {:>13} {:>13} {:>13} {:>13}\n", "", "red", "green", "blue", "all");
    let mut text = header + &text;
    if largest.difference > 0.0 {
        let channel = CHANNELS[largest.channel];
        let _ = writeln!(
            text,
            "largest difference {:.6e} in {channel} at column {}, row {}",
            largest.difference, largest.x, largest.y
        );
    }
    let pixels = u64::from(comparison.width) * u64::from(comparison.height);
    let _ = writeln!(text, "{} of {pixels} pixels differ", comparison.different_pixels);
    let [a, b] = comparison.non_finite_pixels;
    if a + b > 0 {
        let _ = writeln!(text, "pixels that are not finite, left out above: {a} in A, {b} in B");
    }
    let _ = writeln!(text, "{}", if equal { "equal" } else { "different" });
    text
}
