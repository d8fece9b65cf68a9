// The path step that every kernel shares: what happens where a path's ray ends. src/reference/integrator.rs is the same estimator in f64.
//
// A path's vertices are counted from 1, the first surface that the camera sees. Its depth counts edges: 1 is the camera's ray. The two
// differ where rays go on through null surfaces: such a vertex ends no edge.
#import core/layout.wgsl
#import core/math.wgsl
#import core/sampler.wgsl
#import shading/material/bsdf.wgsl
#import shading/light/choice.wgsl
#import shading/path/arrival.wgsl
#import shading/light/sampling.wgsl
#import shading/light/hidden_emitters.wgsl
#import shading/path/layer.wgsl
#import shading/light/light_sample.wgsl
#if LIGHT_LINKS
#import shading/light/links.wgsl
#endif
#import shading/path/mis.wgsl
#import shading/medium/medium.wgsl
#import shading/medium/stack.wgsl
#import shading/light/outside.wgsl
#export shading/path/record.wgsl
#import shading/path/planted.wgsl
#import shading/path/roulette.wgsl
#import shading/path/scatterer.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/path/trace.wgsl
#if LAYER_OF_SURFACES
#export shading/path/surface_layer.wgsl
#endif

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
fn escaped_radiance(path: Path, depth: u32) -> Spectrum {
    if !HAS_ENVIRONMENT || HAS_OUTSIDE_UNSEEN || (HAS_HIDDEN_EMITTERS && depth == 1u) {
        return BLACK;
    }
#if LIGHT_LINKS
    if !mask_lights(OUTSIDE_LINK, path.receiver) {
        return BLACK;
    }
#endif
    var radiance = path.throughput * outside_radiance(path.ray.direction);
    var weight = 1.0;
    // After the camera or a delta lobe no light sample could have found it.
    if HAS_ENVIRONMENT_SAMPLED && path.pdf_solid_angle >= 0.0 {
        let ray = ray_from_reference_point(path);
        let of_one = environment_pdf_solid_angle(ray, light_context(ray.origin, facing_at_reference_point(path)));
        let pdf_light = f32(light_samples_at(depth - 1u)) * of_one;
        weight = emission_weight(path.pdf_solid_angle, pdf_light);
        radiance *= weight;
    }
    trace_found(radiance, weight);
    return in_layer(radiance, depth);
}

// Radiance that a path gains from the emission of a surface that its ray, of this depth, met.
fn emitted_radiance(path: Path, surface: Surface, depth: u32) -> Spectrum {
    var radiance = BLACK;
    if HAS_EMISSION {
#if LIGHT_LINKS
        if !mask_lights(link_of_material(surface.material), path.receiver) {
            return radiance;
        }
#endif
        let emitted = material_emission(surface.material, seen_along(surface, -path.ray.direction), surface.uv);
        if max_component(emitted) > 0.0 {
            var weight = 1.0;
            if HAS_LIGHTS {
                let of_one = light_pdf_solid_angle(ray_from_reference_point(path), facing_at_reference_point(path), surface);
                let pdf_light = f32(light_samples_at(depth - 1u)) * of_one;
                weight = emission_weight(path.pdf_solid_angle, pdf_light);
            }
            radiance = path.throughput * emitted * weight;
            trace_found(radiance, weight);
            radiance = in_layer(radiance, depth);
        }
    }
    return radiance;
}

// The point that light sampling looks from.
fn shading_point(surface: Surface) -> vec3<f32> {
    return surface.position + surface.error * surface.facing_normal;
}

// The shadow ray of one of the light samples that a surface takes, chosen by `light_bits`, given the surface's value towards it.
fn shadow_ray(path: Path, surface: Surface, depth: u32, light: LightSample, light_bits: vec4<u32>, value: BsdfValue) -> ShadowRay {
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
    if HAS_MEDIA && !HAS_OPEN_BOUNDARIES {
        // No boundary lets a shadow ray through, so it stays in the medium where it begins.
        let media = media_towards(surface, light.wi, path.media);
        radiance *= medium_transmittance(innermost(media), light.distance);
    }
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
    let chosen = traced_light(sampled_from, facing_of(surface), light_bits.x);
    trace_light(light.wi, pdf_light, radiance, weight, chosen, value.pdf_solid_angle);
    var shadow: ShadowRay;
    shadow.ray = ray;
    shadow.distance = ray_length;
    shadow.radiance = in_layer(radiance, depth + 1u);
    if HAS_OPEN_BOUNDARIES {
        shadow.media = media_towards(surface, light.wi, path.media);
        shadow.key = key_of_light(light_bits);
    }
    return shadow;
}

// The shadow ray of light sample `number`, not the first, of a vertex that takes more.
fn further_shadow_ray(shaded: ShadedVertex, number: u32) -> ShadowRay {
    let depth = depth_at(shaded.path, shaded.vertex);
    let light_bits = further_light_bits(shaded.path.pixel, shaded.path.sample_in_pass, shaded.vertex, depth, number);
    let light = sample_light(
        shading_point(shaded.surface), facing_of(shaded.surface), light_bits
#if LIGHT_LINKS
        , shaded.surface.receiver
#endif
    );
    let value = evaluate_scatterer(shaded.scatterer, shaded.surface, -shaded.path.ray.direction, light.wi, key_of_light(light_bits));
    return shadow_ray(shaded.path, shaded.surface, depth, light, light_bits, value);
}

