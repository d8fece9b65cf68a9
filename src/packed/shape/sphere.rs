//! Spheres.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::element::Element;
use super::placement::Placement;
use crate::emission_map::Unrolled;
use crate::math::outward;
use crate::packed::attributes::TriangleAttributes;
use crate::scene;

/// Texture coordinates need the rotation into the sphere's own space.
pub fn add(shape: &scene::Sphere, placement: &Placement<'_>, push: &mut dyn FnMut(Sphere, Option<TriangleAttributes>, usize)) {
    let attributes = placement.is_textured(0).then(|| {
        let to_local = placement.to_world.matrix3.inverse().transpose();
        let rows = to_local.to_cols_array_2d().map(|row| DVec3::from(row).normalize().as_vec3());
        TriangleAttributes::new(rows, [Vec2::ZERO; 3])
    });
    push(Sphere { center: placement.point(shape.center), radius: shape.radius * placement.scale() }, attributes, 0);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
}

impl Element for Sphere {
    const UNROLLED: Option<Unrolled> = Some(Unrolled::Sphere);

    fn moved(&self, map: &DAffine3) -> Self {
        Self { center: map.transform_point3(self.center), radius: self.radius * map.matrix3.x_axis.length() }
    }

    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.extent().map(|[low, high]| outward(low, high))
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        Some([self.center - self.radius, self.center + self.radius])
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    /// Center; (radius, 0, 0); nothing.
    fn points(&self) -> [Vec3; 3] {
        [self.center.as_vec3(), Vec3::new(self.radius as f32, 0.0, 0.0), Vec3::ZERO]
    }

    /// Its radius and its center.
    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        Some((self.radius, [self.center, DVec3::ZERO, DVec3::ZERO]))
    }

    fn light_normal(&self) -> Option<DVec3> {
        None
    }
}
