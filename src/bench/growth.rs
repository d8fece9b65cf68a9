//! Scenes of growing size for measurements of speed.

use crate::choice::choices;

choices! {
    /// A series of measurements: one quantity grows, the rest stays.
    pub enum Growth {
        /// Nothing grows: scenes as they are.
        Scenes = "scenes",
        /// 1,000 to 100,000 triangles, with --all to ten million.
        Triangles = "triangles",
        /// 64 to 512 pixels on a side, with --all to 4096.
        Resolution = "resolution",
        /// 1 to 64 samples per pixel, with --all to 1024.
        Samples = "samples",
        /// 1 to 1,000 emitting triangles, with --all to 10,000.
        Lights = "lights",
        /// 1 to 8 leaves of a blend, with --all to 64.
        Leaves = "leaves",
        /// 100 to 10,000 instances of a tree of 10,000 triangles, with --all to a million.
        Trees = "trees",
    }
}

impl Growth {
    /// The heading of the size.
    pub fn label(self) -> &'static str {
        match self {
            Self::Scenes => "scenes",
            Self::Triangles => "triangles",
            Self::Resolution => "pixels",
            Self::Samples => "samples per pixel",
            Self::Lights => "lights",
            Self::Leaves => "leaves of a blend",
            Self::Trees => "instances of a tree",
        }
    }

    /// The sizes that are tried, the larger ones only where everything is asked for.
    pub fn sizes(self, everything: bool) -> Vec<u32> {
        let (bounded, rest): (&[u32], &[u32]) = match self {
            Self::Scenes => (&[], &[]),
            Self::Triangles => (&[1_000, 10_000, 100_000], &[1_000_000, 10_000_000]),
            // The side of a square picture.
            Self::Resolution => (&[64, 128, 256, 512], &[1024, 2048, 4096]),
            Self::Samples => (&[1, 4, 16, 64], &[256, 1024]),
            Self::Lights => (&[1, 10, 100, 1_000], &[10_000]),
            Self::Leaves => (&[1, 2, 4, 8], &[16, 32, 64]),
            Self::Trees => (&[100, 1_000, 10_000], &[100_000, 1_000_000]),
        };
        if everything { [bounded, rest].concat() } else { bounded.to_vec() }
    }
}
