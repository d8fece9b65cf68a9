// One vertex of a path: what every stage and the fused kernel agree on. src/reference/integrator.rs is the same estimator in f64.
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl
#import shading/surface.wgsl
#import shading/bsdf.wgsl
#import shading/light.wgsl
#import shading/mis.wgsl
#if TRACE
#import shading/trace.wgsl
#endif

struct Path {
    ray: Ray,
    throughput: vec3<f32>,
    // Density of the ray's direction by solid angle; negative after the camera or a delta lobe.
    pdf_solid_angle: f32,
    // Product of the squared index ratios of all refractions so far; Russian roulette looks past them.
    eta_scale: f32,
    // Pixel over the whole film, and the sample's index within the pass.
    pixel: u32,
    sample_in_pass: u32,
#if PASS
    // Vertices where the ray went on as if nothing were there; they are no edges of their own.
    passed: u32,
#endif
}

struct ShadowRay {
    ray: Ray,
    distance: f32,
    // What the path gains if nothing is in the way; all 0: there is no shadow ray.
    radiance: vec3<f32>,
}

struct Vertex {
    // The path goes on along its new ray.
    alive: bool,
    // Radiance found at this vertex, already times throughput and weight.
    radiance: vec3<f32>,
    shadow: ShadowRay,
}

// A path on its first edge.
fn new_path(ray: Ray, pixel: u32, sample_in_pass: u32) -> Path {
    var path: Path;
    path.ray = ray;
    path.throughput = vec3<f32>(1.0);
    path.pdf_solid_angle = -1.0;
    path.eta_scale = 1.0;
    path.pixel = pixel;
    path.sample_in_pass = sample_in_pass;
    return path;
}

// Weight of emission met by a ray of the given density, where all light samples together have density `pdf_light`.
fn emission_weight(pdf_solid_angle: f32, pdf_light: f32) -> f32 {
    if pdf_solid_angle < 0.0 || pdf_light == 0.0 {
        return 1.0;
    }
#if ESTIMATOR_MIS
    return mis_weight(pdf_solid_angle, pdf_light);
#else
#if ESTIMATOR_NEE
    return 0.0;
#else
    return 1.0;
#endif
#endif
}

// How many light samples the surface at the end of edge number `edge` takes.
fn light_samples_at(edge: u32) -> f32 {
#if SEVERAL_LIGHT_SAMPLES
    return select(1.0, f32(LIGHT_SAMPLES), edge >= 1u && edge <= LIGHT_SAMPLES_DEPTH);
#else
    return 1.0;
#endif
}

// Which edge of the path ends at its vertex number `visit`.
fn edge_at(path: Path, visit: u32) -> u32 {
#if PASS
    return visit - path.passed;
#else
    return visit;
#endif
}

fn no_shadow() -> ShadowRay {
    return ShadowRay(Ray(vec3<f32>(0.0), vec3<f32>(0.0, 0.0, 1.0)), 0.0, vec3<f32>(0.0));
}

// Radiance that a path gains where its ray leaves the scene.
fn escaped_radiance(path: Path, edge: u32) -> vec3<f32> {
#if ENVIRONMENT
    let radiance = path.throughput * environment_radiance(path.ray.direction);
#if TRACE
    trace_found(radiance, 1.0);
#endif
#if ENVIRONMENT_SAMPLED
    // After the camera or a delta lobe no light sample could have found it.
    if path.pdf_solid_angle >= 0.0 {
        let pdf_light = light_samples_at(edge - 1u) * environment_pdf_solid_angle(path.ray);
        let weight = emission_weight(path.pdf_solid_angle, pdf_light);
#if TRACE
        trace_found(radiance * weight, weight);
#endif
        return radiance * weight;
    }
#endif
    return radiance;
#else
    return vec3<f32>(0.0);
#endif
}

#if PLANT_BRDF
// A planted fault: one material returns 1 % too much.
fn planted_factor(material: u32) -> f32 {
    return select(1.0, 1.01, material == PLANTED_MATERIAL);
}
#endif

