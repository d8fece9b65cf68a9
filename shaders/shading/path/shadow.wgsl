// The light that comes along a shadow ray, and what each surface that the ray meets takes of it.
//
// Whatever finds those surfaces (a hierarchy, packets, ray queries, constants) hands each one to `is_blocked_by`, in any order, and stops at the
// first that leaves nothing. Scenes without transparent surfaces stop at the first surface of all.
#import core/layout.wgsl
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl
#import shading/path/transmittance.wgsl

struct Shadow {
    // The distance to the light.
    limit: f32,
    // The share of light that is left behind the surfaces met so far.
    transmittance: Spectrum,
}

fn begin_shadow(limit: f32) -> Shadow {
    return Shadow(limit, WHITE);
}

// Removes the light that the surface keeps which the ray meets at `hit`. True where nothing is left.
fn is_blocked_by(shadow: ptr<function, Shadow>, ray: Ray, hit: Hit) -> bool {
    if HAS_TRANSPARENT_SHADOWS {
        let transmittance = (*shadow).transmittance * hit_transmittance(ray, hit, (*shadow).limit);
        (*shadow).transmittance = transmittance;
        return max_component(transmittance) <= 0.0;
    } else {
        return true;
    }
}

// Removes the light that surfaces keep which are constants of the code: opaque ones first, then the others in the ray's order. True where
// nothing is left.
fn is_blocked_by_constants(shadow: ptr<function, Shadow>, ray: PreparedRay) -> bool {
    var blocked = any_of_constants(ray, (*shadow).limit);
    if HAS_TRANSPARENT_SHADOWS {
        // One call serves all surfaces: drivers copy a function to each of its calls.
        var hit = world_hit(0.0, 0u, 0.0, 0.0);
        while !blocked {
            hit = next_of_transparent_constants(ray, hit, (*shadow).limit);
            if hit.primitive == NONE {
                break;
            }
            blocked = is_blocked_by(shadow, Ray(ray.origin, ray.direction), hit);
        }
    }
    return blocked;
}

// The share of light that comes to the end of a shadow ray.
fn light_through(shadow: Shadow, blocked: bool) -> Spectrum {
    return select(shadow.transmittance, BLACK, blocked);
}
