//! Constants by which kernels read the table of lights in cells ([`crate::sampling::light_cells`]).

use crate::sampling::light_cells::table;
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    const LIGHT_UNIT_BITS: u32 = table::LIGHT_UNIT_BITS;
    const LIGHT_UNIT: f32 = table::LIGHT_UNIT;
    const LIGHT_UNITS_BY_POWER_BITS: u32 = table::LIGHT_UNITS_BY_POWER_BITS;
    const LIGHT_UNITS_BY_POWER: u32 = table::LIGHT_UNITS_BY_POWER;
    const LIGHT_CELL_SLOTS: u32 = table::LIGHT_CELL_SLOTS;
    const LIGHT_SLOT_COUNT_SHIFT: u32 = table::LIGHT_SLOT_COUNT_SHIFT;
    const LIGHT_SLOT_MASK: u32 = table::LIGHT_SLOT_MASK;
    const LIGHT_SLOT_STRIDE: u32 = table::LIGHT_SLOT_STRIDE;
});