#if LIGHTS
// Where light sampling looks from.
fn light_reference(surface: Surface) -> vec3<f32> {
    return surface.position + surface.error * surface.facing_normal;
}

// What the path gains from one of the light samples that the surface at the end of `edge` takes, chosen by `light_bits`, given the surface's
// value towards it.
fn next_event(path: Path, surface: Surface, edge: u32, light: LightSample, light_bits: u32, value: BsdfValue) -> ShadowRay {
#if TRANSMISSIVE_SMOOTH
    let origin = offset_origin(surface, light.wi);
#else
    let origin = light_reference(surface);
#endif
    var radiance = path.throughput * value.value * light.radiance;
#if PLANT_BRDF
    radiance *= planted_factor(surface.material);
#endif
    let count = light_samples_at(edge);
    // Several samples are as dense together as one of as many times its density.
    let pdf_light = count * light.pdf_solid_angle;
    var weight = 1.0;
    if light.pdf_solid_angle >= 0.0 {
        radiance = radiance / pdf_light;
#if ESTIMATOR_MIS
        weight = mis_weight(pdf_light, value.pdf_solid_angle);
        radiance *= weight;
#endif
    } else {
        radiance = radiance / count;
    }
#if TRACE
    trace_light(light.wi, pdf_light, radiance, weight, choose_light(light_bits), value.pdf_solid_angle);
#endif
    return ShadowRay(Ray(origin, light.wi), light.distance, radiance);
}
#endif

#if SEVERAL_LIGHT_SAMPLES
// A surface on which several light samples are taken, worked out once for all of them.
struct LitSurface {
    // Whether it takes more than the one of shade_vertex.
    takes_more: bool,
    surface: Surface,
    bsdf: Bsdf,
}

// The surface that a path met at its vertex number `visit`; `path` is as it arrived there.
fn lit_surface(path: Path, hit: Hit, visit: u32) -> LitSurface {
    var lit: LitSurface;
    let edge = edge_at(path, visit);
    if hit.primitive == NONE || edge > LIGHT_SAMPLES_DEPTH || edge == MAX_DEPTH {
        return lit;
    }
    lit.surface = hit_surface(path.ray, hit);
    // The same of a blend's materials that shade_vertex looks at.
    let random = random_block(path.pixel, path.sample_in_pass, 2u * visit + 1u);
    lit.bsdf = load_bsdf(lit.surface, -path.ray.direction, uniform_float(random.w));
    lit.takes_more = has_smooth_lobe(lit.bsdf);
    return lit;
}

// The shadow ray of light sample `number`, not the first, of a surface that takes more; `path` is as it arrived there.
fn more_light(path: Path, lit: LitSurface, visit: u32, number: u32) -> ShadowRay {
    let edge = edge_at(path, visit);
    let light_bits = more_light_bits(path.pixel, path.sample_in_pass, visit, edge, number);
    let light = sample_light(light_reference(lit.surface), light_bits);
    let value = evaluate_bsdf(lit.bsdf, lit.surface, -path.ray.direction, light.wi);
    return next_event(path, lit.surface, edge, light, light_bits.x, value);
}
#endif

