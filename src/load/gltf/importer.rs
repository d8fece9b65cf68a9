//! A description in the making.

use std::collections::HashMap;
use std::path::PathBuf;

use super::buffers::Buffers;
use super::json::Root;
use super::made::{MadeMaterial, MadePrimitive, WeightTrack};
use crate::load::files::Files;
use crate::load::import::{Description, FileReference, Place};
use crate::load::printable::short_list;

/// Extensions that are read; what of them is not exact is in the report.
pub const KNOWN: [&str; 24] = [
    "KHR_lights_punctual",
    "KHR_texture_transform",
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_clearcoat",
    "KHR_materials_sheen",
    "KHR_materials_anisotropy",
    "KHR_materials_iridescence",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    // Metadata.
    "KHR_xmp",
    "KHR_xmp_json_ld",
    "KHR_animation_pointer",
];

/// What makes textures differ: which it is, whether its texels are numbers, where it lies, whether on the second coordinates, and by which texture
/// it is multiplied.
type TextureKey = (usize, bool, Option<[u64; 5]>, bool, Option<String>);

/// A description in the making. Errors are sentences without the file's name.
pub struct Importer<'a> {
    pub files: &'a Files,
    pub folder: PathBuf,
    pub name: String,
    pub root: &'a Root,
    pub buffers: Buffers<'a>,
    pub scene: Description,
    pub materials: HashMap<Option<usize>, MadeMaterial>,
    /// By index, whether texels are numbers, and placement.
    pub textures: HashMap<TextureKey, String>,
    pub pictures: HashMap<usize, FileReference>,
    /// Of primitives that nothing of a node bends, by mesh and place in it.
    pub meshes: HashMap<(usize, usize), MadePrimitive>,
    /// Of nodes whose morph targets count differently at frames.
    pub weight_tracks: HashMap<usize, WeightTrack>,
    /// Of all shapes, copies counted.
    pub triangles: u64,
    /// The variant of materials that is shown.
    pub variant: Option<usize>,
}

impl Importer<'_> {
    pub fn place(&self, key: &str) -> Place {
        Place { file: self.name.clone(), line: None, key: key.to_owned() }
    }

    pub fn drop(&mut self, what: impl Into<String>, key: &str, instead: &str) {
        let place = self.place(key).to_string();
        self.scene.report.drop(what, place, instead);
    }

    pub fn report_extensions(&mut self) {
        for extension in &self.root.extensions_used {
            let is_draco = extension == "KHR_draco_mesh_compression" || extension == "KHR_texture_basisu";
            if !KNOWN.contains(&extension.as_str()) && !is_draco {
                self.drop(extension.as_str(), "extensionsUsed", "it has no effect");
            }
        }
        let names = super::variant::names(self.root);
        if self.variant.is_none() && !names.is_empty() {
            let instead =
                format!("the materials that primitives name themselves are taken; --variant chooses {}", short_list(&names));
            self.drop("KHR_materials_variants", "extensions", &instead);
        }
    }
}
