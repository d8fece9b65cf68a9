//! Keyframes of materials: any of a material's own keys, and its emission, at frames.

use super::keys::{KeyedMaterial, MaterialKeyframe};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::Located;
use crate::scene::animation::{Curve, Interpolation, Key, MaterialTrack};
use crate::scene::{ColorInput, Emission, Material};

/// Some keyframe states this key.
pub fn states<K: KeyedMaterial>(keys: &K, key: &str) -> bool {
    keys.keyframes().is_some_and(|keyframes| keyframes.value.iter().any(|entry| entry.value.stated().contains(&key)))
}

/// The numbers of a material at frames; None where it has no keyframes.
///
/// Keyframes state keys and frames change numbers. Which numbers a key stands for shows where it is exchanged alone: a key that several
/// keyframes state has those that any of them changes.
///
/// # Errors
/// Mistakes in keyframes, and keyframes that change more than numbers.
pub fn track<K: KeyedMaterial>(keys: &K, id: usize, resolver: &Resolver<'_>) -> Result<Option<MaterialTrack>, SceneError> {
    let Some(keyframes) = keys.keyframes() else {
        return resolver.without_keyframes(keys.interpolation()).map(|()| None);
    };
    let frames = resolver.frames(keyframes, resolver.scene.animation.frames_per_second, MaterialKeyframe::times)?;
    let rest = look(keys, resolver)?;
    let mut keyed = Vec::with_capacity(frames.len());
    for entry in &keyframes.value {
        if entry.value.stated().is_empty() {
            let message = "a keyframe of a material states one of the keys of its type, or its `emission`";
            return Err(resolver.error(&entry.place, message));
        }
        keyed.push(look(&keys.at(&entry.value, &|_| true), resolver)?);
    }
    let emits_two_sided = rest.emission.is_some_and(|emission| emission.two_sided);
    let emits = keyed.iter().any(|at| at.emission.is_some());
    let lit = |material: Material| if emits { with_emission(material, emits_two_sided) } else { material };
    let rest = lit(rest);
    let keyed: Vec<Material> = keyed.into_iter().map(lit).collect();
    for (entry, at) in keyframes.value.iter().zip(&keyed) {
        if !at.has_form_of(&rest) {
            let message =
                "a keyframe changes numbers and colours, and this one changes more: a texture, a switch, or what a weight is by";
            return Err(resolver.error(&entry.place, message).with_help(
                "let the material stand with keys of the same kinds, or blend two materials by a weight with keyframes",
            ));
        }
    }
    let mut names: Vec<&'static str> = keyframes.value.iter().flat_map(|entry| entry.value.stated()).collect();
    names.sort_unstable();
    names.dedup();
    let interpolation = keys.interpolation().map_or(Interpolation::default(), |name| name.value.into());
    let mut track = MaterialTrack { material: id, emits: emits.then_some(emits_two_sided), ..MaterialTrack::default() };
    for name in names {
        let states = |entry: &Located<K::Keyframe>| entry.value.stated().contains(&name);
        let mut changed = vec![false; rest.numbers().len()];
        for (entry, at) in keyframes.value.iter().zip(&keyed).filter(|(entry, _)| states(entry)) {
            let alone = look(&keys.at(&entry.value, &|key| key == name), resolver).map(|other| (lit(other), &rest));
            // A key may need another one beside it.
            let pair =
                alone.or_else(|_| look(&keys.at(&entry.value, &|key| key != name), resolver).map(|other| (lit(other), at)));
            let (one, other) = pair?;
            if !one.has_form_of(other) {
                let message =
                    format!("`{name}` goes through keyframes by itself: the material's other keys make more of it than a number");
                return Err(resolver.error(&entry.place, message));
            }
            let differ = one.numbers().into_iter().zip(other.numbers()).map(|(a, b)| a != b);
            changed.iter_mut().zip(differ).for_each(|(changed, differs)| *changed |= differs);
        }
        for (number, _) in changed.into_iter().enumerate().filter(|(_, changed)| *changed) {
            let all = keyframes.value.iter().zip(&frames).zip(&keyed).filter(|((entry, _), _)| states(entry));
            let keys = all.map(|((_, &frame), at)| Key { frame, value: at.numbers()[number] }).collect();
            track.numbers.push((number, Curve { keys, interpolation }));
        }
    }
    Ok(Some(track))
}

/// How the material scatters and emits.
fn look<K: KeyedMaterial>(keys: &K, resolver: &Resolver<'_>) -> Result<Material, SceneError> {
    Ok(Material {
        name: String::new(),
        kind: keys.kind(resolver)?,
        normal_map: None,
        emission: keys.emission(&keys.shared(), resolver)?,
        two_sided: true,
        interior: None,
    })
}

/// A material that emits at some frame has an emission at all of them, perhaps a black one.
fn with_emission(material: Material, two_sided: bool) -> Material {
    let black = Emission { radiance: ColorInput::grey(0.0), two_sided };
    Material { emission: Some(material.emission.unwrap_or(black)), ..material }
}
