//! Files without a name, in the system's folder of temporary files, for what has to wait and would be much in memory.

use std::env::temp_dir;
use std::fs::File;
use std::io;

/// A new file, which is gone once it is closed.
///
/// # Errors
/// The file system's error, with the name of the folder.
pub fn temporary_file() -> io::Result<File> {
    tempfile::tempfile().map_err(in_temporary_folder)
}

/// An error of a temporary file, with the name of the folder and of the variable that chooses it.
pub fn in_temporary_folder(error: io::Error) -> io::Error {
    let variable = if cfg!(windows) { "TMP" } else { "TMPDIR" };
    io::Error::new(
        error.kind(),
        format!("a temporary file in {} ({variable} names another folder): {error}", temp_dir().display()),
    )
}