// Extends a path whose ray met `hit`, its vertex number `visit` after the camera: reads and replaces `path`, returns what was found.
// A vertex ends an edge of the path unless the ray passes through it.
fn shade_vertex(path: ptr<function, Path>, hit: Hit, visit: u32) -> Vertex {
    let incoming = *path;
    let edge = edge_at(incoming, visit);
    var vertex = Vertex(false, vec3<f32>(0.0), no_shadow());
#if TRACE
    trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
#endif
    if hit.primitive == NONE {
        vertex.radiance = escaped_radiance(incoming, edge);
        return vertex;
    }
    let surface = hit_surface(incoming.ray, hit);
    let wo = -incoming.ray.direction;
#if TRACE
    trace_surface(surface.position, surface.shading_normal, surface.material);
#endif

#if EMISSION
    let emitted = material_emission(
        surface.material, clamp(dot(wo, surface.shading_normal), 0.0, 1.0), surface.front, surface.uv
    );
    if max_component(emitted) > 0.0 {
#if LIGHTS
        let weight = emission_weight(
            incoming.pdf_solid_angle, light_samples_at(edge - 1u) * light_pdf_solid_angle(incoming.ray, surface)
        );
#else
        let weight = 1.0;
#endif
        vertex.radiance = incoming.throughput * emitted * weight;
#if TRACE
        trace_found(vertex.radiance, weight);
#endif
    }
#endif

    let last_edge = edge == MAX_DEPTH;
#if !PASS
    if last_edge {
        return vertex;
    }
#endif
    let first_block = 2u * visit;
    let random = random_block(incoming.pixel, incoming.sample_in_pass, first_block);
    let more_random = random_block(incoming.pixel, incoming.sample_in_pass, first_block + 1u);
    let bsdf = load_bsdf(surface, wo, uniform_float(more_random.w));
#if LIGHTS
    let samples_light = has_smooth_lobe(bsdf) && !last_edge;
    var light: LightSample;
    if samples_light {
        light = sample_light(light_reference(surface), random);
    }
#endif
#if MORE_LOBES
    // The surface is evaluated towards the light and along the drawn direction by the same code, one after the other: drivers that
    // copy what is called to wherever it is called have half of it to compile.
    let draw = draw_direction(
        bsdf, surface, wo, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
    );
#if LIGHTS
    var light_value = no_value();
    var draw_value = no_value();
    for (var direction = 0u; direction < 2u; direction++) {
        let towards_light = direction == 0u;
        if select(draw.mixed, samples_light, towards_light) {
            let value = evaluate_bsdf(bsdf, surface, wo, select(draw.chosen.wi, light.wi, towards_light));
            if towards_light {
                light_value = value;
            } else {
                draw_value = value;
            }
        }
    }
    let sampled = mixed_sample(draw, draw_value);
#else
    let sampled = mixed_sample(draw, evaluate_bsdf(bsdf, surface, wo, draw.chosen.wi));
#endif
#else
#if LIGHTS
    var light_value = no_value();
    if samples_light {
        light_value = evaluate_bsdf(bsdf, surface, wo, light.wi);
    }
#endif
    let sampled = sample_bsdf(
        bsdf, surface, wo, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
    );
#endif
#if LIGHTS
    if samples_light {
        vertex.shadow = next_event(incoming, surface, edge, light, random.x, light_value);
    }
#endif
#if PASS
    if last_edge && !sampled.passes {
        return vertex;
    }
#endif
    var throughput = incoming.throughput * sampled.weight;
#if PLANT_BRDF
    throughput *= planted_factor(surface.material);
#endif
    if max_component(throughput) <= 0.0 {
        return vertex;
    }
    let eta_scale = incoming.eta_scale * sampled.eta_scale;
#if TRACE
    trace_sample(sampled.wi, sampled.pdf_solid_angle, sampled.weight, sampled.eta_scale, sampled.passes);
#endif
#if ROULETTE
#if PASS
    let roulette = edge >= ROULETTE_DEPTH && !sampled.passes;
#else
    let roulette = edge >= ROULETTE_DEPTH;
#endif
    if roulette {
        // Past edge 64 even a lossless path ends some day.
        let survive = min(max_component(throughput) * eta_scale, select(1.0, 0.999, edge >= 64u));
#if TRACE
        trace_roulette(survive);
#endif
        if uniform_float(more_random.z) >= survive {
            return vertex;
        }
        throughput /= survive;
    }
#endif
    vertex.alive = true;
    (*path).ray = Ray(offset_origin(surface, sampled.wi), sampled.wi);
    (*path).throughput = throughput;
    (*path).pdf_solid_angle = sampled.pdf_solid_angle;
    (*path).eta_scale = eta_scale;
#if PASS
    (*path).passed += select(0u, 1u, sampled.passes);
#endif
    return vertex;
}
