//! `type = "plane"`

use super::keys::{ShapeKeys, Written, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, Vector, vector};
use crate::load::file::writer::{self, Writer, direction, line};
use crate::scene::{Plane, Shape};

shape_keys! {
    /// Infinite.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "PlaneShape" { point: Vector, normal: Located<Vector> }
}

impl ShapeKeys for Keys {
    type Shape = Plane;

    const EXAMPLES: &'static [&'static str] = &["point = [0, -0.6, 0]\nnormal = [0.1, 1, 0.2]"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Plane, SceneError> {
        Ok(Plane { point: vector(self.point), normal: resolver.direction(&self.normal)? })
    }

    fn write(plane: &Plane, shape: &Shape, writer: &mut Writer<'_>) -> String {
        line("point", &writer::vector(plane.point)) + &line("normal", &direction(plane.normal)) + &writer.material_of(shape)
    }
}
