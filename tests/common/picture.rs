//! Pictures as tests look at them.

use gpt::renderer::{RenderReport, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

/// The mean radiance of each pixel, row by row, with the scene's number of samples.
pub fn render(renderer: &mut dyn Renderer, scene: &Scene) -> Vec<[f32; 3]> {
    render_and_count(renderer, scene).0
}

/// The picture, and the counts of the render.
pub fn render_and_count(renderer: &mut dyn Renderer, scene: &Scene) -> (Vec<[f32; 3]>, RenderReport) {
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..scene.render.spp };
    let mut on_band = |band: gpt::Band| {
        pixels.extend(band.mean);
        Ok(())
    };
    let report = renderer.render(&request, &Silent, &mut on_band).expect("it renders");
    (pixels, report)
}
