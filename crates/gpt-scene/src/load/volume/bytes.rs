//! The bytes of a file, little-endian numbers first to last, none of them read beyond the end.

/// A place in the bytes of a file.
#[derive(Debug, Clone, Copy)]
pub struct Bytes<'b> {
    all: &'b [u8],
    at: usize,
}

macro_rules! numbers {
    ($($name:ident)*) => {$(
        pub fn $name(&mut self) -> Result<$name, String> {
            Ok($name::from_le_bytes(self.array()?))
        }
    )*};
}

impl<'b> Bytes<'b> {
    pub fn new(all: &'b [u8]) -> Self {
        Self { all, at: 0 }
    }

    /// The bytes from a place on.
    ///
    /// # Errors
    /// A place beyond the end.
    pub fn from(all: &'b [u8], place: u64) -> Result<Self, String> {
        match usize::try_from(place) {
            Ok(at) if at <= all.len() => Ok(Self { all, at }),
            _ => Err(format!("it refers to its byte {place}, and ends at byte {}", all.len())),
        }
    }

    /// How many bytes come before this place.
    pub fn place(&self) -> u64 {
        self.at as u64
    }

    /// How many bytes follow.
    pub fn left(&self) -> usize {
        self.all.len() - self.at
    }

    /// The next bytes.
    ///
    /// # Errors
    /// Fewer are left.
    pub fn take(&mut self, count: usize) -> Result<&'b [u8], String> {
        if count > self.left() {
            return Err(format!(
                "it ends early: at its byte {} there should be {count} more, and there are {}",
                self.at,
                self.left()
            ));
        }
        let taken = &self.all[self.at..self.at + count];
        self.at += count;
        Ok(taken)
    }

    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut array = [0; N];
        array.copy_from_slice(self.take(N)?);
        Ok(array)
    }

    numbers! { u8 u16 u32 u64 i32 i64 f32 f64 }

    /// So many numbers.
    pub fn f64s<const N: usize>(&mut self) -> Result<[f64; N], String> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// Three whole numbers.
    pub fn coordinate(&mut self) -> Result<[i64; 3], String> {
        Ok([self.i32()?.into(), self.i32()?.into(), self.i32()?.into()])
    }

    /// A text after its length.
    pub fn text(&mut self) -> Result<String, String> {
        let length = self.u32()? as usize;
        Ok(String::from_utf8_lossy(self.take(length)?).into_owned())
    }
}
