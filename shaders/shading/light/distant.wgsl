// The choice of lights at infinity, whose directions are drawn in more ways than one.
#import shading/light/record.wgsl
#import shading/light/cells.wgsl

// The cell by which lights are chosen at a point of a surface that faces a way, as facing_of says; 0 where they are chosen alike everywhere.
fn cell_of_lights(point: vec3<f32>, facing: u32) -> u32 {
#if LIGHT_CELLS
    return light_cell_at(point, facing);
#else
    return 0u;
#endif
}

// The probability with which a light at infinity is chosen in such a cell.
fn distant_light_pmf(light: u32, cell: u32) -> f32 {
#if LIGHT_CELLS
    return light_pmf_in(cell, light);
#else
    return light_word(light, 0u).w;
#endif
}
