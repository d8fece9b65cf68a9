//! Types that the readers of model files share.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::scene::{self, Mesh};
use crate::spectrum::Spectrum;

/// Coordinates of models are within this.
pub const FARTHEST: f32 = scene::FARTHEST as f32;

/// How a model is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ModelFormat {
    Obj,
    Ply,
}

impl ModelFormat {
    /// By the ending of the file's name; None where it is no model's.
    pub fn of(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        match name {
            name if name.ends_with(".obj") => Some(Self::Obj),
            name if name.ends_with(".ply") || name.ends_with(".ply.gz") => Some(Self::Ply),
            _ => None,
        }
    }
}

/// A model as its file describes it.
#[derive(Debug, Default)]
pub struct ModelFile {
    /// Runs of faces of one object and one material, each with at least one face that has area.
    pub parts: Vec<ModelPart>,
    pub materials: Vec<MtlMaterial>,
    /// A number of each face that stands for a material, of formats whose faces have such numbers and one part.
    pub face_groups: Option<Vec<u32>>,
    /// Numbers of vertices and faces, where they were asked for, of formats that have one part.
    pub attributes: Vec<MeshAttribute>,
    /// Deviations from the file, in sentences.
    pub warnings: Vec<String>,
    /// Missing and wrong things that have something else in their place, and in which file each of them is.
    pub substitutes: Vec<(PathBuf, Substitute)>,
}

/// Numbers of a mesh beside positions, normals and texture coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAttribute {
    /// Name of the attribute, as `color`.
    pub name: String,
    /// One for each face; else one for each vertex.
    pub of_faces: bool,
    /// Linear; what has one channel is grey.
    pub values: Vec<Vec3>,
}

#[derive(Debug)]
pub struct ModelPart {
    pub mesh: Mesh,
    /// Index into [`ModelFile::materials`].
    pub material: Option<usize>,
}

/// Something that stands in the place of what a file should have: a warning, or an error where nothing may be replaced.
#[derive(Debug, Clone, PartialEq)]
pub struct Substitute {
    /// The line, if it is in one; counts from 1.
    pub line: Option<usize>,
    /// In words that follow the file's name.
    pub what: String,
}

/// One `newmtl` and what it says. Numbers that it does not say, or not so that they can be read, are not there.
#[derive(Debug, Clone, Default)]
pub struct MtlMaterial {
    pub file: PathBuf,
    pub name: String,
    /// `Kd`, `Ks`, `Ke` and `Tf`: from 0 up.
    pub colours: BTreeMap<MtlKey, Spectrum>,
    /// All others of one number, within the ranges of [`MtlKey`].
    pub numbers: BTreeMap<MtlKey, f64>,
    /// A number from 0 to 10.
    pub illumination: Option<u8>,
    /// The values of `map_Kd` and others, each with its line.
    pub maps: BTreeMap<MtlKey, (usize, String)>,
    /// No library has it.
    pub is_missing: bool,
}

impl MtlMaterial {
    pub fn colour(&self, key: MtlKey) -> Option<Spectrum> {
        self.colours.get(&key).copied()
    }

    pub fn number(&self, key: MtlKey) -> Option<f64> {
        self.numbers.get(&key).copied()
    }
}

/// The name of a key of MTL as it is most often spelled; upper and lower case do not matter.
pub type MtlKey = &'static str;
