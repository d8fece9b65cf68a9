//! From a film position to a ray.

use glam::{DVec2, DVec3};

use super::intersect::Ray;
use super::warp;
use crate::sampling::filter::FilterSampler;
use crate::sampling::{CameraDimension, Dimension, PathSampler};
use crate::scene::{Aperture, ApertureShape, Camera, FilmSettings, Projection};

/// A pinhole or thin-lens camera, perspective or orthographic, with its frame worked out.
#[derive(Debug, Clone)]
pub struct ProjectiveCamera {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    backward: DVec3,
    orthographic: bool,
    /// Half the window's width and height, at distance 1 if it is perspective.
    half_extent: DVec2,
    /// To the right and up, in windows.
    shift: DVec2,
    size: DVec2,
    filter: FilterSampler,
    aperture: Option<Aperture>,
    /// Distance of the plane in focus along the viewing direction.
    focus_distance: f64,
}

impl ProjectiveCamera {
    pub fn new(camera: &Camera, film: &FilmSettings) -> Self {
        let [right, up, backward] = camera.frame();
        let size = DVec2::from(film.size.map(f64::from));
        let (orthographic, half_height) = match camera.projection {
            Projection::Perspective { vertical_fov_degrees } => (false, (0.5 * vertical_fov_degrees.to_radians()).tan()),
            Projection::Orthographic { height } => (true, 0.5 * height),
        };
        Self {
            position: camera.position,
            right,
            up,
            backward,
            orthographic,
            half_extent: DVec2::new(half_height * size.x / size.y, half_height),
            shift: DVec2::from(camera.shift),
            size,
            filter: FilterSampler::new(film.filter),
            aperture: camera.aperture,
            focus_distance: camera.focus_distance,
        }
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
        self.ray(film_x, film_y, lens)
    }

    /// The ray through a film position in pixels: x to the right, y down, (0, 0) the picture's upper left corner. `lens` is where it
    /// starts, to the right and up from the middle of the lens. All rays of a film position meet in the plane in focus.
    pub fn ray(&self, film_x: f64, film_y: f64, lens: DVec2) -> Ray {
        let x = (2.0 * (film_x / self.size.x + self.shift.x) - 1.0) * self.half_extent.x;
        let y = (1.0 - 2.0 * (film_y / self.size.y - self.shift.y)) * self.half_extent.y;
        let window = self.right * x + self.up * y;
        let (middle, direction) =
            if self.orthographic { (self.position + window, -self.backward) } else { (self.position, window - self.backward) };
        if self.aperture.is_none() {
            return Ray { origin: middle, direction: direction.normalize() };
        }
        let offset = self.right * lens.x + self.up * lens.y;
        Ray { origin: middle + offset, direction: (direction * self.focus_distance - offset).normalize() }
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
