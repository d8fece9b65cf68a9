// Multiple importance sampling (Veach 1997, section 9.2): the only place where the two strategies are weighed against each other.
#import shading/path/planted.wgsl

// Weight of a sample drawn with density `own` that the other strategy would have drawn with density `other`. The ratio form
// neither overflows nor divides 0 by 0: own is positive wherever the sample exists.
fn mis_weight(own: f32, other: f32) -> f32 {
    let ratio = planted_ratio(other / own);
    if HAS_HEURISTIC_POWER {
        return 1.0 / (1.0 + ratio * ratio);
    }
    if HAS_HEURISTIC_EXPONENT {
        // Kept from where powers leave f32.
        let exponent = bitcast<f32>(HEURISTIC_EXPONENT_BITS);
        return 1.0 / (1.0 + exp2(clamp(exponent * log2(max(ratio, 1.0e-37)), -120.0, 120.0)));
    }
    if HAS_HEURISTIC_CUTOFF {
        let cutoff = bitcast<f32>(HEURISTIC_CUTOFF_BITS);
        if ratio * cutoff > 1.0 {
            return 0.0;
        }
        if ratio < cutoff {
            return 1.0;
        }
    }
    return 1.0 / (1.0 + ratio);
}
