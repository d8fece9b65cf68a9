//! Meters: places where light is measured as a number, not seen as a picture.

use std::f64::consts::PI;

use glam::DVec3;

use super::medium::MediumId;

/// Factor from W to lm, by which glTF and others relate luminance to radiance.
pub const LUMEN_PER_WATT: f64 = 683.0;

/// Something that measures light.
#[derive(Debug, Clone, PartialEq)]
pub struct Meter {
    pub name: String,
    pub kind: MeterKind,
    /// The medium around it; None: that of the camera.
    pub medium: Option<MediumId>,
}

#[derive(Debug, Clone, PartialEq)]
pub enum MeterKind {
    /// Light from the hemisphere about a normal, W·m⁻², at a point.
    Irradiance { position: DVec3, normal: DVec3 },
    /// The mean of that over a rectangle, whose edges have a right angle between them. Its front is where u × v points.
    IrradianceOfRectangle { corner: DVec3, edge_u: DVec3, edge_v: DVec3 },
    /// The mean of that over a disk.
    IrradianceOfDisk { center: DVec3, normal: DVec3, radius: f64 },
    /// The mean of that over the outside of a sphere.
    IrradianceOfSphere { center: DVec3, radius: f64 },
    /// Light along one ray, W·m⁻²·sr⁻¹.
    Radiance { position: DVec3, direction: DVec3 },
    /// Light along parallel rays that come from outside the scene, in a square window of this size about the target; one ray where that is 0.
    Distant { direction: DVec3, target: DVec3, size: f64 },
}

impl MeterKind {
    /// The type in scene files.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Irradiance { .. }
            | Self::IrradianceOfRectangle { .. }
            | Self::IrradianceOfDisk { .. }
            | Self::IrradianceOfSphere { .. } => "irradiance",
            Self::Radiance { .. } => "radiance",
            Self::Distant { .. } => "distant",
        }
    }

    pub fn unit(&self) -> &'static str {
        if self.is_of_irradiance() { "W/m²" } else { "W/(m² sr)" }
    }

    /// The photometric unit.
    pub fn photometric_unit(&self) -> &'static str {
        if self.is_of_irradiance() { "lx" } else { "cd/m²" }
    }

    pub(super) fn is_of_irradiance(&self) -> bool {
        !matches!(self, Self::Radiance { .. } | Self::Distant { .. })
    }

    /// The quantity over the mean of the picture that the meter sees. Round ones fill a circle of the square picture, π/4 of it.
    pub fn factor(&self) -> f64 {
        match self {
            Self::Irradiance { .. } | Self::IrradianceOfRectangle { .. } => PI,
            Self::IrradianceOfDisk { .. } | Self::IrradianceOfSphere { .. } => 4.0,
            Self::Radiance { .. } | Self::Distant { .. } => 1.0,
        }
    }
}
