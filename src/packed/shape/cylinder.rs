//! Cylinders.

use std::f64::consts::TAU;

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::element::Element;
use super::placement::Placement;
use super::rectangle::QUAD_OVERLAP;
use crate::emission_map::Unrolled;
use crate::math::outward;
use crate::packed::attributes::TriangleAttributes;
use crate::scene;

/// A mirroring transform turns the sense of u round; texture coordinates then need the way back.
pub fn add(
    shape: &scene::Cylinder,
    placement: &Placement<'_>,
    push: &mut dyn FnMut(Cylinder, Option<TriangleAttributes>, usize),
) {
    let attributes = (placement.shape.is_mirrored() && placement.is_textured(0))
        .then(|| TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::new(1.0, 0.0), Vec2::ZERO, Vec2::ONE]));
    let cylinder = Cylinder {
        from: placement.point(shape.from),
        axis: placement.vector(shape.to - shape.from),
        radial: placement.vector(shape.first_direction() * shape.radius),
    };
    push(cylinder, attributes, 0);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    pub from: DVec3,
    /// To the other end.
    pub axis: DVec3,
    /// From the axis to where u is 0, as long as the radius.
    pub radial: DVec3,
}

impl Element for Cylinder {
    const UNROLLED: Option<Unrolled> = Some(Unrolled::Evenly);

    fn moved(&self, map: &DAffine3) -> Self {
        Self {
            from: map.transform_point3(self.from),
            axis: map.transform_vector3(self.axis),
            radial: map.transform_vector3(self.radial),
        }
    }

    /// A circle reaches r·√(1 − a²) along an axis whose cosine with the cylinder's is a (Quilez). Ends overlap what they meet as quads do.
    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let overlap = self.axis.abs() * (2.0 * f64::from(QUAD_OVERLAP));
        self.extent().map(|[low, high]| outward(low - overlap, high + overlap))
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        let along = self.axis.normalize();
        let reach = (DVec3::ONE - along * along).max(DVec3::ZERO).map(f64::sqrt) * self.radial.length();
        let to = self.from + self.axis;
        Some([self.from.min(to) - reach, self.from.max(to) + reach])
    }

    fn area(&self) -> f64 {
        TAU * self.radial.length() * self.axis.length()
    }

    /// One end, the axis, and a radius.
    fn points(&self) -> [Vec3; 3] {
        [self.from, self.axis, self.radial].map(|point| point.as_vec3())
    }

    /// One end, the axis, and a radius.
    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        Some((self.area(), [self.from, self.axis, self.radial]))
    }

    fn light_normal(&self) -> Option<DVec3> {
        None
    }
}
