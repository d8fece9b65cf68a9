//! The noise that a picture of few samples has and does not show. Samples that hit a thin edge or a rare path are few: a tile in which none did is
//! black, and its variance as it was sampled is 0. The golden picture, of many samples, knows better.

use super::golden::Golden;
use crate::compare::Moments;
use crate::compare::image_tests::Layout;
use crate::output::Image;

/// Pixels on each side in which light that meets an edge within a pixel is looked for.
const REACH: u32 = 2;

/// Variances of a single sample, pixel by pixel, of which a picture of few samples need not show any: what the golden picture's samples varied by, or
/// what an edge makes. Points that fill space evenly meet an edge nearly as often as it is large, and hide that single samples are on one of its sides;
/// of values between the darkest and the brightest pixel nearby, l and h, whose mean is m, the variance is (h - m)(m - l) at most (Bhatia and Davis 2000).
pub fn noise_of_samples(golden: &Golden) -> Vec<[f32; 3]> {
    let Image { width, height, ref pixels } = golden.mean;
    let near = |place: u32, end: u32| place.saturating_sub(REACH)..(place + REACH + 1).min(end);
    let at = |x: u32, y: u32| y as usize * width as usize + x as usize;
    let of_edge = |x: u32, y: u32, channel: usize| {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for row in near(y, height) {
            for column in near(x, width) {
                let value = f64::from(pixels[at(column, row)][channel]);
                (low, high) = (low.min(value), high.max(value));
            }
        }
        let mean = f64::from(pixels[at(x, y)][channel]);
        (high - mean) * (mean - low)
    };
    let places = (0..height).flat_map(|y| (0..width).map(move |x| (x, y)));
    let pixel = |(x, y): (u32, u32)| {
        std::array::from_fn(|channel| golden.variances[at(x, y)][channel].max(of_edge(x, y, channel) as f32))
    };
    places.map(pixel).collect()
}

/// The share of these variances that the differences of a picture without a number of samples scatter by, which is one over that number for samples like
/// the golden picture's. A fault makes some tiles scatter more, so it is the median over tiles, each of which counts by the noise that it should have: dark ones
/// hardly count.
pub fn share_of_noise(golden: &Golden, of_samples: &[[f32; 3]], picture: &Image, tile: u32) -> f64 {
    let layout = Layout { width: golden.mean.width, height: golden.mean.height };
    let share_in = |region, channel: usize| {
        let difference = |pixel: usize| f64::from(picture.pixels[pixel][channel]) - f64::from(golden.mean.pixels[pixel][channel]);
        let scatter = layout.pixels(region).map(difference).collect::<Moments>().variance();
        let noise = layout.pixels(region).map(|pixel| f64::from(of_samples[pixel][channel])).collect::<Moments>().mean();
        (noise > 0.0 && scatter.is_finite()).then_some((scatter / noise, noise))
    };
    let regions = layout.tiles(tile).into_iter();
    let mut shares: Vec<(f64, f64)> = regions
        .flat_map(|region| (0..3).map(move |channel| (region, channel)))
        .filter_map(|(region, channel)| share_in(region, channel))
        .collect();
    shares.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let half = 0.5 * shares.iter().map(|(_, weight)| weight).sum::<f64>();
    let mut before = 0.0;
    let median = shares.iter().find(|(_, weight)| {
        before += weight;
        before >= half
    });
    median.map_or(0.0, |(share, _)| *share)
}

#[cfg(test)]
mod tests {
    use super::super::candidate::judge_candidate;
    use super::super::golden::{Candidate, Golden};
    use super::super::replications::Replications;
    use super::super::settings::TestSettings;
    use super::*;
    use crate::compare::{ImageView, Scatter, TileSettings, compare_measured, compare_paired};
    use crate::statistics::random::SplitMix64;

    const SIZE: [u32; 2] = [24, 16];
    const SAMPLES: u32 = 16;
    const PIXELS: usize = (SIZE[0] * SIZE[1]) as usize;

    /// The chance that a sample of a pixel finds light, which is 1 then: a bright middle, whose edge reaches a little into the tiles beside it, and rare
    /// paths everywhere else.
    fn chance(pixel: usize) -> f64 {
        match pixel % 24 {
            8..=15 => 0.9,
            7 | 16 => 0.002,
            _ => 0.0004,
        }
    }

    /// The chance without rare paths.
    fn chance_of_edge(pixel: usize) -> f64 {
        if chance(pixel) < 0.001 { 0.0 } else { chance(pixel) }
    }

    fn render(random: &mut SplitMix64, samples: u32, factor: f32) -> (Vec<[f32; 3]>, Vec<[f32; 3]>) {
        let pixel = |pixel: usize, random: &mut SplitMix64| {
            let hits = (0..samples).filter(|_| random.uniform() < chance(pixel)).count() as f32;
            let (share, count) = (hits / samples as f32, samples as f32);
            ([factor * share; 3], [factor * factor * share * (1.0 - share) / (count - 1.0); 3])
        };
        (0..PIXELS).map(|place| pixel(place, random)).unzip()
    }

