//! Tests as files in the forms that renderers read.

use std::path::{Path, PathBuf};

use gpt::load::FileLog;
use gpt::referee::{Test, replay};
use gpt::scene::ImportReport;
use gpt::scene_writer;

use super::arguments::SceneForm;
use crate::cli::exit::Failure;

/// Limits of depth from here on change no picture of the suite.
const DEEP: u32 = 64;

/// A scene on disk.
pub struct WrittenForm {
    pub path: PathBuf,
    /// Parts of the test that this form cannot say, each a sentence; then a renderer that reads it cannot be judged.
    pub left_out: Vec<String>,
}

impl SceneForm {
    pub const ALL: [Self; 4] = [Self::Toml, Self::Mitsuba, Self::Gltf, Self::Pbrt];

    pub fn file_name(self) -> &'static str {
        match self {
            Self::Toml => "scene.toml",
            Self::Mitsuba => "scene.xml",
            Self::Gltf => "scene.glb",
            Self::Pbrt => "scene.pbrt",
        }
    }

    /// Losses that are none to a test: in glTF the back of a one-sided light is not there, so that it gives off nothing, as it should.
    fn is_harmless(self, what: &str) -> bool {
        self == Self::Gltf && what == "light of one side"
    }

    /// Writes a test to a folder, with the files that it names.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write(self, test: &Test, folder: &Path) -> Result<WrittenForm, Failure> {
        std::fs::create_dir_all(folder).map_err(|source| failed(folder, &source))?;
        let scene =
            replay::load_scene(test.name, &test.scene, &test.files, folder).map_err(|error| Failure::Other(error.to_string()))?;
        let path = folder.join(self.file_name());
        let written = match self {
            Self::Toml => {
                std::fs::write(&path, &test.scene).map_err(|source| failed(&path, &source))?;
                return Ok(WrittenForm { path, left_out: Vec::new() });
            }
            Self::Mitsuba => scene_writer::as_mitsuba(&scene, test.name, &path)?,
            Self::Gltf => scene_writer::as_gltf(&scene, test.name, &path),
            Self::Pbrt => scene_writer::as_pbrt(&scene, test.name, &path),
        };
        let mut left_out = self.sentences(&written.report);
        let depth = scene.render.max_depth;
        if self == Self::Gltf && (1..DEEP).contains(&depth) {
            left_out.push(format!("paths of at most {depth} edges: glTF has no limit of depth"));
        }
        written.write(&path, &FileLog::default())?;
        Ok(WrittenForm { path, left_out })
    }

    fn sentences(self, report: &ImportReport) -> Vec<String> {
        let items = report.dropped.iter().chain(&report.approximated);
        items.filter(|item| !self.is_harmless(&item.what)).map(|item| format!("{}: {}", item.what, item.instead)).collect()
    }
}

fn failed(path: &Path, source: &std::io::Error) -> Failure {
    Failure::Other(format!("{}: {source}", path.display()))
}
