//! Owen-scrambled Sobol' points in four dimensions, padded to as many as a path needs (Burley 2020).
//!
//! The sequence's two-dimensional projections get worse the further apart its dimensions are. So each block of four named dimensions
//! takes the first four of the sequence, which are good in every pair, and goes through them in a random order of its own that
//! keeps every run of 2ᵏ points together. The position on a light and the direction a material samples get the first two, a
//! (0, 2)-sequence: every 2ᵏ points fill all elementary intervals.

use super::hash::{dimension_bits, mix};
use super::permutation::nested_scramble;

/// Which dimension of the sequence each of a block's four dimensions gets: the camera's blocks, and a vertex's first and second.
const PIXEL_AND_LENS: [usize; 4] = [0, 1, 2, 3];
const LIGHT_AND_LOBE: [usize; 4] = [2, 0, 1, 3];
const BSDF_AND_ROULETTE: [usize; 4] = [0, 1, 2, 3];

/// Generator matrices of the sequence's first four dimensions, column by column (initial numbers of Joe and Kuo 2008).
const MATRICES: [[u32; 32]; 4] = [
    van_der_corput(),
    direction_numbers(1, 0, [1, 0, 0]),
    direction_numbers(2, 1, [1, 3, 0]),
    direction_numbers(3, 1, [1, 3, 1]),
];

const fn van_der_corput() -> [u32; 32] {
    let mut columns = [0; 32];
    let mut k = 0;
    while k < 32 {
        columns[k] = 1 << (31 - k);
        k += 1;
    }
    columns
}

/// By the recurrence of Bratley and Fox (1988): `coefficients` holds the inner coefficients of the primitive polynomial of degree
/// `degree`, `initial` the first `degree` odd numbers.
const fn direction_numbers(degree: usize, coefficients: u32, initial: [u32; 3]) -> [u32; 32] {
    let mut columns = [0; 32];
    let mut k = 0;
    while k < 32 {
        if k < degree {
            columns[k] = initial[k] << (31 - k);
        } else {
            let before = columns[k - degree];
            columns[k] = before ^ (before >> degree);
            let mut i = 1;
            while i < degree {
                if coefficients >> (degree - 1 - i) & 1 == 1 {
                    columns[k] ^= columns[k - i];
                }
                i += 1;
            }
        }
        k += 1;
    }
    columns
}

/// The sequence itself, before any scrambling.
fn sobol(axis: usize, index: u32) -> u32 {
    let columns = MATRICES[axis].iter().enumerate();
    columns.filter(|(k, _)| index >> k & 1 == 1).fold(0, |bits, (_, column)| bits ^ column)
}

/// A coordinate of `sample`, as a 32-bit fraction.
pub fn sobol_bits(seed: u32, dimension: u32, sample: u32) -> u32 {
    let block = dimension / 4;
    let axes = match block {
        0 | 1 => PIXEL_AND_LENS,
        _ if block.is_multiple_of(2) => LIGHT_AND_LOBE,
        _ => BSDF_AND_ROULETTE,
    };
    let order_key = dimension_bits(mix(seed ^ 0x6f12_ac55), block);
    let index = nested_scramble(sample, order_key);
    nested_scramble(sobol(axes[dimension as usize % 4], index), dimension_bits(mix(seed ^ 0xa54f_f53a), dimension))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The first points of the table that Joe and Kuo give with their program, dimensions 1 to 4 (they count in Gray code).
    #[test]
    fn first_points_are_those_of_the_literature() {
        let point = |index| [0, 1, 2, 3].map(|axis| f64::from(sobol(axis, index)) / 4_294_967_296.0);
        assert_eq!(point(0), [0.0; 4]);
        assert_eq!(point(1), [0.5; 4]);
        assert_eq!(point(3), [0.75, 0.25, 0.25, 0.25]);
        assert_eq!(point(2), [0.25, 0.75, 0.75, 0.75]);
        assert_eq!(point(6), [0.375, 0.375, 0.625, 0.875]);
        assert_eq!(point(7), [0.875, 0.875, 0.125, 0.375]);
        assert_eq!(point(5), [0.625, 0.125, 0.875, 0.625]);
        assert_eq!(point(4), [0.125, 0.625, 0.375, 0.125]);
    }
}
