//! The change that a test is to find, and how surely.

/// How a change is looked for.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct TestSettings {
    /// The change that is to be found, as a share of a tile's energy.
    pub change: f64,
    /// The probability with which it is.
    pub power: f64,
    /// The probability of finding a difference where there is none.
    pub false_alarms: f64,
    /// Pixels along a tile's side.
    pub tile: u32,
    /// Samples per pixel that a render takes at most.
    pub most_samples: u32,
}

impl Default for TestSettings {
    fn default() -> Self {
        Self { change: 0.01, power: 0.99, false_alarms: 0.01, tile: 8, most_samples: 4096 }
    }
}
