// Closest hit and occlusion by ray queries: the device goes through an acceleration structure of its own (src/gpu/acceleration.rs). It tests
// triangles itself, and asks about the other shapes whose boxes it meets. What it finds is tested again as everywhere else, so that hits
// are the same whatever the device computes.
#import core/layout.wgsl

enable wgpu_ray_query;
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl
#import geometry/records.wgsl
#import geometry/shapes.wgsl
#import geometry/stored.wgsl
#import shading/path/shadow.wgsl

// Instances: triangles, opaque, and boxes. An instance's custom data is its first primitive.
@group(0) @binding(BINDING_ACCELERATION) var acceleration: acceleration_structure;

// Queries for one ray at most. A second one is needed where the device and our own test disagree about a hit at an end of the ray.
const MOST_QUERIES: u32 = 3u;
// By how much of its distance, or of the origin's coordinates, the device's hit may be off.
const DEVICE_ERROR: f32 = 1.0e-6;
// Coordinates of rays that start at 0.
const TINY: f32 = 1.0e-20;

// The nearest of what the structure holds between the distances `after` and before.t; where nothing is, `before`. With
// RAY_FLAG_TERMINATE_ON_FIRST_HIT anything in between. Leaves in `after` where to look for what comes behind it.
fn hit_by_query(ray: PreparedRay, before: Hit, after: ptr<function, f32>, flags: u32) -> Hit {
    var hit = before;
    let passed = *after;
    var t_min = passed;
    var by_device = 0.0;
    var t_max = before.t;
    var query: ray_query;
    for (var count = 0u; count < MOST_QUERIES && t_min < t_max; count++) {
        rayQueryInitialize(&query, acceleration, RayDesc(flags, 0xffu, t_min, t_max, ray.origin, ray.direction));
        while rayQueryProceed(&query) {
#if !ONLY_TRIANGLES_IN_HIERARCHY
            // A shape's box is met. Triangles never come here.
            let candidate = rayQueryGetCandidateIntersection(&query);
            let shape = candidate.instance_custom_data + candidate.primitive_index;
            var met = no_hit(min(hit.t, t_max));
            intersect_stored(ray, shape, primitive_words(shape), &met);
            // Each shape is met at its nearest point alone, which may be one that was passed.
            if met.primitive != NONE && met.t >= passed {
                let nearest = rayQueryGetCommittedIntersection(&query);
                if nearest.kind == RAY_QUERY_INTERSECTION_NONE || met.t < nearest.t {
                    hit = met;
                    // A variable of its own, which naga 30 needs there.
                    let t = met.t;
                    // The device may be told of nothing outside the query's range.
                    if t >= t_min {
                        rayQueryGenerateIntersection(&query, t);
                    }
                }
            }
#endif
        }
#if TRIANGLES_IN_HIERARCHY
        let committed = rayQueryGetCommittedIntersection(&query);
        if committed.kind != RAY_QUERY_INTERSECTION_TRIANGLE {
            break;
        }
        let primitive = committed.instance_custom_data + committed.primitive_index;
        let words = primitive_words(primitive);
        let own = intersect_triangle(ray, INFINITY_DISTANCE, words.w0.xyz, words.w1.xyz, words.w2.xyz);
        var found = world_hit(own.x, primitive, own.y, own.z);
        if own.x < 0.0 {
            let behind = min(own.y, own.z) >= 0.0 && own.y + own.z <= 1.0;
            let places = abs(ray.origin);
            let touching = DEVICE_ERROR * max(max(places.x, TINY), max(places.y, places.z));
            if behind || committed.t < touching {
                // The surface that the ray leaves, or one that touches it there, is not met. What comes after it may be.
                t_min = max(touching, committed.t * (1.0 + DEVICE_ERROR));
                continue;
            }
            // An edge that the device counts to this triangle, and our test to its neighbour.
            found = world_hit(committed.t, primitive, committed.barycentrics.x, committed.barycentrics.y);
        }
        if found.t < hit.t {
            hit = found;
            by_device = committed.t;
            break;
        }
        // The hit lies at the ray's end: something may be in front of it.
        t_max = min(t_max, committed.t) * (1.0 - DEVICE_ERROR);
#else
        break;
#endif
    }
    // Behind both distances, ours and the device's, which would else meet the same primitive for ever.
    *after = max(max(hit.t, by_device) * (1.0 + DEVICE_ERROR), TINY);
    return hit;
}

// The constants first: what they meet shortens the way through the structure.
fn closest_hit(traced: Ray, t_max: f32) -> Hit {
    let ray = prepare_ray(traced);
    var hit = no_hit(t_max);
    closest_of_constants(ray, &hit);
    var after = 0.0;
    return hit_by_query(ray, hit, &after, RAY_FLAG_NONE);
}

// The share of light that comes through all that lies between the origin and t_max.
fn shadow_transmittance(traced: Ray, t_max: f32) -> Spectrum {
    let ray = prepare_ray(traced);
    var shadow = begin_shadow(t_max);
    var blocked = is_blocked_by_constants(&shadow, ray);
    // Transparent surfaces are met one after the other, nearest first, because the device's own order may come to one twice.
    let flags = select(RAY_FLAG_TERMINATE_ON_FIRST_HIT, RAY_FLAG_NONE, HAS_TRANSPARENT_SHADOWS);
    var after = 0.0;
    while !blocked {
        let hit = hit_by_query(ray, no_hit(t_max), &after, flags);
        if hit.primitive == NONE {
            break;
        }
        blocked = is_blocked_by(&shadow, traced, hit);
    }
    return light_through(shadow, blocked);
}
