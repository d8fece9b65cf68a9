// The path step that every kernel shares: what happens where a path's ray ends. src/reference/integrator.rs is the same estimator in f64.
//
// A path's vertices are counted from 1, the first surface that the camera sees. Its depth counts edges: 1 is the camera's ray. The two
// differ where rays go on through null surfaces: such a vertex ends no edge.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/bsdf.wgsl
#import shading/light.wgsl
#import shading/light_sample.wgsl
#if LIGHT_TREE
#import shading/light_tree.wgsl
#endif
#import shading/mis.wgsl
#if NORMAL_SHADOWING
#import shading/normal_shadowing.wgsl
#endif
#import shading/outside.wgsl
#import shading/planted.wgsl
#import shading/scattering.wgsl
#import shading/surface.wgsl
#import shading/trace.wgsl
#if ATTENUATION
#import shading/volume.wgsl
#endif
#if GUIDE
#import shading/guide.wgsl
#import shading/guided.wgsl
#endif
#if LAYER_OF_LIGHT
#import shading/layer.wgsl
#endif
#if LAYER_OF_SURFACES
#import shading/surface_layer.wgsl
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
    // Vertices at null surfaces so far.
    null_vertices: u32,
#if TRANSPARENT_SHADOWS
    // Where the ray began that went on through the null surfaces last met: light was sampled from there.
    lit_from: vec3<f32>,
#endif
#if ATTENUATION
    // Of what the ray goes through.
    extinction: vec3<f32>,
#endif
}

struct ShadowRay {
    ray: Ray,
    distance: f32,
    // What the path gains if nothing is in the way; all 0: there is no shadow ray.
    radiance: vec3<f32>,
}

// What light samples of a vertex start from.
struct LitVertex {
    // As it arrived there.
    path: Path,
    vertex: u32,
    surface: Surface,
    bsdf: Bsdf,
#if GUIDE
    guide: GuideCell,
#endif
}

// What comes of a vertex.
struct Shading {
    // The path goes on along its new ray.
    alive: bool,
    // Radiance found at this vertex, already times throughput and weight.
    radiance: vec3<f32>,
    // How many light samples are taken here; the first one's shadow ray; what further_shadow_ray makes the others of.
    light_samples: u32,
    shadow: ShadowRay,
    lit: LitVertex,
}

// A path on its first edge.
fn new_path(ray: Ray, pixel: u32, sample_in_pass: u32) -> Path {
    return Path(
        ray, vec3<f32>(1.0), -1.0, 1.0, pixel, sample_in_pass, 0u
#if TRANSPARENT_SHADOWS
        , ray.origin
#endif
#if ATTENUATION
        , vec3<f32>(0.0)
#endif
    );
}

// The path's ray from where light was last sampled: shadow rays from there meet the same surfaces as the path, and go on through null ones
// as it does. So what both find is shared out by the densities that they have there.
fn ray_from_lit_vertex(path: Path) -> Ray {
#if TRANSPARENT_SHADOWS
    return Ray(path.lit_from, path.ray.direction);
#else
    return path.ray;
#endif
}

fn no_shadow_ray() -> ShadowRay {
    return ShadowRay(Ray(vec3<f32>(0.0), vec3<f32>(0.0, 0.0, 1.0)), 0.0, vec3<f32>(0.0));
}

// Whether the path may gain anything from it.
fn is_needed(shadow: ShadowRay) -> bool {
    return any(shadow.radiance != vec3<f32>(0.0));
}

fn no_shading() -> Shading {
    var shading: Shading;
    shading.shadow = no_shadow_ray();
    return shading;
}

// Depth of the path's ray that ends at this vertex.
fn depth_at(path: Path, vertex: u32) -> u32 {
    return vertex - select(0u, path.null_vertices, HAS_NULL_SURFACES);
}

// How many light samples a surface takes that a ray of this depth met.
fn light_samples_at(depth: u32) -> u32 {
    return select(1u, LIGHT_SAMPLES, depth >= 1u && depth <= LIGHT_SAMPLES_DEPTH);
}

