// The six sides of a cube. crates/gpt-scene/src/scene/camera/cube_map.rs is the same in f64.
#import core/parameters.wgsl

// The direction that a place of a side sees: to the right, up, backward; 1.
fn cube_map_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let a = place.x * view.model[0].x - 1.0;
    let b = 1.0 - place.y * view.model[0].x;
    var towards = vec3<f32>(-a, b, 1.0);
    switch tile {
        case 0u: { towards = vec3<f32>(1.0, b, a); }
        case 1u: { towards = vec3<f32>(-1.0, b, -a); }
        case 2u: { towards = vec3<f32>(a, 1.0, b); }
        case 3u: { towards = vec3<f32>(a, -1.0, -b); }
        case 4u: { towards = vec3<f32>(a, b, -1.0); }
        default: {}
    }
    return vec4<f32>(normalize(towards), 1.0);
}
