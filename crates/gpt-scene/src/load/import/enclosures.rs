//! The places of media: behind and before the surfaces of shapes.
//!
//! In other programs a shape says what is on both of its sides, and one that says nothing leaves a path in the medium that it is in. Here a body says
//! what it holds, and is within whatever is around it. So what is around a shape is found by the boxes around all of them, and what a shape says
//! otherwise is reported.

use std::collections::{HashMap, HashSet};

use glam::DVec3;

use super::description::Description;
use crate::load::file::material::blend_weight::{BlendWeightEntry, FresnelWeight};
use crate::load::file::material::{MaterialEntry, blend, mirror, pass};
use crate::load::file::medium::MediumEntry;
use crate::load::file::shape::ShapeEntry;
use crate::load::file::value::vector;
use crate::load::place::Place;

/// Most pairs of shapes that are looked at to find which is within which.
const MOST_PAIRS: usize = 1 << 24;
/// Reflections between the faces of a thin wall; half of what is left after them is lost.
const BETWEEN_FACES: usize = 5;

/// The media on the sides of a shape, by their names.
#[derive(Debug, Clone, Default)]
pub struct Sides {
    /// Behind its surface.
    pub inside: Option<String>,
    /// Before its surface.
    pub outside: Option<String>,
    /// The shape says of a side what is there.
    pub is_boundary: bool,
}

/// A shape that bounds a medium, or a body that is within one.
struct Enclosure {
    place: Place,
    /// Its number in the scene.
    shape: usize,
    sides: Sides,
    /// Light goes through its surface.
    is_crossed: bool,
    /// The lower and upper corner of the box around it; None of what is infinite.
    bounds: Option<[DVec3; 2]>,
    /// A measure by which boxes are ordered, flat ones too.
    size: f64,
}

impl Enclosure {
    fn is_within(&self, other: &Self) -> bool {
        let (Some([low, high]), Some([other_low, other_high])) = (self.bounds, other.bounds) else { return false };
        let slack = (other_high - other_low) * 1e-6;
        low.cmpge(other_low - slack).all() && high.cmple(other_high + slack).all() && self.size < other.size
    }
}

/// Shapes that bound media, and the materials that were made for them.
#[derive(Default)]
pub struct Enclosures {
    /// The medium that the camera is within.
    pub around_camera: Option<String>,
    shapes: Vec<Enclosure>,
    /// Materials that enclose a medium, by the names of the material without it and of the medium.
    filled: HashMap<(String, String), String>,
    /// Materials that light gets into and is refracted by, by their names.
    bodies: HashMap<String, bool>,
    /// Materials that light goes through.
    crossed: HashMap<String, bool>,
    /// The name of a medium that neither takes nor gives.
    clear: Option<String>,
    materials: MaterialNumbers,
}

/// Numbers of the scene's materials by their names; of those that share a name, that of the last one.
#[derive(Default)]
struct MaterialNumbers {
    by_name: HashMap<String, usize>,
    /// So many of the scene's materials are in it: they are added one by one.
    known: usize,
}

impl MaterialNumbers {
    fn find<'d>(&mut self, scene: &'d Description, name: &str) -> Option<&'d MaterialEntry> {
        let materials = &scene.file.material;
        for (number, entry) in materials.iter().enumerate().skip(self.known) {
            self.by_name.insert(entry.name().to_owned(), number);
        }
        self.known = materials.len();
        self.by_name.get(name).map(|number| &materials[*number])
    }
}

impl Enclosures {
    /// Notes a shape that is about to be added to the scene, with the material that it has.
    pub fn note(&mut self, scene: &Description, entry: &ShapeEntry, sides: Sides, place: &Place) {
        let Some(material) = entry.common().material.map(|name| name.value.clone()) else { return };
        if sides.is_boundary || self.is_body(scene, &material) {
            let is_crossed = self.is_crossed(scene, &material);
            let bounds = scene.bounds_of(entry);
            let size = bounds.map_or(f64::INFINITY, |[low, high]| (high - low).length());
            self.shapes.push(Enclosure { place: place.clone(), shape: scene.file.shape.len(), sides, is_crossed, bounds, size });
        }
    }

