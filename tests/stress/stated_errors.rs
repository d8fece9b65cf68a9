//! Stated errors and whether they hold: pictures of small scenes that end by their error, once for each of many seeds, against a long render.
//!
//! A bound at 95 % is exceeded in 5 % of all renders at most. Where light is rare, no bound that is made of what samples have seen can promise that: what
//! none of them has found is in no variance. So a render that exceeds its bound must have come with a warning.

use gpt::compare::relative_weight;
use gpt::cpu::ReferenceRenderer;
use gpt::load;
use gpt::render::progressive::{self, Goal, Outcome, Stop};
use gpt::renderer::Silent;
use gpt::scene::Scene;

use super::caustic::CAUSTIC;

pub const SIDE: u32 = 20;
const MOST: u32 = 1024;

/// A scene, the error that its renders are to reach, and whether some of its light is rare: found by few paths, which carry much of it.
struct Case {
    name: &'static str,
    target: f64,
    light_is_rare: bool,
}

const fn case(name: &'static str, target: f64, light_is_rare: bool) -> Case {
    Case { name, target, light_is_rare }
}

const CASES: [Case; 8] = [
    case("cornell", 0.01, false),
    case("spheres", 0.01, true),
    case("knot-plastic", 0.01, false),
    case("workshop", 0.02, false),
    case("under-sky", 0.003, false),
    case("veach-mis", 0.01, true),
    case("behind glass", 0.02, true),
    case("caustic", 0.01, true),
];

/// A room with a small lamp inside of a ball of glass, which no light sample reaches: paths find it by chance.
const BEHIND_GLASS: &str = "[film]\nsize = [20, 20]\n[camera]\nposition = [0, 1.5, 6]\nlook_at = [0, 1, 0]\nvfov = 50\n[render]\nmax_depth = 8\n\
    [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.7\n\
    [[material]]\nname = \"glass\"\ntype = \"glass\"\nior = 1.5\n\
    [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 4000\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-6, 0, -4]\nedge_u = [12, 0, 0]\nedge_v = [0, 6, 0]\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"glass\"\ncenter = [0, 2.5, 0]\nradius = 0.4\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"lamp\"\ncenter = [0, 2.5, 0]\nradius = 0.03\n\
    [[light]]\ntype = \"environment\"\nradiance = 0.3\n";

/// A ball and a floor under the sky.
const SKY: &str = "[film]\nsize = [20, 20]\n[camera]\nposition = [0, 1, 4]\nlook_at = [0, 0.5, 0]\nvfov = 50\n\
    [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.6\n\
    [[shape]]\ntype = \"sphere\"\nmaterial = \"white\"\ncenter = [0, 0.5, 0]\nradius = 0.5\n\
    [[shape]]\ntype = \"rectangle\"\nmaterial = \"white\"\ncorner = [-3, 0, 3]\nedge_u = [6, 0, 0]\nedge_v = [0, 0, -6]\n\
    [[light]]\ntype = \"sky\"\nzenith = [0.4, 0.6, 1.0]\nhorizon = 0.5\nground = 0.2\n";

/// The outcome of a scene's renders.
pub struct Coverage {
    pub name: &'static str,
    pub light_is_rare: bool,
    pub renders: u32,
    /// Renders whose error is above the bound that was stated, and those among them that came without a warning.
    pub exceeded: u32,
    pub unwarned: u32,
    /// Renders whose error is above the target, though they ended by it.
    pub missed: u32,
    pub warned: u32,
    /// Mean of all renders against the truth, less 1.
    pub bias: f64,
}

/// A scene of a name, small.
pub fn scene(name: &str) -> Scene {
    let from_text = |text: &str| load::load_toml_str(text, name, std::path::Path::new(""));
    let mut scene = match name {
        "under-sky" => from_text(SKY),
        "behind glass" => from_text(BEHIND_GLASS),
        "caustic" => from_text(CAUSTIC),
        name => load::load(Some(name)),
    }
    .expect("a scene");
    scene.film.size = [SIDE, SIDE];
    scene
}

/// The relative mean squared error of a picture.
pub fn relative_error(pixels: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let squared = |(found, truth): (&f64, &f64)| (found - truth).powi(2) * relative_weight(*truth);
    let pairs = pixels.as_flattened().iter().zip(truth.as_flattened());
    pairs.map(squared).sum::<f64>() / f64::from(3 * SIDE * SIDE)
}

fn render(renderer: &mut ReferenceRenderer, seed: u32, goal: &Goal) -> (Vec<[f64; 3]>, Outcome) {
    let mut pixels = Vec::new();
    let outcome = progressive::render(renderer, [SIDE; 2], seed, goal, &Silent, &mut |band| {
        pixels.extend(band.mean.iter().map(|pixel| pixel.map(f64::from)));
        Ok(())
    });
    (pixels, outcome.expect("it renders"))
}

fn measure(case: &Case, seeds: u32, truth_samples: u32) -> Coverage {
    let scene = scene(case.name);
    let mut renderer = ReferenceRenderer::new(&scene).expect("the scene fits");
    let goal = |samples, target_error| Goal {
        samples: 0..samples,
        region: None,
        deadline: None,
        target_error,
        adaptive: false,
        interval: None,
    };
    let (truth, _) = render(&mut renderer, 1, &goal(truth_samples, None));
    let mean = |pixels: &[[f64; 3]]| pixels.as_flattened().iter().sum::<f64>();
    let (mut exceeded, mut unwarned, mut missed, mut warned, mut bias) = (0, 0, 0, 0, 0.0);
    for seed in 0..seeds {
        let (pixels, outcome) = render(&mut renderer, 1000 + seed, &goal(MOST, Some(case.target)));
        let stated = outcome.error.expect("it was looked at");
        let error = relative_error(&pixels, &truth);
        let is_warned = stated.tails_decide() || scene.has_light_by_chance();
        warned += u32::from(is_warned);
        exceeded += u32::from(error > stated.upper);
        unwarned += u32::from(error > stated.upper && !is_warned);
        missed += u32::from(error > case.target && outcome.stop == Stop::TargetError);
        bias += (mean(&pixels) / mean(&truth) - 1.0) / f64::from(seeds);
    }
    Coverage { name: case.name, light_is_rare: case.light_is_rare, renders: seeds, exceeded, unwarned, missed, warned, bias }
}

/// All scenes, with so many seeds each, against pictures of so many samples per pixel.
pub fn measure_all(seeds: u32, truth_samples: u32) -> Vec<Coverage> {
    CASES.iter().map(|case| measure(case, seeds, truth_samples)).collect()
}

/// The rows of the table in docs/strategies.md.
pub fn table(rows: &[Coverage]) -> String {
    let share = |count: u32, of: u32| format!("{:.1} %", 100.0 * f64::from(count) / f64::from(of));
    let row = |c: &Coverage| {
        let [exceeded, missed, warned] = [c.exceeded, c.missed, c.warned].map(|count| share(count, c.renders));
        format!("| {} | {exceeded} | {missed} | {warned} | {:+.2} % |\n", c.name, 100.0 * c.bias)
    };
    rows.iter().map(row).collect()
}
