// Counters of a render on the device; src/plan/counters.rs says which words they are.
#import core/layout.wgsl
#import core/parameters.wgsl

#if TRACE
// A path that is written down is not counted: its record takes the binding's place, lest a stage need more than eight storage buffers.
fn count_rays(rays: u32) {}

fn count_refused_samples(samples: u32) {}

fn count_clamped_samples(samples: u32, units: u32) {}
#else
struct Statistics {
    counters: array<atomic<u32>, COUNTER_WORDS>,
#if PIXEL_LIST
    // The band's pixels in the order in which passes take them, in the same binding lest a stage need more than eight storage buffers.
    pixels: array<u32>,
#endif
}

@group(0) @binding(BINDING_STATISTICS) var<storage, read_write> statistics: Statistics;

// Adds to a counter of two words, the low one first.
fn count(counter: u32, number: u32) {
    let before = atomicAdd(&statistics.counters[counter], number);
    if before + number < before {
        atomicAdd(&statistics.counters[counter + 1u], 1u);
    }
}

fn count_rays(rays: u32) {
    count(RAYS_COUNTER, rays);
}

fn count_refused_samples(samples: u32) {
    count(REFUSED_COUNTER, samples);
}

fn count_clamped_samples(samples: u32, units: u32) {
    count(CLAMPED_COUNTER, samples);
    count(CLAMPED_UNITS_COUNTER, units);
}

// Index in the pass of the first of `count` pixels that nobody took before; beyond the pass's pixels where none is left.
fn take_pixels(count: u32) -> u32 {
    return atomicAdd(&statistics.counters[TAKEN_COUNTER], count);
}

// The pixel with this index in the pass.
fn listed_pixel_in_band(index: u32) -> u32 {
    return statistics.pixels[pass_parameters.first_pixel_in_band + index];
}
#endif
