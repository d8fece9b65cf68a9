//! Real layers: interfaces one above the other, and slabs of a medium between them.

use super::table::MaterialId;
use crate::scene::medium::MediumId;
use crate::scene::texture::ColorInput;
use crate::spectrum::Spectrum;

/// Most interfaces of one stack, those of the stacks in it included.
pub const MOST_INTERFACES: usize = 64;

/// Interfaces that light meets one after the other, from the front to the back, and what is between them.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerStack {
    /// At least one. One that is itself a stack stands for all of its interfaces.
    pub interfaces: Vec<MaterialId>,
    /// One fewer than interfaces: number i lies between interfaces i and i + 1.
    pub slabs: Vec<Slab>,
    pub model: LayerModel,
    /// The back looks as the front does: the first interface lies on the side from which the surface is seen.
    pub mirrored: bool,
}

/// The space between two interfaces.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Slab {
    /// Along the normal, in scene units; a number or a texture.
    pub thickness: ColorInput,
    /// None: it takes and scatters nothing.
    pub medium: Option<MediumId>,
}

impl Slab {
    /// No distance between two interfaces.
    pub const NOTHING: Self = Self { thickness: ColorInput::Constant(Spectrum::BLACK), medium: None };
}

/// How light is carried between layers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum LayerModel {
    /// By random walks that take account of everything (Guo, Hašan and Zhao 2018, "Position-free Monte Carlo simulation for arbitrary layered BSDFs").
    #[default]
    Walk,
    /// Straight down to one layer and straight up again, without scattering or reflections between layers (Weidlich and Wilkie 2007, "Arbitrarily
    /// layered micro-facet surfaces").
    Straight,
}
