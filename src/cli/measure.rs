//! `gpt measure`.

use std::fmt::Write;

use clap::Args;
use gpt::load::SceneSource;
use gpt::plan::PlanOptions;
use gpt::render::measure::{MOST_SAMPLES, Measurement, Reading, chosen, measure};
use gpt::renderer::DeviceChoice;
use gpt::{IntervalBasis, IntervalOptions, RenderOptions};
use serde::Serialize;

use super::access_arguments::AccessArguments;
use super::choice::by_name;
use super::exit::{Exit, Failure};
use super::progress::Progress;
use super::values::{parse_confidence, parse_device, parse_share};
use super::{interrupt, reading, terminal};

#[derive(Debug, Args)]
pub struct MeasureArguments {
    /// A scene with meters: a .toml or Mitsuba's .xml file
    pub scene: std::ffi::OsString,
    #[command(flatten)]
    pub access: AccessArguments,
    /// Read this meter alone; may be given several times
    #[arg(long, value_name = "NAME")]
    pub meter: Vec<String>,
    /// Read until half the width of each interval is at most this share of its value [default: 1%]
    #[arg(long, value_name = "SHARE", value_parser = parse_share)]
    pub target_interval: Option<f64>,
    /// The probability that a meter's intervals hold, at all looks together [default: 99%]
    #[arg(long, value_name = "SHARE", value_parser = parse_confidence)]
    pub confidence: Option<f64>,
    /// The assumption on which upper ends of intervals stand [default: bound, where the scene has one]
    #[arg(long, value_name = "BASIS", value_parser = by_name::<IntervalBasis>())]
    pub interval_by: Option<IntervalBasis>,
    /// Samples of each of a meter's 256 pixels, at most [default: 65536]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(16..=1 << 24))]
    pub spp: Option<u32>,
    /// Key of every random number
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// auto, gpu, cpu, or part of an adapter's name
    #[arg(long, value_name = "DEVICE", default_value = "auto", value_parser = parse_device)]
    pub device: DeviceChoice,
    /// Print JSON
    #[arg(long, conflicts_with = "csv")]
    pub json: bool,
    /// Print a table of comma-separated values
    #[arg(long)]
    pub csv: bool,
    /// Refuse files of which parts have no effect
    #[arg(long)]
    pub strict: bool,
    /// Print results alone
    #[arg(short, long)]
    pub quiet: bool,
}

#[derive(Serialize)]
struct Report<'a> {
    scene: &'a str,
    version: &'static str,
    meters: &'a [Measurement],
}

/// Reads the meters of a scene.
pub fn run(arguments: &MeasureArguments) -> Result<Exit, Failure> {
    interrupt::install()?;
    let source = SceneSource::parse(Some(&arguments.scene))?;
    let options = arguments.access.options(arguments.strict);
    let scene = reading::shown(arguments.quiet, &options.progress, || source.load(&options))?;
    scene.warnings.iter().for_each(|warning| terminal::warn(warning));
    let meters = chosen(&scene, &arguments.meter).map_err(Failure::usage)?;
    let default = IntervalOptions::default();
    let interval = IntervalOptions {
        target: Some(arguments.target_interval.unwrap_or(0.01)),
        confidence: arguments.confidence.unwrap_or(default.confidence),
        by: arguments.interval_by,
        ..default
    };
    let options = RenderOptions {
        device: arguments.device.clone(),
        samples: Some(arguments.spp.unwrap_or(MOST_SAMPLES)),
        seed: arguments.seed,
        interval: Some(interval),
        plan: PlanOptions::default(),
        ..RenderOptions::default()
    };
    let mut measured = Vec::new();
    for meter in meters {
        let progress = Progress::of_frame(arguments.quiet, None, None);
        let found = measure(&scene, meter, &options, &progress);
        progress.clear();
        let found = found?;
        let is_interrupted = found.interrupted;
        measured.push(found);
        if is_interrupted {
            break;
        }
    }
    let interrupted = measured.last().is_some_and(|last| last.interrupted);
    if arguments.json {
        terminal::answer_json(&Report { scene: &scene.name, version: env!("CARGO_PKG_VERSION"), meters: &measured })?;
    } else if arguments.csv {
        terminal::answer(&csv(&measured))?;
    } else {
        terminal::answer(&text(&measured))?;
    }
    for meter in measured.iter().filter(|meter| !meter.interval.reaches(interval.target)) {
        let percent = 100.0 * meter.interval.widest;
        terminal::warn(&format!(
            "{}: the interval did not become as narrow as was asked for; it is within {percent:.3} %",
            meter.name
        ));
    }
    Ok(if interrupted { Exit::Interrupted } else { Exit::Done })
}

fn text(measured: &[Measurement]) -> String {
    let mut text = String::new();
    for Measurement { name, kind, unit, channels, photometric, photometric_unit, interval, .. } in measured {
        let shown = |Reading { value, low, high }: &Reading| format!("{value:.5} ({low:.5} to {high:.5})");
        let [red, green, blue] = [0, 1, 2].map(|channel| shown(&channels[channel]));
        let stands_on = match interval.by {
            IntervalBasis::Bound => "samples have a bound",
            IntervalBasis::Seen => "by what was seen",
        };
        let confidence = super::shares::whole_percent(interval.confidence);
        let _ = writeln!(
            text,
            "{name} ({kind}, {confidence} confidence, {stands_on}, {} samples of each of 256 cells)",
            interval.samples
        );
        for (color, value) in [("red", red), ("green", green), ("blue", blue)] {
            let _ = writeln!(text, "  {color:<6} {value} {unit}");
        }
        let _ = writeln!(text, "  in all {} {photometric_unit}", shown(photometric));
    }
    text
}

fn csv(measured: &[Measurement]) -> String {
    let mut text = "meter,type,unit,red,red_low,red_high,green,green_low,green_high,blue,blue_low,blue_high,\
                    photometric_unit,photometric,photometric_low,photometric_high,confidence,by,samples\n"
        .to_owned();
    for Measurement { name, kind, unit, channels, photometric, photometric_unit, interval, .. } in measured {
        let numbers = |reading: &Reading| format!("{},{},{}", reading.value, reading.low, reading.high);
        let channels = channels.iter().map(numbers).collect::<Vec<_>>().join(",");
        let name = format!("\"{}\"", name.replace('"', "\"\""));
        let by = gpt::choice::Choice::name(interval.by);
        let last = format!("{photometric_unit},{},{},{by},{}", numbers(photometric), interval.confidence, interval.samples);
        let _ = writeln!(text, "{name},{kind},{unit},{channels},{last}");
    }
    text
}
