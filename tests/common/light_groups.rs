//! Scenes whose light is in groups.

use gpt::scene::Scene;

/// The names of the groups of [`in_groups`].
pub const GROUPS: [&str; 3] = ["odd", "even", "rest"];

/// The scene with its lights, the emission of its materials and what its media give off in three groups, one after the other.
pub fn in_groups(mut scene: Scene) -> Scene {
    let names = GROUPS.map(|name| scene.light_groups.named(name).expect("a name"));
    for light in 0..scene.lights.len() {
        scene.light_groups.put_light(light, names[light % 3]);
    }
    for material in 0..scene.materials.len() {
        scene.light_groups.put_material(material, names[(material + 1) % 3]);
    }
    for medium in 0..scene.media.len() {
        scene.light_groups.put_medium(medium, names[medium % 3]);
    }
    scene
}

/// The scene in the light of a group.
pub fn lit_by(scene: &Scene, group: &str) -> Scene {
    scene.in_light_of(group).expect("the group is there")
}
