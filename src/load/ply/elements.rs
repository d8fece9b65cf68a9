//! Elements of PLY files as the parser fills them.

use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType};

/// Stands for an index below 0, which begins a new strip, and for one that no vertex can have.
pub const NO_VERTEX: u32 = u32::MAX;
/// Stands for a number below 0 in place of a material.
const NO_GROUP: u32 = u32::MAX;

/// Names of the texture coordinates, as programs write them.
const U: [&str; 4] = ["u", "s", "texture_u", "texture_s"];
const V: [&str; 4] = ["v", "t", "texture_v", "texture_t"];
/// The same of the second ones.
const SECOND_U: [&str; 4] = ["u1", "s1", "texture_u1", "texture_s1"];
const SECOND_V: [&str; 4] = ["v1", "t1", "texture_v1", "texture_t1"];
/// Names of a face's or a strip's corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// What a vertex says; with `REST` all of it.
#[derive(Debug, Default)]
pub struct Vertex<const REST: bool> {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
    pub second_uv: [f32; 2],
    /// Numbers of other names, in their order.
    pub rest: Vec<f32>,
}

impl<const REST: bool> Vertex<REST> {
    fn set(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        let slot = match name {
            "x" => &mut self.position[0],
            "y" => &mut self.position[1],
            "z" => &mut self.position[2],
            "nx" => &mut self.normal[0],
            "ny" => &mut self.normal[1],
            "nz" => &mut self.normal[2],
            _ if U.contains(&name) => &mut self.uv[0],
            _ if V.contains(&name) => &mut self.uv[1],
            _ if SECOND_U.contains(&name) => &mut self.second_uv[0],
            _ if SECOND_V.contains(&name) => &mut self.second_uv[1],
            _ if REST => {
                self.rest.push(value);
                return PropertyAccessResult::Set;
            }
            _ => return PropertyAccessResult::Ignored,
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

/// A number of a property that is none of a mesh's own; integers without sign stand for shares of 1. Lists give 0.
fn number(property: &Property) -> f32 {
    match property {
        Property::UChar(code) => f32::from(*code) / 255.0,
        Property::UShort(code) => f32::from(*code) / 65_535.0,
        other => other.to_f32_lossy().unwrap_or_default(),
    }
}

impl<const REST: bool> PropertyAccess for Vertex<REST> {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if REST && !vertex_names().contains(&name) {
            self.rest.push(number(&property));
            return PropertyAccessResult::Set;
        }
        property.to_f32_lossy().map_or(PropertyAccessResult::Ignored, |value| self.set(name, value))
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        self.set(name, value)
    }
}

/// Names of the number that a face has in place of a material.
const GROUPS: [&str; 2] = ["material_index", "material_indices"];

/// A polygon or a strip of triangles; with `REST` all that it says.
#[derive(Debug, Default)]
pub struct Corners<const REST: bool> {
    /// Indices of vertices.
    pub corners: Vec<u32>,
    /// What stands for its material.
    pub group: u32,
    /// Numbers of other names, in their order.
    pub rest: Vec<f32>,
}

impl<const REST: bool> PropertyAccess for Corners<REST> {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        if GROUPS.contains(&name) {
            self.group = match property {
                Property::UInt(group) => group,
                Property::Int(group) => u32::try_from(group).unwrap_or(NO_GROUP),
                Property::UShort(group) => group.into(),
                Property::Short(group) => u32::try_from(group).unwrap_or(NO_GROUP),
                Property::UChar(group) => group.into(),
                Property::Char(group) => u32::try_from(group).unwrap_or(NO_GROUP),
                _ => return PropertyAccessResult::Ignored,
            };
            return PropertyAccessResult::Set;
        }
        if !CORNERS.contains(&name) {
            if REST {
                self.rest.push(number(&property));
                return PropertyAccessResult::Set;
            }
            return PropertyAccessResult::Ignored;
        }
        let of_signed = |index: i64| u32::try_from(index).unwrap_or(NO_VERTEX);
        self.corners = match property {
            Property::ListUInt(list) => list,
            Property::ListInt(list) => list.into_iter().map(|index| of_signed(index.into())).collect(),
            Property::ListUShort(list) => list.into_iter().map(u32::from).collect(),
            Property::ListShort(list) => list.into_iter().map(|index| of_signed(index.into())).collect(),
            Property::ListUChar(list) => list.into_iter().map(u32::from).collect(),
            Property::ListChar(list) => list.into_iter().map(|index| of_signed(index.into())).collect(),
            _ => return PropertyAccessResult::UnsupportedType,
        };
        PropertyAccessResult::Set
    }
}

/// An element that is read over.
#[derive(Debug)]
pub struct Ignored;

impl PropertyAccess for Ignored {
    fn new() -> Self {
        Self
    }
}

/// What an element of the header has.
pub struct Declared<'a>(pub &'a ElementDef);

