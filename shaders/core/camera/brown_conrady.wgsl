// A perspective that a lens distorts. crates/gpt-scene/src/scene/camera/brown_conrady.rs is the same in f64, with the formula's source.
#import core/camera/rising.wgsl
#import core/parameters.wgsl

// How near to the place its direction must be shown, on the plane at distance 1.
const LENS_TOLERANCE: f32 = 2e-6;

// The factor d of the radial part, and how it changes with the squared radius.
fn radial_factor(square: f32) -> vec2<f32> {
    let over = view.model[1];
    let under = view.model[2];
    let a = 1.0 + square * (over.x + square * (over.y + square * over.z));
    let b = 1.0 + square * (over.w + square * (under.x + square * under.y));
    let a_slope = over.x + square * (2.0 * over.y + square * 3.0 * over.z);
    let b_slope = over.w + square * (2.0 * under.x + square * 3.0 * under.y);
    return vec2<f32>(a / b, (a_slope - a / b * b_slope) / b);
}

// The radius that is shown at a distance from the axis at which the radial part has a value.
fn radius_shown_at(distance: f32) -> f32 {
    var search = search_up_to(view.model[3].x, distance);
    for (var step = 0u; step < 64u && !search.found; step++) {
        let at = search.at;
        let d = radial_factor(at * at);
        search = search_step(search, at * d.x - distance, d.x + 2.0 * at * at * d.y);
    }
    return search.at;
}

// The place at which a point of the plane at distance 1 is shown on it (x, y).
fn shown_by_lens(point: vec2<f32>) -> vec2<f32> {
    let p = view.model[2].zw;
    let square = dot(point, point);
    let bent = vec2<f32>(p.y, p.x) * (square + 2.0 * point * point) + 2.0 * p * point.x * point.y;
    return point * radial_factor(square).x + bent;
}

// The derivative of that: xx, xy = yx, yy.
fn slope_of_lens(point: vec2<f32>) -> vec3<f32> {
    let p = view.model[2].zw;
    let d = radial_factor(dot(point, point));
    return vec3<f32>(
        d.x + 2.0 * d.y * point.x * point.x + 2.0 * p.x * point.y + 6.0 * p.y * point.x,
        2.0 * d.y * point.x * point.y + 2.0 * p.x * point.x + 2.0 * p.y * point.y,
        d.x + 2.0 * d.y * point.y * point.y + 6.0 * p.x * point.y + 2.0 * p.y * point.x
    );
}

// The direction that a place of the view sees: to the right, up, backward; 1, or 0 where the lens shows nothing there.
fn brown_conrady_direction(place: vec2<f32>, tile: u32) -> vec4<f32> {
    let shown = view.model[0].zw + place * view.model[0].xy;
    let distance = length(shown);
    let end = view.model[3].x;
    let towards = select(vec2<f32>(1.0, 0.0), shown / distance, distance > 0.0);
    let is_within = distance <= view.model[3].y;
    var point = select(end, radius_shown_at(distance), is_within) * towards;
    var sees = is_within;
    if any(view.model[2].zw != vec2<f32>(0.0)) {
        for (var step = 0u; step < 20u; step++) {
            let slope = slope_of_lens(point);
            let determinant = slope.x * slope.z - slope.y * slope.y;
            if determinant <= 0.0 {
                break;
            }
            let off = shown_by_lens(point) - shown;
            point -= vec2<f32>(slope.z * off.x - slope.y * off.y, slope.x * off.y - slope.y * off.x) / determinant;
            let radius = length(point);
            point *= select(1.0, end / radius, radius > end);
            if dot(off, off) <= 1e-14 {
                break;
            }
        }
        let slope = slope_of_lens(point);
        let off = length(shown_by_lens(point) - shown);
        sees = off <= LENS_TOLERANCE * (1.0 + distance) && slope.x * slope.z - slope.y * slope.y > 0.0;
    }
    return vec4<f32>(point.x, -point.y, -1.0, select(0.0, 1.0, sees));
}
