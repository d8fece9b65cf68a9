//! The content of a Mitsuba scene file: plugins with properties.

use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

use glam::{DAffine3, DVec3};

use crate::load::error::SceneError;
use crate::load::place::{Origin, Place};
use crate::spectrum::Spectrum;

/// An instance of a plugin: an element with its properties and the plugins within.
#[derive(Debug)]
pub struct Plugin {
    /// The element, as `bsdf`.
    pub kind: String,
    /// The plugin, as `diffuse`.
    pub name: String,
    pub id: String,
    pub place: Arc<Origin>,
    pub properties: Vec<Property>,
    pub children: Vec<Child>,
    pub within: Within,
    /// Something asked what it says.
    pub visited: Cell<bool>,
}

/// Properties of a plugin that also hold where a plugin within it has them. They are computed once the plugin
/// is read: plugins share those that they name, and a walk over all meets 2³² of them where each of 32 names
/// the one before twice.
#[derive(Debug, Default, Clone, Copy)]
pub struct Within {
    /// How many lie within each other, itself among them.
    pub depth: usize,
    /// The plugin looks up a texture.
    pub uses_texture: bool,
    pub uses_bitmap: bool,
    /// An attribute of a mesh.
    pub uses_attribute: bool,
    /// A map of normals or heights.
    pub has_relief: bool,
    /// One of heights.
    pub has_bump_map: bool,
}

#[derive(Debug)]
pub struct Property {
    pub name: String,
    pub value: PropertyValue,
    pub place: Origin,
    /// Something asked for it, so that it has an effect.
    pub used: Cell<bool>,
}

#[derive(Debug, Clone, PartialEq)]
pub enum PropertyValue {
    Number(f64),
    Flag(bool),
    Text(String),
    Vector(DVec3),
    /// Linear Rec.709.
    Rgb(Spectrum),
    Spectrum(SpectralCurve),
    Transform(DAffine3),
}

#[derive(Debug, Clone, PartialEq)]
pub enum SpectralCurve {
    Uniform(f64),
    /// Wavelengths in nanometres with their values.
    Samples(Vec<(f64, f64)>),
    /// Radiance of a black body at so many kelvins, times a factor.
    BlackBody(f64, f64),
}

#[derive(Debug)]
pub struct Child {
    /// Name given by the plugin around; empty where it gives none.
    pub name: String,
    pub plugin: Rc<Plugin>,
    pub used: Cell<bool>,
}

impl Plugin {
    /// How reports call it: `bsdf \`plastic\``.
    pub fn title(&self) -> String {
        format!("{} `{}`", self.kind, self.name)
    }

    /// Notes what is true of it and of what lies within, which is noted there.
    pub fn summarize(&mut self) {
        // Textures without places.
        const CONSTANT: [&str; 9] =
            ["rgb", "srgb", "uniform", "d65", "regular", "irregular", "blackbody", "srgb_d65", "rawconstant"];
        let (kind, name) = (self.kind.as_str(), self.name.as_str());
        let own = Within {
            depth: 0,
            // Directions of roughness follow texture coordinates.
            uses_texture: ["texture", "spectrum"].contains(&kind) && !CONSTANT.contains(&name) || self.has("alpha_u"),
            uses_bitmap: kind == "texture" && name == "bitmap",
            uses_attribute: kind == "texture" && name == "mesh_attribute",
            has_relief: ["bumpmap", "bump", "normalmap"].contains(&name),
            has_bump_map: ["bumpmap", "bump"].contains(&name),
        };
        let all = self.children.iter().map(|child| child.plugin.within).fold(own, |a, b| Within {
            depth: a.depth.max(b.depth),
            uses_texture: a.uses_texture || b.uses_texture,
            uses_bitmap: a.uses_bitmap || b.uses_bitmap,
            uses_attribute: a.uses_attribute || b.uses_attribute,
            has_relief: a.has_relief || b.has_relief,
            has_bump_map: a.has_bump_map || b.has_bump_map,
        });
        self.within = Within { depth: all.depth + 1, ..all };
    }

    fn find(&self, name: &str) -> Option<&Property> {
        let property = self.properties.iter().find(|property| property.name == name)?;
        property.used.set(true);
        Some(property)
    }

