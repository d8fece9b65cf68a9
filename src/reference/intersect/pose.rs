//! Places of moving shapes at one time.
//!
//! A moving primitive is met in its rest space, where it is at shutter time 0: the ray is taken there by the inverse of the shape's
//! motion, and what it meets is brought back. The ray's direction keeps the length that the inverse gives it, so distances along it are
//! those of the world.

use glam::{DAffine3, DMat3, DVec3};

use super::normal_map::Tangents;
use super::ray::{Ray, SurfacePoint};
use crate::scene::{Motion, Scene, Shape};

/// Times at which a shape is looked at to find what it sweeps.
const SWEEP_TIMES: u32 = 32;

/// One shape's motion at one time.
#[derive(Debug, Clone, Copy)]
pub struct Pose {
    to_world: DAffine3,
    to_rest: DAffine3,
    /// By how much rounding grows on the way to rest and back.
    condition: f64,
    /// Largest coordinate that the map itself contains.
    reach: f64,
}

/// All that depends on the time at which a path sees the scene. A still scene has nothing of it.
#[derive(Debug, Clone, Default)]
pub struct PathTime {
    /// By shape; empty where nothing moves.
    poses: Vec<Option<Pose>>,
    time: f64,
}

impl PathTime {
    pub fn new(scene: &Scene, time: f64) -> Self {
        Self { poses: scene.shapes.iter().map(|shape| shape.moved_by(time).map(Pose::new)).collect(), time }
    }

    pub fn value(&self) -> f64 {
        self.time
    }

    /// None: the shape rests.
    pub fn pose(&self, shape: usize) -> Option<&Pose> {
        self.poses.get(shape)?.as_ref()
    }
}

impl Pose {
    pub fn new(to_world: DAffine3) -> Self {
        let to_rest = to_world.inverse();
        let size = |m: DMat3| m.to_cols_array().into_iter().fold(0.0, |largest: f64, entry| largest.max(entry.abs()));
        Self {
            to_world,
            to_rest,
            condition: 3.0 * size(to_world.matrix3) * size(to_rest.matrix3),
            reach: to_world.translation.abs().max_element(),
        }
    }

    pub fn ray_to_rest(&self, ray: &Ray) -> Ray {
        Ray { origin: self.to_rest.transform_point3(ray.origin), direction: self.to_rest.transform_vector3(ray.direction) }
    }

    /// A normal at rest as it is in the world: by the inverse transpose, of unit length.
    pub fn normal(&self, at_rest: DVec3) -> DVec3 {
        (self.to_rest.matrix3.transpose() * at_rest).normalize_or_zero()
    }

    /// The other way round.
    pub fn normal_to_rest(&self, normal: DVec3) -> DVec3 {
        (self.to_world.matrix3.transpose() * normal).normalize_or_zero()
    }

    pub fn tangents(&self, at_rest: Tangents) -> Tangents {
        let linear = self.to_world.matrix3;
        Tangents { along_u: linear * at_rest.along_u, along_v: linear * at_rest.along_v, ..at_rest }
    }

    pub fn point(&self, at_rest: &SurfacePoint) -> SurfacePoint {
        let position = self.to_world.transform_point3(at_rest.position);
        let magnitude = at_rest.position.abs().max_element() + position.abs().max_element() + self.reach;
        let carried = at_rest.error * self.condition.max(1.0);
        let moved = SurfacePoint::new(position, self.normal(at_rest.normal), magnitude * self.condition.max(1.0));
        SurfacePoint { error: moved.error + carried, ..moved }
    }

    /// The place of a point that is given at rest.
    pub fn place(&self, at_rest: DVec3) -> DVec3 {
        self.to_world.transform_point3(at_rest)
    }

    /// The place at rest of a point that is given in the world.
    pub fn place_at_rest(&self, point: DVec3) -> DVec3 {
        self.to_rest.transform_point3(point)
    }

    /// The factor along every axis: round shapes are scaled evenly.
    pub fn scale(&self) -> f64 {
        self.to_world.matrix3.x_axis.length()
    }

    /// The factor by which the motion multiplied the area of a flat piece of surface with this normal in the
    /// world (Nanson's formula).
    pub fn area_factor(&self, normal: DVec3) -> f64 {
        self.to_world.matrix3.determinant().abs() / (self.to_world.matrix3.transpose() * normal).length()
    }
}

/// A box around everything that a shape's part inside the box `[min, max]` sweeps while the shutter is open. Its corners are followed
/// from one time to the next; in between, none moves farther from the nearer time's place than the greatest speed takes it.
pub fn swept(shape: &Shape, bounds: [DVec3; 2], shutter: [f64; 2]) -> [DVec3; 2] {
    shape.motion.as_ref().map_or(bounds, |motion| swept_by(motion, shape.origin(), bounds, shutter))
}

/// The box that a box sweeps while it moves about `origin`.
pub fn swept_by(motion: &Motion, origin: DVec3, [min, max]: [DVec3; 2], [open, close]: [f64; 2]) -> [DVec3; 2] {
    let corner = |index: usize| DVec3::select(glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), max, min);
    let radius = (0..8).map(|index| (corner(index) - origin).length()).fold(0.0, f64::max);
    let step = (close - open) / f64::from(SWEEP_TIMES);
    let margin = 0.5 * step * motion.greatest_speed(radius, [open, close]);
    let times = if step > 0.0 { SWEEP_TIMES } else { 0 };
    let places = (0..=times).flat_map(|index| {
        let map = motion.at(open + f64::from(index) * step, origin);
        (0..8).map(move |index| map.transform_point3(corner(index)))
    });
    let [low, high] = places.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    // Rounding, of the bound itself and of rays on their way to rest and back.
    let margin = margin * (1.0 + 1e-9) + 1e-9 * (radius + low.abs().max(high.abs()).max_element());
    [low - margin, high + margin]
}
