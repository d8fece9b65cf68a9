//! The flight of a path through a medium: up to the end of its ray, or to a place where the medium scatters it.
//!
//! The place is drawn in two ways. By distance, it is as dense as light is lost there, which suits light that comes from everywhere: a channel is
//! chosen by the path's throughput, and the channels share the place by multiple importance sampling, so that no channel counts much more than the
//! path carries. By angle (equi-angular sampling; Kulla and Fajardo 2012), it is as dense as light from one point arrives. Where both are possible one
//! of them draws the place, and it counts over the density of both together. How often light is scattered at all is the same for both.
//! `shaders/shading/medium/free_flight.wgsl` is the same in f32.

use glam::DVec3;

use super::intersect::Ray;
use super::medium::left;
use crate::scene::media::{FARTHEST, LEAST_ASIDE};
use crate::scene::{DistanceSampling, Filling};
use crate::spectrum::Spectrum;

/// The end of a flight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Flight {
    /// The distance at which the medium scatters; None: the path comes to the ray's end.
    pub scattered_at: Option<f64>,
    /// Transmittance, and scattering per unit length where there is some, over the density of the place or the probability of the ray's end.
    pub weight: Spectrum,
}

/// Equi-angular sampling of a ray's first `length` about a point: all angles under which the point sees the ray are alike.
#[derive(Debug, Clone, Copy)]
struct Angles {
    /// Distance along the ray of its place next to the point, and the distance of that place from the point.
    next: f64,
    aside: f64,
    /// The angle under which the point sees the ray.
    all: f64,
}

impl Angles {
    /// None where the point is on the ray.
    fn new(ray: &Ray, length: f64, pivot: DVec3) -> Option<Self> {
        let to_pivot = pivot - ray.origin;
        let next = to_pivot.dot(ray.direction);
        let aside = (to_pivot - ray.direction * next).length();
        if aside <= LEAST_ASIDE * to_pivot.length() {
            return None;
        }
        let all = (length * aside).atan2(aside * aside - next * (length - next));
        Some(Self { next, aside, all })
    }

    /// The distance at a share of the angle.
    fn sample(&self, u: f64) -> f64 {
        let (sine, cosine) = (u * self.all).sin_cos();
        sine * (self.aside * self.aside + self.next * self.next) / (self.aside * cosine + self.next * sine)
    }

    /// Density of a distance, per unit length.
    fn pdf(&self, distance: f64) -> f64 {
        let beyond = distance - self.next;
        self.aside / (self.all * (self.aside * self.aside + beyond * beyond))
    }
}

