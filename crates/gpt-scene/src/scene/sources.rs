//! The origin of a scene's bulk, so that a scene file can name its files again.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Weak};

use glam::DAffine3;

use super::image::{ColorSpace, ImageData};
use super::light::LightProfile;
use super::shape::Mesh;
use super::volume::VoxelGrid;

/// The files that a scene's meshes, pictures, grids and profiles of lights were read from. What was changed since, or made by a program, has none.
#[derive(Debug, Clone, Default)]
pub struct Sources {
    images: HashMap<usize, (Weak<ImageData>, ImageSource)>,
    meshes: HashMap<usize, (Weak<Mesh>, MeshSource)>,
    grids: HashMap<usize, (Weak<VoxelGrid>, GridSource)>,
    profiles: HashMap<usize, (Weak<LightProfile>, PathBuf)>,
    /// Pictures that cannot be read, by the names of the textures that show a colour in their place.
    unreadable: HashMap<String, ImageSource>,
}

/// How a picture was read.
#[derive(Debug, Clone, PartialEq)]
pub struct ImageSource {
    /// The file, or the name of one that stands within another file.
    pub path: PathBuf,
    /// The content of a file that stands within another one.
    pub embedded: Option<Arc<[u8]>>,
    /// The colour space that was asked for; None for the format's own.
    pub color_space: Option<ColorSpace>,
    /// Factor of its values.
    pub scale: f64,
}

/// How a model was read.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshSource {
    pub path: PathBuf,
    pub smooth: Option<bool>,
    /// Its faces have the materials of its file, but for those that stand in `replaced`: name in the file, name in the scene.
    pub own_materials: bool,
    pub replaced: Vec<(String, String)>,
}

/// How a grid of values was read.
#[derive(Debug, Clone, PartialEq)]
pub struct GridSource {
    pub path: PathBuf,
    /// The name that was asked for.
    pub grid: Option<String>,
    /// From the file's space to index space.
    pub to_index: DAffine3,
}

// Objects are known by their address, and weakly remembered, so that no other object can get the address.
impl Sources {
    pub fn add_image(&mut self, image: &Arc<ImageData>, source: ImageSource) {
        self.images.insert(address(image), (Arc::downgrade(image), source));
    }

    pub fn add_unreadable(&mut self, texture: &str, source: ImageSource) {
        self.unreadable.insert(texture.to_owned(), source);
    }

    pub fn add_mesh(&mut self, mesh: &Arc<Mesh>, source: MeshSource) {
        self.meshes.insert(address(mesh), (Arc::downgrade(mesh), source));
    }

    pub fn add_grid(&mut self, grid: &Arc<VoxelGrid>, source: GridSource) {
        self.grids.insert(address(grid), (Arc::downgrade(grid), source));
    }

    pub fn add_profile(&mut self, profile: &Arc<LightProfile>, path: PathBuf) {
        self.profiles.insert(address(profile), (Arc::downgrade(profile), path));
    }

    /// The file of a picture.
    pub fn image(&self, image: &Arc<ImageData>) -> Option<&ImageSource> {
        self.images.get(&address(image)).map(|(_, source)| source)
    }

    /// The picture in whose place a texture shows a colour.
    pub fn unreadable(&self, texture: &str) -> Option<&ImageSource> {
        self.unreadable.get(texture)
    }

    /// The file of a mesh.
    pub fn mesh(&self, mesh: &Arc<Mesh>) -> Option<&MeshSource> {
        self.meshes.get(&address(mesh)).map(|(_, source)| source)
    }

    /// The file of a grid of values.
    pub fn grid(&self, grid: &Arc<VoxelGrid>) -> Option<&GridSource> {
        self.grids.get(&address(grid)).map(|(_, source)| source)
    }

    /// The file of a light's profile.
    pub fn profile(&self, profile: &Arc<LightProfile>) -> Option<&Path> {
        self.profiles.get(&address(profile)).map(|(_, path)| path.as_path())
    }

    /// Every file that something of the scene came from.
    pub fn paths(&self) -> impl Iterator<Item = &Path> {
        let images = self.images.values().filter(|(_, source)| source.embedded.is_none());
        let images = images.map(|(_, source)| source.path.as_path());
        let meshes = self.meshes.values().map(|(_, source)| source.path.as_path());
        let profiles = self.profiles.values().map(|(_, path)| path.as_path());
        images.chain(meshes).chain(self.grids.values().map(|(_, source)| source.path.as_path())).chain(profiles)
    }
}

fn address<T>(shared: &Arc<T>) -> usize {
    Arc::as_ptr(shared) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_changed_has_no_source_any_more() {
        let mut sources = Sources::default();
        let mut mesh = Arc::new(Mesh::default());
        let source = MeshSource { path: "a.obj".into(), smooth: None, own_materials: true, replaced: Vec::new() };
        sources.add_mesh(&mesh, source.clone());
        let shared = mesh.clone();
        assert_eq!(sources.mesh(&shared), Some(&source));
        assert_eq!(sources.mesh(&Arc::new(Mesh::default())), None);
        Arc::make_mut(&mut mesh).smooth = true;
        assert_eq!(sources.mesh(&mesh), None);
        assert_eq!(sources.mesh(&shared), Some(&source));
    }
}
