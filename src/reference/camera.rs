//! From a film position to a ray.

use glam::{DVec2, DVec3};

use super::intersect::Ray;
use super::warp;
use crate::sampling::filter::FilterSampler;
use crate::sampling::{CameraDimension, Dimension, PathSampler};
use crate::scene::{Aperture, ApertureShape, Camera, FilmSettings, Projection, Scene};

/// A pinhole or thin-lens camera, perspective or orthographic, with its frame worked out.
#[derive(Debug, Clone)]
pub struct ProjectiveCamera {
    /// Poses of the camera, at even steps of time while the shutter is open; one where it rests.
    poses: Vec<Pose>,
    orthographic: bool,
    /// To the right and up, in windows.
    shift: DVec2,
    size: DVec2,
    filter: FilterSampler,
    aperture: Option<Aperture>,
}

/// The part of the camera that differs where it moves.
#[derive(Debug, Clone)]
struct Pose {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    backward: DVec3,
    /// Half the window's width and height, at distance 1 if it is perspective; the width is below 0 where the picture is mirrored.
    half_extent: DVec2,
    /// Distance of the plane in focus along the viewing direction.
    focus_distance: f64,
}

/// A ray before its direction has length 1: of a film position and a point of the lens, linear in where the camera is.
struct Unscaled {
    /// Origin of the ray through the middle of the lens, and its direction.
    middle: DVec3,
    direction: DVec3,
    /// From the middle of the lens.
    offset: DVec3,
    focus_distance: f64,
}

impl Pose {
    fn new(camera: &Camera, size: DVec2) -> Self {
        let [right, up, backward] = camera.frame();
        let half_height = match camera.projection {
            Projection::Perspective { vertical_fov_degrees } => (0.5 * vertical_fov_degrees.to_radians()).tan(),
            Projection::Orthographic { height } => 0.5 * height,
        };
        Self {
            position: camera.position,
            right,
            up,
            backward,
            half_extent: DVec2::new(half_height * size.x / size.y * camera.stretch, half_height),
            focus_distance: camera.focus_distance,
        }
    }
}

impl Unscaled {
    fn between(a: &Self, b: &Self, share: f64) -> Self {
        Self {
            middle: a.middle + (b.middle - a.middle) * share,
            direction: a.direction + (b.direction - a.direction) * share,
            offset: a.offset + (b.offset - a.offset) * share,
            focus_distance: a.focus_distance + (b.focus_distance - a.focus_distance) * share,
        }
    }
}

impl ProjectiveCamera {
    /// A camera at rest.
    pub fn new(camera: &Camera, film: &FilmSettings) -> Self {
        let size = DVec2::from(film.size.map(f64::from));
        Self {
            poses: vec![Pose::new(camera, size)],
            orthographic: matches!(camera.projection, Projection::Orthographic { .. }),
            shift: DVec2::from(camera.shift),
            size,
            filter: FilterSampler::new(film.filter),
            aperture: camera.aperture,
        }
    }

    /// The camera of a scene, at rest or not.
    pub fn of(scene: &Scene) -> Self {
        let mut camera = Self::new(&scene.camera, &scene.film);
        if !scene.exposure.is_empty() {
            camera.poses = scene.exposure.iter().map(|pose| Pose::new(pose, camera.size)).collect();
        }
        camera
    }

    /// The camera ray of a sample of pixel (x, y). Its position is drawn from the filter around the pixel's centre, its origin from
    /// the aperture.
    pub fn sample(&self, x: u32, y: u32, sampler: &PathSampler) -> Ray {
        let bits = |dimension| sampler.bits(Dimension::camera(dimension));
        let offset = |dimension| self.filter.offset(sampler.uniform(Dimension::camera(dimension)));
        let film_x = f64::from(x) + 0.5 + offset(CameraDimension::PixelX);
        let film_y = f64::from(y) + 0.5 + offset(CameraDimension::PixelY);
        let lens = self.aperture.map_or(DVec2::ZERO, |aperture| {
            aperture.radius * aperture_point(aperture.shape, bits(CameraDimension::LensU), bits(CameraDimension::LensV))
        });
        let time = if self.poses.len() > 1 { sampler.uniform(Dimension::camera(CameraDimension::Time)) } else { 0.0 };
        self.ray(film_x, film_y, lens, time)
    }

    /// The ray through a film position in pixels: x to the right, y down, (0, 0) the picture's upper left corner. `lens` is where it
    /// starts, to the right and up from the middle of the lens. All rays of a film position meet in the plane in focus. `time` is 0 as the
    /// shutter opens and 1 as it closes.
    pub fn ray(&self, film_x: f64, film_y: f64, lens: DVec2, time: f64) -> Ray {
        let stretches = self.poses.len() - 1;
        let ray = if stretches == 0 {
            self.unscaled(&self.poses[0], film_x, film_y, lens)
        } else {
            let scaled = time * stretches as f64;
            let first = (scaled as usize).min(stretches - 1);
            let [a, b] = [first, first + 1].map(|index| self.unscaled(&self.poses[index], film_x, film_y, lens));
            Unscaled::between(&a, &b, scaled - first as f64)
        };
        if self.aperture.is_none() {
            return Ray { origin: ray.middle, direction: ray.direction.normalize() };
        }
        Ray { origin: ray.middle + ray.offset, direction: (ray.direction * ray.focus_distance - ray.offset).normalize() }
    }

    fn unscaled(&self, pose: &Pose, film_x: f64, film_y: f64, lens: DVec2) -> Unscaled {
        let x = (2.0 * (film_x / self.size.x + self.shift.x) - 1.0) * pose.half_extent.x;
        let y = (1.0 - 2.0 * (film_y / self.size.y - self.shift.y)) * pose.half_extent.y;
        let window = pose.right * x + pose.up * y;
        let (middle, direction) =
            if self.orthographic { (pose.position + window, -pose.backward) } else { (pose.position, window - pose.backward) };
        let offset = pose.right * lens.x + pose.up * lens.y;
        Unscaled { middle, direction, offset, focus_distance: pose.focus_distance }
    }
}

/// Uniform over an aperture of radius 1: the unit disk; the square that surrounds it; or the regular polygon with its corners on the
/// unit circle, the first one to the right of the centre, turned anticlockwise as seen from behind the camera.
pub fn aperture_point(shape: ApertureShape, bits_u: u32, bits_v: u32) -> DVec2 {
    let uniform = crate::sampling::sampler::uniform;
    match shape {
        ApertureShape::Disk => warp::disk(1.0, uniform(bits_u), uniform(bits_v)),
        ApertureShape::Square => DVec2::new(2.0 * uniform(bits_u) - 1.0, 2.0 * uniform(bits_v) - 1.0),
        ApertureShape::Polygon { blades, rotation_degrees } => {
            // The choice of a triangle takes what it needs of the bits and leaves the rest, uniform again.
            let product = u64::from(bits_u) * u64::from(blades);
            let (triangle, rest) = ((product >> 32) as u32, product as u32);
            let corner = |index: u32| {
                let turns = f64::from(index) / f64::from(blades);
                DVec2::from_angle(std::f64::consts::TAU * turns + rotation_degrees.to_radians())
            };
            let (root, v) = (uniform(rest).sqrt(), uniform(bits_v));
            root * (corner(triangle) * (1.0 - v) + corner(triangle + 1) * v)
        }
    }
}

#[cfg(test)]
mod tests;
