//! Scenes that are part of the program.

use std::sync::LazyLock;

use super::examples;

/// Name and text of every built-in scene that is a file; the first is the default.
const SCENES: [(&str, &str); 36] = [
    ("cornell", include_str!(concat!(env!("GPT_SCENES"), "/cornell.toml"))),
    ("spheres", include_str!(concat!(env!("GPT_SCENES"), "/spheres.toml"))),
    ("veach-mis", include_str!(concat!(env!("GPT_SCENES"), "/veach-mis.toml"))),
    ("teapot-plastic", include_str!(concat!(env!("GPT_SCENES"), "/teapot-plastic.toml"))),
    ("teapot-ceramic", include_str!(concat!(env!("GPT_SCENES"), "/teapot-ceramic.toml"))),
    ("teapot-iridescent", include_str!(concat!(env!("GPT_SCENES"), "/teapot-iridescent.toml"))),
    ("teapot-toon", include_str!(concat!(env!("GPT_SCENES"), "/teapot-toon.toml"))),
    ("knot-plastic", include_str!(concat!(env!("GPT_SCENES"), "/knot-plastic.toml"))),
    ("knot-ceramic", include_str!(concat!(env!("GPT_SCENES"), "/knot-ceramic.toml"))),
    ("knot-iridescent", include_str!(concat!(env!("GPT_SCENES"), "/knot-iridescent.toml"))),
    ("knot-toon", include_str!(concat!(env!("GPT_SCENES"), "/knot-toon.toml"))),
    ("motion-blur", include_str!(concat!(env!("GPT_SCENES"), "/motion-blur.toml"))),
    ("gallery", include_str!(concat!(env!("GPT_SCENES"), "/gallery.toml"))),
    ("stage", include_str!(concat!(env!("GPT_SCENES"), "/stage.toml"))),
    ("loft", include_str!(concat!(env!("GPT_SCENES"), "/loft.toml"))),
    ("terrace", include_str!(concat!(env!("GPT_SCENES"), "/terrace.toml"))),
    ("crystal", include_str!(concat!(env!("GPT_SCENES"), "/crystal.toml"))),
    ("lanterns", include_str!(concat!(env!("GPT_SCENES"), "/lanterns.toml"))),
    ("bazaar", include_str!(concat!(env!("GPT_SCENES"), "/bazaar.toml"))),
    ("arbour", include_str!(concat!(env!("GPT_SCENES"), "/arbour.toml"))),
    ("vitrine", include_str!(concat!(env!("GPT_SCENES"), "/vitrine.toml"))),
    ("paints", include_str!(concat!(env!("GPT_SCENES"), "/paints.toml"))),
    ("wardrobe", include_str!(concat!(env!("GPT_SCENES"), "/wardrobe.toml"))),
    ("workshop", include_str!(concat!(env!("GPT_SCENES"), "/workshop.toml"))),
    ("grove", include_str!(concat!(env!("GPT_SCENES"), "/grove.toml"))),
    ("theatre", include_str!(concat!(env!("GPT_SCENES"), "/theatre.toml"))),
    ("planetarium", include_str!(concat!(env!("GPT_SCENES"), "/planetarium.toml"))),
    ("cellar", include_str!(concat!(env!("GPT_SCENES"), "/cellar.toml"))),
    ("mist", include_str!(concat!(env!("GPT_SCENES"), "/mist.toml"))),
    ("bonfire", include_str!(concat!(env!("GPT_SCENES"), "/bonfire.toml"))),
    ("model-town", include_str!(concat!(env!("GPT_SCENES"), "/model-town.toml"))),
    ("duet", include_str!(concat!(env!("GPT_SCENES"), "/duet.toml"))),
    ("furnace-lambert", include_str!(concat!(env!("GPT_SCENES"), "/furnace-lambert.toml"))),
    ("furnace-box", include_str!(concat!(env!("GPT_SCENES"), "/furnace-box.toml"))),
    ("furnace-glass", include_str!(concat!(env!("GPT_SCENES"), "/furnace-glass.toml"))),
    ("furnace-mirror", include_str!(concat!(env!("GPT_SCENES"), "/furnace-mirror.toml"))),
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
