//! Elements of XML as Mitsuba has them.

use std::fmt::Write as _;

use glam::{DAffine3, DVec3};

use crate::spectrum::Spectrum;

/// A scene in the making.
#[derive(Debug, Default)]
pub struct Xml(Vec<Element>);

/// A plugin with its properties and the plugins within.
#[derive(Debug, Clone, Default)]
pub struct Element {
    tag: &'static str,
    kind: String,
    attributes: Vec<(&'static str, String)>,
    body: Vec<String>,
    within: Vec<Element>,
}

impl Xml {
    pub fn push(&mut self, element: Element) {
        self.0.push(element);
    }

    pub fn finish(&self) -> String {
        let mut text = "<scene version=\"3.0.0\">\n".to_owned();
        self.0.iter().for_each(|element| element.write(&mut text, 1));
        text + "</scene>\n"
    }
}

impl Element {
    pub fn new(tag: &'static str, kind: &str) -> Self {
        Self { tag, kind: kind.to_owned(), ..Self::default() }
    }

    /// Sets the name by which the plugin around refers to it.
    pub fn named(mut self, name: &str) -> Self {
        self.attributes.push(("name", name.to_owned()));
        self
    }

    pub fn id(mut self, id: &str) -> Self {
        self.attributes.push(("id", id.to_owned()));
        self
    }

    pub fn with(mut self, element: Self) -> Self {
        self.within.push(element);
        self
    }

    fn property(mut self, tag: &str, name: &str, value: &str) -> Self {
        self.body.push(format!("<{tag} name=\"{name}\" value=\"{}\"/>", escaped(value)));
        self
    }

    pub fn float(self, name: &str, value: f64) -> Self {
        self.property("float", name, &value.to_string())
    }

    pub fn integer(self, name: &str, value: i64) -> Self {
        self.property("integer", name, &value.to_string())
    }

    pub fn boolean(self, name: &str, value: bool) -> Self {
        self.property("boolean", name, &value.to_string())
    }

    pub fn string(self, name: &str, value: &str) -> Self {
        self.property("string", name, value)
    }

    pub fn rgb(self, name: &str, value: Spectrum) -> Self {
        let [red, green, blue] = value.to_rgb();
        self.property("rgb", name, &format!("{red}, {green}, {blue}"))
    }

    pub fn point(mut self, name: &str, DVec3 { x, y, z }: DVec3) -> Self {
        self.body.push(format!("<point name=\"{name}\" x=\"{x}\" y=\"{y}\" z=\"{z}\"/>"));
        self
    }

    pub fn vector(mut self, name: &str, DVec3 { x, y, z }: DVec3) -> Self {
        self.body.push(format!("<vector name=\"{name}\" x=\"{x}\" y=\"{y}\" z=\"{z}\"/>"));
        self
    }

    pub fn reference(mut self, id: &str) -> Self {
        self.body.push(format!("<ref id=\"{}\"/>", escaped(id)));
        self
    }

    /// A reference that the plugin around calls by a name.
    pub fn named_reference(mut self, name: &str, id: &str) -> Self {
        self.body.push(format!("<ref name=\"{name}\" id=\"{}\"/>", escaped(id)));
        self
    }

    /// Steps as XML.
    pub fn transform(mut self, name: &str, steps: &str) -> Self {
        self.body.push(format!("<transform name=\"{name}\">{steps}</transform>"));
        self
    }

    fn write(&self, text: &mut String, depth: usize) {
        let indent = "  ".repeat(depth);
        // Writing to a text cannot fail.
        let _ = write!(text, "{indent}<{} type=\"{}\"", self.tag, self.kind);
        for (name, value) in &self.attributes {
            let _ = write!(text, " {name}=\"{}\"", escaped(value));
        }
        if self.body.is_empty() && self.within.is_empty() {
            text.push_str("/>\n");
            return;
        }
        text.push_str(">\n");
        for line in &self.body {
            let _ = writeln!(text, "{indent}  {line}");
        }
        self.within.iter().for_each(|element| element.write(text, depth + 1));
        let _ = writeln!(text, "{indent}</{}>", self.tag);
    }
}

/// `$` begins a parameter's name there, so it cannot stand in a text.
fn escaped(text: &str) -> String {
    let text = text.replace('&', "&amp;").replace('<', "&lt;").replace('"', "&quot;").replace('$', "_");
    text.chars().filter(|character| !character.is_control()).collect()
}

pub fn triple(DVec3 { x, y, z }: DVec3) -> String {
    format!("{x}, {y}, {z}")
}

/// The step that puts +Z along a direction.
pub fn look_along(position: DVec3, direction: DVec3) -> String {
    look_at(position, position + direction, direction.normalize_or(DVec3::Z).any_orthonormal_vector())
}

/// A look-at with +Y to this side.
pub fn look_at(position: DVec3, target: DVec3, up: DVec3) -> String {
    format!("<lookat origin=\"{}\" target=\"{}\" up=\"{}\"/>", triple(position), triple(target), triple(up))
}

/// `<matrix>`
pub fn matrix(map: &DAffine3) -> String {
    let m = map.matrix3;
    let rows = [0, 1, 2].map(|row| format!("{} {} {} {}", m.x_axis[row], m.y_axis[row], m.z_axis[row], map.translation[row]));
    format!("<matrix value=\"{} 0 0 0 1\"/>", rows.join(" "))
}
