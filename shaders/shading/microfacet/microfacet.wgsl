// Microfacets: sampling of visible normals and Smith shadowing. Local directions: z along the shading normal,
// x along the tangent.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/material/lobe.wgsl
#import shading/surface.wgsl
#import shading/microfacet/beckmann.wgsl

// Microfacets of GGX with correlated heights, unless a flag says otherwise.
struct Facets {
    // The width: along the tangent, and across it.
    alpha: f32,
    alpha_v: f32,
    // The lobe's kind and form.
    flags: u32,
}

fn to_local(frame: Frame, w: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(w, frame.tangent), dot(w, frame.bitangent), dot(w, frame.normal));
}

// Microfacets of a lobe, given its parameter `width_across`. The narrower of two widths is not below the
// smallest that is resolved if the wider one is not.
fn lobe_facets(lobe: Lobe, width_across: f32) -> Facets {
    if HAS_ANISOTROPY && (lobe.kind & ANISOTROPIC) != 0u {
        let across = select(width_across, width_across * width_across, (lobe.kind & ACROSS_IS_SQUARED) != 0u);
        let widths = vec2<f32>(lobe.roughness, across);
        let resolved = select(widths, max(widths, vec2<f32>(DELTA_ALPHA)), max(widths.x, widths.y) >= DELTA_ALPHA);
        return Facets(resolved.x, resolved.y, lobe.kind);
    }
    return isotropic_facets(lobe);
}

// Microfacets of a lobe that have one width.
fn isotropic_facets(lobe: Lobe) -> Facets {
    return Facets(lobe.roughness, lobe.roughness, lobe.kind);
}

// The width across the tangent, known to be the other one in kernels without anisotropy.
fn alpha_across(facets: Facets) -> f32 {
    return select(facets.alpha, facets.alpha_v, HAS_ANISOTROPY);
}

// The microfacets are too narrow to be told from a smooth surface.
fn facets_are_smooth(facets: Facets) -> bool {
    return max(facets.alpha, alpha_across(facets)) < DELTA_ALPHA;
}

// The frame of local directions.
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
    let alpha_v = alpha_across(facets);
    var slopes = (m.x * m.x + m.y * m.y) / (alpha * alpha);
    if HAS_ANISOTROPY && (facets.flags & ANISOTROPIC) != 0u {
        slopes = m.x * m.x / (alpha * alpha) + m.y * m.y / (alpha_v * alpha_v);
    }
    if HAS_BECKMANN && (facets.flags & BECKMANN_FACETS) != 0u {
        let cosine2 = max(m.z * m.z, 1.0e-20);
        return exp(-slopes / cosine2) / (PI * alpha * alpha_v * cosine2 * cosine2);
    }
    let e = slopes + m.z * m.z;
    return 1.0 / (PI * alpha * alpha_v * e * e);
}

// Smith's Λ(w).
fn facet_lambda(facets: Facets, w: vec3<f32>) -> f32 {
    let alpha = facets.alpha;
    let tan2 = (w.x * w.x + w.y * w.y) / max(w.z * w.z, 1.0e-20);
    var stretched = alpha * alpha * tan2;
    if HAS_ANISOTROPY && (facets.flags & ANISOTROPIC) != 0u {
        let along = alpha * w.x;
        let across = facets.alpha_v * w.y;
        stretched = (along * along + across * across) / max(w.z * w.z, 1.0e-20);
    }
    if HAS_BECKMANN && (facets.flags & BECKMANN_FACETS) != 0u {
        return beckmann_lambda(stretched);
    }
    return 0.5 * (sqrt(1.0 + stretched) - 1.0);
}

// G2: the share of the microfacets that are seen from both directions.
fn facet_shadowing(facets: Facets, lambda_o: f32, lambda_i: f32) -> f32 {
    if HAS_SEPARABLE_MASKING && (facets.flags & SEPARABLE_MASKS) != 0u {
        return 1.0 / ((1.0 + lambda_o) * (1.0 + lambda_i));
    }
    return 1.0 / (1.0 + lambda_o + lambda_i);
}

// G2 / G1(wo): the share of the microfacets seen from wo that are seen from wi too.
fn facet_shadowing_of_visible(facets: Facets, lambda_o: f32, lambda_i: f32) -> f32 {
    if HAS_SEPARABLE_MASKING && (facets.flags & SEPARABLE_MASKS) != 0u {
        return 1.0 / (1.0 + lambda_i);
    }
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
    let widths = vec2<f32>(facets.alpha, alpha_across(facets));
    let n = visible_normal_of_width_one(facets, normalize(vec3<f32>(widths * wo.xy, wo.z)), u, v);
    return normalize(vec3<f32>(widths * n.xy, max(1.0e-7, n.z)));
}

// A visible normal of microfacets of width 1; for GGX by Heitz 2018.
fn visible_normal_of_width_one(facets: Facets, wo: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
    if HAS_BECKMANN && (facets.flags & BECKMANN_FACETS) != 0u {
        return visible_beckmann_normal(wo, u, v);
    }
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
