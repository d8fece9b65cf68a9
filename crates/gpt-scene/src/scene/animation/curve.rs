//! Quantities that go through keys.

use glam::{DQuat, DVec3};

use crate::spectrum::Spectrum;

/// How a quantity goes from one key to the next.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// Evenly.
    #[default]
    Linear,
    /// With a speed that does not jump: at rest at the first and the last key and wherever it turns back, and never beyond a key's value (Fritsch
    /// and Butland 1984).
    Smooth,
    /// Not at all: it keeps a key's value up to the next key.
    Step,
}

/// A value at a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Key<T> {
    pub frame: f64,
    pub value: T,
}

/// A quantity by its keys, in the order of their frames, which differ. Before the first key and after the last it stays what it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve<T> {
    pub keys: Vec<Key<T>>,
    pub interpolation: Interpolation,
}

impl<T> Default for Curve<T> {
    fn default() -> Self {
        Self { keys: Vec::new(), interpolation: Interpolation::default() }
    }
}

/// A quantity that can be interpolated.
pub trait Quantity: Copy {
    /// Between two keys, `share` of the way.
    fn between(a: Self, b: Self, share: f64) -> Self;

    /// The value between two keys, with a speed that does not jump at them. `before` and `after` are the keys
    /// around the two.
    fn smoothly_between(before: Option<Key<Self>>, a: Key<Self>, b: Key<Self>, after: Option<Key<Self>>, share: f64) -> Self;
}

/// A moment while the shutter is open, both in frames.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moment {
    pub now: f64,
    /// When it opened. Jumps after that are not followed: a jump is no motion, and would be blurred as one.
    pub opening: f64,
}

impl From<f64> for Moment {
    /// By itself.
    fn from(frame: f64) -> Self {
        Self { now: frame, opening: frame }
    }
}

impl<T: Quantity> Curve<T> {
    /// Its value while the shutter is open; None where it has no keys.
    pub fn during(&self, moment: Moment) -> Option<T> {
        self.at(if self.interpolation == Interpolation::Step { moment.opening } else { moment.now })
    }

    /// Its value at a frame; None where it has no keys.
    pub fn at(&self, frame: f64) -> Option<T> {
        let keys = &self.keys;
        let next = keys.partition_point(|key| key.frame <= frame);
        let Some(a) = next.checked_sub(1).map(|last| keys[last]) else { return keys.first().map(|key| key.value) };
        let Some(&b) = keys.get(next) else { return Some(a.value) };
        let share = (frame - a.frame) / (b.frame - a.frame);
        Some(match self.interpolation {
            // A key is met exactly.
            _ if share == 0.0 => a.value,
            Interpolation::Step => a.value,
            Interpolation::Linear => T::between(a.value, b.value, share),
            Interpolation::Smooth => {
                let before = next.checked_sub(2).map(|index| keys[index]);
                T::smoothly_between(before, a, b, keys.get(next + 1).copied(), share)
            }
        })
    }
}

impl Quantity for f64 {
    fn between(a: Self, b: Self, share: f64) -> Self {
        a + (b - a) * share
    }

    fn smoothly_between(before: Option<Key<Self>>, a: Key<Self>, b: Key<Self>, after: Option<Key<Self>>, share: f64) -> Self {
        let slope = |from: Key<Self>, to: Key<Self>| (to.value - from.value) / (to.frame - from.frame);
        let width = |from: Key<Self>, to: Key<Self>| to.frame - from.frame;
        let own = slope(a, b);
        let start = before.map_or(0.0, |before| speed([slope(before, a), own], [width(before, a), width(a, b)]));
        let end = after.map_or(0.0, |after| speed([own, slope(b, after)], [width(a, b), width(b, after)]));
        hermite([a.value, b.value], [start, end], width(a, b), share)
    }
}

impl Quantity for Spectrum {
    fn between(a: Self, b: Self, share: f64) -> Self {
        a + (b - a) * share
    }

    fn smoothly_between(before: Option<Key<Self>>, a: Key<Self>, b: Key<Self>, after: Option<Key<Self>>, share: f64) -> Self {
        let channel = |channel: usize| {
            let of = |key: Key<Self>| Key { frame: key.frame, value: key.value.to_rgb()[channel] };
            f64::smoothly_between(before.map(of), of(a), of(b), after.map(of), share)
        };
        Self::new(channel(0), channel(1), channel(2))
    }
}

impl Quantity for DVec3 {
    fn between(a: Self, b: Self, share: f64) -> Self {
        a + (b - a) * share
    }

