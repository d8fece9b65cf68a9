//! Files that built-in scenes name, which are part of the program.

use std::path::Path;

/// The folder that built-in scenes lie in, as far as paths go: what they name is looked up among [`FILES`], not on disk.
pub(super) const FOLDER: &str = "builtin:";

/// Path within [`FOLDER`] and content of every file that built-in scenes name.
const FILES: [(&str, &[u8]); 10] = [
    ("models/teapot.obj", include_bytes!(concat!(env!("GPT_SCENES"), "/models/teapot.obj"))),
    ("models/knot.obj", include_bytes!(concat!(env!("GPT_SCENES"), "/models/knot.obj"))),
    // scripts/textures makes them.
    ("textures/brushed.png", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/brushed.png"))),
    ("textures/embers.hdr", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/embers.hdr"))),
    ("textures/evening.hdr", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/evening.hdr"))),
    ("textures/hammered.png", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/hammered.png"))),
    ("textures/harbour.png", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/harbour.png"))),
    ("textures/lamps.hdr", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/lamps.hdr"))),
    ("textures/leaf.png", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/leaf.png"))),
    ("textures/worn.png", include_bytes!(concat!(env!("GPT_SCENES"), "/textures/worn.png"))),
];

/// True of files that are part of the program, and not on disk.
pub fn is_builtin(path: &Path) -> bool {
    path.starts_with(FOLDER)
}

/// A file that built-in scenes name.
pub(super) fn embedded(path: &Path) -> Option<&'static [u8]> {
    let within = path.strip_prefix(FOLDER).ok()?;
    FILES.iter().find(|(name, _)| Path::new(name) == within).map(|(_, content)| *content)
}
