//! BSDFs around others: two-sided ones, masks, maps of normals, blends.

use std::rc::Rc;

use glam::DVec3;

use super::keyed::{Keyed, Parts, with_relief};
use super::principled::{blended, weight};
use crate::load::error::SceneError;
use crate::load::import::{Keys, Value};
use crate::load::mitsuba::colour::Role;
use crate::load::mitsuba::converter::Converter;
use crate::load::mitsuba::input::{Input, Texels};
use crate::load::mitsuba::plugin::Plugin;

pub fn two_sided(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let within = plugin.children_of("bsdf");
    let differ = within.len() > 1 && !Rc::ptr_eq(within[0], within[1]);
    if within.len() > 2 {
        return Err(plugin.error(format!("a surface has two sides, and this one {} bsdfs for them", within.len())));
    }
    let outside = std::mem::replace(&mut converter.both_sides, true);
    let made = if differ { sides(converter, plugin, depth) } else { converter.within(plugin, depth).map(|(keys, _)| keys) };
    converter.both_sides = outside;
    made.map(|keys| (keys, true))
}

/// The first BSDF on the front, the second one on the back.
fn sides(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keys, SceneError> {
    let Parts { names, relief } = converter.parts(plugin, depth)?;
    let keys = Keys::of_type("blend").with("materials", names).with("weight", Keys::of_type("front"));
    Ok(with_relief(keys, relief))
}

pub fn mask(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let opacity = converter.scalar(plugin, "opacity", 0.5)?;
    if opacity.constant() == Some(DVec3::ONE) {
        return converter.within(plugin, depth);
    }
    if opacity.constant() == Some(DVec3::ZERO) {
        converter.within(plugin, depth)?;
        return Ok((Keys::of_type("pass"), true));
    }
    let parts = converter.parts(plugin, depth)?;
    let Some(part) = parts.names.into_iter().next() else { return Err(plugin.error("a mask needs a bsdf within")) };
    let behind = converter.extra(plugin, "what is behind", Keys::of_type("pass"));
    Ok((with_relief(blended(part, behind, &opacity), parts.relief), false))
}

pub fn bump_map(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let scale = plugin.number_or("scale", 1.0)?;
    let map = plugin.first_of("texture").cloned().ok_or_else(|| plugin.error("a bump map needs a texture within"))?;
    let (keys, two_sided) = converter.within(plugin, depth)?;
    if keys.get("normal_map").is_some() || keys.get("bump_map").is_some() {
        converter.drop(plugin, "bump map around another map of normals", "the inner map counts");
        return Ok((keys, two_sided));
    }
    if map.name == "checkerboard" {
        map.visited.set(true);
        converter.drop(&map, "texture `checkerboard` as a bump map", "it has steps and no slopes, and bends no normals");
        return Ok((keys, two_sided));
    }
    Ok(match converter.texture(&map, Role::Surface, Texels::Heights)? {
        Input::Texture(name, factor) => {
            if keys.get("clearcoat").is_some() {
                converter.approximate(plugin, "bump map of a coat", "it bends what is below the coat alone");
            }
            let keys = keys.with("bump_map", name).with("bump_scale", scale * factor.x);
            plugin.without_effect(&["flip_invalid_normals"]);
            (shadowed(plugin, keys)?, two_sided)
        }
        Input::Constant(_) => (keys, two_sided),
    })
}

/// As a map there shadows the normals that it bends, unless it says otherwise.
fn shadowed(plugin: &Plugin, keys: Keys) -> Result<Keys, SceneError> {
    let is_shadowed = plugin.flag("use_shadowing_function", true)?;
    Ok(if is_shadowed { keys.with("normal_shadowing", true) } else { keys })
}

/// A map there bends a coat too.
fn with_coat(keys: Keys, map: &str) -> Keys {
    let is_coated = keys.get("clearcoat").is_some();
    keys.with_some("coat_normal_map", is_coated.then_some(map))
}

pub fn normal_map(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let map = plugin.child("normalmap").or_else(|| plugin.first_of("texture")).cloned();
    let map = map.ok_or_else(|| plugin.error("a normal map needs a texture within"))?;
    let (keys, two_sided) = converter.within(plugin, depth)?;
    Ok(match converter.texture(&map, Role::Surface, Texels::Normals)? {
        Input::Texture(name, _) => {
            let keys = with_coat(keys, &name).with("normal_map", name);
            let keys = shadowed(plugin, keys)?;
            let is_mirrored = plugin.flag("flip_invalid_normals", true)? && keys.get("normal_shadowing").is_some();
            (keys.with_some("normal_mirroring", is_mirrored.then_some(true)), two_sided)
        }
        Input::Constant(_) => (keys, two_sided),
    })
}

/// Mitsuba's weight is the second one's share.
pub fn blend(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let share = converter.scalar(plugin, "weight", 0.5)?;
    let parts = converter.parts(plugin, depth)?;
    match &parts.names[..] {
        [first, second] => Ok((with_relief(blended(second.clone(), first.clone(), &share), parts.relief), false)),
        others => Err(plugin.error(format!("a blend has two bsdfs within, and this one {}", others.len()))),
    }
}

/// `weights` of any number of BSDFs, at most 1 in all; what is missing reflects nothing.
pub fn mixture(converter: &mut Converter, plugin: &Rc<Plugin>, depth: usize) -> Result<Keyed, SceneError> {
    let text = plugin.text("weights")?.ok_or_else(|| plugin.error("a mixture needs the string `weights`"))?;
    let weights = crate::load::mitsuba::transform::numbers(&plugin.place, text)?;
    let Parts { names, relief } = converter.parts(plugin, depth)?;
    let sum: f64 = weights.iter().sum();
    if weights.len() != names.len() || names.is_empty() || weights.iter().any(|weight| *weight < 0.0) || sum > 1.0 + 1e-6 {
        return Err(plugin.error("a mixture has a weight from 0 to 1 for each bsdf within, at most 1 in all"));
    }
    let mut parts: Vec<(Value, f64)> = names.into_iter().zip(weights).collect();
    if sum < 1.0 - 1e-6 {
        parts.push((converter.extra(plugin, "black", Keys::of_type("diffuse").with("reflectance", 0.0)), 1.0 - sum));
    }
    // From the last one on: each takes its share of what is left.
    let Some((mut rest, mut left)) = parts.pop() else { return Err(plugin.error("a mixture needs bsdfs within")) };
    let mut keys = None;
    while let Some((name, share)) = parts.pop() {
        left += share;
        let of_left = if left > 0.0 { share / left } else { 1.0 };
        let made =
            Keys::of_type("blend").with("materials", vec![name, rest.clone()]).with("weight", weight(&Input::grey(of_left)));
        if !parts.is_empty() {
            rest = converter.extra(plugin, "mixture", made.clone());
        }
        keys = Some(made);
    }
    match keys {
        Some(keys) => Ok((with_relief(keys, relief), false)),
        None => converter.within(plugin, depth),
    }
}
