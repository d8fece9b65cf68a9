// All stages in one kernel, for hierarchies on software devices. The lanes of a subgroup trace samples of one pixel at a time: their
// camera rays and shadow rays are neighbours, which visit the same nodes at the same time.
#import core/lanes.wgsl
#import geometry/closest.wgsl
#import geometry/packet.wgsl
#import shading/path.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl

// What the ray meets first, of the lanes that have one.
fn nearest(ray: Ray, has_ray: bool) -> Hit {
    return closest_hit_together(ray, select(-1.0, INFINITY_DISTANCE, has_ray));
}

#if LIGHTS
// Whether nothing is in the shadow ray's way, of the lanes that have one.
fn is_lit(shadow: ShadowRay, has_ray: bool) -> bool {
    return !occluded_together(shadow.ray, select(-1.0, shadow.distance, has_ray)) && has_ray;
}
#endif

// What whole paths bring, of the lanes that have one, all on the same vertex at a time; counts their rays. All lanes take part.
fn path_radiance(first: Path, exists: bool, rays: ptr<function, u32>) -> vec3<f32> {
    var path = first;
    var radiance = vec3<f32>(0.0);
    var visit = 1u;
    var alive = exists;
    loop {
        let hit = nearest(path.ray, alive);
        var vertex = Vertex(false, vec3<f32>(0.0), no_shadow());
#if SEVERAL_LIGHT_SAMPLES
        let incoming = path;
        var lit: LitSurface;
        if alive {
            lit = lit_surface(path, hit, visit);
        }
        var number = 1u;
#endif
        if alive {
            vertex = shade_vertex(&path, hit, visit);
            radiance += vertex.radiance;
            (*rays)++;
        }
        alive = vertex.alive;
#if LIGHTS
        var shadow = vertex.shadow;
#if SEVERAL_LIGHT_SAMPLES
        // One shadow ray a turn, the next one made at its end.
        loop {
#endif
        let asks = any(shadow.radiance != vec3<f32>(0.0));
        (*rays) += select(0u, 1u, asks);
        if is_lit(shadow, asks) {
            radiance += shadow.radiance;
        }
#if SEVERAL_LIGHT_SAMPLES
            let goes_on = lit.takes_more && number < LIGHT_SAMPLES;
            shadow = no_shadow();
            if goes_on {
                shadow = more_light(incoming, lit, visit, number);
            }
            number++;
            continuing {
                break if !any_lane(goes_on);
            }
        }
#endif
#endif
        visit++;
        continuing {
            break if !any_lane(alive);
        }
    }
    return radiance;
}

// Reads the pass's parameters. LANES invocations, a subgroup, trace all samples of LANES pixels and add them to the film, in the order
// of the samples: pixel after pixel, each lane one sample of it; or, of passes with few samples, each lane all samples of one pixel.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let place = place_in_pass(workgroup.x, invocation);
    lane = invocation % LANES;
    let samples = pass_parameters.sample_count;
    // How many lanes share a pixel: all, or one.
    let sharing = select(1u, LANES, samples > LANES / 2u);
    let rounds = (samples + sharing - 1u) / sharing;
    var film_pixel: FilmPixel;
    var rays = 0u;
    for (var turn = 0u; turn < LANES; turn += LANES / sharing) {
        let own_place = select(place, place - lane + turn, sharing == LANES);
        let exists = own_place < pass_parameters.pixel_count;
        // All lanes take part in exchanges, those without a pixel of their own with another's.
        let pixel = pass_pixel(min(own_place, pass_parameters.pixel_count - 1u));
        film_pixel = load_film_pixel(pixel.in_band);
        for (var round = 0u; round < rounds; round++) {
            let sample = select(round, round * LANES + lane, sharing == LANES);
            let path = start_path(pixel.pixel, min(sample, samples - 1u));
            let radiance = path_radiance(path, exists && sample < samples, &rays);
            for (var other = 0u; other < min(sharing, samples - round * sharing); other++) {
                add_sample(&film_pixel, subgroupShuffle(radiance, select(lane, other, sharing == LANES)));
            }
        }
        if exists && (sharing == 1u || lane == 0u) {
            store_film_pixel(pixel.in_band, film_pixel);
        }
    }
    count_rays(rays);
}
