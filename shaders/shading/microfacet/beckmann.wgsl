// Microfacets whose slopes are normally distributed, of width 1.

const INVERSE_ROOT_PI: f32 = 0.56418958354775628695;

// 1 - erf(x), of relative accuracy 1.2e-7 (Press et al., Numerical Recipes, section 6.2).
fn erfc(x: f32) -> f32 {
    let z = abs(x);
    let t = 1.0 / (1.0 + 0.5 * z);
    let series = -1.26551223 + t * (1.00002368 + t * (0.37409196 + t * (0.09678418 + t * (-0.18628806 + t * (0.27886807
        + t * (-1.13520398 + t * (1.48851587 + t * (-0.82215223 + t * 0.17087277))))))));
    let tail = t * exp(-z * z + series);
    return select(tail, 2.0 - tail, x < 0.0);
}

// The inverse of erf on (-1, 1) (Giles 2012).
fn inverse_erf(x: f32) -> f32 {
    // Next to ±1 the product is 2⁻²³. On lavapipe one was seen that has no finite logarithm.
    var w = -log(max((1.0 - x) * (1.0 + x), 1.1920929e-7));
    var p = 0.0;
    if w < 5.0 {
        w -= 2.5;
        p = 1.50140941 + w * (0.246640727 + w * (-0.00417768164 + w * (-0.00125372503 + w * (0.00021858087 + w * (-4.39150654e-6
            + w * (-3.5233877e-6 + w * (3.43273939e-7 + w * 2.81022636e-8)))))));
    } else {
        w = sqrt(w) - 3.0;
        p = 2.83297682 + w * (1.00167406 + w * (0.00943887047 + w * (-0.0076224613 + w * (0.00573950773 + w * (-0.00367342844
            + w * (0.00134934322 + w * (0.000100950558 - w * 0.000200214257)))))));
    }
    return p * x;
}

// Smith's Λ by α² tan²θ: (erf(a) - 1) / 2 + exp(-a²) / (2a√π) with a = 1 / (α tanθ).
fn beckmann_lambda(stretched: f32) -> f32 {
    // From a = 4 on it is below 1e-9.
    if stretched < 0.0625 {
        return 0.0;
    }
    let a = inverseSqrt(stretched);
    return 0.5 * (exp(-a * a) * INVERSE_ROOT_PI / a - erfc(a));
}

// Share of the slopes along a direction that are below `slope`, weighted by how large they look from an angle of the given tangent, less
// the share `u` of all, which are 1 + Λ. From either end, so that tails keep their digits.
fn visible_slopes_beyond(slope: f32, tangent: f32, u: f32, lambda: f32) -> f32 {
    let weighted = tangent * INVERSE_ROOT_PI * exp(-slope * slope);
    if slope < 0.0 {
        return 0.5 * (erfc(-slope) + weighted) - u * (1.0 + lambda);
    }
    return (1.0 - u) * (1.0 + lambda) - 0.5 * (erfc(slope) - weighted) - lambda;
}

// Samples the slopes visible from wo (Heitz and d'Eon 2014): across the direction of view they are normally
// distributed; along it their distribution is inverted by Newton's method, which halves the interval where a
// step would leave it.
fn visible_beckmann_normal(wo: vec3<f32>, u: f32, v: f32) -> vec3<f32> {
    let sine = length(wo.xy);
    var direction = vec2<f32>(1.0, 0.0);
    if sine > 0.0 {
        direction = wo.xy / sine;
    }
    let tangent = sine / max(wo.z, 1.0e-10);
    var low = -5.0;
    var high = min(5.0, 1.0 / max(tangent, 1.0e-10));
    // Numbers are multiples of 2⁻²⁴: what lies below the smallest is drawn half-way to it.
    let share = max(u, 2.9802322e-8);
    let lambda = beckmann_lambda(tangent * tangent);
    var along = clamp(0.0, low, high - 0.1);
    for (var step = 0u; step < 12u; step++) {
        let excess = visible_slopes_beyond(along, tangent, share, lambda);
        if excess < 0.0 {
            low = along;
        } else {
            high = along;
        }
        let density = INVERSE_ROOT_PI * exp(-along * along) * (1.0 - along * tangent);
        let next = along - excess / max(density, 1.0e-30);
        along = select(0.5 * (low + high), next, next >= low && next <= high);
    }
    let across = inverse_erf(2.0 * v - 1.0 + 5.9604645e-8);
    let slope = vec2<f32>(direction.x * along - direction.y * across, direction.y * along + direction.x * across);
    return vec3<f32>(-slope, 1.0);
}
