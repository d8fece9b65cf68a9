//! The allocation of samples: half of them go everywhere alike, the other half where the noise is.
//!
//! A pixel's samples are the first of one sequence, and their number is `floor`, or that doubled up to [`MOST_DOUBLINGS`] times. It
//! follows the noise that the first `floor` samples of the pixels *around* it show, never its own: a pixel whose first samples happened to be dark is
//! not left with them, and the plain mean of all its samples is unbiased. To be strict, pixels are coloured like a chessboard, and numbers of one
//! colour depend on samples of the other alone, by the scale that all of a colour share as well.
//!
//! The two halves of a pixel's first samples show its noise by their difference: how much the mean of so many
//! points of a sequence varies, not how much a single sample does.
//!
//! If few samples hold most of the light, pixels that have not met one yet look calm. Hence the half that
//! goes everywhere: no pixel's expected error is more than about twice what it would have been
//! (docs/notes/2026-11-22-adaptive-sampling.md).

use rayon::prelude::*;

use crate::compare::RELATIVE_EPSILON;

/// A pixel has at most two to the power of this times the samples that all have. More would be spent by what few samples tell of noise.
pub const MOST_DOUBLINGS: u8 = 3;
/// Pixels up to this far, of the other colour, tell of a pixel's noise: few samples tell little, and the neighbours see much the same.
const RADIUS: isize = 2;
/// With n samples a pixel's squared error is about v n⁻ᵅ, and the sum of these errors is least, for a given number of samples, where n is in
/// proportion to v to the power of 1 / (1 + α). α is 1 for independent samples and more for points of a sequence, 4/3 say; and as v is only
/// roughly known, following it less closely loses less where noise is in truth even. Of powers from 1/5 to 3/7 and radii from 2 to 4, on six scenes,
/// these gain nearly as much as any at shadows' edges and lose least elsewhere.
const EXPONENT: f64 = 0.25;
/// Noise below this is treated as this: it is not told from none, and samples that no pixel needs are spread over all.
const LEAST_NOISE: f64 = 1e-12;
/// Scales are searched between two to the power of this and its inverse, in so many steps.
const LARGEST_EXPONENT: f32 = 128.0;
const BISECTIONS: u32 = 40;

/// How often each pixel's `floor` samples are to be doubled, so that on average a pixel has `budget` times `floor` samples or as few less as
/// powers of two allow. `halves` are the mean luminances of the two halves of the pixels' first `floor` samples, `least` doublings that
/// pixels have behind them.
pub fn allocate(size: [u32; 2], halves: [&[f32]; 2], budget: f64, least: &[u8]) -> Vec<u8> {
    let [width, height] = size.map(|side| side as isize);
    let at = |x: isize, y: isize| (y * width + x) as usize;
    let noise_around = |x: isize, y: isize| {
        let (mut noise, mut count) = (0.0, 0.0);
        for dy in -RADIUS..=RADIUS {
            for dx in -RADIUS..=RADIUS {
                let (x, y) = (x + dx, y + dy);
                let other_colour = (dx + dy) % 2 != 0;
                if other_colour && (0..width).contains(&x) && (0..height).contains(&y) {
                    noise += squared_relative_error(halves.map(|half| f64::from(half[at(x, y)])));
                    count += 1.0;
                }
            }
        }
        if count > 0.0 { (noise / count).max(LEAST_NOISE) } else { LEAST_NOISE }
    };
    // In doublings: a scale of all samples is a sum.
    let wanted: Vec<f32> = (0..height)
        .into_par_iter()
        .flat_map_iter(|y| (0..width).map(move |x| (EXPONENT * noise_around(x, y).log2()) as f32))
        .collect();
    let scales = [0, 1].map(|colour| scale_for(colour, width as usize, &wanted, least, budget));
    let doublings = |index: usize| level(wanted[index] + scales[colour_of(index, width as usize)], least[index]);
    (0..wanted.len()).map(doublings).collect()
}

/// An estimate, from a pixel's halves, of the squared error of their mean, relative as in `gpt compare`.
fn squared_relative_error([a, b]: [f64; 2]) -> f64 {
    let (mean, error) = (0.5 * (a + b), 0.5 * (a - b));
    error * error / (mean * mean + RELATIVE_EPSILON)
}

