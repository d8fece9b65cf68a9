//! BSDFs of rough surfaces, from their sources.

use std::f64::consts::PI;

use super::vector::{Vector, dot, normalized};

/// f of a rough surface of GGX facets of width alpha, per unit of the facets' reflectance, with the height-correlated masking of Smith (Walter et al.
/// 2007, equations 20 and 33; Heitz 2014, equation 99), and the cosine between the half vector and wo, by which the reflectance is found. Directions
/// lead away from the surface, whose normal is z.
pub fn ggx_reflection(wo: Vector, wi: Vector, alpha: f64) -> (f64, f64) {
    let half = normalized(std::array::from_fn(|axis| wo[axis] + wi[axis]));
    let a2 = alpha * alpha;
    let base = half[2] * half[2] * (a2 - 1.0) + 1.0;
    let d = a2 / (PI * base * base);
    let lambda = |w: Vector| 0.5 * ((1.0 + a2 * (1.0 - w[2] * w[2]) / (w[2] * w[2])).sqrt() - 1.0);
    let masking = 1.0 / (1.0 + lambda(wo) + lambda(wi));
    (d * masking / (4.0 * wo[2] * wi[2]), dot(wo, half))
}

/// f of Oren and Nayar's simpler model (1994, section 4.4) for a reflectance of 1; `sigma` in radians.
pub fn oren_nayar_qualitative(wo: Vector, wi: Vector, sigma: f64) -> f64 {
    let sigma2 = sigma * sigma;
    let (a, b) = (1.0 - 0.5 * sigma2 / (sigma2 + 0.33), 0.45 * sigma2 / (sigma2 + 0.09));
    let angle = |w: Vector| w[2].clamp(-1.0, 1.0).acos();
    let (theta_o, theta_i) = (angle(wo), angle(wi));
    let between = wo[1].atan2(wo[0]) - wi[1].atan2(wi[0]);
    (a + b * between.cos().max(0.0) * theta_o.max(theta_i).sin() * theta_o.min(theta_i).tan()) / PI
}

/// f of glTF's metallic-roughness material for a dielectric or a metal (glTF 2.0, appendix B.3): GGX with separable masking, Schlick's Fresnel term,
/// and below a dielectric's facets Lambert's law for what they do not reflect. `roughness` is the square root of the facets' width.
pub fn gltf(wo: Vector, wi: Vector, color: [f64; 3], is_metal: bool, roughness: f64) -> [f64; 3] {
    let half = normalized(std::array::from_fn(|axis| wo[axis] + wi[axis]));
    let a2 = roughness.powi(4);
    let base = half[2] * half[2] * (a2 - 1.0) + 1.0;
    let d = a2 / (PI * base * base);
    let shadow = |w: Vector| 1.0 / (w[2] + (a2 + (1.0 - a2) * w[2] * w[2]).sqrt());
    let specular = d * shadow(wo) * shadow(wi);
    let missing = (1.0 - dot(wo, half)).powi(5);
    color.map(|channel| {
        if is_metal {
            specular * (channel + (1.0 - channel) * missing)
        } else {
            let fresnel = 0.04 + 0.96 * missing;
            (1.0 - fresnel) * channel / PI + fresnel * specular
        }
    })
}
