// All stages in one kernel, for hierarchies on software devices. The lanes of a subgroup trace samples of one pixel at a time: their
// camera rays and shadow rays are neighbours, which visit the same nodes at the same time.
#import core/layout.wgsl
#import geometry/software/lanes.wgsl
#import core/parameters.wgsl
#import shading/path.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl
#import stages/fused_vertex.wgsl
#import stages/statistics.wgsl

// What whole paths bring, of the lanes that have one, all on the same vertex at a time; counts their rays. All lanes take part.
fn path_radiance(first: Path, exists: bool, rays: ptr<function, u32>) -> vec3<f32> {
    var path = first;
    var radiance = vec3<f32>(0.0);
    var vertex = 1u;
    var alive = exists;
    loop {
        alive = trace_vertex(&path, vertex, alive, &radiance, rays);
        vertex++;
        continuing {
            break if !any_lane(alive);
        }
    }
    return radiance;
}

// Reads the pass's parameters. LANES invocations, a subgroup, trace all samples of LANES pixels and add them to the film, in the order
// of the samples: pixel after pixel, each lane one sample of it; or, of passes with few samples, each lane all samples of one pixel.
// Counts rays. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(workgroup_id) workgroup: vec3<u32>, @builtin(local_invocation_index) invocation: u32) {
    let index = index_in_pass(workgroup.x, invocation);
    lane = invocation % LANES;
    let samples = pass_parameters.sample_count;
    // How many lanes share a pixel: all, or one.
    let sharing = select(1u, LANES, samples > LANES / 2u);
    let rounds = (samples + sharing - 1u) / sharing;
    var film_pixel: FilmPixel;
    var rays = 0u;
    for (var turn = 0u; turn < LANES; turn += LANES / sharing) {
        let own_index = select(index, index - lane + turn, sharing == LANES);
        let exists = own_index < pass_parameters.pixel_count;
        // All lanes take part in exchanges, those without a pixel of their own with another's.
        let pixel = pass_pixel(min(own_index, pass_parameters.pixel_count - 1u));
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
