//! Formats of other programs, by the endings of files.

use std::path::Path;

use super::gltf::as_gltf;
use super::mitsuba::as_mitsuba;
use super::pbrt::as_pbrt;
use super::written::WrittenScene;
use crate::load::SceneError;
use crate::scene::Scene;

/// A format of another program that scenes are written in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ExportFormat {
    /// XML of Mitsuba 3.
    Mitsuba,
    /// The text of pbrt-v4.
    Pbrt,
    /// glTF 2.0, as JSON or binary.
    Gltf,
}

impl ExportFormat {
    /// Endings, each with its format.
    pub const ENDINGS: [(&'static str, Self); 4] =
        [("xml", Self::Mitsuba), ("pbrt", Self::Pbrt), ("glb", Self::Gltf), ("gltf", Self::Gltf)];

    /// The format that the ending of a file stands for.
    pub fn of(path: &Path) -> Option<Self> {
        let ending = path.extension()?;
        Self::ENDINGS.into_iter().find(|(known, _)| ending.eq_ignore_ascii_case(known)).map(|(_, format)| format)
    }

    /// The scene in this format, as it is to be written to `target`. `name` is how reports call it.
    ///
    /// # Errors
    /// The errors of [`as_mitsuba`].
    pub fn write(self, scene: &Scene, name: &str, target: &Path) -> Result<WrittenScene, SceneError> {
        match self {
            Self::Mitsuba => as_mitsuba(scene, name, target),
            Self::Pbrt => Ok(as_pbrt(scene, name, target)),
            Self::Gltf => Ok(as_gltf(scene, name, target)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_stand_for_formats() {
        let of = |name: &str| ExportFormat::of(Path::new(name));
        assert_eq!([of("a.XML"), of("b/c.pbrt")], [Some(ExportFormat::Mitsuba), Some(ExportFormat::Pbrt)]);
        assert_eq!([of("a.glb"), of("a.gltf")], [Some(ExportFormat::Gltf); 2]);
        assert_eq!([of("a.toml"), of("glb"), of("a.glb.png")], [None; 3]);
    }
}
