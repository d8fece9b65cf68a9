//! `type = "cylinder"`

use glam::DVec3;

use super::keys::{ShapeKeys, Written, around_ball, plain_keys, shape_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Exactly, Located, Positive, Vector, vector};
use crate::load::file::writer::{self, Writer, line, number};
use crate::load::place::Place;
use crate::scene::{Cylinder, Shape};

shape_keys! {
    /// The wall of a tube without caps, the normal outward. u goes round the axis, from the side of −z, or of +x where the axis runs along z;
    /// v goes from 0 at `from` to 1 at `to`.
    #[schemars(extend("allOf" = [{ "required": ["material"] }]))]
    "CylinderShape" {
        /// One end of the axis.
        from: Vector,
        /// The other end.
        to: Located<Vector>,
        radius: Checked<Positive>,
    }
}

impl Keys {
    /// A cylinder between two ends.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(from: DVec3, to: DVec3, radius: f64, place: &Place) -> Result<Self, String> {
        let to = place.at(Exactly::of(to.to_array())?);
        Ok(plain_keys!(from: Exactly::of(from.to_array())?, to: to, radius: Checked::of(radius)?))
    }
}

impl ShapeKeys for Keys {
    type Shape = Cylinder;

    const EXAMPLES: &'static [&'static str] = &["from = [0.1, -0.8, 0]\nto = [-0.2, 0.7, 0.3]\nradius = 0.6"];

    fn resolve(&self, resolver: &mut Resolver<'_>, _: &mut Written<'_>) -> Result<Cylinder, SceneError> {
        let (from, to) = (vector(self.from), vector(self.to.value));
        if (to - from).length() == 0.0 {
            return Err(resolver.error(&self.to.place, "the cylinder has no length: `from` and `to` are the same point"));
        }
        Ok(Cylinder { from, to, radius: self.radius.0 })
    }

    fn outline(&self) -> Vec<DVec3> {
        let ends = [self.from, self.to.value].map(vector);
        ends.into_iter().flat_map(|end| around_ball(end, self.radius.0)).collect()
    }

    fn write(cylinder: &Cylinder, shape: &Shape, writer: &mut Writer<'_>) -> String {
        [
            line("from", &writer::vector(cylinder.from)),
            line("to", &writer::vector(cylinder.to)),
            line("radius", &number(cylinder.radius)),
            writer.material_of(shape),
        ]
        .concat()
    }
}
