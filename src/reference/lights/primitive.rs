//! Points on emitting primitives and portals, as seen from where the light is wanted.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use crate::math::Frame;
use crate::reference::intersect::{Pose, PreparedRay, Primitive, Ray, Sphere, SurfacePoint};
use crate::reference::warp;
use crate::scene::LightSampling;

/// A direction to a primitive, before its emission is looked up.
pub struct Direction {
    pub wi: DVec3,
    pub distance: f64,
    pub pdf_solid_angle: f64,
    pub point: SurfacePoint,
    pub local: DVec2,
}

/// A point of a primitive, uniform over its area; on spheres as `strategy` says. None where the point cannot be seen from
/// `reference` because the primitive itself is in the way. `pose`: where the primitive has moved to.
pub fn sample_primitive(
    primitive: &Primitive,
    pose: Option<&Pose>,
    strategy: LightSampling,
    reference: DVec3,
    u1: f64,
    u2: f64,
) -> Option<Direction> {
    let (at_rest, local) = match primitive {
        Primitive::Sphere(sphere) => return sample_sphere(&moved(sphere, pose), strategy, reference, u1, u2),
        Primitive::Triangle(triangle) => {
            let local = warp::triangle(u1, u2);
            (triangle.point(local), local)
        }
        Primitive::Parallelogram(parallelogram) => {
            let local = DVec2::new(u1, u2);
            (parallelogram.point(local), local)
        }
        Primitive::Disk(disk) => {
            let p = warp::disk(disk.radius, u1, u2);
            (disk.point(disk.center + disk.frame.to_world(DVec3::new(p.x, p.y, 0.0))), DVec2::ZERO)
        }
    };
    // Motions keep what is uniform over an area uniform.
    let point = pose.map_or(at_rest, |pose| pose.point(&at_rest));
    let to_point = point.position - reference;
    let distance = to_point.length();
    let wi = to_point / distance;
    let pdf_solid_angle = pdf_solid_angle(primitive, pose, strategy, reference, &point);
    (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local })
}

fn moved(sphere: &Sphere, pose: Option<&Pose>) -> Sphere {
    pose.map_or(*sphere, |pose| pose.sphere(sphere))
}

fn sample_sphere(sphere: &Sphere, strategy: LightSampling, reference: DVec3, u1: f64, u2: f64) -> Option<Direction> {
    match strategy {
        LightSampling::Cone => sample_sphere_cone(sphere, reference, u1, u2),
        LightSampling::Visible | LightSampling::Area => sample_sphere_area(sphere, strategy, reference, u1, u2),
    }
}

/// From outside, uniform over the cone of directions that meet the sphere; from inside, uniform over all directions.
fn sample_sphere_cone(sphere: &Sphere, reference: DVec3, u1: f64, u2: f64) -> Option<Direction> {
    let to_center = sphere.center - reference;
    let squared = to_center.length_squared();
    let center_distance = squared.sqrt();
    let radius_squared = sphere.radius * sphere.radius;
    let (wi, distance) = if center_distance > sphere.radius {
        let local = warp::cone(one_minus_cos_max(radius_squared / squared), u1, u2);
        let sin_squared = local.x * local.x + local.y * local.y;
        let half_chord = (radius_squared - squared * sin_squared).max(0.0).sqrt();
        (Frame::around(to_center / center_distance).to_world(local), center_distance * local.z - half_chord)
    } else {
        let wi = warp::uniform_sphere(u1, u2);
        (wi, sphere.intersect(&Ray { origin: reference, direction: wi }, f64::INFINITY)?)
    };
    let point = sphere.point(reference + wi * distance);
    let pdf_solid_angle = sphere_cone_pdf(sphere, reference);
    (distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local: DVec2::ZERO })
}

/// Uniform over the surface: all of it, or the half that faces an outside reference point.
fn sample_sphere_area(sphere: &Sphere, strategy: LightSampling, reference: DVec3, u1: f64, u2: f64) -> Option<Direction> {
    let to_reference = reference - sphere.center;
    let outside = to_reference.length() > sphere.radius;
    let normal = if strategy == LightSampling::Visible && outside {
        Frame::around(to_reference.normalize()).to_world(warp::uniform_hemisphere(u1, u2))
    } else {
        warp::uniform_sphere(u1, u2)
    };
    let point = sphere.point(sphere.center + normal * sphere.radius);
    let to_point = point.position - reference;
    let distance = to_point.length();
    // From outside, the sphere hides its own far side.
    let hidden = outside && to_point.dot(point.normal) >= 0.0;
    let pdf_solid_angle = sphere_pdf(sphere, strategy, reference, &point);
    let wi = to_point / distance;
    (!hidden && distance > 0.0).then_some(Direction { wi, distance, pdf_solid_angle, point, local: DVec2::ZERO })
}

/// Density per steradian with which a point of a primitive is drawn, seen from `reference`.
pub fn pdf_solid_angle(
    primitive: &Primitive,
    pose: Option<&Pose>,
    strategy: LightSampling,
    reference: DVec3,
    point: &SurfacePoint,
) -> f64 {
    if let Primitive::Sphere(sphere) = primitive {
        return sphere_pdf(&moved(sphere, pose), strategy, reference, point);
    }
    let area = primitive.area() * pose.map_or(1.0, |pose| pose.area_factor(point.normal));
    area_to_solid_angle(area, reference, point)
}

/// Uniform over an area: dA·cosθ / d² is the solid angle of dA.
fn area_to_solid_angle(area: f64, reference: DVec3, point: &SurfacePoint) -> f64 {
    let to_point = point.position - reference;
    let squared = to_point.length_squared();
    squared * squared.sqrt() / (to_point.dot(point.normal).abs() * area)
}

fn sphere_pdf(sphere: &Sphere, strategy: LightSampling, reference: DVec3, point: &SurfacePoint) -> f64 {
    let area = 4.0 * PI * sphere.radius * sphere.radius;
    let outside = (sphere.center - reference).length() > sphere.radius;
    match strategy {
        LightSampling::Cone => sphere_cone_pdf(sphere, reference),
        LightSampling::Visible if outside => area_to_solid_angle(0.5 * area, reference, point),
        LightSampling::Visible | LightSampling::Area => area_to_solid_angle(area, reference, point),
    }
}

fn sphere_cone_pdf(sphere: &Sphere, reference: DVec3) -> f64 {
    let squared = (sphere.center - reference).length_squared();
    if squared.sqrt() > sphere.radius {
        warp::cone_pdf(one_minus_cos_max(sphere.radius * sphere.radius / squared))
    } else {
        warp::UNIFORM_SPHERE_PDF
    }
}

/// Density per steradian with which [`sample_primitive`] draws the direction in which `ray` goes from its origin; 0 where the ray does
/// not meet the primitive. On spheres by [`LightSampling::Cone`].
pub fn pdf_of_direction(primitive: &Primitive, ray: &PreparedRay) -> f64 {
    let Some((distance, local)) = primitive.intersect(ray, f64::INFINITY) else { return 0.0 };
    let point = primitive.point(&ray.ray, distance, local);
    pdf_solid_angle(primitive, None, LightSampling::Cone, ray.ray.origin, &point)
}

/// 1 − cosθ from sin²θ, without cancellation.
fn one_minus_cos_max(sin_squared: f64) -> f64 {
    sin_squared / (1.0 + (1.0 - sin_squared).max(0.0).sqrt())
}
