// The light that comes along a shadow ray, and what each surface that the ray meets takes of it.
//
// Whatever finds those surfaces (a hierarchy, packets, ray queries, constants) hands each one to `is_blocked_by`, in any order, and stops at the
// first that leaves nothing. Scenes without transparent surfaces stop at the first surface of all.
#import core/math.wgsl
#import geometry/constants.wgsl
#import geometry/prepared_ray.wgsl
#import core/layout.wgsl
#import shading/path/transmittance.wgsl

struct Shadow {
    // The distance to the light.
    limit: f32,
#if TRANSPARENT_SHADOWS
    // The share of light that is left behind the surfaces met so far.
    transmittance: Spectrum,
#endif
}

#if TRANSPARENT_SHADOWS
fn begin_shadow(limit: f32) -> Shadow {
    return Shadow(limit, WHITE);
}

// Takes from the light what the surface keeps that the ray meets at `hit`. Whether nothing is left.
fn is_blocked_by(shadow: ptr<function, Shadow>, ray: Ray, hit: Hit) -> bool {
    let transmittance = (*shadow).transmittance * hit_transmittance(ray, hit, (*shadow).limit);
    (*shadow).transmittance = transmittance;
    return max_component(transmittance) <= 0.0;
}

// Removes the light that surfaces block which are constants of the code: opaque ones first, then the others
// in the ray's order. Returns true where nothing is left.
fn is_blocked_by_constants(shadow: ptr<function, Shadow>, ray: PreparedRay) -> bool {
    let limit = (*shadow).limit;
    if any_of_constants(ray, limit) {
        return true;
    }
    var blocked = false;
    var hit = next_of_transparent_constants(ray, world_hit(0.0, 0u, 0.0, 0.0), limit);
    while hit.primitive != NONE && !blocked {
        blocked = is_blocked_by(shadow, Ray(ray.origin, ray.direction), hit);
        hit = next_of_transparent_constants(ray, hit, limit);
    }
    return blocked;
}

// The share of light that comes to the end of a shadow ray.
fn light_through(shadow: Shadow, blocked: bool) -> Spectrum {
    return select(shadow.transmittance, BLACK, blocked);
}
#else
fn begin_shadow(limit: f32) -> Shadow {
    return Shadow(limit);
}

fn is_blocked_by(shadow: ptr<function, Shadow>, ray: Ray, hit: Hit) -> bool {
    return true;
}

fn is_blocked_by_constants(shadow: ptr<function, Shadow>, ray: PreparedRay) -> bool {
    return any_of_constants(ray, (*shadow).limit);
}

fn light_through(shadow: Shadow, blocked: bool) -> Spectrum {
    return select(WHITE, BLACK, blocked);
}
#endif
