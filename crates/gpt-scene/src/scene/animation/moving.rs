//! The motion during one exposure, from where something stands at the shutter's times.

use glam::{DAffine3, DMat3, DQuat, DVec3};

use super::curve::Turn;
use crate::scene::motion::{Motion, MotionStep};

/// Stretches of an exposure in which turns are counted, so that what turns more than half around is not taken to turn the other way.
const STRETCHES: u32 = 8;
/// Parts of a map that are less than this apart from doing nothing do nothing.
const NEGLIGIBLE: f64 = 1e-12;

/// A shape that is turned inside out between two times has no motion that leads from one to the other.
pub const INSIDE_OUT: &str = "is turned inside out while the shutter is open";

/// The placement as the shutter opens, and the motion from there on: it is exact as the shutter opens and closes, and even in between. None for a thing at rest.
///
/// # Errors
/// `INSIDE_OUT`.
pub fn motion_between(at: &dyn Fn(f64) -> DAffine3, [open, close]: [f64; 2]) -> Result<Option<(DAffine3, Motion)>, &'static str> {
    let time = |index: u32| open + (close - open) * f64::from(index) / f64::from(STRETCHES);
    let maps: Vec<DAffine3> = (0..=STRETCHES).map(|index| at(time(index))).collect();
    let first = maps[0];
    if open == close || maps.iter().all(|map| *map == first) {
        return Ok(None);
    }
    let last = maps[STRETCHES as usize];
    let (stretch, rotation) = polar(last.matrix3 * first.matrix3.inverse()).ok_or(INSIDE_OUT)?;
    let mut steps = stretch_steps(stretch);
    let turn = counted(&maps).filter(|turn| turn.degrees > 180.0).unwrap_or_else(|| Turn::of(rotation));
    if turn.degrees.to_radians() > NEGLIGIBLE {
        steps.push(MotionStep::Rotate { axis: turn.axis, degrees: turn.degrees });
    }
    let offset = last.translation - first.translation;
    if offset != DVec3::ZERO {
        steps.push(MotionStep::Translate(offset));
    }
    Ok((!steps.is_empty()).then_some((first, Motion { steps, rest: open, reached: close })))
}

/// All that is turned during the exposure, where it is about one axis.
fn counted(maps: &[DAffine3]) -> Option<Turn> {
    let mut sum = Turn { axis: DVec3::ZERO, degrees: 0.0 };
    for pair in maps.windows(2) {
        let (_, rotation) = polar(pair[1].matrix3 * pair[0].matrix3.inverse())?;
        let turn = Turn::of(rotation);
        if turn.degrees == 0.0 {
            continue;
        }
        if sum.degrees == 0.0 {
            sum.axis = turn.axis;
        }
        if turn.axis.dot(sum.axis) < 0.999 {
            return None;
        }
        sum.degrees += turn.degrees;
    }
    Some(sum)
}

/// Steps that stretch along three axes at right angles; none where nothing is stretched.
fn stretch_steps((axes, factors): (DMat3, DVec3)) -> Vec<MotionStep> {
    if (factors - DVec3::ONE).abs().max_element() <= NEGLIGIBLE {
        return Vec::new();
    }
    let even = factors.max_element() - factors.min_element() <= NEGLIGIBLE * factors.max_element();
    if even {
        return vec![MotionStep::Scale(DVec3::splat(factors.x))];
    }
    let turn = Turn::of(DQuat::from_mat3(&axes));
    if turn.degrees.to_radians() <= NEGLIGIBLE {
        return vec![MotionStep::Scale(factors)];
    }
    let turned = |degrees: f64| MotionStep::Turned { axis: turn.axis, degrees };
    vec![turned(-turn.degrees), MotionStep::Scale(factors), turned(turn.degrees)]
}

/// A map as a stretch along the columns of a rotation, followed by a rotation; None where it mirrors or flattens.
fn polar(map: DMat3) -> Option<((DMat3, DVec3), DQuat)> {
    if !map.determinant().is_normal() || map.determinant() < 0.0 {
        return None;
    }
    let (axes, squares) = eigen(map.transpose() * map);
    let factors = DVec3::new(squares.x.sqrt(), squares.y.sqrt(), squares.z.sqrt());
    let unstretch = axes * DMat3::from_diagonal(factors.recip()) * axes.transpose();
    let rotation = map * unstretch;
    rotation.is_finite().then(|| ((axes, factors), DQuat::from_mat3(&rotation).normalize()))
}

/// By what factor a map stretches one direction more than another at most: 1 for turns, mirrors and uniform scales; infinite where it flattens, or
/// where that cannot be told.
pub fn unevenness(map: DMat3) -> f64 {
    let (_, squares) = eigen(map.transpose() * map);
    let is_known = squares.is_finite() && squares.min_element() > 0.0;
    if is_known { (squares.max_element() / squares.min_element()).sqrt() } else { f64::INFINITY }
}

