//! How many slots of a cell each light gets.

use super::table::{LIGHT_CELL_SLOTS, LIGHT_SLOT_COUNT_SHIFT, LIGHT_UNITS_BY_POWER, SLOTS};

/// A light that reaches a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reaching {
    pub light: u32,
    /// Root of the mean square of what it brings to points of the cell.
    pub worth: f64,
    /// Its probability where lights are chosen by power.
    pub by_power: f64,
}

/// The slots of a cell, by the numbers of the lights. None: no light reaches it.
///
/// With probabilities p the squared error goes with Σ worth² / p, and p is in proportion to the number of slots and what power adds. So one slot
/// after the other goes to the light where that sum falls most.
pub fn slots(reaching: &[Reaching]) -> Option<[u32; SLOTS]> {
    let largest = reaching.iter().map(|light| light.worth).fold(0.0, f64::max);
    if !(largest > 0.0 && largest.is_finite()) {
        return None;
    }
    let mut counts = vec![0_u32; reaching.len()];
    let gain = |light: &Reaching, count: u32| {
        let share = f64::from(count) + f64::from(LIGHT_UNITS_BY_POWER) * light.by_power;
        let worth = light.worth / largest;
        worth * worth / (share * (share + 1.0))
    };
    let mut gains: Vec<f64> = reaching.iter().map(|light| gain(light, 0)).collect();
    for _ in 0..LIGHT_CELL_SLOTS {
        // The first of equal ones.
        let best = (1..gains.len()).fold(0, |best, index| if gains[index] > gains[best] { index } else { best });
        counts[best] += 1;
        gains[best] = gain(&reaching[best], counts[best]);
    }
    let mut named: Vec<(u32, u32)> =
        reaching.iter().zip(counts).filter(|(_, count)| *count > 0).map(|(light, count)| (light.light, count)).collect();
    named.sort_unstable();
    let mut all =
        named.iter().flat_map(|&(light, count)| std::iter::repeat_n(light | count << LIGHT_SLOT_COUNT_SHIFT, count as usize));
    Some(std::array::from_fn(|_| all.next().unwrap_or_default()))
}
