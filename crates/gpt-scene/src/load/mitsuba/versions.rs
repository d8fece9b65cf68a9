//! Keys and plugins of older versions of Mitsuba, brought up to date.

use std::cell::Cell;

use glam::DAffine3;

use super::plugin::{Plugin, Property, PropertyValue};
use crate::load::place::Origin;

/// Elements of versions before 0.5.
pub fn modern_kind(tag: &str) -> &str {
    match tag {
        "luminaire" => "emitter",
        "camera" => "sensor",
        other => other,
    }
}

/// `toWorld` became `to_world` in version 2, and some words changed.
pub fn modern_name(name: &str) -> String {
    let mut modern = String::with_capacity(name.len() + 4);
    for character in name.chars() {
        if character.is_ascii_uppercase() {
            if !modern.is_empty() && !modern.ends_with('_') {
                modern.push('_');
            }
            modern.push(character.to_ascii_lowercase());
        } else {
            modern.push(character);
        }
    }
    match modern.as_str() {
        "int_i_o_r" => "int_ior".to_owned(),
        "ext_i_o_r" => "ext_ior".to_owned(),
        "diffuse_amount" => "diffuse_reflectance".to_owned(),
        "specular_amount" => "specular_reflectance".to_owned(),
        _ => modern,
    }
}

/// `uscale` and its like, which became `to_uv` in version 2. Version 3 reads them as scale × (uv + offset); those before 2 did as scale × uv + offset.
pub fn old_texture_coordinates(plugin: &mut Plugin) {
    if plugin.kind != "texture" {
        return;
    }
    let number = |name: &str| {
        plugin.properties.iter().find_map(|property| match property.value {
            PropertyValue::Number(number) if property.name == name => Some(number),
            _ => None,
        })
    };
    let both = number("uvscale");
    let found = ["uscale", "vscale", "uoffset", "voffset"].map(number);
    if both.is_none() && found.iter().all(Option::is_none) {
        return;
    }
    let [u, v, u_offset, v_offset] = found;
    let scale = glam::DVec3::new(u.or(both).unwrap_or(1.0), v.or(both).unwrap_or(1.0), 1.0);
    let offset = glam::DVec3::new(u_offset.unwrap_or(0.0), v_offset.unwrap_or(0.0), 0.0);
    plugin.properties.retain(|property| !["uscale", "vscale", "uvscale", "uoffset", "voffset"].contains(&property.name.as_str()));
    plugin.properties.push(Property {
        name: "to_uv".to_owned(),
        value: PropertyValue::Transform(DAffine3::from_scale(scale) * DAffine3::from_translation(offset)),
        place: Origin::clone(&plugin.place),
        used: Cell::new(false),
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_brought_up_to_date() {
        let rows = [
            ("toWorld", "to_world"),
            ("maxDepth", "max_depth"),
            ("intIOR", "int_ior"),
            ("to_uv", "to_uv"),
            ("alphaU", "alpha_u"),
        ];
        for (old, new) in rows {
            assert_eq!(modern_name(old), new);
        }
    }
}
