//! A stage for a model that comes without one: ground, light, camera, all sized by the model.

use std::path::Path;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::access::Access;
use super::environment_map::{self, EnvironmentMap};
use super::error::{SceneError, show};
use super::image_file::Pictures;
use super::view::{ModelView, Up};
use crate::scene::{
    Camera, ColorInput, Emission, Environment, EnvironmentRadiance, Geometry, ImageSource, Light, MapRows, Material,
    MaterialKind, Plane, Projection, Rectangle, Scene, Shape, Transform, TransformStep,
};
use crate::spectrum::Spectrum;

/// Vertical field of view of the camera, degrees: a short telephoto lens, which does not distort.
pub const FIELD_OF_VIEW: f64 = 30.0;
/// Reflectance of the ground.
pub const GROUND: f64 = 0.5;
/// Radiance of the light and of the sky.
pub const LIGHT: f64 = 9.0;
pub const SKY: f64 = 0.2;
/// Degrees from the front to the right, and above the horizon, from which the camera looks.
const AZIMUTH: f64 = 27.0;
const ELEVATION: f64 = 17.5;
/// How much of the picture's width or height the model takes.
const FILLED: f64 = 0.88;

/// Puts the scene's shapes on a grey ground under a soft rectangle light and a dim grey sky, seen from the front (+Z, once +Y is up), a
/// little from the right and from above.
pub fn frame(mut scene: Scene, name: &str, view: &ModelView) -> Result<Scene, SceneError> {
    place(&mut scene, view);
    let points = points(&scene);
    let ModelStage { ground, light, .. } = ModelStage::around(&points, name)?;
    let (center, radius) = sphere_around(&points);
    let elevation = view.elevation_degrees.unwrap_or(ELEVATION);
    if !view.no_ground && elevation < 0.0 {
        scene.warnings.push(format!("{name}: the camera looks from below, so the ground is left out"));
    } else if !view.no_ground {
        add(&mut scene, "(ground)", diffuse("(ground)", GROUND), Geometry::Plane(ground));
    }
    if view.environment.is_none() {
        add_lights(&mut scene, light);
    }
    let [width, height] = view.size.unwrap_or(scene.film.size).map(f64::from);
    scene.camera = camera(&points, (center, radius), elevation, width / height);
    Ok(scene)
}

/// Stands the model up and turns it.
fn place(scene: &mut Scene, view: &ModelView) {
    let mut steps = Vec::new();
    if view.up == Up::Z {
        // z to y and y to −z: exact, as a rotation by a right angle is not.
        let matrix3 = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
        steps.push(TransformStep::Matrix(DAffine3 { matrix3, translation: DVec3::ZERO }));
    }
    if view.turn_degrees != 0.0 {
        steps.push(TransformStep::Rotate { axis: DVec3::Y, degrees: view.turn_degrees });
    }
    scene.shapes.iter_mut().for_each(|shape| shape.transform.steps.extend_from_slice(&steps));
}

fn add_lights(scene: &mut Scene, rectangle: Rectangle) {
    let light = Material {
        emission: Some(Emission { radiance: ColorInput::grey(LIGHT), two_sided: false }),
        kind: MaterialKind::Emissive,
        ..diffuse("(light)", 0.0)
    };
    add(scene, "(light)", light, Geometry::Rectangle(rectangle));
    let radiance = EnvironmentRadiance::Constant(Spectrum::grey(SKY));
    scene.lights.push(Light::Environment(Environment {
        radiance,
        rotation_degrees: 0.0,
        turn: None,
        rows: MapRows::Inside,
        mirrored: false,
    }));
}

/// Ground, light and camera around a model.
pub struct ModelStage {
    /// Infinite, so that the horizon is level wherever the camera stands.
    pub ground: Plane,
    /// Above the camera's left shoulder, facing the model.
    pub light: Rectangle,
    pub camera: Camera,
}

impl ModelStage {
    /// Around all points.
    ///
    /// # Errors
    /// There are none, or all are the same.
    pub fn around(points: &[DVec3], name: &str) -> Result<Self, SceneError> {
        let (min, max) = bounds(points).ok_or_else(|| SceneError::in_file(name, "there is nothing to place the camera by"))?;
        let center = 0.5 * (min + max);
        let radius = 0.5 * (max - min).length();
        if !(radius.is_finite() && radius > 1e-15) {
            return Err(SceneError::in_file(name, "the model has no extent"));
        }
        let ground = Plane { point: DVec3::new(center.x, min.y, center.z), normal: DVec3::Y };
        let toward_light = DVec3::new(-0.6, 1.0, 0.5).normalize();
        let across = DVec3::Y.cross(toward_light).normalize() * (2.0 * radius);
        let along = toward_light.cross(across);
        let corner = center + 4.0 * radius * toward_light - 0.5 * (across + along);
        // The front is where edge_u × edge_v points: toward the model.
        Ok(Self {
            ground,
            light: Rectangle { corner, edge_u: along, edge_v: across },
            camera: camera(points, (center, radius), ELEVATION, 1.0),
        })
    }
}

