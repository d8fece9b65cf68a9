//! Directives of pbrt's text: a name, texts in quotes, and typed parameters.

use std::fmt;

use glam::{DAffine3, DVec3};

use crate::spectrum::Spectrum;

/// A number of pbrt's parameters, or the name of a texture of numbers.
#[derive(Debug, Clone, PartialEq)]
pub enum Number {
    Constant(f64),
    Texture(String),
}

/// A colour of pbrt's parameters, or the name of a texture of colours.
#[derive(Debug, Clone, PartialEq)]
pub enum Tint {
    Constant(Spectrum),
    Texture(String),
}

/// A directive with its parameters, in the making.
#[derive(Debug, Clone)]
pub struct Directive {
    head: String,
    parameters: Vec<String>,
}

impl Directive {
    /// A directive and the texts behind its name.
    pub fn new(name: &str, texts: &[&str]) -> Self {
        let texts: String = texts.iter().map(|text| format!(" {}", quoted(text))).collect();
        Self { head: format!("{name}{texts}"), parameters: Vec::new() }
    }

    fn parameter(mut self, kind: &str, name: &str, values: impl IntoIterator<Item = String>) -> Self {
        let values: Vec<String> = values.into_iter().collect();
        self.parameters.push(format!("\"{kind} {name}\" [ {} ]", values.join(" ")));
        self
    }

    pub fn float(self, name: &str, value: f64) -> Self {
        self.parameter("float", name, [value.to_string()])
    }

    pub fn floats(self, name: &str, values: &[f64]) -> Self {
        self.parameter("float", name, values.iter().map(f64::to_string))
    }

    pub fn integer(self, name: &str, value: i64) -> Self {
        self.parameter("integer", name, [value.to_string()])
    }

    pub fn integers(self, name: &str, values: impl IntoIterator<Item = u32>) -> Self {
        self.parameter("integer", name, values.into_iter().map(|value| value.to_string()))
    }

    pub fn flag(self, name: &str, value: bool) -> Self {
        self.parameter("bool", name, [value.to_string()])
    }

    pub fn string(self, name: &str, value: &str) -> Self {
        self.parameter("string", name, [quoted(value)])
    }

    pub fn strings(self, name: &str, values: &[&str]) -> Self {
        self.parameter("string", name, values.iter().map(|value| quoted(value)))
    }

    pub fn rgb(self, name: &str, value: Spectrum) -> Self {
        self.parameter("rgb", name, value.to_rgb().map(|channel| channel.to_string()))
    }

    /// A spectrum by its name.
    pub fn named_spectrum(self, name: &str, spectrum: &str) -> Self {
        self.parameter("spectrum", name, [quoted(spectrum)])
    }

    /// A spectrum by its values at wavelengths in nanometres.
    pub fn spectrum(self, name: &str, values: &[[f64; 2]]) -> Self {
        self.parameter("spectrum", name, values.as_flattened().iter().map(f64::to_string))
    }

    pub fn point(self, name: &str, value: DVec3) -> Self {
        self.parameter("point3", name, value.to_array().map(|coordinate| coordinate.to_string()))
    }

    /// Single-precision numbers, of points (`point3`, `point2`), of normals (`normal`), or plain ones (`float`).
    pub fn coordinates(self, kind: &str, name: &str, values: impl IntoIterator<Item = f32>) -> Self {
        self.parameter(kind, name, values.into_iter().map(|value| value.to_string()))
    }

    /// The number, or the texture of numbers.
    pub fn number(self, name: &str, value: &Number) -> Self {
        match value {
            Number::Constant(value) => self.float(name, *value),
            Number::Texture(texture) => self.parameter("texture", name, [quoted(texture)]),
        }
    }

    /// The colour, or the texture of colours.
    pub fn tint(self, name: &str, value: &Tint) -> Self {
        match value {
            Tint::Constant(value) => self.rgb(name, *value),
            Tint::Texture(texture) => self.parameter("texture", name, [quoted(texture)]),
        }
    }

    /// The widths of microfacets under the names `roughness`, or `uroughness` and `vroughness`, behind a prefix.
    pub fn rough(self, prefix: &str, [along, across]: &[Number; 2]) -> Self {
        let directive = if along == across {
            self.number(&format!("{prefix}roughness"), along)
        } else {
            self.number(&format!("{prefix}uroughness"), along).number(&format!("{prefix}vroughness"), across)
        };
        // Numbers are widths, and not roots of some: one word for a coat and what is below it.
        if prefix == "interface." { directive } else { directive.flag("remaproughness", false) }
    }

    /// The parameter where there is one.
    pub fn some<T>(self, value: Option<T>, with: impl FnOnce(Self, T) -> Self) -> Self {
        match value {
            Some(value) => with(self, value),
            None => self,
        }
    }
}

impl fmt::Display for Directive {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}", self.head)?;
        self.parameters.iter().try_for_each(|parameter| write!(out, " {parameter}"))
    }
}

/// Text in quotes, on one line.
pub fn quoted(text: &str) -> String {
    let text: String = text.chars().map(|character| if character.is_control() { ' ' } else { character }).collect();
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// The sixteen numbers of a map, column by column.
pub fn transform(name: &str, map: &DAffine3) -> String {
    let columns = glam::DMat4::from(*map).to_cols_array().map(|number| number.to_string());
    format!("{name} [ {} ]", columns.join(" "))
}

pub fn triple(DVec3 { x, y, z }: DVec3) -> String {
    format!("{x} {y} {z}")
}
