// A grid of boxes for each way that a surface can face. src/sampling/cell_grid.rs computes the same bits, and says what tables hold.
#import core/layout.wgsl

// Twice the axis along which a normal is longest, and one more where it points down that axis.
fn normal_facing(normal: vec3<f32>) -> u32 {
    let weighed = abs(normal) * vec3<f32>(1.0, FACING_WEIGHT_Y, FACING_WEIGHT_Z);
    let is_x = weighed.x >= weighed.y && weighed.x >= weighed.z;
    let is_y = weighed.y >= weighed.z;
    let along = select(select(normal.z, normal.y, is_y), normal.x, is_x);
    return select(select(4u, 2u, is_y), 0u, is_x) + select(0u, 1u, along < 0.0);
}

// Index of a point's box in a table, given the table's first words; 0, the header, for points outside.
fn grid_word(begins: vec4<u32>, counts: vec3<u32>, facing: u32, point: vec3<f32>) -> u32 {
    let place = (point - bitcast<vec3<f32>>(begins.xyz)) * bitcast<f32>(begins.w);
    if !(all(place >= vec3<f32>(0.0)) && all(place < vec3<f32>(counts))) {
        return 0u;
    }
    let at = min(vec3<u32>(place), counts - 1u);
    return GRID_HEADER_WORDS + ((facing * counts.z + at.z) * counts.y + at.y) * counts.x + at.x;
}
