//! A scene as one of pbrt-v4, as far as it can be said there.
//!
//! A light's `rgb` is multiplied there by the spectrum of sRGB's white, whose photometric value the light is divided by, and a film of sRGB with the
//! default sensor weighs what arrives by the same curve: the numbers of an `rgb` are those of the film. Radiance, intensity and irradiance are
//! therefore written as they are, without `power` or `illuminance`.
//!
//! Shapes are written where they stand in the world, so that no transform turns their fronts; what is stored once and stands in many places is an
//! object there too.

mod camera;
mod directive;
mod environment;
mod glass;
mod light;
mod made;
mod material;
mod medium;
mod principled;
mod shape;
mod stack;
mod texture;
mod weight;

use std::collections::{HashMap, HashSet};
use std::path::Path;

use self::directive::Directive;
use self::made::{Made, Relief};
use super::flat_camera::with_flat_camera;
use super::losses::Losses;
use super::surroundings::{Surroundings, with_media_below_surfaces};
use super::written::WrittenScene;
use crate::load::file::writer::{Names, SideFiles};
use crate::scene::{Material, MaterialId, Projection, Scene};

/// A scene as one of pbrt-v4 that is to be written to `target`; meshes and pictures that it embeds lie in the folder `NAME.files` beside it. `name`
/// is how reports call the scene.
pub fn as_pbrt(scene: &Scene, name: &str, target: &Path) -> WrittenScene {
    let mut losses = Losses::of(name);
    losses.drop_links(scene);
    let has = |projection: &Projection| matches!(projection, Projection::Equirectangular(model) if model.is_full());
    let scene = &with_flat_camera(scene, &mut losses, has);
    let scene = &with_media_below_surfaces(scene);
    let bodies: Vec<String> = scene.materials.iter().map(|material| format!("body of {}", material.name)).collect();
    let mut writer = Writer {
        scene,
        target,
        losses,
        files: SideFiles::beside(target),
        materials: Names::unique(scene.materials.iter().map(|material| material.name.as_str()), "material"),
        media: Names::unique(
            scene.media.iter().map(|medium| medium.name.as_str()).chain(bodies.iter().map(String::as_str)),
            "medium",
        ),
        taken: HashSet::new(),
        made: HashMap::new(),
        textures: HashMap::new(),
        surroundings: Surroundings::of(scene),
        is_textured: scene.materials_that(Material::uses_texture),
        is_bent: scene.materials_that(|material| material.normal_map.is_some()),
        out: String::new(),
        depth: 0,
    };
    writer.all();
    let content = writer.out.into_bytes();
    WrittenScene { content, files: writer.files.into_files(), report: writer.losses.into_report() }
}

struct Writer<'w> {
    scene: &'w Scene,
    target: &'w Path,
    losses: Losses,
    files: SideFiles,
    materials: Names,
    /// Names of the media, then of what may be within bodies of each material.
    media: Names,
    /// Names of materials and textures that stand in the text.
    taken: HashSet<String>,
    /// Materials that are written, each with the map that bends the normals of a blend that it is a part of.
    made: HashMap<(MaterialId, Option<Relief>), Made>,
    /// Names of textures, by what they are made from.
    textures: HashMap<String, String>,
    surroundings: Surroundings,
    /// For each material: it, or a part of it, looks up a texture.
    is_textured: Vec<bool>,
    /// For each material: a map bends its normals, or those of a part of it.
    is_bent: Vec<bool>,
    out: String,
    /// Blocks of attributes around the next line.
    depth: usize,
}

impl Writer<'_> {
    fn all(&mut self) {
        self.line("# A scene of pbrt-v4: https://pbrt.org".to_owned());
        self.settings();
        for index in 0..self.scene.meters.len() {
            self.drop("meter", &format!("meter[{index}]"), "it is not written");
        }
        self.media();
        self.camera();
        self.line(String::new());
        self.line("WorldBegin".to_owned());
        if self.scene.camera_medium.is_some() {
            // The camera's medium is not on the backs of all surfaces.
            self.push(Directive::new("MediumInterface", &["", ""]));
        }
        self.lights();
        self.shapes();
        self.instances();
        self.report_animation();
    }

    fn line(&mut self, line: String) {
        let indent = if line.is_empty() { String::new() } else { "    ".repeat(self.depth) };
        self.out += &format!("{indent}{line}\n");
    }

    fn push(&mut self, directive: Directive) {
        self.line(directive.to_string());
    }

    /// Lines that have no effect on those behind them.
    fn attributes(&mut self, within: impl FnOnce(&mut Self)) {
        self.line("AttributeBegin".to_owned());
        self.depth += 1;
        within(self);
        self.depth -= 1;
        self.line("AttributeEnd".to_owned());
    }

    /// A name that nothing else has.
    fn free_name(&mut self, wanted: &str) -> String {
        let others = (2..).map(|number| format!("{wanted} ({number})"));
        let free = std::iter::once(wanted.to_owned()).chain(others).find(|name| !self.taken.contains(name));
        // There are more numbers than names.
        let name = free.unwrap_or_else(|| wanted.to_owned());
        self.taken.insert(name.clone());
        name
    }

    fn drop(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.losses.drop(what, place, instead);
    }

    fn approximate(&mut self, what: impl Into<String>, place: &str, instead: impl Into<String>) {
        self.losses.approximate(what, place, instead);
    }

    fn report_animation(&mut self) {
        let animation = &self.scene.animation;
        let has_keys = animation.frames().is_some();
        if has_keys {
            self.drop("keyframes", "animation", "the scene is written as it is at rest");
        }
    }
}

#[cfg(test)]
mod tests;
