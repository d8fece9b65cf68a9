// Points of the unit square with a density that is constant over each cell of a grid; src/sampling/hierarchical_warp.rs does the same, and says how.
#import geometry/texels.wgsl

struct Warp {
    // Among the words of the texels: of the quadtree's inner nodes, three of each, and of the cells' densities.
    first_node: u32,
    first_density: u32,
    width: u32,
    height: u32,
    levels: u32,
}

struct WarpCell {
    column: u32,
    row: u32,
    // Position of the point in the cell, in (0, 1) x (0, 1).
    position: vec2<f32>,
}

// Density over the unit square in a cell.
fn warp_density(warp: Warp, column: u32, row: u32) -> f32 {
    return texel_float(warp.first_density + row * warp.width + column);
}

// The cell that a point of the primary square, 2^31 points a side, is warped to: down a quadtree, at each node first to the left or the
// right column of children, then up or down in it. Nothing but comparisons of integers: the same on every device.
fn warp_cell(warp: Warp, point: vec2<u32>) -> WarpCell {
    // The node's rectangle of the primary square, and its place in its level.
    var low = vec2<u32>(0u);
    var high = vec2<u32>(0x80000000u);
    var place = vec2<u32>(0u);
    var first = warp.first_node;
    for (var level = warp.levels; level > 0u; level--) {
        let round_up = (1u << level) - 1u;
        let columns = (warp.width + round_up) >> level;
        let rows = (warp.height + round_up) >> level;
        let node = first + 3u * (place.y * columns + place.x);
        let split_u = texel_word(node);
        let right = point.x >= split_u;
        let split_v = texel_word(node + select(1u, 2u, right));
        let split = vec2<u32>(split_u, split_v);
        let second = vec2<bool>(right, point.y >= split_v);
        low = select(low, split, second);
        high = select(split, high, second);
        place = 2u * place + select(vec2<u32>(0u), vec2<u32>(1u), second);
        first += 3u * columns * rows;
    }
    return WarpCell(place.x, place.y, (vec2<f32>(point - low) + 0.5) / vec2<f32>(high - low));
}
