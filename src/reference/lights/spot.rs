//! Spot lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use crate::scene::SpotLight;

#[derive(Debug)]
pub struct Spot {
    position: DVec3,
    axis: DVec3,
    intensity: DVec3,
    /// Of the angles at which there is no light and at which there is all.
    cosines: [f64; 2],
}

pub fn new(light: &SpotLight) -> Spot {
    Spot {
        position: light.position,
        axis: light.direction,
        intensity: light.intensity,
        cosines: [light.angle_degrees, light.falloff_degrees].map(|angle| angle.to_radians().cos()),
    }
}

impl DeltaLight for Spot {
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        Arriving::from_position(self.position, point, |direction| {
            self.intensity * falloff(direction.dot(self.axis), self.cosines)
        })
    }
}

/// How much of a spot light's intensity goes in a direction whose cosine with the axis is `cosine`: 1 within the inner angle, 0 past the
/// outer, between them Hermite's smooth step t²(3 − 2t) in the cosine.
fn falloff(cosine: f64, [outer, inner]: [f64; 2]) -> f64 {
    if cosine >= inner {
        return 1.0;
    }
    if cosine <= outer {
        return 0.0;
    }
    let t = (cosine - outer) / (inner - outer);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_full_inside_and_ends_at_its_angle() {
        let cosines = [60.0_f64, 30.0].map(|angle| angle.to_radians().cos());
        let at = |degrees: f64| falloff(degrees.to_radians().cos(), cosines);
        assert_eq!([at(0.0), at(29.9), at(60.1), at(170.0)], [1.0, 1.0, 0.0, 0.0]);
        let middle = falloff(0.5 * (cosines[0] + cosines[1]), cosines);
        assert!((middle - 0.5).abs() < 1e-12);
        // Without a border between them, the light ends sharply.
        let sharp = [cosines[1]; 2];
        assert_eq!([falloff(sharp[0] + 1e-9, sharp), falloff(sharp[0] - 1e-9, sharp)], [1.0, 0.0]);
    }
}
