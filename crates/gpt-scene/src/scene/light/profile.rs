//! Profiles of lamps: how much light goes in which direction, as photometers measure it.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use glam::DVec3;

use crate::math::Frame;
use crate::scene::check::{Check, is_amount};
use crate::spectrum::Spectrum;

/// Most angles of either kind in a table as it is written.
pub const MOST_ANGLES: usize = 4096;
/// Least difference of neighbouring angles, in degrees: in single precision they still differ.
const LEAST_STEP: f64 = 1e-3;
/// Largest candela: its square is still finite in single precision.
const LARGEST_CANDELA: f64 = 1e18;
/// Longest step of integrals over the vertical angle, in degrees.
const LONGEST_STEP: f64 = 1.0;
/// Shorter pieces of them are left out, in degrees.
const SHORTEST_PIECE: f64 = 1e-6;

/// The luminous intensity of a lamp by direction: type C photometry of IES LM-63. Between its angles it is interpolated bilinearly, and past the first
/// and the last vertical angle there is no light.
#[derive(Debug, Clone, PartialEq)]
pub struct LightProfile {
    /// Degrees from nadir, which is the direction that the lamp is aimed in; two or more, ascending.
    vertical: Vec<f64>,
    /// Degrees about nadir, ascending from 0 to 360, counter-clockwise for who looks along nadir; 0 alone where the light is the same all around.
    horizontal: Vec<f64>,
    /// Candela: for each horizontal angle those of all vertical angles.
    candela: Vec<f64>,
    /// For each vertical angle the mean over the horizontal ones.
    means: Vec<f64>,
}

/// A list of numbers that a profile is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ProfileList {
    Vertical,
    Horizontal,
    /// The index is `horizontal · vertical angles + vertical`.
    Candela,
}

/// A mistake in a profile: in which list, at which of its numbers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ProfileFault {
    pub list: ProfileList,
    pub index: usize,
    pub message: String,
}

/// A profile with its place on a light.
#[derive(Debug, Clone, PartialEq)]
pub struct AimedProfile {
    pub profile: Arc<LightProfile>,
    /// Direction of vertical angle 0, of length 1.
    pub nadir: DVec3,
    /// Horizontal angle 0 lies on this side; projected across `nadir`.
    pub front: DVec3,
}

impl LightProfile {
    /// A profile by a table that may use symmetry: its horizontal angles are 0 alone (the same all around), or go from 0 to 90 (four quarters alike),
    /// from 0 to 180 (two halves alike), from 90 to 270 (halves alike, as LM-63-1995 has it), or from 0 to 360.
    ///
    /// # Errors
    /// Angles that do not ascend or are out of range, or candela that are no light.
    pub fn new(vertical: Vec<f64>, horizontal: Vec<f64>, candela: Vec<f64>) -> Result<Self, ProfileFault> {
        let fault = |list, index, message: String| Err(ProfileFault { list, index, message });
        for (list, name, angles, least, most) in [
            (ProfileList::Vertical, "vertical", &vertical, 2, 180.0),
            (ProfileList::Horizontal, "horizontal", &horizontal, 1, 360.0),
        ] {
            if angles.len() < least || angles.len() > MOST_ANGLES {
                return fault(
                    list,
                    0,
                    format!("there are {} {name} angles, and {least} to {MOST_ANGLES} are possible", angles.len()),
                );
            }
            if let Some(index) = angles.iter().position(|angle| !(0.0..=most).contains(angle)) {
                return fault(list, index, format!("the {name} angle {} is not from 0 to {most} degrees", angles[index]));
            }
            if let Some(index) = angles.windows(2).position(|pair| pair[1] - pair[0] < LEAST_STEP) {
                let [before, here] = [angles[index], angles[index + 1]];
                return fault(list, index + 1, format!("the {name} angle {here} comes behind {before}, and angles ascend"));
            }
        }
        if candela.len() != vertical.len() * horizontal.len() {
            let [across, around] = [vertical.len(), horizontal.len()];
            let message = format!(
                "{across} vertical and {around} horizontal angles need {} candela, found {}",
                across * around,
                candela.len()
            );
            return fault(ProfileList::Candela, candela.len().saturating_sub(1), message);
        }
        if let Some(index) = candela.iter().position(|value| !(0.0..=LARGEST_CANDELA).contains(value)) {
            return fault(ProfileList::Candela, index, format!("{} candela are not from 0 to 1e18", candela[index]));
        }
        if candela.iter().all(|value| *value == 0.0) {
            return fault(ProfileList::Candela, 0, "all candela are 0, so the lamp gives no light".to_owned());
        }
        let planes: Vec<Plane> = horizontal.iter().copied().zip(candela.chunks(vertical.len()).map(<[f64]>::to_vec)).collect();
        match unfolded(planes) {
            Some(planes) => Ok(Self::of_planes(vertical, planes)),
            None => {
                let (first, last) = (horizontal[0], horizontal[horizontal.len() - 1]);
                let message = format!(
                    "the horizontal angles go from {first} to {last} degrees: possible are 0 alone, and from 0 to 90, 180 or 360, or from 90 to 270"
                );
                fault(ProfileList::Horizontal, horizontal.len() - 1, message)
            }
        }
    }

