//! What must hold of a packed scene before a kernel may read it.

use super::hierarchy::{Child, Traversal};
use super::primitive::{Primitive, PrimitiveKind};
use super::texture::PackedTextureKind;
use super::{NONE, PackedScene};

/// Why a scene could not be packed.
#[derive(Debug, thiserror::Error)]
pub enum PackError {
    #[error("the scene has {found} primitives; the hierarchy can number {limit}")]
    TooManyPrimitives { found: usize, limit: usize },
    #[error("the scene has {found} infinite planes; {limit} are possible")]
    TooManyPlanes { found: usize, limit: usize },
    #[error("the scene's textures have {found} texels, more than can be numbered")]
    TooManyTexels { found: usize },
    #[error("the blend `{material}` and those before it have more than {limit} weights along their branches")]
    TooManyWeights { material: String, limit: usize },
    #[error("{shape}: {message}")]
    Motion { shape: String, message: String },
    /// A mistake of this program, not of the scene.
    #[error("the packed scene is inconsistent: {0}")]
    Inconsistent(String),
}

impl PackedScene {
    /// Every index points into its array, every leaf's primitives exist, each exactly once.
    pub fn validate(&self) -> Result<(), PackError> {
        let fail = |message: String| Err(PackError::Inconsistent(message));
        for (index, primitive) in self.primitives.iter().enumerate() {
            if primitive.material() as usize >= self.materials.materials.len() {
                return fail(format!("primitive {index} has material {}", primitive.material()));
            }
            if primitive.light != NONE && primitive.light as usize >= self.lights.len() {
                return fail(format!("primitive {index} is light {}", primitive.light));
            }
            if primitive.attributes != NONE && primitive.attributes as usize >= self.attributes.len() {
                return fail(format!("primitive {index} has attributes {}", primitive.attributes));
            }
            let motion = self.attributes.get(primitive.attributes as usize).map_or(NONE, |attributes| attributes.motion);
            if primitive.moves() && motion as usize >= self.motions.len() {
                return fail(format!("primitive {index} moves by motion {motion}"));
            }
        }
        self.validate_textures()?;
        self.validate_hierarchy()
    }

    fn validate_textures(&self) -> Result<(), PackError> {
        for texture in &self.textures.textures {
            let (width, height) = (texture.width_or_octaves, texture.height);
            let end = texture.first_texel_or_seed as usize + 3 * width as usize * height as usize;
            let image = texture.kind() == PackedTextureKind::Image as u32;
            if image && (width == 0 || height == 0 || end > self.textures.texels.len()) {
                return Err(PackError::Inconsistent(format!("a texture of {width} × {height} ends at {end}")));
            }
        }
        Ok(())
    }

    fn validate_hierarchy(&self) -> Result<(), PackError> {
        let fail = |message: String| Err(PackError::Inconsistent(message));
        if self.hierarchy.traversal == Traversal::RayQuery {
            let boxes = &self.hierarchy.boxes;
            // The device knows them by their places alone.
            let held = self.primitives.get(..self.hierarchy.primitive_count as usize).unwrap_or_default();
            let is_triangle = |primitive: &Primitive| primitive.kind() == PrimitiveKind::Triangle as u32;
            let first_box = held.len().saturating_sub(boxes.len());
            return match held.iter().position(|primitive| !is_triangle(primitive)).unwrap_or(held.len()) {
                first_shape if first_shape == first_box && !held[first_shape..].iter().any(is_triangle) => Ok(()),
                first_shape => fail(format!("boxes stand for primitives from {first_box} on, and shapes from {first_shape}")),
            };
        }
        let mut seen = vec![false; self.hierarchy.primitive_count as usize];
        let nodes = &self.hierarchy.nodes;
        for (index, node) in nodes.iter().enumerate() {
            for child in node.children() {
                match child {
                    Child::Inner(inner) if inner <= index || inner >= nodes.len() => {
                        return fail(format!("node {index} has the child {inner}"));
                    }
                    Child::Inner(_) => {}
                    Child::Leaf { first, count } => {
                        for primitive in first..first + count {
                            match seen.get_mut(primitive as usize) {
                                Some(seen) if !*seen => *seen = true,
                                _ => return fail(format!("node {index} holds primitive {primitive}, missing or held twice")),
                            }
                        }
                    }
                }
            }
        }
        match seen.iter().position(|seen| !seen) {
            Some(missing) => fail(format!("primitive {missing} is in no leaf")),
            None => Ok(()),
        }
    }
}
