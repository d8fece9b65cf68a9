// Scattering by a medium's phase function and by a guide together. src/reference/guided.rs is the same in f64.
#import core/layout.wgsl
#import shading/material/scattering.wgsl
#import shading/medium/phase.wgsl
#import shading/path/guide.wgsl

// The value of the phase function, and the density with which wi is drawn.
fn evaluate_guided_phase(cell: GuideCell, phase: u32, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    var value = evaluate_phase(phase, wo, wi);
    if cell.share > 0.0 {
        value.pdf_solid_angle = (1.0 - cell.share) * value.pdf_solid_angle + cell.share * guide_pdf_in_medium(cell, wi);
    }
    return value;
}

fn sample_guided_phase(cell: GuideCell, phase: u32, wo: vec3<f32>, choice: f32, u: f32, v: f32) -> BsdfSample {
    var wi = vec3<f32>(0.0);
    if choice < cell.share {
        wi = guided_direction(cell, u, v);
    } else {
        let left = clamp((choice - cell.share) / (1.0 - cell.share), 0.0, LARGEST_NUMBER);
        wi = sample_phase(phase, wo, left, u, v).wi;
    }
    return from_value(wi, evaluate_guided_phase(cell, phase, wo, wi), 1.0);
}
