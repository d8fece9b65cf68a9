//! `gpt compare`.

use std::fmt::Write;

use gpt::choice::Choice;
use gpt::compare::{Comparison, Metric, compare};
use gpt::output::{PictureKind, read_image};
use serde::Serialize;

use super::arguments::CompareArguments;
use super::exit::{Exit, Failure};
use super::terminal;

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// What `--json` prints.
#[derive(Serialize)]
struct Verdict<'a> {
    equal: bool,
    tolerance: f64,
    metric: Option<Metric>,
    warnings: &'a [String],
    #[serde(flatten)]
    comparison: &'a Comparison,
}

/// Compares two pictures and prints the verdict.
pub fn run(arguments: &CompareArguments) -> Result<Exit, Failure> {
    let tolerance = tolerance(arguments)?;
    let picture = read_image(&arguments.picture)?;
    let reference = read_image(&arguments.reference)?;
    let comparison = compare(&picture, &reference)?;
    let warnings: Vec<String> = different_kinds(arguments).into_iter().collect();
    warnings.iter().for_each(|warning| terminal::warn(warning));
    let equal = comparison.within(arguments.metric, tolerance);
    if arguments.json {
        terminal::answer_json(&Verdict {
            equal,
            tolerance,
            metric: arguments.metric,
            warnings: &warnings,
            comparison: &comparison,
        })?;
    } else {
        terminal::answer(&text(&comparison, arguments.metric, equal))?;
    }
    Ok(if equal { Exit::Done } else { Exit::Difference })
}

/// What to know of a comparison of a render with a preview.
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
