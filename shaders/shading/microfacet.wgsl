// GGX microfacets: sampling of visible normals, height-correlated Smith shadowing, metals and rough dielectrics.
// Local directions: z along the shading normal.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/fresnel.wgsl
#import shading/glass.wgsl
#import shading/leaf.wgsl
#import shading/scattering.wgsl
#import shading/sides.wgsl
#import shading/surface.wgsl

fn to_local(frame: Frame, w: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(w, frame.tangent), dot(w, frame.bitangent), dot(w, frame.normal));
}

// D(m) (Walter et al. 2007). The sine comes from x and y, which keeps narrow lobes accurate.
fn ggx_distribution(m: vec3<f32>, alpha: f32) -> f32 {
    let e = (m.x * m.x + m.y * m.y) / (alpha * alpha) + m.z * m.z;
    return 1.0 / (PI * alpha * alpha * e * e);
}

// Smith's Λ(w).
fn ggx_lambda(w: vec3<f32>, alpha: f32) -> f32 {
    let tan2 = (w.x * w.x + w.y * w.y) / max(w.z * w.z, 1.0e-20);
    return 0.5 * (sqrt(1.0 + alpha * alpha * tan2) - 1.0);
}

// A microfacet normal visible from wo (Heitz 2018).
fn sample_visible_normal(wo: vec3<f32>, alpha: f32, u: f32, v: f32) -> vec3<f32> {
    let stretched = normalize(vec3<f32>(alpha * wo.xy, wo.z));
    let across2 = dot(stretched.xy, stretched.xy);
    var axis_x = vec3<f32>(1.0, 0.0, 0.0);
    if across2 > 0.0 {
        axis_x = vec3<f32>(-stretched.y, stretched.x, 0.0) * inverseSqrt(across2);
    }
    let axis_y = cross(stretched, axis_x);
    let circle = sin_cos_turns(v);
    let r = sqrt(u);
    let x = r * circle.y;
    let s = 0.5 * (1.0 + stretched.z);
    let y = (1.0 - s) * sqrt(max(0.0, 1.0 - x * x)) + s * (r * circle.x);
    let z = sqrt(max(0.0, 1.0 - x * x - y * y));
    let n = x * axis_x + y * axis_y + z * stretched;
    return normalize(vec3<f32>(alpha * n.xy, max(1.0e-7, n.z)));
}

#if CONDUCTOR
fn evaluate_conductor(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if leaf.scalar < DELTA_ALPHA || !on_wo_side(surface, wi) {
        return no_value();
    }
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let m = normalize(o + i);
    return conductor_value(leaf, o, i, m);
}

fn conductor_value(leaf: Leaf, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>) -> BsdfValue {
    let fresnel = conductor_fresnel(leaf.kind, leaf.first, leaf.second, clamp(dot(o, m), 0.0, 1.0));
    let lambda_o = ggx_lambda(o, leaf.scalar);
    let common_factor = ggx_distribution(m, leaf.scalar) / (4.0 * o.z);
    let shadowing = 1.0 / (1.0 + lambda_o + ggx_lambda(i, leaf.scalar));
    return BsdfValue(fresnel * (common_factor * shadowing), common_factor / (1.0 + lambda_o));
}

fn sample_conductor(leaf: Leaf, surface: Surface, wo: vec3<f32>, u: f32, v: f32) -> BsdfSample {
    if leaf.scalar < DELTA_ALPHA {
        let wi = mirrored(surface, wo);
        if dot(wi, surface.facing_normal) <= 0.0 {
            return no_sample();
        }
        let cosine = clamp(dot(wo, surface.shading_normal), 0.0, 1.0);
        return BsdfSample(wi, conductor_fresnel(leaf.kind, leaf.first, leaf.second, cosine), -1.0, 1.0, false);
    }
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(o, leaf.scalar, u, v);
    let i = 2.0 * dot(o, m) * m - o;
    let wi = frame_to_world(frame, i);
    if i.z <= 0.0 || dot(wi, surface.facing_normal) <= 0.0 {
        return no_sample();
    }
    // The weight is F G2 / G1; the distribution cancels and with it its rounding.
    let value = conductor_value(leaf, o, i, m);
    let fresnel = conductor_fresnel(leaf.kind, leaf.first, leaf.second, clamp(dot(o, m), 0.0, 1.0));
    let lambda_o = ggx_lambda(o, leaf.scalar);
    let weight = fresnel * ((1.0 + lambda_o) / (1.0 + lambda_o + ggx_lambda(i, leaf.scalar)));
    return BsdfSample(wi, weight, value.pdf_solid_angle, 1.0, false);
}
#endif

