// Volumes that take light and scatter none, behind the surfaces that enclose them.
#import core/layout.wgsl
#import core/spectrum.wgsl
#import geometry/scene.wgsl
#import shading/surface.wgsl

// Share of light that is left after a distance within a volume.
fn volume_transmittance(extinction: Spectrum, distance: f32) -> Spectrum {
    return exp(-min(extinction * min(distance, FARTHEST), Spectrum(87.0)));
}

// Extinction on the side of a surface that `toward` points to, given that on wo's side.
fn extinction_towards(surface: Surface, toward: vec3<f32>, here: Spectrum) -> Spectrum {
    let word = surface.material * MATERIAL_WORDS;
    let encloses = (bitcast<u32>(tables[word + 2u].w) & ENCLOSES_VOLUME) != 0u;
    if !encloses || dot(toward, surface.facing_normal) > 0.0 {
        return here;
    }
    if !surface.front {
        return BLACK;
    }
#if BLENDS
    if (bitcast<u32>(tables[word].w) & 255u) == BLEND {
        return tables[word].xyz;
    }
#endif
    let first = FIRST_FURTHER_WORD + (bitcast<u32>(tables[word + 4u].w) & ((1u << FURTHER_SHIFT) - 1u));
    return tables[first + EXTINCTION_PARAMETER].xyz;
}
