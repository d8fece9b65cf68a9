//! Sampling strategies seen in pictures: how fast samplers converge, and how large a lens draws a small light.

use std::path::Path;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use crate::common::picture::render;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::PlanOptions;
use gpt::scene::{self, Aperture, ApertureShape, Projection, SamplerKind, Scene};

fn load(text: &str) -> Scene {
    load::load_toml_str(text, "strategies", Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
}

fn render_on_cpu(scene: &Scene) -> Vec<[f32; 3]> {
    render(&mut ReferenceRenderer::new(scene).expect("the scene is supported"), scene)
}

/// The pictures of one scene by the reference and by the GPU, unless the latter is to be left out.
fn on_every_device(scene: &Scene) -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let mut pictures = vec![("cpu", render_on_cpu(scene))];
    if let Some(device) = DEVICE.as_ref() {
        let mut gpu = GpuRenderer::on(device, scene, &PlanOptions::default()).expect("the scene fits");
        pictures.push(("gpu", render(&mut gpu, scene)));
    }
    pictures
}

/// A floor straight below a sphere light, seen through a field of view so narrow that all pixels see the same point and are
/// replications of each other.
const FLOOR_AND_LIGHT: &str = r#"
[film]
size = [8, 8]
[render]
max_depth = 2
[camera]
position = [4, 3, 0]
look_at = [0, 0, 0]
vfov = 0.001
[[material]]
name = "floor"
type = "diffuse"
reflectance = 0.5
[[material]]
name = "lamp"
type = "emissive"
radiance = 10
[[shape]]
type = "plane"
point = [0, 0, 0]
normal = [0, 1, 0]
material = "floor"
[[shape]]
type = "sphere"
center = [0, 2, 0]
radius = 1.5
material = "lamp"
"#;

/// Slope, in doubly logarithmic scales, of the root mean square error against the number of samples.
fn convergence_slope(sampler: SamplerKind) -> f64 {
    let mut scene = load(FLOOR_AND_LIGHT);
    scene.render.sampler = sampler;
    scene.render.estimator = scene::Estimator::Nee;
    // E = π L (R/d)², radiance ρ E / π.
    let exact = 0.5 * 10.0 * (1.5_f64 / 2.0).powi(2);
    let points = [4, 16, 64, 256, 1024].map(|spp: u32| {
        scene.render.spp = spp;
        let errors = (0..4).flat_map(|seed| {
            scene.render.seed = seed;
            render_on_cpu(&scene).into_iter().map(|pixel| f64::from(pixel[1]) - exact).collect::<Vec<f64>>()
        });
        let squares: Vec<f64> = errors.map(|error| error * error).collect();
        let mean = squares.iter().sum::<f64>() / squares.len() as f64;
        (f64::from(spp).ln(), 0.5 * mean.ln())
    });
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / points.len() as f64;
    let (x, y) = (mean(|point| point.0), mean(|point| point.1));
    let covariance: f64 = points.iter().map(|point| (point.0 - x) * (point.1 - y)).sum();
    covariance / points.iter().map(|point| (point.0 - x).powi(2)).sum::<f64>()
}

/// On a smooth integrand, random numbers have slope −½ and even ones are steeper. 256 replications (64 pixels, 4 seeds) measure each
/// error to 5 % and a slope over a factor of 256 in samples to about 0.02.
#[test]
fn even_sequences_converge_faster_than_random_numbers() {
    let independent = convergence_slope(SamplerKind::Independent);
    println!("independent: {independent:.3}");
    assert!((independent + 0.5).abs() < 0.06, "{independent}");
    for (sampler, bound) in [
        // −¾: each pixel rotates the strata, and those that straddle the square's edges meet both ends of the integrand.
        (SamplerKind::Stratified, -0.65),
        (SamplerKind::Quadrant, -0.7),
        (SamplerKind::Halton, -0.8),
        (SamplerKind::Sobol, -1.2),
    ] {
        let slope = convergence_slope(sampler);
        println!("{sampler:?}: {slope:.3}");
        assert!(slope < bound, "{sampler:?}: {slope}");
    }
}

