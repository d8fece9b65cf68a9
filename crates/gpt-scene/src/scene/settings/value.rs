//! Values of settings: what people may write, what a setting's field holds, and how one becomes the other.

use std::fmt;

use serde::{Serialize, Serializer};

use crate::choice::{Choice, Named};

/// Largest number of samples and of edges: picture headers hold signed 32-bit numbers.
pub const MOST_SAMPLES: u32 = i32::MAX as u32;

/// A setting's value as people write it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    Number(u32),
    Real(f64),
    Name(&'static str),
}

/// The form in which people write it, without quotes.
impl fmt::Display for Value {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(number) => write!(out, "{number}"),
            Self::Real(number) => write!(out, "{number}"),
            Self::Name(name) => out.write_str(name),
        }
    }
}

impl Serialize for Value {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => serializer.serialize_u32(*number),
            Self::Real(number) => serializer.serialize_f64(*number),
            Self::Name(name) => serializer.serialize_str(name),
        }
    }
}

/// Which values a setting may have.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Values {
    /// Whole numbers from the first to the second.
    Whole(u32, u32),
    /// Whole numbers from the first to the second, and a name that stands for none of them.
    WholeOr(u32, u32, Named),
    /// Numbers from the first to the second.
    Real(f64, f64),
    Names(&'static [Named]),
}

impl Values {
    /// The number as a value.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn number(self, number: i64) -> Result<Value, String> {
        match (self, u32::try_from(number)) {
            (Self::Whole(least, most) | Self::WholeOr(least, most, _), Ok(number)) if (least..=most).contains(&number) => {
                Ok(Value::Number(number))
            }
            (Self::Real(..), _) => self.real(number as f64),
            (Self::Whole(_, most), _) if most >= MOST_SAMPLES && number > i64::from(most) => {
                Err(format!("a whole number of at most {most}"))
            }
            (Self::WholeOr(_, most, name), _) if most >= MOST_SAMPLES && number > i64::from(most) => {
                Err(format!("a whole number of at most {most}, or {}", name.name))
            }
            _ => Err(self.to_string()),
        }
    }

    /// The number, which need not be whole, as a value.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn real(self, number: f64) -> Result<Value, String> {
        match self {
            Self::Real(least, most) if (least..=most).contains(&number) => Ok(Value::Real(number)),
            _ => Err(self.to_string()),
        }
    }

    /// The value of this name.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn name(self, name: &str) -> Result<Value, String> {
        match self {
            Self::Names(names) => names.iter().find(|known| known.name == name).map(|known| Value::Name(known.name)),
            Self::WholeOr(.., known) => (known.name == name).then_some(Value::Name(known.name)),
            Self::Whole(..) | Self::Real(..) => None,
        }
        .ok_or_else(|| self.to_string())
    }

    /// The value that is written so, a number or a name.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn text(self, text: &str) -> Result<Value, String> {
        let wrong = || self.to_string();
        match self {
            Self::Names(_) => self.name(text),
            Self::Real(..) => text.parse().map_err(|_| wrong()).and_then(|number| self.real(number)),
            Self::Whole(..) => text.parse().map_err(|_| wrong()).and_then(|number| self.number(number)),
            Self::WholeOr(..) => text.parse().map_or_else(|_| self.name(text), |number| self.number(number)),
        }
    }

    /// Checks that the value is one of these.
    ///
    /// # Errors
    /// The values that are allowed, to follow "expected".
    pub fn check(self, value: Value) -> Result<(), String> {
        match value {
            Value::Number(number) => self.number(number.into()),
            Value::Real(number) => self.real(number),
            Value::Name(name) => self.name(name),
        }
        .map(|_| ())
    }
}

/// The expected values, in words. The largest number is left out where nobody comes near it.
impl fmt::Display for Values {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Whole(least, most) if *most >= MOST_SAMPLES => write!(out, "a whole number of at least {least}"),
            Self::Whole(least, most) => write!(out, "a whole number from {least} to {most}"),
            Self::WholeOr(least, most, name) if *most >= MOST_SAMPLES => {
                write!(out, "a whole number of at least {least}, or {}", name.name)
            }
            Self::WholeOr(least, most, name) => write!(out, "a whole number from {least} to {most}, or {}", name.name),
            Self::Real(least, most) if *most >= 1e9 => write!(out, "a number of at least {least}"),
            Self::Real(least, most) => write!(out, "a number from {least} to {most}"),
            Self::Names(names) => {
                let names: Vec<&str> = names.iter().map(|name| name.name).collect();
                write!(out, "one of {}", names.join(", "))
            }
        }
    }
}

