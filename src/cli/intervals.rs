//! The intervals of a render, as the command line asks for them and is told of them.

use gpt::choice::Choice;
use gpt::film::Layer;
use gpt::reference::sample_bound::sample_bound;
use gpt::{IntervalBasis, IntervalEstimate, IntervalOptions, Outcome, RenderOptions, Scene, Stop};

use super::arguments::RenderArguments;
use super::exit::Failure;
use super::shares::{percent, whole_percent};
use super::terminal;

const CHANNELS: [&str; 3] = ["red", "green", "blue"];

/// The options with the intervals that are asked for, by `--target-interval` or as layers of the files; the scene then has independent samples.
///
/// # Errors
/// A usage error where intervals do not go with the rest.
pub fn asked_for(
    arguments: &RenderArguments,
    (scene, layers): (&mut Scene, &[Layer]),
    options: &RenderOptions,
) -> Result<RenderOptions, Failure> {
    let asked = &arguments.goal.interval;
    let layers = layers.iter().any(|layer| matches!(layer, Layer::Low | Layer::High));
    if !layers && asked.target_interval.is_none() {
        let given = [
            (asked.confidence.is_some(), "--confidence"),
            (asked.interval_by.is_some(), "--interval-by"),
            (asked.interval_of.is_some(), "--interval-of"),
        ];
        let lonely = given.into_iter().find_map(|(is_given, flag)| is_given.then_some(flag));
        let Some(flag) = lonely else { return Ok(options.clone()) };
        let what = "belongs to --target-interval, or to the layers low and high of --aov";
        return Err(Failure::usage(format!("{flag} {what}")));
    }
    let default = IntervalOptions::default();
    let interval = IntervalOptions {
        target: asked.target_interval,
        confidence: asked.confidence.unwrap_or(default.confidence),
        of: asked.interval_of.unwrap_or(default.of),
        by: asked.interval_by,
        layers,
    };
    interval.apply(&mut scene.render);
    let options = RenderOptions { interval: Some(interval), ..options.clone() };
    options.contradiction(scene).map_or(Ok(options), |message| Err(Failure::usage(message)))
}

/// Says what is known of the picture, and on what that stands.
pub fn tell(arguments: &RenderArguments, scene: &Scene, outcome: &Outcome) {
    let Some(interval) = &outcome.interval else { return };
    if let Some((channel, brightness)) = interval.refuted_by {
        terminal::warn(&format!(
            "a sample of brightness {brightness} in {} was beyond the bound that was derived from the scene, which is a fault of gpt: \
             intervals stand on what was seen instead",
            CHANNELS[channel]
        ));
    }
    let target = arguments.goal.interval.target_interval;
    if let Some(target) = target.filter(|_| outcome.stop != Stop::TargetInterval) {
        terminal::warn(&format!("the intervals did not become as narrow as {}: {}", percent(target), widest(interval)));
    }
    if arguments.quiet {
        return;
    }
    terminal::note(&of_picture(interval));
    if target.is_some() && outcome.stop == Stop::TargetInterval {
        terminal::note(&widest(interval));
    }
    if interval.by == IntervalBasis::Seen && interval.refuted_by.is_none() {
        let why = match (arguments.goal.interval.interval_by, sample_bound(scene)) {
            (None, Err(why)) => format!("samples have no bound, because {why}"),
            _ => "as --interval-by says".to_owned(),
        };
        terminal::note(&format!(
            "upper ends of intervals stand on what was seen ({why}): light that is brighter than twice all of that is not in them"
        ));
    }
}

/// The interval of the picture's mean.
fn of_picture(interval: &IntervalEstimate) -> String {
    let ends = |channel: usize| format!("{:.5} to {:.5}", interval.picture_low[channel], interval.picture_high[channel]);
    let bound = match interval.sample_bound {
        Some(bound) => format!(", samples being at most {:.4}", bound.into_iter().fold(0.0, f64::max)),
        None => String::new(),
    };
    format!("mean of the picture: {}, {}, {} ({}{bound})", ends(0), ends(1), ends(2), whole_percent(interval.confidence))
}

fn widest(interval: &IntervalEstimate) -> String {
    let narrow = percent(interval.narrow_enough);
    format!("{}: the widest interval is within {} ({narrow} are narrow enough)", interval.of.name(), percent(interval.widest))
}
