//! Scenes that are part of the program.

/// Name and text of every built-in scene; the first is the default.
const SCENES: [(&str, &str); 7] = [
    ("cornell", include_str!("../../scenes/cornell.toml")),
    ("spheres", include_str!("../../scenes/spheres.toml")),
    ("veach-mis", include_str!("../../scenes/veach-mis.toml")),
    ("furnace-lambert", include_str!("../../scenes/furnace-lambert.toml")),
    ("furnace-box", include_str!("../../scenes/furnace-box.toml")),
    ("furnace-glass", include_str!("../../scenes/furnace-glass.toml")),
    ("furnace-mirror", include_str!("../../scenes/furnace-mirror.toml")),
];

/// Names of the built-in scenes; the first is the default.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name)
}

/// The scene file of a built-in scene.
pub fn builtin_text(name: &str) -> Option<&'static str> {
    SCENES.iter().find(|(other, _)| *other == name).map(|(_, text)| *text)
}
