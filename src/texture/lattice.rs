//! Random numbers tied to the points of the integer lattice, the same bits on every device.

use glam::DVec2;

use crate::sampling::hash::{GOLDEN, mix};

/// Odd, and unrelated to [`GOLDEN`]: spreads the rows of the lattice as that spreads its columns.
const ROW_STRIDE: u32 = 0x85eb_ca6b;

/// 32 bits for the lattice point (x, y): mix(mix(x·GOLDEN ^ seed) + y·ROW_STRIDE), everything modulo 2³².
pub fn lattice_bits(x: i64, y: i64, seed: u32) -> u32 {
    let column = mix((x as u32).wrapping_mul(GOLDEN) ^ seed);
    mix(column.wrapping_add((y as u32).wrapping_mul(ROW_STRIDE)))
}

/// The lattice cell that holds a point, and the point's place in it, in [0, 1)².
pub fn cell_of(point: DVec2) -> ([i64; 2], DVec2) {
    let corner = point.floor();
    // Far out the conversion saturates; NaN becomes 0.
    ([corner.x as i64, corner.y as i64], point - corner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_values_hold_so_that_pictures_stay_the_same_between_versions() {
        let bits = [lattice_bits(0, 0, 0), lattice_bits(1, 0, 0), lattice_bits(0, 1, 0), lattice_bits(-1, -2, 7)];
        assert_eq!(bits, [0, 3_578_996_390, 3_980_567_503, 265_192_520]);
    }
}
