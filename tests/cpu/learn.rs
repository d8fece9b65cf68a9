//! How lights are drawn from where the settings leave it open.

use std::path::Path;
use std::time::Duration;

use gpt::cpu::ReferenceRenderer;
use gpt::learn::{Effort, Pace, settle};
use gpt::load;
use gpt::scene::{Estimator, Guiding, LightChoice, LightSampling, NumberOrAuto, RenderSettings, Scene};

const SIZE: [u32; 2] = [256, 256];

/// A built-in scene, large enough for a trial run.
fn built_in(name: &str) -> Scene {
    let mut scene = Scene::load(name).expect("a built-in scene");
    scene.film.size = SIZE;
    scene
}

fn settled(scene: &Scene) -> RenderSettings {
    settle(scene, Effort::default()).expect("the reference can render the scene").scene.render.clone()
}

fn light_samples(scene: &Scene) -> [u32; 2] {
    settled(scene).several_light_samples()
}

/// A rectangle, or as many triangles a side.
#[derive(Clone, Copy)]
enum Lamp {
    Rectangle,
    Mesh(u32),
}

/// A floor under a square lamp of this half width, and at this height. The film is large enough for a trial run to tell what pays.
fn floor_under_a_lamp(lamp: Lamp, half_width: f64, height: f64) -> Scene {
    let lamp = match lamp {
        Lamp::Rectangle => format!(
            "type = \"rectangle\"\ncorner = [-{half_width}, {height}, -{half_width}]\nedge_u = [{0}, 0, 0]\nedge_v = [0, 0, {0}]\n",
            2.0 * half_width
        ),
        Lamp::Mesh(side) => {
            let at = |index: u32| half_width * (2.0 * f64::from(index) / f64::from(side) - 1.0);
            let corners = (0..=side).flat_map(|row| (0..=side).map(move |column| (row, column)));
            let positions: Vec<[f64; 3]> = corners.map(|(row, column)| [at(column), height, at(row)]).collect();
            let squares = (0..side * side).map(|square| square / side * (side + 1) + square % side);
            let faces: Vec<[u32; 3]> =
                squares.flat_map(|at| [[at, at + 1, at + side + 2], [at, at + side + 2, at + side + 1]]).collect();
            format!("type = \"mesh\"\npositions = {positions:?}\nfaces = {faces:?}\n")
        }
    };
    let text = format!(
        "[film]\nsize = [1024, 1024]\n[render]\nmax_depth = 2\n\
         [camera]\nposition = [0, 0.4, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n\
         [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[material]]\nname = \"lamp\"\ntype = \"diffuse\"\nreflectance = 0\nemission = 1\n\
         [[shape]]\ntype = \"rectangle\"\ncorner = [-4, 0, 4]\nedge_u = [8, 0, 0]\nedge_v = [0, 0, -8]\nmaterial = \"grey\"\n\
         [[shape]]\n{lamp}material = \"lamp\"\n"
    );
    load::load_toml_str(&text, "lamp", Path::new("")).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
#[ignore = "slow"]
fn several_light_samples_are_taken_where_they_pay() {
    assert_eq!(light_samples(&built_in("cornell")), [1, 1]);
    let mut by_power = built_in("veach-mis");
    by_power.render.light_choice = LightChoice::Power;
    let [count, _] = light_samples(&by_power);
    assert!(count > 1, "{count}");
}

/// The choice belongs to the whole picture: whoever renders a part of it and states how many samples the whole has comes to the same.
#[test]
#[ignore = "slow"]
fn the_choice_depends_on_neither_the_seed_nor_the_part() {
    let mut scene = built_in("veach-mis");
    scene.render.expected_spp = 256.into();
    let chosen = settled(&scene);
    assert_ne!(chosen.light_samples, NumberOrAuto::Auto);
    for (seed, spp) in [(0, 1), (1, 256), (77, 100_000)] {
        let mut other = scene.clone();
        (other.render.seed, other.render.spp) = (seed, spp);
        assert_eq!(settled(&other), RenderSettings { seed, spp, ..chosen.clone() });
    }
    // The control: a part that does not state it is taken for a short render.
    (scene.render.spp, scene.render.expected_spp) = (1, NumberOrAuto::Auto);
    assert_eq!(settled(&scene).light_samples, NumberOrAuto::Auto);
}

/// Learning takes its share of the render: nothing is learned if that is over at once, by its samples, by a time limit or on a graphics card.
#[test]
#[ignore = "slow"]
fn short_renders_learn_nothing() {
    let choice = |spp: u32, effort: Effort| {
        let mut scene = built_in("veach-mis");
        scene.render.spp = spp;
        let settled = settle(&scene, effort).expect("the reference can render the scene");
        let because = settled.because.light_samples.clone().expect("there is a reason");
        (settled.scene.render.light_samples != NumberOrAuto::Auto, because)
    };
    let limited = |seconds: f64| Effort { time_limit: Some(Duration::from_secs_f64(seconds)), ..Effort::default() };
    let too_short = (false, "the render is too short to learn for".to_owned());
    assert!(choice(256, Effort::default()).0 && choice(256, limited(600.0)).0);
    assert_eq!(choice(4, Effort::default()), too_short);
    assert_eq!(choice(256, limited(0.01)), too_short);
    assert_eq!(choice(256, Effort { pace: Pace::Card, ..Effort::default() }), too_short);
    assert!(choice(16_384, Effort { pace: Pace::Card, ..Effort::default() }).0);
}

#[test]
fn what_is_given_stays_and_what_cannot_pay_is_not_tried() {
    let scene = built_in("veach-mis");
    let given = |change: fn(&mut RenderSettings)| {
        let mut scene = scene.clone();
        scene.render.guiding = Guiding::Off;
        change(&mut scene.render);
        scene
    };
    assert_eq!(light_samples(&given(|render| (render.light_samples, render.light_samples_depth) = (5.into(), 3))), [5, 3]);
    let without_lights = |render: &mut RenderSettings| render.estimator = Estimator::Bsdf;
    let not_tried = [given(without_lights), given(|render| render.max_depth = 1), {
        let mut small = scene.clone();
        (small.render.spp, small.render.guiding) = (4, Guiding::Off);
        small
    }];
    for scene in not_tried {
        let settled = settle(&scene, Effort::default()).expect("the reference can render the scene");
        assert_eq!((settled.scene.render.several_light_samples(), settled.depends_on_view), ([1, 1], false));
        assert!(settled.because.light_samples.is_some());
    }
}

/// BSDF sampling finds an environment of one colour better than light sampling does, so there is none.
#[test]
fn nothing_is_tried_where_only_an_even_sky_gives_light() {
    let text = "[film]\nsize = [256, 256]\n[camera]\nposition = [0, 0, 4]\nlook_at = [0, 0, 0]\nvfov = 40\n\
        [[material]]\nname = \"grey\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
        [[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"grey\"\n\
        [[light]]\ntype = \"environment\"\nradiance = 1\n";
    let scene = load::load_toml_str(text, "even", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
    let settled = settle(&scene, Effort::default()).expect("the reference can render the scene");
    assert_eq!(
        (settled.because.light_samples.as_deref(), settled.scene.render.several_light_samples()),
        (Some("no light is sampled"), [1, 1])
    );
}

/// Paths are guided neither in renders that are over before learning pays, nor where it has begun and does not pay.
#[test]
fn a_guide_that_does_not_pay_is_given_up() {
    let because = |spp: u32| {
        let mut scene = built_in("veach-mis");
        scene.render.spp = spp;
        let learned = settle(&scene, Effort::default()).expect("the reference can render the scene");
        assert!(learned.guide.is_none());
        learned.because.directions.expect("there is a reason")
    };
    assert_eq!(because(16), "the render is too short to learn for");
    let after_a_trial_run = because(256);
    assert!(after_a_trial_run.starts_with("a trial run found 1."), "{after_a_trial_run}");
}

/// The last two rounds of learning make the guide, and the scene may say how many paths they have, which are traced by the 256.
#[test]
fn a_guide_learns_of_as_many_paths_as_are_wanted() {
    let because = |paths: NumberOrAuto| {
        let mut scene = built_in("cornell");
        (scene.film.size, scene.render.guiding, scene.render.guiding_paths) = ([32, 24], Guiding::On, paths);
        let learned = settle(&scene, Effort::default()).expect("the reference can render the scene");
        learned.because.directions.expect("there is a reason")
    };
    for (paths, both) in [(NumberOrAuto::Auto, 24_576), (4096.into(), 6144), (5000.into(), 5120 + 2560)] {
        let because = because(paths);
        assert!(because.ends_with(&format!(" cells of {both} paths")), "{because}");
    }
}

/// In the cellar a guide of all rounds pays, and early looks do not end it.
#[test]
#[ignore = "long: learning a guide of all rounds that has to pay"]
fn long_a_guide_that_pays_late_is_kept() {
    let mut scene = built_in("cellar");
    scene.render.guiding = Guiding::Auto;
    let learned = settle(&scene, Effort::default()).expect("the reference can render the scene");
    let because = learned.because.directions.clone().expect("there is a reason");
    assert!(learned.guide.is_some() && because.starts_with("a trial run found 0."), "{because}");
}

/// A render whose settings leave it open is, sample by sample, the one whose settings say what the trial run chose, and not that of one light sample by power.
#[test]
#[ignore = "slow"]
fn what_is_chosen_is_what_is_rendered() {
    let open = built_in("veach-mis");
    let with = |settings: RenderSettings| Scene { render: settings, ..open.clone() };
    let one = with(RenderSettings { light_choice: LightChoice::Power, light_samples: 1.into(), ..open.render.clone() });
    let radiance = |scene: &Scene| -> Vec<[f64; 3]> {
        let renderer = ReferenceRenderer::new(scene).expect("the reference can render the scene");
        (0..64).map(|number| renderer.radiance_of_sample(4 * number, 200, number)).collect()
    };
    let found = radiance(&open);
    assert_eq!(found, radiance(&with(settled(&open))));
    assert_ne!(found, radiance(&one));
}

/// A lamp that fills half the sky of the floor below it is drawn by solid angle; one like a point is not, nor one of many triangles.
#[test]
#[ignore = "slow"]
fn only_lamps_seen_under_large_angles_are_drawn_by_solid_angle() {
    // Rectangles are drawn by area below a larger angle than triangles are.
    for (lamp, least) in [(Lamp::Rectangle, 0.1), (Lamp::Mesh(1), 0.001)] {
        assert_eq!(settled(&floor_under_a_lamp(lamp, 3.0, 0.6)).light_sampling, LightSampling::Cone);
        assert_eq!(settled(&floor_under_a_lamp(lamp, least, 3.0)).light_sampling, LightSampling::Auto);
        let mut by_area = floor_under_a_lamp(lamp, 3.0, 0.6);
        by_area.render.light_sampling = LightSampling::Area;
        assert_eq!(settled(&by_area).light_sampling, LightSampling::Area);
    }
    // Each of many triangles is seen under a small angle.
    assert_eq!(settled(&floor_under_a_lamp(Lamp::Mesh(24), 3.0, 0.6)).light_sampling, LightSampling::Auto);
}

/// Nothing is made ready where nothing is open: where no lamp has straight edges, how its points are drawn is not.
#[test]
fn a_scene_without_open_settings_is_not_made_ready() {
    let made_ready = |name: &str| {
        let mut scene = built_in(name);
        scene.render.spp = 1 << 16;
        (scene.render.light_samples, scene.render.light_choice) = (1.into(), LightChoice::Power);
        scene.render.guiding = Guiding::Off;
        settle(&scene, Effort::default()).expect("the reference can render the scene").integrator.is_some()
    };
    // Lamps of the one are spheres, that of the other is a rectangle.
    assert!(!made_ready("veach-mis") && made_ready("cornell"));
}
