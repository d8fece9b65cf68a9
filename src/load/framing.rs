//! A stage for a model that comes without one: ground, light, camera, all sized by the model.

use glam::DVec3;

use super::error::SceneError;
use crate::scene::{
    Camera, ColorInput, Emission, Environment, EnvironmentRadiance, Geometry, Light, Material, MaterialKind, Plane, Projection,
    Rectangle, Scene, Shape, Transform,
};

/// Vertical field of view of the camera, degrees: a short telephoto lens, which does not distort.
pub const FIELD_OF_VIEW: f64 = 30.0;
/// Reflectance of the ground.
pub const GROUND: f64 = 0.5;
/// Radiance of the light and of the sky.
pub const LIGHT: f64 = 8.0;
pub const SKY: f64 = 0.4;

/// Puts the scene's shapes, which stand with +Y up, on a grey ground under a soft rectangle light and a dim grey sky, seen from the
/// front (+Z), a little from the right and from above.
pub fn frame(mut scene: Scene, name: &str) -> Result<Scene, SceneError> {
    let stage = Stage::around(bounds(&scene), name)?;
    let ground = diffuse("(ground)", GROUND);
    let light = Material {
        name: "(light)".to_owned(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission: Some(Emission { radiance: ColorInput::grey(LIGHT), two_sided: false }),
    };
    add(&mut scene, "(ground)", ground, Geometry::Plane(stage.ground));
    add(&mut scene, "(light)", light, Geometry::Rectangle(stage.light));
    scene.lights.push(Light::Environment(Environment {
        radiance: EnvironmentRadiance::Constant(DVec3::splat(SKY)),
        rotation_degrees: 0.0,
    }));
    scene.camera = stage.camera;
    Ok(scene)
}

/// Where ground, light and camera stand.
pub struct Stage {
    /// Infinite, so that the horizon is level wherever the camera stands.
    pub ground: Plane,
    /// Above the camera's left shoulder, facing the model.
    pub light: Rectangle,
    pub camera: Camera,
}

impl Stage {
    /// Around a box, given by its corners.
    ///
    /// # Errors
    /// There is no box, or nothing in it.
    pub fn around(bounds: Option<(DVec3, DVec3)>, name: &str) -> Result<Self, SceneError> {
        let (min, max) = bounds.ok_or_else(|| SceneError::in_file(name, "the model has no vertices"))?;
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
        Ok(Self { ground, light: Rectangle { corner, edge_u: along, edge_v: across }, camera: camera(center, radius) })
    }
}

/// Far enough for the bounding sphere to be in the picture, with some room around it.
fn camera(center: DVec3, radius: f64) -> Camera {
    let distance = 1.05 * radius / (0.5 * FIELD_OF_VIEW.to_radians()).sin();
    let toward_camera = DVec3::new(0.5, 0.35, 1.0).normalize();
    Camera {
        position: center + distance * toward_camera,
        look_at: center,
        up: DVec3::Y,
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
    });
}

/// Corners of the box around every mesh of the scene.
fn bounds(scene: &Scene) -> Option<(DVec3, DVec3)> {
    let used = scene.shapes.iter().flat_map(|shape| {
        let positions = shape.world_positions();
        shape.world_faces().into_iter().flatten().map(move |index| positions[index as usize].as_dvec3()).collect::<Vec<_>>()
    });
    used.fold(None, |bounds, point| match bounds {
        None => Some((point, point)),
        Some((min, max)) => Some((min.min(point), max.max(point))),
    })
}
