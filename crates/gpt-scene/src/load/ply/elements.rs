//! The meaning of the properties of a PLY file's elements, by the names that programs give them.

use glam::Vec3;

use super::header::{Element, Kind};
use crate::load::model::MeshAttribute;

/// Names of the texture coordinates.
const U: [&str; 5] = ["u", "s", "texture_u", "texture_s", "texcoord_u"];
const V: [&str; 5] = ["v", "t", "texture_v", "texture_t", "texcoord_v"];
/// Names of the second texture coordinates.
const SECOND_U: [&str; 4] = ["u1", "s1", "texture_u1", "texture_s1"];
const SECOND_V: [&str; 4] = ["v1", "t1", "texture_v1", "texture_t1"];
const POSITIONS: [[&str; 1]; 3] = [["x"], ["y"], ["z"]];
const NORMALS: [[&str; 3]; 3] = [["nx", "normal_x", "normalx"], ["ny", "normal_y", "normaly"], ["nz", "normal_z", "normalz"]];
/// Names of a face's or a strip's corners.
const CORNERS: [&str; 2] = ["vertex_indices", "vertex_index"];
/// Names of the number that a face has in place of a material.
const GROUPS: [&str; 2] = ["material_index", "material_indices"];

/// The use that a property is put to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Role {
    /// A coordinate of the position.
    Position(usize),
    Normal(usize),
    Uv(usize),
    SecondUv(usize),
    Corners,
    /// Stands for a material.
    Group,
    /// One of the numbers beside those that make a mesh.
    Attribute(usize),
    Nothing,
}

/// The roles of an element's properties.
pub struct Roles {
    pub of: Vec<Role>,
    pub rest: Rest,
    /// Names of properties that nothing is made of.
    pub without_effect: Vec<String>,
}

impl Roles {
    /// The roles of vertices' properties; `with_rest` makes attributes of properties by other names.
    pub fn of_vertices(element: &Element, with_rest: bool) -> Self {
        let role = |name: &str| {
            let among = |lists: &[&[&str]]| lists.iter().position(|names| names.contains(&name));
            among(&POSITIONS.each_ref().map(|names| &names[..]))
                .map(Role::Position)
                .or_else(|| among(&NORMALS.each_ref().map(|names| &names[..])).map(Role::Normal))
                .or_else(|| among(&[&U, &V]).map(Role::Uv))
                .or_else(|| among(&[&SECOND_U, &SECOND_V]).map(Role::SecondUv))
        };
        Self::new(element, with_rest, |name, kind| role(name).filter(|_| matches!(kind, Kind::Scalar(_))))
    }

    /// The roles of the properties of faces and strips.
    pub fn of_faces(element: &Element, with_rest: bool) -> Self {
        Self::new(element, with_rest, |name, kind| match kind {
            Kind::List { .. } => CORNERS.contains(&name).then_some(Role::Corners),
            Kind::Scalar(_) => GROUPS.contains(&name).then_some(Role::Group),
        })
    }

    fn new(element: &Element, with_rest: bool, role: impl Fn(&str, Kind) -> Option<Role>) -> Self {
        let mut roles = Self { of: Vec::new(), rest: Rest::default(), without_effect: Vec::new() };
        for property in &element.properties {
            let known = role(&property.name, property.kind);
            roles.of.push(match (known, property.kind) {
                (Some(role), _) => role,
                (None, Kind::Scalar(_)) if with_rest => Role::Attribute(roles.rest.declare(&property.name)),
                (None, _) => {
                    roles.without_effect.extend((!with_rest).then(|| format!("{} {}", element.name, property.name)));
                    Role::Nothing
                }
            });
        }
        roles.rest.end_of_declarations();
        roles
    }

    /// Each of these is the role of some property.
    pub fn has(&self, roles: &[Role]) -> bool {
        roles.iter().all(|role| self.of.contains(role))
    }
}

/// Numbers of an element beside those that make a mesh.
#[derive(Default)]
pub struct Rest {
    /// Names, and where the channels stand.
    declared: Vec<(String, Vec<usize>)>,
    values: Vec<Vec<Vec3>>,
    count: usize,
}

impl Rest {
    /// Adds a property, a channel of an attribute, and gives its place among them.
    fn declare(&mut self, name: &str) -> usize {
        let name = match name {
            "r" | "g" | "b" | "red" | "green" | "blue" => "color",
            name => name.rsplit_once('_').filter(|(_, channel)| channel.len() == 1).map_or(name, |(name, _)| name),
        };
        match self.declared.iter_mut().find(|(known, _)| known == name) {
            Some((_, places)) => places.push(self.count),
            None => self.declared.push((name.to_owned(), vec![self.count])),
        }
        self.count += 1;
        self.count - 1
    }

    /// Attributes that have neither one channel nor three, nor four of which the last is no colour, are left out.
    fn end_of_declarations(&mut self) {
        self.declared.retain(|(_, places)| matches!(places.len(), 1 | 3 | 4));
        self.values = vec![Vec::new(); self.declared.len()];
    }

    /// How many numbers an element has.
    pub fn count(&self) -> usize {
        self.count
    }

    pub fn push(&mut self, numbers: &[f32]) {
        for ((_, places), values) in self.declared.iter().zip(&mut self.values) {
            let channel = |number: usize| {
                let place = places.get(number).or(places.first());
                place.and_then(|&place| numbers.get(place)).copied().filter(|number| number.is_finite()).unwrap_or_default()
            };
            values.push(Vec3::new(channel(0), channel(1), channel(2)));
        }
    }

    pub fn attributes(self, of_faces: bool) -> impl Iterator<Item = MeshAttribute> {
        let named = self.declared.into_iter().zip(self.values);
        named.map(move |((name, _), values)| MeshAttribute { name, of_faces, values })
    }
}
