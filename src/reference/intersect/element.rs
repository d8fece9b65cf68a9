//! Elements, which rays meet: the pieces that shapes are made of.

use std::fmt::Debug;

use glam::{DVec2, DVec3};

use super::hierarchy::PreparedRay;
use super::normal_map::Tangents;
use super::pose::Pose;
use super::ray::{Local, Ray, SurfacePoint};
use super::seen::{Flat, Seen};
use crate::emission_map::Unrolled;
use crate::scene::LightSampling;

/// A direction to an element, before its emission is looked up.
pub struct Direction {
    pub wi: DVec3,
    pub distance: f64,
    pub pdf_solid_angle: f64,
    pub point: SurfacePoint,
    pub local: Local,
}

/// A piece of surface, at rest. What moves is met in its rest space, and brought back by its pose.
pub trait Element: Debug + Send + Sync {
    /// Distance along the ray and local coordinates of the first crossing beyond the ray's origin and before `limit`.
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)>;

    /// The crossing behind the one that [`Element::intersect`] finds, before `limit`. None: there is none, as on what is flat.
    fn intersect_again(&self, _ray: &PreparedRay, _limit: f64) -> Option<(f64, Local)> {
        None
    }

    /// The point a ray meets after `distance`, taken back onto the element.
    fn point(&self, ray: &Ray, distance: f64, local: Local) -> SurfacePoint;

    fn area(&self) -> f64;

    /// Lower and upper corner of the axis-aligned bounding box. None: it is infinite.
    fn bounds(&self) -> Option<[DVec3; 2]>;

    /// Texture coordinates at a point with this normal; 0 where it has none.
    fn uv(&self, _local: Local, _normal: DVec3) -> DVec2 {
        DVec2::ZERO
    }

    /// How texture coordinates cover it, where its points can be drawn by what it shows.
    fn unrolled(&self) -> Option<Unrolled> {
        None
    }

    /// The numbers with which [`Element::sample`] draws, evenly over the area, the point at a `u` above such a share of the area, as it is
    /// [unrolled](Self::unrolled).
    fn numbers_of_place(&self, _pose: Option<&Pose>, place: DVec2) -> DVec2 {
        place
    }

    /// The directions in which they grow.
    fn tangents(&self, _local: Local, _normal: DVec3) -> Option<Tangents> {
        None
    }

    /// A point uniform over the area. None: it has none to be uniform over.
    fn sample_area(&self, _u1: f64, _u2: f64) -> Option<(SurfacePoint, Local)> {
        None
    }

    /// A place that stands for it: a point uniform over the area, or its centre.
    fn place(&self, pose: Option<&Pose>, u1: f64, u2: f64) -> Option<DVec3> {
        let (at_rest, _) = self.sample_area(u1, u2)?;
        Some(pose.map_or(at_rest, |pose| pose.point(&at_rest)).position)
    }

    /// Its normal. None: it is not flat, or infinite.
    fn normal(&self) -> Option<DVec3> {
        self.sample_area(0.5, 0.5).map(|(point, _)| point.normal)
    }

    /// The flat outline of an element whose points can be drawn by solid angle as well as by area, at rest.
    fn flat(&self) -> Option<Flat> {
        None
    }

    /// The element as it is seen from `from`, where its points are drawn by solid angle.
    fn seen(&self, pose: Option<&Pose>, strategy: LightSampling, from: DVec3) -> Option<Seen> {
        if pose.is_some() || strategy != LightSampling::Cone {
            return None;
        }
        self.flat()?.seen_from(from)
    }

    /// A point as it is drawn for light that goes to `from`: uniform over its solid angle or over the area.
    fn sample_seen(
        &self,
        pose: Option<&Pose>,
        strategy: LightSampling,
        from: DVec3,
        u1: f64,
        u2: f64,
    ) -> Option<(SurfacePoint, Local)> {
        let numbers = self.seen(pose, strategy, from).map_or(DVec2::new(u1, u2), |seen| seen.numbers(u1, u2));
        self.sample_area(numbers.x, numbers.y)
    }

    /// By how much drawing such a point magnifies rounding errors of its random numbers, where single precision computes it.
    fn magnifies(&self, pose: Option<&Pose>, strategy: LightSampling, from: DVec3) -> f64 {
        self.seen(pose, strategy, from).map_or(1.0, |seen| seen.magnifies())
    }

    /// Says that the element itself stands between `from` and a point of it.
    fn hides(&self, _from: DVec3, _point: &SurfacePoint) -> bool {
        false
    }

    /// A direction from `from` to a point of it. None where the point cannot be seen from there because the element itself is in the way and
    /// `is_opaque`. `pose`: where it has moved to; `strategy`: how spheres, rectangles and triangles are sampled.
    fn sample(
        &self,
        (pose, is_opaque): (Option<&Pose>, bool),
        strategy: LightSampling,
        from: DVec3,
        u1: f64,
        u2: f64,
    ) -> Option<Direction> {
        let (at_rest, local) = self.sample_seen(pose, strategy, from, u1, u2)?;
        let is_hidden = is_opaque && self.hides(pose.map_or(from, |pose| pose.place_at_rest(from)), &at_rest);
        if is_hidden { None } else { self.towards(pose, strategy, from, &at_rest, local) }
    }

    /// A direction at rest, also to points that the element hides, uniform over the area unless it says otherwise.
    fn sample_through(&self, _strategy: LightSampling, from: DVec3, u1: f64, u2: f64) -> Option<Direction> {
        let (at_rest, local) = self.sample_area(u1, u2)?;
        self.towards(None, LightSampling::Area, from, &at_rest, local)
    }

    /// The direction from `from` to a point.
    fn towards(
        &self,
        pose: Option<&Pose>,
        strategy: LightSampling,
        from: DVec3,
        at_rest: &SurfacePoint,
        local: Local,
    ) -> Option<Direction> {
        // Motions keep what is uniform over an area uniform.
        let point = pose.map_or(*at_rest, |pose| pose.point(at_rest));
        let to_point = point.position - from;
        let distance = to_point.length();
        let wi = to_point / distance;
        let pdf_solid_angle = self.pdf(pose, strategy, from, &point);
        (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local })
    }

    /// Density per steradian with which [`Element::sample`] draws the direction from `from` to a point of it.
    fn pdf(&self, pose: Option<&Pose>, strategy: LightSampling, from: DVec3, point: &SurfacePoint) -> f64 {
        match self.seen(pose, strategy, from) {
            Some(seen) => 1.0 / seen.solid_angle(),
            None => area_to_solid_angle(self.area() * pose.map_or(1.0, |pose| pose.area_factor(point.normal)), from, point),
        }
    }

    /// Density per steradian with which [`Element::sample_through`] draws the direction in which `ray` goes from its origin; 0 where the ray
    /// does not meet it.
    fn pdf_through(&self, _strategy: LightSampling, ray: &PreparedRay) -> f64 {
        let Some((distance, local)) = self.intersect(ray, f64::INFINITY) else { return 0.0 };
        area_to_solid_angle(self.area(), ray.ray.origin, &self.point(&ray.ray, distance, local))
    }
}

/// Uniform over an area: dA·cosθ / d² is the solid angle of dA.
#[inline]
pub fn area_to_solid_angle(area: f64, from: DVec3, point: &SurfacePoint) -> f64 {
    let to_point = point.position - from;
    let squared = to_point.length_squared();
    squared * squared.sqrt() / (to_point.dot(point.normal).abs() * area)
}
