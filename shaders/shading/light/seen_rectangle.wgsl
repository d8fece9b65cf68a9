// Rectangles as they are seen from a point: directions uniform over their solid angle (Ureña, Fajardo and King 2013).
// src/reference/intersect/seen/rectangle.rs does the same, and says how.
#import core/layout.wgsl
#import core/math.wgsl

struct SeenRectangle {
    // Ends of its sides in axes along its edges, the point at their origin.
    low: vec2<f32>,
    high: vec2<f32>,
    // Distance of the rectangle's plane.
    distance: f32,
    // Solid angle, in steradians; 0 where points are sampled by area.
    solid_angle: f32,
    // Begin of the sampled angle, in turns.
    first_turns: f32,
}

// Cosine of the angle between the rectangle's plane and the plane through the point and a side, and its squared sine.
fn rectangle_side(offset: f32, squared_distance: f32) -> vec2<f32> {
    let squared = offset * offset + squared_distance;
    return vec2<f32>(offset / sqrt(squared), squared_distance / squared);
}

// The angle between two such planes, in turns.
fn rectangle_corner(a: vec2<f32>, b: vec2<f32>) -> f32 {
    return atan2_turns(sqrt(a.y + a.x * a.x * b.y), -a.x * b.x);
}

fn see_rectangle(point: vec3<f32>, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> SeenRectangle {
    let size = vec2<f32>(length(edge_u), length(edge_v));
    let x = edge_u / size.x;
    let y = edge_v / size.y;
    let to_corner = corner - point;
    var seen: SeenRectangle;
    seen.low = vec2<f32>(dot(to_corner, x), dot(to_corner, y));
    seen.high = seen.low + size;
    seen.distance = abs(dot(to_corner, cross(x, y)));
    let farthest = max(max(abs(seen.low.x), abs(seen.high.x)), max(abs(seen.low.y), abs(seen.high.y)));
    if seen.distance <= LEAST_RECTANGLE_DISTANCE * farthest {
        return seen;
    }
    let squared_distance = seen.distance * seen.distance;
    let below = rectangle_side(-seen.low.y, squared_distance);
    let right = rectangle_side(seen.high.x, squared_distance);
    let above = rectangle_side(seen.high.y, squared_distance);
    let left = rectangle_side(-seen.low.x, squared_distance);
    let before = rectangle_corner(below, right) + rectangle_corner(right, above);
    seen.first_turns = 1.0 - rectangle_corner(above, left) - rectangle_corner(left, below);
    let solid_angle = TWO_PI * (before - seen.first_turns);
    seen.solid_angle = select(0.0, solid_angle, solid_angle >= LEAST_RECTANGLE_SOLID_ANGLE);
    return seen;
}

// The place along the edges, in [0, 1] x [0, 1], of a point whose direction is uniform over the solid angle.
fn rectangle_place(seen: SeenRectangle, u: f32, v: f32) -> vec2<f32> {
    let squared_distance = seen.distance * seen.distance;
    let sin_cos = sin_cos_turns(seen.first_turns + u * seen.solid_angle * 0.15915494309189534);
    let squared_low = seen.low.y * seen.low.y + squared_distance;
    let b0 = -seen.low.y / sqrt(squared_low);
    let b1 = seen.high.y / sqrt(seen.high.y * seen.high.y + squared_distance);
    let numerator = sin_cos.y * b0 - b1;
    let under_root = numerator * numerator - squared_distance / squared_low * sin_cos.x * sin_cos.x;
    let signed = seen.distance * sin_cos.x * select(-1.0, 1.0, numerator >= 0.0);
    let x = clamp(signed / sqrt(max(under_root, 1.0e-30)), seen.low.x, seen.high.x);
    let across = sqrt(x * x + squared_distance);
    let low_sine = seen.low.y / sqrt(seen.low.y * seen.low.y + across * across);
    let high_sine = seen.high.y / sqrt(seen.high.y * seen.high.y + across * across);
    let sine = low_sine + v * (high_sine - low_sine);
    let y = clamp(sine * across / sqrt(max(1.0 - sine * sine, 1.0e-30)), seen.low.y, seen.high.y);
    return (vec2<f32>(x, y) - seen.low) / (seen.high - seen.low);
}
