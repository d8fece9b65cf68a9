//! Scenes that are part of the program.

use std::sync::LazyLock;

use super::examples;

/// Name and text of every built-in scene that is a file; the first is the default.
const SCENES: [(&str, &str); 35] = [
    ("cornell", include_str!("../../../../scenes/cornell.toml")),
    ("spheres", include_str!("../../../../scenes/spheres.toml")),
    ("veach-mis", include_str!("../../../../scenes/veach-mis.toml")),
    ("teapot-plastic", include_str!("../../../../scenes/teapot-plastic.toml")),
    ("teapot-ceramic", include_str!("../../../../scenes/teapot-ceramic.toml")),
    ("teapot-iridescent", include_str!("../../../../scenes/teapot-iridescent.toml")),
    ("teapot-toon", include_str!("../../../../scenes/teapot-toon.toml")),
    ("knot-plastic", include_str!("../../../../scenes/knot-plastic.toml")),
    ("knot-ceramic", include_str!("../../../../scenes/knot-ceramic.toml")),
    ("knot-iridescent", include_str!("../../../../scenes/knot-iridescent.toml")),
    ("knot-toon", include_str!("../../../../scenes/knot-toon.toml")),
    ("motion-blur", include_str!("../../../../scenes/motion-blur.toml")),
    ("gallery", include_str!("../../../../scenes/gallery.toml")),
    ("stage", include_str!("../../../../scenes/stage.toml")),
    ("loft", include_str!("../../../../scenes/loft.toml")),
    ("terrace", include_str!("../../../../scenes/terrace.toml")),
    ("crystal", include_str!("../../../../scenes/crystal.toml")),
    ("lanterns", include_str!("../../../../scenes/lanterns.toml")),
    ("bazaar", include_str!("../../../../scenes/bazaar.toml")),
    ("arbour", include_str!("../../../../scenes/arbour.toml")),
    ("vitrine", include_str!("../../../../scenes/vitrine.toml")),
    ("paints", include_str!("../../../../scenes/paints.toml")),
    ("wardrobe", include_str!("../../../../scenes/wardrobe.toml")),
    ("workshop", include_str!("../../../../scenes/workshop.toml")),
    ("grove", include_str!("../../../../scenes/grove.toml")),
    ("theatre", include_str!("../../../../scenes/theatre.toml")),
    ("planetarium", include_str!("../../../../scenes/planetarium.toml")),
    ("cellar", include_str!("../../../../scenes/cellar.toml")),
    ("mist", include_str!("../../../../scenes/mist.toml")),
    ("bonfire", include_str!("../../../../scenes/bonfire.toml")),
    ("model-town", include_str!("../../../../scenes/model-town.toml")),
    ("furnace-lambert", include_str!("../../../../scenes/furnace-lambert.toml")),
    ("furnace-box", include_str!("../../../../scenes/furnace-box.toml")),
    ("furnace-glass", include_str!("../../../../scenes/furnace-glass.toml")),
    ("furnace-mirror", include_str!("../../../../scenes/furnace-mirror.toml")),
];

/// A scene of all examples, which every new kind of material, light and shape is in.
const EXAMPLES: &str = "examples";

/// Names of the built-in scenes; the first is the default.
pub fn builtin_names() -> impl Iterator<Item = &'static str> {
    SCENES.iter().map(|(name, _)| *name).chain([EXAMPLES])
}

/// The scene file of a built-in scene.
pub fn builtin_text(name: &str) -> Option<&'static str> {
    static OF_EXAMPLES: LazyLock<String> = LazyLock::new(examples::scene);
    if name == EXAMPLES {
        return Some(&OF_EXAMPLES);
    }
    SCENES.iter().find(|(other, _)| *other == name).map(|(_, text)| *text)
}
