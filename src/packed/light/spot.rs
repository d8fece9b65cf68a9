//! Spot lights.

use std::f64::consts::PI;

use super::record::PackedLight;
use crate::math::luminance;
use crate::sampling::LightStrength;
use crate::scene::SpotLight;

/// `p1`: the axis; `p2`: 1 − cosine of the angle at which the light ends, and of the one up to which it is full. Written that way, narrow
/// cones keep their precision.
pub fn pack(light: &SpotLight) -> (PackedLight, LightStrength) {
    let [outer, inner] = [light.angle_degrees, light.falloff_degrees].map(|angle| 2.0 * (0.5 * angle).to_radians().sin().powi(2));
    let packed = PackedLight {
        p1: light.direction.as_vec3().to_array(),
        p2: [outer as f32, inner as f32, 0.0],
        ..PackedLight::at(light.position, light.intensity)
    };
    (packed, LightStrength::Power(PI * (outer + inner) * luminance(light.intensity)))
}
