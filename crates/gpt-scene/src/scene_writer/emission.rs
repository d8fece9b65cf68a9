//! The light of blends: their own and that of their parts.

use super::losses::Losses;
use super::weights;
use crate::scene::{ColorInput, Emission, MaterialId, MaterialKind, Scene};
use crate::spectrum::Spectrum;

/// Depth of blends within blends that is looked into.
const MOST_DEPTH: usize = 100;

/// The light that surfaces of the material give off: its own and that of its parts, by their shares. A part that a texture makes an opening of
/// gives off all of its light: where it is, the opening says.
pub fn emission_of(scene: &Scene, id: MaterialId, place: &str, losses: &mut Losses) -> Option<Emission> {
    let emission = sum(scene, id, place, losses, 0);
    emission.filter(|emission| emission.radiance != ColorInput::Constant(Spectrum::BLACK))
}

fn sum(scene: &Scene, id: MaterialId, place: &str, losses: &mut Losses, depth: usize) -> Option<Emission> {
    let material = &scene.materials[id];
    let mut sum_so_far = material.emission;
    let MaterialKind::Blend { materials: [first, second], weight } = &material.kind else { return sum_so_far };
    if depth > MOST_DEPTH {
        return sum_so_far;
    }
    let is_nothing = |part: MaterialId| matches!(scene.materials[part].kind, MaterialKind::Pass);
    let share = weights::constant(weight).or_else(|| match [is_nothing(*first), is_nothing(*second)] {
        [_, true] => Some(1.0),
        [true, _] => Some(0.0),
        _ => None,
    });
    for (part, share) in [(*first, share), (*second, share.map(|share| 1.0 - share))] {
        let Some(emission) = sum(scene, part, place, losses, depth + 1) else { continue };
        let share = share.unwrap_or_else(|| {
            losses.approximate("light of a part of a blend", place, "half of it is given off everywhere");
            0.5
        });
        if share == 0.0 {
            continue;
        }
        let scaled = emission.radiance.scaled(Spectrum::grey(share));
        sum_so_far = match (sum_so_far, scaled) {
            (None, radiance) => Some(Emission { radiance, ..emission }),
            (Some(Emission { radiance: ColorInput::Constant(before), two_sided }), ColorInput::Constant(more)) => {
                let radiance = ColorInput::Constant(before + more);
                Some(Emission { radiance, two_sided: two_sided || emission.two_sided })
            }
            (Some(before), _) => {
                losses.drop("light of a part of a blend", place, "that of another part alone is given off");
                Some(before)
            }
        };
    }
    sum_so_far
}