/// Eigenvectors, as the columns of a rotation, and eigenvalues of a symmetric matrix, by Jacobi's method. A matrix that is diagonal keeps its axes.
fn eigen(mut matrix: DMat3) -> (DMat3, DVec3) {
    let mut axes = DMat3::IDENTITY;
    for _ in 0..32 {
        let mut largest = 0.0;
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            let (a, b, off) = (matrix.col(p)[p], matrix.col(q)[q], matrix.col(q)[p]);
            if off.abs() <= 1e-16 * (a.abs() + b.abs()) {
                continue;
            }
            largest = f64::max(largest, off.abs());
            let theta = (b - a) / (2.0 * off);
            let tangent = theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt());
            let cosine = 1.0 / (tangent * tangent + 1.0).sqrt();
            let sine = tangent * cosine;
            let mut turn = DMat3::IDENTITY;
            turn.col_mut(p)[p] = cosine;
            turn.col_mut(q)[q] = cosine;
            turn.col_mut(q)[p] = sine;
            turn.col_mut(p)[q] = -sine;
            matrix = turn.transpose() * matrix * turn;
            axes *= turn;
        }
        if largest == 0.0 {
            break;
        }
    }
    (axes, DVec3::new(matrix.x_axis.x, matrix.y_axis.y, matrix.z_axis.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn moved(at: &dyn Fn(f64) -> DAffine3, shutter: [f64; 2], time: f64) -> DAffine3 {
        let (first, motion) = motion_between(at, shutter).expect("it can be followed").expect("it moves");
        motion.at(time, first.translation) * first
    }

    /// A map that is stretched unevenly along axes of its own, turned and moved is met at both ends of the exposure; by its negative control, a
    /// motion without the turns about the stretch, it is not.
    #[test]
    fn a_motion_leads_from_the_opening_to_the_closing() {
        let axis = DVec3::new(1.0, 2.0, 2.0) / 3.0;
        let at = |time: f64| {
            DAffine3::from_scale_rotation_translation(
                DVec3::new(1.0 + time, 2.0, 3.0 - 0.5 * time),
                DQuat::from_axis_angle(axis, 0.3 + 0.8 * time),
                DVec3::new(5.0, time, 1.0 - time),
            )
        };
        for shutter in [[0.0, 1.0], [0.25, 0.75], [3.0, 3.5]] {
            let apart = |a: DAffine3, b: DAffine3| {
                (a.to_cols_array().into_iter().zip(b.to_cols_array())).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
            };
            for time in shutter {
                assert!(apart(moved(&at, shutter, time), at(time)) < 1e-11, "{shutter:?} {time}");
            }
            let (first, mut motion) = motion_between(&at, shutter).expect("it can be followed").expect("it moves");
            motion.steps.retain(|step| !matches!(step, MotionStep::Turned { .. }));
            let wrong = motion.at(shutter[1], first.translation) * first;
            assert!(apart(wrong, at(shutter[1])) > 1e-3, "the control: {shutter:?}");
        }
    }

    #[test]
    fn what_is_squashed_is_uneven_and_what_is_turned_moved_or_scaled_is_not() {
        let turn = DMat3::from_axis_angle(DVec3::new(0.6, 0.0, 0.8), 1.1);
        for even in [turn, turn * 1e3, DMat3::from_diagonal(DVec3::new(-2.0, 2.0, 2.0)) * turn] {
            assert!((unevenness(even) - 1.0).abs() < 1e-9, "{even}");
        }
        let squashed = turn * DMat3::from_diagonal(DVec3::new(3.0, 0.5, 1.0)) * turn.transpose();
        assert!((unevenness(squashed) - 6.0).abs() < 1e-9);
        let flat = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0));
        for flattened in [flat, flat.inverse(), turn * flat.inverse(), DMat3::ZERO] {
            assert_eq!(unevenness(flattened), f64::INFINITY, "{flattened}");
        }
    }

    #[test]
    fn whole_turns_are_counted() {
        let at = |time: f64| DAffine3::from_rotation_y(1.5 * std::f64::consts::TAU * time);
        let (_, motion) = motion_between(&at, [0.0, 1.0]).expect("it can be followed").expect("it moves");
        let [MotionStep::Rotate { axis, degrees }] = motion.steps[..] else { panic!("{:?}", motion.steps) };
        assert!((axis - DVec3::Y).length() < 1e-9 && (degrees - 540.0).abs() < 1e-9, "{axis} {degrees}");
        let third = motion.at(1.0 / 3.0, DVec3::ZERO).transform_point3(DVec3::X);
        assert!((third + DVec3::X).length() < 1e-9, "half a turn at a third: {third}");
    }

    #[test]
    fn what_rests_has_no_motion_and_what_turns_inside_out_none_either() {
        let still = |_: f64| DAffine3::from_translation(DVec3::Y);
        assert_eq!(motion_between(&still, [0.0, 1.0]), Ok(None));
        let moving = |time: f64| DAffine3::from_translation(DVec3::Y * time);
        assert_eq!(motion_between(&moving, [0.5, 0.5]), Ok(None));
        assert!(motion_between(&moving, [0.0, 0.5]).is_ok_and(|motion| motion.is_some()));
        let inverted = |time: f64| DAffine3::from_scale(DVec3::new(1.0, 1.0 - 2.0 * time, 1.0));
        assert_eq!(motion_between(&inverted, [0.0, 1.0]), Err(INSIDE_OUT));
    }
}
