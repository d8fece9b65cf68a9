//! `type = "plane"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located, Vector, vector};
use crate::load::file::writer::{self, Writer, direction, line};
use crate::load::place::Place;
use crate::scene::{Plane, Shape};

shape_keys! {
    /// Infinite.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "PlaneShape" { point: Vector, normal: Located<Vector> }
}

impl Keys {
    /// A plane.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(point: DVec3, normal: DVec3, place: &Place) -> Result<Self, String> {
        let normal = place.at(Exactly::of(normal.to_array())?);
        Ok(plain_keys!(point: Exactly::of(point.to_array())?, normal: normal))
    }
}

impl ShapeKeys for Keys {
    type Shape = Plane;

    const EXAMPLES: &'static [&'static str] = &["point = [0, -0.6, 0]\nnormal = [0.1, 1, 0.2]"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Plane, SceneError> {
        Ok(Plane { point: vector(self.point), normal: resolver.direction(&self.normal)? })
    }

    fn outline(&self) -> Vec<DVec3> {
        Vec::new()
    }

    fn write(plane: &Plane, shape: &Shape, writer: &mut Writer<'_>) -> String {
        line("point", &writer::vector(plane.point)) + &line("normal", &direction(plane.normal)) + &writer.material_of(shape)
    }
}
