//! A fingerprint of what a scene shows.

use std::fmt::{self, Write};
use std::sync::Arc;

use glam::{Vec2, Vec3};
use sha2::{Digest, Sha256};

use super::image::ImageData;
use super::light::Light;
use super::light_groups::LightGroups;
use super::light_links::LightLinks;
use super::model::Scene;
use super::shape::{Geometry, Mesh};
use super::texture::TextureKind;

/// SHA-256, in hexadecimal, of everything that decides what the scene looks like: shapes, materials, textures, lights and camera.
/// Its name, the picture's size and the way of estimating are left out, since a picture's header states them by themselves.
pub fn digest(scene: &Scene) -> String {
    BulkDigest::of(scene).digest(scene)
}

/// A fingerprint in the making, of meshes, pictures and grids alone: what frames of one scene have in common, and what takes time.
#[derive(Clone)]
pub struct BulkDigest(Sha256);

impl BulkDigest {
    /// Reads all meshes, pictures and grids of a scene.
    pub fn of(scene: &Scene) -> Self {
        // Bulk data is hashed as bytes, since printing millions of numbers takes seconds; the rest by how it prints.
        let mut hash = Sha256::new();
        for shape in &scene.shapes {
            if let Geometry::Mesh(mesh) = &shape.geometry {
                hash_mesh(&mut hash, mesh);
            }
        }
        for texture in &scene.textures {
            if let TextureKind::Image(image) = &texture.kind {
                hash_image(&mut hash, &image.image);
            }
        }
        for image in scene.lights.iter().filter_map(Light::image) {
            hash_image(&mut hash, image);
        }
        for grids in scene.media.iter().filter_map(|medium| medium.grids.as_ref()) {
            grids.hash_into(&mut hash);
        }
        Self(hash)
    }

    /// The [`digest`] of a scene that has these meshes and pictures.
    pub fn digest(&self, scene: &Scene) -> String {
        finish(self.0.clone(), scene)
    }
}

/// Adds everything but the contents of meshes, pictures and grids.
fn finish(mut hash: Sha256, scene: &Scene) -> String {
    let mut rest = scene.clone();
    let of_groups = rest.groups.iter_mut().flat_map(|group| &mut group.shapes);
    for shape in rest.shapes.iter_mut().chain(of_groups) {
        shape.label.clear();
        if let Geometry::Mesh(mesh) = &mut shape.geometry {
            *mesh = Arc::default();
        }
    }
    for texture in &mut rest.textures {
        if let TextureKind::Image(image) = &mut texture.kind {
            image.image = emptied(&image.image);
        }
    }
    for light in &mut rest.lights {
        if let Some(image) = light.image_mut() {
            *image = emptied(image);
        }
    }
    let printed =
        write!(HashWriter(&mut hash), "{:?}", (&rest.camera, &rest.textures, &rest.materials, &rest.shapes, &rest.lights));
    hash_instances(&mut hash, &mut rest);
    if !rest.exposure.is_empty() {
        let printed = write!(HashWriter(&mut hash), "{:?}", rest.exposure);
        debug_assert!(printed.is_ok(), "hashing cannot fail");
    }
    debug_assert!(printed.is_ok(), "hashing cannot fail");
    hash_media(&mut hash, &mut rest);
    if rest.light_groups != LightGroups::default() {
        let printed = write!(HashWriter(&mut hash), "{:?}", rest.light_groups);
        debug_assert!(printed.is_ok(), "hashing cannot fail");
    }
    if rest.light_links != LightLinks::default() {
        let printed = write!(HashWriter(&mut hash), "{:?}", rest.light_links);
        debug_assert!(printed.is_ok(), "hashing cannot fail");
    }
    hash.finalize().iter().fold(String::new(), |mut hexadecimal, byte| {
        let _ = write!(hexadecimal, "{byte:02x}");
        hexadecimal
    })
}

/// Hashes media, where there are any; the values of their grids have been hashed.
fn hash_media(hash: &mut Sha256, scene: &mut Scene) {
    if scene.media.is_empty() {
        return;
    }
    for grids in scene.media.iter_mut().filter_map(|medium| medium.grids.as_mut()) {
        *grids = Arc::new(grids.without_values());
    }
    let printed = write!(HashWriter(hash), "{:?}", (&scene.media, scene.camera_medium));
    debug_assert!(printed.is_ok(), "hashing cannot fail");
}

/// Hashes groups and instances, where there are any; the groups' meshes have been hashed.
fn hash_instances(hash: &mut Sha256, scene: &mut Scene) {
    for group in &scene.groups {
        let printed = write!(HashWriter(hash), "{:?}", group.shapes);
        debug_assert!(printed.is_ok(), "hashing cannot fail");
    }
    for instances in &mut scene.instances {
        instances.label.clear();
        let places = std::mem::take(&mut instances.places);
        hash.update((places.len() as u64).to_le_bytes());
        for place in places.iter() {
            hash.update(place.to_cols_array().map(f64::to_le_bytes).as_flattened());
        }
        let printed = write!(HashWriter(hash), "{instances:?}");
        debug_assert!(printed.is_ok(), "hashing cannot fail");
    }
}

