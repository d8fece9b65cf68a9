// A fisheye lens by a polynomial. crates/gpt-scene/src/scene/camera/kannala_brandt.rs is the same in f64, with the formula's source.
#import core/math.wgsl
#import core/parameters.wgsl

// The angle in radians that is shown at a distance from the principal point: Newton's method between two angles that enclose it.
fn angle_shown_at(distance: f32) -> f32 {
    let k = view.model[1];
    var low = 0.0;
    var high = view.model[3].x;
    var at = min(distance, high);
    for (var step = 0u; step < 64u; step++) {
        let s = at * at;
        let found = at * (1.0 + s * (k.x + s * (k.y + s * (k.z + s * k.w)))) - distance;
        if found > 0.0 {
            high = at;
        } else {
            low = at;
        }
        let slope = 1.0 + s * (3.0 * k.x + s * (5.0 * k.y + s * (7.0 * k.z + s * 9.0 * k.w)));
        var next = 0.5 * (low + high);
        if slope > 0.0 {
            let newton = at - found / slope;
            next = select(next, newton, newton >= low && newton <= high);
        }
        let change = abs(next - at);
        at = next;
        if change <= 1.2e-7 * at {
            break;
        }
    }
    return at;
}

// The direction that a place of the view sees: to the right, up, backward; 1, or 0 where the lens shows nothing there.
fn kannala_brandt_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let shown = view.model[0].zw + place * view.model[0].xy;
    let distance = length(shown);
    let towards = select(vec2<f32>(0.0), shown / distance, distance > 0.0);
    let angle = sin_cos_turns(angle_shown_at(distance) / TWO_PI);
    return vec4<f32>(towards.x * angle.x, -towards.y * angle.x, -angle.y, select(0.0, 1.0, distance <= view.model[3].y));
}
