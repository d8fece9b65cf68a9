//! The analytic primitives: their bounds, intersections and points.
//!
//! Every intersection test returns the distance along the ray of the first crossing beyond the ray's origin and before `limit`.

use std::f64::consts::{PI, TAU};

use glam::{DVec2, DVec3};

use super::hierarchy::PreparedRay;
use super::normal_map::Tangents;
use super::ray::{Local, Ray, SurfacePoint};
use super::triangle::Triangle;
use crate::math::Frame;

#[derive(Debug, Clone, PartialEq)]
pub enum Primitive {
    Triangle(Triangle),
    Sphere(Sphere),
    // Boxed, so that the many triangles of a mesh do not pay for the few large primitives.
    Parallelogram(Box<Parallelogram>),
    Disk(Box<Disk>),
}

impl Primitive {
    /// Distance and local coordinates of the closest crossing in (0, limit).
    pub fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        match self {
            Self::Triangle(triangle) => triangle.intersect(ray, limit),
            Self::Sphere(sphere) => sphere.intersect(&ray.ray, limit).map(|distance| (distance, Local::ZERO)),
            Self::Parallelogram(parallelogram) => parallelogram.intersect(&ray.ray, limit),
            Self::Disk(disk) => disk.intersect(&ray.ray, limit).map(|distance| (distance, Local::ZERO)),
        }
    }

    /// The point a ray meets after `distance`, taken back onto the primitive.
    pub fn point(&self, ray: &Ray, distance: f64, local: Local) -> SurfacePoint {
        match self {
            Self::Triangle(triangle) => triangle.point(local),
            Self::Sphere(sphere) => sphere.point(ray.at(distance)),
            Self::Parallelogram(parallelogram) => parallelogram.point(local),
            Self::Disk(disk) => disk.point(ray.at(distance)),
        }
    }

    pub fn area(&self) -> f64 {
        match self {
            Self::Triangle(triangle) => triangle.area(),
            Self::Sphere(sphere) => 4.0 * PI * sphere.radius * sphere.radius,
            Self::Parallelogram(parallelogram) => parallelogram.area(),
            Self::Disk(disk) => PI * disk.radius * disk.radius,
        }
    }

    /// Lower and upper corner of the axis-aligned bounding box.
    pub fn bounds(&self) -> [DVec3; 2] {
        match self {
            Self::Triangle(triangle) => triangle.bounds(),
            Self::Sphere(sphere) => [sphere.center - sphere.radius, sphere.center + sphere.radius],
            Self::Parallelogram(parallelogram) => parallelogram.bounds(),
            Self::Disk(disk) => disk.bounds(),
        }
    }
}

/// Normal outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sphere {
    pub center: DVec3,
    pub radius: f64,
}

impl Sphere {
    /// Roots of |o + t·d − c|² = r² with the discriminant taken from the chord's distance to the centre, which keeps its precision
    /// for small spheres far away (Haines et al. 2019), and the smaller root from the product of both.
    pub fn intersect(&self, ray: &Ray, limit: f64) -> Option<f64> {
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
        let (near, far) = if first < second { (first, second) } else { (second, first) };
        [near, far].into_iter().find(|&distance| distance > 0.0).filter(|&distance| distance < limit)
    }

    /// The point of the sphere in the direction of `near`.
    pub fn point(&self, near: DVec3) -> SurfacePoint {
        let normal = (near - self.center).normalize();
        SurfacePoint::new(self.center + normal * self.radius, normal, self.center.abs().max_element() + self.radius)
    }

    /// u = atan2(x, −z)/2π (mod 1), v = acos(−y)/π, of a direction from the centre in the sphere's own space.
    pub fn uv(direction: DVec3) -> DVec2 {
        let u = (direction.x.atan2(-direction.z) / TAU).rem_euclid(1.0);
        DVec2::new(u, (-direction.y).clamp(-1.0, 1.0).acos() / PI)
    }
}

/// Rectangles and the faces of boxes. The front is where `edge_u` × `edge_v` points.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Parallelogram {
    pub corner: DVec3,
    pub edge_u: DVec3,
    pub edge_v: DVec3,
    pub normal: DVec3,
    /// The first edge runs backwards, to keep the front in front under a reflection; texture coordinates undo that.
    pub reversed: bool,
    /// Dual basis: the coordinate along edge_u is the offset from the corner dotted with `dual_u`, and so for v.
    dual_u: DVec3,
    dual_v: DVec3,
    /// How far beyond its borders it reaches, in its own coordinates: enough for rounding to leave no gap between two that share
    /// an edge.
    slack: DVec2,
}