    /// An error about the whole plugin.
    pub fn error(&self, message: impl Into<String>) -> SceneError {
        error_at(&self.place, message)
    }

    /// The plugin's place, which entries made of it have.
    pub fn at(&self) -> Place {
        Place::Imported(self.place.clone())
    }

    /// A value of an entry, or the plugin's error about one that is not possible.
    pub fn possible<T>(&self, made: Result<T, String>) -> Result<T, SceneError> {
        made.map_err(|message| self.error(format!("{}: {message}", self.title())))
    }

    pub fn has(&self, name: &str) -> bool {
        self.properties.iter().any(|property| property.name == name) || self.children.iter().any(|child| child.name == name)
    }

    /// A number that the plugin cannot be without.
    ///
    /// # Errors
    /// A value of another kind.
    pub fn number(&self, name: &str) -> Result<Option<f64>, SceneError> {
        match self.find(name) {
            None => Ok(None),
            Some(property) => match &property.value {
                PropertyValue::Number(number) => Ok(Some(*number)),
                PropertyValue::Spectrum(SpectralCurve::Uniform(number)) => Ok(Some(*number)),
                PropertyValue::Rgb(colour) if colour.min_component() == colour.max_component() => Ok(Some(colour.r())),
                _ => Err(wrong_kind(property, "a number")),
            },
        }
    }

    pub fn number_or(&self, name: &str, default: f64) -> Result<f64, SceneError> {
        Ok(self.number(name)?.unwrap_or(default))
    }

    pub fn flag(&self, name: &str, default: bool) -> Result<bool, SceneError> {
        match self.find(name) {
            None => Ok(default),
            Some(property) => match &property.value {
                PropertyValue::Flag(flag) => Ok(*flag),
                _ => Err(wrong_kind(property, "true or false")),
            },
        }
    }

    pub fn text(&self, name: &str) -> Result<Option<&str>, SceneError> {
        match self.find(name) {
            None => Ok(None),
            Some(property) => match &property.value {
                PropertyValue::Text(text) => Ok(Some(text)),
                _ => Err(wrong_kind(property, "a string")),
            },
        }
    }

    pub fn vector(&self, name: &str) -> Result<Option<DVec3>, SceneError> {
        match self.find(name) {
            None => Ok(None),
            Some(property) => match &property.value {
                PropertyValue::Vector(vector) => Ok(Some(*vector)),
                _ => Err(wrong_kind(property, "a point or a vector")),
            },
        }
    }

    pub fn transform(&self, name: &str) -> Result<DAffine3, SceneError> {
        match self.find(name) {
            None => Ok(DAffine3::IDENTITY),
            Some(property) => match &property.value {
                PropertyValue::Transform(map) => Ok(*map),
                _ => Err(wrong_kind(property, "a transform")),
            },
        }
    }

    /// The value as it is written.
    pub fn value(&self, name: &str) -> Option<&PropertyValue> {
        self.find(name).map(|property| &property.value)
    }

    /// The plugin within that is called so.
    pub fn child(&self, name: &str) -> Option<&Rc<Plugin>> {
        let child = self.children.iter().find(|child| child.name == name)?;
        child.used.set(true);
        Some(&child.plugin)
    }

    /// Plugins within of an element, in their order.
    pub fn children_of(&self, kind: &str) -> Vec<&Rc<Plugin>> {
        let fitting = self.children.iter().filter(|child| child.plugin.kind == kind);
        fitting
            .map(|child| {
                child.used.set(true);
                &child.plugin
            })
            .collect()
    }

    /// The first plugin within of an element.
    pub fn first_of(&self, kind: &str) -> Option<&Rc<Plugin>> {
        let child = self.children.iter().find(|child| child.plugin.kind == kind)?;
        child.used.set(true);
        Some(&child.plugin)
    }

    /// Marks properties that change nothing that is rendered here.
    pub fn without_effect(&self, names: &[&str]) {
        self.properties.iter().filter(|property| names.contains(&property.name.as_str())).for_each(|one| one.used.set(true));
    }
}

/// An error at a place of an imported file.
pub fn error_at(place: &Origin, message: impl Into<String>) -> SceneError {
    place.error(message)
}

fn wrong_kind(property: &Property, expected: &str) -> SceneError {
    error_at(&property.place, format!("`{}` is not {expected}", property.name))
}
