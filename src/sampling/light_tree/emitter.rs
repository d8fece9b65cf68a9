//! Facts about one light that a tree of lights is built from.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;

use super::cone::Cone;
use crate::scene::{LightParameters, LightStrength, Shape};

/// Addition to the angle up to which a light emits: no rounding then takes a light for one that does not
/// reach a point.
const MARGIN: f64 = 0.01;
/// Times at which a moving light is looked at, beside the first.
const TIMES: u32 = 16;
/// Axes are rounded to multiples of 1 over this.
const AXIS_STEPS: f64 = (1 << 20) as f64;

/// A light inside the scene.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emitter {
    /// Lower and upper corner of a box around it.
    pub bounds: [DVec3; 2],
    pub cone: Cone,
    /// Luminous, above 0.
    pub power: f64,
}

impl Emitter {
    /// A surface at rest: `normal` is that of a flat one, on its front.
    pub fn surface(bounds: [DVec3; 2], normal: Option<DVec3>, two_sided: bool, power: f64) -> Self {
        let reach = FRAC_PI_2 + MARGIN;
        let cone = match normal {
            Some(normal) => Cone { axis: rounded_axis(normal), spread: 0.0, reach, two_sided },
            None => Cone { axis: DVec3::Z, spread: PI, reach, two_sided: false },
        };
        Self { bounds, cone, power }
    }

    /// A surface of a moving shape, with its bounds at rest. It may turn any way.
    pub fn moving(shape: &Shape, shutter: [f64; 2], bounds: [DVec3; 2], power: f64) -> Self {
        let [low, high] = bounds;
        let [open, close] = shutter;
        let corner = |index: usize| DVec3::select(glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), high, low);
        let places = (0..=TIMES).flat_map(|step| {
            let map = shape.moved_by(open + (close - open) * f64::from(step) / f64::from(TIMES)).unwrap_or_default();
            (0..8).map(move |index| map.transform_point3(corner(index)))
        });
        let swept = places.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
        Self::surface(swept, None, false, power)
    }

    /// A delta light; None: it is at infinity.
    pub fn delta(light: &LightParameters) -> Option<Self> {
        let LightStrength::Power(power) = light.strength else { return None };
        let bounds = [light.position; 2];
        let cone = match light.cone {
            None => Cone { axis: DVec3::Z, spread: PI, reach: FRAC_PI_2, two_sided: false },
            Some((axis, [full, end])) => {
                Cone { axis: rounded_axis(axis), spread: full, reach: (end - full + MARGIN).min(PI), two_sided: false }
            }
        };
        Some(Self { bounds, cone, power })
    }
}

/// Rounded, so that it is the same however it was found.
fn rounded_axis(axis: DVec3) -> DVec3 {
    ((axis * AXIS_STEPS).round() / AXIS_STEPS).try_normalize().unwrap_or(DVec3::Z)
}
