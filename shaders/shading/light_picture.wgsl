// Rectangles whose points are drawn by what they show: the density lies over the unit square of their texture coordinates.
#import core/layout.wgsl
#import shading/light_record.wgsl
#import shading/warp.wgsl

// Of a light with LIGHT_WARPED.
fn light_warp(light: u32) -> Warp {
    let words = bitcast<vec4<u32>>(light_word(light, 4u));
    let width = words.z & 0xffffu;
    let height = words.z >> 16u;
    return Warp(words.x, words.y, width, height, 32u - countLeadingZeros(max(width, height) - 1u));
}

struct DrawnPlace {
    // Along the edges.
    place: vec2<f32>,
    // Against an even density over the rectangle.
    density: f32,
}

fn draw_shown_place(light: u32, kind_flags: u32, bits_u: u32, bits_v: u32) -> DrawnPlace {
    let warp = light_warp(light);
    let cell = warp_cell(warp, vec2<u32>(bits_u >> 1u, bits_v >> 1u));
    let uv = (vec2<f32>(vec2<u32>(cell.column, cell.row)) + cell.position) / vec2<f32>(vec2<u32>(warp.width, warp.height));
    let u = select(uv.x, 1.0 - uv.x, (kind_flags & LIGHT_REVERSED) != 0u);
    return DrawnPlace(vec2<f32>(u, uv.y), warp_density(warp, cell.column, cell.row));
}

// The density with which a point with these texture coordinates is drawn, against an even one.
fn shown_density(light: u32, uv: vec2<f32>) -> f32 {
    let warp = light_warp(light);
    let size = vec2<u32>(warp.width, warp.height);
    let cell = min(vec2<u32>(max(uv, vec2<f32>(0.0)) * vec2<f32>(size)), size - vec2<u32>(1u));
    return warp_density(warp, cell.x, cell.y);
}
