//! From what is written to what is meant: names looked up, files read, angles and directions checked.

mod camera;
mod light;
mod material;
mod mesh;
mod mtl;
mod settings;
mod shape;
mod texture;
mod transform;

use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use super::document::Document;
use super::syntax::SceneFile;
use super::value::Located;
use super::wording::did_you_mean;
use crate::load::SceneError;
use crate::scene::{MaterialId, Scene, TextureId};

/// A scene in the making.
pub struct Resolver<'a> {
    document: Document<'a>,
    /// What paths in the file are relative to.
    folder: &'a Path,
    scene: Scene,
    texture_names: HashMap<String, TextureId>,
    material_names: HashMap<String, MaterialId>,
    images: texture::ImageCache,
    /// Per texture: an image whose colour space is written to be linear.
    linear_textures: Vec<bool>,
    mesh_files: HashMap<mesh::MeshFileKey, mesh::LoadedMesh>,
    /// The material of faces that name none.
    unnamed_material: Option<MaterialId>,
}

/// Resolves a whole file.
pub fn resolve(document: Document<'_>, folder: &Path, file: SceneFile) -> Result<Scene, SceneError> {
    let mut resolver = Resolver::new(document, folder);
    resolver.settings(&file)?;
    resolver.camera(&file.camera)?;
    resolver.textures(&file.texture)?;
    resolver.materials(&file.material)?;
    resolver.shapes(&file.shape)?;
    resolver.lights(&file.light)?;
    Ok(resolver.scene)
}

/// Reads a model by itself: a scene of one shape with the model's own materials and nothing else.
pub fn resolve_model(path: &Path) -> Result<Scene, SceneError> {
    let name = crate::load::error::show(path);
    let mut resolver = Resolver::new(Document { name: &name, text: "" }, Path::new(""));
    resolver.lone_mesh(path)?;
    Ok(resolver.scene)
}

impl<'a> Resolver<'a> {
    fn new(document: Document<'a>, folder: &'a Path) -> Self {
        Self {
            document,
            folder,
            scene: Scene::default(),
            texture_names: HashMap::new(),
            material_names: HashMap::new(),
            images: Default::default(),
            linear_textures: Vec::new(),
            mesh_files: HashMap::new(),
            unnamed_material: None,
        }
    }

    fn error(&self, span: &Range<usize>, message: impl Into<String>) -> SceneError {
        self.document.error(span.clone(), message)
    }

    fn path(&self, file: &str) -> PathBuf {
        self.folder.join(file)
    }

    fn texture_id(&self, name: &Located<String>) -> Result<TextureId, SceneError> {
        self.look_up(&self.texture_names, name, "texture")
    }

    fn material_id(&self, name: &Located<String>) -> Result<MaterialId, SceneError> {
        self.look_up(&self.material_names, name, "material")
    }

    fn look_up(&self, names: &HashMap<String, usize>, name: &Located<String>, what: &str) -> Result<usize, SceneError> {
        if let Some(&id) = names.get(&name.value) {
            return Ok(id);
        }
        let mut choices: Vec<&str> = names.keys().map(String::as_str).collect();
        choices.sort_unstable();
        let help = did_you_mean(&name.value, &choices).unwrap_or_else(|| format!("the file has no [[{what}]]"));
        Err(self.error(&name.span, format!("there is no {what} named `{}`", name.value)).with_help(help))
    }

    /// Gives every entry its place by its name; a name may be used once.
    fn register<'n>(
        &self,
        what: &str,
        names: impl Iterator<Item = &'n Located<String>>,
    ) -> Result<HashMap<String, usize>, SceneError> {
        let mut places = HashMap::new();
        for (place, name) in names.enumerate() {
            if name.value.is_empty() {
                return Err(self.error(&name.span, "a name cannot be empty"));
            }
            if places.insert(name.value.clone(), place).is_some() {
                return Err(self.error(&name.span, format!("a second {what} is named `{}`", name.value)));
            }
        }
        Ok(places)
    }
}
