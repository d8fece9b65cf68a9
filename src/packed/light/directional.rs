//! Directional lights.

use glam::DVec3;

use super::record::PackedLight;
use crate::math::luminance;
use crate::sampling::LightStrength;
use crate::scene::DirectionalLight;

/// `p1`: the direction to the light.
pub fn pack(light: &DirectionalLight) -> (PackedLight, LightStrength) {
    let p1 = (-light.direction).as_vec3().to_array();
    let packed = PackedLight { p1, ..PackedLight::at(DVec3::ZERO, light.irradiance) };
    (packed, LightStrength::Irradiance(luminance(light.irradiance)))
}
