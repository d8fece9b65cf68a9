//! Which lights reach which part of a scene, as a table that both devices read: next event estimation chooses by it where a scene has many
//! lights that stand behind walls for most of its surfaces.
//!
//! Space is cut into cells, by position and by which way a surface faces. Each cell has a list of slots, every slot as likely as any other, that
//! name the lights found to reach it ([`crate::reference::light_cells`]): a light that brings more has more of them. A fixed share of the
//! choices is made by power among all lights, so that every light has a probability above 0 everywhere, whatever was learned. The probability
//! of a light is that of both ways together. 32 random bits choose by integers alone, so devices that round differently choose another
//! light only where a point lies on the border of two cells. `shaders/shading/light_cells.wgsl` is the device's half.

mod division;
mod list;
mod lit_point;
pub mod table;

use std::sync::Arc;

pub use division::Division;
pub use list::Reaching;
pub use lit_point::LitPoint;
pub use table::{LightCell, LightCells};

use super::alias::AliasTable;

/// How a light is chosen: those inside the scene, which are numbered first, by cells and by power; those at infinity by irradiance, in half of the
/// choices where there are both.
#[derive(Debug, Clone)]
pub struct LightCellChoice {
    pub cells: Arc<LightCells>,
    /// Of the lights inside the scene, by power.
    local: AliasTable,
    at_infinity: AliasTable,
}

impl LightCellChoice {
    /// Nothing is learned yet. The probabilities of either table sum to one, or there are none.
    pub fn new(local: AliasTable, at_infinity: AliasTable) -> Self {
        Self { cells: Arc::default(), local, at_infinity }
    }

    /// The probabilities of the lights inside the scene by power.
    pub fn by_power(&self) -> &[f64] {
        &self.local.pmf
    }

    /// The light inside the scene that 32 random bits choose by power.
    pub fn choose_by_power(&self, bits: u32) -> usize {
        self.local.choose(bits)
    }

    /// The share of the choices that goes to lights inside the scene.
    fn local_share(&self) -> f64 {
        if self.at_infinity.pmf.is_empty() { 1.0 } else { 0.5 }
    }

    /// The light that 32 random bits choose at a point, and the probability of that.
    pub fn choose(&self, from: LitPoint, bits: u32) -> (usize, f64) {
        let mut rest = bits;
        if !self.at_infinity.pmf.is_empty() {
            rest = bits << 1;
            if bits >> 31 == 1 {
                let light = self.at_infinity.choose(rest);
                return (self.local.pmf.len() + light, 0.5 * self.at_infinity.pmf[light]);
            }
        }
        let cell = self.cells.cell(from);
        let light = match cell.map(|cell| cell.choose(rest)) {
            Some(Ok(light)) => light as usize,
            Some(Err(rest)) => self.local.choose(rest),
            None => self.local.choose(rest),
        };
        (light, self.probability_in(cell, light))
    }

    fn probability_in(&self, cell: Option<LightCell<'_>>, light: usize) -> f64 {
        let by_power = self.local.pmf[light];
        self.local_share() * cell.map_or(by_power, |cell| cell.probability(light as u32, by_power))
    }

    /// The probability with which [`LightCellChoice::choose`] chooses a light inside the scene at a point.
    pub fn probability(&self, from: LitPoint, light: usize) -> f64 {
        self.probability_in(self.cells.cell(from), light)
    }
}

#[cfg(test)]
mod tests;
