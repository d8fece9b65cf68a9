//! How shapes move while the shutter is open.

use glam::{DAffine3, DQuat, DVec3};

use super::check::{Check, FARTHEST, within_range};

/// Steps applied in this order after a shape's `transform`, along the world's axes and about the shape's own origin, that is where
/// `transform` puts the shape's (0, 0, 0). Each is interpolated by itself, at rest at one shutter time and reached at another: a rotation
/// turns evenly about its axis, which no blend of matrices does. Times beyond the two extrapolate.
#[derive(Debug, Clone, PartialEq)]
pub struct Motion {
    pub steps: Vec<MotionStep>,
    /// The shutter times of rest and of the steps as they are written: 0 and 1 in scene files.
    pub rest: f64,
    pub reached: f64,
}

impl Default for Motion {
    fn default() -> Self {
        Self { steps: Vec::new(), rest: 0.0, reached: 1.0 }
    }
}

/// One step as it is where it is reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum MotionStep {
    Scale(DVec3),
    Rotate {
        axis: DVec3,
        degrees: f64,
    },
    Translate(DVec3),
    /// A turn that is the same at all times. Before and after a scale, it and its inverse turn the axes of the scale.
    Turned {
        axis: DVec3,
        degrees: f64,
    },
}

/// Smallest factor by which a moving shape may be scaled. Below, single precision loses the shape.
pub const SMALLEST_SCALE: f64 = 1e-6;
/// Most turns of one step while the shutter is open. Beyond, single precision loses the angle, and the eye lost it long before.
pub const MOST_TURNS: f64 = 100.0;
impl MotionStep {
    /// The factors of a scale at a time.
    pub fn factors(scale: DVec3, time: f64) -> DVec3 {
        DVec3::ONE + (scale - DVec3::ONE) * time
    }

    fn at(self, time: f64) -> DAffine3 {
        match self {
            Self::Scale(scale) => DAffine3::from_scale(Self::factors(scale, time)),
            Self::Rotate { axis, degrees } => {
                DAffine3::from_quat(DQuat::from_axis_angle(axis.normalize(), degrees.to_radians() * time))
            }
            Self::Translate(offset) => DAffine3::from_translation(offset * time),
            Self::Turned { axis, degrees } => DAffine3::from_quat(DQuat::from_axis_angle(axis.normalize(), degrees.to_radians())),
        }
    }

    /// Checks that the step can be followed over the whole shutter, whose times are 0 at rest and 1 where the
    /// step is reached.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check(self, [open, close]: [f64; 2]) -> Result<(), String> {
        match self {
            Self::Scale(scale) => {
                let smallest = [open, close].map(|time| Self::factors(scale, time).min_element());
                if smallest.into_iter().all(|factor| factor >= SMALLEST_SCALE) {
                    return Ok(());
                }
                Err(format!("the scale shrinks the shape to nothing on the way to shutter times {open} to {close}"))
            }
            Self::Rotate { degrees, .. } if (degrees * (close - open)).abs() > 360.0 * MOST_TURNS => {
                Err(format!("the shape turns more than {MOST_TURNS} times while the shutter is open"))
            }
            Self::Rotate { .. } | Self::Translate(_) | Self::Turned { .. } => Ok(()),
        }
    }
}

impl Motion {
    /// The steps as scene files have them: at rest at shutter time 0, reached at time 1.
    pub fn new(steps: Vec<MotionStep>) -> Self {
        Self { steps, ..Self::default() }
    }

    /// A shutter time as the steps count it: 0 at rest, 1 where they are reached.
    pub fn share(&self, time: f64) -> f64 {
        if self.rest == 0.0 && self.reached == 1.0 { time } else { (time - self.rest) / (self.reached - self.rest) }
    }

    /// Checks that all steps can be followed over the whole shutter, and lead to where numbers are finite.
    ///
    /// # Errors
    /// The mistake, in words, and its step if it is in a single one.
    pub fn check(&self, shutter: [f64; 2]) -> Result<(), (Option<usize>, String)> {
        let shares = shutter.map(|time| self.share(time));
        for (index, step) in self.steps.iter().enumerate() {
            step.check(shares).map_err(|message| (Some(index), message))?;
        }
        self.check_ends(shutter, DVec3::ZERO).map_err(|message| (None, message))
    }

    /// Checks that numbers stay in their range for a shape about `origin` that is moved as the shutter opens
    /// and closes.
    pub(super) fn check_ends(&self, shutter: [f64; 2], origin: DVec3) -> Result<(), String> {
        let ends = shutter.map(|time| self.at(time, origin));
        let in_range = |map: &DAffine3| map.to_cols_array().iter().all(|number| number.abs() <= FARTHEST);
        if ends.iter().all(|map| in_range(map) && map.matrix3.determinant().is_normal()) {
            return Ok(());
        }
        Err("the motion leaves the range of numbers".to_owned())
    }

