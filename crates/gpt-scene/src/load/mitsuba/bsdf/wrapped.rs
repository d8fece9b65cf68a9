//! BSDFs around others: two-sided ones, masks, maps of normals, blends.

use std::rc::Rc;

use super::keyed::{Keyed, NestedBsdfs, black, nothing};
use crate::load::error::SceneError;
use crate::load::file::material::blend_weight::{BlendWeightEntry, NoKeys};
use crate::load::file::material::{MaterialEntry, blend as blend_entry};
use crate::load::file::reference::TextureName;
use crate::load::file::value::Number;
use crate::load::import::Input;
use crate::load::mitsuba::colour::Role;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::input::Texels;
use crate::load::mitsuba::plugin::Plugin;
use crate::spectrum::Spectrum;

pub fn two_sided(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let within = plugin.children_of("bsdf");
    let differ = within.len() > 1 && !Rc::ptr_eq(within[0], within[1]);
    if within.len() > 2 {
        return Err(plugin.error(format!("a surface has two sides, and this one {} bsdfs for them", within.len())));
    }
    let outside = std::mem::replace(&mut converter.both_sides, true);
    let made = if differ { sides(converter, plugin, depth) } else { converter.within(plugin, depth).map(|(entry, _)| entry) };
    converter.both_sides = outside;
    made.map(|entry| (entry, true))
}

