//! What files of models have in common.

use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::scene::Mesh;

/// Coordinates of models are within this.
pub const FARTHEST: f32 = 1e18;

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
    pub parts: Vec<Part>,
    pub materials: Vec<MtlMaterial>,
    /// A number of each face that stands for a material, of formats whose faces have such numbers and one part.
    pub face_groups: Option<Vec<u32>>,
    /// Numbers of vertices and faces, where they were asked for, of formats that have one part.
    pub attributes: Vec<MeshAttribute>,
    /// What could not be taken as written, in sentences.
    pub warnings: Vec<String>,
    /// What is missing and has something else in its place, in words that follow the file's name.
    pub substitutes: Vec<String>,
}

/// Numbers of a mesh beside positions, normals and texture coordinates.
#[derive(Debug, Clone, PartialEq)]
pub struct MeshAttribute {
    /// As `color`.
    pub name: String,
    /// One for each face; else one for each vertex.
    pub of_faces: bool,
    /// Linear; what has one channel is grey.
    pub values: Vec<Vec3>,
}

#[derive(Debug)]
pub struct Part {
    pub mesh: Mesh,
    /// Index into [`ModelFile::materials`].
    pub material: Option<usize>,
}

/// One `newmtl` and where it stands.
#[derive(Debug, Clone)]
pub struct MtlMaterial {
    pub file: PathBuf,
    pub material: tobj::Material,
    /// No library has it.
    pub is_missing: bool,
}