impl Declared<'_> {
    fn is_scalar(&self, name: &str) -> bool {
        matches!(self.0.properties.get(name), Some(property) if matches!(property.data_type, PropertyType::Scalar(_)))
    }

    pub fn has_positions(&self) -> bool {
        ["x", "y", "z"].iter().all(|name| self.is_scalar(name))
    }

    pub fn has_normals(&self) -> bool {
        ["nx", "ny", "nz"].iter().all(|name| self.is_scalar(name))
    }

    pub fn has_uvs(&self) -> bool {
        U.iter().zip(V).any(|(u, v)| self.is_scalar(u) && self.is_scalar(v))
    }

    pub fn has_second_uvs(&self) -> bool {
        SECOND_U.iter().zip(SECOND_V).any(|(u, v)| self.is_scalar(u) && self.is_scalar(v))
    }

    pub fn has_corners(&self) -> bool {
        CORNERS
            .iter()
            .any(|name| self.0.properties.get(*name).is_some_and(|property| matches!(property.data_type, PropertyType::List(..))))
    }

    /// Its faces have numbers in place of materials.
    pub fn has_groups(&self) -> bool {
        GROUPS.iter().any(|name| self.is_scalar(name))
    }

    /// The attributes that its properties of other names are, in their order: a name, and where its channels, one or three, stand among them.
    pub fn attributes(&self, used: &[&str]) -> Vec<(String, Vec<usize>)> {
        let mut attributes: Vec<(String, Vec<usize>)> = Vec::new();
        let rest = self.0.properties.iter().filter(|(name, _)| !used.contains(&name.as_str()));
        for (place, (name, property)) in rest.enumerate() {
            if !matches!(property.data_type, PropertyType::Scalar(_)) {
                continue;
            }
            let name = match name.as_str() {
                "r" | "g" | "b" | "red" | "green" | "blue" => "color",
                name => name.rsplit_once('_').filter(|(_, channel)| channel.len() == 1).map_or(name, |(name, _)| name),
            };
            match attributes.iter_mut().find(|(known, _)| known == name) {
                Some((_, places)) => places.push(place),
                None => attributes.push((name.to_owned(), vec![place])),
            }
        }
        attributes
    }

    /// Names of its properties that nothing is made of.
    pub fn without_effect<'b>(&'b self, used: &'b [&'b str]) -> impl Iterator<Item = String> + 'b {
        let known = move |name: &&String| used.contains(&name.as_str());
        self.0.properties.keys().filter(move |name| !known(name)).map(|name| format!("{} {name}", self.0.name))
    }
}

/// Every name that a vertex's position, normal and texture coordinates have.
pub fn vertex_names() -> Vec<&'static str> {
    [&["x", "y", "z", "nx", "ny", "nz"][..], &U, &V, &SECOND_U, &SECOND_V].concat()
}

pub fn corner_names() -> Vec<&'static str> {
    [CORNERS, GROUPS].concat()
}
