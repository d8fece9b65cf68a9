//! The scene file that is edited: its text with all that was changed, what can be undone, and what is on the disk.

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use gpt::load::{self, FileLog, LoadOptions, SceneError};
use gpt::output::{AtomicFile, OutputError};
use gpt::scene::Scene;
use serde::Serialize;
use serde_json::Value as Json;
use toml_edit::DocumentMut;

use super::changes::{Change, LISTS, Refused, apply};
use super::looking::{CameraModel, Look, Looking};
use super::references::REFERENCES;
use super::values::item_to_json;

/// Largest scene file that is edited: its text is parsed at each change.
const MOST_BYTES: u64 = 64 << 20;
/// Bytes of text that are kept for undoing.
const MOST_UNDO_BYTES: usize = 64 << 20;
const MARK: &str = "\u{feff}";

/// A scene file that is being edited.
pub struct EditedFile {
    path: PathBuf,
    content: Mutex<Content>,
    /// The text is another one than that which is rendered.
    changed: Arc<AtomicBool>,
}

struct Content {
    document: DocumentMut,
    text: String,
    /// Counts changes, so that a page knows whether it has seen the last one.
    revision: u64,
    undo: Vec<String>,
    redo: Vec<String>,
    /// The drag of a slider that made the last change.
    gesture: Option<String>,
    /// The bytes that the file had when it was read or saved, and their text.
    on_disk: Vec<u8>,
    saved: String,
    form: Form,
    looking: Looking,
}

/// Traits of the file that the edited text has not.
#[derive(Debug, Clone, Copy)]
struct Form {
    has_mark: bool,
    has_returns: bool,
}

impl Form {
    /// The text as it is edited: lines end in line feeds.
    fn read(bytes: &[u8]) -> Option<(Self, String)> {
        let text = std::str::from_utf8(bytes).ok()?;
        let (has_mark, text) = text.strip_prefix(MARK).map_or((false, text), |rest| (true, rest));
        let has_returns = text.contains("\r\n");
        Some((Self { has_mark, has_returns }, if has_returns { text.replace("\r\n", "\n") } else { text.to_owned() }))
    }

    fn write(self, text: &str) -> Vec<u8> {
        let text = if self.has_returns { text.replace('\n', "\r\n") } else { text.to_owned() };
        if self.has_mark { [MARK, &text].concat().into_bytes() } else { text.into_bytes() }
    }
}

/// The scene as the page gets it.
#[derive(Serialize)]
pub struct Model<'a> {
    revision: u64,
    file: String,
    unsaved: bool,
    can_undo: bool,
    can_redo: bool,
    lists: Json,
    /// The lists that can be changed.
    editable: &'a [&'a str],
    /// Keys that name entries, and the list of each.
    references: Json,
    camera: Option<CameraModel>,
}

/// The reason why the page does not get what it asked for.
#[derive(Debug, thiserror::Error)]
pub enum EditError {
    #[error("the scene was changed by another page meanwhile")]
    Outdated,
    #[error(transparent)]
    Refused(#[from] Refused),
    #[error("{0} was changed by another program meanwhile")]
    Conflict(String),
    #[error(transparent)]
    Output(#[from] OutputError),
}

impl EditedFile {
    /// Reads a scene file.
    ///
    /// # Errors
    /// A file that cannot be read, and one that is no TOML in UTF-8.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let name = path.display().to_string();
        let bytes = FileLog::default().read(path, MOST_BYTES);
        let bytes = bytes.map_err(|error| SceneError::in_file(&name, format!("cannot be read: {error}")))?;
        let (form, text) = Form::read(&bytes)
            .ok_or_else(|| SceneError::in_file(&name, "is not a text in UTF-8").with_help("save it as UTF-8"))?;
        let document = match text.parse::<DocumentMut>() {
            Ok(document) => document,
            // The loader tells the place.
            Err(error) => {
                let of_loader = load::load_file_text(path, &text, &LoadOptions::default()).err();
                return Err(of_loader.unwrap_or_else(|| SceneError::in_file(&name, error.to_string())));
            }
        };
        let saved = text.clone();
        let (undo, redo, gesture) = (Vec::new(), Vec::new(), None);
        let content = Content {
            document,
            text,
            revision: 1,
            undo,
            redo,
            gesture,
            on_disk: bytes,
            saved,
            form,
            looking: Looking::default(),
        };
        Ok(Self { path: path.to_owned(), content: Mutex::new(content), changed: Arc::new(AtomicBool::new(false)) })
    }

    /// Is true once the text is another one than that which is rendered.
    pub fn changed(&self) -> &Arc<AtomicBool> {
        &self.changed
    }

    /// Reads the scene of the text as it is now, seen from where the page moved its camera.
    ///
    /// # Errors
    /// The errors of [`load::load_file_text`].
    pub fn scene(&self, options: &LoadOptions) -> Result<Scene, SceneError> {
        let text = self.content().text.clone();
        let mut scene = load::load_file_text(&self.path, &text, options)?;
        self.content().looking.apply(&mut scene);
        Ok(scene)
    }

    /// Moves the camera, or with None back to where the file has it. That is no change of the text.
    ///
    /// # Errors
    /// The errors of [`Looking::turn`].
    pub fn look(&self, to: Option<Look>) -> Result<(), EditError> {
        self.content().looking.turn(to)?;
        self.changed.store(true, Ordering::SeqCst);
        Ok(())
    }

    /// Writes where the camera was moved into the text.
    ///
    /// # Errors
    /// Another revision, and a camera that was not moved.
    pub fn keep_look(&self, revision: u64) -> Result<(), EditError> {
        self.take_change(revision, None, |document, looking| looking.keep(document))?;
        self.content().looking.is_kept();
        Ok(())
    }

    /// The scene as the page gets it.
    pub fn model(&self) -> Model<'static> {
        let content = self.content();
        let mut lists = serde_json::Map::new();
        for list in LISTS.iter().chain(&["texture"]) {
            lists.insert((*list).to_owned(), content.document.get(list).map_or(Json::Array(Vec::new()), item_to_json));
        }
        Model {
            revision: content.revision,
            file: self.path.display().to_string(),
            unsaved: content.is_unsaved(),
            can_undo: !content.undo.is_empty(),
            can_redo: !content.redo.is_empty(),
            lists: Json::Object(lists),
            editable: &LISTS,
            references: REFERENCES.iter().map(|(key, list)| (*key, *list)).collect(),
            camera: content.looking.model(),
        }
    }

