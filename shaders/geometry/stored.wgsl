// A ray against primitive `index` of the hierarchy. Kinds that it does not hold are left out; planes never are in it.
#import core/math.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#import geometry/shapes.wgsl
#import geometry/placed.wgsl

// Replaces `hit` where primitive `index`, whose record is `words`, is nearer.
fn intersect_stored(ray: PreparedRay, index: u32, words: PrimitiveWords, hit: ptr<function, Hit>) {
#if MOTION
    let placed = placed_primitive(words);
    let p0 = placed.p0;
    let p1 = placed.p1;
    let p2 = placed.p2;
#else
    let p0 = words.w0;
    let p1 = words.w1;
    let p2 = words.w2;
#endif
    let t_max = (*hit).t;
#if ONLY_TRIANGLES_IN_HIERARCHY
    let found = intersect_triangle(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
#else
    let found = intersect_shape(ray, t_max, primitive_kind(p0.w), p0.xyz, p1.xyz, p2.xyz);
#endif
    if found.x > 0.0 {
        *hit = world_hit(found.x, index, found.y, found.z);
        if HAS_INSTANCES {
            (*hit).instance = ray.instance;
        }
    }
}
