// All stages in one kernel, for hierarchies on software devices. The lanes of a subgroup trace samples of one pixel at a time: their
// camera rays and shadow rays are neighbours, which visit the same nodes at the same time.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/software/lanes.wgsl
#import core/parameters.wgsl
#import shading/path/path.wgsl
#import stages/film.wgsl
#import stages/fused_pixels.wgsl
#import stages/fused_vertex.wgsl
#import stages/statistics.wgsl

// Radiance of whole paths, for the lanes that have one, all on the same vertex at a time; counts their rays.
// All lanes take part.
fn path_radiance(first: Path, exists: bool, rays: ptr<function, u32>) -> Spectrum {
    var path = first;
    var radiance = BLACK;
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

// Index in the pass of the first of LANES pixels that nobody took before. All lanes take part.
fn take_pixels_together() -> u32 {
    var first = 0u;
    if lane == 0u {
        first = take_pixels(LANES);
    }
    return subgroupShuffle(first, 0u);
}

// All samples of LANES pixels, the first of which has this index in the pass, added to the film in the order of the samples: pixel after pixel, each
// lane one sample of it; or, of passes with few samples, each lane all samples of one pixel. Counts rays. All lanes take part.
fn render_pixels(first_pixel: u32, rays: ptr<function, u32>) {
    let samples = pass_parameters.sample_count;
    // How many lanes share a pixel: all, or one.
    let sharing = select(1u, LANES, samples > LANES / 2u);
    let rounds = (samples + sharing - 1u) / sharing;
    var film_pixel: FilmPixel;
    for (var turn = 0u; turn < LANES; turn += LANES / sharing) {
        let own_index = first_pixel + select(lane, turn, sharing == LANES);
        let exists = own_index < pass_parameters.pixel_count;
        // All lanes take part in exchanges, those without a pixel of their own with another's.
        let pixel = pass_pixel(min(own_index, pass_parameters.pixel_count - 1u));
        film_pixel = load_film_pixel(pixel.in_band);
        for (var round = 0u; round < rounds; round++) {
            let sample = select(round, round * LANES + lane, sharing == LANES);
            let path = start_path(pixel.pixel, min(sample, samples - 1u));
            let radiance = path_radiance(path, exists && sample < samples, rays);
            for (var other = 0u; other < min(sharing, samples - round * sharing); other++) {
                add_sample(&film_pixel, subgroupShuffle(radiance, select(lane, other, sharing == LANES)));
            }
        }
        if exists && (sharing == 1u || lane == 0u) {
            store_film_pixel(pixel.in_band, film_pixel);
        }
    }
}

// Reads the pass's parameters. A subgroup, LANES invocations, traces all samples of LANES pixels at a time, as long as any are left, and adds them to
// the film. Counts rays. Leaves everything else alone.
@compute @workgroup_size(WORKGROUP)
fn trace_paths(@builtin(local_invocation_index) invocation: u32) {
    lane = invocation % LANES;
    var rays = 0u;
    for (var first = take_pixels_together(); first < pass_parameters.pixel_count; first = take_pixels_together()) {
        render_pixels(first, &rays);
    }
    count_rays(rays);
}
