// Area lights whose points are sampled by what they emit: the density lies over the unit square that their texture coordinates are unrolled to
// (src/emission_map/unrolled.rs).
#import core/layout.wgsl
#import core/math.wgsl
#import shading/light/record.wgsl
#import shading/warp.wgsl
#import geometry/records.wgsl
#import geometry/motion.wgsl

// The distribution of the points of a light with LIGHT_WARPED.
fn light_warp(light: u32) -> Warp {
    let words = bitcast<vec4<u32>>(light_word(light, 4u));
    let width = words.z & 0xffffu;
    let height = words.z >> 16u;
    return Warp(words.x, words.y, width, height, 32u - countLeadingZeros(max(width, height) - 1u));
}

struct DrawnPlace {
    // Along the edges, or round the axis and along it; of a sphere, u and the height.
    place: vec2<f32>,
    // Against an even density over the area.
    density: f32,
}

fn draw_shown_place(light: u32, kind_flags: u32, bits_u: u32, bits_v: u32) -> DrawnPlace {
    let warp = light_warp(light);
    let cell = warp_cell(warp, vec2<u32>(bits_u >> 1u, bits_v >> 1u));
    let uv = (vec2<f32>(vec2<u32>(cell.column, cell.row)) + cell.position) / vec2<f32>(vec2<u32>(warp.width, warp.height));
    let u = select(uv.x, 1.0 - uv.x, (kind_flags & LIGHT_REVERSED) != 0u);
    return DrawnPlace(vec2<f32>(u, uv.y), warp_density(warp, cell.column, cell.row));
}

// The density with which a point at a place of the square is drawn, against an even one.
fn shown_density(light: u32, place: vec2<f32>) -> f32 {
    let warp = light_warp(light);
    let size = vec2<u32>(warp.width, warp.height);
    let cell = min(vec2<u32>(max(place, vec2<f32>(0.0)) * vec2<f32>(size)), size - vec2<u32>(1u));
    return warp_density(warp, cell.x, cell.y);
}

struct SphereBand {
    // The share of the area that lies below.
    below: f32,
    // The share of the area that the band is, against the share of the square that it is.
    area: f32,
}

// A place in the square as one of a sphere: in a row points are even over the area (src/emission_map/unrolled.rs).
fn sphere_band(light: u32, v: f32) -> SphereBand {
    let rows = f32(light_warp(light).height);
    let row = clamp(floor(v * rows), 0.0, rows - 1.0);
    let border = sin_cos_turns(0.25 * row / rows).x;
    let area = sin_cos_turns(0.25 / rows).x * sin_cos_turns(0.25 * (2.0 * row + 1.0) / rows).x;
    return SphereBand(border * border + (v * rows - row) * area, area * rows);
}

// `shown_density` by a sphere's texture coordinates, per area.
fn shown_density_on_sphere(light: u32, uv: vec2<f32>) -> f32 {
    return shown_density(light, uv) / sphere_band(light, uv.y).area;
}

// The normal of a sphere with attributes from `first` on at a `u`, above such a share of the area: the attributes hold the rows of the rotation into
// its own space.
fn sphere_normal_at(first: u32, u: f32, below: f32) -> vec3<f32> {
    let height = 2.0 * below - 1.0;
    let across = 2.0 * sqrt(max(0.0, below * (1.0 - below)));
    let circle = sin_cos_turns(u);
    let words = attribute_words(first);
    var normal = across * circle.x * words.w0.xyz + height * words.w1.xyz - across * circle.y * words.w2.xyz;
#if MOTION
    let moving = motion_of_attributes(first);
    if moving != NONE {
        normal = motion_at_path_time(moving).linear * normal;
    }
#endif
    return normalize(normal);
}
