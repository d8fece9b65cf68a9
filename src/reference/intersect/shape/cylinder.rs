//! Cylinders: open tubes.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::placement::Placement;
use super::primitive::Primitive;
use crate::emission_map::Unrolled;
use crate::math::{DIRECTION_ERROR, POINT_ERROR, SHADOW_SHORTENING};
use crate::reference::intersect::element::{Element, area_to_solid_angle};
use crate::reference::intersect::hierarchy::PreparedRay;
use crate::reference::intersect::normal_map::Tangents;
use crate::reference::intersect::pose::Pose;
use crate::reference::intersect::ray::{Local, Ray, SurfacePoint};
use crate::scene::{self, LightSampling};

pub fn elements(shape: &scene::Cylinder, placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
    let linear = placement.to_world.matrix3;
    let [from, to] = [shape.from, shape.to].map(|end| placement.to_world.transform_point3(end));
    let first = (linear * shape.first_direction()).normalize();
    let second = first.cross((to - from).normalize());
    let second = if placement.shape.is_mirrored() { -second } else { second };
    vec![(0, Primitive::of(Cylinder { from, axis: to - from, radius: shape.radius * placement.scale, first, second }))]
}

/// Normal outward.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cylinder {
    from: DVec3,
    /// To the other end.
    axis: DVec3,
    radius: f64,
    /// Directions from the axis to where u is 0 and to where it is a quarter.
    first: DVec3,
    second: DVec3,
}

/// A crossing of a line and the wall: how far along the line, and how high between the ends.
type Crossing = (f64, f64);

impl Element for Cylinder {
    fn intersect(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let is_met = |&(distance, _): &Crossing| distance > 0.0 && distance < limit;
        let (distance, height) = self.crossings(&ray.ray).into_iter().flatten().find(is_met)?;
        Some((distance, Local::new(0.0, height)))
    }

    fn intersect_again(&self, ray: &PreparedRay, limit: f64) -> Option<(f64, Local)> {
        let mut ahead = self.crossings(&ray.ray).into_iter().flatten().filter(|&(distance, _)| distance > 0.0);
        let (distance, height) = ahead.nth(1).filter(|&(distance, _)| distance < limit)?;
        Some((distance, Local::new(0.0, height)))
    }

    fn point(&self, ray: &Ray, distance: f64, local: Local) -> SurfacePoint {
        let (_, across) = self.parts(ray.at(distance) - self.from);
        self.at(across.normalize_or_zero(), local.y)
    }

    fn area(&self) -> f64 {
        TAU * self.radius * self.axis.length()
    }

    fn bounds(&self) -> Option<[DVec3; 2]> {
        // A circle reaches r·√(1 − a²) along an axis whose cosine with the cylinder's is a (Quilez).
        let along = self.axis.normalize();
        let reach = self.radius * (DVec3::ONE - along * along).max(DVec3::ZERO).map(f64::sqrt);
        let to = self.from + self.axis;
        let margin = reach + self.axis.abs() * self.slack();
        Some([self.from.min(to) - margin, self.from.max(to) + margin])
    }

    fn uv(&self, local: Local, normal: DVec3) -> DVec2 {
        let turns = normal.dot(self.second).atan2(normal.dot(self.first)) / TAU;
        DVec2::new(turns.rem_euclid(1.0), local.y)
    }

    fn tangents(&self, _: Local, normal: DVec3) -> Option<Tangents> {
        let along_u = self.second * normal.dot(self.first) - self.first * normal.dot(self.second);
        Some(Tangents::along(along_u, self.axis))
    }

    fn unrolled(&self) -> Option<Unrolled> {
        Some(Unrolled::Evenly)
    }

    /// u runs against the sense of what is drawn where the cylinder is mirrored.
    fn numbers_of_place(&self, _: Option<&Pose>, place: DVec2) -> DVec2 {
        if self.drawn_quarter().dot(self.second) < 0.0 { DVec2::new(1.0 - place.x, place.y) } else { place }
    }

    fn sample_area(&self, u1: f64, u2: f64) -> Option<(SurfacePoint, Local)> {
        let (sine, cosine) = (TAU * u1).sin_cos();
        Some((self.at(self.first * cosine + self.drawn_quarter() * sine, u2), Local::new(0.0, u2)))
    }

    fn normal(&self) -> Option<DVec3> {
        None
    }

