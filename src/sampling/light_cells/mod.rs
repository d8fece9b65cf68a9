//! Which lights reach which part of a scene, as a table that both devices read: next event estimation chooses by it where a scene has lights
//! that do not reach most of its surfaces, or are much stronger there than elsewhere: many lights behind walls, or a light and a window.
//!
//! Space is cut into cells, by position and by which way a surface faces. Each cell has a list of slots, every slot as likely as any other, that
//! name the lights found to reach it ([`crate::learn`]): a light that brings more has more of them. A fixed share of the
//! choices is made by power among all lights, so that every light has a probability above 0 everywhere, whatever was learned. The probability
//! of a light is that of both ways together. 32 random bits choose by integers alone, so devices that round differently choose another
//! light only where a point lies on the border of two cells. `shaders/shading/light/choice/cells.wgsl` is the device's half.

mod division;
mod light_sample_context;
mod list;
pub mod table;

use std::sync::Arc;

pub use division::Division;
pub use light_sample_context::LightSampleContext;
pub use list::Reaching;
pub use table::{LightCell, LightCells};

use super::alias::AliasTable;

/// How a light is chosen: by cells and by power.
#[derive(Debug, Clone)]
pub struct LightCellChoice {
    pub cells: Arc<LightCells>,
    by_power: AliasTable,
}

impl LightCellChoice {
    /// Nothing is learned yet: all choices are made by power, by a table of all lights.
    pub fn new(by_power: AliasTable) -> Self {
        Self { cells: Arc::default(), by_power }
    }

    /// The probabilities of the lights by power.
    pub fn by_power(&self) -> &[f64] {
        &self.by_power.pmf
    }

    /// The light that 32 random bits choose by power.
    pub fn choose_by_power(&self, bits: u32) -> usize {
        self.by_power.choose(bits)
    }

    /// The light that 32 random bits choose at a point, and the probability of that.
    pub fn choose(&self, from: LightSampleContext, bits: u32) -> (usize, f64) {
        let cell = self.cells.cell(from);
        let light = match cell.map(|cell| cell.choose(bits)) {
            Some(Ok(light)) => light as usize,
            Some(Err(rest)) => self.by_power.choose(rest),
            None => self.by_power.choose(bits),
        };
        (light, self.probability_in(cell, light))
    }

    fn probability_in(&self, cell: Option<LightCell<'_>>, light: usize) -> f64 {
        let by_power = self.by_power.pmf[light];
        cell.map_or(by_power, |cell| cell.probability(light as u32, by_power))
    }

    /// The probability with which [`LightCellChoice::choose`] chooses a light at a point.
    pub fn probability(&self, from: LightSampleContext, light: usize) -> f64 {
        self.probability_in(self.cells.cell(from), light)
    }
}

#[cfg(test)]
mod tests;
