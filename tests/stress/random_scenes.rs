//! Scenes thrown together at random, by the text that a person could have written: none may make a number that is not finite.

use std::fmt::Write as _;

use crate::statistics::random::SplitMix64;
use gpt::load::load_toml_str;
use gpt::plan::PlanOptions;
use gpt::scene::Scene;

use super::support::{Effort, Finding, compare_with, mean_difference};

/// Paths of a random scene that match, at least: mirrors that face each other and blends of them make some scenes chaotic.
const LEAST_MATCHING: f64 = 0.9;

pub fn findings(effort: Effort) -> Vec<Finding> {
    let count = effort.pick(12, 1_000);
    // Other scenes on request, and any one of them by itself.
    let number = |name| std::env::var(name).ok().and_then(|text: String| text.parse().ok());
    let first = number("GPT_STRESS_SEED").unwrap_or(1);
    let count = number("GPT_STRESS_COUNT").unwrap_or(count);
    let mut tally = Tally::default();
    for seed in first..first + count {
        let text = text(seed);
        let scene = load_toml_str(&text, &format!("random {seed}"), std::path::Path::new(""));
        match scene {
            Ok(scene) => tally.render(seed, &scene),
            Err(error) => tally.complaints.push(format!("seed {seed} is refused: {error:?}\n{text}")),
        }
    }
    tally.findings(count)
}

#[derive(Default)]
struct Tally {
    rendered: u64,
    paths: u64,
    matching: u64,
    non_finite: u64,
    least_matching: f64,
    worst_seed: u64,
    largest_mean_difference: f64,
    complaints: Vec<String>,
}

impl Tally {
    fn render(&mut self, seed: u64, scene: &Scene) {
        let Some(verdict) = compare_with(scene, scene, &PlanOptions::default()) else { return };
        if std::env::var("GPT_STRESS_VERBOSE").is_ok() {
            println!(
                "seed {seed}: {:.2} % match, {} not finite, {} rejected",
                100.0 * verdict.loosely_matching_share(),
                verdict.non_finite_samples,
                verdict.rejections.len()
            );
        }
        if self.rendered == 0 || verdict.loosely_matching_share() < self.least_matching {
            (self.least_matching, self.worst_seed) = (verdict.loosely_matching_share(), seed);
        }
        self.rendered += 1;
        self.paths += verdict.paths;
        self.matching += verdict.matching_paths;
        self.non_finite += verdict.non_finite_samples;
        self.largest_mean_difference = self.largest_mean_difference.max(mean_difference(&verdict));
        if verdict.non_finite_samples > 0 || verdict.loosely_matching_share() < LEAST_MATCHING || !verdict.rejections.is_empty() {
            self.complaints.push(format!("seed {seed}: {verdict:?}"));
        }
    }

    fn findings(self, count: u64) -> Vec<Finding> {
        if self.rendered == 0 && self.complaints.is_empty() {
            return Vec::new();
        }
        let finding = Finding::new(format!("{count} random scenes"))
            .with("paths", self.paths)
            .with("not finite", self.non_finite)
            .with("paths that match", format!("{:.3} %", 100.0 * self.matching as f64 / self.paths.max(1) as f64))
            .with("in the worst scene", format!("{:.2} % (seed {})", 100.0 * self.least_matching, self.worst_seed))
            .with("largest difference of the means", format!("{:.1e}", self.largest_mean_difference));
        vec![finding.require(self.complaints.is_empty(), || self.complaints.join("\n"))]
    }
}

/// The scene that belongs to a seed.
pub fn text(seed: u64) -> String {
    let mut writer = Writer { random: SplitMix64::new(seed), text: String::new(), emits: Vec::new() };
    writer.settings();
    writer.textures();
    let materials = writer.materials();
    writer.shapes(materials);
    writer.lights();
    writer.text
}

/// Said of a box whose faces coincide.
const NO_THICKNESS: &str = " # no thickness";

/// Writes tables, drawing every choice from one stream.
struct Writer {
    random: SplitMix64,
    text: String,
    /// For each material so far, true if it emits, or some part of it does.
    emits: Vec<bool>,
}