/// A small disk light that faces the camera, at twice the distance of the plane in focus.
const SMALL_LIGHT: &str = r#"
[film]
size = [64, 64]
[render]
spp = 1024
max_depth = 1
[camera]
position = [0, 0, 0]
look_at = [0, 0, -1]
vfov = 40
[[material]]
name = "lamp"
type = "emissive"
radiance = 1
[[shape]]
type = "disk"
center = [0, 0, -8]
normal = [0, 0, 1]
radius = 0.25
material = "lamp"
"#;

const FOCUS: f64 = 4.0;
const DEPTH: f64 = 8.0;
const LIGHT_RADIUS: f64 = 0.25;
const LENS_RADIUS: f64 = 1.5;

/// Mean square distance from the picture's middle per axis, in pixels², and the largest distance of a lit pixel.
fn spread(pixels: &[[f32; 3]]) -> ([f64; 2], f64) {
    let (mut sum, mut squares, mut largest) = (0.0, [0.0; 2], 0.0_f64);
    for (index, pixel) in pixels.iter().enumerate().filter(|(_, pixel)| pixel[1] > 0.0) {
        let place = [index % 64, index / 64].map(|coordinate| coordinate as f64 + 0.5 - 32.0);
        sum += f64::from(pixel[1]);
        for axis in 0..2 {
            squares[axis] += f64::from(pixel[1]) * place[axis].powi(2);
        }
        largest = largest.max(place[0].hypot(place[1]));
    }
    (squares.map(|square| square / sum), largest)
}

/// The thin-lens equation: a point at depth d is spread, in the plane in focus at f, over the aperture's shape times |1 − f/d|; in a
/// window of parallel rays over its shape times |1 − d/f|.
#[test]
#[ignore = "slow"]
fn a_small_light_is_as_large_as_the_thin_lens_equation_says() {
    let tangent = 20.0_f64.to_radians().tan();
    let projections = [
        // Pixels per unit of length in the plane in focus; and scale of the lens and of the light in it.
        (None, 32.0 / (FOCUS * tangent), 1.0 - FOCUS / DEPTH, FOCUS / DEPTH),
        (Some(Projection::Orthographic { height: 4.0 }), 16.0, 1.0 - DEPTH / FOCUS, 1.0),
    ];
    let shapes = [
        (ApertureShape::Disk, 0.25),
        (ApertureShape::Square, 1.0 / 3.0),
        // E[x²] of a regular polygon: (2 + cos(2π/n)) / 12.
        (ApertureShape::Polygon { blades: 5, rotation_degrees: 20.0 }, (2.0 + (std::f64::consts::TAU / 5.0).cos()) / 12.0),
    ];
    let everywhere = in_full("every lens with either projection, of a thousand samples");
    for (index, (projection, pixels_per_unit, lens_scale, light_scale)) in projections.into_iter().enumerate() {
        // In the short form parallel rays go through one shape, which is neither round nor square.
        for (shape, moment) in shapes.into_iter().skip(if everywhere { 0 } else { 2 * index }) {
            let mut scene = load(SMALL_LIGHT);
            scene.render.spp = if everywhere { 1024 } else { 512 };
            scene.camera.projection = projection.unwrap_or(scene.camera.projection);
            scene.camera.focus_distance = FOCUS;
            // Both projections have one size of blur.
            let radius = if projection.is_some() { LENS_RADIUS / 2.0 } else { LENS_RADIUS };
            scene.camera.aperture = Some(Aperture { shape, radius });
            let blur = radius * lens_scale.abs() * pixels_per_unit;
            let light = LIGHT_RADIUS * light_scale * pixels_per_unit;
            // Pixels add the variance of a box of width 1.
            let expected = blur * blur * moment + light * light / 4.0 + 1.0 / 12.0;
            for (device, pixels) in on_every_device(&scene) {
                let (found, largest) = spread(&pixels);
                let what =
                    format!("{device}, {shape:?}, {projection:?}: {found:?}, expected {expected}, reach {largest}, {blur}");
                println!("{what}");
                assert!(found.iter().all(|found| (found / expected - 1.0).abs() < 0.04), "{what}");
                let corner = if shape == ApertureShape::Square { 2.0_f64.sqrt() } else { 1.0 };
                assert!(largest < corner * blur + light + 0.8 && largest > 0.85 * blur, "{what}");
            }
            // A lens 10 % wider is told apart by the same test.
            scene.camera.aperture = Some(Aperture { shape, radius: 1.1 * radius });
            let (found, _) = spread(&render_on_cpu(&scene));
            assert!(
                found.iter().all(|found| (found / expected - 1.0).abs() > 0.04),
                "{shape:?}: {found:?} passes for {expected}"
            );
        }
    }
}

