//! Lights that are not surfaces.

use std::sync::Arc;

use glam::DVec3;

use super::texture::ImageData;

#[derive(Debug, Clone)]
pub enum Light {
    Environment(Environment),
    /// Radiant intensity in W·sr⁻¹, the same in every direction.
    Point {
        position: DVec3,
        intensity: DVec3,
    },
    /// A point light cut to a cone: full `intensity` inside `falloff_degrees` of the axis, none past `angle_degrees`, between them
    /// the smooth step t²(3 − 2t) in the cosine.
    Spot {
        position: DVec3,
        direction: DVec3,
        intensity: DVec3,
        angle_degrees: f64,
        falloff_degrees: f64,
    },
    /// Parallel light; `irradiance` is on a surface facing it, `direction` the way the light travels.
    Directional {
        direction: DVec3,
        irradiance: DVec3,
    },
}

/// Radiance that arrives from outside the scene.
#[derive(Debug, Clone)]
pub struct Environment {
    pub radiance: EnvironmentRadiance,
    /// Rotation about +Y, counter-clockwise seen from above.
    pub rotation_degrees: f64,
}

#[derive(Debug, Clone)]
pub enum EnvironmentRadiance {
    Constant(DVec3),
    /// Lat-long map: u = atan2(x, -z)/2π (mod 1), v = acos(y)/π from the top row, interpolated bilinearly; texels already multiplied by `scale`.
    Map(Arc<ImageData>),
    /// horizon + (zenith − horizon)·y over the upper half, y the direction's height, `ground` below.
    Sky {
        zenith: DVec3,
        horizon: DVec3,
        ground: DVec3,
    },
}