    /// True where the text is not in the file.
    pub fn is_unsaved(&self) -> bool {
        self.content().is_unsaved()
    }

    /// Makes all of these changes, or none. Changes of one gesture, as while a slider is dragged, are undone together.
    ///
    /// # Errors
    /// Changes of another revision, and those that cannot be made.
    pub fn change(&self, revision: u64, changes: &[Change], gesture: Option<String>) -> Result<(), EditError> {
        self.take_change(revision, gesture, |document, _| changes.iter().try_for_each(|change| apply(document, change)))
    }

    fn take_change(
        &self,
        revision: u64,
        gesture: Option<String>,
        make: impl FnOnce(&mut DocumentMut, &Looking) -> Result<(), Refused>,
    ) -> Result<(), EditError> {
        let mut content = self.content();
        content.is_at(revision)?;
        let mut document = content.document.clone();
        make(&mut document, &content.looking)?;
        let text = document.to_string();
        if text == content.text {
            return Ok(());
        }
        if gesture.is_none() || content.gesture != gesture || content.undo.is_empty() {
            let before = content.text.clone();
            content.undo.push(before);
        }
        content.redo.clear();
        content.gesture = gesture;
        content.take(text, Some(document));
        self.changed.store(true, Ordering::SeqCst);
        Ok(())
    }

    /// Takes the last change back, or `again` what was taken back.
    ///
    /// # Errors
    /// Another revision.
    pub fn undo(&self, revision: u64, again: bool) -> Result<(), EditError> {
        let mut content = self.content();
        content.is_at(revision)?;
        let Some(text) = (if again { content.redo.pop() } else { content.undo.pop() }) else { return Ok(()) };
        let before = content.text.clone();
        if again {
            content.undo.push(before);
        } else {
            content.redo.push(before);
        }
        content.gesture = None;
        content.take(text, None);
        self.changed.store(true, Ordering::SeqCst);
        Ok(())
    }

    /// Writes the text to the file. Where another program changed that, only with `overwrite`.
    ///
    /// # Errors
    /// Such a change, another revision, and a file that cannot be written.
    pub fn save(&self, revision: u64, overwrite: bool) -> Result<(), EditError> {
        let mut content = self.content();
        content.is_at(revision)?;
        if !overwrite && FileLog::default().read(&self.path, MOST_BYTES).ok().as_ref() != Some(&content.on_disk) {
            return Err(EditError::Conflict(self.path.display().to_string()));
        }
        let bytes = content.form.write(&content.text);
        AtomicFile::write(&self.path, &bytes)?;
        content.on_disk = bytes;
        content.saved = content.text.clone();
        content.gesture = None;
        Ok(())
    }

