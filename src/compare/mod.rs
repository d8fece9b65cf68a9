//! How far two pictures are apart.

mod metrics;

pub use metrics::{Comparison, Extreme, Metric, MetricValue, RELATIVE_EPSILON, SizeMismatch, compare, relative_weight};
