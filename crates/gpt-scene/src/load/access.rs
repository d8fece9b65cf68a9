//! Permissions and limits of reading a scene.

use std::path::PathBuf;

use super::error::SceneError;
use super::files::Files;
use super::reading::ReadingProgress;
use super::view::ModelView;
use crate::file_log::FileLog;
use crate::scene::CameraPreset;

/// Options of the reader of a scene.
#[derive(Debug, Clone, Default)]
pub struct LoadOptions {
    /// Files that the scene names lie in this folder, wherever links lead; others are refused. None: they may lie anywhere.
    pub assets_root: Option<PathBuf>,
    /// Refuse a scene in which something is missing, instead of replacing it.
    pub strict: bool,
    /// Values of `$key` in a file of Mitsuba.
    pub definitions: Vec<(String, String)>,
    /// The camera of an imported file that has several, by its name.
    pub camera: Option<String>,
    /// The way in which the scene is seen, in place of its camera's own. The picture is then as wide as fits its height.
    pub preset: Option<CameraPreset>,
    /// The variant of a glTF's materials that is shown, by its name (`KHR_materials_variants`). None: what primitives name themselves.
    pub variant: Option<String>,
    /// How a model is shown that comes without camera and light. Of scene files, only its environment counts.
    pub view: ModelView,
    /// Is told how many files are read, and how many were.
    pub progress: ReadingProgress,
    /// The list in which all files are noted that are opened.
    pub log: FileLog,
}

/// [`LoadOptions`] whose folder is there.
#[derive(Debug, Clone, Default)]
pub struct Access {
    pub files: Files,
    pub strict: bool,
}

impl LoadOptions {
    pub(super) fn access(&self) -> Result<Access, SceneError> {
        let files = self.assets_root.as_deref().map_or(Ok(Files::default()), Files::within)?;
        Ok(Access { files: files.with_progress(self.progress.clone()).with_log(self.log.clone()), strict: self.strict })
    }
}
