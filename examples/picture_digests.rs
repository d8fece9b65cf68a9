//! Prints a digest of small pictures of scenes, so that a change which should leave every picture as it is can be seen to do so:
//! `cargo run --release --example picture_digests [SCENE…] > before`, change, the same into another file, `diff`.
//!
//! One line for each scene and each way to render: both kernels of the GPU and the CPU. Without arguments all built-in scenes.

use std::fmt::Write as _;

use gpt::cpu::ReferenceRenderer;
use gpt::gpu::{Device, GpuRenderer};
use gpt::plan::{PlanOptions, StageMode};
use gpt::renderer::{DeviceChoice, RenderRequest, Renderer, Silent};
use gpt::scene::Scene;
use sha2::{Digest as _, Sha256};

const WIDTH: u32 = 40;
const SAMPLES: u32 = 3;

fn main() {
    let named: Vec<String> = std::env::args().skip(1).collect();
    let names = if named.is_empty() { gpt::load::builtin_names().map(str::to_owned).collect() } else { named };
    let device = Device::open(&DeviceChoice::Gpu).expect("a graphics adapter");
    for name in names {
        let mut scene = match gpt::load::load(Some(&name)) {
            Ok(scene) => scene,
            Err(error) => {
                println!("{name}: {error}");
                continue;
            }
        };
        let [width, height] = scene.film.size;
        scene.film.size = [WIDTH, (WIDTH * height).div_ceil(width).max(1)];
        scene.render.spp = SAMPLES;
        for (way, stages) in [("fused", StageMode::Fused), ("wavefront", StageMode::Wavefront)] {
            let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
            let line = GpuRenderer::on(&device, &scene, &options).map(|renderer| digest(renderer, &scene));
            println!("{name} {way} {}", line.unwrap_or_else(|error| error.to_string()));
        }
        let line = ReferenceRenderer::new(&scene).map(|renderer| digest(renderer, &scene));
        println!("{name} cpu {}", line.unwrap_or_else(|error| error.to_string()));
    }
}

/// The mean over all channels and a digest of all bits of the picture.
fn digest(mut renderer: impl Renderer, scene: &Scene) -> String {
    let mut hash = Sha256::new();
    let (mut sum, mut count) = (0.0, 0.0);
    let request = RenderRequest { rows: 0..scene.film.size[1], samples: 0..SAMPLES };
    let mut on_band = |band: gpt::film::Band| {
        for channel in band.mean.iter().flatten() {
            hash.update(channel.to_bits().to_le_bytes());
            sum += f64::from(*channel);
            count += 1.0;
        }
        Ok(())
    };
    match renderer.render(&request, &Silent, &mut on_band) {
        Ok(_) => {
            let mut line = format!("{:.6} ", sum / count);
            for byte in &hash.finalize()[..12] {
                let _ = write!(line, "{byte:02x}");
            }
            line
        }
        Err(error) => error.to_string(),
    }
}
