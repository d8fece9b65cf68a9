//! That blends end somewhere, and soon enough.

use super::material::{Material, MaterialId, MaterialKind};

/// Most leaves of one blend, those of the blends in it included. A blend of the same blend twice, and so on, doubles them at every
/// level: this stops before memory ends.
pub const MOST_LEAVES: usize = 1 << 16;

/// Checks that every blend ends in plain materials, in no more than [`MOST_LEAVES`] of them.
///
/// # Errors
/// The blend that does not, and what is wrong with it. Parts that do not exist count as leaves.
pub fn check_blends(materials: &[Material]) -> Result<(), (MaterialId, String)> {
    let mut leaves: Vec<Option<usize>> = vec![None; materials.len()];
    for start in 0..materials.len() {
        // A blend waits below its parts until both are counted. What waits longer than there are materials waits for itself.
        let mut waiting = vec![start];
        while let Some(&id) = waiting.last() {
            let material = &materials[id];
            let MaterialKind::Blend { materials: parts, .. } = material.kind else {
                leaves[id] = Some(1);
                waiting.pop();
                continue;
            };
            if let Some(&part) = parts.iter().find(|&&part| leaves.get(part) == Some(&None)) {
                if waiting.len() > materials.len() {
                    return Err((id, format!("the blend `{}` contains itself", material.name)));
                }
                waiting.push(part);
                continue;
            }
            let count = parts.iter().map(|&part| leaves.get(part).copied().flatten().unwrap_or(1)).sum();
            if count > MOST_LEAVES {
                return Err((id, format!("the blend `{}` is of more than {MOST_LEAVES} materials", material.name)));
            }
            leaves[id] = Some(count);
            waiting.pop();
        }
    }
    Ok(())
}