    /// One of the two crossings of the line through both points is the point itself, at 1. Their product
    /// tells the other, which is in the
    /// way if it lies between and on the wall. Where the line all but touches the wall, the two are closer than shadow rays come to what they
    /// go to: those end before a light by their errors in single precision, and the point counts as seen.
    fn hides(&self, from: DVec3, point: &SurfacePoint) -> bool {
        let (low, start) = self.parts(from - self.from);
        let (high, end) = self.parts(point.position - self.from);
        let across = end - start;
        let other = (start.length_squared() - self.radius * self.radius) / across.length_squared();
        let height = low + (high - low) * other;
        other > 0.0 && other < self.end_of_shadow_ray(point.position - from, point.normal) && (0.0..=1.0).contains(&height)
    }

    /// Both crossings of a ray are drawn.
    fn pdf_through(&self, _: LightSampling, ray: &PreparedRay) -> f64 {
        let density = |(distance, height): Crossing| {
            let point = self.point(&ray.ray, distance, Local::new(0.0, height));
            area_to_solid_angle(self.area(), ray.ray.origin, &point)
        };
        self.crossings(&ray.ray).into_iter().flatten().filter(|(distance, _)| *distance > 0.0).map(density).sum()
    }
}

impl Cylinder {
    /// Both devices draw in the sense of the transformed axis, mirrored or not.
    fn drawn_quarter(&self) -> DVec3 {
        self.first.cross(self.axis.normalize())
    }

    /// How high between the ends a place relative to `from` is, and its part across the axis.
    fn parts(&self, place: DVec3) -> (f64, DVec3) {
        let height = place.dot(self.axis) / self.axis.length_squared();
        (height, place - self.axis * height)
    }

    /// The share of `way` after which a shadow ray to a point with this normal ends, as kernels end it:
    /// `area_light_sample` in `shaders/shading/light/area_light.wgsl`.
    fn end_of_shadow_ray(&self, way: DVec3, normal: DVec3) -> f64 {
        let error = POINT_ERROR * normal.abs().dot(self.from.abs() + self.axis.abs() + self.radius);
        let along_normal = way.dot(normal).abs();
        let own = (error / along_normal).min(0.5);
        let early = (own + DIRECTION_ERROR * way.length() / along_normal).min(own.max(0.01));
        (1.0 - early) * SHADOW_SHORTENING
    }

    /// By how much it reaches over its ends, as a share of its length: enough for rounding to leave no gap to what it meets there.
    fn slack(&self) -> f64 {
        32.0 * f64::EPSILON * (self.from.abs() + self.axis.abs() + self.radius).max_element() / self.axis.length()
    }

    /// The nearer and the farther crossing of the line, as far as they lie between the ends. Across the axis the wall is a circle: the
    /// discriminant comes from the line's distance to the axis, and the root that would cancel from the product of both.
    fn crossings(&self, ray: &Ray) -> [Option<Crossing>; 2] {
        let (low, origin) = self.parts(ray.origin - self.from);
        let (rise, direction) = self.parts(ray.direction);
        let a = direction.length_squared();
        let b = -origin.dot(direction);
        let nearest = origin + direction * (b / a);
        let discriminant = a * (self.radius * self.radius - nearest.length_squared());
        // Along the axis there is no crossing, and 0/0.
        if discriminant.is_nan() || discriminant < 0.0 {
            return [None, None];
        }
        let c = origin.length_squared() - self.radius * self.radius;
        let q = b + discriminant.sqrt().copysign(b);
        let (first, second) = (c / q, q / a);
        let slack = self.slack();
        [first.min(second), first.max(second)].map(|distance| {
            let height = low + distance * rise;
            (-slack..=1.0 + slack).contains(&height).then_some((distance, height))
        })
    }

