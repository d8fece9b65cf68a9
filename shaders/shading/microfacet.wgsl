// GGX microfacets: sampling of visible normals and height-correlated Smith shadowing. Local directions: z along the shading normal.
#import core/math.wgsl

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
