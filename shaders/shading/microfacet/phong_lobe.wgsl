// The cosine-power lobe about the mirror direction that `glossy` and `phong` have, and what comparisons change of it.
#import shading/microfacet/cosine_power.wgsl
#import shading/microfacet/hemisphere.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

struct PhongLobe {
    // f |cos|, f = (n+2)/(2π) cosⁿα.
    value: f32,
    // The density of sample_phong_lobe.
    pdf: f32,
}

// Towards a direction above the surface.
fn phong_lobe(surface: Surface, wo: vec3<f32>, exponent: f32, wi: vec3<f32>) -> PhongLobe {
    let axis = mirrored(surface, wo);
    let cosine = dot(wi, surface.shading_normal);
    var spread = cosine_power_pdf(axis, exponent, wi);
    if HAS_PHONG_FLIPPED {
        // The lobe below the surface, in the opposite direction, was turned up.
        spread += cosine_power_pdf(axis, exponent, -wi);
    }
    var projected = cosine;
    if HAS_PHONG_WITHOUT_COSINE {
        projected = 1.0;
    }
    var pdf = spread;
    if HAS_PHONG_BY_HEMISPHERE {
        pdf = hemisphere_pdf(cosine);
    }
    let scale = (exponent + 2.0) / (exponent + 1.0) * projected;
    return PhongLobe(spread * scale, pdf);
}

// A direction, which may be below the surface.
fn sample_phong_lobe(surface: Surface, wo: vec3<f32>, exponent: f32, u: f32, v: f32) -> vec3<f32> {
    if HAS_PHONG_BY_HEMISPHERE {
        return sample_hemisphere(surface, u, v).xyz;
    }
    let wi = sample_cosine_power(mirrored(surface, wo), exponent, u, v);
    if HAS_PHONG_FLIPPED {
        return select(wi, -wi, dot(wi, surface.shading_normal) < 0.0);
    }
    return wi;
}
