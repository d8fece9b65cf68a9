//! Keys of scene files with their values.

use std::path::PathBuf;

/// Keys with their values, in the order in which they are written.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Keys(pub Vec<(&'static str, Value)>);

#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Number(f64),
    Integer(i64),
    Flag(bool),
    Text(String),
    File(FileReference),
    List(Vec<Value>),
    Table(Keys),
}

#[derive(Debug, Clone, PartialEq)]
pub enum FileReference {
    /// A file on disk, as this process finds it.
    Disk(PathBuf),
    /// Index into [`Description::held`].
    Held(usize),
}

impl Keys {
    pub fn new() -> Self {
        Self::default()
    }

    /// Of a table that has a type.
    pub fn of_type(name: &str) -> Self {
        Self::new().with("type", name)
    }

    pub fn with(mut self, key: &'static str, value: impl Into<Value>) -> Self {
        self.set(key, value);
        self
    }

    pub fn with_some(self, key: &'static str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.with(key, value),
            None => self,
        }
    }

    /// Sets a key, in place of what it had.
    pub fn set(&mut self, key: &'static str, value: impl Into<Value>) {
        let value = value.into();
        match self.0.iter_mut().find(|(other, _)| *other == key) {
            Some(entry) => entry.1 = value,
            None => self.0.push((key, value)),
        }
    }

    pub fn get(&self, key: &str) -> Option<&Value> {
        self.0.iter().find(|(other, _)| *other == key).map(|(_, value)| value)
    }

    /// The text that a key has.
    pub fn text(&self, key: &str) -> Option<&str> {
        match self.get(key) {
            Some(Value::Text(text)) => Some(text),
            _ => None,
        }
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Several values as a list.
pub fn list<T: Into<Value>>(values: impl IntoIterator<Item = T>) -> Value {
    Value::List(values.into_iter().map(Into::into).collect())
}

macro_rules! from {
    ($($type:ty: $value:ident => $made:expr,)*) => {$(
        impl From<$type> for Value {
            fn from($value: $type) -> Self {
                $made
            }
        }
    )*};
}
from! {
    f64: value => Self::Number(value),
    i64: value => Self::Integer(value),
    u32: value => Self::Integer(value.into()),
    bool: value => Self::Flag(value),
    &str: value => Self::Text(value.to_owned()),
    String: value => Self::Text(value),
    FileReference: value => Self::File(value),
    Keys: value => Self::Table(value),
    glam::DVec3: value => list(value.to_array()),
    [f64; 2]: value => list(value),
    Vec<Value>: value => Self::List(value),
}
