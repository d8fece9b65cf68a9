//! Values within a plugin's element: numbers, texts, vectors, colours and transforms.

use std::cell::Cell;

use glam::DAffine3;
use roxmltree::Node;

use super::document::{Reader, Source};
use super::number::parse_number;
use super::plugin::{Plugin, Property, PropertyValue, SpectralCurve, error_at};
use super::{colour, transform};
use crate::load::encoding;
use crate::load::error::{SceneError, show};

impl Reader<'_> {
    /// Reads one into the plugin around it.
    pub(super) fn property(&mut self, source: Source, node: Node, around: &mut Plugin) -> Result<(), SceneError> {
        let tag = node.tag_name().name();
        let place = source.place(node);
        let name = self.property_name(source, node)?;
        let number = |reader: &mut Self| -> Result<f64, SceneError> {
            let text = reader.needed(source, node, "value")?;
            parse_number(&place, &text)
        };
        let value = match tag {
            "float" | "integer" | "long" => PropertyValue::Number(number(self)?),
            "boolean" => match self.needed(source, node, "value")?.trim().to_ascii_lowercase().as_str() {
                "true" => PropertyValue::Flag(true),
                "false" => PropertyValue::Flag(false),
                other => return Err(error_at(&place, format!("expected true or false, found `{other}`"))),
            },
            "string" => PropertyValue::Text(self.needed(source, node, "value")?),
            "point" | "vector" => PropertyValue::Vector(self.vector(source, node)?),
            "rgb" | "color" => PropertyValue::Rgb(colour::parse_rgb(&place, &self.needed(source, node, "value")?)?),
            "srgb" => PropertyValue::Rgb(colour::parse_srgb(&place, &self.needed(source, node, "value")?)?),
            "spectrum" => self.spectrum(source, node)?,
            "blackbody" => {
                let kelvin = self.needed(source, node, "temperature")?;
                let kelvin = parse_number(&place, kelvin.trim_end_matches(['K', 'k']))?;
                let scale = match self.attribute(source, node, "scale")? {
                    Some(scale) => parse_number(&place, &scale)?,
                    None => 1.0,
                };
                PropertyValue::Spectrum(SpectralCurve::BlackBody(kelvin, scale))
            }
            "transform" => PropertyValue::Transform(self.transform(source, node)?),
            "animation" => {
                self.report.drop("animation", place.to_string(), "its first transform is taken for all times");
                let first = node.children().find(|child| child.has_tag_name("transform"));
                PropertyValue::Transform(first.map_or(Ok(DAffine3::IDENTITY), |node| self.transform(source, node))?)
            }
            _ => return Err(error_at(&place, format!("<{tag}> is no element of a Mitsuba scene"))),
        };
        if around.properties.iter().any(|property| property.name == name) {
            return Err(error_at(&place, format!("`{name}` is given twice")));
        }
        around.properties.push(Property { name, value, place, used: Cell::new(false) });
        Ok(())
    }

    fn spectrum(&mut self, source: Source, node: Node) -> Result<PropertyValue, SceneError> {
        let place = source.place(node);
        if let Some(file) = self.attribute(source, node, "filename")? {
            let path = self.find(&file).ok_or_else(|| error_at(&place, format!("there is no file {file}")))?;
            let bytes = self.files.read(&path, 1 << 24);
            let bytes = bytes.map_err(|error| error_at(&place, format!("{}: cannot be read: {error}", show(&path))))?;
            let (text, _) = encoding::decode(&bytes);
            return colour::parse_spectrum_file(&place, &text).map(PropertyValue::Spectrum);
        }
        colour::parse_spectrum(&place, &self.needed(source, node, "value")?)
    }

    fn transform(&mut self, source: Source, node: Node) -> Result<DAffine3, SceneError> {
        let mut map = DAffine3::IDENTITY;
        for step in node.children().filter(Node::is_element) {
            let place = source.place(step);
            let mut get = |name: &str| self.attribute(source, step, name);
            if step.has_tag_name("rotate") && (transform::vector(&place, &mut get, 0.0)?.length() - 1.0).abs() > 1e-3 {
                let instead = "it is taken as it is, as version 3 does, which distorts; those before took one of length 1";
                self.report.approximate("axis of a rotation of another length than 1", place.to_string(), instead);
            }
            let mut get = |name: &str| self.attribute(source, step, name);
            map = transform::step(&place, step.tag_name().name(), &mut get)? * map;
        }
        Ok(map)
    }

    fn vector(&mut self, source: Source, node: Node) -> Result<glam::DVec3, SceneError> {
        let place = source.place(node);
        let mut get = |name: &str| self.attribute(source, node, name);
        transform::vector(&place, &mut get, 0.0)
    }
}
