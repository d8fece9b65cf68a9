//! The share of matching paths of each built-in scene.
//!
//! The share is a property of the scene: how many of its paths run along edges, and how steep they are. It
//! depends little on the picture's size, on the samples, and on the device, as long as that rounds by IEEE
//! 754.

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
const MEASURED: &[(&str, MeasuredShare)] = &[
    ("cornell", MeasuredShare { matching: 261_072, paths: 262_144 }),
    ("spheres", MeasuredShare { matching: 147_409, paths: 147_456 }),
    ("veach-mis", MeasuredShare { matching: 176_126, paths: 176_128 }),
    ("teapot-plastic", MeasuredShare { matching: 218_384, paths: 219_136 }),
    ("teapot-ceramic", MeasuredShare { matching: 218_852, paths: 219_136 }),
    ("teapot-iridescent", MeasuredShare { matching: 217_021, paths: 219_136 }),
    ("teapot-toon", MeasuredShare { matching: 219_060, paths: 219_136 }),
    ("knot-plastic", MeasuredShare { matching: 218_529, paths: 219_136 }),
    ("knot-ceramic", MeasuredShare { matching: 218_813, paths: 219_136 }),
    ("knot-iridescent", MeasuredShare { matching: 215_981, paths: 219_136 }),
    ("knot-toon", MeasuredShare { matching: 219_064, paths: 219_136 }),
    ("motion-blur", MeasuredShare { matching: 147_315, paths: 147_456 }),
    ("gallery", MeasuredShare { matching: 163_165, paths: 163_840 }),
    ("stage", MeasuredShare { matching: 147_076, paths: 147_456 }),
    ("loft", MeasuredShare { matching: 187_907, paths: 188_416 }),
    ("terrace", MeasuredShare { matching: 175_468, paths: 176_128 }),
    ("crystal", MeasuredShare { matching: 157_268, paths: 157_696 }),
    ("lanterns", MeasuredShare { matching: 157_628, paths: 157_696 }),
    ("bazaar", MeasuredShare { matching: 188_312, paths: 188_416 }),
    ("arbour", MeasuredShare { matching: 163_624, paths: 163_840 }),
    ("theatre", MeasuredShare { matching: 145_578, paths: 147_456 }),
    ("planetarium", MeasuredShare { matching: 173_967, paths: 176_128 }),
    ("cellar", MeasuredShare { matching: 196_165, paths: 196_608 }),
    ("grove", MeasuredShare { matching: 163_684, paths: 163_840 }),
    ("wardrobe", MeasuredShare { matching: 175_075, paths: 176_128 }),
    ("workshop", MeasuredShare { matching: 167_001, paths: 167_936 }),
    ("paints", MeasuredShare { matching: 110_510, paths: 110_592 }),
    ("vitrine", MeasuredShare { matching: 175_226, paths: 176_128 }),
    ("mist", MeasuredShare { matching: 175_652, paths: 176_128 }),
    ("bonfire", MeasuredShare { matching: 196_465, paths: 196_608 }),
    ("model-town", MeasuredShare { matching: 196_519, paths: 196_608 }),
    ("duet", MeasuredShare { matching: 147_357, paths: 147_456 }),
    ("furnace-lambert", MeasuredShare { matching: 65_536, paths: 65_536 }),
    ("furnace-box", MeasuredShare { matching: 65_451, paths: 65_536 }),
    ("furnace-glass", MeasuredShare { matching: 65_536, paths: 65_536 }),
    ("furnace-mirror", MeasuredShare { matching: 65_536, paths: 65_536 }),
];

/// The share of a built-in scene.
pub fn of_builtin(name: &str) -> Option<MeasuredShare> {
    MEASURED.iter().find(|(scene, _)| *scene == name).map(|(_, share)| *share)
}
