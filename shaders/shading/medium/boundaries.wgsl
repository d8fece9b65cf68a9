// The way of a shadow ray through the null surfaces that bound media: from surface to surface in their order, because they decide which medium lies
// behind them. src/reference/integrator.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/stack.wgsl
#import shading/path/transmittance.wgsl
#import shading/surface.wgsl

// A shadow ray on its way.
struct Crossing {
    // The rest of the ray, and its length.
    ray: Ray,
    remaining: f32,
    media: MediumStack,
    // The share of light that is left so far.
    share: Spectrum,
    // Surfaces that were crossed.
    crossed: u32,
    goes_on: bool,
}

fn begin_crossing(ray: Ray, distance: f32, media: MediumStack, exists: bool) -> Crossing {
    return Crossing(ray, distance, media, WHITE, 0u, exists);
}

// Goes on to `hit`, the first thing on the rest of the way.
fn cross_surface(crossing: Crossing, hit: Hit) -> Crossing {
    var next = crossing;
    let medium = innermost(crossing.media);
    if hit.primitive == NONE {
        next.share *= medium_transmittance(medium, crossing.remaining);
        next.goes_on = false;
        return next;
    }
    let surface = hit_surface(crossing.ray, hit);
    next.share *= medium_transmittance(medium, distance(surface.position, crossing.ray.origin)) * null_share(surface, crossing.ray);
    next.crossed++;
    if max_component(next.share) <= 0.0 || next.crossed >= MOST_CROSSINGS {
        next.share = BLACK;
        next.goes_on = false;
        return next;
    }
    if is_open_boundary(surface.material) {
        next.media = media_towards(surface, crossing.ray.direction, crossing.media);
    }
    next.ray.origin = offset_origin(surface, crossing.ray.direction);
    // Shorter by what rounding may have moved the origin, so that the way still ends before the light.
    next.remaining -= dot(next.ray.origin - crossing.ray.origin, crossing.ray.direction) + 4.0 * surface.error;
    return next;
}
