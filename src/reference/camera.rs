//! From a film position to a ray.

use glam::{DVec2, DVec3};

use super::intersect::Ray;
use super::warp;
use crate::sampling::filter::FilterSampler;
use crate::sampling::{CameraDimension, Dimension, PathSampler};
use crate::scene::{ApertureShape, Camera, Eyes, FilmSettings, Scene, ViewPlace, Window};

/// The rays of a camera, with its frame worked out.
#[derive(Debug, Clone)]
pub struct CameraRays {
    /// Poses of the camera, at even steps of time while the shutter is open; one where it rests.
    poses: Vec<Pose>,
    /// All that is the same while the shutter is open.
    camera: Camera,
    /// Columns and rows of views in the picture, and their size in pixels.
    tiles: [u32; 2],
    view: [u32; 2],
    /// Rows of the picture.
    rows: u32,
    filter: FilterSampler,
}

/// The part of the camera that differs where it moves.
#[derive(Debug, Clone)]
struct Pose {
    position: DVec3,
    /// To the right, up and backward.
    frame: [DVec3; 3],
    /// None where the picture is not flat.
    window: Option<Window>,
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
    fn new(camera: &Camera, view: [u32; 2]) -> Self {
        Self {
            position: camera.position,
            frame: camera.frame(),
            window: camera.window(DVec2::from(view.map(f64::from))),
            focus_distance: camera.focus_distance,
        }
    }

