//! A material as a weighted list of its parts.
//!
//! A blend of two materials has the weights w0 and 1 − w0; a blend of blends has the products. So any tree is the list of the
//! plain materials at its ends, from the first to the last, each with the product of the weights on the way to it from the root.

use super::blend_weight;
use super::lookup::Lookup;
use crate::reference::work;
use crate::scene::{BlendWeight, Material, MaterialId, MaterialKind, Scene};

/// Calls `visit` with the material itself, the blends in it and the plain materials at their ends, each before its own parts, the first of two before the
/// second, with their weights at one hit. Parts of weight 0 do nothing and are left out.
pub fn for_each_part<'a>(lookup: &Lookup<'a>, material: MaterialId, mut visit: impl FnMut(&'a Material, f64)) {
    for_each_sided_part(lookup, material, |id, weight, _| visit(&lookup.scene.materials[id], weight));
}

/// Visits each part with its weight, and says that it scatters light on both sides: it and all blends that it
/// is in do.
pub fn for_each_sided_part(lookup: &Lookup<'_>, material: MaterialId, visit: impl FnMut(MaterialId, f64, bool)) {
    walk(lookup.scene, material, |blend| blend_weight::weight(blend, lookup), visit);
}

/// Visits each part with the weight to be expected before any hit is known.
pub fn for_each_part_on_average<'a>(scene: &'a Scene, material: MaterialId, mut visit: impl FnMut(&'a Material, f64)) {
    walk(scene, material, blend_weight::mean_weight, |id, weight, _| visit(&scene.materials[id], weight));
}

fn walk(
    scene: &Scene,
    material: MaterialId,
    first_weight: impl Fn(&BlendWeight) -> f64,
    mut visit: impl FnMut(MaterialId, f64, bool),
) {
    let mut next = Some((material, 1.0, true));
    // Second parts that wait for the first to be walked through. Plain materials never touch it.
    let mut waiting = Vec::new();
    let mut parts_walked = 0;
    while let Some((id, weight, two_sided)) = next.take().or_else(|| waiting.pop()) {
        parts_walked += 1;
        let part = &scene.materials[id];
        let two_sided = two_sided && part.two_sided;
        visit(id, weight, two_sided);
        if let MaterialKind::Blend { materials: [first, second], weight: blend_weight } = &part.kind {
            let w0 = first_weight(blend_weight);
            let parts = [(*second, weight * (1.0 - w0), two_sided), (*first, weight * w0, two_sided)];
            waiting.extend(parts.into_iter().filter(|&(_, weight, _)| weight > 0.0));
        }
    }
    work::add(work::PART * parts_walked);
}