    fn smoothly_between(before: Option<Key<Self>>, a: Key<Self>, b: Key<Self>, after: Option<Key<Self>>, share: f64) -> Self {
        let component = |axis: usize| {
            let of = |key: Key<Self>| Key { frame: key.frame, value: key.value[axis] };
            f64::smoothly_between(before.map(of), of(a), of(b), after.map(of), share)
        };
        Self::new(component(0), component(1), component(2))
    }
}

/// The speed at a key between two stretches with these slopes and widths: a weighted harmonic mean, 0 where they differ in sign.
fn speed([before, after]: [f64; 2], [width_before, width_after]: [f64; 2]) -> f64 {
    if before * after <= 0.0 {
        return 0.0;
    }
    let (first, second) = (2.0 * width_after + width_before, width_after + 2.0 * width_before);
    (first + second) / (first / before + second / after)
}

/// The cubic through two values with these speeds.
fn hermite([a, b]: [f64; 2], [start, end]: [f64; 2], width: f64, s: f64) -> f64 {
    let rest = 1.0 - s;
    let (blend, back) = (s * s * (3.0 - 2.0 * s), rest * rest * s * width);
    a + (b - a) * blend + back * start - s * s * rest * width * end
}

/// A turn about an axis of length 1. About one axis it goes through all angles, also beyond a whole turn; between different axes it takes the
/// shortest way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Turn {
    pub axis: DVec3,
    pub degrees: f64,
}

impl Turn {
    /// The rotation that the four numbers stand for.
    pub fn rotation(self) -> DQuat {
        DQuat::from_axis_angle(self.axis, self.degrees.to_radians())
    }

    /// A rotation as a turn of at most 180 degrees.
    pub fn of(rotation: DQuat) -> Self {
        let shorter = if rotation.w < 0.0 { -rotation } else { rotation };
        let (axis, angle) = shorter.to_axis_angle();
        Self { axis, degrees: angle.to_degrees() }
    }

    /// The axis that two turns have in common; no turn at all has any.
    fn common_axis(self, other: Self) -> Option<DVec3> {
        match (self.degrees == 0.0, other.degrees == 0.0) {
            (true, _) => Some(other.axis),
            (_, true) => Some(self.axis),
            _ => (self.axis == other.axis).then_some(self.axis),
        }
    }

    /// The turn that leads from this one to the other: an axis, and an angle in degrees that is not negative.
    fn way_to(self, other: Self) -> (DVec3, f64) {
        if let Some(axis) = self.common_axis(other) {
            let change = other.degrees - self.degrees;
            return (axis * change.signum(), change.abs());
        }
        let way = Self::of(other.rotation() * self.rotation().inverse());
        (way.axis, way.degrees)
    }
}

impl Quantity for Turn {
    fn between(a: Self, b: Self, share: f64) -> Self {
        match a.common_axis(b) {
            Some(axis) => Self { axis, degrees: f64::between(a.degrees, b.degrees, share) },
            None => Self::of(a.rotation().slerp(b.rotation(), share)),
        }
    }

