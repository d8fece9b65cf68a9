//! All that a scene's files say, before anything of it is converted.

use std::collections::HashMap;
use std::rc::Rc;

use super::color_space::RgbSpace;
use super::graphics_state::{Maps, MaterialName};
use super::parameter::Entity;
use super::text::Spot;

/// The content of a scene.
#[derive(Debug, Default)]
pub struct World {
    pub camera: Option<CameraRecord>,
    pub film: Option<Entity>,
    pub sampler: Option<Entity>,
    pub filter: Option<Entity>,
    pub integrator: Option<Entity>,
    /// Times of the transforms at the start and at the end of motion.
    pub transform_times: [f64; 2],
    pub shapes: Vec<ShapeRecord>,
    pub lights: Vec<LightRecord>,
    pub objects: Vec<ObjectRecord>,
    pub object_numbers: HashMap<String, usize>,
    pub instances: Vec<InstanceRecord>,
    /// Materials without names; the first one is that of shapes before any other.
    pub materials: Vec<Rc<Entity>>,
    pub named_materials: HashMap<String, Rc<Entity>>,
    pub media: HashMap<String, Rc<PlacedEntity>>,
    pub float_textures: HashMap<String, Rc<PlacedEntity>>,
    pub spectrum_textures: HashMap<String, Rc<PlacedEntity>>,
}

/// The camera, by the map from the world to it.
#[derive(Debug)]
pub struct CameraRecord {
    pub entity: Entity,
    pub maps: Maps,
    pub medium: Rc<str>,
}

#[derive(Debug)]
pub struct ShapeRecord {
    pub entity: Entity,
    pub maps: Maps,
    pub reverses: bool,
    pub material: MaterialName,
    pub light: Option<Rc<Entity>>,
    pub inside: Rc<str>,
    pub outside: Rc<str>,
}

#[derive(Debug)]
pub struct LightRecord {
    pub entity: Entity,
    pub maps: Maps,
}

/// Shapes that `ObjectInstance` shows.
#[derive(Debug)]
pub struct ObjectRecord {
    pub name: String,
    pub spot: Spot,
    pub shapes: Vec<ShapeRecord>,
}

#[derive(Debug)]
pub struct InstanceRecord {
    pub name: String,
    pub spot: Spot,
    pub maps: Maps,
}

/// A directive that lies as a transform says.
#[derive(Debug)]
pub struct PlacedEntity {
    pub entity: Entity,
    pub maps: Maps,
}

impl World {
    pub fn new() -> Self {
        Self { transform_times: [0.0, 1.0], ..Self::default() }
    }

    /// The space of the film's colours.
    pub fn film_space(&self) -> RgbSpace {
        self.film.as_ref().map_or(RgbSpace::Srgb, |film| film.space)
    }
}
