// The way of a shadow ray through media and the null surfaces that bound them: from surface to surface in their order, because they decide which medium lies
// behind them. src/reference/integrator/shadow.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/medium/stack.wgsl
#import shading/medium/tracking.wgsl
#import shading/path/transmittance.wgsl
#import shading/surface.wgsl

// A shadow ray on its way.
struct Crossing {
    // The rest of the ray, and its length.
    ray: Ray,
    remaining: f32,
    media: MediumStack,
    // Key of the random numbers by which media with grids are passed.
    key: u32,
    // The share of light that is left so far.
    share: Spectrum,
    // The way from the surface that was crossed last to the ray's origin, which lies a little behind it.
    way_before: f32,
    // Surfaces that were crossed.
    crossed: u32,
    goes_on: bool,
}

fn begin_crossing(ray: Ray, distance: f32, media: MediumStack, key: u32, exists: bool) -> Crossing {
    return Crossing(ray, distance, media, key, WHITE, 0.0, 0u, exists);
}

// Goes on to `hit`, the first thing on the rest of the way.
fn cross_surface(crossing: Crossing, hit: Hit) -> Crossing {
    var next = crossing;
    let medium = innermost(crossing.media);
    if hit.primitive == NONE {
        next.share *= transmittance_along(medium, crossing.ray, crossing.remaining + crossing.way_before, mix_bits(crossing.key + crossing.crossed));
        next.goes_on = false;
        return next;
    }
    let surface = hit_surface(crossing.ray, hit);
    next.share *= null_share(surface, crossing.ray);
    if max_component(next.share) > 0.0 {
        let way = distance(surface.position, crossing.ray.origin) + crossing.way_before;
        next.share *= transmittance_along(medium, crossing.ray, way, mix_bits(crossing.key + crossing.crossed));
    }
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
    next.way_before = way_before(surface, next.ray);
    // Shorter by what rounding may have moved the origin, so that the way still ends before the light.
    next.remaining -= dot(next.ray.origin - crossing.ray.origin, crossing.ray.direction) + 4.0 * surface.error;
    return next;
}