// Weight of emission met by a ray of the given density, where all light samples together have density `pdf_light`.
fn emission_weight(pdf_solid_angle: f32, pdf_light: f32) -> f32 {
    if pdf_solid_angle < 0.0 || pdf_light == 0.0 {
        return 1.0;
    }
    if HAS_ESTIMATOR_MIS {
        return mis_weight(pdf_solid_angle, pdf_light);
    }
    return select(1.0, 0.0, HAS_ESTIMATOR_NEE);
}

// Radiance that a path gains where its ray, of this depth, leaves the scene.
fn escaped_radiance(path: Path, depth: u32) -> vec3<f32> {
    if !HAS_ENVIRONMENT {
        return vec3<f32>(0.0);
    }
    var radiance = path.throughput * outside_radiance(path.ray.direction);
    var weight = 1.0;
    // After the camera or a delta lobe no light sample could have found it.
    if HAS_ENVIRONMENT_SAMPLED && path.pdf_solid_angle >= 0.0 {
        let pdf_light = f32(light_samples_at(depth - 1u)) * environment_pdf_solid_angle(ray_from_lit_vertex(path));
        weight = emission_weight(path.pdf_solid_angle, pdf_light);
        radiance *= weight;
    }
    trace_found(radiance, weight);
#if LAYER_OF_LIGHT
    radiance = select(vec3<f32>(0.0), radiance, is_in_layer(depth));
#endif
    return radiance;
}

// Radiance that a path gains from the emission of a surface that its ray, of this depth, met.
fn emitted_radiance(path: Path, surface: Surface, depth: u32) -> vec3<f32> {
    var radiance = vec3<f32>(0.0);
    if HAS_EMISSION {
        let cosine = clamp(dot(-path.ray.direction, surface.shading_normal), 0.0, 1.0);
        let emitted = material_emission(surface.material, cosine, surface.front, surface.uv);
        if max_component(emitted) > 0.0 {
            var weight = 1.0;
            if HAS_LIGHTS {
                let pdf_light = f32(light_samples_at(depth - 1u)) * light_pdf_solid_angle(ray_from_lit_vertex(path), surface);
                weight = emission_weight(path.pdf_solid_angle, pdf_light);
            }
            radiance = path.throughput * emitted * weight;
            trace_found(radiance, weight);
#if LAYER_OF_LIGHT
            radiance = select(vec3<f32>(0.0), radiance, is_in_layer(depth));
#endif
        }
    }
    return radiance;
}

// The point that light sampling looks from.
fn shading_point(surface: Surface) -> vec3<f32> {
    return surface.position + surface.error * surface.facing_normal;
}

#if LIGHT_TREE
// The light that was chosen, to be written down where paths are; else 0, because a tree is not walked twice for nothing.
fn traced_light(surface: Surface, light_bits: u32) -> u32 {
#if TRACE
    return choose_light_at(shading_point(surface), light_bits).light;
#else
    return 0u;
#endif
}
#endif

