// The plastic model, smooth and rough: a diffuse base of colour color0 below a boundary that reflects color1.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/material/lobe.wgsl

fn plastic_is_bright(lobe: Lobe) -> bool {
    return max_component(lobe.color0) > 0.0;
}

// About what is reflected seen along the normal.
fn plastic_weight(lobe: Lobe) -> f32 {
    let r = (lobe.ior - 1.0) / (lobe.ior + 1.0);
    return max_component(mix(lobe.color0, lobe.color1, r * r));
}

// f of the base, given what the boundary lets through at either angle: ρ / (π η²) To Ti / (1 - R), or 1 - ρR below where it is nonlinear.
// The first further parameter is R, the share of light from within that the boundary sends back.
fn plastic_base(lobe: Lobe, transmitted_o: f32, transmitted_i: f32) -> Spectrum {
#if FURTHER_PARAMETERS
    let internal = further_parameter(lobe, 0u, vec3<f32>(0.0)).x;
#else
    let internal = 0.0;
#endif
    let kept = internal * select(WHITE, lobe.color0, (lobe.kind & NONLINEAR_BASE) != 0u);
    return lobe.color0 / (1.0 - kept) * (INVERSE_PI * transmitted_o * transmitted_i / (lobe.ior * lobe.ior));
}

// Probability of sampling the boundary's reflection, which reflects the share `reflected` of light towards wo.
fn plastic_specular_share(lobe: Lobe, reflected: f32) -> f32 {
    let specular = reflected * (lobe.color1.x + lobe.color1.y + lobe.color1.z);
    let diffuse = (1.0 - reflected) * (lobe.color0.x + lobe.color0.y + lobe.color0.z);
    return specular / max(specular + diffuse, 1.0e-30);
}
