//! Spheres.

use std::f64::consts::{PI, TAU};

use glam::{DMat3, DVec2, DVec3};

use super::placement::Placement;
use super::primitive::Primitive;
use crate::emission_map::Unrolled;
use crate::math::Frame;
use crate::reference::intersect::element::{Direction, Element, area_to_solid_angle};
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::normal_map::Tangents;
use crate::reference::intersect::pose::Pose;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::reference::warp;
use crate::scene::{self, LightSampling};

pub fn elements(shape: &scene::Sphere, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let to_local = placement.to_world.matrix3.inverse();
    let center = placement.to_world.transform_point3(shape.center);
    vec![(0, Primitive::of(Sphere { center, radius: shape.radius * placement.scale, to_local }))]
}

/// Normal outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
    /// Takes world directions to the shape's own space, up to a factor.
    pub to_local: DMat3,
}

impl Element for Sphere {
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        self.distance(&ray.ray, limit).map(|distance| (distance, Local::ZERO))
    }

    fn intersect_again(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let [near, far] = self.crossings(&ray.ray)?;
        (near > 0.0 && far < limit).then_some((far, Local::ZERO))
    }

    fn point(&self, ray: &Ray, distance: f64, _: Local) -> SurfacePoint {
        self.towards(ray.at(distance))
    }

    fn area(&self) -> f64 {
        4.0 * PI * self.radius * self.radius
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        Some([self.center - self.radius, self.center + self.radius])
    }

    fn uv(&self, _: Local, normal: DVec3) -> DVec2 {
        uv(self.own_direction(normal))
    }

    fn unrolled(&self) -> Option<Unrolled> {
        Some(Unrolled::Sphere)
    }

    /// The numbers by which [`warp::uniform_sphere`] draws the place.
    fn numbers_of_place(&self, pose: Option<&Pose>, place: DVec2) -> DVec2 {
        let (height, turn) = (2.0 * place.y - 1.0, TAU * place.x);
        let across = (1.0 - height * height).max(0.0).sqrt();
        let own = DVec3::new(across * turn.sin(), height, -across * turn.cos());
        let at_rest = (self.to_local.inverse() * own).normalize_or_zero();
        let normal = pose.map_or(at_rest, |pose| pose.normal(at_rest));
        DVec2::new(0.5 * (1.0 - normal.z), (normal.y.atan2(normal.x) / TAU).rem_euclid(1.0))
    }

    fn tangents(&self, _: Local, normal: DVec3) -> Option<Tangents> {
        let to_world = self.to_local.inverse();
        tangents(self.own_direction(normal)).map(|own| Tangents::along(to_world * own.along_u, to_world * own.along_v))
    }

    fn place(&self, pose: Option<&Pose>, _: f64, _: f64) -> Option<DVec3> {
        Some(self.moved(pose).center)
    }

    /// From outside never to a point of the far side, be the sphere opaque or not: [`Element::pdf`] is 0 there.
    fn sample(
        &self,
        (pose, _): (Option<&Pose>, bool),
        strategy: LightSampling,
        from: DVec3,
        u1: f64,
        u2: f64,
    ) -> Option<Direction> {
        let sphere = self.moved(pose);
        match strategy {
            LightSampling::Cone | LightSampling::Auto => sphere.sample_cone(from, u1, u2),
            LightSampling::Visible | LightSampling::Area => sphere.sample_surface(strategy, from, u1, u2),
        }
    }

    fn sample_through(&self, strategy: LightSampling, from: DVec3, u1: f64, u2: f64) -> Option<Direction> {
        self.sample((None, true), strategy, from, u1, u2)
    }

    fn pdf(&self, pose: Option<&Pose>, strategy: LightSampling, from: DVec3, point: &SurfacePoint) -> f64 {
        self.moved(pose).pdf_at_rest(strategy, from, point)
    }

    fn pdf_through(&self, strategy: LightSampling, ray: &PreparedRay) -> f64 {
        let Some((distance, local)) = self.intersect(ray, f64::INFINITY) else { return 0.0 };
        self.pdf_at_rest(strategy, ray.ray.origin, &self.point(&ray.ray, distance, local))
    }
}

