//! Stratified sampling: one random point in each of many parts of equal size.
//!
//! The parts are laid out in two ways. `stratified` knows how many samples a pixel gets and makes that many strata, taken in a random
//! order. `quadrant` does not need to know: it quarters the square again and again (Honsdorf).

use super::dimension::{Dimension, Strata};
use super::hash::{dimension_bits, mix};
use super::permutation::{nested_scramble, permuted};

/// A coordinate of `sample` in strata for `samples` samples, as a 32-bit fraction. The samples after those begin anew, in another
/// order. `samples` is at least 1 and at most 2³¹.
///
/// A line has `samples` intervals. A square has rows of cells, as many rows as cells in a row where `samples` is a square number; if
/// not, some rows have a cell more than others and are higher in proportion, so that every cell has the area 1/`samples` and
/// holds exactly one sample whatever the number.
pub fn stratified_bits(seed: u32, samples: u32, dimension: Dimension, sample: u32) -> u32 {
    let (round, index) = (sample / samples, sample % samples);
    let key = |first| mix(dimension_bits(mix(seed ^ 0x8d26_f1a3), first) ^ mix(round));
    match dimension.strata() {
        Strata::Line(first) => {
            let stratum = permuted(index, samples, key(first));
            fraction(u64::from(stratum), jitter(key(first), 0, sample), samples)
        }
        Strata::Square { first, axis } => {
            let cell = permuted(index, samples, key(first));
            cell_bits(cell, samples, axis, jitter(key(first), axis as u32, sample))
        }
    }
}

/// A coordinate of `sample` where the strata of all directions of a path have one random order, k(0), k(1), …, and the surface of depth d takes number
/// (sample + d) modulo `samples` of it (Legmaier's master's thesis, equation 4.3). All other coordinates are random.
///
/// The thesis adds the pixel's coordinates as well. This changes only which of a pixel's samples takes which strata, not the mean of them all.
pub fn shared_strata_bits(seed: u32, samples: u32, dimension: Dimension, sample: u32) -> u32 {
    let key = mix(seed ^ 0x51ed_270b);
    let Some((depth, axis)) = dimension.of_direction() else {
        return jitter(dimension_bits(key, dimension.0), 0, sample);
    };
    let (round, index) = (sample / samples, (sample % samples + depth) % samples);
    let cell = permuted(index, samples, key ^ mix(round));
    cell_bits(cell, samples, axis, jitter(dimension_bits(key, dimension.0), axis as u32, sample))
}

/// A coordinate inside one of `samples` cells of the square.
fn cell_bits(cell: u32, samples: u32, axis: usize, jitter: u32) -> u32 {
    let (cell, count) = (u64::from(cell), u64::from(samples));
    let rows = (count as f64).sqrt().round().max(1.0) as u64;
    let first_of_row = |row: u64| row * count / rows;
    let row = ((cell + 1) * rows - 1) / count;
    let (first, end) = (first_of_row(row), first_of_row(row + 1));
    if axis == 0 {
        fraction(cell - first, jitter, (end - first) as u32)
    } else {
        // The row is as high as its share of the cells.
        (((first << 32) + (end - first) * u64::from(jitter)) / count) as u32
    }
}

/// A coordinate of `sample` by recursive quadrants, as a 32-bit fraction.
///
/// The first 4 samples fall into the 4 quadrants of the square, the next 16 into those of the quadrants, the next 64 into theirs. Within
/// such a level, any 4 successive samples from a multiple of 4 visit all quadrants, any 16 all of the next size, and so on; in which
/// order is random in each quadrant. A line is cut into 4 parts, 16, 64 in the same manner.
pub fn quadrant_bits(seed: u32, dimension: Dimension, sample: u32) -> u32 {
    let (level, index) = level_of(sample);
    let key = |first| dimension_bits(dimension_bits(mix(seed ^ 0x3c6e_f372), first), level);
    match dimension.strata() {
        Strata::Line(first) => {
            // The lowest digit says which half.
            let order = visiting_order(index, level, key(first));
            let interval = (0..2 * level).fold(0, |bits, digit| bits << 1 | order >> digit & 1);
            fixed_point(scrambled(interval, level, mix(key(first))), 2 * level, jitter(key(first), 0, sample))
        }
        Strata::Square { first, axis } => {
            // The lowest pair of digits names the largest quadrant. Cells are numbered quadrant by quadrant (Morton order).
            let order = visiting_order(index, level, key(first));
            let number = (0..level).fold(0, |bits, digit| bits << 2 | order >> (2 * digit) & 3);
            let number = scrambled(number, level, mix(key(first)));
            let cell = (0..level).rev().fold(0, |bits, digit| bits << 1 | number >> (2 * digit + axis as u32) & 1);
            fixed_point(cell, level, jitter(key(first), axis as u32, sample))
        }
    }
}

/// The index within its level, its blocks of 4, 16, … in another order.
fn visiting_order(index: u32, level: u32, key: u32) -> u64 {
    scrambled(u64::from(index), level, key)
}

/// Nested scrambling of the 2·level digits of a number.
fn scrambled(number: u64, level: u32, key: u32) -> u64 {
    let unused = u32::BITS - 2 * level;
    u64::from(nested_scramble((number << unused) as u32, key)) >> unused
}

/// The level, from 1, of a sample, and its number among the 4^level of that level.
fn level_of(sample: u32) -> (u32, u32) {
    let (mut level, mut index, mut cells) = (1, u64::from(sample), 4);
    while index >= cells {
        index -= cells;
        cells *= 4;
        level += 1;
    }
    (level, index as u32)
}

