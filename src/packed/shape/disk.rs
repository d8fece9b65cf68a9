//! Disks.

use std::f64::consts::PI;

use glam::{DAffine3, DVec3, Vec3};

use super::element::Element;
use super::placement::Placement;
use crate::math::outward;
use crate::packed::attributes::TriangleAttributes;
use crate::scene;

pub fn add(shape: &scene::Disk, placement: &Placement<'_>, push: &mut dyn FnMut(Disk, Option<TriangleAttributes>, usize)) {
    let (center, normal) = (placement.point(shape.center), placement.normal(shape.normal));
    push(Disk { center, normal, radius: shape.radius * placement.scale() }, None, 0);
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    pub center: DVec3,
    pub normal: DVec3,
    pub radius: f64,
}

impl Element for Disk {
    fn moved(&self, map: &DAffine3) -> Self {
        let scale = map.matrix3.x_axis.length();
        Self {
            center: map.transform_point3(self.center),
            normal: map.transform_vector3(self.normal) / scale,
            radius: self.radius * scale,
        }
    }

    fn bounds(&self) -> Option<(Vec3, Vec3)> {
        self.extent().map(|[low, high]| outward(low, high))
    }

    fn extent(&self) -> Option<[DVec3; 2]> {
        let reach = (DVec3::ONE - self.normal * self.normal).max(DVec3::ZERO).map(f64::sqrt) * self.radius;
        Some([self.center - reach, self.center + reach])
    }

    fn area(&self) -> f64 {
        PI * self.radius * self.radius
    }

    /// Center; normal; (radius, 0, 0).
    fn points(&self) -> [Vec3; 3] {
        [self.center.as_vec3(), self.normal.as_vec3(), Vec3::new(self.radius as f32, 0.0, 0.0)]
    }

    /// Center and two perpendicular radii.
    fn light(&self) -> Option<(f64, [DVec3; 3])> {
        let [tangent, bitangent] = frame(self.normal);
        Some((self.area(), [self.center, tangent * self.radius, bitangent * self.radius]))
    }
}

/// Orthonormal basis of Duff et al. 2017; `frame_from_normal` in `shaders/core/math.wgsl`.
fn frame(n: DVec3) -> [DVec3; 2] {
    let s = if n.z < -0.2137 { -1.0 } else { 1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    [DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x), DVec3::new(b, s + n.y * n.y * a, -n.y)]
}
