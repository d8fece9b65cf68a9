//! Surfaces that are black from behind.

use super::*;
use crate::scene::{BlendMode, BlendWeight};

const SCENE: &str = "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n\
    [[light]]\ntype = \"environment\"\nradiance = 1\n\
    [[material]]\nname = \"front\"\ntype = \"diffuse\"\nreflectance = 0.5\ntwo_sided = false\n\
    [[material]]\nname = \"both\"\ntype = \"mirror\"\n\
    [[material]]\nname = \"part\"\ntype = \"blend\"\nmaterials = [\"front\", \"both\"]\nweight = { type = \"constant\", value = 0.25 }\n\
    [[material]]\nname = \"whole\"\ntype = \"blend\"\nmaterials = [\"both\", \"part\"]\ntwo_sided = false\n\
    weight = { type = \"constant\", value = 0.5 }\n\
    [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"front\"\n";

/// Mean weight of samples seen from the front and from behind.
fn reflected(material: usize, mode: BlendMode) -> [f64; 2] {
    let mut scene = load_toml_str(SCENE, "sides.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    scene.render.blend = mode;
    scene.materials[2].kind = MaterialKind::Blend { materials: [0, 1], weight: BlendWeight::Constant { value: 0.25 } };
    let mut surface = super::mixtures::surface(&scene);
    surface.owner.material = material;
    // The rectangle's front is below.
    [150.0, 30.0].map(|degrees| {
        let count = 4096;
        let weight = |[a, b, c]: [f64; 3]| {
            let bsdf = Bsdf::new(&scene, &surface, at_degrees(degrees, 1.0), (7.3 * a + b).fract());
            bsdf.sample(c, a, b).map_or(0.0, |sample| sample.weight.r())
        };
        cube_points(count, 3).map(weight).sum::<f64>() / f64::from(count)
    })
}

#[test]
fn the_back_of_a_one_sided_surface_is_black() {
    for mode in [BlendMode::Mixture, BlendMode::Pick] {
        let expected = [[0.5, 0.0], [1.0, 1.0], [0.25 * 0.5 + 0.75, 0.75], [0.5 + 0.5 * 0.875, 0.0]];
        for (material, expected) in expected.into_iter().enumerate() {
            let found = reflected(material, mode);
            assert!((found[0] - expected[0]).abs() < 0.02 && (found[1] - expected[1]).abs() < 0.02, "{material}: {found:?}");
        }
    }
}
