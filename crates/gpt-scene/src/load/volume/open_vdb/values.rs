//! The values of a node, compressed in two ways at once: inactive values may be left out, and the bytes of the others be compressed.

use std::borrow::Cow;
use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::version::NODE_MASK_COMPRESSION;
use crate::load::volume::blosc;
use crate::load::volume::bytes::Bytes;
use crate::load::volume::number::{Number, Value, ValueType};

/// The ways in which a grid's values are compressed.
#[derive(Debug, Clone, Copy, Default)]
pub struct Compression {
    pub zip: bool,
    /// Inactive values are left out.
    active_mask: bool,
    blosc: bool,
}

impl Compression {
    /// By the bits of a grid's number.
    pub fn from_bits(bits: u32) -> Self {
        Self { zip: bits & 1 != 0, active_mask: bits & 2 != 0, blosc: bits & 4 != 0 }
    }
}

/// How a grid's values are stored.
pub struct Format {
    pub version: u32,
    pub compression: Compression,
    /// The type of single values; arrays may have it in half precision.
    pub stored: ValueType,
    pub is_half: bool,
}

/// Meanings of the byte before a node's values. Inactive values are left out but in the last case, and are the background's value; its negative;
/// one value, which follows; or by a mask the background's value or its negative; the background's value or one that follows; one of two that
/// follow.
const BACKGROUND: u8 = 0;
const NEGATIVE_BACKGROUND: u8 = 1;
const ONE_VALUE: u8 = 2;
const MASK: u8 = 3;
const MASK_AND_ONE_VALUE: u8 = 4;
const MASK_AND_TWO_VALUES: u8 = 5;
const ALL_VALUES: u8 = 6;

impl Format {
    /// The type of values in arrays.
    fn in_arrays(&self) -> ValueType {
        let can_be_half = matches!(self.stored.number, Number::Float | Number::Double);
        if self.is_half && can_be_half { ValueType { number: Number::Half, ..self.stored } } else { self.stored }
    }

    /// A single value, which is never in half precision.
    pub fn value(&self, bytes: &mut Bytes<'_>) -> Result<Value, String> {
        Ok(self.stored.read(bytes.take(self.stored.size())?))
    }

    /// The values of a node into `values`: one for each bit of the mask of active ones; or of nodes of old files that are not leaves, as many as
    /// are stored.
    pub fn values(&self, bytes: &mut Bytes<'_>, active: &[u8], background: Value, values: &mut [Value]) -> Result<(), String> {
        let kind = if self.version >= NODE_MASK_COMPRESSION { bytes.u8()? } else { ALL_VALUES };
        let negative = background.map(|value| -value);
        let [mut off, mut on] = [if kind == BACKGROUND { background } else { negative }, background];
        if matches!(kind, ONE_VALUE | MASK_AND_ONE_VALUE | MASK_AND_TWO_VALUES) {
            off = self.value(bytes)?;
        }
        if kind == MASK_AND_TWO_VALUES {
            on = self.value(bytes)?;
        }
        let selection = match kind {
            MASK | MASK_AND_ONE_VALUE | MASK_AND_TWO_VALUES => Some(bytes.take(active.len())?),
            BACKGROUND | NEGATIVE_BACKGROUND | ONE_VALUE | ALL_VALUES => None,
            _ => return Err(format!("a node of its grid has the unknown kind {kind}")),
        };
        let leaves_out = self.compression.active_mask && kind != ALL_VALUES;
        let count = if leaves_out { active.iter().map(|byte| byte.count_ones() as usize).sum() } else { values.len() };
        let numbers = self.in_arrays();
        let content = self.content(bytes, count * numbers.size())?;
        let mut stored = numbers.read_all(&content);
        if count == values.len() {
            values.iter_mut().zip(stored).for_each(|(value, stored)| *value = stored);
            return Ok(());
        }
        for (index, value) in values.iter_mut().enumerate() {
            let inactive = if selection.is_some_and(|selection| is_set(selection, index)) { on } else { off };
            *value = is_set(active, index).then(|| stored.next()).flatten().unwrap_or(inactive);
        }
        Ok(())
    }

    /// The decompressed bytes of an array.
    fn content<'b>(&self, bytes: &mut Bytes<'b>, size: usize) -> Result<Cow<'b, [u8]>, String> {
        if !self.compression.zip && !self.compression.blosc || size == 0 && self.in_arrays() != self.stored {
            return bytes.take(size).map(Cow::Borrowed);
        }
        // A length that is not positive is that of bytes that are not compressed.
        let length = bytes.i64()?;
        if length <= 0 {
            if length.unsigned_abs() != size as u64 {
                return Err(format!("a node of its grid has {} bytes of values, and not {size}", length.unsigned_abs()));
            }
            return bytes.take(size).map(Cow::Borrowed);
        }
        let compressed = bytes.take(usize::try_from(length).map_err(|_| "it ends early".to_owned())?)?;
        let mut content = vec![0; size];
        if self.compression.blosc {
            blosc::decompress(compressed, &mut content)?;
        } else {
            let result = ZlibDecoder::new(compressed).read_exact(&mut content);
            result.map_err(|_| "a compressed block of it is damaged".to_owned())?;
        }
        Ok(Cow::Owned(content))
    }
}

/// True where a bit of a mask is set.
pub fn is_set(mask: &[u8], index: usize) -> bool {
    mask[index / 8] >> (index % 8) & 1 == 1
}
