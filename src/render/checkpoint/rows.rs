//! Finished rows of pictures that are rendered in bands: a file beside the checkpoint that only grows, each band with a digest behind it.

use std::fs::{self, File, OpenOptions};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use sha2::{Digest, Sha256};

use super::file::{DAMAGED, DIGEST_BYTES};
use crate::film::Band;

/// Between the checkpoint's name and what tells its files of rows apart.
const INFIX: &str = "-rows-";

/// Rows in their file. It is locked as long as its process lives.
pub struct RowsFile {
    name: String,
    file: File,
    bytes: u64,
}

impl RowsFile {
    /// Begins a file beside the checkpoint.
    pub fn create(checkpoint: &Path) -> io::Result<Self> {
        let now = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
        let name = format!("{}{INFIX}{}-{}", name_of(checkpoint), std::process::id(), now.as_nanos());
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create_new(true).open(checkpoint.with_file_name(&name))?;
        // A file system without locks refuses, and then nobody removes the file.
        let _ = file.try_lock();
        Ok(Self { name, file, bytes: 0 })
    }

    /// Goes on with the first bytes of one. If another process has it open, with a copy.
    pub fn resume(checkpoint: &Path, name: &str, bytes: u64) -> io::Result<Self> {
        if !is_of(checkpoint, name) {
            return Err(io::Error::other("a name that is none of its own"));
        }
        let mut options = OpenOptions::new();
        let mut file = options.read(true).write(true).open(checkpoint.with_file_name(name))?;
        if file.metadata()?.len() < bytes {
            return Err(io::ErrorKind::UnexpectedEof.into());
        }
        if file.try_lock().is_ok() {
            file.set_len(bytes)?;
            file.seek(SeekFrom::End(0))?;
            return Ok(Self { name: name.to_owned(), file, bytes });
        }
        let mut copy = Self::create(checkpoint)?;
        copy.bytes = io::copy(&mut file.take(bytes), &mut copy.file)?;
        Ok(copy)
    }

    /// Adds a band.
    pub fn append(&mut self, band: &Band) -> io::Result<()> {
        let mut bytes = Vec::new();
        let numbers = [band.first_row, band.width, band.rows, band.samples, u32::from(band.counts.is_some())];
        let lengths = [band.mean.len() as u32, band.remainder.len() as u32, band.second_moment.len() as u32];
        bytes.extend_from_slice(bytemuck::cast_slice(&numbers));
        bytes.extend_from_slice(bytemuck::cast_slice(&lengths));
        bytes.extend_from_slice(bytemuck::cast_slice(band.counts.as_deref().unwrap_or_default()));
        bytes.extend_from_slice(bytemuck::cast_slice(&band.mean));
        bytes.extend_from_slice(bytemuck::cast_slice(&band.remainder));
        bytes.extend_from_slice(bytemuck::cast_slice(&band.second_moment));
        let digest = Sha256::digest(&bytes);
        bytes.extend_from_slice(&digest);
        self.file.write_all(&bytes)?;
        self.bytes += bytes.len() as u64;
        Ok(())
    }

    /// Its name, and its length once all of it is sure to stay.
    pub fn flushed(&self) -> io::Result<(String, u64)> {
        self.file.sync_data()?;
        Ok((self.name.clone(), self.bytes))
    }

    /// Checks that all bands are what was written.
    ///
    /// # Errors
    /// The errors of [`RowsFile::read`].
    pub fn check(&mut self) -> io::Result<()> {
        self.read(&mut |_| Ok(()))
    }

    /// Hands over all bands.
    ///
    /// # Errors
    /// A file that cannot be read, bands that are not what was written, and what `on_band` says.
    pub fn read(&mut self, on_band: &mut dyn FnMut(Band) -> io::Result<()>) -> io::Result<()> {
        self.file.rewind()?;
        let mut left = self.bytes;
        while left > 0 {
            let mut hash = Sha256::new();
            let [first_row, width, rows, samples, has_counts, means, remainders, squares] = {
                let mut bytes = [0; 32];
                self.file.read_exact(&mut bytes)?;
                hash.update(bytes);
                bytemuck::pod_read_unaligned::<[u32; 8]>(&bytes)
            };
            let counts = if has_counts == 1 { means } else { 0 };
            let length = 4 * u64::from(counts) + 12 * (u64::from(means) + u64::from(remainders)) + 4 * u64::from(squares);
            let damaged = || io::Error::new(io::ErrorKind::InvalidData, DAMAGED);
            left = left.checked_sub(32 + length + DIGEST_BYTES as u64).ok_or_else(damaged)?;
            let counts = (has_counts == 1).then(|| self.items(counts, &mut hash)).transpose()?;
            let [mean, remainder] = [self.items(means, &mut hash)?, self.items(remainders, &mut hash)?];
            let second_moment = self.items(squares, &mut hash)?;
            let mut digest = [0; DIGEST_BYTES];
            self.file.read_exact(&mut digest)?;
            if hash.finalize().as_slice() != digest {
                return Err(damaged());
            }
            on_band(Band { first_row, width, rows, samples, counts, mean, remainder, second_moment, ..Band::default() })?;
        }
        self.file.seek(SeekFrom::Start(self.bytes)).map(|_| ())
    }

