//! Tracks of keys: transforms in parts, nodes, shapes and the camera.

use glam::{DAffine3, DQuat, DVec3};

use super::curve::{Curve, Moment, Turn};
use crate::scene::camera::{Camera, Projection};
use crate::scene::light_at::LightAt;
use crate::scene::material::{Emission, Material};
use crate::scene::texture::ColorInput;
use crate::scene::transform::Transform;
use crate::spectrum::Spectrum;

/// A transform in parts, each with keys of its own: first scaled, then turned, then moved. A part without keys does nothing.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct TransformTrack {
    pub scale: Curve<DVec3>,
    pub rotation: Curve<Turn>,
    pub translation: Curve<DVec3>,
}

impl TransformTrack {
    /// The map while the shutter is open.
    pub fn during(&self, moment: Moment) -> DAffine3 {
        DAffine3::from_scale_rotation_translation(
            self.scale.during(moment).unwrap_or(DVec3::ONE),
            self.rotation.during(moment).map_or(DQuat::IDENTITY, Turn::rotation),
            self.translation.during(moment).unwrap_or(DVec3::ZERO),
        )
    }

    /// The frames of all its keys.
    pub fn frames(&self) -> impl Iterator<Item = f64> {
        let vectors = [&self.scale, &self.translation].into_iter().flat_map(|curve| curve.keys.iter().map(|key| key.frame));
        vectors.chain(self.rotation.keys.iter().map(|key| key.frame))
    }
}

/// A frame of reference, perhaps within another, that takes along what names it.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Node {
    pub name: String,
    pub parent: Option<usize>,
    /// The placement in its parent without a frame.
    pub rest: DAffine3,
    pub track: Option<TransformTrack>,
}

/// A shape that is elsewhere at another frame.
#[derive(Debug, Clone, PartialEq)]
pub struct ShapeTrack {
    /// Index among the scene's shapes.
    pub shape: usize,
    /// Takes the place of the shape's transform.
    pub track: Option<TransformTrack>,
    /// The node that takes it along.
    pub node: Option<usize>,
    /// The transform without a frame.
    pub rest: Transform,
}

/// The camera's keys. They take the place of the camera's values without a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct CameraTrack {
    pub position: Curve<DVec3>,
    pub look_at: Curve<DVec3>,
    pub up: Curve<DVec3>,
    /// The vertical field of view in degrees, or the height of an orthographic camera's window.
    pub opening: Curve<f64>,
    pub focus_distance: Curve<f64>,
    /// The node that takes it along.
    pub node: Option<usize>,
}

/// A light's keys. They take the place of the light's values without a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LightTrack {
    /// Index among the scene's lights.
    pub light: usize,
    pub position: Curve<DVec3>,
    /// The direction, of length 1 at the keys and made so in between.
    pub direction: Curve<DVec3>,
    /// Intensity, irradiance or radiance.
    pub strength: Curve<Spectrum>,
    /// The rotation of an environment, in degrees.
    pub rotation: Curve<f64>,
    /// The node that takes it along.
    pub node: Option<usize>,
}

/// A material's keys, by the [numbers](Material::numbers) that they stand for. They take the place of those without a frame.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MaterialTrack {
    /// Index among the scene's materials.
    pub material: usize,
    /// The material emits at some frame, on both sides where this is true: it has an emission then, perhaps a black one, among its numbers.
    pub emits: Option<bool>,
    /// The places of numbers, each with its keys.
    pub numbers: Vec<(usize, Curve<f64>)>,
}

impl MaterialTrack {
    /// The material, as it is without a frame, with all numbers that it has at some frame.
    pub fn with_all_numbers(&self, rest: &Material) -> Material {
        let black = |two_sided| Emission { radiance: ColorInput::grey(0.0), two_sided };
        Material { emission: rest.emission.or(self.emits.map(black)), ..rest.clone() }
    }

    /// The material at a frame.
    pub fn at(&self, rest: &Material, frame: f64) -> Material {
        let form = self.with_all_numbers(rest);
        let mut numbers = form.numbers();
        for (number, curve) in &self.numbers {
            numbers[*number] = curve.at(frame).unwrap_or(numbers[*number]);
        }
        let mut material = form.with_numbers(&numbers);
        material.emission = material.emission.filter(|emission| emission.radiance != ColorInput::grey(0.0));
        material
    }

    /// The frames of all its keys.
    pub fn frames(&self) -> impl Iterator<Item = f64> {
        self.numbers.iter().flat_map(|(_, curve)| curve.keys.iter().map(|key| key.frame))
    }
}

impl LightTrack {
    /// The state of its keys at a frame, before its node moves it.
    pub fn at(&self, frame: f64) -> LightAt {
        LightAt {
            position: self.position.at(frame),
            // Opposite directions have none halfway, which whoever looks at the light finds.
            direction: self.direction.at(frame).map(DVec3::normalize_or_zero),
            strength: self.strength.at(frame),
            rotation_degrees: self.rotation.at(frame),
            along: DAffine3::IDENTITY,
        }
    }

    /// The frames of all its keys.
    pub fn frames(&self) -> impl Iterator<Item = f64> {
        let vectors = [&self.position, &self.direction].into_iter().flat_map(|curve| curve.keys.iter().map(|key| key.frame));
        let strengths = self.strength.keys.iter().map(|key| key.frame);
        vectors.chain(strengths).chain(self.rotation.keys.iter().map(|key| key.frame))
    }
}

impl CameraTrack {
    /// The camera while the shutter is open, before its node moves it.
    pub fn during(&self, rest: &Camera, moment: Moment) -> Camera {
        let opening = |rest: f64| self.opening.during(moment).unwrap_or(rest);
        Camera {
            position: self.position.during(moment).unwrap_or(rest.position),
            look_at: self.look_at.during(moment).unwrap_or(rest.look_at),
            up: self.up.during(moment).unwrap_or(rest.up),
            projection: match rest.projection {
                Projection::Perspective { vertical_fov_degrees } => {
                    Projection::Perspective { vertical_fov_degrees: opening(vertical_fov_degrees) }
                }
                Projection::Orthographic { height } => Projection::Orthographic { height: opening(height) },
                other => other,
            },
            focus_distance: self.focus_distance.during(moment).unwrap_or(rest.focus_distance),
            ..rest.clone()
        }
    }

    /// The frames of all its keys.
    pub fn frames(&self) -> impl Iterator<Item = f64> {
        let vectors =
            [&self.position, &self.look_at, &self.up].into_iter().flat_map(|curve| curve.keys.iter().map(|key| key.frame));
        let numbers = [&self.opening, &self.focus_distance].into_iter().flat_map(|curve| curve.keys.iter().map(|key| key.frame));
        vectors.chain(numbers)
    }
}