impl Sphere {
    /// The sphere in motion, which scales it by the same factor along every axis.
    fn moved(&self, pose: Option<&Pose>) -> Self {
        pose.map_or(*self, |pose| Self { center: pose.place(self.center), radius: self.radius * pose.scale(), ..*self })
    }

    /// A normal in the shape's own space.
    fn own_direction(&self, normal: DVec3) -> DVec3 {
        (self.to_local * normal).normalize_or_zero()
    }

    /// Roots of |o + t·d − c|² = r² with the discriminant taken from the chord's distance to the centre, which keeps its precision
    /// for small spheres far away (Haines et al. 2019), and the smaller root from the product of both.
    fn crossings(&self, ray: &Ray) -> Option<[f64; 2]> {
        let to_origin = ray.origin - self.center;
        let a = ray.direction.length_squared();
        let b = -to_origin.dot(ray.direction);
        let chord_foot = to_origin + ray.direction * (b / a);
        let discriminant = a * (self.radius * self.radius - chord_foot.length_squared());
        if discriminant < 0.0 {
            return None;
        }
        let c = to_origin.length_squared() - self.radius * self.radius;
        let q = b + discriminant.sqrt().copysign(b);
        let (first, second) = (c / q, q / a);
        Some(if first < second { [first, second] } else { [second, first] })
    }

    /// The first of them ahead of the ray's origin, where it lies before `limit`.
    fn distance(&self, ray: &Ray, limit: f64) -> Option<f64> {
        self.crossings(ray)?.into_iter().find(|&distance| distance > 0.0).filter(|&distance| distance < limit)
    }

    /// The point of the sphere in the direction of `near`.
    fn towards(&self, near: DVec3) -> SurfacePoint {
        let normal = (near - self.center).normalize();
        SurfacePoint::new(self.center + normal * self.radius, normal, self.center.abs().max_element() + self.radius)
    }

    /// From outside, uniform over the cone of directions that meet the sphere; from inside, uniform over all directions.
    fn sample_cone(&self, from: DVec3, u1: f64, u2: f64) -> Option<Direction> {
        let to_center = self.center - from;
        let squared = to_center.length_squared();
        let center_distance = squared.sqrt();
        let radius_squared = self.radius * self.radius;
        let (wi, distance) = if center_distance > self.radius {
            let local = warp::cone(one_minus_cos_max(radius_squared / squared), u1, u2);
            let sin_squared = local.x * local.x + local.y * local.y;
            let half_chord = (radius_squared - squared * sin_squared).max(0.0).sqrt();
            (Frame::around(to_center / center_distance).to_world(local), center_distance * local.z - half_chord)
        } else {
            let wi = warp::uniform_sphere(u1, u2);
            (wi, self.distance(&Ray { origin: from, direction: wi }, f64::INFINITY)?)
        };
        let point = self.towards(from + wi * distance);
        let pdf_solid_angle = self.cone_pdf(from);
        (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local: DVec2::ZERO })
    }

    /// Uniform over the surface: all of it, or the half that faces a point outside.
    fn sample_surface(&self, strategy: LightSampling, from: DVec3, u1: f64, u2: f64) -> Option<Direction> {
        let to_from = from - self.center;
        let outside = to_from.length() > self.radius;
        let normal = if strategy == LightSampling::Visible && outside {
            Frame::around(to_from.normalize()).to_world(warp::uniform_hemisphere(u1, u2))
        } else {
            warp::uniform_sphere(u1, u2)
        };
        let point = self.towards(self.center + normal * self.radius);
        let to_point = point.position - from;
        let distance = to_point.length();
        // From outside, the sphere hides its own far side.
        let hidden = outside && to_point.dot(point.normal) >= 0.0;
        let pdf_solid_angle = self.pdf_at_rest(strategy, from, &point);
        let wi = to_point / distance;
        (!hidden && distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local: DVec2::ZERO })
    }

    fn pdf_at_rest(&self, strategy: LightSampling, from: DVec3, point: &SurfacePoint) -> f64 {
        let area = 4.0 * PI * self.radius * self.radius;
        let outside = (self.center - from).length() > self.radius;
        // A ray that went through the near side has met the far one, to which no direction is drawn.
        if outside && (point.position - from).dot(point.normal) > 0.0 {
            return 0.0;
        }
        match strategy {
            LightSampling::Cone | LightSampling::Auto => self.cone_pdf(from),
            LightSampling::Visible if outside => area_to_solid_angle(0.5 * area, from, point),
            LightSampling::Visible | LightSampling::Area => area_to_solid_angle(area, from, point),
        }
    }

    fn cone_pdf(&self, from: DVec3) -> f64 {
        let squared = (self.center - from).length_squared();
        if squared.sqrt() > self.radius {
            warp::cone_pdf(one_minus_cos_max(self.radius * self.radius / squared))
        } else {
            warp::UNIFORM_SPHERE_PDF
        }
    }
}

