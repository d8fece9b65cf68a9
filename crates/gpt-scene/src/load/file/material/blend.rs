//! `type = "blend"`

use super::blend_weight::{self, BlendWeightEntry};
use super::keys::{MaterialKeys, material_keys};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Exactly, Located};
use crate::load::file::writer::{Writer, line};
use crate::load::place::Place;
use crate::scene::MaterialKind;

material_keys! {
    /// w0·first + (1 − w0)·second; either may be another blend.
    {
        materials: Exactly<Located<String>, 2>,
        /// The weight w0 of the first material.
        weight: Located<BlendWeightEntry>,
    }
}

impl Keys {
    /// A blend of two materials by their names; `weight` is the share of the first.
    pub fn of(materials: [String; 2], weight: BlendWeightEntry, place: &Place) -> Self {
        let materials = Exactly(materials.map(|name| place.at(name)));
        Self { materials, weight: place.at(weight), ..Self::default() }
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "materials = [\"red\", \"mirror\"]\nweight = { type = \"fresnel\", ior = 1.5, exact = true }",
        "materials = [\"red\", \"mirror\"]\nweight = { type = \"front\" }",
        "materials = [\"mirror\", \"red\"]\nweight = { type = \"camera\" }",
        "materials = [\"mirror\", \"red\"]\nweight = { type = \"up\", axis = [1, 2, 0.5], power = 2 }",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Blend {
            materials: [resolver.material_id(&self.materials[0])?, resolver.material_id(&self.materials[1])?],
            weight: self.weight.value.resolve(resolver)?,
        })
    }

    /// They lie on one surface: its normals are the blend's own.
    fn check_parts(&self, resolver: &Resolver<'_>) -> Result<(), SceneError> {
        for part in self.materials.iter() {
            if resolver.scene.materials[resolver.material_id(part)?].normal_map.is_some() {
                let message = format!("`{}` has a normal map and is part of a blend", part.value);
                return Err(resolver.error(&part.place, message).with_help("give the normal map to the blend"));
            }
        }
        Ok(())
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Blend { materials, weight } = kind else { return String::new() };
        let [first, second] = materials.map(|part| writer.materials.quoted(part));
        line("materials", &format!("[{first}, {second}]")) + &line("weight", &blend_weight::write(weight, writer))
    }
}