// The shadow ray of one of the light samples that a surface takes, chosen by `light_bits`, given the surface's value towards it.
fn shadow_ray(path: Path, surface: Surface, depth: u32, light: LightSample, light_bits: u32, value: BsdfValue) -> ShadowRay {
    let sampled_from = shading_point(surface);
    var ray = Ray(sampled_from, light.wi);
    var ray_length = light.distance;
    if HAS_NON_DELTA_TRANSMISSION {
        ray.origin = offset_origin(surface, light.wi);
        // On the far side the ray begins elsewhere than where light was sampled from, and ends where it would have ended.
        if dot(light.wi, surface.facing_normal) < 0.0 && light.distance < INFINITY_DISTANCE {
            let way = sampled_from + light.distance * light.wi - ray.origin;
            ray_length = length(way);
            ray.direction = way / ray_length;
        }
    }
    var radiance = path.throughput * value.value * light.radiance * planted_factor(surface.material);
#if ATTENUATION
    radiance *= volume_transmittance(extinction_towards(surface, light.wi, path.extinction), light.distance);
#endif
    let count = f32(light_samples_at(depth));
    // Several samples are as dense together as one of as many times its density.
    let pdf_light = count * light.pdf_solid_angle;
    var weight = 1.0;
    if light.pdf_solid_angle >= 0.0 {
        radiance = radiance / pdf_light;
        if HAS_ESTIMATOR_MIS {
            weight = mis_weight(pdf_light, value.pdf_solid_angle);
            radiance *= weight;
        }
    } else {
        radiance = radiance / count;
    }
#if LIGHT_TREE
    trace_light(light.wi, pdf_light, radiance, weight, traced_light(surface, light_bits), value.pdf_solid_angle);
#else
    trace_light(light.wi, pdf_light, radiance, weight, choose_light(light_bits), value.pdf_solid_angle);
#endif
#if LAYER_OF_LIGHT
    radiance = select(vec3<f32>(0.0), radiance, is_in_layer(depth + 1u));
#endif
    return ShadowRay(ray, ray_length, radiance);
}

// The shadow ray of light sample `number`, not the first, of a vertex that takes more.
fn further_shadow_ray(lit: LitVertex, number: u32) -> ShadowRay {
    let depth = depth_at(lit.path, lit.vertex);
    let light_bits = further_light_bits(lit.path.pixel, lit.path.sample_in_pass, lit.vertex, depth, number);
    let light = sample_light(shading_point(lit.surface), light_bits);
#if GUIDE
    var value = evaluate_guided(lit.guide, lit.bsdf, lit.surface, -lit.path.ray.direction, light.wi);
#else
    var value = evaluate_bsdf(lit.bsdf, lit.surface, -lit.path.ray.direction, light.wi);
#endif
#if NORMAL_SHADOWING
    value.value *= normal_shadowing(lit.surface.unbent_normal, lit.surface.shading_normal, light.wi);
#endif
    return shadow_ray(lit.path, lit.surface, depth, light, light_bits.x, value);
}

#if LAYER_OF_SURFACES
// Follows a path whose ray met `hit`, its vertex number `vertex`, to the surface that the layer is of: replaces `path`, or returns the layer's
// value as what was found.
fn shade_vertex(path: ptr<function, Path>, hit: Hit, vertex: u32) -> Shading {
    var incoming = *path;
    let wo = -incoming.ray.direction;
    var shading = no_shading();
    trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
    if hit.primitive == NONE {
        shading.radiance = vec3<f32>(NOTHING_MET);
        return shading;
    }
    let surface = hit_surface(incoming.ray, hit);
#if ATTENUATION
    incoming.throughput *= volume_transmittance(incoming.extinction, distance(surface.position, incoming.ray.origin));
#endif
    trace_surface(surface.position, surface.shading_normal, surface.material);
    var drawn = no_sample();
    if depth_at(incoming, vertex) < MAX_DEPTH {
        let random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex);
        let more_random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex + 1u);
        let bsdf = load_bsdf(surface, wo, uniform_float(more_random.w));
        let scattering = scatter(
            bsdf, surface, wo, false, wo, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
        );
        drawn = scattering.drawn;
    }
    if !is_followed(drawn) {
        shading.radiance = surface_value(incoming.throughput, surface, drawn);
        return shading;
    }
    shading.alive = true;
    (*path).ray = Ray(offset_origin(surface, drawn.wi), drawn.wi);
    (*path).throughput = incoming.throughput * drawn.weight;
    (*path).pdf_solid_angle = drawn.pdf_solid_angle;
#if ATTENUATION
    if !drawn.is_null {
        (*path).extinction = extinction_towards(surface, drawn.wi, incoming.extinction);
    }