/// The first BSDF on the front, the second one on the back.
fn sides(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<MaterialEntry, SceneError> {
    let NestedBsdfs { names, relief } = converter.parts(plugin, depth)?;
    let count = names.len();
    let sides = <[String; 2]>::try_from(names);
    let sides = sides.map_err(|_| plugin.error(format!("a surface has two sides, and this one {count} bsdfs for them")))?;
    let front = BlendWeightEntry::Front(NoKeys {});
    Ok(relief.given_to(MaterialEntry::from(blend_entry::Keys::of(sides, front, &plugin.at()))))
}

pub fn mask(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let opacity = converter.scalar(plugin, "opacity", 0.5)?;
    if opacity.constant() == Some(Spectrum::WHITE) {
        return converter.within(plugin, depth);
    }
    if opacity.constant() == Some(Spectrum::BLACK) {
        converter.within(plugin, depth)?;
        return Ok((nothing(), true));
    }
    let parts = converter.parts(plugin, depth)?;
    let Some(part) = parts.names.into_iter().next() else { return Err(plugin.error("a mask needs a bsdf within")) };
    let behind = converter.extra(plugin, "what is behind", nothing());
    let blend = blended([part, behind], &opacity, plugin)?;
    Ok((parts.relief.given_to(blend), false))
}

pub fn bump_map(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let scale = plugin.number_or("scale", 1.0)?;
    let map = plugin.first_of("texture").cloned().ok_or_else(|| plugin.error("a bump map needs a texture within"))?;
    let (mut entry, two_sided) = converter.within(plugin, depth)?;
    let common = entry.common();
    if common.normal_map.is_some() || common.bump_map.is_some() {
        converter.drop(plugin, "bump map around another map of normals", "the inner map counts");
        return Ok((entry, two_sided));
    }
    if map.name == "checkerboard" {
        map.visited.set(true);
        converter.drop(&map, "texture `checkerboard` as a bump map", "it has steps and no slopes, and bends no normals");
        return Ok((entry, two_sided));
    }
    if let Input::Texture(name, factor) = converter.texture(&map, Role::Surface, Texels::Heights)? {
        if is_coated(&entry) {
            converter.approximate(plugin, "bump map of a coat", "it bends what is below the coat alone");
        }
        let place = plugin.at();
        let common = entry.common_mut();
        *common.bump_map = Some(place.at(TextureName(name)));
        *common.bump_scale = Some(place.at(plugin.possible(Number::of(scale * factor.r()))?));
        plugin.without_effect(&["flip_invalid_normals"]);
        shade(plugin, &mut entry)?;
    }
    Ok((entry, two_sided))
}

/// Lets a map shadow the normals that it bends, as it does there, unless it says otherwise. Whether it does.
fn shade(plugin: &Plugin, entry: &mut MaterialEntry) -> Result<bool, SceneError> {
    let is_shadowed = plugin.flag("use_shadowing_function", true)?;
    if is_shadowed {
        *entry.common_mut().normal_shadowing = Some(plugin.at().at(true));
    }
    Ok(is_shadowed || entry.common().normal_shadowing.is_some())
}

fn is_coated(entry: &MaterialEntry) -> bool {
    matches!(entry, MaterialEntry::Principled(keys) if keys.clearcoat.is_some())
}

pub fn normal_map(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let map = plugin.child("normalmap").or_else(|| plugin.first_of("texture")).cloned();
    let map = map.ok_or_else(|| plugin.error("a normal map needs a texture within"))?;
    let (mut entry, two_sided) = converter.within(plugin, depth)?;
    if let Input::Texture(name, _) = converter.texture(&map, Role::Surface, Texels::Normals)? {
        let place = plugin.at();
        // A map there bends a coat too.
        if let (true, MaterialEntry::Principled(keys)) = (is_coated(&entry), &mut entry) {
            keys.coat_normal_map = Some(place.at(TextureName(name.clone())));
        }
        *entry.common_mut().normal_map = Some(place.at(TextureName(name)));
        let is_shadowed = shade(plugin, &mut entry)?;
        if plugin.flag("flip_invalid_normals", true)? && is_shadowed {
            *entry.common_mut().normal_mirroring = Some(place.at(true));
        }
    }
    Ok((entry, two_sided))
}

fn blended(materials: [String; 2], share: &Input, plugin: &Plugin) -> Result<MaterialEntry, SceneError> {
    let weight = plugin.possible(share.weight(&plugin.at()))?;
    Ok(MaterialEntry::from(blend_entry::Keys::of(materials, weight, &plugin.at())))
}

/// Mitsuba's weight is the second one's share.
pub fn blend(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let share = converter.scalar(plugin, "weight", 0.5)?;
    let parts = converter.parts(plugin, depth)?;
    match &parts.names[..] {
        [first, second] => {
            let blend = blended([second.clone(), first.clone()], &share, plugin)?;
            Ok((parts.relief.given_to(blend), false))
        }
        others => Err(plugin.error(format!("a blend has two bsdfs within, and this one {}", others.len()))),
    }
}

/// `weights` of any number of BSDFs, at most 1 in all; what is missing reflects nothing.
pub fn mixture(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let text = plugin.text("weights")?.ok_or_else(|| plugin.error("a mixture needs the string `weights`"))?;
    let weights = crate::load::mitsuba::transform::numbers(&plugin.place, text)?;
    let NestedBsdfs { names, relief } = converter.parts(plugin, depth)?;
    let sum: f64 = weights.iter().sum();
    if weights.len() != names.len() || names.is_empty() || weights.iter().any(|weight| *weight < 0.0) || sum > 1.0 + 1e-6 {
        return Err(plugin.error("a mixture has a weight from 0 to 1 for each bsdf within, at most 1 in all"));
    }
    let mut parts: Vec<(String, f64)> = names.into_iter().zip(weights).collect();
    if sum < 1.0 - 1e-6 {
        parts.push((converter.extra(plugin, "black", black()), 1.0 - sum));
    }
    // From the last one on: each takes its share of what is left.
    let Some((mut rest, mut left)) = parts.pop() else { return Err(plugin.error("a mixture needs bsdfs within")) };
    let mut blend = None;
    while let Some((name, share)) = parts.pop() {
        left += share;
        let of_left = if left > 0.0 { share / left } else { 1.0 };
        let made = blended([name, rest.clone()], &Input::grey(of_left), plugin)?;
        if !parts.is_empty() {
            rest = converter.extra(plugin, "mixture", made.clone());
        }
        blend = Some(made);
    }
    match blend {
        Some(blend) => Ok((relief.given_to(blend), false)),
        None => converter.within(plugin, depth),
    }
}
