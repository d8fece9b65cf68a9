// One vertex of a path in a fused kernel: by itself, or side by side with the other lanes of its subgroup, whose paths are then all on
// the same vertex.
#import core/math.wgsl
#import geometry/closest.wgsl
#import shading/medium/boundaries.wgsl
#import shading/path/path.wgsl
#import shading/path/trace.wgsl
#if PACKETS
#import geometry/software/lanes.wgsl
#import geometry/software/packet.wgsl
#endif

// True where the condition holds for any of the paths that are traced side by side.
fn any_path(condition: bool) -> bool {
    if HAS_PACKETS {
        return any_lane(condition);
    } else {
        return condition;
    }
}

// Closest hits, before a distance, of the rays of all lanes that have one.
fn nearest_before(ray: Ray, limit: f32, has_ray: bool) -> Hit {
#if PACKETS
    return closest_hit_together(ray, select(-1.0, limit, has_ray));
#else
    var hit: Hit;
    if has_ray {
        hit = closest_hit(ray, limit);
    }
    return hit;
#endif
}

// Closest hits of the rays of all lanes that have one.
fn nearest(ray: Ray, has_ray: bool) -> Hit {
    return nearest_before(ray, INFINITY_DISTANCE, has_ray);
}

// The share of light that comes along the shadow ray through surfaces that bound media.
fn light_across_boundaries(shadow: ShadowRay, has_ray: bool) -> Spectrum {
    var crossing = begin_crossing(shadow.ray, shadow.distance, shadow.media, shadow.key, has_ray);
    loop {
        let hit = nearest_before(crossing.ray, crossing.remaining, crossing.goes_on);
        if crossing.goes_on {
            crossing = cross_surface(crossing, hit);
        }
        continuing {
            break if !any_path(crossing.goes_on);
        }
    }
    return select(BLACK, crossing.share, has_ray);
}

// The share of light that comes along the shadow ray, for the lanes that have one; 0 for the others.
fn light_share(shadow: ShadowRay, has_ray: bool) -> Spectrum {
    if HAS_OPEN_BOUNDARIES {
        return light_across_boundaries(shadow, has_ray);
    }
#if PACKETS
    return select(BLACK, shadow_transmittance_together(shadow.ray, select(-1.0, shadow.distance, has_ray)), has_ray);
#else
    var share = BLACK;
    if has_ray {
        share = shadow_transmittance(shadow.ray, shadow.distance);
    }
    return share;
#endif
}

// Adds what a path gains by a shadow ray, of the lanes that have one, to `radiance`, and counts it. All lanes take part.
fn trace_shadow_ray(shadow: ShadowRay, radiance: ptr<function, Spectrum>, rays: ptr<function, u32>) {
    let has_ray = is_needed(shadow);
    *rays += select(0u, 1u, has_ray);
    let share = light_share(shadow, has_ray);
    if max_component(share) > 0.0 {
        trace_light_seen(share);
        *radiance += share * shadow.radiance;
    }
}

// Traces the ray of a path, of the lanes whose path is alive, to its vertex number `vertex`; adds what the path gains there to `radiance`,
// and counts rays. Whether the path goes on. All lanes take part.
fn trace_vertex(
    path: ptr<function, Path>, vertex: u32, alive: bool, radiance: ptr<function, Spectrum>, rays: ptr<function, u32>
) -> bool {
    let hit = nearest((*path).ray, alive);
    var shading = no_shading();
    if alive {
        shading = shade_vertex(path, hit, vertex);
        *radiance += shading.radiance;
        (*rays)++;
    }
    if HAS_LIGHTS && LIGHT_SAMPLES == 1u {
        trace_shadow_ray(shading.shadow, radiance, rays);
    } else if HAS_LIGHTS {
        var shadow = shading.shadow;
        var number = 1u;
        // One shadow ray a turn, the next one made at its end. With one light sample, drivers would keep this loop around those of the traversal.
        loop {
            trace_shadow_ray(shadow, radiance, rays);
            let goes_on = number < shading.light_samples;
            if !any_path(goes_on) {
                break;
            }
            shadow = no_shadow_ray();
            if goes_on {
                shadow = further_shadow_ray(shading.shaded, number);
            }
            number++;
        }
    }
    store_trace(vertex);
    return shading.alive;
}