    fn golden(random: &mut SplitMix64) -> Golden {
        let mut renders = Replications::new(SIZE[0], 0..SIZE[1], 512);
        (0..8).for_each(|_| renders.add(&render(random, 512, 1.0).0));
        Golden::of(&renders, 0.0, String::new())
    }

    fn candidate(random: &mut SplitMix64, samples: u32, factor: f32, is_stated: bool) -> Candidate {
        let (pixels, variances) = render(random, samples, factor);
        let mean = Image { width: SIZE[0], height: SIZE[1], pixels };
        let stated = is_stated.then_some((variances, samples));
        let (variances, samples) = stated.unzip();
        Candidate { mean, variances, samples, warnings: Vec::new() }
    }

    /// The verdict by what the picture itself shows of its noise.
    fn by_itself(golden: &Golden, candidate: &Candidate, settings: &TileSettings) -> bool {
        let view = |pixels| ImageView { width: SIZE[0], pixels };
        let pictures = [view(&golden.mean.pixels), view(&candidate.mean.pixels)];
        let own = golden.own_variances();
        let compared = match (&candidate.variances, candidate.samples) {
            (Some(variances), Some(samples)) => {
                let scatter = [
                    Scatter { variances: view(&own), degrees_of_freedom: golden.degrees_of_freedom() },
                    Scatter { variances: view(variances), degrees_of_freedom: f64::from(samples - 1) },
                ];
                compare_measured(pictures, &scatter, settings)
            }
            _ => compare_paired(pictures[0], pictures[1], settings),
        };
        compared.expect("they have one size").agrees()
    }

    #[test]
    fn dark_pictures_of_few_samples_raise_no_more_alarms_than_stated() {
        let settings = TestSettings { false_alarms: 0.02, ..TestSettings::default() };
        let tiles = super::super::judge::tile_settings(&settings);
        let (runs, mut random) = (300, SplitMix64::new(3));
        for is_stated in [true, false] {
            let (mut alarms, mut without) = (0, 0);
            for _ in 0..runs {
                let golden = golden(&mut random);
                let candidate = candidate(&mut random, SAMPLES, 1.0, is_stated);
                alarms += u32::from(!judge_candidate(&golden, &candidate, &settings).expect("one size").agrees());
                without += u32::from(!by_itself(&golden, &candidate, &tiles));
            }
            // Binomial(300, 0.02) is above 17 with a probability of 1e-4.
            assert!(alarms <= 17, "{alarms} of {runs}, stated: {is_stated}");
            // The control: the picture's own noise raises more.
            assert!(without > 60, "{without} of {runs}, stated: {is_stated}");
        }
    }

    #[test]
    fn five_per_cent_too_much_is_found() {
        let settings = TestSettings { false_alarms: 0.02, ..TestSettings::default() };
        let mut random = SplitMix64::new(4);
        let golden = golden(&mut random);
        for is_stated in [true, false] {
            let found = (0..100).filter(|_| {
                let candidate = candidate(&mut random, SAMPLES, 1.05, is_stated);
                !judge_candidate(&golden, &candidate, &settings).expect("one size").agrees()
            });
            let found = found.count();
            assert!(found >= 95, "{found} of 100, stated: {is_stated}");
        }
    }
    /// A golden picture of points that fill space evenly: its renders meet the edge as often as it is large, all of them, and do not scatter.
    #[test]
    fn edges_are_noise_that_even_points_hide() {
        let settings = TestSettings { false_alarms: 0.02, ..TestSettings::default() };
        let tiles = super::super::judge::tile_settings(&settings);
        let pixels = (0..PIXELS).map(|pixel| [chance_of_edge(pixel) as f32; 3]).collect();
        let golden = Golden {
            mean: Image { width: SIZE[0], height: SIZE[1], pixels },
            variances: vec![[0.0; 3]; PIXELS],
            samples: 4096,
            replications: Some(8),
            flip_of_noise: None,
            scene_hash: None,
            warnings: Vec::new(),
        };
        let (mut random, mut alarms, mut without) = (SplitMix64::new(5), 0, 0);
        for _ in 0..300 {
            let mut candidate = candidate(&mut random, SAMPLES, 1.0, true);
            for (pixel, value) in candidate.mean.pixels.iter_mut().enumerate().filter(|(pixel, _)| chance_of_edge(*pixel) == 0.0)
            {
                *value = golden.mean.pixels[pixel];
            }
            alarms += u32::from(!judge_candidate(&golden, &candidate, &settings).expect("one size").agrees());
            without += u32::from(!by_itself(&golden, &candidate, &tiles));
        }
        assert!(alarms <= 17, "{alarms} of 300");
        // The control: by its own noise.
        assert!(without > 60, "{without} of 300");
    }
}
