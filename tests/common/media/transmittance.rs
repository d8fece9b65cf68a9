//! Light along a straight line through bodies whose media are homogeneous (Beer, Lambert): per channel, without scattering into the line.

/// A stretch of a line within a body.
#[derive(Debug, Clone, Copy)]
pub struct Stretch {
    /// Distances along the line at which the body is entered and left.
    pub from: f64,
    pub to: f64,
    /// Absorption and scattering per unit length.
    pub extinction: [f64; 3],
    /// Radiance that the medium adds per unit length.
    pub emission: [f64; 3],
}

impl Stretch {
    pub fn new([from, to]: [f64; 2], extinction: [f64; 3]) -> Self {
        Self { from, to, extinction, emission: [0.0; 3] }
    }
}

/// The parts of the line from 0 to `length`, in order, with the body that fills each. A body within another one displaces it: of the stretches that
/// cover a part, the last in the list counts.
fn parts(stretches: &[Stretch], length: f64) -> Vec<(f64, Option<&Stretch>)> {
    let mut cuts: Vec<f64> = stretches.iter().flat_map(|stretch| [stretch.from, stretch.to]).chain([0.0, length]).collect();
    cuts.retain(|&cut| (0.0..=length).contains(&cut));
    cuts.sort_by(f64::total_cmp);
    let filled_by = |middle: f64| stretches.iter().rev().find(|stretch| stretch.from < middle && middle < stretch.to);
    cuts.windows(2).map(|pair| (pair[1] - pair[0], filled_by(0.5 * (pair[0] + pair[1])))).collect()
}

/// The part of the light that comes through from `length` to 0.
pub fn transmittance(stretches: &[Stretch], length: f64) -> [f64; 3] {
    let dark: Vec<Stretch> = stretches.iter().map(|&stretch| Stretch { emission: [0.0; 3], ..stretch }).collect();
    radiance(&dark, length, [1.0; 3])
}

/// The radiance at 0 of a background at `length`, through media that glow: over a part of length d, ε (1 − exp(−σ d)) / σ is added.
pub fn radiance(stretches: &[Stretch], length: f64, background: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|channel| {
        parts(stretches, length).iter().rev().fold(background[channel], |radiance, (distance, body)| {
            let Some(body) = body else { return radiance };
            let depth = body.extinction[channel] * distance;
            let glow = if depth == 0.0 { *distance } else { -(-depth).exp_m1() / body.extinction[channel] };
            radiance * (-depth).exp() + body.emission[channel] * glow
        })
    })
}

/// The distances at which a line enters and leaves a sphere; the direction has length 1.
pub fn through_sphere(origin: [f64; 3], direction: [f64; 3], center: [f64; 3], radius: f64) -> Option<[f64; 2]> {
    let offset: [f64; 3] = std::array::from_fn(|axis| center[axis] - origin[axis]);
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let nearest = dot(offset, direction);
    let half_chord_squared = radius * radius - (dot(offset, offset) - nearest * nearest);
    (half_chord_squared > 0.0).then(|| [nearest - half_chord_squared.sqrt(), nearest + half_chord_squared.sqrt()])
}

/// The distances at which a line enters and leaves a box.
pub fn through_box(origin: [f64; 3], direction: [f64; 3], min: [f64; 3], max: [f64; 3]) -> Option<[f64; 2]> {
    let mut both = [f64::NEG_INFINITY, f64::INFINITY];
    for axis in 0..3 {
        let [a, b] = [min, max].map(|corner| (corner[axis] - origin[axis]) / direction[axis]);
        both = [both[0].max(a.min(b)), both[1].min(a.max(b))];
    }
    (both[0] < both[1]).then_some(both)
}
