//! Stacks against closed forms, against oracles, and by their own estimators.

mod doubling;

use std::f64::consts::PI;
use std::path::Path;

use glam::DVec3;

use super::layers::LayersOfMaterials;
use super::stack::Stack;
use crate::load::load_toml_str;
use crate::reference::bsdf::{Density, View};
use crate::reference::intersect::{PathTime, Ray, Surface, World};
use crate::reference::tracking::Stream;
use crate::sampling::hash::mix;
use crate::scene::Scene;
use crate::spectrum::Spectrum;

const MATERIALS: &str = r#"
[camera]
position = [0, 0, 1]
look_at = [0, 0, 0]
vfov = 40
[[light]]
type = "environment"
radiance = 1
[[medium]]
name = "milk"
scattering = [1, 2, 3]
phase = { type = "henyey_greenstein", g = 0.3 }
[[medium]]
name = "fog"
scattering = 2
[[medium]]
name = "dye"
absorption = [0.2, 0.5, 1]
[[medium]]
name = "pigment"
scattering = [3, 2, 1]
absorption = [0.1, 0.3, 0.5]
phase = { type = "henyey_greenstein", g = -0.4 }
[[material]]
name = "varnish"
type = "glass"
ior = 1.5
[[material]]
name = "under"
type = "glass"
ior = 0.6666666666666666
[[material]]
name = "frost"
type = "rough_glass"
ior = 1.4
alpha = 0.3
[[material]]
name = "sharp"
type = "rough_glass"
ior = 1.5
alpha = 0.12
[[material]]
name = "wide"
type = "rough_glass"
ior = 0.8
alpha = 0.5
[[material]]
name = "white"
type = "diffuse"
reflectance = 1
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.8, 0.3, 0.1]
[[material]]
name = "gold"
type = "conductor"
preset = "gold"
alpha = 0.2
[[material]]
name = "mirror"
type = "mirror"
[[material]]
name = "nothing"
type = "pass"
[[material]]
name = "tinted"
type = "blend"
materials = ["gold", "red"]
weight = { type = "constant", value = 0.4 }
"#;

/// A stack on a square whose front looks along z.
struct Probe {
    scene: Scene,
    layers: LayersOfMaterials,
    surface: Surface,
}

