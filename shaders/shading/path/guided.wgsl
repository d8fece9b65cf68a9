// Scattering by a surface's BSDF and by a guide together. src/reference/guided.rs is the same in f64, and says how they share directions.
#import core/layout.wgsl
#import shading/material/bsdf.wgsl
#import shading/path/guide.wgsl
#import shading/material/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

// The density of a direction that the BSDF alone draws with density `of_bsdf`.
fn shared_pdf(cell: GuideCell, surface: Surface, wi: vec3<f32>, of_bsdf: f32) -> f32 {
    if cell.share == 0.0 {
        return of_bsdf;
    }
    return (1.0 - cell.share) * of_bsdf + cell.share * guide_pdf(cell, surface, wi);
}

// The non-delta lobes' f |cos|, and the density with which wi is drawn.
fn evaluate_guided(cell: GuideCell, bsdf: Bsdf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    let alone = evaluate_bsdf(bsdf, surface, wo, wi);
    return BsdfValue(alone.value, shared_pdf(cell, surface, wi, alone.pdf_solid_angle));
}

// Variant of `scatter` for guided paths. The surface is evaluated in one place of the code, for drivers that
// inline every call.
fn scatter_guided(
    cell: GuideCell, bsdf: Bsdf, surface: Surface, wo: vec3<f32>, samples_light: bool, light_wi: vec3<f32>, choice: f32, u: f32, v: f32
) -> Scattering {
    let by_guide = choice < cell.share;
    let left = clamp((choice - cell.share) / (1.0 - cell.share), 0.0, LARGEST_NUMBER);
    var drawn = no_sample();
    var is_open = false;
#if MORE_LOBES
    var draw = Draw(no_sample(), false);
#endif
    if by_guide {
        drawn.wi = guided_direction(cell, u, v);
        is_open = on_wo_side(surface, drawn.wi);
    } else {
        if HAS_MORE_LOBES {
            draw = draw_direction(bsdf, surface, wo, left, u, v);
            drawn = draw.chosen;
            is_open = draw.mixed;
        } else {
            drawn = sample_bsdf(bsdf, surface, wo, left, u, v);
        }
    }
    var light_value = no_value();
    var draw_value = no_value();
    for (var direction = select(1u, 0u, HAS_LIGHTS); direction < 2u; direction++) {
        let towards_light = direction == 0u;
        if select(is_open, samples_light, towards_light) {
            let value = evaluate_bsdf(bsdf, surface, wo, select(drawn.wi, light_wi, towards_light));
            if towards_light {
                light_value = value;
            } else {
                draw_value = value;
            }
        }
    }
    if samples_light {
        light_value.pdf_solid_angle = shared_pdf(cell, surface, light_wi, light_value.pdf_solid_angle);
    }
    if by_guide && !is_open {
        return shadowed(Scattering(light_value, no_sample()), surface, light_wi);
    }
    if HAS_MORE_LOBES && !by_guide {
        drawn = mixed_sample(draw, draw_value);
    }
    if !by_guide && drawn.pdf_solid_angle < 0.0 {
        // The guide leaves delta lobes to the BSDF.
        drawn.weight /= 1.0 - cell.share;
        return shadowed(Scattering(light_value, drawn), surface, light_wi);
    }
    let alone = select(drawn.pdf_solid_angle, draw_value.pdf_solid_angle, by_guide);
    let value = select(drawn.weight * alone, draw_value.value, by_guide);
    let together = shared_pdf(cell, surface, drawn.wi, alone);
    if cell.share > 0.0 {
        drawn = from_value(drawn.wi, BsdfValue(value, together), drawn.eta_scale);
    }
    return shadowed(Scattering(light_value, drawn), surface, light_wi);
}
