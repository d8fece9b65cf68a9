// A ray against primitive `index` of the hierarchy. Kinds that it does not hold are left out; planes never are in it.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/primitives.wgsl
#import geometry/records.wgsl
#import geometry/scene.wgsl
#if MOTION
#import geometry/motion.wgsl
#endif

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
    var found = vec3<f32>(-1.0, 0.0, 0.0);
    let t_max = (*hit).t;
#if ONLY_TRIANGLES_IN_HIERARCHY
    found = intersect_triangle(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
#else
    switch primitive_kind(p0.w) {
#if TRIANGLES_IN_HIERARCHY
        case KIND_TRIANGLE: {
            found = intersect_triangle(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
        }
#endif
#if QUADS_IN_HIERARCHY
        case KIND_QUAD: {
            found = intersect_quad(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
        }
#endif
#if SPHERES_IN_HIERARCHY
        case KIND_SPHERE: {
            found.x = intersect_sphere(ray, t_max, p0.xyz, p1.x);
        }
#endif
        default: {
#if DISKS_IN_HIERARCHY
            found.x = intersect_disk(ray, t_max, p0.xyz, p1.xyz, p2.x);
#endif
        }
    }
#endif
    if found.x > 0.0 {
        *hit = Hit(found.x, index, found.y, found.z);
    }
}
