//! Transforms that change while the shutter is open, as steps of motion.
//!
//! There the translation, the rotation and the stretch of the transform go evenly from the start to the end. Here a shape is scaled, turned and moved
//! from where it rests, each evenly too, about its own origin and along the world's axes: the same for all that keeps its form.

use glam::{DMat3, DQuat, DVec3};

use super::converter::Converter;
use super::graphics_state::Maps;
use super::text::Spot;
use crate::load::error::SceneError;
use crate::load::file::keyframes::ScaleEntry;
use crate::load::file::shape::TransformEntry;
use crate::load::file::shape::transform::StepEntry;
use crate::load::file::value::{Exactly, Located, Number};
use crate::load::place::Place;

/// Differences that are rounding.
const SAME: f64 = 1e-9;
/// Stretches along other axes than the world's that are not seen.
const SLIGHT: f64 = 1e-4;

impl Converter<'_> {
    /// The motion from one transform to another; None of what rests.
    pub fn motion(&mut self, maps: &Maps, spot: &Spot) -> Result<Option<Located<TransformEntry>>, SceneError> {
        let [start, end] = self.world.transform_times;
        if maps[0] == maps[1] || start >= end {
            return Ok(None);
        }
        let change = maps[1].matrix3 * maps[0].matrix3.inverse();
        let Some((rotation, stretch)) = polar(change) else {
            self.drop(spot, "motion that mirrors", "it rests where its transform begins");
            return Ok(None);
        };
        let factors = DVec3::new(stretch.x_axis.x, stretch.y_axis.y, stretch.z_axis.z);
        let beside =
            (stretch - DMat3::from_diagonal(factors)).to_cols_array().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        if beside > SLIGHT {
            let instead = "it is stretched along the world's axes";
            self.approximate(spot, "motion that stretches along other axes than the world's", instead);
        }
        let steps = steps(factors, rotation, maps[1].translation - maps[0].translation, &spot.place());
        let steps = spot.possible(steps)?;
        Ok((!steps.is_empty()).then(|| spot.place().at(TransformEntry::Steps(steps))))
    }
}

/// Steps of a scale, a turn and a way, those that change something.
fn steps(factors: DVec3, rotation: DQuat, way: DVec3, place: &Place) -> Result<Vec<Located<StepEntry>>, String> {
    let empty = || StepEntry { scale: None, rotate: None, degrees: None, translate: None, matrix: None };
    let mut steps = Vec::new();
    if (factors - 1.0).abs().max_element() > SAME {
        steps.push(place.at(StepEntry { scale: Some(place.at(ScaleEntry(factors))), ..empty() }));
    }
    let (axis, angle) = rotation.to_axis_angle();
    if angle.abs() > SAME {
        let degrees = Some(place.at(Number::of(angle.to_degrees())?));
        steps.push(place.at(StepEntry { rotate: Some(place.at(Exactly::of(axis.to_array())?)), degrees, ..empty() }));
    }
    if way.length() > 0.0 {
        steps.push(place.at(StepEntry { translate: Some(Exactly::of(way.to_array())?), ..empty() }));
    }
    Ok(steps)
}

/// The rotation and the stretch whose product a map is (Higham 1986); None of one that mirrors.
fn polar(map: DMat3) -> Option<(DQuat, DMat3)> {
    if map.determinant().is_nan() || map.determinant() <= 0.0 {
        return None;
    }
    let mut rotation = map;
    for _ in 0..64 {
        let next = (rotation + rotation.inverse().transpose()) * 0.5;
        let change = (next - rotation).to_cols_array().iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        rotation = next;
        if change < 1e-15 {
            break;
        }
    }
    // The shorter way round.
    let turn = DQuat::from_mat3(&rotation).normalize();
    let turn = if turn.w < 0.0 { -turn } else { turn };
    Some((turn, rotation.transpose() * map))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_and_a_stretch_are_told_apart() {
        let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, 0.5).normalize(), 2.0);
        let stretch = DMat3::from_diagonal(DVec3::new(1.5, 0.5, 2.0));
        let (rotation, scale) = polar(DMat3::from_quat(turn) * stretch).expect("it keeps its sides");
        assert!(rotation.angle_between(turn) < 1e-7, "{rotation}");
        assert!((scale - stretch).to_cols_array().iter().all(|value| value.abs() < 1e-9), "{scale}");
        assert!(polar(DMat3::from_diagonal(DVec3::new(-1.0, 1.0, 1.0))).is_none());
        let (rest, _) = polar(DMat3::IDENTITY).expect("it rests");
        assert!(steps(DVec3::ONE, rest, DVec3::ZERO, &Place::default()).expect("numbers").is_empty());
    }
}
