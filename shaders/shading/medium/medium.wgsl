// Media by their numbers, and what they leave of light. src/reference/medium.rs is the same in f64.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl

// All per unit length.
struct Medium {
    extinction: Spectrum,
    scattering: Spectrum,
    emission: Spectrum,
    flags: u32,
    // The first of its phase lobes, and above it their number.
    phase: u32,
    // The first of its volumes, of a medium with grids.
    first_volume: u32,
}

// The medium of a number, which is not 0.
fn load_medium(number: u32) -> Medium {
    let at = FIRST_MEDIUM_WORD + (number - 1u) * MEDIUM_WORDS;
    let extinction = tables[at];
    let scattering = tables[at + 1u];
    let emission = tables[at + 2u];
    return Medium(
        extinction.xyz, scattering.xyz, emission.xyz, bitcast<u32>(extinction.w), bitcast<u32>(scattering.w), bitcast<u32>(emission.w)
    );
}

// Beer and Lambert's law: the share of light that is left after a distance.
fn light_left(extinction: Spectrum, distance: f32) -> Spectrum {
    return exp(-min(extinction * min(distance, FARTHEST), Spectrum(87.0)));
}

// That share within the medium of a number.
fn medium_transmittance(medium: u32, distance: f32) -> Spectrum {
    if medium == 0u {
        return WHITE;
    }
    return light_left(tables[FIRST_MEDIUM_WORD + (medium - 1u) * MEDIUM_WORDS].xyz, distance);
}

// 1 - exp(-x) of x >= 0, which does not cancel where x is small.
fn share_lost(x: f32) -> f32 {
    let series = x * (1.0 - x * (0.5 - x * (0.16666667 - x * (4.1666667e-2 - x * (8.3333333e-3 - x * 1.3888889e-3)))));
    return select(1.0 - exp(-min(x, 87.0)), series, x < 0.25);
}

// That of each channel, by its optical depth.
fn shares_lost(depth: Spectrum) -> Spectrum {
    return Spectrum(share_lost(depth.x), share_lost(depth.y), share_lost(depth.z));
}

// The light that a medium gives off along a ray, as it arrives at the ray's origin.
fn light_given_off(medium: Medium, distance: f32) -> Spectrum {
    let way = min(distance, FARTHEST);
    let depth = medium.extinction * way;
    let mean_way = select(shares_lost(depth) / medium.extinction, Spectrum(way), depth < Spectrum(1.0e-9));
    return medium.emission * mean_way;
}
