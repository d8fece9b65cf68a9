// Results of evaluating and sampling a BSDF. Directions point away from the surface; values include the
// cosine.
#import core/spectrum.wgsl

struct BsdfSample {
    // Zero weight: no direction was found.
    wi: vec3<f32>,
    // f |cos| / pdf
    weight: Spectrum,
    // Negative for a delta lobe.
    pdf_solid_angle: f32,
    // Squared ratio of refractive indices crossed by a refraction, else 1.
    eta_scale: f32,
    // The ray goes straight on through a null surface.
    is_null: bool,
}

struct BsdfValue {
    // f |cos|
    value: Spectrum,
    pdf_solid_angle: f32,
}

fn no_sample() -> BsdfSample {
    return BsdfSample(vec3<f32>(0.0, 0.0, 1.0), BLACK, -1.0, 1.0, false);
}

fn no_value() -> BsdfValue {
    return BsdfValue(BLACK, 0.0);
}

fn from_value(wi: vec3<f32>, value: BsdfValue, eta_scale: f32) -> BsdfSample {
    if value.pdf_solid_angle <= 0.0 {
        return no_sample();
    }
    return BsdfSample(wi, value.value / value.pdf_solid_angle, value.pdf_solid_angle, eta_scale, false);
}