#endif
    if drawn.is_null {
        (*path).null_vertices++;
    }
    return shading;
}
#else
// Extends a path whose ray met `hit`, its vertex number `vertex`: replaces `path`, returns what was found.
fn shade_vertex(path: ptr<function, Path>, hit: Hit, vertex: u32) -> Shading {
    var incoming = *path;
    let depth = depth_at(incoming, vertex);
    let wo = -incoming.ray.direction;
    var shading = no_shading();
    if hit.primitive == NONE {
#if ATTENUATION
        incoming.throughput *= volume_transmittance(incoming.extinction, INFINITY_DISTANCE);
#endif
        trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
        shading.radiance = escaped_radiance(incoming, depth);
        return shading;
    }
    let surface = hit_surface(incoming.ray, hit);
#if ATTENUATION
    // A hit in an instance may come without its distance.
    incoming.throughput *= volume_transmittance(incoming.extinction, distance(surface.position, incoming.ray.origin));
#endif
    trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
    trace_surface(surface.position, surface.shading_normal, surface.material);
    shading.radiance = emitted_radiance(incoming, surface, depth);

    // The last edge may go on through null surfaces.
    let last_edge = depth == MAX_DEPTH;
    if last_edge && !HAS_NULL_SURFACES {
        return shading;
    }
    let random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex);
    let more_random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex + 1u);
    let bsdf = load_bsdf(surface, wo, uniform_float(more_random.w));
    let samples_light = HAS_LIGHTS && has_non_delta_lobe(bsdf) && !last_edge;
    var light = no_light();
    if samples_light {
        light = sample_light(shading_point(surface), random);
    }
#if GUIDE
    let cell = guide_at(surface, guided_probability(bsdf));
    let scattering = scatter_guided(
        cell, bsdf, surface, wo, samples_light, light.wi, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
    );
#else
    let scattering = scatter(
        bsdf, surface, wo, samples_light, light.wi, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
    );
#endif
    if samples_light {
        shading.light_samples = light_samples_at(depth);
        shading.shadow = shadow_ray(incoming, surface, depth, light, random.x, scattering.towards_light);
#if GUIDE
        shading.lit = LitVertex(incoming, vertex, surface, bsdf, cell);
#else
        shading.lit = LitVertex(incoming, vertex, surface, bsdf);
#endif
    }

    let drawn = scattering.drawn;
    if HAS_NULL_SURFACES && last_edge && !drawn.is_null {
        return shading;
    }
    var throughput = incoming.throughput * drawn.weight * planted_factor(surface.material);
    if max_component(throughput) <= 0.0 {
        return shading;
    }
    let eta_scale = incoming.eta_scale * drawn.eta_scale;
    trace_sample(drawn.wi, drawn.pdf_solid_angle, drawn.weight, drawn.eta_scale, drawn.is_null);
    if HAS_ROULETTE && depth >= ROULETTE_DEPTH && !drawn.is_null {
        // Past depth 64 even a lossless path ends some day.
        let survival = min(max_component(throughput) * eta_scale, select(1.0, 0.999, depth >= 64u));
        trace_roulette(survival);
        if uniform_float(more_random.z) >= survival {
            return shading;
        }
        throughput /= survival;
    }
    shading.alive = true;
    (*path).ray = Ray(offset_origin(surface, drawn.wi), drawn.wi);
    (*path).throughput = throughput;
#if TRANSPARENT_SHADOWS
    // Through a null surface goes the ray that was drawn before.
    (*path).pdf_solid_angle = select(drawn.pdf_solid_angle, incoming.pdf_solid_angle, drawn.is_null);
    (*path).lit_from = select((*path).ray.origin, incoming.lit_from, drawn.is_null);
#else
    (*path).pdf_solid_angle = drawn.pdf_solid_angle;
#endif
#if ATTENUATION
    // Nothing lies behind a surface that is not there.
    if !drawn.is_null {
        (*path).extinction = extinction_towards(surface, drawn.wi, incoming.extinction);
    }
#endif
    (*path).eta_scale = eta_scale;
    (*path).null_vertices += select(0u, 1u, drawn.is_null);
    return shading;
}
#endif