/// A setting that no render can have.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{setting}: {message}")]
pub struct BadSetting {
    /// The scene file's key.
    pub setting: &'static str,
    pub message: String,
    /// Advice, where the message has none.
    pub help: Option<String>,
}

/// A type of a setting's field: it becomes a [`Value`] and is made from one.
pub trait Field: Copy {
    fn to_value(self) -> Value;
    /// None for a value of the other kind, and for a name that does not exist.
    fn from_value(value: Value) -> Option<Self>;
}

impl Field for u32 {
    fn to_value(self) -> Value {
        Value::Number(self)
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(number) => Some(number),
            Value::Real(_) | Value::Name(_) => None,
        }
    }
}

impl Field for f64 {
    fn to_value(self) -> Value {
        Value::Real(self)
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Real(number) => Some(number),
            Value::Number(_) | Value::Name(_) => None,
        }
    }
}

impl<T: Choice> Field for T {
    fn to_value(self) -> Value {
        Value::Name(self.name())
    }

    fn from_value(value: Value) -> Option<Self> {
        match value {
            Value::Number(_) | Value::Real(_) => None,
            Value::Name(name) => T::from_name(name),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::number_or_auto::{NumberOrAuto, auto};
    use super::*;
    use crate::scene::SamplerKind;

    #[test]
    fn values_out_of_range_are_refused_with_what_would_be_right() {
        let few = Values::Whole(1, 16);
        assert_eq!(few.number(16), Ok(Value::Number(16)));
        for bad in [0, 17, -1, i64::MIN, i64::MAX] {
            assert_eq!(few.number(bad), Err("a whole number from 1 to 16".to_owned()), "{bad}");
        }
        let many = Values::Whole(1, MOST_SAMPLES);
        assert_eq!(many.number(0), Err("a whole number of at least 1".to_owned()));
        assert_eq!(many.number(1 << 31), Err("a whole number of at most 2147483647".to_owned()));
        assert_eq!(few.name("three"), Err("a whole number from 1 to 16".to_owned()));
    }

    #[test]
    fn numbers_need_not_be_whole_where_they_may_be_any() {
        let some = Values::Real(0.0, 8.0);
        assert_eq!((some.real(0.5), some.number(3)), (Ok(Value::Real(0.5)), Ok(Value::Real(3.0))));
        for bad in [-0.5, 8.5, f64::NAN, f64::INFINITY] {
            assert_eq!(some.real(bad), Err("a number from 0 to 8".to_owned()), "{bad}");
        }
        assert!(some.name("three").is_err() && Values::Whole(1, 16).real(2.0).is_err());
    }

    #[test]
    fn a_name_may_stand_for_no_number() {
        let some = Values::WholeOr(1, 16, auto("As many as are best."));
        assert_eq!((some.number(3), some.name("auto")), (Ok(Value::Number(3)), Ok(Value::Name("auto"))));
        assert_eq!((some.text("3"), some.text("auto")), (Ok(Value::Number(3)), Ok(Value::Name("auto"))));
        for bad in ["0", "17", "-1", "2.5", "Auto", "", "many"] {
            assert_eq!(some.text(bad), Err("a whole number from 1 to 16, or auto".to_owned()), "{bad}");
        }
        for value in [NumberOrAuto::Auto, NumberOrAuto::Number(7)] {
            assert_eq!(NumberOrAuto::from_value(value.to_value()), Some(value));
        }
    }

    #[test]
    fn names_are_chosen_from_a_list() {
        let samplers = Values::Names(SamplerKind::NAMES);
        assert_eq!(samplers.name("halton"), Ok(Value::Name("halton")));
        let list = "one of independent, stratified, quadrant, halton, sobol, shared_strata, hammersley, lcg";
        assert_eq!(samplers.name("Halton"), Err(list.to_owned()));
        assert_eq!(samplers.number(1), Err(list.to_owned()));
        for kind in SamplerKind::ALL {
            assert_eq!(SamplerKind::from_value(kind.to_value()), Some(kind));
        }
        assert_eq!((u32::from_value(Value::Name("halton")), SamplerKind::from_value(Value::Number(0))), (None, None));
    }
}