    fn smoothly_between(before: Option<Key<Self>>, a: Key<Self>, b: Key<Self>, after: Option<Key<Self>>, share: f64) -> Self {
        let (axis, angle) = a.value.way_to(b.value);
        if angle == 0.0 {
            return Self::between(a.value, b.value, share);
        }
        // The angle along the way is a quantity whose speed at a key counts as far as the next stretch turns the same way.
        let width = b.frame - a.frame;
        let along = |(other, angle): (DVec3, f64), width: f64| axis.dot(other) * angle / width;
        let start = before.map_or(0.0, |before| {
            let width_before = a.frame - before.frame;
            speed([along(before.value.way_to(a.value), width_before), angle / width], [width_before, width])
        });
        let end = after.map_or(0.0, |after| {
            let width_after = after.frame - b.frame;
            speed([angle / width, along(b.value.way_to(after.value), width_after)], [width, width_after])
        });
        Self::between(a.value, b.value, hermite([0.0, angle], [start, end], width, share) / angle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(interpolation: Interpolation, keys: &[(f64, f64)]) -> Curve<f64> {
        Curve { keys: keys.iter().map(|&(frame, value)| Key { frame, value }).collect(), interpolation }
    }

    #[test]
    fn keys_are_met_and_ends_are_held() {
        let keys = [(0.0, 1.0), (10.0, 3.0), (12.0, 3.0), (20.0, -1.0)];
        for interpolation in [Interpolation::Linear, Interpolation::Smooth, Interpolation::Step] {
            let curve = curve(interpolation, &keys);
            for (frame, value) in keys {
                assert_eq!(curve.at(frame), Some(value));
            }
            assert_eq!((curve.at(-5.0), curve.at(99.0), curve.at(11.0)), (Some(1.0), Some(-1.0), Some(3.0)));
        }
        assert_eq!(curve(Interpolation::Linear, &keys).at(5.0), Some(2.0));
        assert_eq!(curve(Interpolation::Step, &keys).at(9.9), Some(1.0));
        assert_eq!(curve(Interpolation::Linear, &[]).at(1.0), None);
    }

    /// Two keys make the smooth step; the speed does not jump at an inner key, as it does with straight lines.
    #[test]
    fn smooth_curves_have_no_corners_and_no_overshoot() {
        let two = curve(Interpolation::Smooth, &[(0.0, 0.0), (8.0, 1.0)]);
        for step in 0..=8 {
            let s = f64::from(step) / 8.0;
            let found = two.at(f64::from(step)).expect("it has keys");
            assert!((found - s * s * (3.0 - 2.0 * s)).abs() < 1e-15);
        }
        let keys = [(0.0, 0.0), (4.0, 1.0), (6.0, 5.0), (9.0, 5.0), (14.0, 2.0)];
        let corner = |curve: &Curve<f64>, frame: f64| {
            let h = 1e-6;
            let value = |frame: f64| curve.at(frame).expect("it has keys");
            ((value(frame + h) - 2.0 * value(frame) + value(frame - h)) / h).abs()
        };
        let (smooth, lines) = (curve(Interpolation::Smooth, &keys), curve(Interpolation::Linear, &keys));
        for (frame, _) in &keys[1..4] {
            assert!(corner(&smooth, *frame) < 1e-4, "{frame}");
            assert!(corner(&lines, *frame) > 0.1, "{frame}");
        }
        for step in 0..1400 {
            let frame = f64::from(step) / 100.0;
            let value = smooth.at(frame).expect("it has keys");
            let place = keys.iter().rposition(|key| key.0 <= frame).expect("there is a key before");
            let (a, b) = (keys[place].1, keys[place + 1].1);
            assert!(value >= a.min(b) - 1e-12 && value <= a.max(b) + 1e-12, "{frame} {value}");
        }
    }

    fn turns(interpolation: Interpolation, keys: &[(f64, DVec3, f64)]) -> Curve<Turn> {
        let key = |&(frame, axis, degrees): &(f64, DVec3, f64)| Key { frame, value: Turn { axis, degrees } };
        Curve { keys: keys.iter().map(key).collect(), interpolation }
    }

    #[test]
    fn turns_about_one_axis_go_through_all_angles_and_others_the_shortest_way() {
        let whole = turns(Interpolation::Linear, &[(0.0, DVec3::X, 0.0), (4.0, DVec3::Y, 720.0)]);
        let quarter = whole.at(0.5).expect("it has keys");
        assert_eq!((quarter.axis, quarter.degrees), (DVec3::Y, 90.0));
        let turning = turns(Interpolation::Linear, &[(0.0, DVec3::X, 90.0), (2.0, DVec3::Y, 90.0)]);
        let (a, b) = (turning.at(0.0).expect("a key").rotation(), turning.at(2.0).expect("a key").rotation());
        let middle = turning.at(1.0).expect("it has keys").rotation();
        assert!((middle.angle_between(a) - middle.angle_between(b)).abs() < 1e-12);
        assert!((middle.angle_between(a) - 0.5 * a.angle_between(b)).abs() < 1e-12);
    }

    #[test]
    fn smooth_turns_have_no_corners() {
        let keys = [(0.0, DVec3::Y, 0.0), (5.0, DVec3::Y, 90.0), (15.0, DVec3::Y, 360.0), (20.0, DVec3::Y, 300.0)];
        let (smooth, lines) = (turns(Interpolation::Smooth, &keys), turns(Interpolation::Linear, &keys));
        let corner = |curve: &Curve<Turn>, frame: f64| {
            let h = 1e-5;
            let degrees = |frame: f64| curve.at(frame).expect("it has keys").degrees;
            ((degrees(frame + h) - 2.0 * degrees(frame) + degrees(frame - h)) / h).abs()
        };
        for frame in [5.0, 15.0] {
            assert!(corner(&smooth, frame) < 1e-2 && corner(&lines, frame) > 1.0, "{frame}");
        }
    }
}
