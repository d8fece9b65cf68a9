// How much light is reflected where it meets another medium.
#import core/spectrum.wgsl

// Squared cosine of the refracted direction by Snell's law, not above 0 in total reflection. As a sum of the difference of the indices and
// the cosine it keeps its accuracy where both are small: 1 - (1 - cos²) / eta² would take every grazing ray for totally reflected.
fn transmitted_cosine2(cosine: f32, eta: f32) -> f32 {
    return ((eta - 1.0) * (eta + 1.0) + cosine * cosine) / (eta * eta);
}

// Shares of unpolarised light; their sum is 1.
struct Fresnel {
    reflected: f32,
    transmitted: f32,
}

// Reflectance and transmittance of a dielectric by Fresnel's equations; eta = transmitted over incident index
// of refraction. Both are accurate where they are small: at grazing angles 1 - reflected would have lost its
// digits.
fn fresnel_dielectric(cosine: f32, eta: f32) -> Fresnel {
    let cosine2 = transmitted_cosine2(cosine, eta);
    if cosine2 <= 0.0 {
        return Fresnel(1.0, 0.0);
    }
    let cosine_transmitted = sqrt(cosine2);
    let parallel_sum = eta * cosine + cosine_transmitted;
    let perpendicular_sum = cosine + eta * cosine_transmitted;
    let parallel = (eta * cosine - cosine_transmitted) / parallel_sum;
    let perpendicular = (cosine - eta * cosine_transmitted) / perpendicular_sum;
    let product = eta * cosine * cosine_transmitted;
    return Fresnel(
        0.5 * (parallel * parallel + perpendicular * perpendicular),
        2.0 * (product / (parallel_sum * parallel_sum) + product / (perpendicular_sum * perpendicular_sum))
    );
}

// Schlick's approximation, of what is reflected at normal incidence.
fn schlick(cosine: f32, normal_incidence: Spectrum) -> Spectrum {
    let away = 1.0 - cosine;
    let away2 = away * away;
    return normal_incidence + (1.0 - normal_incidence) * (away2 * away2 * away);
}