#if ROUGH_GLASS
// Both lobes by the side of wi. The refraction's half vector lies along wo + eta wi; its Jacobian is Walter et al. 2007, equation 17
// with eta = transmitted over incident: |wi·m| / (wi·m + wo·m / eta)². Radiance is scaled by 1 / eta².
fn evaluate_rough_glass(leaf: Leaf, surface: Surface, wo: vec3<f32>, wi: vec3<f32>) -> BsdfValue {
    if leaf.scalar < DELTA_ALPHA {
        return no_value();
    }
    let reflects = on_wo_side(surface, wi);
    if !reflects && !on_far_side(surface, wi) {
        return no_value();
    }
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    let i = to_local(frame, wi);
    let eta = relative_ior(leaf, surface);
    var m = normalize(o + select(eta, 1.0, reflects) * i);
    m = select(-m, m, m.z > 0.0);
    return rough_glass_value(leaf, o, i, m, eta, reflects);
}

fn rough_glass_value(leaf: Leaf, o: vec3<f32>, i: vec3<f32>, m: vec3<f32>, eta: f32, reflects: bool) -> BsdfValue {
    let o_m = dot(o, m);
    let i_m = dot(i, m);
    // Facets that wo or wi sees from behind do not connect them.
    if o_m <= 0.0 || (i_m > 0.0) != reflects {
        return no_value();
    }
    let reflected = fresnel_dielectric(min(o_m, 1.0), eta);
    let probability = reflection_probability(leaf, reflected);
    let lambda_o = ggx_lambda(o, leaf.scalar);
    let visible = ggx_distribution(m, leaf.scalar) * o_m / o.z;
    let shadowing = 1.0 / (1.0 + lambda_o + ggx_lambda(i, leaf.scalar));
    let pdf_m = visible / (1.0 + lambda_o);
    if reflects {
        let jacobian = 1.0 / (4.0 * o_m);
        return BsdfValue(leaf.first * (reflected * visible * shadowing * jacobian), probability * pdf_m * jacobian);
    }
    let refraction = i_m + o_m / eta;
    let jacobian = -i_m / (refraction * refraction);
    return BsdfValue(
        leaf.second * ((1.0 - reflected) * visible * shadowing * jacobian / (eta * eta)),
        (1.0 - probability) * pdf_m * jacobian
    );
}

fn sample_rough_glass(leaf: Leaf, surface: Surface, wo: vec3<f32>, lobe: f32, u: f32, v: f32) -> BsdfSample {
    if leaf.scalar < DELTA_ALPHA {
        return sample_delta_glass(leaf, surface, wo, lobe);
    }
    let frame = frame_from_normal(surface.shading_normal);
    let o = to_local(frame, wo);
    let m = sample_visible_normal(o, leaf.scalar, u, v);
    let eta = relative_ior(leaf, surface);
    let reflected = fresnel_dielectric(clamp(dot(o, m), 0.0, 1.0), eta);
    let probability = reflection_probability(leaf, reflected);
    let reflects = lobe < probability;
    var i = 2.0 * dot(o, m) * m - o;
    if !reflects {
        i = refracted(m, o, eta);
    }
    let wi = frame_to_world(frame, i);
    if reflects != (i.z > 0.0) || reflects != (dot(wi, surface.facing_normal) > 0.0) {
        return no_sample();
    }
    let value = rough_glass_value(leaf, o, i, m, eta, reflects);
    if value.pdf_solid_angle <= 0.0 {
        return no_sample();
    }
    let lambda_o = ggx_lambda(o, leaf.scalar);
    let masking = (1.0 + lambda_o) / (1.0 + lambda_o + ggx_lambda(i, leaf.scalar));
    if reflects {
        return BsdfSample(wi, leaf.first * (reflected / probability * masking), value.pdf_solid_angle, 1.0, false);
    }
    let weight = (1.0 - reflected) / ((1.0 - probability) * eta * eta) * masking;
    return BsdfSample(wi, leaf.second * weight, value.pdf_solid_angle, eta * eta, false);
}
#endif
