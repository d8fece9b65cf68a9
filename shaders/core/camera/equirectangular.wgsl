// Angles along both sides of the picture. crates/gpt-scene/src/scene/camera/equirectangular.rs is the same in f64.
#import core/math.wgsl
#import core/parameters.wgsl

// The direction that a place of the view sees: to the right, up, backward; 1.
fn equirectangular_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let turns = view.model[0].xz + place * view.model[0].yw;
    let azimuth = sin_cos_turns(fract(turns.x));
    let elevation = sin_cos_turns(fract(turns.y));
    return vec4<f32>(elevation.y * azimuth.x, elevation.x, -elevation.y * azimuth.y, 1.0);
}
