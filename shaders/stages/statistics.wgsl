// What a render counts on the device.

#if TRACE
// A path that is written down is not counted: its record takes the binding's place, lest a stage need more than eight storage buffers.
fn count_rays(rays: u32) {}

fn count_refused_samples(samples: u32) {}
#else
// Rays traced (low and high word), samples refused because they were not finite.
@group(0) @binding(14) var<storage, read_write> statistics: array<atomic<u32>, 4>;

fn count_rays(rays: u32) {
    let before = atomicAdd(&statistics[0], rays);
    if before + rays < before {
        atomicAdd(&statistics[1], 1u);
    }
}

fn count_refused_samples(samples: u32) {
    atomicAdd(&statistics[2], samples);
}
#endif
