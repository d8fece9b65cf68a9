//! Files that are read: regular ones, of bounded size.
//!
//! A pipe, a device or a socket may never end, or never begin. Each is refused before it is opened.

use std::fs::{self, File};
use std::io::{self, BufRead, BufReader, ErrorKind, Read, Seek};
use std::path::Path;

/// A regular file that is being read.
pub type InputFile = BufReader<File>;

/// Bytes that are read ahead.
const BUFFER: usize = 1 << 16;

/// A stream that is read from any place in it.
pub trait Seekable: BufRead + Seek {}

impl<T: BufRead + Seek> Seekable for T {}

/// A file, or bytes in memory. Decoders of pictures are large and compiled for each type that they read from; this is the one.
pub type AnyFile = Box<dyn Seekable + Send>;

/// Opens a regular file.
///
/// # Errors
/// The errors of [`File::open`], and a path that leads to anything else, which the error names.
pub fn open(path: &Path) -> io::Result<InputFile> {
    let kind = fs::metadata(path)?.file_type();
    if !kind.is_file() {
        return Err(io::Error::new(ErrorKind::InvalidInput, format!("it is {}, not a regular file", name(kind))));
    }
    Ok(BufReader::with_capacity(BUFFER, File::open(path)?))
}

/// Opens a regular file for a decoder.
///
/// # Errors
/// The errors of [`open`].
pub fn open_to_decode(path: &Path) -> io::Result<AnyFile> {
    Ok(Box::new(open(path)?))
}

/// The length of an open file.
///
/// # Errors
/// The file system's error.
pub fn length(file: &InputFile) -> io::Result<u64> {
    Ok(file.get_ref().metadata()?.len())
}

/// Reads what is left of an open file, at most `most` bytes.
///
/// # Errors
/// A larger file, one that cannot be read, and memory that does not suffice.
pub fn read(file: InputFile, most: u64) -> io::Result<Vec<u8>> {
    let length = length(&file)?;
    if length > most {
        return Err(too_large(most));
    }
    read_to_end(file, length, most)
}

/// Reads what is left of a stream, at most `most` bytes; `expected` of them, as far as that is known.
///
/// # Errors
/// The errors of [`read`].
pub fn read_to_end(stream: impl Read, expected: u64, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    bytes.try_reserve_exact(usize::try_from(expected).unwrap_or(usize::MAX)).map_err(|_| ErrorKind::OutOfMemory)?;
    // Files of the kernel state no length, and others grow while they are read.
    stream.take(most.saturating_add(1)).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > most { Err(too_large(most)) } else { Ok(bytes) }
}

fn too_large(most: u64) -> io::Error {
    io::Error::new(ErrorKind::FileTooLarge, format!("it is larger than the {} MiB that are read of such a file", most >> 20))
}

#[cfg(unix)]
fn name(kind: fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt as _;
    match kind {
        _ if kind.is_dir() => "a folder",
        _ if kind.is_fifo() => "a pipe",
        _ if kind.is_socket() => "a socket",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn name(kind: fs::FileType) -> &'static str {
    if kind.is_dir() { "a folder" } else { "a device" }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regular_files_are_read_up_to_a_size() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        fs::write(&path, [7; 100]).unwrap();
        let read_at = |path: &Path, most| open(path).and_then(|file| read(file, most));
        assert_eq!(read_at(&path, 100).unwrap(), [7; 100]);
        assert_eq!(read_at(&path, 99).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(read_to_end(io::repeat(1), 0, 1 << 20).unwrap_err().kind(), ErrorKind::FileTooLarge);
        assert_eq!(open(folder.path()).unwrap_err().to_string(), "it is a folder, not a regular file");
        assert_eq!(open(&folder.path().join("absent")).unwrap_err().kind(), ErrorKind::NotFound);
    }

    #[cfg(unix)]
    #[test]
    fn what_never_ends_or_never_begins_is_refused() {
        assert_eq!(open(Path::new("/dev/zero")).unwrap_err().to_string(), "it is a device, not a regular file");
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        assert_eq!(open(&pipe).unwrap_err().to_string(), "it is a pipe, not a regular file");
    }
}
