//! From what is written to what is meant: names looked up, files read, angles and directions checked.

mod animation;
mod camera;
mod camera_model;
mod material;
mod medium;
mod mtl;
mod mtl_principled;
mod settings;
mod texture;

use std::path::Path;

use super::document::Document;
use super::reference::FileOr;
use super::resolver::Resolver;
use super::shape::{self, ShapeEntry, TransformEntry};
use super::syntax::SceneFile;
use super::value::Located;
use crate::load::access::Access;
use crate::load::error::{SceneError, show};
use crate::load::place::{Origin, Place};
use crate::scene::{Scene, Transform};

/// Resolves a whole file.
pub fn resolve<'a>(document: Document<'a>, folder: &'a Path, file: SceneFile, access: Access) -> Result<Scene, SceneError> {
    let mut resolver = Resolver::new(document, folder, access);
    // Each part goes on past its own mistakes, so that all are reported at once.
    let settings = resolver.settings(&file);
    resolver.note(settings);
    let media = resolver.media(&file.medium);
    if resolver.note(media).is_none() {
        return resolver.finish();
    }
    let camera = file.camera.as_ref().map_or(Ok(()), |camera| resolver.camera(camera, file.film.size.is_some()));
    resolver.note(camera);
    let animation = resolver.animation(&file);
    if resolver.note(animation).is_none() {
        return resolver.finish();
    }
    // Without unique names every reference would look wrong.
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
    resolver.check_linked_receivers();
    resolver.meters(&file.meter);
    resolver.finish()
}

/// The transform that an entry of a file states.
///
/// # Errors
/// A mistake in it.
pub fn resolve_transform(document: &Document<'_>, written: &Located<TransformEntry>) -> Result<Transform, SceneError> {
    Resolver::new(document.clone(), Path::new(""), Access::default()).transform(written)
}

/// Reads a model by itself: a scene of one shape with the model's own materials, or with the last one of `materials`.
///
/// # Errors
/// Mistakes in the model or the materials.
pub fn resolve_model<'a>(
    path: &Path,
    smooth: Option<bool>,
    materials: Option<(Document<'a>, &'a Path)>,
    access: Access,
) -> Result<Scene, SceneError> {
    let name = show(path);
    let place = Place::from(Origin { file: name.clone(), ..Origin::default() });
    let mut keys = shape::mesh::Keys { file: Some(place.at(FileOr::OnDisk(path.to_owned()))), smooth, ..Default::default() };
    let mut file = SceneFile::default();
    if let Some((document, _)) = &materials {
        let library: SceneFile = document.read_whole()?;
        (file.texture, file.material) = (library.texture, library.material);
        let last = file.material.last().map(|last| last.common().name.value.clone());
        let missing = || SceneError::in_file(document.name, "has no [[material]] to take");
        keys.material = Some(place.at(last.ok_or_else(missing)?));
    }
    file.shape.push(place.at(ShapeEntry::Mesh(keys)));
    let (document, folder) = materials.unwrap_or((Document::new("", ""), Path::new("")));
    let mut scene = resolve(document, folder, file, access)?;
    scene.shapes[0].label = name;
    Ok(scene)
}
