//! The values of a scene file. A type says which values are possible, so that reading a file checks every range at the place where
//! the value is written, and the JSON Schema carries the same ranges.

use std::borrow::Cow;
use std::fmt;
use std::marker::PhantomData;
use std::ops::Deref;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, IgnoredAny, SeqAccess, Visitor};

use super::reader::located;
use super::reference::NamesTextures;
use crate::load::place::Place;
use crate::scene::settings::{LARGEST_FILTER_RADIUS, SMALLEST_FILTER_RADIUS};

/// Largest magnitude of any number: its square is still finite in single precision, which is what the device computes in.
pub const LARGEST: f64 = 1e18;

/// Which numbers are possible.
pub trait Rule: 'static {
    /// In words, to follow "expected".
    const WORDS: &'static str;
    const NAME: &'static str;
    const MINIMUM: f64;
    const MAXIMUM: f64 = LARGEST;
    /// The minimum itself is not possible.
    const ABOVE_MINIMUM: bool = false;

    fn accepts(value: f64) -> bool {
        let high_enough = if Self::ABOVE_MINIMUM { value > Self::MINIMUM } else { value >= Self::MINIMUM };
        high_enough && value <= Self::MAXIMUM
    }
}

macro_rules! rules {
    ($($name:ident $words:literal { $($item:tt)* })*) => {$(
        #[doc = concat!("Marks ", $words, ".")]
        #[derive(Debug, Clone, Copy)]
        pub enum $name {}
        impl Rule for $name {
            const WORDS: &'static str = $words;
            const NAME: &'static str = stringify!($name);
            $($item)*
        }
    )*};
}

rules! {
    Any "a number of magnitude at most 1e18" { const MINIMUM: f64 = -LARGEST; }
    NonNegative "a number from 0 to 1e18" { const MINIMUM: f64 = 0.0; }
    Positive "a number above 0" { const MINIMUM: f64 = 0.0; const ABOVE_MINIMUM: bool = true; }
    Fraction "a number from 0 to 1" { const MINIMUM: f64 = 0.0; const MAXIMUM: f64 = 1.0; }
    FilterRadius "a number from 0.5 to 16 (pixels)" {
        const MINIMUM: f64 = SMALLEST_FILTER_RADIUS; const MAXIMUM: f64 = LARGEST_FILTER_RADIUS;
    }
    FieldOfView "an angle from 0.001 to 179 (degrees)" { const MINIMUM: f64 = 0.001; const MAXIMUM: f64 = 179.0; }
    WholeAngle "an angle above 0, at most 360 (degrees)" {
        const MINIMUM: f64 = 0.0; const MAXIMUM: f64 = 360.0; const ABOVE_MINIMUM: bool = true;
    }
    Azimuth "an angle from -360 to 360 (degrees)" { const MINIMUM: f64 = -360.0; const MAXIMUM: f64 = 360.0; }
    Elevation "an angle from -90 to 90 (degrees)" { const MINIMUM: f64 = -90.0; const MAXIMUM: f64 = 90.0; }
    Longitude "an angle from -180 to 180 (degrees)" { const MINIMUM: f64 = -180.0; const MAXIMUM: f64 = 180.0; }
    Turbidity "a turbidity from 2 to 10" { const MINIMUM: f64 = 2.0; const MAXIMUM: f64 = 10.0; }
    HalfAngle "an angle above 0, at most 90 (degrees)" {
        const MINIMUM: f64 = 0.0; const MAXIMUM: f64 = 90.0; const ABOVE_MINIMUM: bool = true;
    }
    Temperature "a temperature from 1000 to 40000 (kelvin)" { const MINIMUM: f64 = 1000.0; const MAXIMUM: f64 = 40_000.0; }
    GasTemperature "a temperature from 0 to 40000 (kelvin)" { const MINIMUM: f64 = 0.0; const MAXIMUM: f64 = 40_000.0; }
    MeanCosine "a mean cosine from -0.999 to 0.999" { const MINIMUM: f64 = -0.999; const MAXIMUM: f64 = 0.999; }
    FilmIndex "an index of refraction from 1 to 10" { const MINIMUM: f64 = 1.0; const MAXIMUM: f64 = 10.0; }
    IndexOfRefraction "an index of refraction from 0.1 to 10" { const MINIMUM: f64 = 0.1; const MAXIMUM: f64 = 10.0; }
}

/// A number that keeps `R`.
#[derive(Debug)]
pub struct Checked<R>(pub f64, PhantomData<R>);

impl<R> Clone for Checked<R> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<R> Copy for Checked<R> {}

impl<R> PartialEq for Checked<R> {
    fn eq(&self, other: &Self) -> bool {
        self.0 == other.0
    }
}

impl<R: Rule> Checked<R> {
    pub fn new<E: Error>(value: f64) -> Result<Self, E> {
        Self::of(value).map_err(E::custom)
    }

