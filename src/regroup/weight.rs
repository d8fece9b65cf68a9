//! The weight of a light group, as people write it: `key=2`, `key=#ffddaa`, `key=2,#ffddaa`.

use std::str::FromStr;

use crate::math::srgb_to_linear_f64;

/// By what the light of a group is multiplied: red, green and blue, linear.
#[derive(Debug, Clone, PartialEq)]
pub struct GroupWeight {
    pub group: String,
    pub weight: [f64; 3],
}

/// The largest factor: a brighter picture would leave the range of single precision.
const LARGEST_FACTOR: f64 = 1e18;

impl FromStr for GroupWeight {
    type Err = String;

    /// Reads the name of a group with a factor, an sRGB colour, or both. A colour multiplies by what its components are in linear light, so
    /// `#ffffff` changes nothing and `#808080` takes four fifths.
    fn from_str(text: &str) -> Result<Self, String> {
        let Some((group, numbers)) = text.split_once('=') else {
            return Err("expected NAME=FACTOR, NAME=#RRGGBB or NAME=FACTOR,#RRGGBB".to_owned());
        };
        let (mut factor, mut colour) = (None, None);
        for part in numbers.split(',') {
            let is_second = match part.strip_prefix('#') {
                Some(digits) => colour.replace(linear_colour(digits)?).is_some(),
                None => factor.replace(read_factor(part)?).is_some(),
            };
            if is_second {
                return Err("a group has one factor and one colour at most".to_owned());
            }
        }
        let factor = factor.unwrap_or(1.0);
        Ok(Self { group: group.to_owned(), weight: colour.unwrap_or([1.0; 3]).map(|component| factor * component) })
    }
}

fn read_factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor: &f64| (0.0..=LARGEST_FACTOR).contains(factor));
    factor.ok_or_else(|| format!("{text:?} is no factor: expected a number from 0 to {LARGEST_FACTOR:e}, or a colour as #RRGGBB"))
}

/// Six hexadecimal digits along the sRGB curve, in linear light.
fn linear_colour(digits: &str) -> Result<[f64; 3], String> {
    let error = || format!("#{digits} is no colour: expected # and six hexadecimal digits, as #ffddaa");
    if digits.len() != 6 || !digits.bytes().all(|digit| digit.is_ascii_hexdigit()) {
        return Err(error());
    }
    let code = u32::from_str_radix(digits, 16).map_err(|_| error())?;
    Ok([16, 8, 0].map(|shift| srgb_to_linear_f64(f64::from((code >> shift) & 255) / 255.0)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weight(text: &str) -> [f64; 3] {
        text.parse::<GroupWeight>().unwrap_or_else(|error| panic!("{text}: {error}")).weight
    }

    #[test]
    fn factors_and_colours_multiply() {
        assert_eq!(weight("key=2"), [2.0; 3]);
        assert_eq!(weight("key=#ffffff"), [1.0; 3]);
        assert_eq!(weight("key=0.5,#ff00FF"), [0.5, 0.0, 0.5]);
        assert_eq!(weight("key=#ff00ff,0.5"), weight("key=0.5,#ff00ff"));
        // Half of the code is a fifth of the light.
        assert!((weight("key=#808080")[0] - 0.2158605).abs() < 1e-6);
        assert_eq!("key=0".parse::<GroupWeight>().unwrap().group, "key");
    }

    #[test]
    fn what_is_no_weight_is_refused() {
        for bad in [
            "key",
            "key=",
            "key=-1",
            "key=nan",
            "key=inf",
            "key=1e19",
            "key=#fff",
            "key=#gggggg",
            "key=1,2",
            "key=#ffffff,#ffffff",
            "key=#+fffff",
        ] {
            assert!(bad.parse::<GroupWeight>().is_err(), "{bad}");
        }
    }
}
