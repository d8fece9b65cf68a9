//! What share of the paths of each built-in scene matches.
//!
//! It is a property of the scene: how many of its paths run along edges, and how steep they are. It depends little on the picture's size,
//! on the samples, and on the device, as long as that rounds as IEEE 754 has it.

/// A share that was measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredShare {
    pub matching: u64,
    pub paths: u64,
}

/// Standard deviations by which a share may fall short of the measured one.
const DEVIATIONS: f64 = 3.0;

impl MeasuredShare {
    /// The least share that chance allows among so many paths: both counts are binomial.
    pub fn least_of(&self, paths: u64) -> f64 {
        let (measured, paths) = (self.paths as f64, paths.max(1) as f64);
        // With one path more that does not match, so that a share of 1 has an uncertainty too.
        let differing = (self.paths - self.matching + 1) as f64 / (measured + 1.0);
        let deviation = (differing * (1.0 - differing) * (1.0 / measured + 1.0 / paths)).sqrt();
        (1.0 - differing - DEVIATIONS * deviation).max(0.0)
    }
}

/// By name, as `gpt verify` measures them unless told otherwise. On another device than those measured, others of the paths differ, but
/// not more of them.
const MEASURED: &[(&str, MeasuredShare)] = &[];

/// Of a built-in scene.
pub fn of_builtin(name: &str) -> Option<MeasuredShare> {
    MEASURED.iter().find(|(scene, _)| *scene == name).map(|(_, share)| *share)
}
