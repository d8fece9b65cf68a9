// From where light arrives at surfaces and within media. src/sampling/guide/table.rs is the same in f64, and says what the table holds.
#import core/layout.wgsl
#import core/math.wgsl
#import core/octahedron.wgsl
#import core/sampler.wgsl
#import shading/cell_grid.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

@group(0) @binding(BINDING_GUIDE) var<storage, read> guide: array<u32>;

// The part of the guide that holds at one surface, or at a place within a medium.
struct GuideCell {
    // Share of the directions that it draws; 0 where there is no guide.
    share: f32,
    // Index of the cell's first bin.
    first: u32,
    axis: vec3<f32>,
#if SCATTERING
    // All directions have bins, and not those of a hemisphere.
    is_sphere: bool,
#endif
}

// A direction from its place on an octahedron, a byte a coordinate.
fn guide_axis(packed_axis: u32) -> vec3<f32> {
    let bytes = vec2<i32>(i32(packed_axis << 24u) >> 24u, i32(packed_axis << 16u) >> 24u);
    return octahedron_direction(vec2<f32>(bytes) * GUIDE_AXIS_STEP);
}

// The first word of the cell of a place; 0 where there is none.
fn guide_cell_word(facing: u32, position: vec3<f32>) -> u32 {
    let begins = vec4<u32>(guide[0], guide[1], guide[2], guide[3]);
    let counts = vec3<u32>(guide[4], guide[5], guide[6]);
    let word = grid_word(begins, counts, facing, position);
    if word == 0u || guide[word] == 0u {
        return 0u;
    }
    return guide[7] + (guide[word] - 1u) * GUIDE_CELL_WORDS;
}

// The guide at a surface whose broad lobes are sampled with this probability.
fn guide_at(surface: Surface, probability: f32) -> GuideCell {
    var cell: GuideCell;
    let first = guide_cell_word(normal_facing(surface.shading_normal), surface.position);
    if probability <= 0.0 || first == 0u {
        return cell;
    }
    cell.axis = guide_axis(guide[first]);
    cell.share = GUIDED_SHARE * probability;
    cell.first = first + 1u;
    return cell;
}

#if SCATTERING
// The guide at a place within a medium whose phase function spreads light so evenly.
fn guide_in_medium(position: vec3<f32>, evenness: f32) -> GuideCell {
    var cell: GuideCell;
    let first = guide_cell_word(GUIDE_FACING_IN_MEDIA, position);
    if evenness <= 0.0 || first == 0u {
        return cell;
    }
    cell.share = GUIDED_SHARE * evenness;
    cell.first = first + 1u;
    cell.is_sphere = true;
    return cell;
}
#endif

// Radiance that a surface sends on, on average: all light, or the part that it scatters.
fn guide_sent_on(cell: GuideCell, all: bool) -> f32 {
    return bitcast<f32>(guide[cell.first + GUIDE_ROWS * GUIDE_COLUMNS + select(0u, 1u, all)]);
}

// Draws a direction.
fn guided_direction(cell: GuideCell, u: f32, v: f32) -> vec3<f32> {
    let u_bits = u32(u * 16777216.0);
    let v_bits = u32(v * 16777216.0) << 8u;
    // The row, and where in it, by bisection.
    var row = 0u;
    var first = 0u;
    var end = 65536u;
    for (var stride = GUIDE_ROWS / 2u; stride > 0u; stride >>= 1u) {
        let start = guide[cell.first + (row + stride) * GUIDE_COLUMNS] & 0xffffu;
        let is_past = u_bits >= (start << 8u);
        row = select(row, row + stride, is_past);
        first = select(first, start, is_past);
        end = select(start, end, is_past);
    }
    let in_row = f32(u_bits - (first << 8u)) / f32((end - first) << 8u);
    // The column, by what part of the row's share the second number means.
    let row_share = end - first;
    let chosen = first + multiply_high(v_bits, row_share);
    let rest = f32(v_bits * row_share) * 2.3283064365386963e-10;
    let row_at = cell.first + row * GUIDE_COLUMNS;
    var column = 0u;
    for (var stride = GUIDE_COLUMNS / 2u; stride > 0u; stride >>= 1u) {
        let start = guide[row_at + column + stride] & 0xffffu;
        let is_past = chosen >= start;
        column = select(column, column + stride, is_past);
        first = select(first, start, is_past);
        end = select(start, end, is_past);
    }
    let in_column = (f32(chosen - first) + rest) / f32(end - first);
    let down = (f32(row) + in_row) * (1.0 / f32(GUIDE_ROWS));
    let turns = (f32(column) + in_column) * (1.0 / f32(GUIDE_COLUMNS));
    let circle = sin_cos_turns(turns);
#if SCATTERING
    if cell.is_sphere {
        let wide = 2.0 * sqrt(max(0.0, down * (1.0 - down)));
        return vec3<f32>(wide * circle.y, wide * circle.x, 1.0 - 2.0 * down);
    }
#endif
    let sine = sqrt(down);
    let local = vec3<f32>(sine * circle.y, sine * circle.x, sqrt(max(0.0, 1.0 - down)));
    return frame_to_world(frame_from_normal(cell.axis), local);
}

// Density with which the guide draws a direction, per steradian; it brings nothing below the surface.
fn guide_pdf(cell: GuideCell, surface: Surface, wi: vec3<f32>) -> f32 {
    let frame = frame_from_normal(cell.axis);
    let x = dot(wi, frame.tangent);
    let y = dot(wi, frame.bitangent);
    let cosine = dot(wi, frame.normal);
    if cosine <= 0.0 || !on_wo_side(surface, wi) {
        return 0.0;
    }
    return guide_bin_share(cell, x * x + y * y, x, y) * cosine * INVERSE_PI;
}

// How many times as much as on average the bin of a direction is drawn, by how far it is down from the axis, from 0 to 1, and its place around it.
fn guide_bin_share(cell: GuideCell, down: f32, x: f32, y: f32) -> f32 {
    let signed_turns = atan2_turns(y, x);
    let turns = select(signed_turns, signed_turns + 1.0, signed_turns < 0.0);
    let row = min(u32(down * f32(GUIDE_ROWS)), GUIDE_ROWS - 1u);
    let column = min(u32(turns * f32(GUIDE_COLUMNS)), GUIDE_COLUMNS - 1u);
    let share = guide[cell.first + row * GUIDE_COLUMNS + column] >> 16u;
    return f32(share) * (f32(GUIDE_ROWS * GUIDE_COLUMNS) / 65536.0);
}

#if SCATTERING
// Density with which the guide draws a direction within a medium, per steradian.
fn guide_pdf_in_medium(cell: GuideCell, wi: vec3<f32>) -> f32 {
    return guide_bin_share(cell, clamp(0.5 - 0.5 * wi.z, 0.0, 1.0), wi.x, wi.y) * 0.25 * INVERSE_PI;
}
#endif
