//! Ranges of angles.

use crate::scene::check::Check;

/// Checks a range of azimuths, in degrees to the right of the viewing direction.
pub fn check_azimuth([from, to]: [f64; 2]) -> Check {
    if from >= -360.0 && to <= 360.0 && from < to && to - from <= 360.0 {
        return Ok(());
    }
    Err(format!("its azimuths must rise, by 360 degrees at most, and lie from -360 to 360; they are {from} and {to}"))
}

/// Checks a range of elevations, in degrees above the horizon: up to `most` of either side.
pub fn check_elevation([from, to]: [f64; 2], most: f64) -> Check {
    if from >= -most && to <= most && from < to {
        return Ok(());
    }
    Err(format!("its elevations must rise, and lie from -{most} to {most} degrees; they are {from} and {to}"))
}