/// Random within a stratum, of its own for every sample and coordinate.
fn jitter(key: u32, axis: u32, sample: u32) -> u32 {
    dimension_bits(mix(key ^ mix(sample.wrapping_add(0x1b56_c4e9))), axis)
}

/// (whole + jitter) / parts, jitter a 32-bit fraction, as a 32-bit fraction.
fn fraction(whole: u64, jitter: u32, parts: u32) -> u32 {
    ((whole << 32 | u64::from(jitter)) / u64::from(parts)) as u32
}

/// `cell` in the upper `digits` binary digits, `jitter` in those that are left.
fn fixed_point(cell: u64, digits: u32, jitter: u32) -> u32 {
    ((cell << 32 | u64::from(jitter)) >> digits) as u32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sampling::VertexDimension;

    fn point(bits: impl Fn(Dimension, u32) -> u32, sample: u32) -> [f64; 2] {
        [0, 1].map(|d| (f64::from(bits(Dimension(d), sample)) + 0.5) / 4_294_967_296.0)
    }

    /// Every stratum has the same area and one sample, for any number of samples, in every round.
    #[test]
    fn each_cell_holds_one_sample_whatever_the_number() {
        for samples in [1_u32, 2, 3, 5, 7, 12, 16, 37, 64, 100, 257] {
            let rows = f64::from(samples).sqrt().round() as u32;
            for round in [0, 5] {
                let mut counts = vec![0; samples as usize];
                let mut on_the_line = counts.clone();
                for sample in round * samples..(round + 1) * samples {
                    let [x, y] = point(|d, s| stratified_bits(3, samples, d, s), sample);
                    let first_of_row = |row: u32| row * samples / rows;
                    let row = (0..rows).rfind(|&row| y >= f64::from(first_of_row(row)) / f64::from(samples)).unwrap();
                    let cells = first_of_row(row + 1) - first_of_row(row);
                    counts[(first_of_row(row) + (x * f64::from(cells)) as u32) as usize] += 1;
                    let line = f64::from(stratified_bits(3, samples, Dimension(4), sample)) / 4_294_967_296.0;
                    on_the_line[(line * f64::from(samples)) as usize] += 1;
                }
                assert!(counts.iter().chain(&on_the_line).all(|&count| count == 1), "{samples}: {counts:?} {on_the_line:?}");
            }
        }
    }

    /// Each surface's directions fill all strata, and those of the next one have the same order, one further: a sample's stratum is that of the
    /// sample after it at the surface before. The control: `stratified` has another order at each.
    #[test]
    fn surfaces_share_an_order_of_strata() {
        let samples = 16_u32;
        let cell = |bits: &dyn Fn(Dimension, u32) -> u32, depth: u32, sample: u32| {
            let at = |name| f64::from(bits(Dimension::vertex(depth, name), sample)) / 4_294_967_296.0;
            let [x, y] = [at(VertexDimension::BsdfU), at(VertexDimension::BsdfV)];
            (4.0 * y) as u32 * 4 + (4.0 * x) as u32
        };
        let shared = |d: Dimension, s: u32| shared_strata_bits(9, samples, d, s);
        let own = |d: Dimension, s: u32| stratified_bits(9, samples, d, s);
        let order =
            |bits: &dyn Fn(Dimension, u32) -> u32, depth: u32| (0..samples).map(|s| cell(bits, depth, s)).collect::<Vec<u32>>();
        for depth in 0..3 {
            let mut here = order(&shared, depth);
            let next = order(&shared, depth + 1);
            assert!((0..samples as usize).all(|s| next[s] == here[(s + 1) % samples as usize]), "{here:?} {next:?}");
            here.sort_unstable();
            assert_eq!(here, (0..samples).collect::<Vec<u32>>());
        }
        let (here, next) = (order(&own, 0), order(&own, 1));
        assert!((0..samples as usize).any(|s| next[s] != here[(s + 1) % samples as usize]), "the control");
    }

    #[test]
    fn each_quadrant_holds_one_sample_at_every_level() {
        let mut first = 0;
        for level in 1..=5_u32 {
            // Whole levels, and the aligned parts of a level.
            for size in 1..=level {
                let (count, side) = (1 << (2 * size), 1 << size);
                for part in 0..1 << (2 * (level - size)) {
                    let mut counts = vec![0; count as usize];
                    for sample in first + part * count..first + (part + 1) * count {
                        let [x, y] = point(|d, s| quadrant_bits(8, d, s), sample);
                        counts[((y * f64::from(side)) as u32 * side + (x * f64::from(side)) as u32) as usize] += 1;
                    }
                    assert!(counts.iter().all(|&count| count == 1), "level {level}, {counts:?}");
                }
            }
            first += 1 << (2 * level);
        }
    }

    #[test]
    fn the_last_samples_have_levels_too() {
        assert_eq!(
            [level_of(0), level_of(3), level_of(4), level_of(19), level_of(20)],
            [(1, 0), (1, 3), (2, 0), (2, 15), (3, 0)]
        );
        assert_eq!(level_of(u32::MAX).0, 16);
        for dimension in (0..40).map(Dimension) {
            quadrant_bits(0, dimension, u32::MAX);
            stratified_bits(0, 1 << 31, dimension, u32::MAX);
        }
    }
}
