// Pictures that lights throw.
#import core/math.wgsl

// Point where the line that arrives along `wi` crosses the plane at distance 1 before the light, which shines
// along `axis`: to the right and up, as seen from the light. `turn` has the cosine and the sine that
// `picture_turn` of crates/gpt-scene/src/scene/light/projected.rs gives.
fn picture_place(wi: vec3<f32>, axis: vec3<f32>, turn: vec2<f32>) -> vec2<f32> {
    let frame = frame_from_normal(axis);
    let along = vec2<f32>(dot(wi, frame.tangent), dot(wi, frame.bitangent)) / dot(wi, axis);
    return vec2<f32>(turn.x * along.x + turn.y * along.y, turn.y * along.x - turn.x * along.y);
}
