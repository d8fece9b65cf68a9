// Lobes whose shape is a power of a cosine. What such a lobe has below the horizon is cut off.
#import core/math.wgsl

// The cosine of a narrow lobe is next to 1, where f32 has no digits left for the angle; so these functions
// compute with 1 - cos.

// 1 - exp(-x), x not negative.
fn one_minus_exp(x: f32) -> f32 {
    return select(1.0 - exp(-x), x * (1.0 - x * (1.0 / 2.0 - x * (1.0 / 6.0 - x * (1.0 / 24.0)))), x < 0.03);
}

// log(1 - x), x in [0, 1).
fn log_one_minus(x: f32) -> f32 {
    return select(log(1.0 - x), -x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 3.0 + x * (1.0 / 4.0)))), x < 0.02);
}

// cosⁿ about an axis: cos = ξ^(1/(n+1)), density (n+1)/(2π) cosⁿ (Lafortune and Willems 1994).
fn sample_cosine_power(axis: vec3<f32>, exponent: f32, u: f32, v: f32) -> vec3<f32> {
    var away = 1.0;
    if u > 0.0 {
        away = one_minus_exp(-log(u) / (exponent + 1.0));
    }
    let sine = sqrt(away * (2.0 - away));
    let circle = sin_cos_turns(v);
    return frame_to_world(frame_from_normal(axis), vec3<f32>(sine * circle.y, sine * circle.x, 1.0 - away));
}

fn cosine_power_pdf(axis: vec3<f32>, exponent: f32, wi: vec3<f32>) -> f32 {
    // Half the squared distance of two unit vectors is 1 - cos, and keeps its digits.
    let apart = axis - wi;
    let away = 0.5 * dot(apart, apart);
    if away >= 1.0 {
        return 0.0;
    }
    return (exponent + 1.0) / TWO_PI * exp(exponent * log_one_minus(away));
}
