//! Vectors, colours and directions as scene files have them. Numbers come back bit for bit.

use glam::{DVec3, Vec2, Vec3};

use crate::load::toml_text::{line, list, number};
use crate::spectrum::Spectrum;

/// Ways that are tried to write a direction.
const MOST_TRIALS: u32 = 4096;

/// A number that is read in double precision and then rounded.
pub fn number_f32(value: f32) -> String {
    let short = format!("{value:?}");
    // Rounding twice may differ from rounding once.
    let comes_back = short.parse::<f64>().is_ok_and(|read| (read as f32).to_bits() == value.to_bits());
    if value.fract() == 0.0 || !comes_back { number(f64::from(value)) } else { short }
}

pub fn numbers(values: &[f64]) -> String {
    list(values.iter().map(|&value| number(value)))
}

pub fn vector(value: DVec3) -> String {
    numbers(&value.to_array())
}

pub fn vector_f32(value: Vec3) -> String {
    list(value.to_array().map(number_f32))
}

pub fn pair_f32(value: Vec2) -> String {
    list(value.to_array().map(number_f32))
}

/// One number where all channels are equal.
pub fn colour(value: Spectrum) -> String {
    if value.min_component() == value.max_component() { number(value.r()) } else { numbers(&value.to_rgb()) }
}

/// A direction of length 1. The reader makes its length 1 once more, which may change last bits: a multiple is written that becomes exactly
/// this one, if one is found.
pub fn direction(value: DVec3) -> String {
    let multiples = (0..MOST_TRIALS).map(|trial| value * (1.0 + f64::from(trial) / f64::from(MOST_TRIALS)));
    let exact = multiples.into_iter().find(|multiple| multiple.try_normalize() == Some(value));
    vector(exact.unwrap_or(value))
}

/// `key = true` on a line, and nothing for false.
pub fn flag(key: &str, value: bool) -> String {
    if value { line(key, "true") } else { String::new() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_single_precision_are_short() {
        assert_eq!([0.1, 3.0, 1.0 / 3.0].map(number_f32), ["0.1", "3", "0.33333334"]);
    }

    #[test]
    fn directions_come_back() {
        let mut exact = 0;
        for index in 0..1000 {
            let angle = f64::from(index);
            let value = DVec3::new(angle.sin(), (1.7 * angle).cos(), 0.3).normalize();
            let read: toml::Table = toml::from_str(&line("x", &direction(value))).unwrap();
            let number = |part: &toml::Value| part.as_float().or(part.as_integer().map(|whole| whole as f64));
            let parts: Vec<f64> = read["x"].as_array().unwrap().iter().map(|part| number(part).unwrap()).collect();
            exact += usize::from(DVec3::from_slice(&parts).normalize() == value);
        }
        assert_eq!(exact, 1000);
    }
}
