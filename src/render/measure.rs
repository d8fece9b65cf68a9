//! The readings of a scene's meters.

use serde::Serialize;

use super::options::RenderOptions;
use super::stream::Renderer;
use crate::confidence::{IntervalEstimate, IntervalOptions, IntervalScope};
use crate::error::Error;
use crate::renderer::Observer;
use crate::scene::{LUMEN_PER_WATT, Meter, Scene};
use crate::spectrum::Spectrum;

/// Samples of each pixel of a meter's picture, at most, where nobody says how many.
pub const MOST_SAMPLES: u32 = 1 << 16;

/// The meters of these names, or all of them where no name is given.
///
/// # Errors
/// A sentence about a scene without meters, or about a name that none of them has.
pub fn chosen<'s>(scene: &'s Scene, names: &[String]) -> Result<Vec<&'s Meter>, String> {
    if scene.meters.is_empty() {
        return Err(format!("{} has no meter; a [[meter]] of a scene file is one", scene.name));
    }
    if names.is_empty() {
        return Ok(scene.meters.iter().collect());
    }
    let find = |name: &String| {
        let known = || scene.meters.iter().map(|meter| meter.name.as_str()).collect::<Vec<_>>().join(", ");
        let found = scene.meters.iter().find(|meter| meter.name == *name);
        found.ok_or_else(|| format!("meter {name}: there is no such meter; there are {}", known()))
    };
    names.iter().map(find).collect()
}

/// A quantity with its interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Reading {
    pub value: f64,
    pub low: f64,
    pub high: f64,
}

/// The reading of a meter.
#[derive(Debug, Clone, Serialize)]
pub struct Measurement {
    pub name: String,
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// The unit of the three channels.
    pub unit: &'static str,
    /// Red, green and blue.
    pub channels: [Reading; 3],
    /// 683 lm/W times the luminance of the channels, in this unit.
    pub photometric: Reading,
    pub photometric_unit: &'static str,
    /// The intervals that it stands on, of the mean of the meter's picture.
    pub interval: IntervalEstimate,
    pub device: String,
    pub seconds: f64,
    /// The observer stopped it.
    pub interrupted: bool,
}

/// Reads a meter until its interval is as narrow as the options ask for, or their samples are spent.
///
/// # Errors
/// The errors of a render.
pub fn measure(scene: &Scene, meter: &Meter, options: &RenderOptions, observer: &dyn Observer) -> Result<Measurement, Error> {
    let interval = IntervalOptions { of: IntervalScope::Picture, layers: false, ..options.interval.unwrap_or_default() };
    let options = RenderOptions { interval: Some(interval), size: None, crop: None, ..options.clone() };
    let mut renderer = Renderer::new(&scene.seen_by(meter), &options)?;
    let image = renderer.image(observer)?;
    let missing = || Error::Options("a meter needs intervals".to_owned());
    let outcome = image.outcome().ok_or_else(missing)?;
    let interval = outcome.interval.ok_or_else(missing)?;
    let factor = meter.kind.factor();
    let count = image.pixels().len() as f64;
    let mean = |channel: usize| image.pixels().iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / count;
    let [low, high] = [interval.picture_low, interval.picture_high];
    let channels = [0, 1, 2].map(|channel| Reading {
        value: factor * mean(channel),
        low: factor * low[channel],
        high: factor * high[channel],
    });
    // Weights are positive, so ends of the sum are sums of ends: all three channels are within theirs together.
    let luminance = |of: fn(&Reading) -> f64| {
        LUMEN_PER_WATT * Spectrum::from_rgb([0, 1, 2].map(|channel| of(&channels[channel]))).luminance()
    };
    let photometric = Reading {
        value: luminance(|reading| reading.value),
        low: luminance(|reading| reading.low),
        high: luminance(|reading| reading.high),
    };
    Ok(Measurement {
        name: meter.name.clone(),
        kind: meter.kind.name(),
        unit: meter.kind.unit(),
        channels,
        photometric,
        photometric_unit: meter.kind.photometric_unit(),
        interval,
        device: outcome.report.device.clone(),
        seconds: outcome.report.render_seconds,
        interrupted: outcome.report.interrupted,
    })
}