    fn items<T: bytemuck::Pod>(&mut self, count: u32, hash: &mut Sha256) -> io::Result<Vec<T>> {
        let mut bytes = vec![0; count as usize * size_of::<T>()];
        self.file.read_exact(&mut bytes)?;
        hash.update(&bytes);
        Ok(bytes.chunks_exact(size_of::<T>()).map(bytemuck::pod_read_unaligned).collect())
    }
}

/// Removes the files of rows of this checkpoint that no process has open.
pub fn remove_all(checkpoint: &Path) {
    let folder = checkpoint.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let Ok(entries) = fs::read_dir(folder) else { return };
    let ours = entries.flatten().filter(|entry| entry.file_name().to_str().is_some_and(|name| is_of(checkpoint, name)));
    for path in ours.map(|entry| entry.path()).collect::<Vec<PathBuf>>() {
        if File::open(&path).is_ok_and(|file| file.try_lock().is_ok()) {
            // A file that cannot be removed stays.
            let _ = fs::remove_file(path);
        }
    }
}

fn name_of(checkpoint: &Path) -> String {
    checkpoint.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

fn is_of(checkpoint: &Path, name: &str) -> bool {
    name.strip_prefix(&format!("{}{INFIX}", name_of(checkpoint))).is_some_and(|rest| !rest.contains(['/', '\\']))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn band(first_row: u32, counts: Option<Vec<u32>>) -> Band {
        Band {
            first_row,
            width: 2,
            rows: 1,
            samples: 3,
            counts,
            mean: vec![[0.5; 3]; 2],
            remainder: Vec::new(),
            second_moment: vec![0.25; 2],
            ..Band::default()
        }
    }

    fn rows(file: &mut RowsFile) -> Vec<(u32, Option<Vec<u32>>, usize)> {
        let mut found = Vec::new();
        file.read(&mut |band| {
            found.push((band.first_row, band.counts, band.mean.len() + band.second_moment.len()));
            Ok(())
        })
        .expect("they are read");
        found
    }

    #[test]
    fn rows_go_on_from_where_the_checkpoint_says() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let checkpoint = folder.path().join("a.exr.checkpoint");
        let mut file = RowsFile::create(&checkpoint).expect("a file");
        file.append(&band(0, None)).expect("it is written");
        let (name, bytes) = file.flushed().expect("it is flushed");
        file.append(&band(1, Some(vec![1, 2]))).expect("it is written");
        // While the first process lives, another has a copy.
        let mut copy = RowsFile::resume(&checkpoint, &name, bytes).expect("a copy");
        assert_ne!(copy.name, name);
        copy.append(&band(2, None)).expect("it is written");
        assert_eq!(rows(&mut copy), [(0, None, 4), (2, None, 4)]);
        assert_eq!(rows(&mut file), [(0, None, 4), (1, Some(vec![1, 2]), 4)]);
        drop(file);
        let mut resumed = RowsFile::resume(&checkpoint, &name, bytes).expect("the file");
        assert_eq!(rows(&mut resumed), [(0, None, 4)]);
        assert_eq!(resumed.name, name);
        assert!(RowsFile::resume(&checkpoint, &name, bytes + 1000).is_err());
        assert!(RowsFile::resume(&checkpoint, "../elsewhere", 0).is_err());
        // Each byte counts.
        drop(resumed);
        let path = checkpoint.with_file_name(&name);
        let whole = fs::read(&path).expect("the file");
        for index in 0..whole.len() {
            let mut bad = whole.clone();
            bad[index] ^= 0x04;
            fs::write(&path, bad).expect("the file");
            assert!(RowsFile::resume(&checkpoint, &name, bytes).and_then(|mut file| file.check()).is_err(), "byte {index}");
        }
        fs::write(&path, &whole).expect("the file");
        let mut resumed = RowsFile::resume(&checkpoint, &name, bytes).expect("the file");
        assert!(resumed.check().is_ok(), "the control");
        drop(copy);
        remove_all(&checkpoint);
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 1, "what is open stays");
        drop(resumed);
        remove_all(&checkpoint);
        assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0);
    }
}