    fn of_planes(vertical: Vec<f64>, planes: Vec<Plane>) -> Self {
        let weights = weights_around(&planes);
        let mean = |row: usize| planes.iter().zip(&weights).map(|((_, candela), weight)| candela[row] * weight).sum();
        let means = (0..vertical.len()).map(mean).collect();
        let (horizontal, candela): (Vec<f64>, Vec<Vec<f64>>) = planes.into_iter().unzip();
        Self { vertical, horizontal, candela: candela.concat(), means }
    }

    /// Degrees from nadir.
    pub fn vertical(&self) -> &[f64] {
        &self.vertical
    }

    /// Degrees about nadir: from 0 to 360, or 0 alone.
    pub fn horizontal(&self) -> &[f64] {
        &self.horizontal
    }

    /// Candela: for each horizontal angle those of all vertical ones.
    pub fn candela(&self) -> &[f64] {
        &self.candela
    }

    /// The light differs around nadir.
    pub fn varies_around(&self) -> bool {
        self.horizontal.len() > 1
    }

    /// Candela at a vertical angle, averaged around nadir.
    pub fn mean_candela(&self, vertical_degrees: f64) -> f64 {
        interval(&self.vertical, vertical_degrees)
            .map_or(0.0, |(index, share)| self.means[index] + share * (self.means[index + 1] - self.means[index]))
    }

    /// Candela in a direction.
    pub fn candela_at(&self, vertical_degrees: f64, horizontal_degrees: f64) -> f64 {
        let Some((row, down)) = interval(&self.vertical, vertical_degrees) else { return 0.0 };
        let rows = self.vertical.len();
        let of_plane = |plane: usize| {
            let [above, below] = [row, row + 1].map(|row| self.candela[plane * rows + row]);
            above + down * (below - above)
        };
        match interval(&self.horizontal, horizontal_degrees.rem_euclid(360.0)) {
            Some((plane, across)) => of_plane(plane) + across * (of_plane(plane + 1) - of_plane(plane)),
            None => of_plane(0),
        }
    }

    /// The integral over all directions of candela times a factor that depends on the vertical angle, in degrees, and has kinks at `kinks` only: in
    /// lumen where the factor is 1. By Simpson's rule.
    pub fn integral(&self, factor: impl Fn(f64) -> f64, kinks: &[f64]) -> f64 {
        let [first, last] = [self.vertical[0], self.vertical[self.vertical.len() - 1]];
        let mut ends: Vec<f64> = self.vertical.iter().chain(kinks).copied().filter(|end| (first..=last).contains(end)).collect();
        ends.sort_by(f64::total_cmp);
        ends.dedup_by(|end, before| *end - *before < SHORTEST_PIECE);
        let value = |angle: f64| self.mean_candela(angle) * factor(angle) * angle.to_radians().sin();
        let of_piece = |pair: &[f64]| {
            let steps = ((pair[1] - pair[0]) / LONGEST_STEP).ceil().max(1.0);
            let step = (pair[1] - pair[0]) / steps;
            // Within the piece, so that the factor at its ends is that of its inside.
            let within = |place: f64| (pair[0] + place * step).clamp(pair[0] + 1e-9, pair[1] - 1e-9);
            let of_step = |at: f64| value(within(at)) + 4.0 * value(within(at + 0.5)) + value(within(at + 1.0));
            (0..steps as u32).map(|at| of_step(f64::from(at))).sum::<f64>() * step.to_radians() / 6.0
        };
        TAU * ends.windows(2).map(of_piece).sum::<f64>()
    }

    /// The vertical angles between which the light lies, in degrees.
    pub fn extent(&self) -> [f64; 2] {
        let last = self.vertical.len() - 1;
        let is_lit = |row: &usize| self.means[*row] > 0.0;
        let [low, high] = [(0..=last).find(is_lit), (0..=last).rev().find(is_lit)].map(Option::unwrap_or_default);
        [self.vertical[low.saturating_sub(1)], self.vertical[(high + 1).min(last)]]
    }
}

/// A horizontal angle, and candela by vertical angle.
type Plane = (f64, Vec<f64>);

