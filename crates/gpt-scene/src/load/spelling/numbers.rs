//! Numbers as programs spell them.

use std::borrow::Cow;
use std::str::FromStr;

/// A number, and whether it was spelled as few programs do.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number<F> {
    pub value: F,
    pub is_odd: bool,
}

/// The number that a word says, where it is finite. Understood beside decimal numbers: `1,5` of languages with decimal commas, `1.5f` of C,
/// `1.5D3` of Fortran, `0x1f`, a minus sign of typography, and commas or semicolons behind. All spellings of infinity and of what is no number
/// (`inf`, `1.#IND`, `1e400`) give none.
pub fn number<F: FromStr + Copy + Into<f64> + FromHex>(word: &str) -> Option<Number<F>> {
    if let Ok(value) = word.parse::<F>() {
        let finite: f64 = value.into();
        return finite.is_finite().then_some(Number { value, is_odd: false });
    }
    let odd: Cow<'_, str> = word.replace(['−', '–'], "-").into();
    let odd = odd.trim_end_matches([',', ';']);
    if let Some(hex) = hexadecimal(odd) {
        return Some(Number { value: F::from_hex(hex), is_odd: true });
    }
    let mut plain = odd.to_owned();
    // A comma that is no decimal point separates, and whoever splits into words has to know.
    if plain.matches(',').count() == 1 && !plain.contains('.') {
        plain = plain.replace(',', ".");
    }
    // A suffix of a type, but not the last letter of `inf`.
    if plain.len() > 1
        && plain.ends_with(['f', 'F', 'l', 'L', 'd', 'D'])
        && plain[..plain.len() - 1].ends_with(|end: char| end.is_ascii_digit() || end == '.')
    {
        plain.pop();
    }
    if plain.contains(['d', 'D']) && plain.starts_with(|start: char| start.is_ascii_digit() || "+-.".contains(start)) {
        plain = plain.replace(['d', 'D'], "e");
    }
    let value = plain.parse::<F>().ok()?;
    let finite: f64 = value.into();
    (finite.is_finite() && plain.contains(|digit: char| digit.is_ascii_digit())).then_some(Number { value, is_odd: true })
}

/// Numbers that hexadecimal integers become.
pub trait FromHex {
    fn from_hex(value: f64) -> Self;
}

impl FromHex for f32 {
    fn from_hex(value: f64) -> Self {
        value as Self
    }
}

impl FromHex for f64 {
    fn from_hex(value: f64) -> Self {
        value
    }
}

fn hexadecimal(word: &str) -> Option<f64> {
    let (sign, digits) = match word.strip_prefix('-') {
        Some(rest) => (-1.0, rest),
        None => (1.0, word.strip_prefix('+').unwrap_or(word)),
    };
    let digits = digits.strip_prefix("0x").or(digits.strip_prefix("0X"))?;
    Some(sign * u32::from_str_radix(digits, 16).ok()? as f64)
}

/// An integer, also where it is written as a number with nothing behind the point (`3.0`).
pub fn integer(word: &str) -> Option<Number<f64>> {
    if let Ok(value) = word.parse::<i64>() {
        return Some(Number { value: value as f64, is_odd: false });
    }
    let number = number::<f64>(word)?;
    // All integers up to this are doubles.
    (number.value.fract() == 0.0 && number.value.abs() <= 9e15).then_some(Number { is_odd: true, ..number })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_of_many_programs_are_understood() {
        for (word, expected) in [("+.5", 0.5), ("5.", 5.0), ("-1e3", -1000.0), (".5E-1", 0.05), ("007", 7.0)] {
            assert_eq!(number::<f64>(word), Some(Number { value: expected, is_odd: false }), "{word}");
        }
        let odd = [
            ("1,5", 1.5),
            ("-0,25", -0.25),
            ("1.0f", 1.0),
            ("1.F", 1.0),
            ("1D3", 1000.0),
            ("1.5d-2", 0.015),
            ("0x1F", 31.0),
            ("−2", -2.0),
            ("2,", 2.0),
            ("2.5;", 2.5),
            ("3L", 3.0),
        ];
        for (word, expected) in odd {
            assert_eq!(number::<f64>(word), Some(Number { value: expected, is_odd: true }), "{word}");
            assert_eq!(number::<f32>(word).map(|number| number.value), Some(expected as f32), "{word}");
        }
    }

    #[test]
    fn what_is_no_finite_number_is_none() {
        let words = [
            "nan",
            "-nan",
            "NaN",
            "nan(ind)",
            "-nan(ind)",
            "inf",
            "-Infinity",
            "1.#IND",
            "-1.#QNAN",
            "1.#INF",
            "1e400",
            "x",
            "",
            "-",
            ".",
            "f",
            "d",
            "1,2,3",
            "1e",
            "#",
            "0x",
            "1.5.2",
            "e5",
        ];
        for word in words {
            assert_eq!(number::<f64>(word), None, "{word}");
            assert_eq!(number::<f32>(word), None, "{word}");
        }
        assert_eq!(number::<f32>("1e39"), None);
    }

    #[test]
    fn integers_may_have_a_point() {
        assert_eq!(integer("-3"), Some(Number { value: -3.0, is_odd: false }));
        assert_eq!(integer("3.0"), Some(Number { value: 3.0, is_odd: true }));
        assert_eq!(integer("0x10"), Some(Number { value: 16.0, is_odd: true }));
        for word in ["3.5", "x", "1e300", ""] {
            assert_eq!(integer(word), None, "{word}");
        }
    }
}
