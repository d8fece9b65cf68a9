//! Results of converting materials, nodes and primitives, and deformations of meshes.

use std::collections::HashMap;
use std::sync::Arc;

use glam::{DAffine2, DAffine3};

use crate::load::file::shape::deformation::DeformationEntry;
use crate::load::file::value::Located;
use crate::scene::Mesh;

/// A converted material of a primitive.
#[derive(Debug, Clone)]
pub struct MadeMaterial {
    pub name: String,
    /// The set of texture coordinates that its textures use, and what is done to them.
    pub coordinates: Option<Coordinates>,
}

/// Which texture coordinates, and their map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Coordinates {
    pub set: u64,
    pub map: DAffine2,
    /// The set that stands beside as the second coordinates of meshes, as it is written.
    pub second: Option<u64>,
}

/// A texture of vertex colours.
#[derive(Debug, Clone, PartialEq)]
pub struct Paint {
    pub texture: String,
    /// Its alpha is below 1 somewhere.
    pub has_alpha: bool,
}

/// In what form a primitive has its material.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Form {
    /// The factor of the base colour.
    pub paint: Option<Paint>,
    /// The mesh's first texture coordinates are for directions alone, and its textures lie by the second ones.
    pub is_framed: bool,
    /// Only the camera sees it.
    pub is_outline: bool,
}

/// A converted primitive.
#[derive(Debug, Clone)]
pub struct MadePrimitive {
    pub mesh: Arc<Mesh>,
    pub material: String,
    pub triangles: u64,
    /// Deformation of a mesh that changes with frames.
    pub deformation: Option<Box<Located<DeformationEntry>>>,
}

/// How much the morph targets of a node count at times in seconds, each later than the one before.
#[derive(Debug, Clone)]
pub struct WeightTrack {
    pub keys: Vec<(f64, Vec<f64>)>,
    pub is_step: bool,
}

/// Name of the scene file's node that moves each of the nodes that move.
pub type MovingNodes = HashMap<usize, String>;

/// Joints of a skin.
pub struct Skinning {
    /// From the mesh's space to the world.
    pub maps: Vec<DAffine3>,
    /// The scene file's node that moves each joint.
    pub nodes: Vec<Option<String>>,
}

/// Deformation of the mesh of a node.
#[derive(Clone, Copy, Default)]
pub struct Bending<'b> {
    pub skinning: Option<&'b Skinning>,
    /// Weights of morph targets, in place of the mesh's own.
    pub weights: Option<&'b [f64]>,
    /// Weights of morph targets at frames.
    pub track: Option<&'b WeightTrack>,
}

impl Bending<'_> {
    /// All nodes have the same mesh.
    pub fn is_none(&self) -> bool {
        self.skinning.is_none() && self.weights.is_none() && self.track.is_none()
    }

    /// The mesh is another one at frames.
    pub fn is_animated(&self) -> bool {
        self.track.is_some() || self.skinning.is_some_and(|skinning| skinning.nodes.iter().any(Option::is_some))
    }
}
