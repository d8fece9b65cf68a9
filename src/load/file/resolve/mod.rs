//! From what is written to what is meant: names looked up, files read, angles and directions checked.

mod animation;
mod camera;
mod material;
mod mtl;
mod mtl_principled;
mod settings;
mod texture;

use std::path::Path;

use super::document::Document;
use super::resolver::Resolver;
use super::syntax::{PartOfFile, SceneFile};
use crate::load::access::Access;
use crate::load::error::{SceneError, show};
use crate::scene::Scene;

/// Resolves a whole file.
pub fn resolve<'a>(document: Document<'a>, folder: &'a Path, file: SceneFile, access: Access) -> Result<Scene, SceneError> {
    let mut resolver = Resolver::new(document, folder, access);
    // Each part goes on past its own mistakes, so that all are told at once.
    let settings = resolver.settings(&file);
    resolver.note(settings);
    let camera = resolver.camera(&file.camera);
    resolver.note(camera);
    let animation = resolver.animation(&file);
    if resolver.note(animation).is_none() {
        return resolver.finish();
    }
    // Where names are not clear, whatever names something would seem wrong.
    let textures = resolver.textures(&file.texture);
    if resolver.note(textures).is_none() {
        return resolver.finish();
    }
    let materials = resolver.materials(&file.material);
    if resolver.note(materials).is_none() {
        return resolver.finish();
    }
    resolver.shapes(&file.shape);
    let groups = resolver.groups(&file.group);
    if let Some((names, groups)) = resolver.note(groups) {
        resolver.instances(&file.instance, &names, &groups);
    }
    resolver.lights(&file.light);
    resolver.finish()
}

/// Reads a model by itself: a scene of one shape with the model's own materials and nothing else.
pub fn resolve_model(path: &Path, smooth: Option<bool>, access: Access) -> Result<Scene, SceneError> {
    let name = show(path);
    let mut resolver = Resolver::new(Document::new(&name, "", &[]), Path::new(""), access);
    resolver.lone_mesh(path, smooth, None)?;
    resolver.finish()
}

/// As [`resolve_model`], with the last of the materials of a file in place of the model's own.
pub fn resolve_model_of<'a>(
    path: &Path,
    smooth: Option<bool>,
    (document, folder): (Document<'a>, &'a Path),
    access: Access,
) -> Result<Scene, SceneError> {
    let file: PartOfFile = document.read().map_err(|first| document.all_mistakes::<PartOfFile>(first))?;
    let name = document.name;
    let mut resolver = Resolver::new(document, folder, access);
    resolver.textures(&file.texture)?;
    resolver.materials(&file.material)?;
    if !resolver.errors.is_empty() {
        return resolver.finish();
    }
    let Some(last) = resolver.scene.materials.len().checked_sub(1) else {
        return Err(SceneError::in_file(name, "has no [[material]] to take"));
    };
    resolver.lone_mesh(path, smooth, Some(last))?;
    resolver.finish()
}
