//! From the tree of a blend to the run of its parts.

use super::blend_weight::{PackedBlendWeight, constant_weight};
use super::error::PackError;
use crate::scene::{ColorInput, Material, MaterialId, MaterialKind, Scene};
use crate::spectrum::Spectrum;

/// Most weights of all parts together: 16 MiB of them.
pub const MOST_WEIGHTS: usize = 1 << 20;

/// A part of a blend on the way from the tree to the tables.
#[derive(Clone)]
pub struct BlendPart {
    pub material: MaterialId,
    pub constant: f64,
    pub factors: Vec<PackedBlendWeight>,
    /// True where the part, or a blend around it, scatters nothing on the back.
    pub front_only: bool,
}

pub struct BlendParts {
    /// The plain materials at its ends, in the tree's order: the first child's before the second's.
    pub plain: Vec<BlendPart>,
    /// Blends below the root that emit besides what their parts do.
    pub emitting_blends: Vec<BlendPart>,
}

/// The parts of a blend; those that never have any weight are left out.
pub fn parts(scene: &Scene, id: MaterialId) -> Result<BlendParts, PackError> {
    let mut weights = 0;
    let mut found = BlendParts { plain: Vec::new(), emitting_blends: Vec::new() };
    let mut to_visit = vec![BlendPart { material: id, constant: 1.0, factors: Vec::new(), front_only: false }];
    while let Some(mut branch) = to_visit.pop() {
        branch.front_only |= !scene.materials[branch.material].two_sided;
        // Checked on the way: a deep chain of blends would fill the memory before it ends.
        weights += branch.factors.len();
        if weights > 2 * MOST_WEIGHTS {
            return Err(PackError::TooManyWeights { material: scene.materials[id].name.clone(), limit: MOST_WEIGHTS });
        }
        let MaterialKind::Blend { materials, weight } = &scene.materials[branch.material].kind else {
            found.plain.push(branch);
            continue;
        };
        for (child, reversed) in [(1, true), (0, false)] {
            let mut below = BlendPart { material: materials[child], ..branch.clone() };
            match constant_weight(weight) {
                Some(value) => below.constant *= if reversed { 1.0 - value } else { value },
                None => below.factors.push(PackedBlendWeight::new(weight, reversed)),
            }
            if below.constant > 0.0 {
                to_visit.push(below);
            }
        }
        if branch.material != id && scene.materials[branch.material].emission.is_some() {
            found.emitting_blends.push(branch);
        }
    }
    Ok(found)
}

/// Lambert surfaces blended by weights that never change are one of their mean reflectance. None where a part is anything else, varies
/// over the surface, or emits.
pub fn lambert_of_the_mean(scene: &Scene, plain: &[BlendPart]) -> Option<Spectrum> {
    let weighted =
        plain.iter().map(|part| match &scene.materials[part.material] {
            Material {
                kind: MaterialKind::Diffuse { reflectance: ColorInput::Constant(reflectance) }, emission: None, ..
            } if part.factors.is_empty() && !part.front_only => Some(part.constant * *reflectance),
            _ => None,
        });
    weighted.sum()
}
