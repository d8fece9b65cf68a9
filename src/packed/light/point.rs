//! Point lights.

use std::f64::consts::PI;

use super::record::PackedLight;
use crate::math::luminance;
use crate::sampling::LightStrength;
use crate::scene::PointLight;

pub fn pack(light: &PointLight) -> (PackedLight, LightStrength) {
    (PackedLight::at(light.position, light.intensity), LightStrength::Power(4.0 * PI * luminance(light.intensity)))
}