struct HashWriter<'a>(&'a mut Sha256);

impl Write for HashWriter<'_> {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        self.0.update(text);
        Ok(())
    }
}

fn hash_mesh(hash: &mut Sha256, mesh: &Mesh) {
    hash_items(hash, &mesh.positions, Vec3::to_array);
    hash_items(hash, &mesh.normals, Vec3::to_array);
    hash_items(hash, &mesh.uvs, Vec2::to_array);
    if !mesh.second_uvs.is_empty() {
        hash_items(hash, &mesh.second_uvs, Vec2::to_array);
    }
    hash_items(hash, &mesh.faces, |face| face.map(f32::from_bits));
    hash_items(hash, &mesh.face_materials, |material| [f32::from_bits(*material as u32)]);
    hash.update([u8::from(mesh.smooth)]);
}

fn hash_image(hash: &mut Sha256, image: &ImageData) {
    hash.update((image.texels.len() as u64).to_le_bytes());
    hash.update(image.texels.as_bytes());
}

/// The image without its texels.
fn emptied(image: &ImageData) -> Arc<ImageData> {
    let ImageData { width, height, has_alpha, ref texels } = *image;
    Arc::new(ImageData { width, height, has_alpha, texels: texels.emptied() })
}

/// Hashes an array's length and the bits of its items' words.
fn hash_items<T, const WORDS: usize>(hash: &mut Sha256, items: &[T], words: impl Fn(&T) -> [f32; WORDS]) {
    hash.update((items.len() as u64).to_le_bytes());
    let mut bytes = Vec::new();
    for chunk in items.chunks(4096) {
        bytes.clear();
        bytes.extend(chunk.iter().flat_map(&words).flat_map(|word| word.to_bits().to_le_bytes()));
        hash.update(&bytes);
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::scene::{GridsOfMedium, Medium, MediumGrids, Phase, Volume, VoxelGrid};
    use crate::scene::{Shape, Transform};
    use crate::spectrum::Spectrum;

    fn scene() -> Scene {
        let mesh = Mesh { positions: vec![Vec3::ZERO, Vec3::X, Vec3::Y], faces: vec![[0, 1, 2]], ..Mesh::default() };
        let shape = Shape {
            label: "shape 1".to_owned(),
            geometry: Geometry::Mesh(Arc::new(mesh)),
            material: 0,
            transform: Transform::default(),
            motion: None,
            portal: false,
            receiver: 0,
        };
        Scene { shapes: vec![shape], ..Scene::default() }
    }

    #[test]
    fn equal_scenes_have_equal_digests_whatever_they_are_called() {
        let mut other = scene();
        other.name = "other".to_owned();
        other.film.size = [1, 2];
        other.shapes[0].label = "shape 7".to_owned();
        assert_eq!(digest(&scene()), digest(&other));
        assert_eq!(digest(&scene()).len(), 64);
    }

    #[test]
    fn every_part_counts() {
        let first = digest(&scene());
        let mut moved = scene();
        let Geometry::Mesh(mesh) = &mut moved.shapes[0].geometry else { unreachable!("the scene is made of a mesh") };
        Arc::make_mut(mesh).positions[1].z = f32::MIN_POSITIVE;
        let mut turned = scene();
        turned.camera.up.x = 1e-12;
        let mut other_material = scene();
        other_material.shapes[0].material = 1;
        for other in [moved, turned, other_material] {
            assert_ne!(digest(&other), first);
        }
    }

    /// Media count by their numbers and by every voxel of their grids.
    #[test]
    fn media_count() {
        let with = |scattering: f64, voxel: f32| {
            let mut scene = scene();
            let grid = VoxelGrid::new([2, 1, 1], 1, vec![1.0, voxel]).expect("a grid");
            let density = Volume::in_box(Arc::new(grid), DVec3::ZERO, DVec3::ONE);
            let grids = MediumGrids::new(GridsOfMedium { density, albedo: None, emission: None });
            scene.media.push(Medium {
                name: "fog".into(),
                absorption: Spectrum::BLACK,
                scattering: Spectrum::grey(scattering),
                emission: Spectrum::BLACK,
                phase: Phase::isotropic(),
                grids: Some(Arc::new(grids)),
            });
            scene
        };
        let first = digest(&with(1.0, 2.0));
        assert_eq!(digest(&with(1.0, 2.0)), first);
        let mut within = with(1.0, 2.0);
        within.camera_medium = Some(0);
        for other in [scene(), with(1.5, 2.0), with(1.0, 2.5), within] {
            assert_ne!(digest(&other), first);
        }
    }
}
