//! Files of what bends a mesh: joints of its vertices, and offsets of morph targets.

use glam::Vec3;
use serde::{Deserialize, Serialize};

use crate::scene::animation::{Deformation, MorphTarget};

/// The JSON file.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct DeformationRows {
    pub influences: Vec<Vec<(u32, f32)>>,
    pub targets: Vec<TargetRows>,
}

#[derive(Debug, Clone, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct TargetRows {
    pub positions: Vec<[f32; 3]>,
    pub normals: Vec<[f32; 3]>,
}

impl DeformationRows {
    pub fn of(deformation: &Deformation) -> Self {
        let list = |offsets: &[Vec3]| offsets.iter().map(Vec3::to_array).collect();
        let target = |target: &MorphTarget| TargetRows { positions: list(&target.positions), normals: list(&target.normals) };
        Self {
            influences: deformation.influences.of_vertices().map(<[_]>::to_vec).collect(),
            targets: deformation.targets.iter().map(target).collect(),
        }
    }
}

/// The contents of the JSON file of a deformation.
pub fn influences_file(deformation: &Deformation) -> Vec<u8> {
    // Lists of finite numbers can always be written.
    serde_json::to_vec(&DeformationRows::of(deformation)).unwrap_or_default()
}
