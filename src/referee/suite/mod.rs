//! The tests, family by family.

mod blends;
mod cameras;
mod daylight;
mod environments;
mod extensions;
mod layers;
mod lights;
mod links;
mod media;
mod reflection;
mod shadows;
mod shapes;
mod stage;
mod surfaces;
mod textures;
mod transport;

use super::test::Test;

/// Version of the suite: it grows where a test is added or its truth changes.
pub const VERSION: &str = "1.5";

/// The licence under which scenes and truths may be used.
pub const LICENCE: &str = "CC0-1.0";

/// All tests, in the order of reports.
pub fn all_tests() -> Vec<Test> {
    [
        lights::tests(),
        shadows::tests(),
        links::tests(),
        cameras::tests(),
        shapes::tests(),
        textures::tests(),
        surfaces::tests(),
        reflection::tests(),
        blends::tests(),
        environments::tests(),
        transport::tests(),
        daylight::tests(),
        media::tests(),
        layers::tests(),
        extensions::tests(),
    ]
    .into_iter()
    .flatten()
    .collect()
}