    /// The point in a direction from the axis, at a height between the ends.
    fn at(&self, normal: DVec3, height: f64) -> SurfacePoint {
        let position = self.from + self.axis * height + normal * self.radius;
        SurfacePoint::new(position, normal, (self.from.abs() + self.axis.abs() + self.radius).max_element())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::sidak;
    use crate::effort::in_full;
    use crate::scene::{Geometry, Material, Shape, Transform};
    use crate::statistics::{SphereBins, test_directional_sampler};

    const AXIS: DVec3 = DVec3::new(0.4, 1.5, -0.3);

    fn cylinder() -> Cylinder {
        let first = DVec3::NEG_Z.reject_from(AXIS).normalize();
        Cylinder { from: DVec3::new(0.2, -0.7, 0.1), axis: AXIS, radius: 0.6, first, second: first.cross(AXIS.normalize()) }
    }

    fn ray(origin: DVec3, direction: DVec3) -> PreparedRay {
        PreparedRay::new(Ray { origin, direction: direction.normalize() })
    }

    /// By rays whose crossings are known: across, from inside, over an end, and along the axis.
    #[test]
    fn rays_meet_the_wall_and_not_the_open_ends() {
        let tube = Cylinder { from: DVec3::ZERO, axis: DVec3::Y * 2.0, radius: 1.0, first: DVec3::NEG_Z, second: DVec3::X };
        let meet = |origin: [f64; 3], direction: [f64; 3]| tube.intersect(&ray(origin.into(), direction.into()), f64::INFINITY);
        assert_eq!(meet([-3.0, 0.5, 0.0], [1.0, 0.0, 0.0]), Some((2.0, DVec2::new(0.0, 0.25))));
        assert_eq!(meet([0.0, 1.0, 0.0], [1.0, 0.0, 0.0]), Some((1.0, DVec2::new(0.0, 0.5))));
        let (distance, local) = meet([-3.0, 3.6, 0.0], [1.0, -0.6, 0.0]).expect("through the open end to the far wall");
        assert!((distance - 4.0 * 1.36_f64.sqrt()).abs() < 1e-12 && (local.y - 0.6).abs() < 1e-12, "{distance} {local}");
        assert_eq!(meet([-3.0, 2.1, 0.0], [1.0, 0.0, 0.0]), None);
        assert_eq!(meet([-3.0, 0.5, 1.1], [1.0, 0.0, 0.0]), None);
        assert_eq!(meet([0.5, -1.0, 0.0], [0.0, 1.0, 0.0]), None);
        let normal =
            tube.point(&Ray { origin: DVec3::new(0.0, 1.0, 0.0), direction: DVec3::X }, 1.0, DVec2::new(0.0, 0.5)).normal;
        assert_eq!(normal, DVec3::X);
        assert_eq!(
            [DVec3::NEG_Z, DVec3::X, DVec3::Z].map(|n| tube.uv(DVec2::new(0.0, 0.5), n)),
            [0.0, 0.25, 0.5].map(|u| DVec2::new(u, 0.5))
        );
    }

    /// Points and coordinates found by moving along the mapping itself; a mirroring transform keeps the coordinates of what it moves.
    #[test]
    fn tangents_follow_the_coordinates_and_stay_under_reflections() {
        let mirrored = glam::DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
        let own = scene::Cylinder { from: DVec3::new(0.2, -0.7, 0.1), to: DVec3::new(0.6, 0.8, -0.2), radius: 0.6 };
        let place = |step: Option<glam::DAffine3>| {
            let steps = step.into_iter().map(scene::TransformStep::Matrix).collect();
            let shape = Shape {
                label: "tube".into(),
                geometry: Geometry::Cylinder(own),
                material: 0,
                transform: Transform { steps },
                motion: None,
                portal: false,
                receiver: 0,
            };
            elements(&own, &Placement::new(&shape)).remove(0).1
        };
        let (plain, reflected) = (place(None), place(Some(mirrored)));
        for turn in [0.1, 0.35, 0.6, 0.85] {
            let (point, local) = plain.element().sample_area(turn, 0.3).expect("it has an area");
            let uv = plain.element().uv(local, point.normal);
            assert!((uv - DVec2::new(turn, 0.3)).length() < 1e-12, "{uv}");
            let other = reflected.element().uv(local, mirrored.transform_vector3(point.normal));
            assert!((uv - other).length() < 1e-12, "{uv} {other}");
            for (element, normal) in [(&plain, point.normal), (&reflected, mirrored.transform_vector3(point.normal))] {
                let Tangents { along_u, along_v, .. } = element.element().tangents(local, normal).expect("it has tangents");
                let moved = element.element().uv(local, (normal + along_u * 1e-6).normalize());
                assert!(
                    moved.x > uv.x && (along_u.dot(normal)).abs() < 1e-12 && along_v.dot(normal).abs() < 1e-12,
                    "{moved} {uv}"
                );
            }
        }
    }

    /// From outside, from inside and from before an open end: what is not hidden follows the density of what rays meet first; through it,
    /// as a portal, the density of both crossings.
    #[test]
    fn directions_follow_their_densities() {
        let tube = cylinder();
        let middle = tube.from + 0.5 * tube.axis;
        let references = [DVec3::new(2.0, 0.3, 1.0), middle + tube.first * 0.2, tube.from + 1.6 * tube.axis];
        let level = sidak(0.01, 2 * references.len());
        let samples = if in_full("200,000 directions to a cylinder instead of 50,000") { 200_000 } else { 50_000 };
        for (seed, reference) in (0..).zip(references) {
            let bins = SphereBins::uniform(DVec3::Y, 24, 24);
            let visible =
                |[u1, u2, _]: [f64; 3]| tube.sample((None, true), LightSampling::Area, reference, u1, u2).map(|drawn| drawn.wi);
            let nearest = |wi: DVec3| {
                let ray = ray(reference, wi);
                let met = tube.intersect(&ray, f64::INFINITY);
                met.map_or(0.0, |(distance, local)| {
                    tube.pdf(None, LightSampling::Area, reference, &tube.point(&ray.ray, distance, local))
                })
            };
            let report = test_directional_sampler(&bins, samples, seed, visible, nearest);
            assert!(report.passes(level), "{reference}: {report:?}");
            let through =
                |[u1, u2, _]: [f64; 3]| tube.sample_through(LightSampling::Area, reference, u1, u2).map(|drawn| drawn.wi);
            let both = |wi: DVec3| tube.pdf_through(LightSampling::Area, &ray(reference, wi));
            let report = test_directional_sampler(&bins, samples, seed, through, both);
            assert!(report.passes(level) && (report.integral.value - 1.0).abs() < 1e-2, "{reference}, through: {report:?}");
            // From within or before an end each line meets the wall once ahead; elsewhere the one is not the other.
            let mixed = test_directional_sampler(&bins, samples, seed, through, nearest);
            assert_eq!(mixed.passes(level), seed != 0, "{reference}: {mixed:?}");
        }
    }

    /// The irradiance of a long tube beside a point that faces it, from the view factor of a differential area to an infinite cylinder: r/d.
    #[test]
    fn a_long_tube_lights_as_its_view_factor_says() {
        let tube = Cylinder {
            from: DVec3::new(0.0, -4e3, 0.0),
            axis: DVec3::Y * 8e3,
            radius: 0.5,
            first: DVec3::NEG_Z,
            second: DVec3::X,
        };
        let reference = DVec3::new(2.0, 0.0, 0.0);
        let steps = 400;
        let mut sum = 0.0;
        for (i, j) in (0..steps).flat_map(|i| (0..steps).map(move |j| (i, j))) {
            // Heights in proportion to the tangent of an even angle, whose density is what the sum divides by.
            let angle = (f64::from(j) + 0.5) / f64::from(steps) * 3.0 - 1.5;
            let (y, stretch) = (2.0 * angle.tan(), 3.0 * 2.0 / angle.cos().powi(2));
            let (point, _) = tube.sample_area((f64::from(i) + 0.5) / f64::from(steps), (y + 4e3) / 8e3).expect("it has an area");
            let to_point = point.position - reference;
            let (squared, wi) = (to_point.length_squared(), to_point.normalize());
            let cosine = -wi.dot(point.normal);
            if cosine > 0.0 && !tube.hides(reference, &point) {
                sum += (-wi.x).max(0.0) * cosine / squared * stretch * TAU * 0.5;
            }
        }
        let view_factor = sum / f64::from(steps * steps) / std::f64::consts::PI;
        assert!((view_factor - 0.25).abs() < 2e-3, "{view_factor}");
    }

    #[test]
    fn a_cylinder_without_length_is_refused() {
        let mut wrong = scene::Scene::default();
        let kind = scene::MaterialKind::Emissive;
        wrong.materials.push(Material {
            name: "glow".into(),
            kind,
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
        });
        let tube = |to| scene::Cylinder { from: DVec3::ZERO, to, radius: 1.0 };
        for (geometry, is_right) in [(tube(DVec3::Y), true), (tube(DVec3::ZERO), false)] {
            wrong.shapes = vec![Shape {
                label: "tube".into(),
                geometry: Geometry::Cylinder(geometry),
                material: 0,
                transform: Transform::default(),
                motion: None,
                portal: false,
                receiver: 0,
            }];
            assert_eq!(wrong.validate().is_ok(), is_right);
        }
    }
}
