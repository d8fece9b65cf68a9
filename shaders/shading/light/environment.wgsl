// A lat-long map: its radiance, and how directions to it are drawn. src/reference/lights/environment.rs does the same.
#import core/math.wgsl
#import core/parameters.wgsl
#import geometry/texels.wgsl
#import shading/environment_sample.wgsl

// (u, v) of a direction on the map: u = atan2(x, -z) / 2π after turning back the rotation, v = acos(y) / π from the top.
fn map_coordinates(wi: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(fract(atan2_turns(wi.x, -wi.z) + view.environment[0].w), 2.0 * atan2_turns(length(wi.xz), wi.y));
}

fn map_texel(x: i32, y: i32) -> vec3<f32> {
    let width = i32(ENVIRONMENT_WIDTH);
    let column = select(select(x, x - width, x >= width), x + width, x < 0);
    let row = clamp(y, 0, i32(ENVIRONMENT_HEIGHT) - 1);
    let index = ENVIRONMENT_FIRST_TEXEL + 3u * u32(row * width + column);
    return vec3<f32>(texel_float(index), texel_float(index + 1u), texel_float(index + 2u));
}

// The first and the last row lie half a row from the poles, or on them.
fn map_row(v: f32) -> f32 {
    if ENVIRONMENT_ROWS_TO_POLES != 0u {
        return v * f32(ENVIRONMENT_HEIGHT - 1u);
    }
    return v * f32(ENVIRONMENT_HEIGHT) - 0.5;
}

// Bilinear; the map goes round at its sides and ends at the poles.
fn map_radiance(uv: vec2<f32>) -> vec3<f32> {
    let position = vec2<f32>(uv.x * f32(ENVIRONMENT_WIDTH) - 0.5, map_row(uv.y));
    let corner = floor(position);
    let blend = position - corner;
    let x = i32(corner.x);
    let y = i32(corner.y);
    let upper = mix(map_texel(x, y), map_texel(x + 1, y), blend.x);
    let lower = mix(map_texel(x, y + 1), map_texel(x + 1, y + 1), blend.x);
    return mix(upper, lower, blend.y);
}

fn environment_radiance(wi: vec3<f32>) -> vec3<f32> {
    return map_radiance(map_coordinates(wi));
}

// From a density over the unit square of (u, v) to one per steradian.
fn map_pdf_per_steradian(sine: f32) -> f32 {
    return 1.0 / (2.0 * PI * PI * max(sine, 1.0e-6));
}

// Density of sample_environment, per steradian.
fn environment_pdf(wi: vec3<f32>) -> f32 {
    let uv = map_coordinates(wi);
    let column = min(u32(uv.x * f32(ENVIRONMENT_GRID_WIDTH)), ENVIRONMENT_GRID_WIDTH - 1u);
    let row = min(u32(uv.y * f32(ENVIRONMENT_GRID_HEIGHT)), ENVIRONMENT_GRID_HEIGHT - 1u);
    return map_cell_density(column, row) * map_pdf_per_steradian(length(wi.xz));
}

// Density over the unit square in a cell of the grid.
fn map_cell_density(column: u32, row: u32) -> f32 {
    return texel_float(ENVIRONMENT_FIRST_DENSITY + row * ENVIRONMENT_GRID_WIDTH + column);
}

fn map_split(index: u32) -> u32 {
    return texel_word(index);
}

struct MapCell {
    column: u32,
    row: u32,
    // Where in the cell the point lies, in (0, 1) x (0, 1).
    position: vec2<f32>,
}

// The cell that a point of the primary square, 2^31 points a side, is warped to: down a quadtree, at each node first to the left or the
// right column of children, then up or down in it. Nothing but comparisons of integers: the same on every device.
fn map_cell(point: vec2<u32>) -> MapCell {
    // The node's rectangle of the primary square, and its place in its level.
    var low = vec2<u32>(0u);
    var high = vec2<u32>(0x80000000u);
    var place = vec2<u32>(0u);
    var first = ENVIRONMENT_FIRST_NODE;
    for (var level = ENVIRONMENT_QUADTREE_LEVELS; level > 0u; level--) {
        let round_up = (1u << level) - 1u;
        let columns = (ENVIRONMENT_GRID_WIDTH + round_up) >> level;
        let rows = (ENVIRONMENT_GRID_HEIGHT + round_up) >> level;
        let node = first + 3u * (place.y * columns + place.x);
        let split_u = map_split(node);
        let right = point.x >= split_u;
        let split_v = map_split(node + select(1u, 2u, right));
        let split = vec2<u32>(split_u, split_v);
        let second = vec2<bool>(right, point.y >= split_v);
        low = select(low, split, second);
        high = select(split, high, second);
        place = 2u * place + select(vec2<u32>(0u), vec2<u32>(1u), second);
        first += 3u * columns * rows;
    }
    return MapCell(place.x, place.y, (vec2<f32>(point - low) + 0.5) / vec2<f32>(high - low));
}

fn sample_environment(bits_u: u32, bits_v: u32) -> EnvironmentSample {
    let cell = map_cell(vec2<u32>(bits_u >> 1u, bits_v >> 1u));
    let uv = vec2<f32>(
        (f32(cell.column) + cell.position.x) / f32(ENVIRONMENT_GRID_WIDTH),
        (f32(cell.row) + cell.position.y) / f32(ENVIRONMENT_GRID_HEIGHT)
    );
    let polar = sin_cos_turns(0.5 * uv.y);
    let azimuth = sin_cos_turns(fract(uv.x - view.environment[0].w));
    let pdf = map_cell_density(cell.column, cell.row) * map_pdf_per_steradian(polar.x);
    return EnvironmentSample(vec3<f32>(polar.x * azimuth.x, polar.y, -polar.x * azimuth.y), map_radiance(uv), pdf);
}
