//! Spot lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use super::projected_picture::ProjectedPicture;
use crate::scene::{FalloffCurve, Scene, SpotLight};
use crate::spectrum::Spectrum;

#[derive(Debug)]
pub struct Spot {
    position: DVec3,
    axis: DVec3,
    intensity: Spectrum,
    /// Angles at which there is no light and at which there is all, in radians.
    angles: [f64; 2],
    curve: FalloffCurve,
    picture: Option<ProjectedPicture>,
}

pub fn new(light: &SpotLight, scene: &Scene) -> Spot {
    let half_width = light.angle_degrees.to_radians().tan();
    let picture = light
        .picture
        .map(|picture| ProjectedPicture::new(light.direction, picture.up, [half_width; 2], Some(picture.texture), scene));
    Spot {
        position: light.position,
        axis: light.direction,
        intensity: light.intensity,
        angles: [light.angle_degrees, light.falloff_degrees].map(f64::to_radians),
        curve: light.curve,
        picture,
    }
}

impl DeltaLight for Spot {
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        Arriving::from_position(self.position, point, |direction| {
            let falloff = falloff(direction.dot(self.axis), self.angles, self.curve);
            let picture = self.picture.as_ref().filter(|_| falloff > 0.0);
            let color = picture.and_then(|picture| picture.coordinates(direction).map(|uv| picture.color(uv)));
            self.intensity * falloff * color.unwrap_or(Spectrum::WHITE)
        })
    }

    fn position(&self) -> Option<DVec3> {
        Some(self.position)
    }
}

/// How much of a spot light's intensity goes in a direction whose cosine with the axis is `cosine`: 1 within the inner angle, 0 past the
/// outer.
fn falloff(cosine: f64, angles: [f64; 2], curve: FalloffCurve) -> f64 {
    let [outer, inner] = angles.map(f64::cos);
    if cosine >= inner {
        return 1.0;
    }
    if cosine <= outer {
        return 0.0;
    }
    let t = (cosine - outer) / (inner - outer);
    match curve {
        FalloffCurve::Smooth => t * t * (3.0 - 2.0 * t),
        FalloffCurve::Square => t * t,
        FalloffCurve::Linear => (angles[0] - cosine.acos()) / (angles[0] - angles[1]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_full_inside_and_ends_at_its_angle() {
        let angles = [60.0_f64, 30.0].map(f64::to_radians);
        for curve in [FalloffCurve::Smooth, FalloffCurve::Square, FalloffCurve::Linear] {
            let at = |degrees: f64| falloff(degrees.to_radians().cos(), angles, curve);
            assert_eq!([at(0.0), at(29.9), at(60.1), at(170.0)], [1.0, 1.0, 0.0, 0.0]);
            // Without a border between them, the light ends sharply.
            let sharp = |degrees: f64| falloff(degrees.to_radians().cos(), [angles[1]; 2], curve);
            assert_eq!([sharp(29.999), sharp(30.001)], [1.0, 0.0]);
        }
        let middle = 0.5 * (0.5 + 0.75_f64.sqrt());
        assert!((falloff(middle, angles, FalloffCurve::Smooth) - 0.5).abs() < 1e-12);
        assert!((falloff(middle, angles, FalloffCurve::Square) - 0.25).abs() < 1e-12);
        assert!((falloff(45.0_f64.to_radians().cos(), angles, FalloffCurve::Linear) - 0.5).abs() < 1e-12);
    }
}
