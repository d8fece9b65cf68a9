//! Pictures to be compared to the last bit.

use std::ops::Range;

use gpt::gpu::{Device, GpuRenderer};
use gpt::plan::{Plan, PlanOptions};
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

/// Means of all pixels as bits, and the plan.
pub fn pixel_bits(device: &Device, scene: &Scene, options: &PlanOptions, samples: Range<u32>) -> (Vec<[u32; 3]>, Plan) {
    let mut renderer = GpuRenderer::on(device, scene, options).expect("the scene fits");
    let request = RenderRequest { rows: 0..scene.film.size[1], samples };
    let mut pixels = Vec::new();
    let mut on_band = |band: gpt::film::Band| {
        pixels.extend(band.mean.iter().map(|pixel| pixel.map(f32::to_bits)));
        Ok(())
    };
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    (pixels, renderer.plan().clone())
}
