//! `[[material]]`

use super::needed::named_texture;
use crate::load::file::write_kind;
use crate::load::file::writer::{Writer, flag, line, number, text};
use crate::scene::{Emission, MaterialId, MaterialKind, Relief};

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
            let [radiance_key, sides_key] = if emits { ["radiance", "two_sided"] } else { ["emission", "emission_two_sided"] };
            out += &writer.input(radiance_key, &radiance);
            if two_sided {
                out += &line(sides_key, "true");
            }
        }
        None if emits => out += &line("radiance", "0"),
        None => {}
    }
    if let Some(medium) = material.interior {
        out += &line("interior", &writer.media.quoted(medium));
    }
    if !material.two_sided {
        out += &line("two_sided", "false");
    }
    out
}
