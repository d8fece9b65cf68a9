// Triangles as they are seen from a point: directions uniform over their solid angle (Arvo 1995, Peters 2021).
// src/reference/intersect/seen/triangle.rs does the same, and says how.
#import core/layout.wgsl
#import core/math.wgsl

// Its corners are the directions a, b and c; e is perpendicular to a, on the arc from a to c.
struct SeenTriangle {
    to_corner: vec3<f32>,
    // Distances of a, b and c.
    distances: vec3<f32>,
    // Tangent of half the angle between a and c.
    tangent: f32,
    // 1 + a·b.
    one_and_cosine: f32,
    // |a·(b x e)|.
    sine: f32,
    // b·e.
    cosine: f32,
    // Half the solid angle.
    half_turns: f32,
    // In steradians; 0 where its points are drawn by area.
    solid_angle: f32,
}

// Tangent of half the angle with this sine and cosine, both times `length`.
fn half_angle_tangent(sine: f32, cosine: f32, length: f32) -> f32 {
    let obtuse = cosine < 0.0;
    return select(sine, length - cosine, obtuse) / select(length + cosine, sine, obtuse);
}

fn see_triangle(point: vec3<f32>, corner: vec3<f32>, edge_u: vec3<f32>, edge_v: vec3<f32>) -> SeenTriangle {
    var seen: SeenTriangle;
    seen.to_corner = corner - point;
    let to_b = seen.to_corner + edge_u;
    seen.distances = vec3<f32>(length(seen.to_corner), length(to_b), length(seen.to_corner + edge_v));
    let a = seen.to_corner / seen.distances.x;
    let height = abs(dot(a, cross(edge_u, edge_v)));
    let least = LEAST_TRIANGLE_SHARE * max_coordinate(seen.distances) * length(edge_u) * length(edge_v);
    if !(seen.distances.x * height > least) {
        return seen;
    }
    let along_a = dot(edge_v, a);
    let across_a = edge_v - along_a * a;
    let across = length(across_a);
    seen.tangent = half_angle_tangent(across, seen.distances.x + along_a, seen.distances.z);
    let twice_middle = a + to_b / seen.distances.y;
    seen.one_and_cosine = 0.5 * dot(twice_middle, twice_middle);
    let scale = 1.0 / (across * seen.distances.y);
    seen.sine = height * scale;
    seen.cosine = dot(edge_u, across_a) * scale;
    seen.half_turns = atan2_turns(seen.tangent * seen.sine, seen.one_and_cosine + seen.tangent * seen.cosine);
    let solid_angle = 2.0 * TWO_PI * seen.half_turns;
    seen.solid_angle = select(0.0, solid_angle, solid_angle >= LEAST_TRIANGLE_SOLID_ANGLE);
    return seen;
}

// How far along an edge the direction meets it that is at an angle from the edge's beginning, which is seen under `whole`: tangents of
// their halves. `begin` and `end` are the distances of the edge's ends.
fn share_of_edge(begin: f32, end: f32, whole: f32, part: f32) -> f32 {
    let near = begin * part * (1.0 + whole * whole);
    let far = end * (whole - part) * (1.0 + whole * part);
    return near / (near + far);
}

// The numbers with which `sample_triangle` draws the point that these draw uniformly over the solid angle.
fn triangle_numbers(seen: SeenTriangle, edge_u: vec3<f32>, edge_v: vec3<f32>, u: f32, v: f32) -> vec2<f32> {
    let sin_cos = sin_cos_turns(v * seen.half_turns);
    let beside = sin_cos.y * seen.sine - sin_cos.x * seen.cosine;
    let sliding = sin_cos.x * seen.one_and_cosine / max(beside, 1.0e-37);
    let along_edge = share_of_edge(seen.distances.x, seen.distances.z, seen.tangent, min(sliding, seen.tangent));
    let b = (seen.to_corner + edge_u) / seen.distances.y;
    let end = seen.to_corner + along_edge * edge_v;
    let to_end = length(end);
    let whole = half_angle_tangent(length(cross(b, along_edge * edge_v - edge_u)), dot(b, end), to_end);
    let part = whole * sqrt(u / (1.0 + (1.0 - u) * whole * whole));
    let along_arc = share_of_edge(seen.distances.y, to_end, whole, part);
    return vec2<f32>(along_arc * along_arc, along_edge);
}
