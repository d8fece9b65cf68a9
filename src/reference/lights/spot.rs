//! Spot lights.

use glam::DVec3;

use super::delta::{Arriving, DeltaLight};
use super::projected_picture::ProjectedPicture;
use crate::scene::{AimedProfile, FalloffCurve, Scene, SpotLight};
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
    profile: Option<AimedProfile>,
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
        profile: light.profile.clone(),
    }
}

impl DeltaLight for Spot {
    fn arriving(&self, point: DVec3) -> Option<Arriving> {
        Arriving::from_position(self.position, point, |direction| {
            let falloff = self.curve.share(direction.dot(self.axis), self.angles);
            let picture = self.picture.as_ref().filter(|_| falloff > 0.0);
            let color = picture.and_then(|picture| picture.coordinates(direction).map(|uv| picture.color(uv)));
            let candela = self.profile.as_ref().filter(|_| falloff > 0.0).map_or(1.0, |aimed| aimed.candela(direction));
            self.intensity * (falloff * candela) * color.unwrap_or(Spectrum::WHITE)
        })
    }

    fn position(&self) -> Option<DVec3> {
        Some(self.position)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_full_inside_and_ends_at_its_angle() {
        let angles = [60.0_f64, 30.0].map(f64::to_radians);
        for curve in [FalloffCurve::Smooth, FalloffCurve::Square, FalloffCurve::Linear] {
            let at = |degrees: f64| curve.share(degrees.to_radians().cos(), angles);
            assert_eq!([at(0.0), at(29.9), at(60.1), at(170.0)], [1.0, 1.0, 0.0, 0.0]);
            // Without a border between them, the light ends sharply.
            let sharp = |degrees: f64| curve.share(degrees.to_radians().cos(), [angles[1]; 2]);
            assert_eq!([sharp(29.999), sharp(30.001)], [1.0, 0.0]);
        }
        let middle = 0.5 * (0.5 + 0.75_f64.sqrt());
        assert!((FalloffCurve::Smooth.share(middle, angles) - 0.5).abs() < 1e-12);
        assert!((FalloffCurve::Square.share(middle, angles) - 0.25).abs() < 1e-12);
        assert!((FalloffCurve::Linear.share(45.0_f64.to_radians().cos(), angles) - 0.5).abs() < 1e-12);
    }
}