    /// The material of a shape of a group, which is placed by its instances: what is around those is the camera's medium.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of_group(
        &mut self,
        scene: &mut Description,
        material: String,
        sides: &Sides,
        place: &Place,
    ) -> Result<String, String> {
        if sides.is_boundary && sides.outside != self.around_camera {
            report_outside(scene, sides, self.around_camera.is_some(), place);
        }
        let is_body = self.is_body(scene, &material);
        let medium = match (&sides.inside, sides.is_boundary, self.around_camera.clone()) {
            (Some(inside), true, _) => inside.clone(),
            (None, true, _) if self.is_crossed(scene, &material) => self.clear(scene, place),
            (_, false, Some(around)) if is_body => around,
            _ => return Ok(material),
        };
        self.fill(scene, material, medium, place)
    }

    /// A material like this one around a medium.
    fn fill(&mut self, scene: &mut Description, material: String, medium: String, place: &Place) -> Result<String, String> {
        let key = (material, medium);
        if let Some(known) = self.filled.get(&key) {
            return Ok(known.clone());
        }
        let (material, medium) = &key;
        let Some(mut entry) = self.materials.find(scene, material).cloned() else { return Ok(material.clone()) };
        // A body keeps what it holds by itself.
        if entry.common().interior.is_some() {
            return Ok(material.clone());
        }
        if is_thin(&entry) {
            entry = thin_wall(scene, &entry, place)?;
        }
        let name = scene.free_material_name(&format!("{material}, around {medium}"));
        let common = entry.common_mut();
        *common.name = place.at(name.clone());
        *common.interior = Some(place.at(medium.clone()));
        scene.file.material.push(entry);
        scene.material_variants.insert(name.clone(), material.clone());
        self.filled.insert(key, name.clone());
        Ok(name)
    }

    fn clear(&mut self, scene: &mut Description, place: &Place) -> String {
        if let Some(known) = &self.clear {
            return known.clone();
        }
        let name = scene.free_medium_name("(empty)");
        scene.file.medium.push(MediumEntry { name: place.at(name.clone()), ..MediumEntry::default() });
        self.clear = Some(name.clone());
        name
    }

    /// Light goes through a surface of this material, as it is or bent.
    fn is_crossed(&mut self, scene: &Description, name: &str) -> bool {
        let materials = &mut self.materials;
        *self.crossed.entry(name.to_owned()).or_insert_with(|| is_crossed(materials, scene, name))
    }

    /// Light gets into bodies of this material, which bends it.
    fn is_body(&mut self, scene: &Description, name: &str) -> bool {
        if let Some(known) = self.bodies.get(name) {
            return *known;
        }
        // Blends share their parts: each is looked at once.
        let is_body = match self.materials.find(scene, name) {
            Some(entry @ (MaterialEntry::Glass(_) | MaterialEntry::RoughGlass(_))) => !is_thin(entry),
            Some(entry @ MaterialEntry::Principled(keys)) => keys.transmission.is_some() && !is_thin(entry),
            Some(entry) => entry.parts().iter().any(|part| self.is_body(scene, &part.value)),
            None => false,
        };
        self.bodies.insert(name.to_owned(), is_body);
        is_body
    }

    /// Gives bodies that say nothing the medium around them, and reports what is not around a shape though it says so.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn settle(mut self, scene: &mut Description) -> Result<(), String> {
        let shapes = std::mem::take(&mut self.shapes);
        if !shapes.iter().any(|shape| shape.sides.is_boundary) && self.around_camera.is_none() {
            return Ok(());
        }
        let mut hulls: Vec<&Enclosure> = shapes.iter().filter(|shape| shape.sides.is_boundary && shape.is_crossed).collect();
        if hulls.len().saturating_mul(shapes.len()) > MOST_PAIRS {
            hulls.clear();
        }
        hulls.sort_by(|a, b| a.size.total_cmp(&b.size));
        let around_all = self.around_camera.clone().filter(|medium| !leaves_with_rays(scene, medium, &hulls));
        for shape in &shapes {
            // Smaller ones hold nothing of it.
            let first = hulls.partition_point(|hull| hull.size <= shape.size);
            let hull = hulls[first..].iter().find(|hull| shape.is_within(hull));
            let around = match hull {
                Some(hull) => hull.sides.inside.clone(),
                None => around_all.clone(),
            };
            if shape.sides.is_boundary && shape.sides.outside != around {
                report_outside(scene, &shape.sides, around.is_some(), &shape.place);
            }
            let medium = match (&shape.sides.inside, shape.sides.is_boundary, around) {
                (Some(inside), true, _) => inside.clone(),
                (None, true, _) if shape.is_crossed => self.clear(scene, &shape.place),
                (_, false, Some(around)) => around,
                _ => continue,
            };
            let material = scene.file.shape[shape.shape].value.common().material.cloned();
            if let Some(material) = material {
                let filled = self.fill(scene, material.value, medium, &shape.place)?;
                *scene.file.shape[shape.shape].value.common_mut().material = Some(shape.place.at(filled));
            }
        }
        Ok(())
    }
}

