//! A clear sky and its sun, as an environment map and a directional light.
//!
//! `moment` reads a time, `sun` says where the sun stands then and how strong it is behind the air, `preetham` how bright the sky is.
//! Space is +X east, +Y up and −Z north.

pub mod moment;
mod preetham;
mod sun;

use std::f64::consts::{PI, TAU};
use std::io::Cursor;

use exr::prelude::{Image, SpecificChannels, Vec2 as TexelPosition, WritableImage};
use glam::DVec3;

use crate::load::image_file::EmbeddedFile;
use crate::spectrum::Spectrum;
pub use sun::direction_to_sun;

/// Rows of the map, half of them above the horizon. The sky changes by hardly a percent from one to the next, but close to the sun.
const ROWS: usize = 256;

/// The sky at a place and a time.
#[derive(Debug, Clone, Copy)]
pub struct Daylight {
    /// How hazy the air is: 2 is very clear, 10 hazy (Linke's turbidity).
    pub turbidity: f64,
    /// Reflectance of the ground below the horizon.
    pub ground: Spectrum,
    /// A direction of length 1, above the horizon.
    pub to_sun: DVec3,
}

impl Daylight {
    /// On a surface that faces the sun, W·m⁻².
    pub fn sun_irradiance(&self) -> Spectrum {
        sun::irradiance(self.to_sun.y, self.turbidity)
    }

    /// Radiance of the sky from a direction of length 1 above the horizon, without the sun, W·m⁻²·sr⁻¹.
    pub fn sky_radiance(&self, direction: DVec3) -> Spectrum {
        preetham::radiance(self.turbidity, self.to_sun, direction)
    }

    /// The irradiance of level ground by the sky alone, W·m⁻²: ∫ L cos θ dω by the midpoint rule.
    pub fn sky_irradiance(&self) -> Spectrum {
        const STEPS: usize = 96;
        let mut sum = Spectrum::BLACK;
        for i in 0..STEPS {
            // Even steps of sin²θ are even shares of the cosine.
            let sine = ((i as f64 + 0.5) / STEPS as f64).sqrt();
            for j in 0..4 * STEPS {
                let phi = TAU * (j as f64 + 0.5) / (4 * STEPS) as f64;
                let direction = DVec3::new(sine * phi.cos(), (1.0 - sine * sine).sqrt(), sine * phi.sin());
                sum += self.sky_radiance(direction);
            }
        }
        sum * (PI / (4 * STEPS * STEPS) as f64)
    }

    /// Radiance of the ground, which sends on what the sky and, where it is there, the sun bring, W·m⁻²·sr⁻¹.
    pub fn ground_radiance(&self, has_sun: bool) -> Spectrum {
        let sun = if has_sun { self.sun_irradiance() * self.to_sun.y } else { Spectrum::BLACK };
        (self.sky_irradiance() + sun) * self.ground / PI
    }

    /// The sky above the ground as a lat-long map, an EXR file in memory.
    pub fn map(&self, has_sun: bool) -> EmbeddedFile {
        let ground = self.ground_radiance(has_sun).to_f32();
        let texel = |place: TexelPosition<usize>| -> (f32, f32, f32) {
            let theta = PI * (place.y() as f64 + 0.5) / ROWS as f64;
            // u = atan2(x, −z)/2π
            let phi = TAU * (place.x() as f64 + 0.5) / (2 * ROWS) as f64;
            let direction = DVec3::new(theta.sin() * phi.sin(), theta.cos(), -theta.sin() * phi.cos());
            let [red, green, blue] = if direction.y > 0.0 { self.sky_radiance(direction).to_f32() } else { ground };
            (red, green, blue)
        };
        let mut bytes = Vec::new();
        let image = Image::from_channels((2 * ROWS, ROWS), SpecificChannels::rgb(texel));
        // Memory takes all that is written.
        let _ = image.write().to_buffered(Cursor::new(&mut bytes));
        EmbeddedFile { name: "daylight.exr".to_owned(), bytes: bytes.into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn noon(turbidity: f64, elevation: f64) -> Daylight {
        let (y, z) = elevation.to_radians().sin_cos();
        Daylight { turbidity, ground: Spectrum::WHITE * 0.2, to_sun: DVec3::new(0.0, y, z) }
    }

    fn lux(light: Spectrum) -> f64 {
        683.0 * light.luminance()
    }

    /// The Illuminating Engineering Society's clear sky gives level ground 800 + 15,500·√sin a lx, and its sun 127,500·exp(−0.21/sin a) lx to a surface
    /// that faces it (Lighting Handbook, daylight availability). The sun agrees within a tenth; this model's sky is known to be brighter than measured ones.
    #[test]
    fn a_clear_day_is_as_bright_as_clear_days_are() {
        let day = noon(2.5, 60.0);
        let sine = day.to_sun.y;
        let (sky, sun) = (lux(day.sky_irradiance()), lux(day.sun_irradiance()));
        let (of_sky, of_sun) = (800.0 + 15_500.0 * sine.sqrt(), 127_500.0 * (-0.21 / sine).exp());
        assert!((1.0..2.0).contains(&(sky / of_sky)), "{sky} lx by the sky, and not {of_sky}");
        assert!((0.9..1.1).contains(&(sun / of_sun)), "{sun} lx by the sun, and not {of_sun}");
        let hazy = noon(8.0, 60.0);
        assert!(
            lux(hazy.sun_irradiance()) < 0.7 * sun && lux(hazy.sky_irradiance()) > 1.2 * sky,
            "haze dims the sun and lights the sky"
        );
    }

    #[test]
    fn the_sky_is_blue_above_and_bright_around_the_sun_which_reddens_as_it_sets() {
        let day = noon(2.5, 40.0);
        let zenith = day.sky_radiance(DVec3::Y);
        assert!(zenith.b() > 1.5 * zenith.r(), "{zenith}");
        let beside = day.sky_radiance((day.to_sun + DVec3::X * 0.1).normalize());
        let opposite = day.sky_radiance(DVec3::new(0.0, day.to_sun.y, -day.to_sun.z));
        assert!(beside.luminance() > 3.0 * opposite.luminance(), "{beside} {opposite}");
        let [high, low] = [60.0, 5.0].map(|elevation| noon(2.5, elevation).sun_irradiance());
        assert!(low.r() / low.b() > 3.0 * high.r() / high.b(), "{low} {high}");
        for elevation in [0.5, 10.0, 45.0, 89.9] {
            for turbidity in [2.0, 10.0] {
                let day = noon(turbidity, elevation);
                for tilt in [0.001, 0.3, 1.0, 1.57] {
                    let sky = day.sky_radiance(DVec3::new(f64::cos(tilt), f64::sin(tilt), 0.0).normalize());
                    assert!(sky.is_finite() && sky.min_component() >= 0.0, "{elevation} {turbidity} {tilt}: {sky}");
                }
            }
        }
    }

    /// The ground is as bright as its light says, and no brighter than that without the sun.
    #[test]
    fn the_ground_sends_on_what_reaches_it() {
        let day = noon(3.0, 50.0);
        let all = (day.sky_irradiance() + day.sun_irradiance() * day.to_sun.y) * 0.2 / PI;
        assert!((day.ground_radiance(true) - all).max_component().abs() < 1e-12);
        assert!(day.ground_radiance(false).luminance() < 0.5 * all.luminance(), "the control");
    }
}
