//! The camera and what lies outside the scene, as the device wants them.

use glam::DVec3;

use super::environment::PackedEnvironment;
use crate::sampling::filter::{CURVE_PIECES, FilterSampler};
use crate::scene::{self, Aperture, ApertureShape, Camera, Projection, Scene};
use crate::shader::shared::{shared_constants, shared_struct};

shared_struct! {
/// The camera and what lies outside the scene.
pub struct View {
    pub position: [f32; 4],
    /// A ray through film position (x, y), in pixels, goes along corner + x·step_x + y·step_y; orthographic: it starts there,
    /// relative to the position.
    pub corner: [f32; 4],
    pub step_x: [f32; 4],
    pub step_y: [f32; 4],
    /// Viewing direction, of length 1; the filter's radius in pixels.
    pub forward: [f32; 4],
    /// From the middle of the lens to the right, as long as the aperture's radius; distance of the plane in focus.
    pub lens_u: [f32; 4],
    /// Likewise upward; rotation of a polygon in turns.
    pub lens_v: [f32; 4],
    /// Words that the shader of the light from outside the scene reads; its radiance where it is constant.
    pub environment: [[f32; 4]; 3],
    /// Inverse cumulative distribution of the filter, piece by piece.
    pub filter_curve: [[f32; 4]; CURVE_PIECES],
    /// The first POSE_WORDS of these at even steps of time while the shutter is open, for a camera that moves.
    pub exposure: [[[f32; 4]; POSE_WORDS]; scene::EXPOSURE_STRETCHES + 1],
}
}

/// Words that say where a camera is: from `position` to `lens_v`.
pub const POSE_WORDS: usize = 7;

shared_constants!(constants {
    const EXPOSURE_STRETCHES: u32 = scene::EXPOSURE_STRETCHES as u32;
});

impl View {
    pub fn new(scene: &Scene, environment: &PackedEnvironment) -> Self {
        let pose = |camera: &Camera| pose(camera, scene);
        let at_rest = pose(&scene.camera);
        let exposure = std::array::from_fn(|step| scene.exposure.get(step).map_or(at_rest, pose));
        let [position, corner, step_x, step_y, forward, lens_u, lens_v] = at_rest;
        Self {
            position,
            corner,
            step_x,
            step_y,
            forward,
            lens_u,
            lens_v,
            environment: environment.words.map(|word| word.as_vec4().to_array()),
            filter_curve: *FilterSampler::new(scene.film.filter).curve(),
            exposure,
        }
    }
}

/// The words of a pose, for the film of a scene.
fn pose(camera: &Camera, scene: &Scene) -> [[f32; 4]; POSE_WORDS] {
    let [right, up, backward] = camera.frame();
    let [width, height] = scene.film.size.map(f64::from);
    let (half_height, distance) = match camera.projection {
        Projection::Perspective { vertical_fov_degrees } => ((0.5 * vertical_fov_degrees).to_radians().tan(), 1.0),
        Projection::Orthographic { height } => (0.5 * height, 0.0),
    };
    let half_width = half_height * width / height * camera.stretch;
    let shift = right * (2.0 * half_width * camera.shift[0]) + up * (2.0 * half_height * camera.shift[1]);
    let radius = camera.aperture.map_or(0.0, |aperture| aperture.radius);
    [
        extend(camera.position, 0.0),
        extend(up * half_height - right * half_width - backward * distance + shift, 0.0),
        extend(right * (2.0 * half_width / width), 0.0),
        extend(up * (-2.0 * half_height / height), 0.0),
        extend(-backward, scene.film.filter.radius),
        extend(right * radius, camera.focus_distance),
        extend(up * radius, camera.aperture.map_or(0.0, rotation_turns)),
    ]
}

fn extend(v: DVec3, w: f64) -> [f32; 4] {
    v.as_vec3().extend(w as f32).to_array()
}

/// In [0, 1).
fn rotation_turns(aperture: Aperture) -> f64 {
    match aperture.shape {
        ApertureShape::Polygon { rotation_degrees, .. } => (rotation_degrees / 360.0).rem_euclid(1.0),
        ApertureShape::Disk | ApertureShape::Square => 0.0,
    }
}
