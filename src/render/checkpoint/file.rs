//! The file of a checkpoint: a header in JSON, arrays of numbers, and a digest of both.

use std::io::{self, BufWriter, Read, Write};
use std::path::Path;

use bytemuck::Pod;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::input::{self, InputFile};
use crate::output::{AtomicFile, OutputError};

const MAGIC: &[u8; 16] = b"gpt checkpoint\n\0";
pub const DIGEST_BYTES: usize = 32;
/// A header is no longer: identities and positions take a few thousand bytes.
const MOST_HEADER_BYTES: u64 = 1 << 20;

#[derive(Serialize, Deserialize)]
struct Header<H> {
    content: H,
    /// Bytes of each array.
    arrays: Vec<u64>,
}

/// Writes a checkpoint, whole or not at all.
///
/// # Errors
/// The errors of [`AtomicFile::create`] and [`AtomicFile::commit`].
pub fn write<H: Serialize>(path: &Path, content: &H, arrays: &[&[u8]]) -> Result<(), OutputError> {
    let failure = |source| OutputError::Write { path: path.to_owned(), source };
    let header = Header { content, arrays: arrays.iter().map(|array| array.len() as u64).collect() };
    let header = serde_json::to_vec(&header).map_err(|error| failure(error.into()))?;
    let file = AtomicFile::create(path)?;
    let mut writer = Hashing { hash: Sha256::new(), inner: BufWriter::with_capacity(1 << 18, file.handle()?) };
    let written = (|| {
        writer.write_all(MAGIC)?;
        writer.write_all(&(header.len() as u64).to_le_bytes())?;
        writer.write_all(&header)?;
        arrays.iter().try_for_each(|array| writer.write_all(array))?;
        let digest = writer.hash.finalize();
        writer.inner.write_all(&digest)?;
        writer.inner.flush()
    })();
    written.map_err(failure)?;
    file.commit()
}

/// The content of a checkpoint.
pub struct Content<H> {
    pub header: H,
    arrays: std::vec::IntoIter<Vec<u8>>,
}

impl<H> Content<H> {
    /// The next array, which must have so many items.
    ///
    /// # Errors
    /// An array with another number of items.
    pub fn array<T: Pod>(&mut self, items: usize) -> Result<Vec<T>, String> {
        let bytes = self.arrays.next().unwrap_or_default();
        if bytes.len() != items * size_of::<T>() {
            return Err(DAMAGED.to_owned());
        }
        Ok(bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
    }
}

/// The message for files that are not what was written.
pub const DAMAGED: &str = "it is damaged";

/// Reads a checkpoint; None where there is none.
///
/// # Errors
/// A file that cannot be read, or that is not what was written, in words.
pub fn read<H: DeserializeOwned>(path: &Path) -> Result<Option<Content<H>>, String> {
    let mut file = match input::open(path) {
        Ok(file) => file,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error.to_string()),
    };
    let length = input::length(&file).map_err(|error| error.to_string())?;
    let mut hash = Sha256::new();
    let mut take = |bytes: u64| {
        // No more is made room for than the file has.
        let mut buffer = vec![0; usize::try_from(bytes.min(length)).unwrap_or(usize::MAX)];
        if buffer.len() as u64 != bytes {
            return Err(DAMAGED.to_owned());
        }
        file.read_exact(&mut buffer).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => DAMAGED.to_owned(),
            _ => error.to_string(),
        })?;
        Ok(buffer)
    };
    let start = take(MAGIC.len() as u64 + 8)?;
    hash.update(&start);
    let (magic, header_bytes) = start.split_at(MAGIC.len());
    if magic != MAGIC {
        return Err("it is no checkpoint of this program".to_owned());
    }
    let header_bytes = header_bytes.try_into().map_or(0, u64::from_le_bytes);
    if header_bytes > MOST_HEADER_BYTES {
        return Err(DAMAGED.to_owned());
    }
    let header = take(header_bytes)?;
    hash.update(&header);
    let Ok(Header { content, arrays }) = serde_json::from_slice::<Header<H>>(&header) else {
        return Err("it was made by another version of gpt, or is damaged".to_owned());
    };
    let arrays = arrays.into_iter().map(&mut take).collect::<Result<Vec<_>, _>>()?;
    arrays.iter().for_each(|array| hash.update(array));
    let digest = take(DIGEST_BYTES as u64)?;
    if hash.finalize().as_slice() != digest || file_goes_on(&mut file) {
        return Err(DAMAGED.to_owned());
    }
    Ok(Some(Content { header: content, arrays: arrays.into_iter() }))
}

fn file_goes_on(file: &mut InputFile) -> bool {
    file.read(&mut [0]).map_or(true, |bytes| bytes > 0)
}

/// Passes bytes on and hashes them.
struct Hashing<W> {
    hash: Sha256,
    inner: W,
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hash.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Each byte counts, and so does each that is missing; nothing else is read.
    #[test]
    fn a_checkpoint_comes_back_whole_or_not_at_all() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("a.checkpoint");
        assert!(read::<String>(&path).is_ok_and(|content| content.is_none()));
        let numbers = [1.5_f32, f32::NAN, -0.0];
        write(&path, &"a header".to_owned(), &[bytemuck::cast_slice(&numbers), &[7, 8]]).expect("it is written");
        let mut content = read::<String>(&path).expect("it is read").expect("it is there");
        assert_eq!(content.header, "a header");
        let found: Vec<f32> = content.array(3).expect("three numbers");
        assert_eq!(found.iter().map(|x| x.to_bits()).collect::<Vec<_>>(), numbers.map(f32::to_bits));
        assert!(content.array::<u8>(3).is_err(), "two bytes are not three");

        let bytes = std::fs::read(&path).expect("the file");
        for index in 0..bytes.len() {
            let mut bad = bytes.clone();
            bad[index] ^= 0x10;
            std::fs::write(&path, bad).expect("the file");
            assert!(read::<String>(&path).is_err(), "byte {index}");
        }
        for length in 0..bytes.len() {
            std::fs::write(&path, &bytes[..length]).expect("the file");
            assert!(read::<String>(&path).is_err(), "{length} bytes");
        }
        std::fs::write(&path, [bytes.as_slice(), &[0]].concat()).expect("the file");
        assert!(read::<String>(&path).is_err(), "a byte too many");
        std::fs::write(&path, &bytes).expect("the file");
        assert!(read::<u32>(&path).is_err(), "another header");
        assert!(read::<String>(&path).is_ok(), "the control");
    }
}
