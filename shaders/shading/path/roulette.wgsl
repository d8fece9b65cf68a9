// Russian roulette: which paths go on. src/reference/roulette.rs is the same in f64, and says why.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/path/record.wgsl
#import shading/path/scatterer.wgsl
#import shading/path/guide.wgsl

struct Roulette {
    // The chance to survive.
    survival: f32,
    // For the path's next surface: see `Path`.
    scale: f32,
}

// At a surface where `incoming` arrived, and from which it would go on with this throughput; `eta_scale` is that of the refraction.
fn roulette_at(incoming: Path, scatterer: Scatterer, throughput: Spectrum, eta_scale: f32, depth: u32) -> Roulette {
    let largest = select(1.0, LARGEST_SURVIVAL, depth >= CERTAIN_ROULETTE_DEPTH);
#if GUIDE
    // In scenes with media that scatter no path is judged by its guide: see src/reference/integrator.rs.
    if HAS_SCATTERING || scatterer.guide.share == 0.0 {
        return Roulette(largest, incoming.roulette_scale);
    }
    let is_first = incoming.roulette_scale == 0.0;
    let expected = dot(incoming.throughput, WHITE) * guide_sent_on(scatterer.guide, is_first);
    if is_first {
        return Roulette(largest, select(0.0, 1.0 / expected, expected > 0.0));
    }
    let survival = sqrt(SURVIVAL_FACTOR * expected * incoming.roulette_scale);
    return Roulette(min(max(survival, LEAST_SURVIVAL), largest), incoming.roulette_scale);
#else
    let scale = incoming.roulette_scale * eta_scale;
    return Roulette(min(max_component(throughput) * scale, largest), scale);
#endif
}
