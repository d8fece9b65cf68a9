//! Clear skies: sun and sky are turned together, and level ground gets what formulas say.

use std::path::Path;

use gpt::cpu::ReferenceRenderer;
use gpt::load::load_toml_str;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::{Light, Scene};
use gpt::spectrum::Spectrum;

fn scene(camera: &str, light: &str) -> Scene {
    let text = format!(
        "[film]\nsize = [8, 8]\n[render]\nspp = 16\nmax_depth = 2\n[camera]\n{camera}\n[[light]]\ntype = \"environment\"\n{light}\n\
         [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 1\n[[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\n\
         corner = [-1, -9, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\n"
    );
    load_toml_str(&text, "sky.toml", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

fn mean(scene: &Scene) -> Spectrum {
    let mut sum = Spectrum::BLACK;
    let request = RenderRequest { rows: 0..8, samples: 0..scene.render.spp };
    let report = ReferenceRenderer::new(scene).expect("it is supported").render(&request, &Silent, &mut |band| {
        band.mean.iter().for_each(|pixel| sum += Spectrum::from_f32(*pixel));
        Ok(())
    });
    report.expect("it renders");
    sum / 64.0
}

/// However the environment is turned, the sky is as bright as ever in the direction that its sun shines from, and not where the sun was before.
#[test]
fn sun_and_sky_are_turned_together() {
    let day = "daylight = { to_sun = [1, 0.8, -0.5], turbidity = 4 }";
    let look = |to: glam::DVec3, turn: &str| {
        let camera = format!("position = [0, 0, 0]\nlook_at = {:?}\nup = [0.1, 1, 0.2]\nvfov = 3", to.to_array());
        scene(&camera, &format!("{day}\n{turn}"))
    };
    let to_sun = |turn: &str| {
        let [_, Light::Directional(sun)] = &look(glam::DVec3::X, turn).lights[..] else { panic!("sky and sun") };
        -sun.direction
    };
    let towards = |to: glam::DVec3, turn: &str| mean(&look(to, turn)).luminance();
    let (at_rest, expected) = (to_sun(""), towards(to_sun(""), ""));
    assert!(at_rest.distance(glam::DVec3::new(1.0, 0.8, -0.5).normalize()) < 1e-12, "{at_rest}");
    for turn in ["rotate = 70", "mirror = true\nrotate = 30", "rotate = 20\ntransform = [{ rotate = [1, 0.3, 0], degrees = 35 }]"]
    {
        let found = towards(to_sun(turn), turn);
        assert!((found / expected - 1.0).abs() < 0.01, "{turn}: {found} and not {expected}");
        let control = towards(at_rest, turn);
        assert!((control / expected - 1.0).abs() > 0.2, "{turn}: {control} where the sun was");
    }
    let alone = scene("look_at = [1, 0, 0]\nposition = [0, 0, 0]\nvfov = 3", "daylight = { to_sun = [1, 1, 0], sun = false }");
    assert_eq!(alone.lights.len(), 1);
}

/// Level white paper sends on (E of the sky + E of the sun)/π, of which the sun's part is known by its light.
#[test]
fn level_paper_gets_the_light_of_sun_and_sky() {
    let above = "position = [0, -8, 0]\nlook_at = [0, -9, 0]\nup = [0, 0, -1]\nvfov = 30";
    let keys = "to_sun = [0.5, 1, 0.3], turbidity = 2.5, ground = 0";
    let lit = scene(above, &format!("daylight = {{ {keys} }}"));
    let [_, Light::Directional(sun)] = &lit.lights[..] else { panic!("sky and sun") };
    let of_sun = sun.irradiance * -sun.direction.y / std::f64::consts::PI;
    let (both, sky) = (mean(&lit), mean(&scene(above, &format!("daylight = {{ {keys}, sun = false }}"))));
    let found = both - sky;
    assert!(((found.luminance() / of_sun.luminance()) - 1.0).abs() < 0.03, "{found} and not {of_sun}");
    // Twice as much light is twice as much of both.
    let double = mean(&scene(above, &format!("daylight = {{ {keys} }}\nscale = 2")));
    assert!((double.luminance() / both.luminance() - 2.0).abs() < 0.01, "{double} {both}");
    // The control: without the sun there is much less.
    assert!(sky.luminance() < 0.6 * both.luminance(), "{sky} {both}");
}
