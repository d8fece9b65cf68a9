// Light from outside the scene: its radiance, and how directions to it are drawn. src/reference/environment.rs does the same.
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl
#import geometry/scene.wgsl

struct EnvironmentSample {
    wi: vec3<f32>,
    radiance: vec3<f32>,
    // Per steradian.
    pdf_solid_angle: f32,
}

#if ENVIRONMENT_MAP
// (u, v) of a direction on the map: u = atan2(x, -z) / 2π after turning back the rotation, v = acos(y) / π from the top.
fn map_coordinates(wi: vec3<f32>) -> vec2<f32> {
    return vec2<f32>(fract(atan2_turns(wi.x, -wi.z) + view.environment.w), 2.0 * atan2_turns(length(wi.xz), wi.y));
}

fn map_texel(x: i32, y: i32) -> vec3<f32> {
    let width = i32(ENVIRONMENT_WIDTH);
    let column = select(select(x, x - width, x >= width), x + width, x < 0);
    let row = clamp(y, 0, i32(ENVIRONMENT_HEIGHT) - 1);
    let index = ENVIRONMENT_FIRST_TEXEL + 3u * u32(row * width + column);
    return vec3<f32>(texels[index], texels[index + 1u], texels[index + 2u]);
}

// Bilinear; the map goes round at its sides and ends at the poles.
fn map_radiance(uv: vec2<f32>) -> vec3<f32> {
    let position = uv * vec2<f32>(f32(ENVIRONMENT_WIDTH), f32(ENVIRONMENT_HEIGHT)) - 0.5;
    let corner = floor(position);
    let blend = position - corner;
    let x = i32(corner.x);
    let y = i32(corner.y);
    let upper = mix(map_texel(x, y), map_texel(x + 1, y), blend.x);
    let lower = mix(map_texel(x, y + 1), map_texel(x + 1, y + 1), blend.x);
    return mix(upper, lower, blend.y);
}

// From a density over the unit square of (u, v) to one per steradian.
fn map_pdf_per_steradian(sine: f32) -> f32 {
    return 1.0 / (2.0 * PI * PI * max(sine, 1.0e-6));
}

fn map_pdf(wi: vec3<f32>) -> f32 {
    let uv = map_coordinates(wi);
    let column = min(u32(uv.x * f32(ENVIRONMENT_GRID_WIDTH)), ENVIRONMENT_GRID_WIDTH - 1u);
    let row = min(u32(uv.y * f32(ENVIRONMENT_GRID_HEIGHT)), ENVIRONMENT_GRID_HEIGHT - 1u);
    return map_cell_density(column, row) * map_pdf_per_steradian(length(wi.xz));
}

// Density over the unit square in a cell of the grid.
fn map_cell_density(column: u32, row: u32) -> f32 {
    return texels[ENVIRONMENT_FIRST_DENSITY + row * ENVIRONMENT_GRID_WIDTH + column];
}

fn map_split(index: u32) -> u32 {
    return bitcast<u32>(texels[index]);
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

fn sample_map(bits_u: u32, bits_v: u32) -> EnvironmentSample {
    let cell = map_cell(vec2<u32>(bits_u >> 1u, bits_v >> 1u));
    let uv = vec2<f32>(
        (f32(cell.column) + cell.position.x) / f32(ENVIRONMENT_GRID_WIDTH),
        (f32(cell.row) + cell.position.y) / f32(ENVIRONMENT_GRID_HEIGHT)
    );
    let polar = sin_cos_turns(0.5 * uv.y);
    let azimuth = sin_cos_turns(fract(uv.x - view.environment.w));
    let pdf = map_cell_density(cell.column, cell.row) * map_pdf_per_steradian(polar.x);
    return EnvironmentSample(vec3<f32>(polar.x * azimuth.x, polar.y, -polar.x * azimuth.y), map_radiance(uv), pdf);
}
#endif

#if SKY
fn sky_radiance(wi: vec3<f32>) -> vec3<f32> {
    return select(view.sky_ground.xyz, mix(view.environment.xyz, view.sky_zenith.xyz, wi.y), wi.y >= 0.0);
}

fn sky_pdf(radiance: vec3<f32>) -> f32 {
    return luminance(radiance) * view.sky_ground.w;
}

// In proportion to luminance: the half first, then, above, a height whose density is linear.
fn sample_sky(u: f32, v: f32) -> EnvironmentSample {
    let share = view.sky_zenith.w;
    let upper = u < share;
    let horizon = luminance(view.environment.xyz);
    let zenith = luminance(view.sky_zenith.xyz);
    var height = (u - 1.0) / (1.0 - share);
    if upper {
        let xi = u / share;
        // The root of h y + (z - h) y^2 / 2 = xi (h + z) / 2 that does not cancel.
        let root = horizon + sqrt(max(0.0, horizon * horizon + xi * (zenith * zenith - horizon * horizon)));
        height = 0.0;
        if root > 0.0 {
            height = min(xi * (horizon + zenith) / root, 1.0);
        }
    }
    let sine = sqrt(max(0.0, (1.0 - height) * (1.0 + height)));
    let circle = sin_cos_turns(v);
    let radiance = select(view.sky_ground.xyz, mix(view.environment.xyz, view.sky_zenith.xyz, height), upper);
    return EnvironmentSample(vec3<f32>(sine * circle.y, height, sine * circle.x), radiance, sky_pdf(radiance));
}
#endif

fn environment_radiance(wi: vec3<f32>) -> vec3<f32> {
#if ENVIRONMENT_MAP
    return map_radiance(map_coordinates(wi));
#else
#if SKY
    return sky_radiance(wi);
#else
    return view.environment.xyz;
#endif
#endif
}

// Density of sample_environment, per steradian.
fn environment_itself_pdf(wi: vec3<f32>) -> f32 {
#if ENVIRONMENT_MAP
    return map_pdf(wi);
#else
#if SKY
    return sky_pdf(sky_radiance(wi));
#else
    return 0.25 * INVERSE_PI;
#endif
#endif
}

fn sample_environment(bits_u: u32, bits_v: u32) -> EnvironmentSample {
#if ENVIRONMENT_MAP
    return sample_map(bits_u, bits_v);
#else
    let u = uniform_float(bits_u);
    let v = uniform_float(bits_v);
#if SKY
    return sample_sky(u, v);
#else
    let cosine = 1.0 - 2.0 * u;
    let sine = sqrt(max(0.0, (1.0 - cosine) * (1.0 + cosine)));
    let circle = sin_cos_turns(v);
    let wi = vec3<f32>(sine * circle.y, sine * circle.x, cosine);
    return EnvironmentSample(wi, view.environment.xyz, 0.25 * INVERSE_PI);
#endif
#endif
}
