// Ideal fisheye lenses. crates/gpt-scene/src/scene/camera/fisheye.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl

// Sine and cosine of the angle of what lies at such a distance from the middle, by the mapping.
fn fisheye_angle(radius: f32) -> vec2<f32> {
    let square = radius * radius;
    if FISHEYE_MAPPING == FISHEYE_EQUIDISTANT {
        return sin_cos_turns(radius);
    } else if FISHEYE_MAPPING == FISHEYE_EQUISOLID {
        return vec2<f32>(2.0 * radius * sqrt(max(1.0 - square, 0.0)), 1.0 - 2.0 * square);
    } else if FISHEYE_MAPPING == FISHEYE_STEREOGRAPHIC {
        return vec2<f32>(2.0 * radius, 1.0 - square) / (1.0 + square);
    } else {
        return vec2<f32>(radius, sqrt(max(1.0 - square, 0.0)));
    }
}

// The direction that a place of the view sees: to the right, up, backward; 1, or 0 outside of the circle.
fn fisheye_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let aside = (place - view.model[0].xy) * view.model[0].z;
    let distance = length(aside);
    let towards = select(vec2<f32>(0.0), aside / distance, distance > 0.0);
    let angle = fisheye_angle(distance * view.model[0].w);
    return vec4<f32>(towards.x * angle.x, -towards.y * angle.x, -angle.y, select(1.0, 0.0, distance > 1.0));
}
