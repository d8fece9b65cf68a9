//! The requests of the page that edits: what it gets, and what it may ask for.

use serde::Deserialize;
use serde::de::DeserializeOwned;

use super::super::view::{Panel, Reply};
use super::changes::Change;
use super::edited_file::{EditError, EditedFile};
use super::looking::Look;

/// The panel beside the picture, all that it consists of.
const PARTS: [&str; 5] = [
    concat!("<style>\n", include_str!("page/panel.css"), "</style>\n"),
    include_str!("page/panel.html"),
    concat!("<script>\n", include_str!("page/form.js"), "</script>\n"),
    concat!("<script>\n", include_str!("page/camera.js"), "</script>\n"),
    concat!("<script>\n", include_str!("page/panel.js"), "</script>\n"),
];

/// Changes that the page asks for.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Edit {
    revision: u64,
    changes: Vec<Change>,
    #[serde(default)]
    gesture: Option<String>,
}

/// A place for the camera; null: that of the file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Turn {
    /// Any will do: the camera is no part of the text.
    #[serde(rename = "revision")]
    _revision: u64,
    look: Option<Look>,
}

/// A request about a revision.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct About {
    revision: u64,
    #[serde(default)]
    overwrite: bool,
}

impl Panel for EditedFile {
    fn parts(&self) -> String {
        PARTS.concat()
    }

    fn get(&self, path: &str) -> Option<Reply> {
        match path {
            "document" => Some(self.reply()),
            "schema" => Some(Reply::json(gpt::load::json_schema().into())),
            _ => None,
        }
    }

    fn post(&self, path: &str, body: &[u8]) -> Option<Reply> {
        let done = match path {
            "edit" => parsed(body).map(|Edit { revision, changes, gesture }| self.change(revision, &changes, gesture)),
            "undo" => parsed(body).map(|About { revision, .. }| self.undo(revision, false)),
            "redo" => parsed(body).map(|About { revision, .. }| self.undo(revision, true)),
            "look" => parsed(body).map(|Turn { look, .. }| self.look(look)),
            "keep" => parsed(body).map(|About { revision, .. }| self.keep_look(revision)),
            "save" => parsed(body).map(|About { revision, overwrite }| self.save(revision, overwrite)),
            _ => return None,
        };
        Some(match done {
            Err(error) => Reply::refused("400 Bad Request", format!("This is no request of the page: {error}.\n")),
            Ok(Ok(())) => self.reply(),
            Ok(Err(error @ (EditError::Outdated | EditError::Conflict(_)))) => Reply::refused("409 Conflict", error.to_string()),
            Ok(Err(error @ EditError::Refused(_))) => Reply::refused("400 Bad Request", error.to_string()),
            Ok(Err(error @ EditError::Output(_))) => Reply::refused("500 Internal Server Error", error.to_string()),
        })
    }
}

fn parsed<T: DeserializeOwned>(body: &[u8]) -> Result<T, serde_json::Error> {
    serde_json::from_slice(body)
}

impl EditedFile {
    fn reply(&self) -> Reply {
        match serde_json::to_vec(&self.model()) {
            Ok(body) => Reply::json(body),
            Err(error) => Reply::refused("500 Internal Server Error", error.to_string()),
        }
    }
}
