//! `type = "rectangle"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located, Vector, vector};
use crate::load::file::writer::{self, Writer, line};
use crate::load::place::Place;
use crate::scene::{Rectangle, Shape};

shape_keys! {
    /// A parallelogram; its front is where edge_u × edge_v points.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "RectangleShape" { corner: Vector, edge_u: Located<Vector>, edge_v: Located<Vector> }
}

impl Keys {
    /// A rectangle by its corner and its edges.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of([corner, edge_u, edge_v]: [DVec3; 3], place: &Place) -> Result<Self, String> {
        let corner = Exactly::of(corner.to_array())?;
        let [edge_u, edge_v] = [Exactly::of(edge_u.to_array())?, Exactly::of(edge_v.to_array())?].map(|edge| place.at(edge));
        Ok(plain_keys!(corner: corner, edge_u: edge_u, edge_v: edge_v))
    }
}

impl ShapeKeys for Keys {
    type Shape = Rectangle;

    const EXAMPLES: &'static [&'static str] =
        &["corner = [-0.8, -0.7, 0.3]\nedge_u = [1.5, 0.2, 0.1]\nedge_v = [0.1, 1.4, -0.3]"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Rectangle, SceneError> {
        let (edge_u, edge_v) = (vector(self.edge_u.value), vector(self.edge_v.value));
        if edge_u.cross(edge_v).length() <= 1e-9 * edge_u.length() * edge_v.length() {
            return Err(resolver.error(&self.edge_v.place, "the rectangle has no area: its edges are parallel or of length 0"));
        }
        Ok(Rectangle { corner: vector(self.corner), edge_u, edge_v })
    }

    fn outline(&self) -> Vec<DVec3> {
        let [corner, u, v] = [self.corner, self.edge_u.value, self.edge_v.value].map(vector);
        vec![corner, corner + u, corner + v, corner + u + v]
    }

    fn write(rectangle: &Rectangle, shape: &Shape, writer: &mut Writer<'_>) -> String {
        [
            line("corner", &writer::vector(rectangle.corner)),
            line("edge_u", &writer::vector(rectangle.edge_u)),
            line("edge_v", &writer::vector(rectangle.edge_v)),
            writer.material_of(shape),
        ]
        .concat()
    }
}