    /// The number.
    ///
    /// # Errors
    /// A sentence about a number that `R` does not accept.
    pub fn of(value: f64) -> Result<Self, String> {
        if R::accepts(value) { Ok(Self(value, PhantomData)) } else { Err(format!("expected {}, found {value}", R::WORDS)) }
    }
}

impl Checked<NonNegative> {
    pub const ZERO: Self = Self(0.0, PhantomData);
}

/// Any finite number.
pub type Number = Checked<Any>;

/// Three numbers.
pub type Vector = Exactly<Number, 3>;

impl<T: Default> Default for Exactly<T, 2> {
    fn default() -> Self {
        Self(Default::default())
    }
}

impl<const N: usize> Exactly<Number, N> {
    /// These numbers.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn of(values: [f64; N]) -> Result<Self, String> {
        let mut numbers = [Checked(0.0, PhantomData); N];
        for (number, value) in numbers.iter_mut().zip(values) {
            *number = Number::of(value)?;
        }
        Ok(Self(numbers))
    }
}

/// The numbers as a vector.
pub fn vector(values: Vector) -> DVec3 {
    DVec3::from_array(values.0.map(|value| value.0))
}

/// A list of so many values. Serde's arrays leave out what is too much.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exactly<T, const N: usize>(pub [T; N]);

impl<T, const N: usize> Deref for Exactly<T, N> {
    type Target = [T; N];

    fn deref(&self) -> &[T; N] {
        &self.0
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ListVisitor<T, const N: usize>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for ListVisitor<T, N> {
            type Value = Exactly<T, N>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                write!(f, "an array of length {N}")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Self::Value, A::Error> {
                let mut values = Vec::with_capacity(N);
                while values.len() < N {
                    let value = seq.next_element()?;
                    values.push(value.ok_or_else(|| Error::invalid_length(values.len(), &self))?);
                }
                let mut length = N;
                while seq.next_element::<IgnoredAny>()?.is_some() {
                    length += 1;
                }
                match values.try_into() {
                    Ok(values) if length == N => Ok(Exactly(values)),
                    _ => Err(Error::invalid_length(length, &self)),
                }
            }
        }
        deserializer.deserialize_seq(ListVisitor(PhantomData))
    }
}

impl<T: JsonSchema, const N: usize> JsonSchema for Exactly<T, N> {
    fn schema_name() -> Cow<'static, str> {
        format!("{N}Of{}", T::schema_name()).into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": generator.subschema_for::<T>(), "minItems": N, "maxItems": N })
    }
}

impl<'de, R: Rule> Deserialize<'de> for Checked<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct NumberVisitor<R>(PhantomData<R>);
        impl<R: Rule> Visitor<'_> for NumberVisitor<R> {
            type Value = Checked<R>;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str(R::WORDS)
            }
            fn visit_f64<E: Error>(self, value: f64) -> Result<Self::Value, E> {
                Checked::new(value)
            }
            fn visit_i64<E: Error>(self, value: i64) -> Result<Self::Value, E> {
                Checked::new(value as f64)
            }
            fn visit_u64<E: Error>(self, value: u64) -> Result<Self::Value, E> {
                Checked::new(value as f64)
            }
        }
        deserializer.deserialize_any(NumberVisitor(PhantomData))
    }
}

impl<R: Rule> JsonSchema for Checked<R> {
    fn schema_name() -> Cow<'static, str> {
        R::NAME.into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let mut schema = json_schema!({ "type": "number" });
        let minimum = if R::ABOVE_MINIMUM { "exclusiveMinimum" } else { "minimum" };
        schema.insert(minimum.to_owned(), R::MINIMUM.into());
        schema.insert("maximum".to_owned(), R::MAXIMUM.into());
        schema
    }
}

/// A value and the place where it is stated.
#[derive(Clone, Default)]
pub struct Located<T> {
    pub value: T,
    pub place: Place,
}

impl Place {
    /// A value that is stated here.
    pub fn at<T>(&self, value: T) -> Located<T> {
        Located { value, place: self.clone() }
    }
}

/// Shows the value alone: two entries that state the same look the same.
impl<T: fmt::Debug> fmt::Debug for Located<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.value.fmt(f)
    }
}

/// Compares the values alone.
impl<T: PartialEq> PartialEq for Located<T> {
    fn eq(&self, other: &Self) -> bool {
        self.value == other.value
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Located<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (value, span) = located(deserializer)?;
        Ok(Self { value, place: span.into() })
    }
}

impl<T: NamesTextures> NamesTextures for Located<T> {
    fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
        self.value.each_texture(visit);
    }
}

impl<R> NamesTextures for Checked<R> {}
impl<T, const N: usize> NamesTextures for Exactly<T, N> {}

impl<T: JsonSchema> JsonSchema for Located<T> {
    fn schema_name() -> Cow<'static, str> {
        T::schema_name()
    }
    fn schema_id() -> Cow<'static, str> {
        T::schema_id()
    }
    fn inline_schema() -> bool {
        T::inline_schema()
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        T::json_schema(generator)
    }
}
