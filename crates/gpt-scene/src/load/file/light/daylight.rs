//! `daylight`: a clear sky and its sun, of an environment.

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::daylight::moment::Moment;
use crate::load::daylight::{Daylight, direction_to_sun};
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Elevation, Fraction, Located, Longitude, Turbidity, Vector};
use crate::load::place::Place;
use crate::scene::{DirectionalLight, Environment};
use crate::spectrum::Spectrum;

/// A clear sky with its sun (Preetham, Shirley and Smits 1999): either `to_sun`, or `time`, `latitude` and `longitude`. +X is east, +Y up, −Z north.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "Daylight", extend("oneOf" = [
    { "required": ["to_sun"], "not": { "anyOf": [{ "required": ["time"] }, { "required": ["latitude"] }, { "required": ["longitude"] }] } },
    { "required": ["time", "latitude", "longitude"], "not": { "required": ["to_sun"] } },
]))]
pub struct DaylightKeys {
    /// How hazy the air is: 2 is very clear, 10 hazy; 3 when left out.
    pub turbidity: Option<Checked<Turbidity>>,
    /// The direction to the sun, of any length, above the horizon.
    pub to_sun: Option<Located<Vector>>,
    /// When it is, from 1950 to 2050: "2026-06-21T12:00:00+02:00", or with `Z` for universal time.
    pub time: Option<Located<String>>,
    /// Degrees north.
    pub latitude: Option<Checked<Elevation>>,
    /// Degrees east.
    pub longitude: Option<Checked<Longitude>>,
    /// Reflectance of the ground below the horizon; 0.2 when left out.
    pub ground: Option<Rgb<Fraction>>,
    /// The sun shines, as a directional light, and not the sky alone; true when left out.
    pub sun: Option<bool>,
}

impl DaylightKeys {
    /// The sun shines.
    pub fn has_sun(&self) -> bool {
        self.sun.unwrap_or(true)
    }

    /// The sky that the keys describe.
    ///
    /// # Errors
    /// Keys that do not go together, a time that is none, and a sun below the horizon.
    pub fn daylight(&self, resolver: &Resolver<'_>, place: &Place) -> Result<Daylight, SceneError> {
        let (to_sun, at) = match (&self.to_sun, &self.time, self.latitude, self.longitude) {
            (Some(to_sun), None, None, None) => (resolver.direction(to_sun)?, &to_sun.place),
            (None, Some(time), Some(latitude), Some(longitude)) => {
                let moment = Moment::read(&time.value).map_err(|message| resolver.error(&time.place, message))?;
                (direction_to_sun(moment, latitude.0, longitude.0), &time.place)
            }
            _ => {
                let message = "`daylight` has either `to_sun`, or `time`, `latitude` and `longitude`";
                return Err(resolver.error(place, message));
            }
        };
        if to_sun.y <= 0.0 {
            let message = format!("the sun is {:.1} degrees below the horizon", -to_sun.y.asin().to_degrees());
            return Err(resolver.error(at, message).with_help("this sky knows no night: choose a time of the day"));
        }
        let turbidity = self.turbidity.map_or(3.0, |turbidity| turbidity.0);
        Ok(Daylight { turbidity, ground: self.ground.as_ref().map_or(Spectrum::WHITE * 0.2, |ground| ground.0), to_sun })
    }
}

/// The sun of a sky that is turned as its environment is.
pub fn sun_of(daylight: &Daylight, environment: &Environment, scale: f64) -> DirectionalLight {
    let mirror = if environment.mirrored { DVec3::new(-1.0, 1.0, 1.0) } else { DVec3::ONE };
    let about_y = DMat3::from_rotation_y(environment.rotation_degrees.to_radians());
    let to_sun = environment.turn().unwrap_or(DMat3::IDENTITY) * about_y * (daylight.to_sun * mirror);
    DirectionalLight { direction: -to_sun.normalize(), irradiance: daylight.sun_irradiance() * scale }
}
