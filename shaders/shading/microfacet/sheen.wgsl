// Fibres that stand on a surface; src/reference/bsdf/sheen.rs has the model.
#import core/layout.wgsl
#import core/math.wgsl
#import shading/microfacet/albedo.wgsl

struct Sheen {
    color: Spectrum,
    // Not below the smallest that is resolved.
    roughness: f32,
}

fn sheen_fit(x: f32, share: f32) -> f32 {
    let a = mix(21.5473, 25.3245, share);
    let b = mix(3.82987, 3.32435, share);
    let c = mix(0.19823, 0.16801, share);
    return a / (1.0 + b * pow(x, c)) + mix(-1.97760, -1.27393, share) * x + mix(-4.32054, -4.85967, share);
}

fn sheen_lambda(alpha: f32, cosine: f32) -> f32 {
    let share = (1.0 - alpha) * (1.0 - alpha);
    if cosine < 0.5 {
        return exp(sheen_fit(max(cosine, 0.0), share));
    }
    return exp(2.0 * sheen_fit(0.5, share) - sheen_fit(max(1.0 - cosine, 0.0), share));
}

// f cosθi for directions in the surface's frame.
fn sheen_value(sheen: Sheen, o: vec3<f32>, i: vec3<f32>) -> Spectrum {
    let alpha = sheen.roughness * sheen.roughness;
    let m = normalize(o + i);
    let shadowing = 1.0 + sheen_lambda(alpha, o.z) + sheen_lambda(alpha, i.z);
    let distribution = (2.0 + 1.0 / alpha) * pow(min(m.x * m.x + m.y * m.y, 1.0), 0.5 / alpha) / TWO_PI;
    let most = max(max(sheen_albedo(sheen, o.z), sheen_albedo(sheen, i.z)), 1.0);
    return sheen.color * (distribution / (4.0 * o.z * shadowing * most));
}

// The share of light that the fibres reflect; more than 1 at grazing angles of narrow fibres, where the fit
// fails.
fn sheen_albedo(sheen: Sheen, cosine: f32) -> f32 {
    return tabulated_albedo(SHEEN_ALBEDO_WORD, cosine, sheen.roughness, sheen.roughness + SHEEN_KNEE);
}

// The share of light that the fibres take from the layers below.
fn sheen_taken(sheen: Sheen, cosine: f32) -> f32 {
    let strongest = max_component(sheen.color);
    if strongest <= 0.0 {
        return 0.0;
    }
    return min(strongest, 1.0) * min(sheen_albedo(sheen, cosine), 1.0);
}
