//! Elements of PLY files as the parser fills them.

use ply_rs_bw::ply::{ElementDef, Property, PropertyAccess, PropertyAccessResult, PropertyType};

/// Stands for an index below 0, which begins a new strip, and for one that no vertex can have.
pub const NO_VERTEX: u32 = u32::MAX;
/// Stands for a number below 0 in place of a material.
const NO_GROUP: u32 = u32::MAX;

/// Names of the texture coordinates, as programs write them.
const U: [&str; 4] = ["u", "s", "texture_u", "texture_s"];
const V: [&str; 4] = ["v", "t", "texture_v", "texture_t"];
/// Names of a face's or a strip's corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];

/// What a vertex says.
#[derive(Debug, Default)]
pub struct Vertex {
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub uv: [f32; 2],
}

impl Vertex {
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
            _ => return PropertyAccessResult::Ignored,
        };
        *slot = value;
        PropertyAccessResult::Set
    }
}

impl PropertyAccess for Vertex {
    fn new() -> Self {
        Self::default()
    }

    fn set_property(&mut self, name: &str, property: Property) -> PropertyAccessResult {
        property.to_f32_lossy().map_or(PropertyAccessResult::Ignored, |value| self.set(name, value))
    }

    fn set_float(&mut self, name: &str, value: f32) -> PropertyAccessResult {
        self.set(name, value)
    }
}

/// Names of the number that a face has in place of a material.
const GROUPS: [&str; 2] = ["material_index", "material_indices"];

/// A polygon or a strip of triangles.
#[derive(Debug, Default)]
pub struct Corners {
    /// Indices of vertices.
    pub corners: Vec<u32>,
    /// What stands for its material.
    pub group: u32,
}

impl PropertyAccess for Corners {
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

    pub fn has_corners(&self) -> bool {
        CORNERS
            .iter()
            .any(|name| self.0.properties.get(*name).is_some_and(|property| matches!(property.data_type, PropertyType::List(..))))
    }

    /// Its faces have numbers in place of materials.
    pub fn has_groups(&self) -> bool {
        GROUPS.iter().any(|name| self.is_scalar(name))
    }

    /// Names of its properties that nothing is made of.
    pub fn without_effect<'b>(&'b self, used: &'b [&'b str]) -> impl Iterator<Item = String> + 'b {
        let known = move |name: &&String| used.contains(&name.as_str());
        self.0.properties.keys().filter(move |name| !known(name)).map(|name| format!("{} {name}", self.0.name))
    }
}

/// Every name that a vertex's position, normal and texture coordinates have.
pub fn vertex_names() -> Vec<&'static str> {
    [&["x", "y", "z", "nx", "ny", "nz"][..], &U, &V].concat()
}

pub fn corner_names() -> Vec<&'static str> {
    [CORNERS, GROUPS].concat()
}
