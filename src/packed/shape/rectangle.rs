//! Rectangles, and the quads that boxes are made of as well.

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::element::Element;
use super::placement::Placement;
use crate::emission_map::Unrolled;
use crate::math::outward;
use crate::packed::attributes::TriangleAttributes;
use crate::scene::Rectangle;
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Quads overlap their neighbours by this share of their edges.
    pub(super) const QUAD_OVERLAP: f32 = 1.0e-6;
});

pub fn add(shape: &Rectangle, placement: &Placement<'_>, push: &mut dyn FnMut(Quad, Option<TriangleAttributes>, usize)) {
    let (quad, attributes) = Quad::placed([shape.corner, shape.edge_u, shape.edge_v], placement);
    push(quad, attributes, 0);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quad {
    pub corner: DVec3,
    pub edge_u: DVec3,
    pub edge_v: DVec3,
}

impl Quad {
    /// Corner and edges in the shape's own space. A mirroring transform would turn fronts into backs; walking along edge u the other way
    /// keeps them, and texture coordinates then need the way back.
    pub fn placed([corner, edge_u, edge_v]: [DVec3; 3], placement: &Placement<'_>) -> (Self, Option<TriangleAttributes>) {
        let mirrored = placement.shape.is_mirrored();
        let (corner, edge_u) = if mirrored { (corner + edge_u, -edge_u) } else { (corner, edge_u) };
        let attributes = (mirrored && placement.is_textured(0))
            .then(|| TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::new(1.0, 0.0), Vec2::ZERO, Vec2::ONE]));
        let placed = Self { corner: placement.point(corner), edge_u: placement.vector(edge_u), edge_v: placement.vector(edge_v) };
        (placed, attributes)
    }
}

impl Element for Quad {
    const UNROLLED: Option<Unrolled> = Some(Unrolled::Evenly);

    fn moved(&self, map: &DAffine3) -> Self {
        Self {
            corner: map.transform_point3(self.corner),
            edge_u: map.transform_vector3(self.edge_u),
            edge_v: map.transform_vector3(self.edge_v),
        }
    }

    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        let overlap = (self.edge_u.abs() + self.edge_v.abs()) * (2.0 * f64::from(QUAD_OVERLAP));
        self.extent().map(|[low, high]| outward(low - overlap, high + overlap))
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        let Self { corner, edge_u, edge_v } = *self;
        let zero = DVec3::ZERO;
        let low = edge_u.min(zero) + edge_v.min(zero);
        let high = edge_u.max(zero) + edge_v.max(zero);
        Some([corner + low, corner + high])
    }

    fn area(&self) -> f64 {
        self.edge_u.cross(self.edge_v).length()
    }

    /// Corner and edges.
    fn points(&self) -> [Vec3; 3] {
        [self.corner, self.edge_u, self.edge_v].map(|point| point.as_vec3())
    }

    /// Corner and edges.
    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        Some((self.area(), [self.corner, self.edge_u, self.edge_v]))
    }
}