/// Center and radius of the box around the points.
fn sphere_around(points: &[DVec3]) -> (DVec3, f64) {
    let (min, max) = bounds(points).unwrap_or_default();
    (0.5 * (min + max), 0.5 * (max - min).length())
}

/// Puts a lat-long map in the place of the scene's environment.
pub fn light_by(scene: &mut Scene, map: &Path, Access { files, strict }: Access) -> Result<(), SceneError> {
    let read = Pictures::new(files).read_file(map, None).map_err(|reason| SceneError::in_file(show(map), reason))?;
    scene.warnings.extend(read.change.map(|change| format!("{}: {change}", show(map))));
    if let Some(note) = read.notes.first().filter(|_| strict) {
        return Err(SceneError::in_file(show(map), note.clone()).with_help("without --strict, this is a warning"));
    }
    let notes = read.notes.into_iter().chain(environment_map::notes(read.integer_bits, &read.hints));
    scene.warnings.extend(notes.map(|note| format!("{}: {note}", show(map))));
    let converted = environment_map::converted(&read.image, &read.hints);
    let converted = converted.map_err(|reason| SceneError::in_file(show(map), reason))?;
    let (image, rows, rotation_degrees) = match converted {
        Some(EnvironmentMap { image, rows, rotation_degrees }) => (Arc::new(image), rows, rotation_degrees),
        None => {
            let image = Arc::new(read.image);
            if read.is_plain {
                scene
                    .sources
                    .add_image(&image, ImageSource { path: map.to_owned(), embedded: None, color_space: None, scale: 1.0 });
            }
            (image, MapRows::Inside, 0.0)
        }
    };
    scene.lights.retain(|light| !light.is_environment());
    let radiance = EnvironmentRadiance::Map(image);
    scene.lights.push(Light::Environment(Environment { radiance, rotation_degrees, turn: None, rows, mirrored: false }));
    Ok(())
}

/// A camera as near as the model fits into the picture, whose width is `aspect` times its height.
fn camera(points: &[DVec3], (center, radius): (DVec3, f64), elevation: f64, aspect: f64) -> Camera {
    let (sine, cosine) = elevation.to_radians().sin_cos();
    let (azimuth_sine, azimuth_cosine) = AZIMUTH.to_radians().sin_cos();
    let level = DVec3::new(azimuth_sine, 0.0, azimuth_cosine);
    let backward = (cosine * level + sine * DVec3::Y).normalize();
    // Seen from straight above, what is farther back is up.
    let up = if cosine < 1e-3 { -level * sine } else { DVec3::Y };
    let right = up.cross(backward).normalize();
    let upward = backward.cross(right);
    let half_height = FILLED * (0.5 * FIELD_OF_VIEW).to_radians().tan();
    // Along one axis of the picture: the distance from the center at which the farthest points touch its edges, and where its middle is.
    let fit = |axis: DVec3, half: f64| {
        let reach = |side: f64| {
            let of_point = |point: &DVec3| (*point - center).dot(backward) + side * (*point - center).dot(axis) / half;
            points.iter().map(of_point).fold(f64::NEG_INFINITY, f64::max)
        };
        let (above, below) = (reach(1.0), reach(-1.0));
        (0.5 * (above + below), 0.5 * half * (above - below))
    };
    let (distance_across, middle_across) = fit(right, half_height * aspect);
    let (distance_along, middle_along) = fit(upward, half_height);
    let nearest = points.iter().map(|point| (*point - center).dot(backward)).fold(f64::NEG_INFINITY, f64::max);
    let distance = distance_across.max(distance_along).max(nearest + 0.05 * radius);
    let look_at = center + middle_across * right + middle_along * upward;
    Camera {
        position: look_at + distance * backward,
        look_at,
        up,
        projection: Projection::Perspective { vertical_fov_degrees: FIELD_OF_VIEW },
        focus_distance: distance,
        ..Camera::default()
    }
}

fn diffuse(name: &str, reflectance: f64) -> Material {
    Material {
        name: name.to_owned(),
        kind: MaterialKind::Diffuse { reflectance: ColorInput::grey(reflectance) },
        normal_map: None,
        emission: None,
        two_sided: true,
        interior: None,
    }
}

fn add(scene: &mut Scene, label: &str, material: Material, geometry: Geometry) {
    scene.materials.push(material);
    scene.shapes.push(Shape {
        label: label.to_owned(),
        geometry,
        material: scene.materials.len() - 1,
        transform: Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    });
}

/// Corners of all faces of every mesh of the scene, in the world.
fn points(scene: &Scene) -> Vec<DVec3> {
    let of_shape = |shape: &Shape| {
        let positions = shape.world_positions();
        let mut used: Vec<u32> = shape.world_faces().into_iter().flatten().collect();
        used.sort_unstable();
        used.dedup();
        used.into_iter().map(move |index| positions[index as usize].as_dvec3()).collect::<Vec<_>>()
    };
    scene.shapes.iter().flat_map(of_shape).collect()
}

/// Corners of the box around the points.
fn bounds(points: &[DVec3]) -> Option<(DVec3, DVec3)> {
    let (first, rest) = points.split_first()?;
    Some(rest.iter().fold((*first, *first), |(min, max), point| (min.min(*point), max.max(*point))))
}