    /// A vector of the camera's coordinates in the world.
    fn to_world(&self, v: DVec3) -> DVec3 {
        let [right, up, backward] = self.frame;
        right * v.x + up * v.y + backward * v.z
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

impl CameraRays {
    /// A camera at rest.
    pub fn new(camera: &Camera, film: &FilmSettings) -> Self {
        let view = camera.view_size(film.size);
        Self {
            poses: vec![Pose::new(camera, view)],
            camera: camera.clone(),
            tiles: camera.tiles(),
            view,
            rows: film.size[1],
            filter: FilterSampler::new(film.filter),
        }
    }

    /// The camera of a scene, at rest or not.
    pub fn of(scene: &Scene) -> Self {
        let mut rays = Self::new(&scene.camera, &scene.film);
        if !scene.exposure.is_empty() {
            rays.poses = scene.exposure.iter().map(|pose| Pose::new(pose, rays.view)).collect();
        }
        rays
    }

    /// The camera ray of a sample of pixel (x, y); None where it sees nothing. Its position is drawn from the filter around the pixel's centre,
    /// its origin from the aperture.
    pub fn sample(&self, x: u32, y: u32, sampler: &PathSampler) -> Option<Ray> {
        let bits = |dimension| sampler.bits(Dimension::camera(dimension));
        let offset = |dimension| self.filter.offset(sampler.uniform(Dimension::camera(dimension)));
        let film_x = f64::from(x) + 0.5 + offset(CameraDimension::PixelX);
        let film_y = f64::from(y) + 0.5 + offset(CameraDimension::PixelY);
        let lens = self.camera.aperture.map_or(DVec2::ZERO, |aperture| {
            aperture.radius * aperture_point(aperture.shape, bits(CameraDimension::LensU), bits(CameraDimension::LensV))
        });
        let time = if self.poses.len() > 1 { self.time(y, sampler) } else { 0.0 };
        self.ray([x, y], DVec2::new(film_x, film_y), lens, time)
    }

    /// When a sample of row y sees the scene, uniform over the time for which the row is exposed: 0 as the shutter opens, 1 as it closes.
    pub fn time(&self, y: u32, sampler: &PathSampler) -> f64 {
        self.camera.time_of_row(y, self.rows, sampler.uniform(Dimension::camera(CameraDimension::Time)))
    }

    /// When row y is first exposed: 0 as the shutter opens, 1 as it closes.
    pub fn start(&self, y: u32) -> f64 {
        self.camera.time_of_row(y, self.rows, 0.0)
    }

    /// The ray of a pixel through the middle of its place and of the lens when it is first exposed; None where it sees nothing.
    pub fn middle(&self, x: u32, y: u32) -> Option<Ray> {
        self.ray([x, y], DVec2::new(f64::from(x) + 0.5, f64::from(y) + 0.5), DVec2::ZERO, self.start(y))
    }

    /// The ray of a pixel through a film position in pixels: x to the right, y down, (0, 0) the picture's upper left corner; None where it sees
    /// nothing. The pixel says which view of the picture it is, and samples of its edge reach over into what the view would show there. `lens` is
    /// where it starts, to the right and up from the middle of the lens. All rays of a film position meet in the plane in focus. `time` is 0 as the
    /// shutter opens and 1 as it closes.
    pub fn ray(&self, pixel: [u32; 2], film: DVec2, lens: DVec2, time: f64) -> Option<Ray> {
        let tile: [u32; 2] = std::array::from_fn(|axis| (pixel[axis] / self.view[axis]).min(self.tiles[axis] - 1));
        let corner: [f64; 2] = std::array::from_fn(|axis| f64::from(tile[axis] * self.view[axis]));
        let place = ViewPlace {
            tile: tile[1] * self.tiles[0] + tile[0],
            at: film - DVec2::from(corner),
            size: DVec2::from(self.view.map(f64::from)),
        };
        let stretches = self.poses.len() - 1;
        let ray = if stretches == 0 {
            self.unscaled(&self.poses[0], &place, lens)?
        } else {
            let scaled = time * stretches as f64;
            let first = (scaled as usize).min(stretches - 1);
            let (a, b) = (self.unscaled(&self.poses[first], &place, lens)?, self.unscaled(&self.poses[first + 1], &place, lens)?);
            Unscaled::between(&a, &b, scaled - first as f64)
        };
        if self.camera.aperture.is_none() {
            return Some(Ray { origin: ray.middle, direction: ray.direction.normalize() });
        }
        Some(Ray { origin: ray.middle + ray.offset, direction: (ray.direction * ray.focus_distance - ray.offset).normalize() })
    }

    /// The place where a pixel's view shows a point through the middle of the lens, in pixels from the view's upper left corner: as the shutter opens, or as it
    /// `closes`. None where the point is not before the camera, and where the picture is not flat.
    pub fn place(&self, pixel: [u32; 2], point: DVec3, closes: bool) -> Option<DVec2> {
        let pose = if closes { self.poses.last() } else { self.poses.first() }?;
        let window = pose.window?;
        let [right, up, backward] = pose.frame;
        let way = point - pose.position;
        let mut seen = DVec3::new(way.dot(right), way.dot(up), -way.dot(backward));
        let mut toed_in = DVec3::ZERO;
        if let Some(stereo) = self.camera.stereo {
            let eye = stereo.eye(Eyes::Pair, DVec3::NEG_Z, self.tile(pixel));
            seen -= eye;
            toed_in = stereo.inverse_convergence() * eye;
        }
        let on_window = match window.is_parallel {
            true => seen.truncate(),
            false if seen.z > 0.0 => (seen / seen.z + toed_in).truncate(),
            false => return None,
        };
        let at = on_window / window.half_extent;
        let share = 0.5 * DVec2::new(1.0 + at.x, 1.0 - at.y) + DVec2::new(-window.shift.x, window.shift.y);
        Some(share * DVec2::from(self.view.map(f64::from)))
    }

    /// Number of the view that a pixel belongs to.
    fn tile(&self, pixel: [u32; 2]) -> u32 {
        let [column, row]: [u32; 2] = std::array::from_fn(|axis| (pixel[axis] / self.view[axis]).min(self.tiles[axis] - 1));
        row * self.tiles[0] + column
    }

    fn unscaled(&self, pose: &Pose, place: &ViewPlace, lens: DVec2) -> Option<Unscaled> {
        let (mut origin, mut direction) = match (pose.window, self.camera.projection.model()) {
            (Some(window), _) => {
                let at = DVec2::new(
                    2.0 * (place.at.x / place.size.x + window.shift.x) - 1.0,
                    1.0 - 2.0 * (place.at.y / place.size.y - window.shift.y),
                );
                let on_window = (at * window.half_extent).extend(0.0);
                if window.is_parallel { (on_window, DVec3::NEG_Z) } else { (DVec3::ZERO, on_window - DVec3::Z) }
            }
            (None, Some(model)) => {
                let direction = model.direction(place)?;
                if self.camera.inward_from > 0.0 {
                    (direction.normalize() * self.camera.inward_from, -direction)
                } else {
                    (DVec3::ZERO, direction)
                }
            }
            (None, None) => return None,
        };
        if let Some(stereo) = self.camera.stereo {
            let eyes = self.camera.projection.model().map_or(Eyes::Pair, |model| model.eyes());
            let eye = stereo.eye(eyes, direction, place.tile);
            origin += eye;
            direction -= stereo.inverse_convergence() * eye;
        }
        Some(Unscaled {
            middle: pose.position + pose.to_world(origin),
            direction: pose.to_world(direction),
            offset: pose.to_world(lens.extend(0.0)),
            focus_distance: pose.focus_distance,
        })
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
