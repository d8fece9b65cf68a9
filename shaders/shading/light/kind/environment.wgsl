// A lat-long map: its radiance, and how directions to it are drawn. src/reference/lights/environment.rs does the same.
#import core/math.wgsl
#import core/parameters.wgsl
#import geometry/texels.wgsl
#import shading/light/environment_sample.wgsl
#import shading/warp.wgsl

// A direction in the map's space. The view has the axes of that space in the world.
fn to_map(wi: vec3<f32>) -> vec3<f32> {
#if ENVIRONMENT_TURNED
    return vec3<f32>(dot(view.environment[0].xyz, wi), dot(view.environment[1].xyz, wi), dot(view.environment[2].xyz, wi));
#else
    return wi;
#endif
}

// A direction in the world.
fn from_map(direction: vec3<f32>) -> vec3<f32> {
#if ENVIRONMENT_TURNED
    let axes = mat3x3<f32>(view.environment[0].xyz, view.environment[1].xyz, view.environment[2].xyz);
    return axes * direction;
#else
    return direction;
#endif
}

// (u, v) of a direction in the map's space: u = atan2(x, -z) / 2π after turning back the rotation, v = acos(y) / π from the top.
fn map_coordinates(wi: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(fract(atan2_turns(wi.x, -wi.z) + view.environment[0].w), 2.0 * atan2_turns(length(wi.xz), wi.y));
}

fn map_texel(x: i32, y: i32) -> Spectrum {
    let width = i32(ENVIRONMENT_WIDTH);
    let column = select(select(x, x - width, x >= width), x + width, x < 0);
    let row = clamp(y, 0, i32(ENVIRONMENT_HEIGHT) - 1);
    let index = ENVIRONMENT_FIRST_TEXEL + 3u * u32(row * width + column);
    return Spectrum(texel_float(index), texel_float(index + 1u), texel_float(index + 2u));
}

// The first and the last row lie half a row from the poles, or on them.
fn map_row(v: f32) -> f32 {
    if ENVIRONMENT_ROWS_TO_POLES != 0u {
        return v * f32(ENVIRONMENT_HEIGHT - 1u);
    }
    return v * f32(ENVIRONMENT_HEIGHT) - 0.5;
}

// Bilinear; the map goes round at its sides and ends at the poles.
fn map_radiance(uv: vec2<f32>) -> Spectrum {
    let position = vec2<f32>(uv.x * f32(ENVIRONMENT_WIDTH) - 0.5, map_row(uv.y));
    let corner = floor(position);
    let blend = position - corner;
    let x = i32(corner.x);
    let y = i32(corner.y);
    let upper = mix(map_texel(x, y), map_texel(x + 1, y), blend.x);
    let lower = mix(map_texel(x, y + 1), map_texel(x + 1, y + 1), blend.x);
    return mix(upper, lower, blend.y);
}

fn environment_radiance(wi: vec3<f32>) -> Spectrum {
    return map_radiance(map_coordinates(to_map(wi)));
}

// From a density over the unit square of (u, v) to one per steradian.
fn map_pdf_per_steradian(sine: f32) -> f32 {
    return 1.0 / (2.0 * PI * PI * max(sine, 1.0e-6));
}

// Density of sample_environment, per steradian.
fn environment_pdf(wi: vec3<f32>) -> f32 {
    let direction = to_map(wi);
    let uv = map_coordinates(direction);
    let column = min(u32(uv.x * f32(ENVIRONMENT_GRID_WIDTH)), ENVIRONMENT_GRID_WIDTH - 1u);
    let row = min(u32(uv.y * f32(ENVIRONMENT_GRID_HEIGHT)), ENVIRONMENT_GRID_HEIGHT - 1u);
    return warp_density(map_warp(), column, row) * map_pdf_per_steradian(length(direction.xz));
}

fn map_warp() -> Warp {
    return Warp(
        ENVIRONMENT_FIRST_NODE, ENVIRONMENT_FIRST_DENSITY, ENVIRONMENT_GRID_WIDTH, ENVIRONMENT_GRID_HEIGHT, ENVIRONMENT_QUADTREE_LEVELS
    );
}

fn sample_environment(bits_u: u32, bits_v: u32) -> EnvironmentSample {
    let cell = warp_cell(map_warp(), vec2<u32>(bits_u >> 1u, bits_v >> 1u));
    let uv = vec2<f32>(
        (f32(cell.column) + cell.position.x) / f32(ENVIRONMENT_GRID_WIDTH),
        (f32(cell.row) + cell.position.y) / f32(ENVIRONMENT_GRID_HEIGHT)
    );
    let polar = sin_cos_turns(0.5 * uv.y);
    let azimuth = sin_cos_turns(fract(uv.x - view.environment[0].w));
    let pdf = warp_density(map_warp(), cell.column, cell.row) * map_pdf_per_steradian(polar.x);
    let direction = vec3<f32>(polar.x * azimuth.x, polar.y, -polar.x * azimuth.y);
    return EnvironmentSample(from_map(direction), map_radiance(uv), pdf);
}
