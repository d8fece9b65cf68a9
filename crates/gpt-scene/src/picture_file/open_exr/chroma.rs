//! Colours out of luminance and chroma, and numbers between those of channels with reduced resolution.

use exr::meta::attribute::ChannelDescription;
use exr::meta::header::Header;
use glam::DVec3;

use crate::picture_file::primaries::Primaries;

/// Weights of the nearest numbers on either side, then of those beyond, half-way between two: the filter of OpenEXR's own reader (RgbaInputFile).
const HALF_WAY: [f64; 7] = [0.627_123, -0.186_077, 0.087_929, -0.043_159, 0.019_597, -0.007_540, 0.002_128];

/// The numbers of a channel, fewer than there are pixels along either axis.
#[derive(Debug, Clone, Default)]
pub struct Plane {
    width: usize,
    values: Vec<f32>,
    step: [usize; 2],
}

impl Plane {
    pub fn new(header: &Header, channel: &ChannelDescription) -> Self {
        let step = [channel.sampling.x().max(1), channel.sampling.y().max(1)];
        let width = header.layer_size.width() / step[0];
        Self { width, values: vec![0.0; width * (header.layer_size.height() / step[1])], step }
    }

    /// Takes numbers side by side.
    pub fn put(&mut self, [column, row]: [usize; 2], numbers: &[f32]) {
        let start = row * self.width + column;
        if let Some(place) = self.values.get_mut(start..start + numbers.len()) {
            place.copy_from_slice(numbers);
        }
    }

    /// The numbers of a row of pixels, between those that there are along both axes.
    pub fn row(&self, row: usize, width: usize) -> Vec<f32> {
        if self.step == [1, 1] {
            return self.values[row * self.width..][..width].to_vec();
        }
        let rows = self.values.len() / self.width.max(1);
        let between: Vec<f32> = (0..self.width)
            .map(|column| interpolate(row, self.step[1], rows, |row| self.values[row * self.width + column]))
            .collect();
        (0..width).map(|column| interpolate(column, self.step[0], self.width, |column| between[column])).collect()
    }
}

/// The number at a pixel, of which every `step`-th has one.
fn interpolate(pixel: usize, step: usize, count: usize, number: impl Fn(usize) -> f32) -> f32 {
    let last = count.saturating_sub(1);
    let (before, rest) = (pixel / step, pixel % step);
    if rest == 0 || last == 0 {
        return number(before.min(last));
    }
    let at = |place: isize| f64::from(number((before as isize + place).clamp(0, last as isize) as usize));
    if step == 2 {
        let pairs = HALF_WAY.iter().enumerate();
        return pairs.map(|(away, weight)| weight * (at(-(away as isize)) + at(1 + away as isize))).sum::<f64>() as f32;
    }
    let share = rest as f64 / step as f64;
    (at(0) * (1.0 - share) + at(1) * share) as f32
}

/// How much red, green and blue add to the luminance of the picture's own primaries.
pub fn luminance_weights(primaries: &Primaries) -> DVec3 {
    let matrix = primaries.to_xyz().or_else(|| Primaries::REC_709.to_xyz());
    let weights = matrix.map_or(DVec3::ONE, |matrix| matrix.row(1));
    weights / weights.element_sum()
}

/// Red, green and blue of a luminance Y and of (R − Y) / Y and (B − Y) / Y.
pub fn colour([luminance, red, blue]: [f32; 3], weights: DVec3) -> [f32; 3] {
    if red == 0.0 && blue == 0.0 {
        return [luminance; 3];
    }
    let [y, red, blue] = [luminance, red, blue].map(f64::from);
    let (red, blue) = ((red + 1.0) * y, (blue + 1.0) * y);
    let green = (y - red * weights.x - blue * weights.z) / weights.y;
    [red as f32, green as f32, blue as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn colours_come_back_from_luminance_and_chroma() {
        let weights = luminance_weights(&Primaries::REC_709);
        assert!((weights - DVec3::new(0.2126, 0.7152, 0.0722)).abs().max_element() < 1e-4, "{weights}");
        for colour_in in [[0.5_f32, 0.25, 0.125], [2.0, 0.1, 7.0], [0.3; 3]] {
            let y =
                colour_in.iter().zip(weights.to_array()).map(|(value, weight)| f64::from(*value) * weight).sum::<f64>() as f32;
            let found = colour([y, (colour_in[0] - y) / y, (colour_in[2] - y) / y], weights);
            assert!(found.iter().zip(colour_in).all(|(found, value)| (found - value).abs() < 1e-5), "{found:?}");
        }
        assert_eq!(colour([0.0, 3.0, 1.0], weights), [0.0; 3]);
    }

    #[test]
    fn numbers_between_follow_what_is_smooth() {
        let wave = |x: f64| (0.3 * x).sin() as f32;
        for (step, error) in [(1, 1e-6), (2, 2e-3), (3, 0.11)] {
            let values: Vec<f32> = (0..40).map(|place| wave(f64::from(place * step))).collect();
            for pixel in 14..26_u32 * step {
                if pixel + 14 * step >= 40 * step {
                    continue;
                }
                let found = interpolate(pixel as usize, step as usize, values.len(), |place| values[place]);
                assert!((found - wave(f64::from(pixel))).abs() < error, "{step} {pixel}");
            }
        }
        // At the ends, and of one number, the last one goes on.
        assert_eq!(interpolate(3, 2, 1, |_| 5.0), 5.0);
        assert!((interpolate(5, 2, 3, |_| 5.0) - 5.0).abs() < 1e-4);
    }
}
