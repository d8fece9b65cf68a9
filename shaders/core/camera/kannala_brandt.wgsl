// A fisheye lens by a polynomial. crates/gpt-scene/src/scene/camera/kannala_brandt.rs is the same in f64, with the formula's source.
#import core/camera/rising.wgsl
#import core/math.wgsl
#import core/parameters.wgsl

// The angle in radians that is shown at a distance from the principal point.
fn angle_shown_at(distance: f32) -> f32 {
    let k = view.model[1];
    var search = search_up_to(view.model[3].x, distance);
    for (var step = 0u; step < 64u && !search.found; step++) {
        let at = search.at;
        let s = at * at;
        let above = at * (1.0 + s * (k.x + s * (k.y + s * (k.z + s * k.w)))) - distance;
        let slope = 1.0 + s * (3.0 * k.x + s * (5.0 * k.y + s * (7.0 * k.z + s * 9.0 * k.w)));
        search = search_step(search, above, slope);
    }
    return search.at;
}

// The direction that a place of the view sees: to the right, up, backward; 1, or 0 where the lens shows nothing there.
fn kannala_brandt_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let shown = view.model[0].zw + place * view.model[0].xy;
    let distance = length(shown);
    let towards = select(vec2<f32>(0.0), shown / distance, distance > 0.0);
    let angle = sin_cos_turns(angle_shown_at(distance) / TWO_PI);
    return vec4<f32>(towards.x * angle.x, -towards.y * angle.x, -angle.y, select(0.0, 1.0, distance <= view.model[3].y));
}
