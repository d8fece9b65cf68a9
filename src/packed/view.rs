//! The camera and what lies outside the scene, as the device wants them.

use glam::{DVec2, DVec3, DVec4};

use super::environment::PackedEnvironment;
use crate::sampling::filter::{CURVE_PIECES, FilterSampler};
use crate::scene::{self, Aperture, ApertureShape, Camera, FisheyeMapping, Scene, Window};
use crate::shader::shared::{shared_constants, shared_struct};

shared_struct! {
/// The camera and what lies outside the scene.
pub struct View {
    pub position: [f32; 4],
    /// A ray through film position (x, y), in pixels, goes along corner + x·step_x + y·step_y; orthographic: it starts there,
    /// relative to the position. Of a camera model, step_x is the direction to the right, and step_y that upward.
    pub corner: [f32; 4],
    pub step_x: [f32; 4],
    pub step_y: [f32; 4],
    /// Viewing direction, of length 1; the filter's radius in pixels.
    pub forward: [f32; 4],
    /// From the middle of the lens to the right, as long as the aperture's radius; distance of the plane in focus.
    pub lens_u: [f32; 4],
    /// Likewise upward; rotation of a polygon in turns.
    pub lens_v: [f32; 4],
    /// From the camera to its right eye; half the distance of its eyes.
    pub eye: [f32; 4],
    /// Words that the shader of the camera's model reads.
    pub model: [[f32; 4]; 4],
    /// One over the distance at which the eyes converge; how far from the camera rays start that come back to it.
    pub convergence: [f32; 4],
    /// Between the moments at which two rows begin to be exposed, and how long each is, as shares of the exposure.
    pub rolling: [f32; 4],
    /// Words that the shader of the light from outside the scene reads; its radiance where it is constant.
    pub environment: [[f32; 4]; 3],
    /// Inverse cumulative distribution of the filter, piece by piece.
    pub filter_curve: [[f32; 4]; CURVE_PIECES],
    /// The first POSE_WORDS of these at even steps of time while the shutter is open, for a camera that moves.
    pub exposure: [[[f32; 4]; POSE_WORDS]; scene::EXPOSURE_STRETCHES + 1],
}
}

/// Words that say where a camera is: from `position` to `eye`.
pub const POSE_WORDS: usize = 8;

shared_constants!(constants {
    const EXPOSURE_STRETCHES: u32 = scene::EXPOSURE_STRETCHES as u32;
    const FISHEYE_EQUIDISTANT: u32 = FisheyeMapping::Equidistant as u32;
    const FISHEYE_EQUISOLID: u32 = FisheyeMapping::Equisolid as u32;
    const FISHEYE_STEREOGRAPHIC: u32 = FisheyeMapping::Stereographic as u32;
});

impl View {
    pub fn new(scene: &Scene, environment: &PackedEnvironment) -> Self {
        let pose = |camera: &Camera| pose(camera, scene);
        let at_rest = pose(&scene.camera);
        let exposure = std::array::from_fn(|step| scene.exposure.get(step).map_or(at_rest, pose));
        let [position, corner, step_x, step_y, forward, lens_u, lens_v, eye] = at_rest;
        let size = DVec2::from(scene.camera.view_size(scene.film.size).map(f64::from));
        let model = scene.camera.projection.model().map_or([DVec4::ZERO; 4], |model| model.words(size));
        let convergence = scene.camera.stereo.map_or(0.0, |stereo| stereo.inverse_convergence());
        let from_row_to_row = scene.camera.time_of_row(1, scene.film.size[1], 0.0);
        Self {
            position,
            corner,
            step_x,
            step_y,
            forward,
            lens_u,
            lens_v,
            eye,
            model: model.map(|word| word.as_vec4().to_array()),
            convergence: [convergence as f32, scene.camera.inward_from as f32, 0.0, 0.0],
            rolling: [from_row_to_row as f32, scene.camera.rolling_shutter as f32, 0.0, 0.0],
            environment: environment.words.map(|word| word.as_vec4().to_array()),
            filter_curve: *FilterSampler::new(scene.film.filter).curve(),
            exposure,
        }
    }
}

/// The words of a pose, for the film of a scene.
fn pose(camera: &Camera, scene: &Scene) -> [[f32; 4]; POSE_WORDS] {
    let [right, up, backward] = camera.frame();
    let size = DVec2::from(camera.view_size(scene.film.size).map(f64::from));
    let [corner, step_x, step_y] = match camera.window(size) {
        Some(Window { half_extent, shift, is_parallel }) => {
            let DVec2 { x: half_width, y: half_height } = half_extent;
            let distance = if is_parallel { 0.0 } else { 1.0 };
            let shift = right * (2.0 * half_width * shift.x) + up * (2.0 * half_height * shift.y);
            [
                up * half_height - right * half_width - backward * distance + shift,
                right * (2.0 * half_width / size.x),
                up * (-2.0 * half_height / size.y),
            ]
        }
        None => [DVec3::ZERO, right, up],
    };
    let radius = camera.aperture.map_or(0.0, |aperture| aperture.radius);
    let half_distance = camera.stereo.map_or(0.0, |stereo| 0.5 * stereo.eye_distance);
    [
        extend(camera.position, 0.0),
        extend(corner, 0.0),
        extend(step_x, 0.0),
        extend(step_y, 0.0),
        extend(-backward, scene.film.filter.radius),
        extend(right * radius, camera.focus_distance),
        extend(up * radius, camera.aperture.map_or(0.0, rotation_turns)),
        extend(right * half_distance, half_distance),
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
