//! `type = "box"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, box_around, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located, Vector, vector};
use crate::load::file::writer::{self, Writer, line};
use crate::load::place::Place;
use crate::scene::{Cuboid, Shape};

shape_keys! {
    /// Axis-aligned before its transform; at most one edge has no length.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "BoxShape" { min: Vector, max: Located<Vector> }
}

impl Keys {
    /// A box between two corners.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(min: DVec3, max: DVec3, place: &Place) -> Result<Self, String> {
        Ok(plain_keys!(min: Exactly::of(min.to_array())?, max: place.at(Exactly::of(max.to_array())?)))
    }
}

impl ShapeKeys for Keys {
    type Shape = Cuboid;

    const EXAMPLES: &'static [&'static str] = &["min = [-0.6, -0.7, -0.5]\nmax = [0.5, 0.6, 0.4]"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Cuboid, SceneError> {
        let (min, max) = (vector(self.min), vector(self.max.value));
        let edges = max - min;
        if edges.min_element() < 0.0 {
            return Err(resolver.error(&self.max.place, "the box's `max` is below its `min`"));
        }
        if edges.to_array().into_iter().filter(|&edge| edge == 0.0).count() > 1 {
            return Err(resolver.error(&self.max.place, "the box has no area: at most one of its edges can have length 0"));
        }
        Ok(Cuboid { min, max })
    }

    fn outline(&self) -> Vec<DVec3> {
        box_around(&[vector(self.min), vector(self.max.value)])
    }

    fn write(cuboid: &Cuboid, shape: &Shape, writer: &mut Writer<'_>) -> String {
        line("min", &writer::vector(cuboid.min)) + &line("max", &writer::vector(cuboid.max)) + &writer.material_of(shape)
    }
}
