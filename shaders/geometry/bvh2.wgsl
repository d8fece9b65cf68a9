// A binary hierarchy with float boxes, four vec4<u32> a node (src/packed/bvh2.rs):
//   per axis: (low of both children, high of both)
//   (both children's entries, -, -)
#import geometry/entries.wgsl

// Distances to the planes that a ray meets first and last, of both children.
fn crossings(planes: vec4<u32>, origin: f32, inverse_direction: f32) -> vec4<f32> {
    // The difference first: its rounding is a part of itself, so widening by a factor covers it.
    let t = (bitcast<vec4<f32>>(planes) - origin) * inverse_direction;
    return select(t, t.zwxy, inverse_direction < 0.0);
}

fn descend(node: u32, traversal: ptr<function, Traversal>, stack: ptr<function, array<StackEntry, STACK_SIZE>>) -> u32 {
    let origin = (*traversal).ray.origin;
    let inverse_direction = (*traversal).inverse_direction;
    let words = node_words(node);
    let x = crossings(words.w0, origin.x, inverse_direction.x);
    let y = crossings(words.w1, origin.y, inverse_direction.y);
    let z = crossings(words.w2, origin.z, inverse_direction.z);
    let entries = words.w3.xy;
    let near = larger(larger(x, y), larger(z, vec4<f32>(0.0))).xy;
    let far = smaller(smaller(x, y), smaller(z, vec4<f32>((*traversal).hit.t))).zw;
    // A child that does not exist has a box turned inside out.
    let met = near <= far * WIDER;
    let t = select(vec2<f32>(INFINITY_DISTANCE), near, met);
    // The nearer is visited next, the other waits.
    let swap = t.y < t.x;
    let depth = (*traversal).pending.depth;
    (*stack)[depth] = select(entries.y, entries.x, swap);
    (*traversal).pending.depth = depth + select(0u, 1u, all(met));
    return select(FINISHED, select(entries.x, entries.y, swap), any(met));
}
