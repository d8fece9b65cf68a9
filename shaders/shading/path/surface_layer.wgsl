// Layers of surfaces: what a render reports in place of radiance, of the first surface that a path meets, or of the first that does not reflect
// or refract it as a mirror does. src/reference/layer.rs is the same in f64.
#import core/layout.wgsl
#import core/math.wgsl
#import core/parameters.wgsl
#import core/sampler.wgsl
#import shading/light/hidden_emitters.wgsl
#import shading/path/object_layer.wgsl
#import shading/path/record.wgsl
#import shading/path/scatterer.wgsl
#import shading/material/scattering.wgsl
#import shading/surface.wgsl
#import shading/path/trace.wgsl

// Stands for the value where nothing is met. Its square is not finite: the film counts no such sample.
const NOTHING_MET: f32 = 3.0e38;

// True where the layer belongs to the surface that is seen along the drawn direction.
fn is_followed(drawn: BsdfSample) -> bool {
    let goes_on = drawn.pdf_solid_angle < 0.0 && max_component(drawn.weight) > 0.0;
    if HAS_LAYER_OF_FIRST_SURFACE {
        return goes_on && drawn.is_null;
    } else {
        return goes_on;
    }
}

// The layer's value at a surface that a path of this throughput met and that is not followed further.
fn surface_value(path: Path, hit: Hit, surface: Surface, drawn: BsdfSample) -> vec3<f32> {
    if HAS_LAYER_ALBEDO {
        return path.throughput * drawn.weight;
    } else if HAS_LAYER_NORMAL {
        return surface.shading_normal;
    } else if HAS_LAYER_POSITION {
        return surface.position;
    } else if HAS_LAYER_UV {
        return vec3<f32>(surface.uv.xy, 0.0);
    } else if HAS_LAYER_OBJECT_POSITION {
        return object_position(hit, surface.position);
    } else if HAS_LAYER_MOTION {
        return screen_motion(hit, path.pixel, surface.position, NOTHING_MET);
    } else if HAS_DEPTH_BY_DISTANCE {
        return vec3<f32>(distance(surface.position, view.position.xyz));
    } else {
        return vec3<f32>(dot(surface.position - view.position.xyz, view.forward.xyz));
    }
}

// Follows a path whose ray met `hit`, its vertex number `vertex`, to the surface that the layer is of: replaces `path`, or returns the layer's
// value as what was found.
fn shade_vertex(path: ptr<function, Path>, hit: Hit, vertex: u32) -> Shading {
    var incoming = *path;
    let wo = -incoming.ray.direction;
    var shading = no_shading();
    if HAS_BLIND_PIXELS && is_blind(incoming, vertex) {
        shading.radiance = vec3<f32>(NOTHING_MET);
        return shading;
    }
    trace_arrival(incoming.ray.direction, incoming.pdf_solid_angle, incoming.throughput, hit.primitive);
    if hit.primitive == NONE {
        shading.radiance = vec3<f32>(NOTHING_MET);
        return shading;
    }
    var surface = hit_surface(incoming.ray, hit);
    if HAS_WEIGHTS_BY_VIEWER {
        surface.by_camera = depth_at(incoming, vertex) == 1u;
    }
    incoming.throughput = arriving_throughput(incoming, distance(surface.position, incoming.ray.origin));
    trace_surface(surface.position, surface.shading_normal, surface.material);
    if HAS_HIDDEN_EMITTERS && depth_at(incoming, vertex) == 1u && gives_light(surface.material) {
        shading.alive = true;
        *path = path_behind(incoming, surface);
        return shading;
    }
    var drawn = no_sample();
    if depth_at(incoming, vertex) < MAX_DEPTH {
        let random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex);
        let more_random = random_block(incoming.pixel, incoming.sample_in_pass, 2u * vertex + 1u);
        let scatterer = load_scatterer(surface, wo, uniform_float(more_random.w), key_of_stack(random.w, more_random.w));
        let scattering = scatter_by(
            scatterer, surface, wo, false, wo, 0u, uniform_float(random.w), uniform_float(more_random.x), uniform_float(more_random.y)
        );
        drawn = scattering.drawn;
    }
    if !is_followed(drawn) {
        shading.radiance = surface_value(incoming, hit, surface, drawn);
        return shading;
    }
    shading.alive = true;
    *path = extended_path(incoming, surface, drawn, incoming.throughput * drawn.weight, incoming.roulette_scale);
    return shading;
}
