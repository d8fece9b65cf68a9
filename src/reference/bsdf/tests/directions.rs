//! Directions of anisotropy that come from textures.

use super::*;
use crate::reference::intersect::Tangents;

/// Brushed metal of these keys, with a texture `even` that is this colour everywhere; it is also that of the directions if so.
fn brushed(texel: DVec3, directed: bool, keys: &str) -> Lobe {
    let [red, green, blue] = texel.to_array();
    let text = format!(
        "[camera]\nposition = [0, 0, 1]\nlook_at = [0, 0, 0]\nvfov = 40\n[[light]]\ntype = \"environment\"\nradiance = 1\n\
         [[texture]]\nname = \"even\"\ntype = \"checker\"\na = [{red}, {green}, {blue}]\nb = [{red}, {green}, {blue}]\n\
         [[material]]\nname = \"m\"\ntype = \"principled\"\nroughness = 0.4\n{keys}"
    );
    let mut scene = load_toml_str(&text, "test.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    if let MaterialKind::Principled(principled) = &mut scene.materials[0].kind {
        // Scene files take pictures alone.
        principled.anisotropy_direction = directed.then_some(0);
    }
    Lobe::of(
        &scene.materials[0].kind,
        &Lookup { scene: &scene, uv: DVec2::ZERO.into(), cosine: 1.0, normal: DVec3::Z, front: true, by_camera: false },
    )
    .expect("it scatters")
}

/// A texture of one direction is a rotation by its angle, whatever the texel's length; blue is the strength, and a rotation is added.
#[test]
fn a_texture_of_one_direction_is_a_rotation() {
    // v grows to either side.
    for along_v in [DVec3::Y, DVec3::NEG_Y] {
        let view = view(50.0, 0.0).with_tangents(Some(Tangents::along(DVec3::new(1.0, 0.3, 0.0), along_v)));
        let value = |lobe: Lobe, wi: DVec3| lobe.evaluate(&view, wi).value.r();
        for (angle, length, further) in [(0.0, 1.0, 0.0), (25.0, 1.0, 0.0), (110.0, 0.5, 0.0), (-70.0, 0.8, 35.0)] {
            let direction = DVec2::from_angle(f64::to_radians(angle)) * length;
            let texel = (0.5 * (direction + 1.0)).extend(0.6);
            let keys = "anisotropy = { texture = \"even\", channel = \"b\" }";
            let textured = brushed(texel, true, &format!("{keys}\nanisotropy_rotation = {further}"));
            let keys = |by: f64| format!("anisotropy = 0.6\nanisotropy_rotation = {}", angle + further + by);
            let turned = |by: f64| brushed(texel, false, &keys(by));
            let mut apart = 0.0_f64;
            for [u, v, _] in cube_points(50, 3) {
                let wi = crate::reference::warp::cosine_hemisphere(u, v);
                let expected = value(turned(0.0), wi);
                assert!((value(textured, wi) - expected).abs() < 1e-9 * (1.0 + expected), "{angle} {length} {further}");
                apart = apart.max((value(turned(5.0), wi) - expected).abs());
            }
            assert!(apart > 1e-3, "5 degrees more look alike");
        }
    }
    // A texel without a direction means that of u.
    let keys = "anisotropy = 0.6";
    assert_eq!(brushed(DVec3::splat(0.5), true, keys), brushed(DVec3::ONE, false, keys));
}
