//! The sums over each pixel's samples that intervals are made from.

use rayon::prelude::*;

/// The first samples of each pixel, which set the scale of its later ones and take no other part in the intervals.
pub const WARM_UP: u32 = 4;
/// A sample is brighter than its bound only beyond what single precision rounds.
const ROUNDING: f64 = 1e-4;

/// A pixel's sums, channel by channel.
#[derive(Debug, Clone, Copy, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct PixelSums {
    /// Sum of the first samples.
    pub warm_up: [f64; 3],
    /// Sum of the later ones.
    pub sum: [f64; 3],
    /// Squared deviations of the later ones from what those before them predicted.
    pub squares: [f64; 3],
}

/// The sums of all pixels, after some samples of each.
#[derive(Debug, Clone)]
pub struct IntervalSums {
    width: u32,
    pixels: Vec<PixelSums>,
    /// Samples of each pixel.
    samples: u32,
    /// The mean of the first samples of all pixels.
    warm_mean: [f64; 3],
    /// The brightest sample so far, by channel.
    brightest: [f64; 3],
}

/// Numbers beside the pixels' sums, in the order in which a state of a render keeps them.
pub type Shared = [f64; 6];

impl IntervalSums {
    /// No sample yet.
    pub fn new([width, height]: [u32; 2]) -> Self {
        let pixels = vec![PixelSums::default(); width as usize * height as usize];
        Self { width, pixels, samples: 0, warm_mean: [0.0; 3], brightest: [0.0; 3] }
    }

    /// Goes on from the sums of an earlier render; None where they are of another size.
    pub fn resumed([width, height]: [u32; 2], pixels: Vec<PixelSums>, samples: u32, shared: Shared) -> Option<Self> {
        let part = |first: usize| [shared[first], shared[first + 1], shared[first + 2]];
        let [warm_mean, brightest] = [part(0), part(3)];
        let fits = pixels.len() as u64 == u64::from(width) * u64::from(height);
        fits.then_some(Self { width, pixels, samples, warm_mean, brightest })
    }

    /// The numbers beside the pixels' sums.
    pub fn shared(&self) -> Shared {
        let of = [self.warm_mean, self.brightest];
        std::array::from_fn(|place| of[place / 3][place % 3])
    }

    /// Adds one sample of each pixel.
    pub fn add(&mut self, samples: &[[f32; 3]]) {
        let before = self.samples;
        let (is_warm_up, warm_mean) = (before < WARM_UP, self.warm_mean);
        let brightest = self.pixels.par_iter_mut().zip(samples).with_min_len(1024).map(|(pixel, sample)| {
            let sample = sample.map(f64::from);
            for (channel, value) in sample.into_iter().enumerate() {
                if is_warm_up {
                    pixel.warm_up[channel] += value;
                } else {
                    let prediction = pixel.prediction(channel, before, warm_mean);
                    pixel.sum[channel] += value;
                    pixel.squares[channel] += (value - prediction).powi(2);
                }
            }
            sample
        });
        let found = brightest.reduce(|| [0.0; 3], |a, b| std::array::from_fn(|channel| f64::max(a[channel], b[channel])));
        self.brightest = std::array::from_fn(|channel| self.brightest[channel].max(found[channel]));
        self.samples += 1;
        if self.samples == WARM_UP {
            self.end_warm_up();
        }
    }

    fn end_warm_up(&mut self) {
        let count = f64::from(WARM_UP) * self.pixels.len() as f64;
        self.warm_mean =
            std::array::from_fn(|channel| self.pixels.iter().map(|pixel| pixel.warm_up[channel]).sum::<f64>() / count);
    }

    /// Samples of each pixel.
    pub fn samples(&self) -> u32 {
        self.samples
    }

    /// Samples of each pixel that intervals are made from.
    pub fn counted(&self) -> u32 {
        self.samples.saturating_sub(WARM_UP)
    }

    pub fn pixels(&self) -> &[PixelSums] {
        &self.pixels
    }

    pub fn width(&self) -> u32 {
        self.width
    }

    pub fn height(&self) -> u32 {
        (self.pixels.len() / self.width.max(1) as usize) as u32
    }

    /// The brightest sample of any pixel, by channel.
    pub fn brightest(&self) -> [f64; 3] {
        self.brightest
    }

    /// The mean of a pixel's samples.
    pub fn mean(&self, pixel: usize) -> [f64; 3] {
        let PixelSums { warm_up, sum, .. } = self.pixels[pixel];
        let samples = f64::from(self.samples.max(1));
        std::array::from_fn(|channel| (warm_up[channel] + sum[channel]) / samples)
    }

    /// The largest prediction of a pixel's samples.
    pub fn scale(&self, pixel: &PixelSums) -> [f64; 3] {
        std::array::from_fn(|channel| pixel.scale(channel, self.warm_mean))
    }

    /// The first channel with a sample that is brighter than these bounds, and how bright it is.
    pub fn brighter_than(&self, bound: [f64; 3]) -> Option<(usize, f64)> {
        let exceeds =
            |channel: &usize| self.brightest[*channel] > bound[*channel] * (1.0 + ROUNDING) + f64::from(f32::MIN_POSITIVE);
        (0..3).find(exceeds).map(|channel| (channel, self.brightest[channel]))
    }
}

impl PixelSums {
    /// The mean of all samples before, no more than the scale.
    fn prediction(&self, channel: usize, samples: u32, warm_mean: [f64; 3]) -> f64 {
        let mean = (self.warm_up[channel] + self.sum[channel]) / f64::from(samples);
        mean.min(self.scale(channel, warm_mean))
    }

    /// Twice the mean of the pixel's first samples, and that of all pixels' beside it, lest a pixel that began dark have no scale. Any number that the
    /// later samples have no part in is right; where no sample was bright, 1 is as good as another.
    fn scale(&self, channel: usize, warm_mean: [f64; 3]) -> f64 {
        let scale = 2.0 * self.warm_up[channel] / f64::from(WARM_UP) + warm_mean[channel];
        if scale > 0.0 { scale } else { 1.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_first_samples_set_the_scale_and_the_later_ones_are_counted() {
        let mut sums = IntervalSums::new([2, 1]);
        for sample in [1.0, 3.0, 1.0, 3.0] {
            sums.add(&[[sample, 0.0, 0.5], [0.0; 3]]);
        }
        assert_eq!((sums.counted(), sums.warm_mean), (0, [1.0, 0.0, 0.25]));
        assert_eq!(sums.scale(&sums.pixels[0]), [5.0, 1.0, 1.25]);
        sums.add(&[[12.0, 0.0, 0.5], [1.0, 0.0, 0.0]]);
        sums.add(&[[2.0, 0.0, 0.5], [0.0; 3]]);
        let first = sums.pixels[0];
        // The mean of the first four is 2, and of five 4.
        assert_eq!((first.sum[0], first.squares[0]), (14.0, 104.0));
        assert_eq!((sums.mean(0)[0], sums.mean(1)[0], sums.counted()), (22.0 / 6.0, 1.0 / 6.0, 2));
        assert_eq!(sums.brighter_than([12.0, 1.0, 1.0]), None);
        assert_eq!(sums.brighter_than([11.0, 1.0, 1.0]), Some((0, 12.0)));
        let again = IntervalSums::resumed([2, 1], sums.pixels.clone(), sums.samples, sums.shared()).expect("its size");
        assert_eq!((again.warm_mean, again.brightest), (sums.warm_mean, sums.brightest));
    }
}