/// The planes from 0 to 360 degrees, or one alone, of planes that stand for others by symmetry; None of those that leave some part open.
fn unfolded(mut planes: Vec<Plane>) -> Option<Vec<Plane>> {
    let last = planes.len() - 1;
    let mirrored = |planes: &[Plane], about: f64| {
        let image = |(angle, candela): &Plane| (2.0 * about - angle, candela.clone());
        planes.iter().rev().filter(|(angle, _)| *angle != about).map(image).collect::<Vec<_>>()
    };
    match [planes[0].0, planes[last].0] {
        [0.0, 0.0] => {}
        [0.0, 360.0] => {}
        [0.0, 90.0] => {
            planes.extend(mirrored(&planes, 90.0));
            planes.extend(mirrored(&planes, 180.0));
        }
        [0.0, 180.0] => planes.extend(mirrored(&planes, 180.0)),
        [90.0, 270.0] => {
            // To 450, and from there back to 0.
            planes.extend(mirrored(&planes, 270.0));
            let beyond = planes.iter().position(|(angle, _)| *angle >= 360.0)?;
            let share = (360.0 - planes[beyond - 1].0) / (planes[beyond].0 - planes[beyond - 1].0);
            let between = |(before, behind): (&f64, &f64)| before + share * (behind - before);
            let at_0: Vec<f64> = planes[beyond - 1].1.iter().zip(&planes[beyond].1).map(between).collect();
            let is_beyond = |(angle, _): &&Plane| *angle > 360.0 && *angle < 450.0;
            let back = |(angle, candela): &Plane| (angle - 360.0, candela.clone());
            let first: Vec<Plane> = planes.iter().filter(is_beyond).map(back).collect();
            planes.retain(|(angle, _)| *angle < 360.0);
            planes = [vec![(0.0, at_0.clone())], first, planes, vec![(360.0, at_0)]].concat();
        }
        _ => return None,
    }
    Some(planes)
}

/// The share of each plane in a mean around nadir of what is interpolated between them.
fn weights_around(planes: &[Plane]) -> Vec<f64> {
    if planes.len() == 1 {
        return vec![1.0];
    }
    let angle = |index: usize| planes[index.min(planes.len() - 1)].0;
    (0..planes.len()).map(|index| (angle(index + 1) - angle(index.saturating_sub(1))) / 720.0).collect()
}

/// The interval of ascending angles that an angle lies in, and how far it is within; None outside, and of one angle alone.
fn interval(angles: &[f64], angle: f64) -> Option<(usize, f64)> {
    let [first, last] = [angles[0], angles[angles.len() - 1]];
    if angles.len() == 1 || !(first..=last).contains(&angle) {
        return None;
    }
    let index = angles.partition_point(|other| *other <= angle).clamp(1, angles.len() - 1) - 1;
    Some((index, (angle - angles[index]) / (angles[index + 1] - angles[index])))
}

impl AimedProfile {
    /// Directions of length 1: of horizontal angle 0, of horizontal angle 90, and nadir.
    pub fn axes(&self) -> [DVec3; 3] {
        let across = self.front - self.nadir * self.front.dot(self.nadir);
        let zero = across.try_normalize().unwrap_or_else(|| Frame::around(self.nadir).tangent);
        [zero, zero.cross(self.nadir), self.nadir]
    }

    /// Candela in a direction of length 1.
    pub fn candela(&self, direction: DVec3) -> f64 {
        let [x, y, down] = self.axes().map(|axis| direction.dot(axis));
        self.profile.candela_at(x.hypot(y).atan2(down).to_degrees(), y.atan2(x).to_degrees())
    }

    /// The direction about which all of the light lies, and the angle from there at which it ends, in radians; None where it goes everywhere.
    pub fn cone(&self) -> Option<(DVec3, f64)> {
        let [low, high] = self.profile.extent();
        let (axis, end) = if high <= 180.0 - low { (self.nadir, high) } else { (-self.nadir, 180.0 - low) };
        (end < 180.0).then_some((axis, end.to_radians().min(PI)))
    }

    /// Checks its direction, and that the light is possible where so much of it goes for each candela.
    pub(super) fn check(&self, intensity: Spectrum) -> Check {
        if !self.front.is_finite() || self.front == DVec3::ZERO {
            return Err("the side of its profile's horizontal angle 0 must be a direction".to_owned());
        }
        let brightest = intensity * self.profile.candela.iter().copied().fold(0.0, f64::max);
        if is_amount(brightest) { Ok(()) } else { Err("its light times the candela of its profile is too large".to_owned()) }
    }
}

#[cfg(test)]
mod tests;