    fn content(&self) -> MutexGuard<'_, Content> {
        // The content is whole whatever panicked while holding it.
        self.content.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Content {
    fn is_unsaved(&self) -> bool {
        self.text != self.saved
    }

    fn is_at(&self, revision: u64) -> Result<(), EditError> {
        if self.revision == revision { Ok(()) } else { Err(EditError::Outdated) }
    }

    /// Takes a text whose document this is; without one it is parsed, for it was a document before.
    fn take(&mut self, text: String, document: Option<DocumentMut>) {
        if let Some(document) = document.or_else(|| text.parse().ok()) {
            self.document = document;
            self.text = text;
        }
        self.revision += 1;
        while self.undo.len() > 1 && self.undo.iter().map(String::len).sum::<usize>() > MOST_UNDO_BYTES {
            self.undo.remove(0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::changes::Step;
    use super::*;

    const TEXT: &str = "# A room.\n[[material]]\nname = \"a\" # kept\ntype = \"diffuse\"\nreflectance = 0.5\n";

    fn set(value: f64) -> Vec<Change> {
        let at = vec![Step::Key("material".to_owned()), Step::Index(0), Step::Key("reflectance".to_owned())];
        vec![Change::Set { at, value: Json::from(value) }]
    }

    fn opened(text: &str) -> (tempfile::TempDir, PathBuf, EditedFile) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("scene.toml");
        std::fs::write(&path, text).expect("the file is written");
        let file = EditedFile::open(&path).expect("it is TOML");
        (folder, path, file)
    }

    fn text(file: &EditedFile) -> String {
        file.content().text.clone()
    }

    #[test]
    fn a_drag_is_one_step_to_undo_and_a_revision_that_is_over_is_refused() {
        let (_folder, _, file) = opened(TEXT);
        let drag = || Some("drag 1".to_owned());
        file.change(1, &set(0.25), None).expect("it is a change");
        file.change(2, &set(0.3), drag()).expect("it is a change");
        file.change(3, &set(0.4), drag()).expect("it is a change");
        assert!(matches!(file.change(3, &set(0.9), None), Err(EditError::Outdated)));
        assert!(file.is_unsaved() && file.changed().load(Ordering::SeqCst));
        assert!(text(&file).contains("reflectance = 0.4\n"));
        file.undo(4, false).expect("there is something to undo");
        assert!(text(&file).contains("reflectance = 0.25\n"));
        file.undo(5, false).expect("there is something to undo");
        assert_eq!(text(&file), TEXT);
        assert!(!file.is_unsaved());
        file.undo(6, true).expect("there is something to do again");
        assert!(text(&file).contains("reflectance = 0.25\n"));
        file.change(7, &set(0.7), None).expect("it is a change");
        let model = file.model();
        assert!(model.can_undo && !model.can_redo, "a change ends what could be done again");
    }

    #[test]
    fn changes_are_made_together_or_not_at_all() {
        let (_folder, _, file) = opened(TEXT);
        let mut changes = set(0.25);
        changes.push(Change::Unset { at: vec![Step::Key("material".to_owned()), Step::Index(7)] });
        assert!(matches!(file.change(1, &changes, None), Err(EditError::Refused(_))));
        assert_eq!((text(&file).as_str(), file.model().revision), (TEXT, 1));
    }

    #[test]
    fn a_file_is_saved_as_it_was_but_for_the_change_and_never_over_the_work_of_others() {
        for (mark, end) in [("", "\n"), (MARK, "\r\n")] {
            let written = |text: &str| format!("{mark}{}", text.replace('\n', end));
            let (_folder, path, file) = opened(&written(TEXT));
            file.change(1, &set(0.25), None).expect("it is a change");
            file.save(2, false).expect("it is saved");
            let read = || std::fs::read_to_string(&path).expect("it is there");
            assert_eq!(read(), written(&TEXT.replace("0.5", "0.25")));
            assert!(!file.is_unsaved());
            std::fs::write(&path, "# other").expect("the file is written");
            file.change(2, &set(0.75), None).expect("it is a change");
            assert!(matches!(file.save(3, false), Err(EditError::Conflict(_))));
            assert_eq!(read(), "# other");
            file.save(3, true).expect("it is asked for");
            assert_eq!(read(), written(&TEXT.replace("0.5", "0.75")));
        }
    }

    /// The page offers every name for every part.
    #[test]
    fn materials_within_themselves_are_mistakes() {
        let camera =
            "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n";
        let blend = |part: &str| {
            format!(
                "[[material]]\nname = \"m\"\ntype = \"blend\"\nmaterials = [\"{part}\", \"a\"]\nweight = {{ type = \"front\" }}\n"
            )
        };
        let layered = "[[material]]\nname = \"l\"\ntype = \"layered\"\ninterfaces = [\"m\"]\n";
        let scene = |part: &str| {
            let (_folder, _, file) = opened(&[TEXT, camera, &blend(part), layered].concat());
            file.scene(&LoadOptions::default()).err().map(|error| error.message().to_owned())
        };
        assert_eq!(scene("m").as_deref(), Some("the blend `m` contains itself"));
        assert_eq!(scene("a"), None, "the control");
    }

    #[test]
    fn what_is_no_text_of_a_scene_is_refused() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("scene.toml");
        assert!(EditedFile::open(&path).is_err(), "it is missing");
        std::fs::write(&path, b"\xff\xfe").expect("the file is written");
        assert!(EditedFile::open(&path).is_err_and(|error| error.message().contains("UTF-8")));
        std::fs::write(&path, "a = ").expect("the file is written");
        assert!(EditedFile::open(&path).is_err_and(|error| error.line() == Some(1)));
    }
}
