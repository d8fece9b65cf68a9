//! YAML, of which JSON is a part, as values that know their lines.

use saphyr_parser::{Event, Parser};

use crate::load::error::SceneError;

/// Deepest nesting of a file.
const DEEPEST: usize = 32;

/// A value of a file.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// Line, counted from 1.
    pub line: usize,
    pub value: Value,
}

#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    Scalar(String),
    List(Vec<Node>),
    Map(Vec<(String, Node)>),
}

impl Node {
    /// The value of a key; None where this is no map, or has no such key.
    pub fn get(&self, key: &str) -> Option<&Self> {
        let Value::Map(entries) = &self.value else { return None };
        entries.iter().find(|(name, _)| name == key).map(|(_, node)| node)
    }

    pub fn text(&self) -> Option<&str> {
        if let Value::Scalar(text) = &self.value { Some(text) } else { None }
    }
}

/// A list or a map that is not at its end.
struct Open {
    line: usize,
    is_map: bool,
    nodes: Vec<Node>,
}

impl Open {
    fn close(self) -> Result<Node, (usize, String)> {
        let Self { line, is_map, nodes } = self;
        if !is_map {
            return Ok(Node { line, value: Value::List(nodes) });
        }
        let mut entries: Vec<(String, Node)> = Vec::new();
        let mut nodes = nodes.into_iter();
        while let (Some(key), Some(value)) = (nodes.next(), nodes.next()) {
            let Value::Scalar(name) = key.value else { return Err((key.line, "a key is a word".to_owned())) };
            if entries.iter().any(|(other, _)| *other == name) {
                return Err((key.line, format!("a second key `{name}`")));
            }
            entries.push((name, value));
        }
        Ok(Node { line, value: Value::Map(entries) })
    }
}

/// Reads the first document of a text.
///
/// # Errors
/// A text that is not YAML, with the line.
pub fn read(name: &str, text: &str) -> Result<Node, SceneError> {
    let fail = |(line, message): (usize, String)| SceneError::in_line(name, line, message);
    // OpenCV's first line, `%YAML:1.0`, is no directive of YAML. The line stays, so that lines are counted right.
    let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
    let blanked;
    let text = if first.starts_with("%YAML:") {
        blanked = format!("\n{rest}");
        &blanked
    } else {
        text
    };
    let mut open: Vec<Open> = Vec::new();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|error| fail((error.marker().line().max(1), error.info().to_owned())))?;
        let line = span.start.line().max(1);
        let complete = match event {
            Event::SequenceStart(..) | Event::MappingStart(..) => {
                if open.len() == DEEPEST {
                    return Err(fail((line, format!("values are nested more than {DEEPEST} times"))));
                }
                open.push(Open { line, is_map: matches!(event, Event::MappingStart(..)), nodes: Vec::new() });
                continue;
            }
            Event::SequenceEnd | Event::MappingEnd => match open.pop() {
                Some(of) => of.close().map_err(fail)?,
                None => continue,
            },
            Event::Scalar(text, ..) => Node { line, value: Value::Scalar(text.into_owned()) },
            Event::Alias(_) => return Err(fail((line, "an alias of YAML stands for a value here".to_owned()))),
            _ => continue,
        };
        match open.last_mut() {
            Some(around) => around.nodes.push(complete),
            None => return Ok(complete),
        }
    }
    Err(SceneError::in_file(name, "is empty"))
}
