//! References of entries: to textures by their names, and to files, which importers may have in memory.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer};

/// The name of a `[[texture]]` that another entry refers to.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub struct TextureName(pub String);

impl JsonSchema for TextureName {
    fn schema_name() -> Cow<'static, str> {
        String::schema_name()
    }
    fn inline_schema() -> bool {
        String::inline_schema()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        String::json_schema(generator)
    }
}

impl AsRef<str> for TextureName {
    fn as_ref(&self) -> &str {
        &self.0
    }
}

/// A value of a material's key, which may name textures.
pub trait NamesTextures {
    /// Calls this with the name of each texture.
    fn each_texture(&mut self, _visit: &mut dyn FnMut(&mut String)) {}
}

impl NamesTextures for TextureName {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        visit(&mut self.0);
    }
}

impl<T: NamesTextures> NamesTextures for Option<T> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        self.iter_mut().for_each(|value| value.each_texture(visit));
    }
}

impl<T: NamesTextures> NamesTextures for Box<T> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        (**self).each_texture(visit);
    }
}

impl NamesTextures for bool {}

/// A file, or its content where an importer has that in memory.
#[derive(Debug)]
pub enum FileOr<T: ?Sized> {
    /// The path in a scene file, relative to the folder of that.
    Written(String),
    /// The path as this process finds the file.
    OnDisk(PathBuf),
    InMemory(Arc<T>),
}

impl<T: ?Sized> FileOr<T> {
    /// The path of the file, where the scene file lies in `folder`; None of what is in memory.
    pub fn path(&self, folder: &Path) -> Option<PathBuf> {
        match self {
            Self::Written(path) => Some(folder.join(path)),
            Self::OnDisk(path) => Some(path.clone()),
            Self::InMemory(_) => None,
        }
    }
}

impl<T: ?Sized> Clone for FileOr<T> {
    fn clone(&self) -> Self {
        match self {
            Self::Written(path) => Self::Written(path.clone()),
            Self::OnDisk(path) => Self::OnDisk(path.clone()),
            Self::InMemory(content) => Self::InMemory(content.clone()),
        }
    }
}

impl<'de, T: ?Sized> Deserialize<'de> for FileOr<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        String::deserialize(deserializer).map(Self::Written)
    }
}

impl<T: ?Sized> JsonSchema for FileOr<T> {
    fn schema_name() -> Cow<'static, str> {
        String::schema_name()
    }
    fn inline_schema() -> bool {
        String::inline_schema()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        String::json_schema(generator)
    }
}
