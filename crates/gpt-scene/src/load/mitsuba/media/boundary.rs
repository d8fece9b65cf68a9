//! The places of media: behind and before the surfaces of shapes.
//!
//! There a shape says what is on both of its sides, and one that says nothing leaves a path in the medium that it is in. Here a body says what it
//! holds, and is within whatever is around it. So what is around a shape is found by the boxes around all of them, and what a shape says otherwise
//! is reported.

use std::rc::Rc;

use glam::DVec3;

use crate::load::error::SceneError;
use crate::load::file::material::blend_weight::{BlendWeightEntry, FresnelWeight};
use crate::load::file::material::{MaterialEntry, blend, mirror, pass};
use crate::load::file::shape::ShapeEntry;
use crate::load::file::value::vector;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::met_media::{Boundary, Sides};
use crate::load::mitsuba::plugin::Plugin;

/// Most pairs of shapes that are looked at to find which is within which.
const MOST_PAIRS: usize = 1 << 24;
/// Reflections between the faces of a thin wall; half of what is left after them is lost.
const BETWEEN_FACES: usize = 5;

impl Converter<'_> {
    /// True of a shape of a version before 2 that bounds a medium by itself: it has no BSDF and no emitter.
    pub fn is_bare_boundary(&self, shape: &Plugin) -> bool {
        let is_boundary = shape.children.iter().any(|child| child.plugin.kind == "medium");
        let gives_light = shape.children.iter().any(|child| child.plugin.kind == "emitter");
        self.reader.is_of_old && is_boundary && !gives_light
    }

    /// The media that a shape names.
    pub fn boundary(&mut self, shape: &Rc<Plugin>, has_bsdf: bool) -> Result<Sides, SceneError> {
        let medium = |name: &str| shape.child(name).filter(|child| child.kind == "medium").cloned();
        let (interior, exterior) = (medium("interior"), medium("exterior"));
        let is_boundary = interior.is_some() || exterior.is_some();
        if !is_boundary || self.leaves_media_out(shape) {
            return Ok(Sides::default());
        }
        if !has_bsdf && !self.is_bare_boundary(shape) {
            let instead = "nothing shows it: without a BSDF the shape is a diffuse surface, as in version 3.9.1; with `null` it would be a boundary alone";
            self.drop(shape, "medium of a shape without a BSDF", instead);
            return Ok(Sides::default());
        }
        Ok(Sides { interior, exterior, is_boundary })
    }

    /// The material of a shape, with what it encloses.
    pub fn around_medium(&mut self, shape: &Rc<Plugin>, material: String, sides: &Sides) -> Result<String, SceneError> {
        let medium = match (&sides.interior, sides.is_boundary) {
            (Some(interior), _) => self.medium(interior)?,
            // The surroundings of the others are known once all shapes are.
            _ if !self.media.in_group => return Ok(material),
            (None, true) => self.clear_medium(shape),
            (None, false) => match self.media.around_sensor.clone() {
                Some(around) if self.is_body(&material) => self.medium(&around)?,
                _ => return Ok(material),
            },
        };
        self.filled(shape, material, medium)
    }

    /// A material like this one around a medium.
    fn filled(&mut self, shape: &Plugin, material: String, medium: String) -> Result<String, SceneError> {
        let key = (material, medium);
        if let Some(known) = self.media.filled.get(&key) {
            return Ok(known.clone());
        }
        let (material, medium) = &key;
        // The one made last is asked for first.
        let entry = self.scene.file.material.iter().rev().find(|entry| entry.name() == material.as_str());
        let Some(mut entry) = entry.cloned() else { return Ok(material.clone()) };
        if is_thin(&entry) {
            entry = self.thin_wall(shape, &entry)?;
        }
        let name = self.scene.free_material_name(&format!("{material}, around {medium}"));
        let common = entry.common_mut();
        *common.name = shape.at().at(name.clone());
        *common.interior = Some(shape.at().at(medium.clone()));
        self.scene.file.material.push(entry);
        self.scene.material_variants.insert(name.clone(), material.clone());
        self.media.filled.insert(key, name.clone());
        Ok(name)
    }

    /// A wall without thickness as a blend of a mirror and of nothing, so that rays go through it into the medium, and shadow rays too.
    ///
    /// Each face reflects the share R, and of what is between them all reflections count: 2R/(1 + R), which is R + (1 − R)·x by x = R·(1 − x). Each
    /// blend by R takes one step of that.
    fn thin_wall(&mut self, shape: &Plugin, wall: &MaterialEntry) -> Result<MaterialEntry, SceneError> {
        let (ior, reflectance, is_tinted) = match wall {
            MaterialEntry::Glass(keys) => {
                (keys.ior.as_ref().map(|ior| ior.value), keys.reflectance.clone(), keys.transmittance.is_some())
            }
            _ => (None, None, true),
        };
        if is_tinted {
            self.approximate(shape, "thin wall around a medium", "what goes through it keeps its colour");
        }
        let place = shape.at();
        let mut add = |wanted: &str, mut entry: MaterialEntry| {
            let name = self.scene.free_material_name(wanted);
            *entry.common_mut().name = place.at(name.clone());
            self.scene.file.material.push(entry);
            name
        };
        let mirror = add("mirror of a thin wall", MaterialEntry::from(mirror::Keys { reflectance, ..Default::default() }));
        let nothing = add("behind a thin wall", MaterialEntry::from(pass::Keys::default()));
        // A blend of what is where light passes the face, and where the face reflects it.
        let by_face = |passed: String, reflected: String| {
            let weight = BlendWeightEntry::Fresnel(FresnelWeight { ior, exact: true });
            MaterialEntry::from(blend::Keys::of([passed, reflected], weight, &place))
        };
        let half = BlendWeightEntry::constant(0.5).map_err(|message| shape.error(message))?;
        let half = MaterialEntry::from(blend::Keys::of([mirror.clone(), nothing.clone()], half, &place));
        let mut between = add("between the faces of a thin wall", half);
        // The last step has the share x of the mirror: each one before has it of what the step after leaves.
        for step in 0..BETWEEN_FACES {
            let rest = if (BETWEEN_FACES - step) % 2 == 1 { &nothing } else { &mirror };
            between = add("between the faces of a thin wall", by_face(rest.clone(), between));
        }
        Ok(by_face(between, mirror))
    }

    /// Notes a shape that is to be added to the scene.
    pub fn note_boundary(&mut self, plugin: &Rc<Plugin>, entry: &ShapeEntry, sides: Sides) {
        let material = entry.common().material.map(|name| name.value.clone());
        let is_seen_through = sides.is_boundary || material.is_some_and(|name| self.is_body(&name));
        if is_seen_through {
            let bounds = self.scene.bounds_of(entry);
            let shape = self.scene.file.shape.len();
            self.media.boundaries.push(Boundary { plugin: plugin.clone(), shape, sides, bounds });
        }
    }

    /// Begins a group that instances name, or ends it: only the sensor's medium is around its shapes.
    pub fn enter_group(&mut self, is_entered: bool) {
        self.media.in_group = is_entered;
    }

    /// Forgets those from this number on: they are parts of a group. What is around those is not looked for.
    pub fn forget_boundaries(&mut self, before: usize) {
        let (kept, of_group): (Vec<Boundary>, Vec<Boundary>) =
            std::mem::take(&mut self.media.boundaries).into_iter().partition(|boundary| boundary.shape < before);
        self.media.boundaries = kept;
        for boundary in of_group.into_iter().filter(|boundary| boundary.sides.is_boundary) {
            let around = self.media.around_sensor.clone();
            self.report_exterior(&boundary, around.as_ref());
        }
    }

    /// Gives bodies that say nothing the medium around them, and reports what is not around a shape though it says so.
    pub fn settle_media(&mut self) -> Result<(), SceneError> {
        let boundaries = std::mem::take(&mut self.media.boundaries);
        if !boundaries.iter().any(|boundary| boundary.sides.is_boundary) && self.media.around_sensor.is_none() {
            return Ok(());
        }
        let mut hulls: Vec<&Boundary> = boundaries.iter().filter(|boundary| boundary.sides.is_boundary).collect();
        if hulls.len().saturating_mul(boundaries.len()) > MOST_PAIRS {
            hulls.clear();
        }
        hulls.sort_by(|a, b| a.size().total_cmp(&b.size()));
        let around_all = self.media.around_sensor.clone().filter(|medium| !self.leaves_with_rays(medium, &hulls));
        for boundary in &boundaries {
            let hull = hulls.iter().find(|hull| boundary.is_within(hull));
            let around = match hull {
                Some(hull) => hull.sides.interior.clone(),
                None => around_all.clone(),
            };
            if boundary.sides.is_boundary {
                self.report_exterior(boundary, around.as_ref());
            }
            let medium = match (&boundary.sides.interior, boundary.sides.is_boundary, &around) {
                (Some(_), ..) | (None, false, None) => continue,
                (None, true, _) => self.clear_medium(&boundary.plugin),
                (None, false, Some(around)) => self.medium(around)?,
            };
            let material = self.scene.file.shape[boundary.shape].value.common().material.cloned();
            if let Some(material) = material {
                let filled = self.filled(&boundary.plugin, material.value, medium)?;
                *self.scene.file.shape[boundary.shape].value.common_mut().material = Some(boundary.plugin.at().at(filled));
            }
        }
        Ok(())
    }

    /// The sensor is within a body of this medium, which rays leave that go out of the body.
    fn leaves_with_rays(&self, medium: &Rc<Plugin>, hulls: &[&Boundary]) -> bool {
        let Some(camera) = &self.scene.file.camera else { return false };
        let eye = vector(camera.position);
        let is_around = |[low, high]: [DVec3; 2]| eye.cmpge(low).all() && eye.cmple(high).all();
        let holds = |hull: &Boundary| hull.sides.interior.as_ref().is_some_and(|interior| Rc::ptr_eq(interior, medium));
        hulls.iter().any(|hull| holds(hull) && hull.bounds.is_some_and(is_around))
    }

    fn report_exterior(&mut self, boundary: &Boundary, around: Option<&Rc<Plugin>>) {
        let exterior = boundary.sides.exterior.as_ref();
        let is_same = match (exterior, around) {
            (None, None) => true,
            (Some(exterior), Some(around)) => Rc::ptr_eq(exterior, around),
            _ => false,
        };
        if !is_same {
            let said = exterior.map_or("no medium outside of a shape", |_| "exterior medium of a shape");
            let instead = match around {
                Some(_) => "the medium counts that the shapes and the sensor around it say",
                None => "nothing is around it, as the shapes and the sensor around it say",
            };
            self.approximate(&boundary.plugin, said, instead);
        }
    }

    /// Light gets into bodies of this material, which bends it.
    fn is_body(&mut self, name: &str) -> bool {
        if let Some(known) = self.media.bodies.get(name) {
            return *known;
        }
        // Blends share their parts: each is looked at once. The one made last is asked for first.
        let entry = self.scene.file.material.iter().rev().find(|entry| entry.name() == name);
        let is_body = match entry {
            Some(entry @ (MaterialEntry::Glass(_) | MaterialEntry::RoughGlass(_))) => !is_thin(entry),
            Some(entry @ MaterialEntry::Principled(keys)) => keys.transmission.is_some() && !is_thin(entry),
            Some(entry) => {
                let parts: Vec<String> = entry.parts().iter().map(|part| part.value.clone()).collect();
                parts.iter().any(|part| self.is_body(part))
            }
            None => false,
        };
        self.media.bodies.insert(name.to_owned(), is_body);
        is_body
    }
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
