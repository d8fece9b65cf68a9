// How much light is reflected where it meets another medium.
#import core/layout.wgsl

// Squared cosine of the refracted direction by Snell's law, not above 0 in total reflection. As a sum of the difference of the indices and
// the cosine it keeps its accuracy where both are small: 1 - (1 - cos²) / eta² would take every grazing ray for totally reflected.
fn transmitted_cosine2(cosine: f32, eta: f32) -> f32 {
    return ((eta - 1.0) * (eta + 1.0) + cosine * cosine) / (eta * eta);
}

// Unpolarised Fresnel reflectance of a dielectric; eta = transmitted over incident index of refraction.
fn fresnel_dielectric(cosine: f32, eta: f32) -> f32 {
    let cosine2 = transmitted_cosine2(cosine, eta);
    if cosine2 <= 0.0 {
        return 1.0;
    }
    let cosine_transmitted = sqrt(cosine2);
    let parallel = (eta * cosine - cosine_transmitted) / (eta * cosine + cosine_transmitted);
    let perpendicular = (cosine - eta * cosine_transmitted) / (cosine + eta * cosine_transmitted);
    return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

#if CONDUCTOR
// Reflectance of a metal: the exact equations for a complex index of refraction, or Schlick's approximation.
fn conductor_fresnel(kind: u32, first: vec3<f32>, second: vec3<f32>, cosine: f32) -> vec3<f32> {
    let c2 = cosine * cosine;
    if (kind & COMPLEX_FRESNEL) == 0u {
        let away = 1.0 - cosine;
        let away2 = away * away;
        return first + (1.0 - first) * (away2 * away2 * away);
    }
    let s2 = (1.0 - cosine) * (1.0 + cosine);
    let eta2 = first * first;
    let k2 = second * second;
    let t0 = eta2 - k2 - s2;
    let a2_plus_b2 = sqrt(t0 * t0 + 4.0 * eta2 * k2);
    let t1 = a2_plus_b2 + c2;
    let a = sqrt(max(0.5 * (a2_plus_b2 + t0), vec3<f32>(0.0)));
    let t2 = 2.0 * cosine * a;
    let perpendicular = (t1 - t2) / (t1 + t2);
    let t3 = c2 * a2_plus_b2 + s2 * s2;
    let t4 = t2 * s2;
    let parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return 0.5 * (parallel + perpendicular);
}
#endif
