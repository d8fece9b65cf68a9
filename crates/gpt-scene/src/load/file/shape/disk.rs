//! `type = "disk"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, around_ball, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Exactly, Located, Positive, Vector, vector};
use crate::load::file::writer::{self, Writer, direction, line, number};
use crate::load::place::Place;
use crate::scene::{Disk, Shape};

shape_keys! {
    /// A flat disk.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "DiskShape" { center: Vector, normal: Located<Vector>, radius: Checked<Positive> }
}

impl Keys {
    /// A disk.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(center: DVec3, normal: DVec3, radius: f64, place: &Place) -> Result<Self, String> {
        let normal = place.at(Exactly::of(normal.to_array())?);
        Ok(plain_keys!(center: Exactly::of(center.to_array())?, normal: normal, radius: Checked::of(radius)?))
    }
}

impl ShapeKeys for Keys {
    type Shape = Disk;

    const EXAMPLES: &'static [&'static str] = &["center = [0.1, 0, 0]\nnormal = [0.3, 0.5, 1]\nradius = 0.8"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Disk, SceneError> {
        Ok(Disk { center: vector(self.center), normal: resolver.direction(&self.normal)?, radius: self.radius.0 })
    }

    fn outline(&self) -> Vec<DVec3> {
        around_ball(vector(self.center), self.radius.0)
    }

    fn write(disk: &Disk, shape: &Shape, writer: &mut Writer<'_>) -> String {
        [
            line("center", &writer::vector(disk.center)),
            line("normal", &direction(disk.normal)),
            line("radius", &number(disk.radius)),
            writer.material_of(shape),
        ]
        .concat()
    }
}
