//! The results of a schedule of renders: errors with intervals, slopes, floors, and one setting's efficiency
//! against another's.

use serde::Serialize;

use super::interval::{Interval, Ratio, Spread};
use super::reference::Reference;
use super::schedule::{Observation, Observations, SampleSchedule, by_brightness, no_weight};
use crate::compare::Metric;
use crate::compare::z_test;

/// A floor is reported where chance would show one as high in fewer than one measurement of so many.
const FLOOR_LEVEL: f64 = 1e-3;
/// Levels whose error is less than this many times the reference's own say too little to be fitted.
const ABOVE_THE_REFERENCE: f64 = 3.0;
/// The two errors that are reported.
pub const METRICS: [Metric; 2] = [Metric::Mse, Metric::RelMse];

/// One number of samples.
#[derive(Debug, Clone, Serialize)]
pub struct Level {
    pub spp: u32,
    /// The reference's own error is taken off.
    pub mse: Interval,
    pub relmse: Interval,
    /// Time of the render alone.
    pub seconds: Spread,
}

/// How the error falls, and what it falls to.
#[derive(Debug, Clone, Serialize)]
pub struct Trend {
    pub metric: Metric,
    /// Slope of log error over log samples, with a floor taken off: −1 for independent samples. None where
    /// fewer than two levels stand clear of the reference's error.
    pub slope: Option<Interval>,
    /// Levels that the slope was fitted to.
    pub fitted_levels: usize,
    pub floor: Floor,
}

/// The part of the error that no number of samples takes away.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct Floor {
    /// Squared bias; may be negative by chance.
    pub squared_bias: Interval,
    /// Its share of the last level's error.
    pub share_of_last_error: f64,
    /// The setting does not converge to the reference.
    pub flagged: bool,
    /// The reference's own error is unknown, so that a floor may be its.
    pub may_be_the_references: bool,
}

/// Everything about one setting.
#[derive(Debug, Clone, Serialize)]
pub struct Curve {
    pub levels: Vec<Level>,
    pub trends: Vec<Trend>,
    pub non_finite_samples: u64,
}

/// A ratio that holds at a place of the curves.
#[derive(Debug, Clone, Copy, Serialize)]
pub struct RatioAt {
    /// Seconds, or the error.
    pub at: f64,
    #[serde(flatten)]
    pub ratio: Ratio,
}

/// One setting against another; each ratio is that of the setting over that of the baseline, replication by replication.
#[derive(Debug, Clone, Serialize)]
pub struct Comparison {
    pub metric: Metric,
    /// At the last level.
    pub time_at_equal_samples: Ratio,
    /// At the last level.
    pub error_at_equal_samples: Ratio,
    /// The ratio of 1 / (error × time), at the last level.
    pub efficiency: Ratio,
    /// None where the curves share no time.
    pub error_at_equal_time: Option<RatioAt>,
    /// None where the curves share no error.
    pub time_to_equal_error: Option<RatioAt>,
}

/// The error of a picture by a metric, less what is the reference's.
fn corrected(observation: &Observation, metric: Metric, reference: &Reference) -> f64 {
    let own = reference.correction();
    match metric {
        Metric::RelMse => observation.relmse - own.relmse,
        _ => observation.mse - own.mse,
    }
}

/// The reference's own error by a metric, and its standard error.
fn own_error(metric: Metric, reference: &Reference) -> (f64, f64) {
    let own = reference.correction();
    match metric {
        Metric::RelMse => (own.relmse, own.relmse_standard_error),
        _ => (own.mse, own.mse_standard_error),
    }
}

/// Errors, times, slopes and floors of one setting.
pub fn curve(observations: &Observations, reference: &Reference, schedule: &SampleSchedule) -> Curve {
    let levels = schedule.levels.iter().zip(&observations.by_level).map(|(&spp, seen)| {
        let error = |metric: Metric| {
            let values: Vec<f64> = seen.iter().map(|one| corrected(one, metric, reference)).collect();
            Interval::of_mean(&values).shifted(0.0, own_error(metric, reference).1)
        };
        let seconds: Vec<f64> = seen.iter().map(|one| one.seconds).collect();
        Level { spp, mse: error(Metric::Mse), relmse: error(Metric::RelMse), seconds: Spread::of(&seconds) }
    });
    let levels: Vec<Level> = levels.collect();
    let trends = METRICS.map(|metric| trend(observations, reference, schedule, &levels, metric)).to_vec();
    Curve { levels, trends, non_finite_samples: observations.non_finite_samples }
}

impl Level {
    /// The error by a metric.
    pub fn error(&self, metric: Metric) -> Interval {
        if metric == Metric::RelMse { self.relmse } else { self.mse }
    }
}

fn trend(
    observations: &Observations,
    reference: &Reference,
    schedule: &SampleSchedule,
    levels: &[Level],
    metric: Metric,
) -> Trend {
    let floor = floor(observations, reference, levels, metric);
    let below = if floor.flagged { floor.squared_bias.estimate } else { 0.0 };
    let own = own_error(metric, reference).0;
    let clear: Vec<usize> = (0..levels.len())
        .filter(|&level| {
            let error = levels[level].error(metric).estimate - below;
            // A floor that is most of the error leaves too little to be fitted as well.
            error > ABOVE_THE_REFERENCE * own && error > 0.25 * below
        })
        .collect();
    let slopes: Vec<f64> = (0..observations.replications())
        .filter_map(|replication| {
            let points: Vec<(f64, f64)> = clear
                .iter()
                .map(|&level| {
                    let error = corrected(&observations.by_level[level][replication], metric, reference) - below;
                    (f64::from(schedule.levels[level]).ln(), error.ln())
                })
                .collect();
            least_squares_slope(&points)
        })
        .collect();
    let slope = (slopes.len() > 1).then(|| Interval::of_mean(&slopes));
    Trend { metric, slope, fitted_levels: clear.len(), floor }
}