impl Probe {
    fn new(keys: &str) -> Self {
        let text = format!(
            "{MATERIALS}[[material]]\nname = 'stack'\ntype = 'layered'\n{keys}\n[[shape]]\ntype = 'rectangle'\ncorner = [-5, -5, 0]\n\
             edge_u = [10, 0, 0]\nedge_v = [0, 10, 0]\nmaterial = 'stack'\n"
        );
        let scene = load_toml_str(&text, "stack", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
        let ray = Ray { origin: DVec3::Z, direction: -DVec3::Z };
        let world = World::new(&scene).expect("a scene");
        let hit = world.closest(ray, &PathTime::default()).expect("the square is there");
        let surface = world.surface(&ray, &hit, &PathTime::default());
        Self { layers: LayersOfMaterials::new(&scene), scene, surface }
    }

    fn with<T>(&self, wo: DVec3, look: impl FnOnce(&Stack<'_>) -> T) -> T {
        let view = View::new(wo, self.surface.point.normal, self.surface.shading_normal);
        let layers = self.layers.of(self.surface.owner.material).expect("it is a stack");
        look(&Stack::new(&self.scene, &self.surface, layers, &view))
    }

    /// Mean weights of walks that end above and below, and those of them with a density.
    fn walks(&self, wo: DVec3, count: u32) -> [Mean; 4] {
        self.with(wo, |stack| {
            let mut means = [Mean::default(); 4];
            for index in 0..count {
                let mut stream = Stream::new(mix(index ^ 0x1234_5678));
                let first = [stream.draw(), stream.draw(), stream.draw()];
                let sample = stack.walk(wo, first, &mut stream);
                let mut found = [Spectrum::BLACK; 4];
                if let Some(sample) = sample {
                    // Radiance that crosses from one medium into another scales, energy does not.
                    let place = usize::from(sample.wi.z < 0.0);
                    found[place] = sample.weight * sample.eta * sample.eta;
                    if sample.density != Density::Delta {
                        found[2 + place] = sample.weight;
                    }
                }
                means.iter_mut().zip(found).for_each(|(mean, value)| mean.add(value));
            }
            means
        })
    }

    /// Estimates of f·|cosθi|.
    fn estimates(&self, wo: DVec3, wi: DVec3, count: u32) -> Mean {
        self.with(wo, |stack| {
            let mut mean = Mean::default();
            (0..count).for_each(|index| mean.add(stack.estimate(wo, wi, &mut Stream::new(mix(index ^ 0x9876_5432)))));
            mean
        })
    }

    /// The integral of estimates over directions on one side, of what `weight` makes of each.
    fn integral(&self, wo: DVec3, above: bool, count: u32, weight: impl Fn(DVec3) -> f64) -> Mean {
        self.with(wo, |stack| {
            let mut mean = Mean::default();
            for index in 0..count {
                let mut stream = Stream::new(mix(index ^ 0x0bad_cafe));
                let (u, v) = (stream.draw(), stream.draw());
                let sine = (1.0 - u * u).sqrt();
                let wi = DVec3::new(sine * (2.0 * PI * v).cos(), sine * (2.0 * PI * v).sin(), if above { u } else { -u });
                mean.add(stack.estimate(wo, wi, &mut stream) * (2.0 * PI * weight(wi)));
            }
            mean
        })
    }
}

/// A mean with its standard error, channel by channel.
#[derive(Debug, Clone, Copy, Default)]
struct Mean {
    sum: Spectrum,
    squares: Spectrum,
    count: f64,
}

impl Mean {
    fn add(&mut self, value: Spectrum) {
        self.sum += value;
        self.squares += value * value;
        self.count += 1.0;
    }

    fn value(&self) -> Spectrum {
        self.sum / self.count
    }

    fn error(&self) -> Spectrum {
        let variance = (self.squares / self.count - self.value() * self.value()).max(Spectrum::BLACK);
        (variance / self.count).sqrt()
    }

    /// Standard errors between this and a number without error, of the channel that differs most.
    fn deviation(&self, exact: Spectrum) -> f64 {
        let [mean, error, exact] = [self.value(), self.error(), exact].map(Spectrum::to_rgb);
        (0..3).map(|channel| (mean[channel] - exact[channel]).abs() / (error[channel] + 1e-9)).fold(0.0, f64::max)
    }

    /// Standard errors between two means.
    fn distance(&self, other: &Self) -> f64 {
        let error = (self.error() * self.error() + other.error() * other.error()).sqrt().to_rgb();
        let [one, other] = [self.value(), other.value()].map(Spectrum::to_rgb);
        (0..3).map(|channel| (one[channel] - other[channel]).abs() / (error[channel] + 1e-9)).fold(0.0, f64::max)
    }
}

fn at(degrees: f64, around: f64) -> DVec3 {
    let (sine, cosine) = degrees.to_radians().sin_cos();
    DVec3::new(sine * around.cos(), sine * around.sin(), cosine)
}

/// Fresnel's reflectance of a smooth boundary.
fn fresnel(cosine: f64, ior: f64) -> f64 {
    crate::math::dielectric_reflectance(cosine, ior)
}

/// A plate of glass: reflections to and fro within add up to a geometric series, with what an absorbing slab leaves at each passage.
#[test]
fn two_smooth_interfaces_are_the_closed_sum() {
    let probe = Probe::new("interfaces = ['varnish', 'under']\nslabs = [{ thickness = 0.7, medium = 'dye' }]");
    for degrees in [0.0, 35.0, 70.0, 85.0] {
        let wo = at(degrees, 0.3);
        let reflected = fresnel(wo.z, 1.5);
        let within = (1.0 - (1.0 - wo.z * wo.z) / 2.25).sqrt();
        let passed = (Spectrum::new(0.2, 0.5, 1.0) * (-0.7 / within)).exp();
        let to_and_fro = Spectrum::WHITE - passed * passed * reflected * reflected;
        let one = Spectrum::WHITE;
        let through = passed * (1.0 - reflected).powi(2) / to_and_fro;
        let back = Spectrum::grey(reflected) + passed * passed * reflected * (1.0 - reflected).powi(2) / to_and_fro;
        let walks = probe.walks(wo, 40_000);
        assert!(walks[0].deviation(back) < 4.0, "{degrees}: {:?} and not {back}", walks[0].value());
        assert!(walks[1].deviation(through) < 4.0, "{degrees}: {:?} and not {through}", walks[1].value());
        assert!(walks[0].deviation(back + one * 0.02) > 4.0, "a difference of 0.02 would be noticed");
        // No way has a density.
        assert_eq!([walks[2].value(), walks[3].value()], [Spectrum::BLACK; 2]);
        assert_eq!(probe.estimates(wo, at(40.0, 1.0), 50).value(), Spectrum::BLACK);
    }
}

/// Stacks of which nothing is lost give back all light, at every angle: white furnaces.
#[test]
fn nothing_is_lost_between_layers() {
    for keys in [
        "interfaces = ['varnish', 'white']",
        "interfaces = ['varnish', 'white']\nslabs = [{ thickness = 0.5, medium = 'milk' }]",
        "interfaces = ['varnish', 'under', 'varnish', 'mirror']\nslabs = [{ thickness = 1, medium = 'fog' }, {}, { thickness = 0.2, medium = 'milk' }]",
        "interfaces = ['varnish', 'under']\nslabs = [{ thickness = 0.5, medium = 'milk' }]",
        "interfaces = ['nothing', 'white']\nslabs = [{ thickness = 3, medium = 'fog' }]",
    ] {
        let probe = Probe::new(keys);
        for degrees in [0.0, 45.0, 80.0, 89.0] {
            // Channels that differ make noise.
            let count = if keys.contains("milk") { 120_000 } else { 40_000 };
            let walks = probe.walks(at(degrees, 0.1), count);
            let all = walks[0].value() + walks[1].value();
            let error = walks[0].error().max_component() + walks[1].error().max_component();
            let difference = (all - Spectrum::WHITE).to_rgb().into_iter().map(f64::abs).fold(0.0, f64::max);
            assert!(difference < 2e-3 + 3.0 * error && error < 8e-3, "{keys} at {degrees}: {all}, error {error}");
        }
    }
    let lossy = Probe::new("interfaces = ['varnish', 'white']\nslabs = [{ thickness = 0.01, medium = 'dye' }]");
    let all = lossy.walks(at(45.0, 0.0), 60_000)[0].value();
    assert!(all.distance(Spectrum::WHITE) > 2e-3 * 3.0_f64.sqrt(), "the control loses light: {all}");
}

/// Smooth glass on a diffuse base is the closed form of plastic whose colour deepens.
#[test]
fn varnish_on_a_diffuse_base_is_plastic() {
    let probe = Probe::new("interfaces = ['varnish', 'red']");
    let reflectance = Spectrum::new(0.8, 0.3, 0.1);
    let from_within = crate::scene::material::diffuse_reflectance(1.5);
    let inner = 1.0 - (1.0 - from_within) / 2.25;
    for (wo, wi) in [(at(20.0, 0.0), at(50.0, 2.0)), (at(75.0, 0.0), at(10.0, 1.0)), (at(60.0, 0.4), at(80.0, 3.0))] {
        let passed = (1.0 - fresnel(wo.z, 1.5)) * (1.0 - fresnel(wi.z, 1.5));
        let base = reflectance / (Spectrum::WHITE - reflectance * inner);
        let exact = base * (passed * wi.z / (PI * 2.25));
        let found = probe.estimates(wo, wi, 40_000);
        assert!(found.deviation(exact) < 4.0, "{:?} and not {exact}", found.value());
        assert!(found.error().max_component() < 0.01 * exact.max_component());
    }
}

/// Interfaces of all kinds, with and without slabs between them.
const STACKS: &[&str] = &[
    "interfaces = ['varnish', 'red']",
    "interfaces = ['frost', 'red']",
    "interfaces = ['frost', 'gold']",
    "interfaces = ['sharp', 'gold']",
    "interfaces = ['frost', 'mirror']",
    "interfaces = ['varnish', 'gold']\nslabs = [{ thickness = 0.3, medium = 'pigment' }]",
    "interfaces = ['sharp', 'tinted']\nslabs = [{ thickness = 0.2, medium = 'milk' }]",
    "interfaces = ['frost', 'sharp', 'red']\nslabs = [{ thickness = 0.5, medium = 'dye' }, { thickness = 0.3, medium = 'pigment' }]",
    "interfaces = ['varnish', 'under', 'frost', 'gold']",
    "interfaces = ['frost', 'under']\nslabs = [{ thickness = 0.4, medium = 'milk' }]",
    "interfaces = ['nothing', 'nothing']\nslabs = [{ thickness = 1, medium = 'pigment' }]",
];

/// Walks and evaluation are two estimators of one BSDF: over each side, all of it and what a weight that varies over directions makes of it.
#[test]
fn walks_and_evaluation_agree() {
    for keys in STACKS {
        let probe = Probe::new(keys);
        for (wo, above) in [(at(30.0, 0.4), true), (at(75.0, 1.0), true), (at(30.0, 0.4), false), (-at(50.0, 0.2), true)] {
            let weight = |wi: DVec3| 1.0 + 0.9 * wi.x - 0.7 * wi.y * wi.y;
            let evaluated = probe.integral(wo, above, 60_000, weight);
            let walked = probe.with(wo, |stack| {
                let mut mean = Mean::default();
                for index in 0..60_000 {
                    let mut stream = Stream::new(mix(index ^ 0x0f0f_1e1e));
                    let first = [stream.draw(), stream.draw(), stream.draw()];
                    let sample = stack.walk(wo, first, &mut stream);
                    let counts = sample.filter(|sample| sample.density != Density::Delta && (sample.wi.z > 0.0) == above);
                    mean.add(counts.map_or(Spectrum::BLACK, |sample| sample.weight * weight(sample.wi)));
                }
                mean
            });
            let distance = evaluated.distance(&walked);
            assert!(distance < 4.5, "{keys}, {wo}, {above}: {} and {}, {distance} errors", evaluated.value(), walked.value());
        }
    }
}

/// Light goes both ways alike, but for the squared ratio of indices of refraction.
#[test]
fn stacks_are_reciprocal() {
    for keys in STACKS {
        let probe = Probe::new(keys);
        let ends = probe.layers.of(probe.surface.owner.material).expect("it is a stack");
        let eta: f64 = ends.layers.iter().map(|layer| layer.flat.ior).product();
        let pairs =
            [(at(20.0, 0.0), at(60.0, 1.0), 1.0), (at(70.0, 0.3), at(75.0, 3.2), 1.0), (at(40.0, 0.0), -at(30.0, 2.0), eta)];
        for (wo, wi, eta) in pairs {
            let there = probe.estimates(wo, wi, 30_000);
            let mut back = probe.estimates(wi, wo, 30_000);
            // f(wo, wi) of radiance times η² on wi's side over wo's is f(wi, wo).
            let factor = wi.z.abs() / wo.z.abs() / (eta * eta);
            back.sum *= factor;
            back.squares *= factor * factor;
            assert!(there.distance(&back) < 4.5, "{keys}: {} and {}", there.value(), back.value());
        }
    }
}

/// Weidlich and Wilkie's density is that of its own samples.
#[test]
fn densities_are_those_of_samples() {
    let probe =
        Probe::new("interfaces = ['frost', 'gold']\nslabs = [{ thickness = 0.2, medium = 'dye' }]\nmodel = 'weidlich-wilkie'");
    for wo in [at(20.0, 0.3), at(65.0, 1.0)] {
        probe.with(wo, |stack| {
            let (mut drawn, mut valued, mut integral, mut share) =
                (Mean::default(), Mean::default(), Mean::default(), Mean::default());
            for index in 0..60_000 {
                let mut stream = Stream::new(mix(index ^ 0x7777_1111));
                let numbers = [stream.draw(), stream.draw(), stream.draw()];
                let weight = |wi: DVec3| 1.0 + 0.9 * wi.x;
                let sample = stack.draw_straight(wo, numbers);
                drawn.add(sample.map_or(Spectrum::BLACK, |sample| sample.weight * weight(sample.wi)));
                share.add(Spectrum::grey(f64::from(u8::from(sample.is_some()))));
                let sine = (1.0 - numbers[0] * numbers[0]).sqrt();
                let (across, along) = (2.0 * PI * numbers[1]).sin_cos();
                let wi = DVec3::new(sine * along, sine * across, numbers[0]);
                let found = stack.evaluate_straight(wo, wi);
                valued.add(found.value * (2.0 * PI * weight(wi)));
                integral.add(Spectrum::grey(2.0 * PI * found.pdf));
            }
            assert!(drawn.distance(&valued) < 4.5, "{wo}: {} and {}", drawn.value(), valued.value());
            assert!(share.distance(&integral) < 4.5, "{wo}: {} and {}", share.value(), integral.value());
        });
    }
}