/// The camera is within a body of this medium, which rays leave that go out of the body.
fn leaves_with_rays(scene: &Description, medium: &str, hulls: &[&Enclosure]) -> bool {
    let Some(camera) = &scene.file.camera else { return false };
    let eye = vector(camera.position);
    let is_around = |[low, high]: [DVec3; 2]| eye.cmpge(low).all() && eye.cmple(high).all();
    let holds = |hull: &Enclosure| hull.sides.inside.as_deref() == Some(medium);
    hulls.iter().any(|hull| holds(hull) && hull.bounds.is_some_and(is_around))
}

fn report_outside(scene: &mut Description, sides: &Sides, is_around: bool, place: &Place) {
    let said = if sides.outside.is_some() { "exterior medium of a shape" } else { "no medium outside of a shape" };
    let instead = match is_around {
        true => "the medium counts that the shapes and the camera around it say",
        false => "nothing is around it, as the shapes and the camera around it say",
    };
    scene.report.approximate(said, place.to_string(), instead);
}

/// Light goes through a surface of this material, as it is or bent.
fn is_crossed(materials: &mut MaterialNumbers, scene: &Description, name: &str) -> bool {
    // Parts that many blends share are looked at once.
    let mut seen = HashSet::new();
    let mut to_visit = vec![name];
    while let Some(name) = to_visit.pop() {
        match materials.find(scene, name).filter(|_| seen.insert(name)) {
            Some(MaterialEntry::Glass(_) | MaterialEntry::RoughGlass(_) | MaterialEntry::Pass(_)) => return true,
            Some(MaterialEntry::Principled(keys)) if keys.transmission.is_some() => return true,
            // The other side is below the lowest interface.
            Some(MaterialEntry::Layered(keys)) => to_visit.extend(keys.interfaces.0.last().map(|part| part.value.as_str())),
            Some(entry) => to_visit.extend(entry.parts().iter().map(|part| part.value.as_str())),
            None => {}
        }
    }
    false
}

fn is_thin(entry: &MaterialEntry) -> bool {
    let thin = match entry {
        MaterialEntry::Glass(keys) => return keys.thin,
        MaterialEntry::RoughGlass(_) => return false,
        MaterialEntry::Principled(keys) => keys.thin.as_ref(),
        _ => None,
    };
    thin.is_some_and(|thin| thin.value)
}

/// A wall without thickness as a blend of a mirror and of nothing, so that rays go through it into the medium, and shadow rays too.
///
/// Each face reflects the share R, and of what is between them all reflections count: 2R/(1 + R), which is R + (1 − R)·x by x = R·(1 − x). Each blend
/// by R takes one step of that.
///
/// # Errors
/// A sentence about a number that is out of range.
fn thin_wall(scene: &mut Description, wall: &MaterialEntry, place: &Place) -> Result<MaterialEntry, String> {
    let (ior, reflectance, is_tinted) = match wall {
        MaterialEntry::Glass(keys) => {
            (keys.ior.as_ref().map(|ior| ior.value), keys.reflectance.clone(), keys.transmittance.is_some())
        }
        _ => (None, None, true),
    };
    if is_tinted {
        scene.report.approximate("thin wall around a medium", place.to_string(), "what goes through it keeps its colour");
    }
    let mut add = |wanted: &str, mut entry: MaterialEntry| {
        let name = scene.free_material_name(wanted);
        *entry.common_mut().name = place.at(name.clone());
        scene.file.material.push(entry);
        name
    };
    let mirror = add("mirror of a thin wall", MaterialEntry::from(mirror::Keys { reflectance, ..Default::default() }));
    let nothing = add("behind a thin wall", MaterialEntry::from(pass::Keys::default()));
    // A blend of what is where light passes the face, and where the face reflects it.
    let by_face = |passed: String, reflected: String| {
        let weight = BlendWeightEntry::Fresnel(FresnelWeight { ior, exact: true });
        MaterialEntry::from(blend::Keys::of([passed, reflected], weight, place))
    };
    let half = BlendWeightEntry::constant(0.5)?;
    let half = MaterialEntry::from(blend::Keys::of([mirror.clone(), nothing.clone()], half, place));
    let mut between = add("between the faces of a thin wall", half);
    // The last step has the share x of the mirror: each one before has it of what the step after leaves.
    for step in 0..BETWEEN_FACES {
        let rest = if (BETWEEN_FACES - step) % 2 == 1 { &nothing } else { &mirror };
        between = add("between the faces of a thin wall", by_face(rest.clone(), between));
    }
    Ok(by_face(between, mirror))
}
