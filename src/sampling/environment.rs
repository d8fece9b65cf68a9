//! The distribution by which directions to an environment map are drawn: its brightness.

use std::f64::consts::PI;

use super::hierarchical_warp::HierarchicalWarp;
use crate::scene::{ImageData, MapRows};
use crate::spectrum::Spectrum;

/// Most cells along u and v. Larger maps have several texels in a cell.
const MOST_CELLS: [u32; 2] = [1024, 512];

/// How directions to a lat-long map are chosen: by luminance and solid angle.
#[derive(Debug, Clone, PartialEq)]
pub struct MapDistribution {
    /// Over (u, v) of the map.
    pub warp: HierarchicalWarp,
    /// Over all directions.
    pub mean_luminance: f64,
}

impl MapDistribution {
    /// None where the map is black.
    pub fn new(image: &ImageData, rows: MapRows) -> Option<Self> {
        let weights = texel_weights(image, rows);
        let size = [image.width, image.height];
        let cells = [0, 1].map(|axis| size[axis].min(MOST_CELLS[axis]));
        // The solid angle of a texel is 2π/width · π/height · sinθ.
        let solid_angle = 2.0 * PI * PI / (f64::from(size[0]) * f64::from(size[1]));
        let mean_luminance = weights.iter().sum::<f64>() * solid_angle / (4.0 * PI);
        let warp = HierarchicalWarp::new(cells[0], cells[1], &gather(&weights, size, cells))?;
        Some(Self { warp, mean_luminance })
    }
}

/// Mean luminance of the bilinear map over each of as many even cells as it has texels, times the sine of its θ. The mean over a cell is
/// that of its texel and the neighbours, weighted: it is positive wherever the looked-up radiance is.
fn texel_weights(image: &ImageData, rows: MapRows) -> Vec<f64> {
    let (width, height) = (image.width as usize, image.height as usize);
    let luminance: Vec<f64> = image.texels.colors().map(|texel| Spectrum::from_f32(texel.to_array()).luminance()).collect();
    let across: Vec<f64> = luminance
        .chunks_exact(width)
        .flat_map(|row| (0..width).map(|x| mean_over_middle([row[(x + width - 1) % width], row[x], row[(x + 1) % width]])))
        .collect();
    let at = |x: usize, y: usize| across[y * width + x];
    let row = |y: usize| {
        let sine = (PI * (y as f64 + 0.5) / height as f64).sin();
        let (above, below) = (y.saturating_sub(1), (y + 1).min(height - 1));
        (0..width).map(move |x| (x, sine, above, below))
    };
    let mean = |y: usize, values: [f64; 3]| match rows {
        MapRows::Inside => mean_over_middle(values),
        MapRows::ToPoles => mean_over_cell(y, height, values),
    };
    (0..height)
        .flat_map(|y| row(y).map(move |item| (y, item)))
        .map(|(y, (x, sine, above, below))| sine * mean(y, [at(x, above), at(x, y), at(x, below)]))
        .collect()
}

/// The mean of a linear interpolation of three values over the cell of the middle one, which reaches half-way to its neighbours.
fn mean_over_middle([before, here, after]: [f64; 3]) -> f64 {
    (before + 6.0 * here + after) / 8.0
}

/// The mean over the y-th of as many even cells as there are rows, of which the first and the last lie on the
/// poles.
fn mean_over_cell(y: usize, height: usize, [before, here, after]: [f64; 3]) -> f64 {
    if height == 1 {
        return here; // the same from pole to pole
    }
    // How far the cell reaches above and below its row, in rows.
    let (above, below) = (y as f64 / height as f64, 1.0 - (y + 1) as f64 / height as f64);
    let shares = [above, below].map(|reach| 0.5 * reach * reach / (above + below));
    shares[0] * before + (1.0 - shares[0] - shares[1]) * here + shares[1] * after
}

/// Sums of the texels' weights over cells, each texel's shared out by overlap.
fn gather(weights: &[f64], size: [u32; 2], cells: [u32; 2]) -> Vec<f64> {
    if size == cells {
        return weights.to_vec();
    }
    let mut sums = vec![0.0; cells[0] as usize * cells[1] as usize];
    for (index, weight) in weights.iter().enumerate() {
        let (x, y) = (index as u32 % size[0], index as u32 / size[0]);
        for (row, part_y) in overlaps(y, size[1], cells[1]) {
            for (column, part_x) in overlaps(x, size[0], cells[0]) {
                sums[row * cells[0] as usize + column] += weight * part_x * part_y;
            }
        }
    }
    sums
}

/// The cells that texel `index` of `size` lies in, and the share of it in each.
fn overlaps(index: u32, size: u32, cells: u32) -> impl Iterator<Item = (usize, f64)> {
    // In units of 1 / (size · cells), so that borders are integers.
    let (low, high) = (u64::from(index) * u64::from(cells), u64::from(index + 1) * u64::from(cells));
    let size = u64::from(size);
    (low / size..high.div_ceil(size)).map(move |cell| {
        let common = high.min((cell + 1) * size) - low.max(cell * size);
        (cell as usize, common as f64 / (high - low) as f64)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn map(width: u32, height: u32, texel: impl Fn(u32, u32) -> f32) -> ImageData {
        let texels: Vec<_> =
            (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| Vec3::splat(texel(x, y))).collect();
        ImageData { width, height, texels: texels.into(), has_alpha: false }
    }

    #[test]
    fn the_mean_of_a_constant_is_the_constant() {
        for (width, height, rows) in [
            (1, 1, MapRows::Inside),
            (2, 1, MapRows::ToPoles),
            (64, 32, MapRows::Inside),
            (64, 32, MapRows::ToPoles),
            (2000, 1030, MapRows::Inside),
        ] {
            let distribution = MapDistribution::new(&map(width, height, |_, _| 3.0), rows).expect("it is not black");
            // One row's midpoint is a coarse quadrature of the sine.
            let allowed = 0.6 / f64::from(height * height);
            assert!((distribution.mean_luminance / 3.0 - 1.0).abs() < allowed, "{width} x {height}");
        }
        assert_eq!(MapDistribution::new(&map(4, 2, |_, _| 0.0), MapRows::Inside), None);
    }

    #[test]
    fn cells_share_texels_out_without_loss() {
        for (size, cells) in [(7, 3), (3, 3), (1030, 512)] {
            let mut total = 0.0;
            for index in 0..size {
                let parts: Vec<(usize, f64)> = overlaps(index, size, cells).collect();
                assert!(parts.iter().all(|(cell, part)| *cell < cells as usize && *part > 0.0));
                total += parts.iter().map(|(_, part)| part).sum::<f64>();
            }
            assert!((total - f64::from(size)).abs() < 1e-9);
        }
    }

    #[test]
    fn a_single_bright_texel_can_be_found_wherever_interpolation_spreads_it() {
        let distribution = MapDistribution::new(&map(8, 8, |x, y| if (x, y) == (0, 3) { 1.0 } else { 0.0 }), MapRows::Inside);
        let warp = distribution.expect("it is not black").warp;
        for (x, y) in (0..8).flat_map(|y| (0..8).map(move |x| (x, y))) {
            let near = [7, 0, 1].contains(&x) && (2..5).contains(&y);
            assert_eq!(warp.density((f64::from(x) + 0.5) / 8.0, (f64::from(y) + 0.5) / 8.0) > 0.0, near, "{x} {y}");
        }
    }
}
