//! A sky of three colours.

use std::f64::consts::PI;

use crate::math::luminance;
use crate::packed::environment::PackedEnvironment;
use crate::packed::error::PackError;
use crate::scene::Sky;

/// Words: (radiance at the horizon; -), (at the zenith; the share of the upper half), (below; 1 over the integral of its luminance).
pub fn pack(sky: &Sky, _: &mut Vec<f32>) -> Result<PackedEnvironment, PackError> {
    let (upper, lower) = (PI * (luminance(sky.zenith) + luminance(sky.horizon)), 2.0 * PI * luminance(sky.ground));
    let integral = (upper + lower).max(f64::MIN_POSITIVE);
    Ok(PackedEnvironment {
        mean_luminance: (upper + lower) / (4.0 * PI),
        words: [sky.horizon.extend(0.0), sky.zenith.extend(upper / integral), sky.ground.extend(1.0 / integral)],
        switch: Some("SKY"),
        ..PackedEnvironment::default()
    })
}