impl Writer {
    fn below(&mut self, count: usize) -> usize {
        (self.random.uniform() * count as f64) as usize
    }

    fn pick<'a>(&mut self, choices: &[&'a str]) -> &'a str {
        choices[self.below(choices.len())]
    }

    fn chance(&mut self, probability: f64) -> bool {
        self.random.uniform() < probability
    }

    /// In [low, high).
    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.uniform()
    }

    /// Both ends more often than chance would have it.
    fn fraction(&mut self) -> f64 {
        match self.below(6) {
            0 => 0.0,
            1 => 1.0,
            _ => self.random.uniform(),
        }
    }

    /// Spread evenly over the powers of ten.
    fn magnitude(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low.log10(), high.log10()))
    }

    fn color(&mut self) -> String {
        if self.chance(0.15) {
            return "{ texture = \"pattern\" }".to_owned();
        }
        format!("[{:?}, {:?}, {:?}]", self.fraction(), self.fraction(), self.fraction())
    }

    fn triple(&mut self, reach: f64) -> String {
        // Exact zeros and equal coordinates are what rounding stumbles over.
        let mut one = |_| if self.chance(0.2) { 0.0 } else { self.between(-reach, reach) };
        let [x, y, z] = std::array::from_fn(&mut one);
        format!("[{x:?}, {y:?}, {z:?}]")
    }

    fn direction(&mut self) -> String {
        self.pick(&["[0, 1, 0]", "[0, 0, -1]", "[1, 0, 0]", "[1, 2, 3]", "[-1, 1e-4, 0]", "[0.3, -0.9, 0.2]"]).to_owned()
    }

    fn line(&mut self, line: std::fmt::Arguments<'_>) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "{line}");
    }

    fn settings(&mut self) {
        let filter = self.pick(&["box", "tent", "gaussian", "blackman_harris"]);
        self.line(format_args!("[film]\nsize = [24, 16]\nfilter = {{ type = \"{filter}\" }}"));
        let (depth, sampler) =
            (self.pick(&["1", "2", "5", "16", "0"]), self.pick(&["halton", "sobol", "independent", "stratified"]));
        let (estimator, heuristic) = (self.pick(&["mis", "mis", "nee", "bsdf"]), self.pick(&["power", "balance"]));
        let (hemisphere, lights) = (self.pick(&["cosine", "uniform"]), self.pick(&["cone", "visible", "area"]));
        let seed = self.below(1000);
        self.line(format_args!(
            "[render]\nspp = 4\nmax_depth = {depth}\nsampler = \"{sampler}\"\nestimator = \"{estimator}\"\nheuristic = \"{heuristic}\"\n\
             hemisphere = \"{hemisphere}\"\nlight_sampling = \"{lights}\"\nseed = {seed}"
        ));
        let position = self.pick(&["[0, 1, 5]", "[3, 2, 4]", "[0.1, 0.2, 0.3]", "[-4, 0.5, -1]"]);
        let fov = self.between(10.0, 120.0);
        self.line(format_args!("[camera]\nposition = {position}\nlook_at = [0, 0.3, 0]\nvfov = {fov:?}"));
        if self.chance(0.3) {
            let (radius, distance) = (self.magnitude(1e-3, 1.0), self.between(0.5, 8.0));
            self.line(format_args!("aperture = {{ shape = \"disk\", radius = {radius:e} }}\nfocus_distance = {distance:?}"));
        }
    }

    fn textures(&mut self) {
        let kind = self.pick(&["checker", "perlin", "worley"]);
        let scale = if kind == "checker" { "[7, 5]" } else { "4" };
        self.line(format_args!(
            "[[texture]]\nname = \"pattern\"\ntype = \"{kind}\"\na = [0.9, 0.2, 0.1]\nb = [0, 0.5, 1]\nscale = {scale}"
        ));
    }

    /// Returns how many there are; `m0` is the first.
    fn materials(&mut self) -> usize {
        let plain = 2 + self.below(4);
        for index in 0..plain {
            let keys = self.plain_material();
            self.emits.push(keys.contains("emissive"));
            self.line(format_args!("[[material]]\nname = \"m{index}\"\n{keys}"));
            if self.chance(0.1) && !keys.contains("emissive") && !keys.contains("\"pass\"") {
                let radiance = self.magnitude(1e-3, 1e3);
                self.line(format_args!("emission = {radiance:e}"));
                self.emits[index] = true;
            }
        }
        let blends = self.below(4);
        for index in plain..plain + blends {
            let (first, second) = (self.below(index), self.below(index));
            let weight = self.weight(0);
            self.emits.push(self.emits[first] || self.emits[second]);
            self.line(format_args!(
                "[[material]]\nname = \"m{index}\"\ntype = \"blend\"\nmaterials = [\"m{first}\", \"m{second}\"]\nweight = {weight}"
            ));
        }
        plain + blends
    }

    fn plain_material(&mut self) -> String {
        let color = self.color();
        match self.below(11) {
            0 => format!("type = \"diffuse\"\nreflectance = {color}"),
            1 => format!("type = \"mirror\"\nreflectance = {color}"),
            2 => format!("type = \"glossy\"\nreflectance = {color}\nexponent = {:e}", self.exponent()),
            3 => {
                let diffuse = self.random.uniform();
                format!(
                    "type = \"phong\"\ndiffuse = {diffuse:?}\nspecular = {:?}\nexponent = {:e}",
                    1.0 - diffuse,
                    self.exponent()
                )
            }
            4 => format!("type = \"glass\"\nior = {:?}\ntransmittance = {color}", self.ior()),
            5 => format!("type = \"rough_glass\"\nior = {:?}\nalpha = {:?}\nreflectance = {color}", self.ior(), self.fraction()),
            6 => format!("type = \"rough_glass\"\nior = {:?}\nexponent = {:e}", self.ior(), self.exponent().max(1e-3)),
            7 => format!("type = \"conductor\"\npreset = \"{}\"\nalpha = {:?}", self.pick(&["gold", "silver"]), self.fraction()),
            8 => format!("type = \"conductor\"\nreflectance = {color}\nroughness = {:e}", self.magnitude(1e-3, 1.0)),
            9 => format!("type = \"emissive\"\nradiance = {:e}\ntwo_sided = {}", self.magnitude(1e-6, 1e6), self.chance(0.5)),
            _ => "type = \"pass\"".to_owned(),
        }
    }

    fn exponent(&mut self) -> f64 {
        if self.chance(0.1) { 0.0 } else { self.magnitude(1e-2, 1e6) }
    }

    fn ior(&mut self) -> f64 {
        if self.chance(0.1) { 1.0 } else { self.magnitude(0.1, 10.0).clamp(0.1, 10.0) }
    }

    fn weight(&mut self, depth: u32) -> String {
        match self.below(if depth < 3 { 7 } else { 4 }) {
            0 => format!("{{ type = \"constant\", value = {:?} }}", self.fraction()),
            1 => format!("{{ type = \"facing\", power = {:e} }}", self.magnitude(1e-3, 1e3)),
            2 => format!("{{ type = \"fresnel\", ior = {:?}, exact = {} }}", self.ior(), self.chance(0.5)),
            3 => "{ type = \"texture\", texture = \"pattern\" }".to_owned(),
            4 => format!("{{ type = \"reverse\", of = {} }}", self.weight(depth + 1)),
            _ => format!("{{ type = \"threshold\", tau = {:?}, of = {} }}", self.fraction(), self.weight(depth + 1)),
        }
    }

    fn shapes(&mut self, materials: usize) {
        self.line(format_args!(
            "[[material]]\nname = \"ground\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [-6, 0, 6]\nedge_u = [12, 0, 0]\nedge_v = [0, 0, -12]\nmaterial = \"ground\""
        ));
        let shapes = 1 + self.below(7);
        for _ in 0..shapes {
            let geometry = self.geometry();
            // Disks have no texture coordinates. Where a box has no thickness, two faces lie in one place, and rounding says which of them a
            // ray meets: they must look the same.
            let plain = geometry.contains("disk");
            let chosen = if plain { None } else { Some(self.below(materials)) };
            let chosen = chosen.filter(|&index| !(geometry.contains(NO_THICKNESS) && self.emits[index]));
            let material = chosen.map_or("ground".to_owned(), |index| format!("m{index}"));
            self.line(format_args!("[[shape]]\n{geometry}\nmaterial = \"{material}\""));
            self.placement();
        }
    }

    fn geometry(&mut self) -> String {
        match self.below(5) {
            0 => format!("type = \"sphere\"\ncenter = {}\nradius = {:e}", self.triple(2.0), self.magnitude(1e-2, 2.0)),
            1 => format!(
                "type = \"rectangle\"\ncorner = {}\nedge_u = [1.5, 0, 0.1]\nedge_v = [-0.2, 1, {:?}]",
                self.triple(2.0),
                self.random.uniform()
            ),
            2 => format!(
                "type = \"disk\"\ncenter = {}\nnormal = {}\nradius = {:e}",
                self.triple(2.0),
                self.direction(),
                self.magnitude(1e-2, 2.0)
            ),
            3 => {
                let corner: [f64; 3] = std::array::from_fn(|_| self.between(-2.0, 1.0));
                // Boxes of zero thickness, too.
                let flat = self.below(6);
                let far: [f64; 3] = std::array::from_fn(|axis| corner[axis] + if axis == flat { 0.0 } else { 1.0 });
                let remark = if flat < 3 { NO_THICKNESS } else { "" };
                format!("type = \"box\"\nmin = {corner:?}\nmax = {far:?}{remark}")
            }
            _ => {
                let points: Vec<String> = (0..4).map(|_| self.triple(1.5)).collect();
                format!(
                    "type = \"mesh\"\npositions = [{}, [0.5, 0.25, 0.125]]\nuvs = [[0, 0], [1, 0], [0, 1], [1, 1], [0.5, 0.5]]\n\
                     faces = [[0, 1, 2], [0, 2, 3], [1, 3, 2], [0, 1, 4], [4, 2, 0]]\nsmooth = {}",
                    points.join(", "),
                    self.chance(0.5)
                )
            }
        }
    }

    fn placement(&mut self) {
        if self.chance(0.5) {
            let (axis, degrees) = (self.direction(), self.between(-180.0, 180.0));
            let (scale, offset) = (self.magnitude(0.1, 3.0), self.triple(1.5));
            let sign = if self.chance(0.2) { "-" } else { "" };
            self.line(format_args!(
                "transform = [{{ scale = {sign}{scale:?} }}, {{ rotate = {axis}, degrees = {degrees:?} }}, {{ translate = {offset} }}]"
            ));
        }
        if self.chance(0.15) {
            let (degrees, offset) = (self.between(-90.0, 90.0), self.triple(0.5));
            self.line(format_args!("motion = [{{ rotate = [0, 1, 0], degrees = {degrees:?} }}, {{ translate = {offset} }}]"));
        }
    }

    /// The place of a light: not in the ground, of which it would be on both sides or on none.
    fn light_position(&mut self) -> String {
        self.triple(3.0).replace(", 0.0, ", ", 0.01, ")
    }

    fn lights(&mut self) {
        let environment = match self.below(3) {
            0 => format!("type = \"environment\"\nradiance = {:e}", self.magnitude(1e-3, 1e3)),
            1 => "type = \"sky\"\nzenith = [0.2, 0.4, 1]\nhorizon = 1\nground = 0.2".to_owned(),
            _ => "type = \"directional\"\ndirection = [0.3, -1, 0.2]\nirradiance = 2".to_owned(),
        };
        self.line(format_args!("[[light]]\n{environment}"));
        if self.chance(0.4) {
            let (position, intensity) = (self.light_position(), self.magnitude(1e-3, 1e3));
            self.line(format_args!("[[light]]\ntype = \"point\"\nposition = {position}\nintensity = {intensity:e}"));
        }
        if self.chance(0.3) {
            let (position, angle) = (self.light_position(), self.magnitude(1e-2, 90.0));
            self.line(format_args!(
                "[[light]]\ntype = \"spot\"\nposition = {position}\ndirection = [0, -1, 0.1]\nintensity = 5\nangle = {angle:?}"
            ));
        }
    }
}
