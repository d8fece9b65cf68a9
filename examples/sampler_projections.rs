//! Draws the first points of every sampler, two named dimensions at a time: `cargo run --release --example sampler_projections [FILE]`
//! (default docs/samplers.png).
//!
//! One row a sampler, in the order of `SamplerKind`; the columns are the pixel, the lens, pixel x
//! against lens u, the first light's point, the first direction, the light's u against the direction's u, the fourth light's point,
//! and the choices of light and lobe. 256 points of one pixel.

use gpt::sampling::{CameraDimension, Dimension, PathSampler, Sampling, SequencePoint, VertexDimension};
use gpt::scene::{PixelSampler, SamplerKind};
use image::{GrayImage, Luma};

const POINTS: u32 = 256;
const SIDE: u32 = 160;
const GAP: u32 = 8;

fn pairs() -> [[Dimension; 2]; 8] {
    use CameraDimension::{LensU, LensV, PixelX, PixelY};
    use VertexDimension::{BsdfU, BsdfV, LightChoice, LightU, LightV, Lobe};
    let (camera, vertex) = (Dimension::camera, Dimension::vertex);
    [
        [camera(PixelX), camera(PixelY)],
        [camera(LensU), camera(LensV)],
        [camera(PixelX), camera(LensU)],
        [vertex(0, LightU), vertex(0, LightV)],
        [vertex(0, BsdfU), vertex(0, BsdfV)],
        [vertex(0, LightU), vertex(0, BsdfU)],
        [vertex(3, LightU), vertex(3, LightV)],
        [vertex(0, LightChoice), vertex(0, Lobe)],
    ]
}

fn main() -> Result<(), image::ImageError> {
    let path = std::env::args().nth(1).unwrap_or_else(|| concat!(env!("CARGO_MANIFEST_DIR"), "/docs/samplers.png").to_owned());
    let (columns, rows) = (pairs().len() as u32, SamplerKind::ALL.len() as u32);
    let mut picture = GrayImage::from_pixel(columns * (SIDE + GAP) - GAP, rows * (SIDE + GAP) - GAP, Luma([120]));
    for (row, kind) in (0..).zip(SamplerKind::ALL) {
        let (path, pixel) = (kind, PixelSampler::SameAsPath);
        let sampling = Sampling { path, pixel, seed: 0, samples: POINTS, light_samples: 1, light_samples_depth: 1 };
        for (column, pair) in (0..).zip(pairs()) {
            draw(&mut picture, [column * (SIDE + GAP), row * (SIDE + GAP)], &sampling, pair);
        }
    }
    picture.save(&path)?;
    println!("{path}");
    Ok(())
}

/// A white square with its upper left corner at `corner` and a dot for each point.
fn draw(picture: &mut GrayImage, corner: [u32; 2], sampling: &Sampling, pair: [Dimension; 2]) {
    for y in 0..SIDE {
        for x in 0..SIDE {
            picture.put_pixel(corner[0] + x, corner[1] + y, Luma([255]));
        }
    }
    for sample in 0..POINTS {
        let point = SequencePoint::new(sampling, sample);
        let sampler = PathSampler::new(sampling, 12_345, &point);
        // Dots of 2 × 2 pixels that stay inside.
        let [x, y] = pair.map(|dimension| (sampler.uniform(dimension) * f64::from(SIDE - 1)) as u32);
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            picture.put_pixel(corner[0] + x + dx, corner[1] + y + dy, Luma([0]));
        }
    }
}