impl Parallelogram {
    /// Corner and edges as transformed, by a reflection or not. None where the area is zero.
    pub fn new(corner: DVec3, edge_u: DVec3, edge_v: DVec3, reversed: bool) -> Option<Self> {
        let (corner, edge_u) = if reversed { (corner + edge_u, -edge_u) } else { (corner, edge_u) };
        let cross = edge_u.cross(edge_v);
        let squared = cross.length_squared();
        let (dual_u, dual_v) = (edge_v.cross(cross) / squared, cross.cross(edge_u) / squared);
        let rounding = 32.0 * f64::EPSILON * (corner.abs() + edge_u.abs() + edge_v.abs()).max_element();
        (squared > 0.0 && squared.is_finite()).then(|| Self {
            corner,
            edge_u,
            edge_v,
            normal: cross.normalize(),
            reversed,
            dual_u,
            dual_v,
            slack: DVec2::new(dual_u.length(), dual_v.length()) * rounding,
        })
    }

    pub fn intersect(&self, ray: &Ray, limit: f64) -> Option<(f64, Local)> {
        let distance = ray.distance_to_plane(self.corner, self.normal, limit)?;
        let offset = ray.at(distance) - self.corner;
        let local = DVec2::new(offset.dot(self.dual_u), offset.dot(self.dual_v));
        let inside = local.cmpge(-self.slack) & local.cmple(DVec2::ONE + self.slack);
        inside.all().then_some((distance, local))
    }

    pub fn point(&self, local: Local) -> SurfacePoint {
        let position = self.corner + self.edge_u * local.x + self.edge_v * local.y;
        let magnitude = (self.corner.abs() + self.edge_u.abs() + self.edge_v.abs()).max_element();
        SurfacePoint::new(position, self.normal, magnitude)
    }

    pub fn tangents(&self) -> Tangents {
        Tangents { along_u: if self.reversed { -self.edge_u } else { self.edge_u }, along_v: self.edge_v }
    }

    /// (0, 0) at the corner, u along the first edge as written.
    pub fn uv(&self, local: Local) -> DVec2 {
        if self.reversed { DVec2::new(1.0 - local.x, local.y) } else { local }
    }

    pub fn area(&self) -> f64 {
        self.edge_u.cross(self.edge_v).length()
    }

    fn bounds(&self) -> [DVec3; 2] {
        let zero = DVec3::ZERO;
        let low = self.corner + self.edge_u.min(zero) + self.edge_v.min(zero);
        [low, self.corner + self.edge_u.max(zero) + self.edge_v.max(zero)]
    }
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disk {
    pub center: DVec3,
    pub radius: f64,
    pub frame: Frame,
}

impl Disk {
    fn intersect(&self, ray: &Ray, limit: f64) -> Option<f64> {
        ray.distance_to_plane(self.center, self.frame.normal, limit)
            .filter(|&distance| (ray.at(distance) - self.center).length_squared() <= self.radius * self.radius)
    }

    /// `near` projected onto the disk's plane.
    pub fn point(&self, near: DVec3) -> SurfacePoint {
        let normal = self.frame.normal;
        let position = near - normal * (near - self.center).dot(normal);
        SurfacePoint::new(position, normal, self.center.abs().max_element() + self.radius)
    }

    fn bounds(&self) -> [DVec3; 2] {
        // A disk reaches r·√(1 − n²) along an axis whose cosine with the normal is n (Quilez).
        let n = self.frame.normal;
        let reach = self.radius * (DVec3::ONE - n * n).max(DVec3::ZERO).map(f64::sqrt);
        [self.center - reach, self.center + reach]
    }
}

/// Infinite, so outside the bounding volume hierarchy.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Plane {
    pub point: DVec3,
    pub normal: DVec3,
}

impl Plane {
    pub fn intersect(&self, ray: &Ray, limit: f64) -> Option<f64> {
        ray.distance_to_plane(self.point, self.normal, limit)
    }

    /// `near` projected onto the plane.
    pub fn point(&self, near: DVec3) -> SurfacePoint {
        let position = near - self.normal * (near - self.point).dot(self.normal);
        SurfacePoint::new(position, self.normal, self.point.abs().max(near.abs()).max_element())
    }
}
