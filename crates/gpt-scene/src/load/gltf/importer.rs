//! A description in the making.

use std::collections::HashMap;
use std::path::PathBuf;

use glam::DAffine3;

use super::buffers::Buffers;
use super::clipping::Clipping;
use super::json::Root;
use super::known::{EXTENSIONS, Unread, WITH_FALLBACK, find_unread};
use super::made::{MadeMaterial, MadePrimitive, WeightTrack};
use super::texture_role::{TextureRole, UvsOf};
use crate::load::file::reference::FileOr;
use crate::load::files::Files;
use crate::load::image_file::EmbeddedFile;
use crate::load::import::Description;
use crate::load::place::{Origin, Place};
use crate::load::printable::short_list;

/// The properties that tell textures apart: index, role of the texels, placement, coordinates, and the texture by which
/// it is multiplied.
type TextureKey = (usize, TextureRole, Option<[u64; 5]>, UvsOf, Option<String>);

/// A description in the making. Errors are sentences without the file's name.
pub struct Importer<'a> {
    pub files: &'a Files,
    pub folder: PathBuf,
    pub name: String,
    pub root: &'a Root,
    pub buffers: Buffers<'a>,
    pub scene: Description,
    pub materials: HashMap<Option<usize>, MadeMaterial>,
    pub textures: HashMap<TextureKey, String>,
    pub pictures: HashMap<usize, FileOr<EmbeddedFile>>,
    /// Profiles of lights, by their index.
    pub profiles: HashMap<usize, FileOr<EmbeddedFile>>,
    /// Primitives that no node deforms, by mesh and index in it.
    pub meshes: HashMap<(usize, usize), MadePrimitive>,
    /// Weights of morph targets at frames, by node.
    pub weight_tracks: HashMap<usize, WeightTrack>,
    /// Triangles of all shapes, copies counted.
    pub triangles: u64,
    /// Places of meshes, by the meshes' index.
    pub places: HashMap<usize, Vec<DAffine3>>,
    /// The part of the world that the camera shows, where one was chosen.
    pub clipping: Option<Clipping>,
    /// The variant of materials that is shown.
    pub variant: Option<usize>,
}

impl Importer<'_> {
    pub fn place(&self, key: &str) -> Place {
        Origin { file: self.name.clone(), line: None, key: key.to_owned() }.into()
    }

    pub fn drop(&mut self, what: impl Into<String>, key: &str, instead: &str) {
        let place = self.place(key).to_string();
        self.scene.report.drop(what, place, instead);
    }

    pub fn approximate(&mut self, what: impl Into<String>, key: &str, instead: &str) {
        let place = self.place(key).to_string();
        self.scene.report.approximate(what, place, instead);
    }

    /// Names what the file says and nothing here reads.
    pub fn report_unread(&mut self, json: &[u8]) {
        let unread = find_unread(json);
        for extension in &self.root.extensions_used {
            let is_known = EXTENSIONS.iter().any(|(known, _)| known == extension) || WITH_FALLBACK.contains(&extension.as_str());
            // Others are named where they stand.
            if !is_known && unread.iter().all(|unread| unread.what != *extension) {
                self.drop(extension.as_str(), "extensionsUsed", "it has no effect");
            }
        }
        for Unread { what, place, instead } in unread {
            self.drop(what, &place, instead);
        }
        let names = super::variant::names(self.root);
        if self.variant.is_none() && !names.is_empty() {
            let instead =
                format!("the materials that primitives name themselves are taken; --variant chooses {}", short_list(&names));
            self.drop("KHR_materials_variants", "extensions", &instead);
        }
    }
}

impl Importer<'_> {
    /// Reports what the camera's planes would cut away.
    pub fn report_clipping(&mut self) {
        let Some(clipping) = self.clipping else { return };
        let mut depths: Vec<f64> = self.scene.points().into_iter().filter_map(|point| clipping.depth_of(point)).collect();
        depths.sort_unstable_by(f64::total_cmp);
        let place = format!("cameras[{}]", clipping.camera);
        if depths.first().is_some_and(|nearest| *nearest < clipping.near) {
            self.drop("znear of a camera", &place, "what lies before it is shown");
        }
        if depths.last().is_some_and(|farthest| *farthest > clipping.far) {
            self.drop("zfar of a camera", &place, "what lies beyond it is shown");
        }
    }
}