/// Colour of a chessboard's square.
fn colour_of(index: usize, width: usize) -> usize {
    (index % width + index / width) % 2
}

/// The nearest number of doublings that there is.
fn level(doublings: f32, least: u8) -> u8 {
    (doublings.round().clamp(0.0, f32::from(MOST_DOUBLINGS)) as u8).max(least)
}

/// The most that can be added to the wanted doublings of one colour's pixels without spending more than the budget on average.
fn scale_for(colour: usize, width: usize, wanted: &[f32], least: &[u8], budget: f64) -> f32 {
    let pixels = (0..wanted.len()).filter(|index| colour_of(*index, width) == colour).count();
    let spent = |scale: f32| {
        let of_pixel = |(index, (wanted, least)): (usize, (&f32, &u8))| {
            if colour_of(index, width) == colour { 1_u64 << level(wanted + scale, *least) } else { 0 }
        };
        wanted.par_iter().zip(least).enumerate().map(of_pixel).sum::<u64>() as f64
    };
    let (mut low, mut high) = (-LARGEST_EXPONENT, LARGEST_EXPONENT);
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        if spent(middle) > budget * pixels as f64 {
            high = middle;
        } else {
            low = middle;
        }
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [64, 32];

    /// Halves whose difference doubles every fourth column, around a mean of 1.
    fn ramp() -> [Vec<f32>; 2] {
        let deviation = |index: usize| 1e-4 * ((index % 64) as f32 / 4.0).exp2();
        let half = |sign: f32| (0..64 * 32).map(|index| 1.0 + sign * deviation(index)).collect();
        [half(1.0), half(-1.0)]
    }

    fn allocated(halves: &[Vec<f32>; 2], least: &[u8]) -> Vec<u8> {
        allocate(SIZE, [&halves[0], &halves[1]], 2.0, least)
    }

    fn average(levels: &[u8]) -> f64 {
        levels.iter().map(|level| f64::from(1 << level)).sum::<f64>() / levels.len() as f64
    }

    #[test]
    fn samples_follow_the_noise() {
        let levels = allocated(&ramp(), &[0; 64 * 32]);
        let row = &levels[64 * 16..64 * 17];
        assert!(row.windows(2).all(|pair| pair[0] <= pair[1]), "{row:?}");
        assert_eq!((row[0], row[63]), (0, MOST_DOUBLINGS));
        assert!((1.9..=2.0).contains(&average(&levels)), "{}", average(&levels));
    }

    /// Samples that a pixel has already are not taken back, and others pay for them.
    #[test]
    fn spent_samples_stay_spent() {
        let mut least = vec![0; 64 * 32];
        least[..64].fill(3);
        let levels = allocated(&ramp(), &least);
        assert!(levels[..64].iter().all(|level| *level == 3));
        assert!((1.9..=2.0).contains(&average(&levels)), "{}", average(&levels));
    }

    /// A pixel's own samples say nothing of their number, nor do those of any other pixel of its colour; those of its neighbours do.
    #[test]
    fn numbers_of_one_colour_depend_on_the_other_alone() {
        let own = |index: &usize| colour_of(*index, 64) == 0;
        let levels = allocated(&ramp(), &[0; 64 * 32]);
        let mut changed = ramp();
        (0..64 * 32).filter(own).for_each(|index| changed[0][index] += 0.1 * (index % 7) as f32);
        let after = allocated(&changed, &[0; 64 * 32]);
        let different =
            |colour| (0..64 * 32).filter(|index| colour_of(*index, 64) == colour && levels[*index] != after[*index]).count();
        assert_eq!(different(0), 0);
        // The control.
        assert!(different(1) > 100, "{}", different(1));
    }

    #[test]
    fn a_picture_without_noise_is_sampled_evenly() {
        assert_eq!(allocate([4, 4], [&[0.5; 16]; 2], 2.0, &[0; 16]), [1; 16]);
        assert_eq!(allocate([4, 4], [&[0.0; 16]; 2], 2.0, &[0; 16]), [1; 16]);
        assert_eq!(allocate([1, 1], [&[0.5], &[0.1]], 2.0, &[0]), [1], "no neighbours");
    }
}
