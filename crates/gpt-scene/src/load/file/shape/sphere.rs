//! `type = "sphere"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, around_ball, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Exactly, Positive, Vector, vector};
use crate::load::file::writer::{self, Writer, line, number};
use crate::scene::{Shape, Sphere};

shape_keys! {
    /// The normal points outward.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "SphereShape" { center: Vector, radius: Checked<Positive> }
}

impl Keys {
    /// A sphere.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(center: DVec3, radius: f64) -> Result<Self, String> {
        Ok(plain_keys!(center: Exactly::of(center.to_array())?, radius: Checked::of(radius)?))
    }
}

impl ShapeKeys for Keys {
    type Shape = Sphere;

    const EXAMPLES: &'static [&'static str] = &["center = [0.1, 0, -0.1]\nradius = 0.8"];

    fn resolve(&self, _: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Sphere, SceneError> {
        Ok(Sphere { center: vector(self.center), radius: self.radius.0 })
    }

    fn outline(&self) -> Vec<DVec3> {
        around_ball(vector(self.center), self.radius.0)
    }

    fn write(sphere: &Sphere, shape: &Shape, writer: &mut Writer<'_>) -> String {
        line("center", &writer::vector(sphere.center)) + &line("radius", &number(sphere.radius)) + &writer.material_of(shape)
    }
}
