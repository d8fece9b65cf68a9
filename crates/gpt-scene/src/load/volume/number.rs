//! The types of values in files.

use crate::math::half_to_f32;

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Number {
    Half,
    Float,
    Double,
    Int32,
    Int64,
}

/// How a voxel's value is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ValueType {
    pub number: Number,
    /// 1 or 3 of them.
    pub channels: usize,
}

/// A voxel's value; where it has one channel the others are equal.
pub type Value = [f32; 3];

impl Number {
    fn size(self) -> usize {
        match self {
            Self::Half => 2,
            Self::Float | Self::Int32 => 4,
            Self::Double | Self::Int64 => 8,
        }
    }

    /// A number from so many bytes as it takes.
    fn read(self, bytes: &[u8]) -> f32 {
        fn array<const N: usize>(bytes: &[u8]) -> [u8; N] {
            let mut array = [0; N];
            array.copy_from_slice(bytes);
            array
        }
        match self {
            Self::Half => half(u16::from_le_bytes(array(bytes))),
            Self::Float => f32::from_le_bytes(array(bytes)),
            Self::Double => f64::from_le_bytes(array(bytes)) as f32,
            Self::Int32 => i32::from_le_bytes(array(bytes)) as f32,
            Self::Int64 => i64::from_le_bytes(array(bytes)) as f32,
        }
    }
}

/// A half-precision number, infinite and no number too.
fn half(bits: u16) -> f32 {
    if bits & 0x7c00 == 0x7c00 {
        return if bits & 0x03ff == 0 { f32::INFINITY } else { f32::NAN };
    }
    half_to_f32(bits)
}

impl ValueType {
    /// Bytes of a value.
    pub fn size(self) -> usize {
        self.number.size() * self.channels
    }

    /// A value from so many bytes as it takes.
    pub fn read(self, bytes: &[u8]) -> Value {
        let size = self.number.size();
        let channel = |index: usize| self.number.read(&bytes[index * size..(index + 1) * size]);
        match self.channels {
            1 => [channel(0); 3],
            _ => [channel(0), channel(1), channel(2)],
        }
    }

    /// Values one after the other.
    pub fn read_all(self, bytes: &[u8]) -> impl Iterator<Item = Value> + '_ {
        bytes.chunks_exact(self.size()).map(move |bytes| self.read(bytes))
    }
}