/// u = atan2(x, −z)/2π (mod 1), v = acos(−y)/π, of a direction from the centre in the sphere's own space.
fn uv(direction: DVec3) -> DVec2 {
    let u = (direction.x.atan2(-direction.z) / TAU).rem_euclid(1.0);
    DVec2::new(u, (-direction.y).clamp(-1.0, 1.0).acos() / PI)
}

/// The directions in which they grow, in its own space. None at the poles.
fn tangents(direction: DVec3) -> Option<Tangents> {
    let DVec3 { x, y, z } = direction;
    let radius = x.hypot(z);
    (radius > 0.0).then(|| Tangents::along(DVec3::new(-z, 0.0, x), DVec3::new(-y * x / radius, radius, -y * z / radius)))
}

/// 1 − cosθ from sin²θ, without cancellation.
fn one_minus_cos_max(sin_squared: f64) -> f64 {
    sin_squared / (1.0 + (1.0 - sin_squared).max(0.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_spheres_far_away_keep_their_density() {
        // 1 − cosθmax is 5·10⁻¹³ here: formed as a difference it would have lost four digits.
        let sphere = Sphere { center: DVec3::new(0.0, 0.0, 1e6), radius: 1.0, to_local: DMat3::IDENTITY };
        let direction = sphere.sample((None, true), LightSampling::Cone, DVec3::ZERO, 0.99, 0.3).expect("the sphere can be seen");
        let solid_angle = PI * 1e-12;
        assert!((direction.pdf_solid_angle * solid_angle - 1.0).abs() < 1e-9);
        let offset = DVec2::new(direction.wi.x, direction.wi.y).length() * 1e6;
        assert!((offset - 0.99_f64.sqrt()).abs() < 1e-5, "{offset}");
    }

    /// Directions found by moving along the mapping itself.
    #[test]
    fn tangents_follow_the_coordinates() {
        for direction in [DVec3::new(0.3, 0.5, -0.8), DVec3::new(-0.6, -0.7, 0.1)].map(DVec3::normalize) {
            let Tangents { along_u, along_v, .. } = tangents(direction).expect("this is no pole");
            let change = |along: DVec3| {
                let uv = |w: DVec3| super::uv(w.normalize());
                (uv(direction + along * 1e-6) - uv(direction - along * 1e-6)) / 2e-6
            };
            assert!(change(along_u).x > 0.0 && change(along_u).y.abs() < 1e-9);
            assert!(change(along_v).y > 0.0 && change(along_v).x.abs() < 1e-9);
            assert!(along_u.dot(direction).abs() < 1e-15 && along_v.dot(direction).abs() < 1e-15);
        }
        assert_eq!(tangents(DVec3::Y), None);
    }
}
