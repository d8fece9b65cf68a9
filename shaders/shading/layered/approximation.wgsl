// Light that goes straight down to one layer, is reflected there, and comes straight up again; or straight through. src/reference/layered/approximation.rs
// is the same in f64, and says what it approximates.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/layered/stack.wgsl
#import shading/material/bsdf.wgsl
#import shading/material/scattering.wgsl
#import shading/medium/medium.wgsl
#import shading/microfacet/dielectric.wgsl
#import shading/microfacet/fresnel.wgsl
#import shading/surface.wgsl

// The part of walks that is taken to leave the stack evenly, where slabs scatter and where they do not.
const EVEN_SHARE_OF_SLABS: f32 = 0.5;
const EVEN_SHARE: f32 = 0.1;

// The number by which a part of an interface is picked where blends pick one.
const MIDDLE: f32 = 0.5;

// A direction that points away from the surface, on its way down.
struct Beam {
    exists: bool,
    direction: vec3<f32>,
    // The part that interfaces and slabs so far let through.
    left: Spectrum,
    // That of interfaces alone.
    passed: f32,
    // Solid angle here over that outside.
    solid_angle: f32,
}

fn beam_of(direction: vec3<f32>) -> Beam {
    return Beam(true, direction, WHITE, 1.0, 1.0);
}

// Behind an interface and the slab beyond it; it does not exist where it is reflected totally.
fn beam_through(beam: Beam, stack: Stack, surface: Surface, number: u32) -> Beam {
    var behind = beam;
    let is_above = dot(beam.direction, stack.up) > 0.0;
    let normal = select(-stack.up, stack.up, is_above);
    let ior = layer_interface(stack, number).ior;
    let eta = select(1.0 / ior, ior, is_above);
    let cosine = max(dot(beam.direction, normal), SMALLEST_LAYER_COSINE);
    var transmitted = 1.0;
    if ior != 1.0 {
        if transmitted_cosine2(dot(beam.direction, normal), eta) <= 0.0 {
            behind.exists = false;
            return behind;
        }
        behind.direction = -refracted(normal, beam.direction, eta);
        transmitted = fresnel_dielectric(cosine, eta).transmitted;
    }
    let cosine_behind = max(dot(behind.direction, normal), SMALLEST_LAYER_COSINE);
    let slab = slab_in(stack, surface, select(number, number + 1u, is_above));
    if HAS_SLABS && slab.flags != 0u {
        behind.left *= light_left(slab.extinction, slab.thickness / cosine_behind);
    }
    behind.left *= transmitted;
    behind.passed *= transmitted;
    behind.solid_angle *= cosine / (eta * eta * cosine_behind);
    return behind;
}

// The interface that a direction which points away from the surface meets at a place.
fn interface_at_place(stack: Stack, direction: vec3<f32>, place: u32) -> u32 {
    return select(stack.count - 1u - place, place, dot(direction, stack.up) > 0.0);
}

