//! Samples that are darkened to a brightest radiance, on both devices, and what is said of it.

use crate::common::device::DEVICE;
use crate::common::picture::render_and_count;
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::renderer::RenderReport;
use gpt::scene::Scene;
use gpt::spectrum::Spectrum;

fn scene(clamp: f64) -> Scene {
    let mut scene = load::load(Some("veach-mis")).expect("it is built in");
    scene.film.size = [48, 36];
    scene.render.spp = 8;
    scene.render.clamp = clamp;
    scene
}

fn mean(pixels: &[[f32; 3]]) -> [f64; 3] {
    [0, 1, 2].map(|channel| pixels.iter().map(|pixel| f64::from(pixel[channel])).sum::<f64>() / pixels.len() as f64)
}

/// The clamped picture and the light that was taken are the whole, no pixel is brighter than allowed, and
/// both devices give the same numbers.
#[test]
fn what_clamping_takes_is_counted() {
    let limit = 3.0;
    let (scene, free) = (scene(limit), scene(0.0));
    let (whole, untouched) = render_and_count(&mut ReferenceRenderer::new(&free).expect("it renders"), &free);
    assert_eq!((untouched.clamped_samples, untouched.clamped_units), (0, 0));
    let whole = Spectrum::from_rgb(mean(&whole)).luminance();
    let (reference, expected) = render_and_count(&mut ReferenceRenderer::new(&scene).expect("it renders"), &scene);
    let check = |what: &str, pixels: &[[f32; 3]], report: &RenderReport| {
        assert!(pixels.as_flattened().iter().all(|channel| f64::from(*channel) <= limit * (1.0 + 1e-6)), "{what}");
        let left = Spectrum::from_rgb(mean(pixels)).luminance();
        let share = report.clamped_light(limit, mean(pixels));
        assert!(report.clamped_samples > 50 && share > 0.1, "{what}: {} samples, {share}", report.clamped_samples);
        assert!((left / (1.0 - share) / whole - 1.0).abs() < 1e-3, "{what}: {left} left, {share} taken of {whole}");
        assert!(report.clamped_samples.abs_diff(expected.clamped_samples) <= 2, "{what}");
    };
    check("reference", &reference, &expected);
    let Some(device) = DEVICE.as_ref() else { return };
    for stages in [StageMode::Fused, StageMode::Wavefront] {
        let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
        let mut renderer = GpuRenderer::on(device, &scene, &options).expect("the scene fits");
        let (pixels, report) = render_and_count(&mut renderer, &scene);
        check(&format!("{stages:?}"), &pixels, &report);
        let far = |other: &[[f32; 3]]| {
            let is_far = |(a, b): (&f32, &f32)| (a - b).abs() > 1e-3 * (b + 0.01);
            pixels.as_flattened().iter().zip(other.as_flattened()).filter(|pair| is_far(*pair)).count()
        };
        assert!(far(&reference) <= 12, "{stages:?}: {} of {} channels differ", far(&reference), 3 * pixels.len());
        // The control: a clamp that is a tenth higher is another picture.
        let other = self::scene(1.1 * limit);
        let (others, _) = render_and_count(&mut ReferenceRenderer::new(&other).expect("it renders"), &other);
        assert!(far(&others) > 100);
    }
}
