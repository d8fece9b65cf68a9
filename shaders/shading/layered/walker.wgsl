// A way of light through a stack, step by step. src/reference/layered/walker.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import core/stream.wgsl
#import shading/layered/stack.wgsl
#import shading/light/place.wgsl
#import shading/material/scattering.wgsl
#import shading/medium/free_flight.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/phase.wgsl
#import shading/surface.wgsl

// Events after which chance may end a way, and after which it does so at least now and then.
const FIRST_LAYER_ROULETTE: u32 = 4u;
const CERTAIN_LAYER_ROULETTE: u32 = 1024u;
const MOST_LAYER_SURVIVAL: f32 = 0.99;

struct Walker {
    gap: u32,
    // Depth within the gap's slab, along the normal.
    depth: f32,
    // In which it goes.
    direction: vec3<f32>,
    weight: Spectrum,
    // The widest of its events so far; 0 where all had a single direction.
    breadth: f32,
    // Product of the ratios of indices of refraction that it crossed.
    eta: f32,
    events: u32,
}

// A way into the stack, against a direction that points away from the surface.
fn walker_into(stack: Stack, direction: vec3<f32>) -> Walker {
    return Walker(gap_outside(stack, direction), 0.0, -direction, WHITE, 0.0, 1.0, 0u);
}

// The way in the slab to the interface ahead, along the normal.
fn height_ahead(walker: Walker, stack: Stack, slab: Slab) -> f32 {
    return select(walker.depth, slab.thickness - walker.depth, dot(walker.direction, stack.up) < 0.0);
}

// Flies to the interface ahead; true where the slab scatters the light before.
fn flies(walker: ptr<function, Walker>, stack: Stack, slab: Slab, stream: ptr<function, Stream>) -> bool {
    if !HAS_SLABS || slab.flags == 0u {
        return false;
    }
    let cosine = dot((*walker).direction, stack.up);
    let length_of_way = height_ahead(*walker, stack, slab) / max(abs(cosine), SMALLEST_LAYER_COSINE);
    if !HAS_SLABS_SCATTER || (slab.flags & SLAB_SCATTERS) == 0u {
        (*walker).weight *= light_left(slab.extinction, length_of_way);
        return false;
    }
    let medium = Medium(slab.extinction, slab.scattering, BLACK, 0u, slab.phase, 0u);
    let event = draw(stream);
    let place_number = draw(stream);
    let way = min(length_of_way, FARTHEST);
    let chances = flight_chances(medium, (*walker).weight, way);
    if event >= chances.scatters {
        (*walker).weight *= passing_weight(medium, chances, way);
        return false;
    }
    let ray = Ray(vec3<f32>(0.0), (*walker).direction);
    let nowhere = LightPlace(false, vec3<f32>(0.0));
    let place = scattering_place(medium, ray, way, chances, nowhere, event / chances.scatters, place_number);
    (*walker).weight *= place.weight;
    (*walker).depth = clamp((*walker).depth - place.distance * cosine, 0.0, slab.thickness);
    return true;
}

// Russian roulette by what the way still carries.
fn survives_in_stack(walker: ptr<function, Walker>, stream: ptr<function, Stream>) -> bool {
    (*walker).events++;
    let carried = max_component((*walker).weight) * (*walker).eta * (*walker).eta;
    if (*walker).events < FIRST_LAYER_ROULETTE || !(carried > 0.0) {
        return carried > 0.0;
    }
    let survival = min(carried, select(MOST_LAYER_SURVIVAL, 1.0, (*walker).events < CERTAIN_LAYER_ROULETTE));
    (*walker).weight /= survival;
    return draw(stream) < survival;
}

// Takes the direction that the slab scatters it into.
fn scatter_in_slab(walker: ptr<function, Walker>, slab: Slab, stream: ptr<function, Stream>) -> bool {
    let choice = draw(stream);
    let u = draw(stream);
    let v = draw(stream);
    let drawn = sample_phase(slab.phase, -(*walker).direction, choice, u, v);
    if max_component(drawn.weight) <= 0.0 {
        return false;
    }
    (*walker).direction = drawn.wi;
    (*walker).breadth = max((*walker).breadth, slab.breadth);
    return survives_in_stack(walker, stream);
}

// Takes a direction that an interface sends it in.
fn leave_interface(walker: ptr<function, Walker>, stack: Stack, surface: Surface, number: u32, drawn: BsdfSample, stream: ptr<function, Stream>) -> bool {
    (*walker).direction = drawn.wi;
    let goes_up = dot(drawn.wi, stack.up) > 0.0;
    (*walker).gap = select(number + 1u, number, goes_up);
    (*walker).depth = 0.0;
    if HAS_SLABS && goes_up {
        (*walker).depth = slab_in(stack, surface, number).thickness;
    }
    if drawn.pdf_solid_angle >= 0.0 {
        (*walker).breadth = max((*walker).breadth, layer_interface(stack, number).breadth);
    }
    return survives_in_stack(walker, stream);
}
