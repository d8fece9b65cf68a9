// Microfacets: sampling of visible normals and Smith shadowing. Local directions: z along the shading normal, x along the tangent.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/material/lobe.wgsl
#import shading/surface.wgsl
#import shading/microfacet/beckmann.wgsl

// GGX, heights correlated, where no flag says otherwise.
struct Facets {
    alpha: f32,
    // Across the tangent.
    alpha_v: f32,
    // The lobe's kind and form.
    flags: u32,
}

fn to_local(frame: Frame, w: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(w, frame.tangent), dot(w, frame.bitangent), dot(w, frame.normal));
}

// The microfacets of a lobe. If one of two widths is too narrow to be resolved, it is raised to the least
// width that is.
fn lobe_facets(lobe: Lobe) -> Facets {
#if ANISOTROPY
    if (lobe.kind & ANISOTROPIC) != 0u {
        let widths = vec2<f32>(lobe.roughness, lobe_width_across(lobe));
        let resolved = select(widths, max(widths, vec2<f32>(DELTA_ALPHA)), max(widths.x, widths.y) >= DELTA_ALPHA);
        return Facets(resolved.x, resolved.y, lobe.kind);
    }
#endif
    return Facets(lobe.roughness, lobe.roughness, lobe.kind);
}

// Too narrow to be told from a smooth surface.
fn facets_are_smooth(facets: Facets) -> bool {
#if ANISOTROPY
    return max(facets.alpha, facets.alpha_v) < DELTA_ALPHA;
#else
    return facets.alpha < DELTA_ALPHA;
#endif
}

// The frame that they lie in.
fn facet_frame(facets: Facets, surface: Surface) -> Frame {
#if ANISOTROPY
    if (facets.flags & ANISOTROPIC) != 0u {
        return frame_along(surface.shading_normal, surface.along_u);
    }
#endif
    return frame_from_normal(surface.shading_normal);
}

// D(m) (Walter et al. 2007). The sine comes from x and y, which keeps narrow lobes accurate.
fn facet_distribution(facets: Facets, m: vec3<f32>) -> f32 {
    let alpha = facets.alpha;
#if ANISOTROPY
    let alpha_v = facets.alpha_v;
    var slopes = (m.x * m.x + m.y * m.y) / (alpha * alpha);
    if (facets.flags & ANISOTROPIC) != 0u {
        slopes = m.x * m.x / (alpha * alpha) + m.y * m.y / (alpha_v * alpha_v);
    }
#else
    let alpha_v = alpha;
    let slopes = (m.x * m.x + m.y * m.y) / (alpha * alpha);
#endif
#if BECKMANN
    if (facets.flags & BECKMANN_FACETS) != 0u {
        let cosine2 = max(m.z * m.z, 1.0e-20);
        return exp(-slopes / cosine2) / (PI * alpha * alpha_v * cosine2 * cosine2);
    }
#endif
    let e = slopes + m.z * m.z;
    return 1.0 / (PI * alpha * alpha_v * e * e);
}

// Smith's Λ(w).
fn facet_lambda(facets: Facets, w: vec3<f32>) -> f32 {
    let alpha = facets.alpha;
    let tan2 = (w.x * w.x + w.y * w.y) / max(w.z * w.z, 1.0e-20);
    var stretched = alpha * alpha * tan2;
#if ANISOTROPY
    if (facets.flags & ANISOTROPIC) != 0u {
        let along = alpha * w.x;
        let across = facets.alpha_v * w.y;
        stretched = (along * along + across * across) / max(w.z * w.z, 1.0e-20);
    }
#endif
#if BECKMANN
    if (facets.flags & BECKMANN_FACETS) != 0u {
        return beckmann_lambda(stretched);
    }
#endif
    return 0.5 * (sqrt(1.0 + stretched) - 1.0);
}

// G2: the share of the microfacets that are seen from both directions.
fn facet_shadowing(facets: Facets, lambda_o: f32, lambda_i: f32) -> f32 {
#if SEPARABLE_MASKING
    if (facets.flags & SEPARABLE_MASKS) != 0u {
        return 1.0 / ((1.0 + lambda_o) * (1.0 + lambda_i));
    }
#endif
    return 1.0 / (1.0 + lambda_o + lambda_i);
}

// G2 / G1(wo): that of those seen from wo.
fn facet_shadowing_of_visible(facets: Facets, lambda_o: f32, lambda_i: f32) -> f32 {
#if SEPARABLE_MASKING
    if (facets.flags & SEPARABLE_MASKS) != 0u {
        return 1.0 / (1.0 + lambda_i);
    }
#endif
    return (1.0 + lambda_o) / (1.0 + lambda_o + lambda_i);
}

// D G2 / (4 cosθo), and the density of the reflected direction; m is the normal between both.
fn facet_reflection(facets: Facets, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>) -> vec2<f32> {
    let lambda_o = facet_lambda(facets, o);
    let unshadowed = facet_distribution(facets, m) / (4.0 * o.z);
    return vec2<f32>(unshadowed * facet_shadowing(facets, lambda_o, facet_lambda(facets, i)), unshadowed / (1.0 + lambda_o));
}

// A microfacet normal visible from wo, by stretching both to a surface of width 1.
fn sample_visible_normal(facets: Facets, wo: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
#if ANISOTROPY
    let stretched = normalize(vec3<f32>(facets.alpha * wo.x, facets.alpha_v * wo.y, wo.z));
#else
    let stretched = normalize(vec3<f32>(facets.alpha * wo.xy, wo.z));
#endif
    let n = visible_normal_of_width_one(facets, stretched, u, v);
#if ANISOTROPY
    return normalize(vec3<f32>(facets.alpha * n.x, facets.alpha_v * n.y, max(1.0e-7, n.z)));
#else
    return normalize(vec3<f32>(facets.alpha * n.xy, max(1.0e-7, n.z)));
#endif
}

// For GGX by Heitz 2018.
fn visible_normal_of_width_one(facets: Facets, wo: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
#if BECKMANN
    if (facets.flags & BECKMANN_FACETS) != 0u {
        return visible_beckmann_normal(wo, u, v);
    }
#endif
    let across2 = dot(wo.xy, wo.xy);
    var axis_x = vec3<f32>(1.0, 0.0, 0.0);
    if across2 > 0.0 {
        axis_x = vec3<f32>(-wo.y, wo.x, 0.0) * inverseSqrt(across2);
    }
    let axis_y = cross(wo, axis_x);
    let circle = sin_cos_turns(v);
    let r = sqrt(u);
    let x = r * circle.y;
    let s = 0.5 * (1.0 + wo.z);
    let y = (1.0 - s) * sqrt(max(0.0, 1.0 - x * x)) + s * (r * circle.x);
    let z = sqrt(max(0.0, 1.0 - x * x - y * y));
    return x * axis_x + y * axis_y + z * wo;
}