// By walks, about the density with which they draw wi. Else Weidlich and Wilkie's approximation of f |cos|, and the density with which
// `draw_straight` draws wi.
fn evaluate_straight(stack: Stack, surface: Surface, wo: vec3<f32>, wi: vec3<f32>, by_walk: bool) -> BsdfValue {
    let same_side = dot(wo, stack.up) * dot(wi, stack.up) > 0.0;
    if !same_side && !by_walk {
        return no_value();
    }
    var sum = no_value();
    var beam = beam_of(wo);
    var to = beam_of(wi);
    for (var place = 0u; place < stack.count && beam.exists; place++) {
        let number = interface_at_place(stack, wo, place);
        var arriving = to;
        if !same_side {
            // Light that comes through meets the interfaces beyond this one first.
            arriving = beam_of(wi);
            for (var other = 0u; other + 1u < stack.count - place && arriving.exists; other++) {
                arriving = beam_through(arriving, stack, surface, interface_at_place(stack, wi, other));
            }
        }
        if arriving.exists {
            let seen = interface_surface(stack, surface, number, beam.direction, WHITE);
            let value = evaluate_bsdf(load_bsdf(seen, beam.direction, MIDDLE), seen, beam.direction, arriving.direction);
            if by_walk {
                sum.pdf_solid_angle += beam.passed * value.pdf_solid_angle * arriving.solid_angle;
            } else {
                let cosines = abs(dot(wi, stack.up)) / max(abs(dot(arriving.direction, stack.up)), SMALLEST_LAYER_COSINE);
                sum.value += value.value * beam.left * arriving.left * cosines;
                sum.pdf_solid_angle += value.pdf_solid_angle * arriving.solid_angle / f32(stack.count);
            }
        } else if same_side && !by_walk {
            break;
        }
        beam = beam_through(beam, stack, surface, number);
        if to.exists && same_side {
            to = beam_through(to, stack, surface, number);
        }
    }
    if by_walk {
        let even = select(EVEN_SHARE, EVEN_SHARE_OF_SLABS, (stack.flags & LAYERS_SCATTER) != 0u);
        sum.pdf_solid_angle = (1.0 - even) * sum.pdf_solid_angle + even * abs(dot(wi, stack.up)) * INVERSE_PI;
    }
    return sum;
}

// Draws wi for the approximation: by one of the interfaces, each as often. A density of 0 stands for one that is not known: the sample then counts the
// value over the density of `evaluate_straight`.
fn draw_straight(stack: Stack, surface: Surface, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    let scaled = choice * f32(stack.count);
    let place = min(u32(scaled), stack.count - 1u);
    var beam = beam_of(wo);
    for (var above = 0u; above < place && beam.exists; above++) {
        beam = beam_through(beam, stack, surface, interface_at_place(stack, wo, above));
    }
    if !beam.exists {
        return no_sample();
    }
    let number = interface_at_place(stack, wo, place);
    let seen = interface_surface(stack, surface, number, beam.direction, WHITE);
    let bsdf = load_bsdf(seen, beam.direction, MIDDLE);
#if MORE_LOBES
    var drawn = draw_direction(bsdf, seen, beam.direction, scaled - f32(place), u, v).chosen;
#else
    var drawn = sample_bsdf(bsdf, seen, beam.direction, scaled - f32(place), u, v);
#endif
    if max_component(drawn.weight) <= 0.0 || dot(drawn.wi, stack.up) * dot(beam.direction, stack.up) <= 0.0 {
        return no_sample();
    }
    // Ways are the same in both directions, so the way out is that of a beam which comes in along wi.
    var wi = drawn.wi;
    for (var back = place; back > 0u; back--) {
        let ior = layer_interface(stack, interface_at_place(stack, wo, back - 1u)).ior;
        if ior != 1.0 {
            let is_above = dot(wi, stack.up) > 0.0;
            let normal = select(-stack.up, stack.up, is_above);
            let eta = select(ior, 1.0 / ior, is_above);
            if transmitted_cosine2(dot(wi, normal), eta) <= 0.0 {
                return no_sample();
            }
            wi = -refracted(normal, wi, eta);
        }
    }
    drawn.wi = wi;
    drawn.eta_scale = 1.0;
    if drawn.pdf_solid_angle < 0.0 {
        var arriving = beam_of(wi);
        for (var above = 0u; above < place && arriving.exists; above++) {
            arriving = beam_through(arriving, stack, surface, interface_at_place(stack, wo, above));
        }
        if !arriving.exists {
            return no_sample();
        }
        let cosines = abs(dot(wi, stack.up)) / max(abs(dot(arriving.direction, stack.up)), SMALLEST_LAYER_COSINE);
        drawn.weight *= beam.left * arriving.left * (f32(stack.count) * cosines / arriving.solid_angle);
    } else {
        drawn.pdf_solid_angle = 0.0;
    }
    return drawn;
}
