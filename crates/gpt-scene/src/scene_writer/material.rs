//! `[[material]]`

use std::collections::BTreeMap;

use super::animation;
use super::needed::named_texture;
use crate::load::file::writer::{Writer, flag, line, number, text};
use crate::load::file::{write_kind, write_light_group, write_link};
use crate::scene::{Emission, Material, MaterialId, MaterialKind, Relief};

pub fn material(id: MaterialId, writer: &Writer<'_>) -> String {
    let material = &writer.scene.materials[id];
    let type_name = material.kind.type_name();
    let mut out = "\n[[material]]\n".to_owned() + &line("name", &writer.materials.quoted(id)) + &line("type", &text(type_name));
    out += &write_kind(&material.kind, writer);
    if let Some(texture) = material.normal_map {
        let name = writer.textures.quoted(named_texture(writer.scene, texture));
        out += &match writer.scene.textures[texture].relief {
            Relief::Normals(1.0) => line("normal_map", &name),
            Relief::Normals(scale) => line("normal_map", &name) + &line("normal_scale", &number(scale)),
            Relief::Heights(scale) => line("bump_map", &name) + &line("bump_scale", &number(scale)),
        };
        out += &flag("normal_shadowing", writer.scene.textures[texture].shadows_perturbed_normals);
        out += &flag("normal_mirroring", writer.scene.textures[texture].mirrors_perturbed_normals);
    }
    let emits = matches!(material.kind, MaterialKind::Emissive);
    match material.emission {
        Some(Emission { radiance, two_sided }) => {
            let sides_key = if emits { "two_sided" } else { "emission_two_sided" };
            out += &writer.input(radiance_key(&material.kind), &radiance);
            if two_sided {
                out += &line(sides_key, "true");
            }
        }
        None if emits => out += &line("radiance", "0"),
        None => {}
    }
    out += &write_light_group(writer.scene.light_groups.of_material(id), writer);
    out += &write_link(writer.scene.light_links.of_material(id), writer);
    if let Some(medium) = material.interior {
        out += &line("interior", &writer.media.quoted(medium));
    }
    if !material.two_sided {
        out += &line("two_sided", "false");
    }
    let tracks = writer.scene.animation.materials.iter().filter(|track| track.material == id);
    tracks.for_each(|track| out += &animation::material(track, material, |at| keyed(at, writer)));
    out
}

/// The key of the light that a material emits.
fn radiance_key(kind: &MaterialKind) -> &'static str {
    if matches!(kind, MaterialKind::Emissive) { "radiance" } else { "emission" }
}

/// The keys that keyframes may state, each with its value.
fn keyed(material: &Material, writer: &Writer<'_>) -> BTreeMap<String, String> {
    let radiance = material.emission.map(|emission| writer.input(radiance_key(&material.kind), &emission.radiance));
    let lines = write_kind(&material.kind, writer) + &radiance.unwrap_or_default();
    lines.lines().filter_map(|line| line.split_once(" = ")).map(|(key, value)| (key.to_owned(), value.to_owned())).collect()
}
