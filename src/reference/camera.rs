//! From a film position to a ray.

use glam::DVec3;

use super::intersect::Ray;
use crate::render::RenderError;
use crate::scene::{Camera, FilmSettings, Projection};

/// A pinhole camera with its frame worked out.
#[derive(Debug, Clone)]
pub struct PinholeCamera {
    position: DVec3,
    right: DVec3,
    up: DVec3,
    backward: DVec3,
    /// Tangents of half the horizontal and half the vertical field of view.
    half_extent: [f64; 2],
    size: [f64; 2],
}

impl PinholeCamera {
    /// Refuses lenses and projections it cannot render.
    pub fn new(camera: &Camera, film: &FilmSettings) -> Result<Self, RenderError> {
        let Projection::Perspective { vertical_fov_degrees } = camera.projection else {
            return Err(RenderError::Internal("the CPU reference renders perspective cameras only".into()));
        };
        if camera.aperture.is_some() {
            return Err(RenderError::Internal("the CPU reference renders pinhole cameras only".into()));
        }
        let [right, up, backward] = camera.frame();
        let size = film.size.map(f64::from);
        let half_height = (0.5 * vertical_fov_degrees.to_radians()).tan();
        let half_extent = [half_height * size[0] / size[1], half_height];
        Ok(Self { position: camera.position, right, up, backward, half_extent, size })
    }

    /// The ray through a film position in pixels: x to the right, y down, (0, 0) the picture's upper left corner.
    pub fn ray(&self, film_x: f64, film_y: f64) -> Ray {
        let x = (2.0 * film_x / self.size[0] - 1.0) * self.half_extent[0];
        let y = (1.0 - 2.0 * film_y / self.size[1]) * self.half_extent[1];
        Ray { origin: self.position, direction: (self.right * x + self.up * y - self.backward).normalize() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_look_where_they_should() {
        let camera = Camera {
            position: DVec3::new(0.0, 0.0, 5.0),
            projection: Projection::Perspective { vertical_fov_degrees: 90.0 },
            ..Camera::default()
        };
        let film = FilmSettings { size: [200, 100], ..FilmSettings::default() };
        let camera = PinholeCamera::new(&camera, &film).unwrap();
        let expect = |ray: Ray, direction: DVec3| assert!((ray.direction - direction.normalize()).length() < 1e-15);
        expect(camera.ray(0.0, 0.0), DVec3::new(-2.0, 1.0, -1.0));
        expect(camera.ray(200.0, 100.0), DVec3::new(2.0, -1.0, -1.0));
        expect(camera.ray(100.0, 50.0), -DVec3::Z);
    }
}