    /// The map from the world at rest to the world at `time` of what stands about `origin`.
    pub fn at(&self, time: f64, origin: DVec3) -> DAffine3 {
        let time = self.share(time);
        let to_origin = DAffine3::from_translation(-origin);
        let moved = self.steps.iter().fold(to_origin, |so_far, step| step.at(time) * so_far);
        DAffine3::from_translation(origin) * moved
    }

    /// Checks that a shape within `radius` of `origin` at rest stays within the range of numbers. Boxes around moving shapes are larger by a part of the way that they go, so that way counts too.
    pub(super) fn check_reach(&self, shutter: [f64; 2], origin: DVec3, radius: f64) -> Check {
        let (farthest, speed) = self.bounds(radius, shutter);
        within_range(origin.length() + farthest + speed * (shutter[1] - shutter[0]))
    }

    /// A bound on the speed, in lengths per shutter time, of points that at rest are within `radius` of the origin.
    pub fn greatest_speed(&self, radius: f64, shutter: [f64; 2]) -> f64 {
        self.bounds(radius, shutter).1
    }

    /// Bounds on how far from the origin points that at rest are within `radius` of it come, and on their speed.
    fn bounds(&self, radius: f64, shutter: [f64; 2]) -> (f64, f64) {
        let [open, close] = shutter.map(|time| self.share(time));
        let (mut farthest, mut speed) = (radius, 0.0);
        let latest = open.abs().max(close.abs());
        for step in &self.steps {
            match *step {
                MotionStep::Scale(scale) => {
                    let largest = [open, close].map(|time| MotionStep::factors(scale, time).abs().max_element());
                    let [a, b] = largest;
                    speed = a.max(b) * speed + (scale - DVec3::ONE).abs().max_element() * farthest;
                    farthest *= a.max(b);
                }
                MotionStep::Rotate { degrees, .. } => speed += degrees.to_radians().abs() * farthest,
                MotionStep::Translate(offset) => {
                    speed += offset.length();
                    farthest += offset.length() * latest;
                }
                MotionStep::Turned { .. } => {}
            }
        }
        (farthest, speed / (self.reached - self.rest))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion(steps: &[MotionStep]) -> Motion {
        Motion::new(steps.to_vec())
    }

    /// A turn about the origin keeps lengths at all times; a blend of the matrices at rest and in the end does not.
    #[test]
    fn rotations_keep_lengths_on_their_way() {
        let turn = motion(&[MotionStep::Rotate { axis: DVec3::new(1.0, 2.0, -0.5), degrees: 90.0 }]);
        let (origin, point) = (DVec3::new(3.0, 1.0, 0.0), DVec3::new(4.0, 3.0, 2.0));
        let radius = (point - origin).length();
        for step in 0..=10 {
            let moved = turn.at(f64::from(step) / 10.0, origin).transform_point3(point);
            assert!(((moved - origin).length() - radius).abs() < 1e-14 * radius);
        }
        let blended = 0.5 * (point + turn.at(1.0, origin).transform_point3(point));
        assert!((blended - origin).length() < 0.9 * radius);
    }

    /// By hand: a quarter turn about the vertical takes x to −z; half of it at half time.
    #[test]
    fn steps_apply_in_their_order_about_the_origin() {
        let steps = [
            MotionStep::Scale(DVec3::splat(3.0)),
            MotionStep::Rotate { axis: DVec3::Y, degrees: 180.0 },
            MotionStep::Translate(DVec3::new(0.0, 4.0, 0.0)),
        ];
        let origin = DVec3::new(10.0, 0.0, 0.0);
        let at_half = motion(&steps).at(0.5, origin).transform_point3(origin + DVec3::X);
        assert!((at_half - (origin + DVec3::new(0.0, 2.0, -2.0))).length() < 1e-14, "{at_half}");
        // The translation first: it is turned and scaled with the shape.
        let reversed: Vec<MotionStep> = steps.into_iter().rev().collect();
        let at_one = motion(&reversed).at(1.0, origin).transform_point3(origin + DVec3::X);
        assert!((at_one - (origin + DVec3::new(-3.0, 12.0, 0.0))).length() < 1e-14, "{at_one}");
        assert_eq!(motion(&steps).at(0.0, origin).transform_point3(DVec3::ONE), DVec3::ONE);
    }

    #[test]
    fn what_cannot_be_followed_is_named() {
        let shrinking = MotionStep::Scale(DVec3::new(1.0, -1.0, 1.0));
        assert!(shrinking.check([0.0, 0.4]).is_ok());
        assert!(shrinking.check([0.0, 0.5]).is_err());
        // Inside out on both ends: it passed through nothing before the shutter opened.
        assert!(shrinking.check([0.7, 0.9]).is_err());
        let spinning = MotionStep::Rotate { axis: DVec3::X, degrees: 72_000.0 };
        assert!(spinning.check([0.0, 1.0]).is_err());
        assert!(spinning.check([0.0, 0.5]).is_ok());
    }
}
