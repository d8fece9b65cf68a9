// Multiple importance sampling (Veach 1997, section 9.2): the only place where the two strategies are weighed against each other.
#import shading/path/planted.wgsl

// Weight of a sample drawn with density `own` that the other strategy would have drawn with density `other`. The ratio form
// neither overflows nor divides 0 by 0: own is positive wherever the sample exists.
fn mis_weight(own: f32, other: f32) -> f32 {
    let ratio = planted_ratio(other / own);
    if HAS_HEURISTIC_POWER {
        return 1.0 / (1.0 + ratio * ratio);
    } else {
        return 1.0 / (1.0 + ratio);
    }
}