#if !LAYER_OF_SURFACES
// The end of a path that leaves the scene.
fn shading_outside(path: Path, depth: u32) -> Shading {
    trace_arrival(path.ray.direction, path.pdf_solid_angle, path.throughput, NONE);
    var shading = no_shading();
    shading.radiance = escaped_radiance(path, depth);
    return shading;
}

// Extends a path whose ray met `hit`, its vertex number `vertex`: replaces `path`, returns what was found.
fn shade_vertex(path: ptr<function, Path>, hit: Hit, vertex: u32) -> Shading {
    var incoming = *path;
    let depth = depth_at(incoming, vertex);
    let wo = -incoming.ray.direction;
    let has_left = hit.primitive == NONE;
    var shading = no_shading();
    if HAS_BLIND_PIXELS && is_blind(incoming, vertex) {
        return shading;
    }
    var surface: Surface;
    // Not 0 where a medium scatters the path before it comes to the end of its ray.
    var phase = 0u;
    if HAS_MEDIA {
        // A hit in an instance may come without its distance.
        var ray_length = INFINITY_DISTANCE;
        if !has_left {
            surface = hit_surface(incoming.ray, hit);
            ray_length = distance(surface.position, incoming.ray.origin);
        }
        let arrival = arrive(incoming, ray_length, vertex);
        incoming.throughput = arrival.throughput;
        shading.radiance = in_layer(arrival.radiance, depth);
        phase = arrival.phase;
        if phase != 0u {
            surface = medium_surface(incoming.ray, arrival.distance);
#if LIGHT_LINKS
            surface.receiver = receiver_of_medium(innermost(incoming.media));
#endif
        } else if has_left {
            shading.radiance += shading_outside(incoming, depth).radiance;
            return shading;
        }
    } else {
        if has_left {
            return shading_outside(incoming, depth);
        }
        surface = hit_surface(incoming.ray, hit);
    }
    if HAS_WEIGHTS_BY_VIEWER {
        surface.by_camera = depth == 1u;
    }
#if CARRIED_LIGHT
    surface.carried = incoming.throughput;
#endif
    trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
    trace_surface(surface.position, surface.shading_normal, surface.material);
    if HAS_SCATTERING && phase != 0u {
        trace_medium();
    }
    if HAS_HIDDEN_EMITTERS && phase == 0u && depth == 1u && gives_light(surface.material) {
        shading.alive = true;
        *path = path_behind(incoming, surface);
        return shading;
    }
    if phase == 0u {
        shading.radiance += emitted_radiance(incoming, surface, depth);
    }

    // The last edge may go on through null surfaces.
    let last_edge = depth == MAX_DEPTH;
    if last_edge && (phase != 0u || !HAS_NULL_SURFACES) {
        return shading;
    }
    let random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex);
    let more_random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex + 1u);
    let scatterer = scatterer_at(surface, phase, wo, uniform_float(more_random.w), key_of_stack(random.w, more_random.w));
    var samples_light = HAS_LIGHTS && has_non_delta_scattering(scatterer) && !last_edge;
    var roulette_bits = more_random.z;
    var goes_on = true;
    if HAS_ESTIMATOR_CHOOSE {
        if samples_light {
            // The first bit chooses, with a chance of one half each; the others are left for roulette.
            samples_light = (roulette_bits >> 31u) == 0u;
            goes_on = !samples_light;
            roulette_bits = roulette_bits << 1u;
            incoming.throughput *= 2.0;
        }
    }
    var light = no_light();
    if samples_light {
        light = sample_light(
            shading_point(surface), facing_of(surface), random
#if LIGHT_LINKS
            , surface.receiver
#endif
        );
    }
    let scattering = scatter_by(
        scatterer, surface, wo, samples_light, light.wi, key_of_light(random), uniform_float(random.w), uniform_float(more_random.x),
        uniform_float(more_random.y)
    );
    if samples_light {
        shading.light_samples = light_samples_at(depth);
        shading.shadow = shadow_ray(incoming, surface, depth, light, random, scattering.towards_light);
        shading.shaded = ShadedVertex(incoming, vertex, surface, scatterer);
    }

    if HAS_ESTIMATOR_CHOOSE {
        if !goes_on {
            return shading;
        }
    }
    let drawn = scattering.drawn;
    if HAS_NULL_SURFACES && last_edge && !drawn.is_null {
        return shading;
    }
    var throughput = incoming.throughput * drawn.weight * planted_factor(surface.material);
    if max_component(throughput) <= 0.0 {
        return shading;
    }
    trace_sample(drawn.wi, drawn.pdf_solid_angle, drawn.weight, drawn.eta_scale, drawn.is_null);
    var roulette_scale = incoming.roulette_scale;
    if HAS_ROULETTE && !drawn.is_null {
        let roulette = roulette_at(incoming, scatterer, throughput, drawn.eta_scale, depth);
        roulette_scale = roulette.scale;
        if depth >= ROULETTE_DEPTH {
            trace_roulette(roulette.survival);
            if uniform_float(roulette_bits) >= roulette.survival {
                return shading;
            }
            throughput /= roulette.survival;
        }
    }
    shading.alive = true;
    *path = extended_path(incoming, surface, drawn, throughput, roulette_scale);
    return shading;
}
#endif
