//! Constants by which kernels read the table that guides paths ([`crate::sampling::guide`]), and the grid
//! that it begins with ([`crate::sampling::cell_grid`]).

use crate::sampling::cell_grid;
use crate::sampling::guide::table;
use crate::shader::shared::shared_constants;

shared_constants!(constants {
    const GUIDE_ROWS: u32 = table::GUIDE_ROWS;
    const GUIDE_COLUMNS: u32 = table::GUIDE_COLUMNS;
    const GUIDE_FACING_IN_MEDIA: u32 = table::GUIDE_FACING_IN_MEDIA;
    const GUIDE_CELL_WORDS: u32 = table::GUIDE_CELL_WORDS;
    const GRID_HEADER_WORDS: u32 = cell_grid::GRID_HEADER_WORDS;
    const GUIDED_SHARE: f32 = table::GUIDED_SHARE;
    const SURVIVAL_FACTOR: f32 = table::SURVIVAL_FACTOR;
    const LEAST_SURVIVAL: f32 = table::LEAST_SURVIVAL;
    const FACING_WEIGHT_Y: f32 = cell_grid::FACING_WEIGHT_Y;
    const FACING_WEIGHT_Z: f32 = cell_grid::FACING_WEIGHT_Z;
    const GUIDE_AXIS_STEP: f32 = table::GUIDE_AXIS_STEP;
});