/// Tests whether the last level's pictures scatter around the reference or around something else.
fn floor(observations: &Observations, reference: &Reference, levels: &[Level], metric: Metric) -> Floor {
    let (excess, standard_error) = match metric {
        Metric::RelMse => observations.squared_bias(reference, by_brightness),
        _ => observations.squared_bias(reference, no_weight),
    };
    let (own, own_standard_error) = own_error(metric, reference);
    let bias = excess - own;
    let standard_error = standard_error.hypot(own_standard_error);
    let half = 1.96 * standard_error;
    let last = levels.last().map_or(f64::NAN, |level| level.error(metric).estimate);
    Floor {
        squared_bias: Interval { estimate: bias, low: bias - half, high: bias + half, confidence: super::interval::CONFIDENCE },
        share_of_last_error: bias / last,
        flagged: bias > 0.0 && z_test(bias, standard_error).p_value < 2.0 * FLOOR_LEVEL,
        may_be_the_references: reference.own_error.is_none(),
    }
}

/// The slope of the line through the points that has least squared residuals; None of fewer than two, and of numbers that are none.
fn least_squares_slope(points: &[(f64, f64)]) -> Option<f64> {
    let count = points.len() as f64;
    let [x_mean, y_mean] = [points.iter().map(|p| p.0).sum::<f64>() / count, points.iter().map(|p| p.1).sum::<f64>() / count];
    let (covariance, variance) = points.iter().fold((0.0, 0.0), |(covariance, variance), (x, y)| {
        (covariance + (x - x_mean) * (y - y_mean), variance + (x - x_mean) * (x - x_mean))
    });
    let slope = covariance / variance;
    (points.len() > 1 && slope.is_finite()).then_some(slope)
}

/// The efficiency of `setting` relative to `baseline`.
pub fn compare_settings(setting: &Observations, baseline: &Observations, reference: &Reference, metric: Metric) -> Comparison {
    let replications = setting.replications().min(baseline.replications());
    let last = setting.by_level.len().saturating_sub(1);
    let at_last = |of: &dyn Fn(&Observation) -> f64| {
        let pair = |replication: usize| (of(&setting.by_level[last][replication]), of(&baseline.by_level[last][replication]));
        Ratio::of_pairs((0..replications).map(pair))
    };
    let error = |one: &Observation| corrected(one, metric, reference);
    let points = |observations: &Observations, replication: usize| -> Vec<(f64, f64)> {
        observations.by_level.iter().map(|level| (level[replication].seconds, error(&level[replication]))).collect()
    };
    let swapped = |points: Vec<(f64, f64)>| points.into_iter().map(|(x, y)| (y, x)).collect::<Vec<_>>();
    let time_curves = |replication| [points(setting, replication), points(baseline, replication)];
    let error_curves = |replication| time_curves(replication).map(swapped);
    let most_time =
        [setting, baseline].map(|one| Spread::of(&one.by_level[last].iter().map(|o| o.seconds).collect::<Vec<_>>()).median);
    let least_error = [setting, baseline].map(|one| Spread::of(&one.by_level[last].iter().map(error).collect::<Vec<_>>()).median);
    Comparison {
        metric,
        time_at_equal_samples: at_last(&|one| one.seconds),
        error_at_equal_samples: at_last(&error),
        efficiency: at_last(&|one| 1.0 / (error(one) * one.seconds)),
        error_at_equal_time: ratio_at(most_time[0].min(most_time[1]), replications, time_curves),
        time_to_equal_error: ratio_at(least_error[0].max(least_error[1]), replications, error_curves),
    }
}

/// The ratio of two curves at the same place, replication by replication; None where not every replication reaches it.
fn ratio_at(at: f64, replications: usize, curves: impl Fn(usize) -> [Vec<(f64, f64)>; 2]) -> Option<RatioAt> {
    let pairs: Option<Vec<(f64, f64)>> = (0..replications)
        .map(|replication| {
            let [over, under] = curves(replication);
            Some((interpolate(&over, at)?, interpolate(&under, at)?))
        })
        .collect();
    pairs.filter(|pairs| !pairs.is_empty()).map(|pairs| RatioAt { at, ratio: Ratio::of_pairs(pairs) })
}

/// How far beyond its ends a curve is believed, as a factor: single runs scatter around the median that chose the place.
const BEYOND: f64 = 2.0;

/// The value at `x` of the curve through the points, straight between them on logarithmic axes.
pub fn interpolate(points: &[(f64, f64)], x: f64) -> Option<f64> {
    let mut logs: Vec<(f64, f64)> = points.iter().filter(|(x, y)| *x > 0.0 && *y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    logs.sort_by(|a, b| a.0.total_cmp(&b.0));
    logs.dedup_by(|a, b| a.0 == b.0);
    let x = x.ln();
    let (first, last) = (logs.first()?, logs.last()?);
    if x.is_nan() || x < first.0 - BEYOND.ln() || x > last.0 + BEYOND.ln() {
        return None;
    }
    if logs.len() == 1 {
        return Some(first.1.exp());
    }
    let right = logs.iter().position(|point| point.0 >= x).unwrap_or(logs.len() - 1).clamp(1, logs.len() - 1);
    let ((x0, y0), (x1, y1)) = (logs[right - 1], logs[right]);
    Some((y0 + (y1 - y0) * (x - x0) / (x1 - x0)).exp())
}

#[cfg(test)]
mod tests;
