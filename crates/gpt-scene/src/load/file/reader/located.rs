//! A value with its place in the text.

use std::fmt;
use std::ops::Range;

use serde::de::{Deserialize, Deserializer, EnumAccess, Error, VariantAccess, Visitor};

/// The enum that stands for a value together with its place.
pub const LOCATED: &str = "$located";

/// Reads a value and its place.
///
/// # Errors
/// Errors of the value, and of readers that know no places.
pub fn located<'de, D: Deserializer<'de>, T: Deserialize<'de>>(deserializer: D) -> Result<(T, Range<usize>), D::Error> {
    struct LocatedVisitor<T>(std::marker::PhantomData<T>);
    impl<'de, T: Deserialize<'de>> Visitor<'de> for LocatedVisitor<T> {
        type Value = (T, Range<usize>);
        fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
            f.write_str("a value with its place")
        }
        fn visit_enum<A: EnumAccess<'de>>(self, data: A) -> Result<Self::Value, A::Error> {
            let (ByteSpan(span), content) = data.variant()?;
            Ok((content.newtype_variant()?, span))
        }
    }
    deserializer.deserialize_enum(LOCATED, &[], LocatedVisitor(std::marker::PhantomData))
}

/// The bytes of a value.
struct ByteSpan(Range<usize>);

impl<'de> Deserialize<'de> for ByteSpan {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct ByteSpanVisitor;
        impl Visitor<'_> for ByteSpanVisitor {
            type Value = ByteSpan;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a place")
            }
            /// The start in the upper half, the end in the lower.
            fn visit_u128<E: Error>(self, both: u128) -> Result<ByteSpan, E> {
                Ok(ByteSpan((both >> 64) as usize..both as u64 as usize))
            }
        }
        deserializer.deserialize_u128(ByteSpanVisitor)
    }
}