/// Flies along the first `length` of a ray through a medium that scatters, with a path of this throughput; about `pivot`, the place of a light, which is
/// asked for where the path is scattered. `u_event` says whether it is and how the place is drawn, `u_distance` where.
pub fn fly(
    filling: &Filling,
    throughput: Spectrum,
    (ray, length): (&Ray, f64),
    pivot: impl FnOnce() -> Option<DVec3>,
    sampling: DistanceSampling,
    [u_event, u_distance]: [f64; 2],
) -> Flight {
    let length = length.min(FARTHEST);
    let extinction = filling.extinction;
    if throughput.is_black() {
        return Flight { scattered_at: None, weight: Spectrum::WHITE };
    }
    let chances = (throughput / throughput.sum()).to_rgb();
    let of_channels = |function: &dyn Fn(f64) -> f64| -> f64 {
        chances.iter().zip(extinction.to_rgb()).map(|(chance, extinction)| chance * function(extinction)).sum()
    };
    let lost = |extinction: f64| -(-extinction * length).exp_m1();
    let scatters = of_channels(&lost);
    if u_event >= scatters {
        let passes = of_channels(&|extinction| (-extinction * length).exp());
        return Flight { scattered_at: None, weight: left(extinction, length) / passes };
    }
    let angles = pivot().and_then(|pivot| Angles::new(ray, length, pivot));
    let share = match (&angles, sampling) {
        (None, _) | (_, DistanceSampling::Distance) => 0.0,
        (Some(_), DistanceSampling::Equiangular) => 1.0,
        // Light that is lost before the place next to the point lights nothing there.
        (Some(angles), DistanceSampling::Mis) => {
            let next = angles.next.clamp(0.0, length);
            0.5 * of_channels(&|extinction| (-extinction * next).exp())
        }
    };
    let choice = u_event / scatters;
    let distance = match &angles {
        Some(angles) if choice < share => angles.sample(u_distance),
        _ => {
            // Each channel by how much is lost of it
            let choice = (choice - share) / (1.0 - share) * scatters;
            let [red, green, _] = std::array::from_fn(|channel| chances[channel] * lost(extinction.to_rgb()[channel]));
            let extinction = match choice {
                choice if choice < red => extinction.r(),
                choice if choice < red + green => extinction.g(),
                _ => extinction.b(),
            };
            -(-u_distance * lost(extinction)).ln_1p() / extinction
        }
    };
    let distance = distance.clamp(0.0, length);
    let by_distance = of_channels(&|extinction| extinction * (-extinction * distance).exp());
    let by_angle = angles.map_or(0.0, |angles| scatters * angles.pdf(distance));
    let pdf = share * by_angle + (1.0 - share) * by_distance;
    if pdf <= 0.0 || distance.is_nan() {
        return Flight { scattered_at: Some(0.0), weight: Spectrum::BLACK };
    }
    Flight { scattered_at: Some(distance), weight: filling.scattering * left(extinction, distance) / pdf }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Phase;

    fn filling(extinction: Spectrum, albedo: Spectrum) -> Filling {
        Filling {
            extinction,
            scattering: extinction * albedo,
            emission: Spectrum::BLACK,
            phase: Phase::isotropic(),
            grids: None,
            is_light_sampled: true,
            is_dark: false,
            light_group: 0,
            receiver: 0,
        }
    }

    /// By a fine grid of both random numbers, the mean of `value` over flights, which is the integral of transmittance · scattering · value along the
    /// ray and of what comes to its end.
    fn mean(filling: &Filling, pivot: Option<DVec3>, sampling: DistanceSampling, value: impl Fn(Option<f64>) -> f64) -> Spectrum {
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };
        let throughput = Spectrum::new(0.5, 1.0, 0.2);
        let (mut sum, side) = (Spectrum::BLACK, 1500);
        for row in 0..side {
            for column in 0..side {
                let numbers = [row, column].map(|index| (f64::from(index) + 0.5) / f64::from(side));
                let flight = fly(filling, throughput, (&ray, 3.0), || pivot, sampling, numbers);
                sum += flight.weight * value(flight.scattered_at);
            }
        }
        sum / f64::from(side * side)
    }

    #[test]
    fn every_way_reaches_the_integral() {
        let filling = filling(Spectrum::new(0.3, 1.0, 0.0), Spectrum::new(0.9, 0.5, 0.5));
        let pivot = Some(DVec3::new(1.0, 0.5, 0.0));
        let value = |at: Option<f64>| at.map_or(0.0, |at| 1.0 / (0.25 + (at - 1.0) * (at - 1.0)));
        // Simpson's rule
        let count = 3000;
        let at = |step: i32| 3.0 * f64::from(step) / f64::from(count);
        let weight = |step: i32| if step == 0 || step == count { 1.0 } else { f64::from(2 + 2 * (step % 2)) };
        let exact: Spectrum = (0..=count)
            .map(|step| filling.scattering * left(filling.extinction, at(step)) * value(Some(at(step))) * weight(step))
            .sum();
        let exact = exact * (3.0 / f64::from(count) / 3.0);
        for sampling in [DistanceSampling::Distance, DistanceSampling::Equiangular, DistanceSampling::Mis] {
            let found = mean(&filling, pivot, sampling, value);
            assert!(found.distance(exact) < 2e-3 * exact.max_component(), "{sampling:?}: {found} and not {exact}");
            let passed = mean(&filling, pivot, sampling, |at| f64::from(u8::from(at.is_none())));
            let exact = left(filling.extinction, 3.0);
            assert!(passed.distance(exact) < 2e-3, "{sampling:?}: {passed} and not {exact}");
        }
    }

    /// The weight stays near what the path carries, however the channels differ.
    #[test]
    fn no_channel_counts_much_more_than_others() {
        let filling = filling(Spectrum::new(1e-3, 1.0, 1e3), Spectrum::WHITE);
        let ray = Ray { origin: DVec3::ZERO, direction: DVec3::X };
        for numbers in [[0.1, 0.3], [0.5, 0.999], [0.9, 0.01], [0.999_999, 0.5]] {
            let flight = fly(&filling, Spectrum::WHITE, (&ray, 1e6), || None, DistanceSampling::Distance, numbers);
            assert!(flight.weight.max_component() <= 3.0 + 1e-9, "{flight:?}");
        }
    }
}
