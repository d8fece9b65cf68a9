// An upright cylinder, unrolled. crates/gpt-scene/src/scene/camera/cylindrical.rs is the same in f64.
#import core/math.wgsl
#import core/parameters.wgsl

// The direction that a place of the view sees: to the right, up, backward; 1.
fn cylindrical_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let on_cylinder = view.model[0].xz + place * view.model[0].yw;
    let azimuth = sin_cos_turns(fract(on_cylinder.x));
    return vec4<f32>(azimuth.x, on_cylinder.y, -azimuth.y, 1.0);
}