/// At later surfaces as well: light that comes by way of another surface keeps its mean.
#[test]
#[ignore = "slow"]
fn several_light_samples_at_later_surfaces_have_the_same_mean() {
    use gpt::compare::{Moments, hypothesis};
    let mut scene = load::load(Some("cornell")).expect("it is built in");
    (scene.film.size, scene.render.spp, scene.render.max_depth) = ([48, 48], 64, 4);
    let means = |count: u32, depth| -> Vec<Vec<f64>> {
        let mut scene = scene.clone();
        (scene.render.light_samples, scene.render.light_samples_depth) = (count.into(), depth);
        let mut of_devices = vec![Vec::new(); 2];
        for seed in 0..8 {
            scene.render.seed = 100 * (count + 10 * depth) + seed;
            for (means, (_, pixels)) in of_devices.iter_mut().zip(on_every_device(&scene)) {
                means.push(pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / pixels.len() as f64);
            }
        }
        of_devices
    };
    for (one, several) in means(1, 1).into_iter().zip(means(4, 2)).filter(|(one, _)| !one.is_empty()) {
        let [one, several, planted]: [Moments; 3] = [(&one, 1.0), (&several, 1.0), (&several, 1.01)]
            .map(|(means, factor)| means.iter().map(|mean| factor * mean).collect());
        let held = hypothesis::welch_t_test(&one, &several);
        assert!(held.p_value > 1e-4, "{one:?} and {several:?}: {held:?}");
        let control = hypothesis::welch_t_test(&one, &planted);
        assert!(control.p_value < 1e-4, "1 % goes unnoticed: {one:?}, {planted:?}, {control:?}");
    }
}

/// Several light samples leave the mean where it is, whatever estimator shares light out, and independent ones cut the variance by their number.
#[test]
fn several_light_samples_have_the_same_mean_and_less_noise() {
    use gpt::compare::{Moments, hypothesis};
    let exact = 0.5 * 10.0 * (1.5_f64 / 2.0).powi(2);
    let mut scene = load(FLOOR_AND_LIGHT);
    scene.render.sampler = SamplerKind::Independent;
    scene.render.spp = 64;
    scene.film.size = [32, 32];
    for estimator in [scene::Estimator::Mis, scene::Estimator::Nee] {
        scene.render.estimator = estimator;
        let variances = [1_u32, 4].map(|count| {
            scene.render.light_samples = count.into();
            let check = |(device, pixels): (&str, Vec<[f32; 3]>)| {
                let moments: Moments = pixels.iter().map(|pixel| f64::from(pixel[1])).collect();
                let held = hypothesis::one_sample_t_test(&moments, exact);
                assert!(held.p_value > 1e-4, "{device}, {estimator:?}, {count}: {moments:?} instead of {exact}: {held:?}");
                let control = hypothesis::one_sample_t_test(&moments, 1.01 * exact);
                assert!(control.p_value < 1e-4, "{device}, {estimator:?}, {count}: 1 % goes unnoticed: {control:?}");
                moments.variance()
            };
            on_every_device(&scene).into_iter().map(check).collect::<Vec<_>>()
        });
        for (one, four) in variances[0].iter().zip(&variances[1]) {
            // The ratio of two variances of 1,024 observations each is within a factor of 1.25 of the truth but for one in a thousand.
            let gain = one / four;
            println!("{estimator:?}: {gain:.2} times the variance with one light sample");
            assert!(estimator != scene::Estimator::Nee || (4.0 / 1.25..4.0 * 1.25).contains(&gain), "{gain}");
        }
    }
}
