//! Materials by name, for models that are looked at by themselves.

/// Name, and the tables of a scene file of which the last material is it.
const PRESETS: [(&str, &str); 12] = [
    ("clay", "[[material]]\nname = \"clay\"\ntype = \"diffuse\"\nreflectance = [0.6, 0.46, 0.37]\n"),
    ("white", "[[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.8\n"),
    ("plastic", include_str!("presets/plastic.toml")),
    ("ceramic", include_str!("presets/ceramic.toml")),
    ("gold", "[[material]]\nname = \"gold\"\ntype = \"conductor\"\npreset = \"gold\"\nroughness = 0.3\n"),
    ("copper", "[[material]]\nname = \"copper\"\ntype = \"conductor\"\npreset = \"copper\"\nroughness = 0.3\n"),
    ("silver", "[[material]]\nname = \"silver\"\ntype = \"conductor\"\npreset = \"silver\"\nroughness = 0.3\n"),
    ("aluminium", "[[material]]\nname = \"aluminium\"\ntype = \"conductor\"\npreset = \"aluminium\"\nroughness = 0.4\n"),
    ("chrome", "[[material]]\nname = \"chrome\"\ntype = \"mirror\"\nreflectance = [0.55, 0.56, 0.56]\n"),
    ("mirror", "[[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = 0.95\n"),
    ("glass", "[[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n"),
    ("frosted", "[[material]]\nname = \"frosted\"\ntype = \"rough_glass\"\nior = 1.5\nroughness = 0.45\n"),
];

/// Names of all of them.
pub fn preset_names() -> impl Iterator<Item = &'static str> {
    PRESETS.iter().map(|(name, _)| *name)
}

/// The tables of a preset.
pub fn preset(name: &str) -> Option<&'static str> {
    PRESETS.iter().find(|(other, _)| *other == name).map(|(_, text)| *text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_preset_is_a_material_of_its_name() {
        for (name, text) in PRESETS {
            let tables: toml::Table = toml::from_str(text).expect("it is TOML");
            let last = tables["material"].as_array().and_then(|materials| materials.last()).expect("it has materials");
            assert_eq!(last["name"].as_str(), Some(name));
        }
    }
}
