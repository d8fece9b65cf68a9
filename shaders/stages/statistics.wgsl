// What a render counts on the device.
#import core/layout.wgsl
#import core/parameters.wgsl

#if TRACE
// A path that is written down is not counted: its record takes the binding's place, lest a stage need more than eight storage buffers.
fn count_rays(rays: u32) {}

fn count_refused_samples(samples: u32) {}

fn count_clamped_samples(samples: u32, units: u32) {}
#else
#if PIXEL_LIST
// The counts: rays traced (low and high word); samples refused because they were not finite; samples that were clamped, and 1024ths of the
// clamp that this took of their luminance (low and high word); pixels of the pass that were taken. Then the pixels, in the same binding lest a stage need more than
// eight storage buffers, the band's pixels in the order in which passes take them.
struct Statistics {
    counts: array<atomic<u32>, 8>,
    pixels: array<u32>,
}

@group(0) @binding(BINDING_STATISTICS) var<storage, read_write> statistics: Statistics;

fn count_rays(rays: u32) {
    let before = atomicAdd(&statistics.counts[0], rays);
    if before + rays < before {
        atomicAdd(&statistics.counts[1], 1u);
    }
}

fn count_refused_samples(samples: u32) {
    atomicAdd(&statistics.counts[2], samples);
}

fn count_clamped_samples(samples: u32, units: u32) {
    atomicAdd(&statistics.counts[3], samples);
    let before = atomicAdd(&statistics.counts[4], units);
    if before + units < before {
        atomicAdd(&statistics.counts[5], 1u);
    }
}

fn take_pixels(count: u32) -> u32 {
    return atomicAdd(&statistics.counts[6], count);
}

// Of the pixel with this index in the pass.
fn listed_pixel_in_band(index: u32) -> u32 {
    return statistics.pixels[pass_parameters.first_pixel_in_band + index];
}
#else
// Rays traced (low and high word); samples refused because they were not finite; samples that were clamped, and 1024ths of the clamp that this
// took of their luminance (low and high word); pixels of the pass that were taken.
@group(0) @binding(BINDING_STATISTICS) var<storage, read_write> statistics: array<atomic<u32>, 8>;

fn count_rays(rays: u32) {
    let before = atomicAdd(&statistics[0], rays);
    if before + rays < before {
        atomicAdd(&statistics[1], 1u);
    }
}

fn count_refused_samples(samples: u32) {
    atomicAdd(&statistics[2], samples);
}

fn count_clamped_samples(samples: u32, units: u32) {
    atomicAdd(&statistics[3], samples);
    let before = atomicAdd(&statistics[4], units);
    if before + units < before {
        atomicAdd(&statistics[5], 1u);
    }
}

// Index in the pass of the first of `count` pixels that nobody took before; beyond the pass's pixels where none is left.
fn take_pixels(count: u32) -> u32 {
    return atomicAdd(&statistics[6], count);
}
#endif
#endif
