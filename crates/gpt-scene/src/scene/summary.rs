//! A scene in numbers, for `gpt check`.

use std::collections::BTreeMap;
use std::fmt::{self, Write};

use serde::Serialize;

use super::instance::Group;
use super::light::Light;
use super::material::MaterialId;
use super::model::Scene;
use super::settings::RenderSettings;
use super::shape::{Geometry, Shape};
use super::texture::TextureKind;
use crate::choice::Choice;

/// A scene of at most so many primitives is small: kernels hold its geometry as constants, and trial runs count costs so.
pub const FEW_PRIMITIVES: usize = 64;

/// The contents of a scene. Maps go from the scene file's name of a type to how often it occurs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SceneSummary {
    pub name: String,
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub filter: String,
    #[serde(flatten)]
    pub render: RenderSettings,
    pub shapes: BTreeMap<&'static str, usize>,
    /// Over all meshes.
    pub triangles: usize,
    pub moving_shapes: usize,
    /// The first and the last frame of all keyframes.
    pub keyframes: Option<[f64; 2]>,
    /// Shapes that keyframes move.
    pub animated_shapes: usize,
    /// Groups that are stored once, their triangles, and how often they stand in the scene in all.
    pub groups: usize,
    pub group_triangles: usize,
    pub instances: usize,
    /// Shapes that send out light, meshes counted once.
    pub emitting_shapes: usize,
    pub materials: BTreeMap<&'static str, usize>,
    pub lights: BTreeMap<&'static str, usize>,
    pub textures: BTreeMap<&'static str, usize>,
    /// Texels of all image textures.
    pub texels: usize,
}

impl SceneSummary {
    /// Counts what is in the scene.
    pub fn of(scene: &Scene) -> Self {
        let emitting = scene.materials_that(|material| material.emission.is_some());
        let emits = |id: MaterialId| emitting.get(id) == Some(&true);
        Self {
            name: scene.name.clone(),
            size: scene.film.size,
            filter: scene.film.filter.to_string(),
            render: scene.render.clone(),
            shapes: count(scene.shapes.iter().map(|shape| shape.geometry.kind_name())),
            triangles: scene.shapes.iter().map(triangles).sum(),
            moving_shapes: scene.shapes.iter().filter(|shape| shape.motion.is_some()).count(),
            keyframes: scene.animation.frames(),
            animated_shapes: scene.animation.animated_shapes(),
            groups: scene.groups.len(),
            group_triangles: scene.groups.iter().map(Group::triangles).sum(),
            instances: scene.instance_count(),
            emitting_shapes: scene.shapes.iter().filter(|shape| shape.materials().any(emits)).count(),
            materials: count(scene.materials.iter().map(|material| material.kind.type_name())),
            lights: count(scene.lights.iter().map(Light::kind_name)),
            textures: count(scene.textures.iter().map(|texture| texture_type(&texture.kind))),
            texels: scene.textures.iter().map(|texture| texels(&texture.kind)).sum(),
        }
    }
}

impl fmt::Display for SceneSummary {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [width, height] = self.size;
        writeln!(out, "scene      {}", self.name)?;
        writeln!(out, "film       {width}x{height}, {} spp, filter {}", self.render.spp, self.filter)?;
        writeln!(out, "render     {}", estimation(&self.render))?;
        writeln!(out, "shapes     {}", list(&self.shapes))?;
        writeln!(
            out,
            "           {} triangles, {} emitting, {} moving",
            self.triangles, self.emitting_shapes, self.moving_shapes
        )?;
        if let Some([first, last]) = self.keyframes {
            writeln!(out, "keyframes  from frame {first} to frame {last}, of {} shapes", self.animated_shapes)?;
        }
        if self.groups > 0 {
            writeln!(
                out,
                "instances  {} of {} groups with {} triangles, each stored once",
                self.instances, self.groups, self.group_triangles
            )?;
        }
        writeln!(out, "materials  {}", list(&self.materials))?;
        writeln!(out, "lights     {}", list(&self.lights))?;
        writeln!(out, "textures   {}, {} texels", list(&self.textures), self.texels)
    }
}

/// The depth and the ways of estimating in words, and whatever else differs from its default.
fn estimation(render: &RenderSettings) -> String {
    let depth = if render.max_depth == 0 { "unlimited depth".to_owned() } else { format!("depth {}", render.max_depth) };
    let [sampler, estimator] = [render.sampler.name(), render.estimator.name()];
    let mut words = format!("{depth}, {sampler} sampler, {estimator} estimator, {} heuristic", render.heuristic.name());
    let said = ["spp", "max_depth", "sampler", "estimator", "heuristic"];
    let defaults = RenderSettings { sampler: render.sampler, ..RenderSettings::default() };
    for ((setting, value), (_, default)) in render.values().zip(defaults.values()) {
        if value != default && !said.contains(&setting.name) {
            let _ = write!(words, ", {} {value}", setting.name);
        }
    }
    words
}

fn list(counts: &BTreeMap<&'static str, usize>) -> String {
    if counts.is_empty() {
        return "none".to_owned();
    }
    let words: Vec<_> = counts.iter().map(|(name, count)| format!("{count} {name}")).collect();
    words.join(", ")
}

fn count(names: impl Iterator<Item = &'static str>) -> BTreeMap<&'static str, usize> {
    let mut counts = BTreeMap::new();
    for name in names {
        *counts.entry(name).or_default() += 1;
    }
    counts
}

fn triangles(shape: &Shape) -> usize {
    match &shape.geometry {
        Geometry::Mesh(mesh) => mesh.faces.len(),
        _ => 0,
    }
}

fn texture_type(kind: &TextureKind) -> &'static str {
    match kind {
        TextureKind::Image(_) => "image",
        TextureKind::Checker { .. } => "checker",
        TextureKind::Perlin { .. } => "perlin",
        TextureKind::Worley { .. } => "worley",
    }
}

fn texels(kind: &TextureKind) -> usize {
    match kind {
        TextureKind::Image(texture) => texture.image.texels.len(),
        _ => 0,
    }
}
