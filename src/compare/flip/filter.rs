//! The filters of ꟻLIP: what the eye resolves, and where it sees edges and points.

use std::f64::consts::PI;

/// a₁, b₁, a₂, b₂ of the contrast sensitivity of each opponent channel, as sums of Gaussians (table 1 of the paper).
const SENSITIVITIES: [[f64; 4]; 3] = [[1.0, 0.0047, 0.0, 1e-5], [1.0, 0.0053, 0.0, 1e-5], [34.1, 0.04, 13.5, 0.025]];
/// The widest of them decides how far all filters reach: three standard deviations.
const WIDEST: f64 = 0.04;
/// Width of the features that are looked for, in degrees.
const FEATURE_WIDTH: f64 = 0.082;

/// A one-dimensional kernel, its middle in the middle.
type Kernel = Vec<f64>;

/// A kernel over −radius to radius.
fn kernel(radius: i32, value: impl Fn(f64) -> f64) -> Kernel {
    (-radius..=radius).map(|x| value(f64::from(x))).collect()
}

/// Convolves a plane with `across` along rows and `down` along columns; pixels beyond the border are those at it.
fn separable(plane: &[f64], width: usize, across: &Kernel, down: &Kernel) -> Vec<f64> {
    let height = plane.len() / width.max(1);
    let pass = |length: usize, kernel: &Kernel, value: &dyn Fn(usize) -> f64, index: usize| -> f64 {
        let radius = kernel.len() / 2;
        let at = |tap: usize| value((index + tap).saturating_sub(radius).min(length - 1));
        kernel.iter().enumerate().map(|(tap, weight)| weight * at(tap)).sum()
    };
    let rows: Vec<f64> =
        (0..plane.len()).map(|pixel| pass(width, across, &|x| plane[pixel / width * width + x], pixel % width)).collect();
    (0..plane.len()).map(|pixel| pass(height, down, &|y| rows[y * width + pixel % width], pixel / width)).collect()
}

/// The contrast sensitivity of each opponent channel: a sum of Gaussians, each with its share.
pub(super) struct Sensitivity {
    channels: [Vec<(f64, Kernel)>; 3],
}

impl Sensitivity {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
        let channels = SENSITIVITIES.map(|[a1, b1, a2, b2]| {
            let gaussian = |b: f64| kernel(radius, |x| (-PI * PI * (x / pixels_per_degree).powi(2) / b).exp());
            let parts = [(a1, b1), (a2, b2)].map(|(a, b)| (a * (PI / b).sqrt(), gaussian(b)));
            let total: f64 = parts.iter().map(|(share, kernel)| share * kernel.iter().sum::<f64>().powi(2)).sum();
            parts.into_iter().filter(|(share, _)| *share > 0.0).map(|(share, kernel)| (share / total, kernel)).collect()
        });
        Self { channels }
    }

    pub(super) fn filter(&self, pixels: &[[f64; 3]], width: usize) -> Vec<[f64; 3]> {
        let mut filtered = vec![[0.0; 3]; pixels.len()];
        for (channel, parts) in self.channels.iter().enumerate() {
            let plane: Vec<f64> = pixels.iter().map(|pixel| pixel[channel]).collect();
            for (share, kernel) in parts {
                for (sum, value) in filtered.iter_mut().zip(separable(&plane, width, kernel, kernel)) {
                    sum[channel] += share * value;
                }
            }
        }
        filtered
    }
}

/// First and second derivatives of a Gaussian, which answer to edges and to points.
pub(super) struct Detectors {
    smooth: Kernel,
    edge: Kernel,
    point: Kernel,
}

impl Detectors {
    pub(super) fn new(pixels_per_degree: f64) -> Self {
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let gaussian = |x: f64| (-x * x / (2.0 * deviation * deviation)).exp();
        let smooth = kernel(radius, gaussian);
        let sum: f64 = smooth.iter().sum();
        Self {
            smooth: smooth.into_iter().map(|weight| weight / sum).collect(),
            edge: balanced(kernel(radius, |x| -x * gaussian(x))),
            point: balanced(kernel(radius, |x| (x * x / (deviation * deviation) - 1.0) * gaussian(x))),
        }
    }

    /// How strong an edge and how strong a point each pixel of a plane is.
    pub(super) fn respond(&self, plane: &[f64], width: usize) -> Vec<[f64; 2]> {
        let strength = |kernel: &Kernel| -> Vec<f64> {
            let across = separable(plane, width, kernel, &self.smooth);
            let down = separable(plane, width, &self.smooth, kernel);
            across.into_iter().zip(down).map(|(x, y)| x.hypot(y)).collect()
        };
        strength(&self.edge).into_iter().zip(strength(&self.point)).map(|(edge, point)| [edge, point]).collect()
    }
}

/// Positive weights that add up to 1, and negative ones that add up to −1.
fn balanced(kernel: Kernel) -> Kernel {
    let positive: f64 = kernel.iter().filter(|weight| **weight > 0.0).sum();
    let negative: f64 = -kernel.iter().filter(|weight| **weight < 0.0).sum::<f64>();
    kernel.into_iter().map(|weight| if weight > 0.0 { weight / positive } else { weight / negative }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn flat_planes_stay_flat_and_have_no_features() {
        let plane = vec![[3.0, -2.0, 0.5]; 7 * 5];
        for pixel in Sensitivity::new(67.0).filter(&plane, 7) {
            assert!(pixel.iter().zip([3.0, -2.0, 0.5]).all(|(a, b)| (a - b).abs() < 1e-12), "{pixel:?}");
        }
        assert!(Detectors::new(67.0).respond(&[0.5; 35], 7).iter().flatten().all(|value| value.abs() < 1e-12));
    }

    #[test]
    fn a_step_is_an_edge() {
        let plane: Vec<f64> = (0..40 * 30).map(|pixel| if pixel % 40 < 20 { 0.0 } else { 1.0 }).collect();
        let found = Detectors::new(67.0).respond(&plane, 40);
        assert!(found[15 * 40 + 20][0] > 0.9 && found[15 * 40 + 2][0] < 0.01, "{:?}", found[15 * 40 + 20]);
    }
}
