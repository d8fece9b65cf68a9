// Directions as places on the octahedron |x| + |y| + |z| = 1, the lower half of which is folded outward around the upper one.

// The direction at a place of [-1, 1] x [-1, 1], of length 1.
fn octahedron_direction(place: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(place.x) - abs(place.y);
    let over_edge = (1.0 - abs(place.yx)) * select(vec2<f32>(-1.0), vec2<f32>(1.0), place >= vec2<f32>(0.0));
    return normalize(vec3<f32>(select(over_edge, place, z >= 0.0), z));
}
