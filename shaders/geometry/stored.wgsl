// A ray against primitive `index` of the arrays.
#import geometry/primitives.wgsl
#import geometry/scene.wgsl

// Replaces `hit` where primitive `index` is nearer.
fn intersect_stored(ray: PreparedRay, index: u32, hit: ptr<function, Hit>) {
    let p0 = primitives[index * 3u];
    let p1 = primitives[index * 3u + 1u];
    let p2 = primitives[index * 3u + 2u];
    var found = vec3<f32>(-1.0, 0.0, 0.0);
    let t_max = (*hit).t;
#if ONLY_TRIANGLES
    found = intersect_triangle(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
#else
    switch primitive_kind(p0.w) {
#if TRIANGLES
        case KIND_TRIANGLE: {
            found = intersect_triangle(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
        }
#endif
#if QUADS
        case KIND_QUAD: {
            found = intersect_quad(ray, t_max, p0.xyz, p1.xyz, p2.xyz);
        }
#endif
#if SPHERES
        case KIND_SPHERE: {
            found.x = intersect_sphere(ray, t_max, p0.xyz, p1.x);
        }
#endif
#if DISKS
        case KIND_DISK: {
            found.x = intersect_disk(ray, t_max, p0.xyz, p1.xyz, p2.x);
        }
#endif
        default: {
#if PLANES
            found.x = intersect_plane(ray, t_max, p0.xyz, p1.xyz);
#endif
        }
    }
#endif
    if found.x > 0.0 {
        *hit = Hit(found.x, index, found.y, found.z);
    }
}
