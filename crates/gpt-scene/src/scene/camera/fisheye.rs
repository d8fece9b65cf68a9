//! Ideal fisheye lenses.

use glam::{DVec2, DVec3, DVec4};

use super::model::{CameraModel, Eyes, ViewPlace};
use crate::choice::choices;
use crate::scene::check::Check;

choices! {
    /// How far from the picture's middle a fisheye shows what lies at the angle θ from its axis.
    pub enum FisheyeMapping {
        /// In proportion to θ.
        Equidistant = "equidistant",
        /// In proportion to sin(θ/2): equal areas of the picture are equal solid angles.
        Equisolid = "equisolid",
        /// In proportion to tan(θ/2): what is small keeps its shape.
        Stereographic = "stereographic",
        /// In proportion to sin θ: equal areas of the picture are equal irradiances on a plane across the axis.
        Orthographic = "orthographic",
    }

    /// How large the circle of a fisheye is.
    pub enum FisheyeFit {
        /// The circle touches the nearest edges: all of it is in the picture.
        Inside = "inside",
        /// The circle is as wide as the picture.
        Width = "width",
        /// The circle is as high as the picture.
        Height = "height",
        /// The circle goes through the corners: all of the picture is in it.
        Diagonal = "diagonal",
    }
}

impl FisheyeMapping {
    /// The largest field of view, in degrees, and whether it is possible itself.
    pub fn largest_fov(self) -> (f64, bool) {
        match self {
            Self::Equidistant | Self::Equisolid => (360.0, true),
            Self::Stereographic => (360.0, false),
            Self::Orthographic => (180.0, true),
        }
    }

    /// The number that shaders have for it.
    pub fn number(self) -> u32 {
        self as u32
    }

    /// The distance from the middle of what lies at an angle, up to a factor.
    fn radius(self, angle: f64) -> f64 {
        match self {
            Self::Equidistant => angle,
            Self::Equisolid => (0.5 * angle).sin(),
            Self::Stereographic => (0.5 * angle).tan(),
            Self::Orthographic => angle.sin(),
        }
    }

    /// Sine and cosine of the angle of what lies at such a distance.
    fn angle_at(self, radius: f64) -> (f64, f64) {
        match self {
            Self::Equidistant => radius.sin_cos(),
            Self::Equisolid => (2.0 * radius * (1.0 - radius * radius).max(0.0).sqrt(), 1.0 - 2.0 * radius * radius),
            Self::Stereographic => {
                let square = radius * radius;
                (2.0 * radius / (1.0 + square), (1.0 - square) / (1.0 + square))
            }
            Self::Orthographic => (radius, (1.0 - radius * radius).max(0.0).sqrt()),
        }
    }
}

/// A fisheye: a circle about the picture's middle, whose rim lies half the field of view from the axis. Outside of the circle there is nothing to see.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fisheye {
    pub mapping: FisheyeMapping,
    /// From rim to rim, across the axis.
    pub fov_degrees: f64,
    pub fit: FisheyeFit,
}

impl Fisheye {
    /// Radius of the circle in pixels.
    fn circle(&self, size: DVec2) -> f64 {
        0.5 * match self.fit {
            FisheyeFit::Inside => size.min_element(),
            FisheyeFit::Width => size.x,
            FisheyeFit::Height => size.y,
            FisheyeFit::Diagonal => size.length(),
        }
    }

    fn half_angle(&self) -> f64 {
        0.5 * self.fov_degrees.to_radians()
    }
}

impl CameraModel for Fisheye {
    fn check(&self) -> Check {
        let (most, is_possible) = self.mapping.largest_fov();
        let fov = self.fov_degrees;
        if fov > 0.0 && (fov < most || fov == most && is_possible) {
            return Ok(());
        }
        let words = if is_possible { "at most" } else { "below" };
        let name = crate::choice::Choice::name(self.mapping);
        Err(format!("the field of view of a fisheye that is {name} must be above 0 and {words} {most} degrees, and is {fov}"))
    }

    fn direction(&self, place: &ViewPlace) -> Option<DVec3> {
        let aside = (place.at - 0.5 * place.size) / self.circle(place.size);
        let distance = aside.length();
        if distance > 1.0 {
            return None;
        }
        let (sine, cosine) = self.mapping.angle_at(distance * self.mapping.radius(self.half_angle()));
        let towards = if distance > 0.0 { aside / distance } else { DVec2::ZERO };
        Some(DVec3::new(towards.x * sine, -towards.y * sine, -cosine))
    }

    /// The circle's middle, and one over its radius, in pixels; the radius that the mapping gives the rim, in turns where it is an angle.
    fn words(&self, size: DVec2) -> [DVec4; 4] {
        let rim = self.mapping.radius(self.half_angle());
        let rim = if self.mapping == FisheyeMapping::Equidistant { rim / std::f64::consts::TAU } else { rim };
        let first = DVec4::new(0.5 * size.x, 0.5 * size.y, self.circle(size).recip(), rim);
        [first, DVec4::ZERO, DVec4::ZERO, DVec4::ZERO]
    }

    fn eyes(&self) -> Eyes {
        Eyes::Pair
    }
}
