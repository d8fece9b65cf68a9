//! Cells of lights as a table, and what is read from it.
//!
//! The table begins as [`crate::sampling::cell_grid`] says, with the cell's number from 1 in the index, or 0
//! where nothing is known. Then come
//! [`LIGHT_CELL_SLOTS`] for each cell, by the number of the light that they name, which is in the lower bits; in the upper ones stands how
//! many slots of the cell name it.

use super::light_sample_context::LightSampleContext;
use crate::sampling::cell_grid::{CellGrid, GRID_HEADER_WORDS};

/// Random bits that say by which of all units a light is chosen: slots of a cell, and those that leave the choice to power.
pub const LIGHT_UNIT_BITS: u32 = 7;
/// The probability of one of these bits' values.
pub const LIGHT_UNIT: f32 = 1.0 / (1 << LIGHT_UNIT_BITS) as f32;
/// Number of these bits' values that leave the choice to power, the first ones: a power of two.
pub const LIGHT_UNITS_BY_POWER_BITS: u32 = 4;
pub const LIGHT_UNITS_BY_POWER: u32 = 1 << LIGHT_UNITS_BY_POWER_BITS;
/// The rest of the values: slots of a cell.
pub const LIGHT_CELL_SLOTS: u32 = (1 << LIGHT_UNIT_BITS) - LIGHT_UNITS_BY_POWER;
/// Bit of a slot at which the number of slots begins, above the number of the light.
pub const LIGHT_SLOT_COUNT_SHIFT: u32 = 20;
pub const LIGHT_SLOT_MASK: u32 = (1 << LIGHT_SLOT_COUNT_SHIFT) - 1;
/// Least power of two of which twice is more than the slots: from there on they are searched by halves.
pub const LIGHT_SLOT_STRIDE: u32 = 1 << (LIGHT_UNIT_BITS - 1);

/// Words of a cell.
pub const SLOTS: usize = LIGHT_CELL_SLOTS as usize;
/// Words before the index.
pub const HEADER: usize = GRID_HEADER_WORDS as usize;

/// Which lights reach which part of a scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct LightCells {
    pub(super) words: Vec<u32>,
}

/// The lights that reach one cell.
#[derive(Debug, Clone, Copy)]
pub struct LightCell<'a> {
    slots: &'a [u32],
}

/// Nothing is known anywhere.
impl Default for LightCells {
    fn default() -> Self {
        let mut words = vec![0; HEADER];
        words[HEADER - 1] = GRID_HEADER_WORDS;
        Self { words }
    }
}

impl LightCells {
    /// The table, as devices read it.
    pub fn words(&self) -> &[u32] {
        &self.words
    }

    /// How many cells know of lights.
    pub fn count(&self) -> usize {
        count(&self.words)
    }

    fn first_cell(&self) -> usize {
        self.words[HEADER - 1] as usize
    }

    /// The cell of a point on a surface; None where nothing is known there.
    pub fn cell(&self, from: LightSampleContext) -> Option<LightCell<'_>> {
        let index = CellGrid::of_table(&self.words).index_of(from.facing, from.point)?;
        let number = self.words[HEADER + index];
        let start = self.first_cell() + SLOTS * (number.checked_sub(1)? as usize);
        Some(LightCell { slots: &self.words[start..start + SLOTS] })
    }
}

/// How many cells a table has.
pub fn count(words: &[u32]) -> usize {
    let first = words.get(HEADER - 1).map_or(0, |first| *first as usize);
    words.len().saturating_sub(first) / SLOTS
}

impl LightCell<'_> {
    /// The light that 32 random bits choose.
    ///
    /// # Errors
    /// The light that the bits choose, or the bits to choose by power with.
    pub fn choose(&self, bits: u32) -> Result<u32, u32> {
        let unit = bits >> (32 - LIGHT_UNIT_BITS);
        match unit.checked_sub(LIGHT_UNITS_BY_POWER) {
            Some(slot) => Ok(self.slots[slot as usize] & LIGHT_SLOT_MASK),
            None => Err(bits << (LIGHT_UNIT_BITS - LIGHT_UNITS_BY_POWER_BITS)),
        }
    }

    /// How many slots name a light.
    pub fn slots_of(&self, light: u32) -> u32 {
        let first = self.slots.partition_point(|slot| slot & LIGHT_SLOT_MASK < light);
        let found = self.slots.get(first).filter(|slot| **slot & LIGHT_SLOT_MASK == light);
        found.map_or(0, |slot| slot >> LIGHT_SLOT_COUNT_SHIFT)
    }

    /// The probability with which a light is chosen here, by slots or by power, by which alone it has the probability `by_power`.
    pub fn probability(&self, light: u32, by_power: f64) -> f64 {
        (f64::from(self.slots_of(light)) + f64::from(LIGHT_UNITS_BY_POWER) * by_power) * f64::from(LIGHT_UNIT)
    }
}
