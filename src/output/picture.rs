//! One picture file in the making: a thread encodes and writes while the render goes on.

use std::fs::File;
use std::io::{BufWriter, Error, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Text};

use super::format::PictureFormat;
use super::provenance::BROKEN_OFF_KEY;
use super::rows::{Completeness, Message, Rows};
use super::spec::PictureSpec;
use super::temporary::temporary_file;
use super::{exr_file, hdr_file, jpeg_file, png_file};
use crate::file_identity::follow_links;
use crate::film::Band;
use crate::input;
use gpt_scene::atomic_file::{AtomicFile, MOST_BESIDE, names_beside};
use gpt_scene::output_error::OutputError;

/// Bands that wait for the encoder; with the one it works on and the one being rendered, this bounds the memory.
const WAITING_BANDS: usize = 1;
/// The path that is standard output.
pub const STDOUT: &str = "-";
/// The last bytes of a preview, in which the note stands that its render broke off.
const BYTES_OF_NOTE: u64 = 64;

/// A file that takes bands and appears, whole, at [`PictureFile::finish`]. Dropped before that, it leaves nothing.
pub struct PictureFile {
    place: Destination,
    messages: SyncSender<Message>,
    /// None once it was joined.
    encoder: Option<JoinHandle<Result<(), String>>>,
    rows_taken: u32,
    spec: PictureSpec,
}

/// The target of a picture.
enum Destination {
    File(AtomicFile),
    /// Kept in a file without a name until it is whole: encoders go back to the header.
    Stdout(File),
}

impl PictureFile {
    /// Begins the file; `format` is what the path's ending asked for. The path [`STDOUT`] is standard output.
    ///
    /// # Errors
    /// The errors of [`AtomicFile::create`]; a system that starts no more threads.
    pub fn create(path: &Path, format: PictureFormat, spec: &PictureSpec) -> Result<Self, OutputError> {
        let failure = |source| OutputError::Write { path: path.to_owned(), source };
        let place = if path == Path::new(STDOUT) {
            Destination::Stdout(temporary_file().map_err(failure)?)
        } else {
            Destination::File(AtomicFile::create(path)?)
        };
        let handle = match &place {
            Destination::File(file) => file.handle()?,
            Destination::Stdout(file) => file.try_clone().map_err(failure)?,
        };
        let writer = BufWriter::with_capacity(1 << 18, handle);
        let (messages, receiver) = sync_channel(WAITING_BANDS);
        let rows = Rows::new(receiver, spec.width);
        let encoder_spec = spec.clone();
        let encode = move || match format {
            PictureFormat::Exr => exr_file::write(writer, rows, &encoder_spec),
            PictureFormat::Png => png_file::write(writer, rows, &encoder_spec),
            PictureFormat::Jpeg => jpeg_file::write(writer, rows, &encoder_spec),
            PictureFormat::Hdr => hdr_file::write(writer, rows, &encoder_spec),
        };
        let encoder = thread::Builder::new().name("picture".to_owned()).spawn(encode).map_err(failure)?;
        Ok(Self { place, messages, encoder: Some(encoder), rows_taken: 0, spec: spec.clone() })
    }

    /// The path as it was asked for.
    pub fn path(&self) -> &Path {
        match &self.place {
            Destination::File(file) => file.path(),
            Destination::Stdout(_) => Path::new(STDOUT),
        }
    }

    /// Takes the next band; waits while the encoder is behind.
    ///
    /// # Errors
    /// A band of another width, one that overlaps an earlier one, or an encoder that gave up, with what it said.
    pub fn write_band(&mut self, band: &Arc<Band>) -> Result<(), Error> {
        let pixels = u64::from(band.width) * u64::from(band.rows);
        let end = band.first_row.checked_add(band.rows);
        let fits = band.width == self.spec.width && end.is_some_and(|end| end <= self.spec.height);
        if !fits || band.first_row < self.rows_taken || band.mean.len() as u64 != pixels {
            return Err(Error::other(format!("the band at row {} does not fit the picture", band.first_row)));
        }
        self.rows_taken = band.first_row + band.rows;
        self.messages.send(Message::Band(band.clone())).map_err(|_| {
            Error::other(self.join_encoder().err().unwrap_or_else(|| self.encode_error("the encoder stopped early")))
        })
    }

    /// Finishes the file with what came, black where nothing came, and puts it in its place.
    ///
    /// # Errors
    /// Errors of the encoder and the file system.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.encode_rest(Completeness::Finished)?;
        match self.place {
            Destination::File(file) => {
                let target = file.target().to_owned();
                file.commit_or_keep(&target)
            }
            Destination::Stdout(file) => write_to_stdout(file),
        }
    }

    /// Finishes the file as [`PictureFile::finish`] does, for a render that broke off. A finished picture in
    /// the place stays there, and this one goes beside it. The result is where it went.
    ///
    /// # Errors
    /// The errors of [`PictureFile::finish`].
    pub fn finish_broken_off(mut self) -> Result<PathBuf, OutputError> {
        self.encode_rest(Completeness::BrokenOff)?;
        match self.place {
            Destination::Stdout(file) => write_to_stdout(file).map(|()| PathBuf::from(STDOUT)),
            Destination::File(file) => {
                let place = beside_finished(file.target());
                // The message names the file as the person did, unless a link leads elsewhere.
                let named = file.path().with_file_name(place.file_name().unwrap_or_default());
                let named = if follow_links(&named).is_ok_and(|meant| meant == place) { named } else { place.clone() };
                file.commit_or_keep(&place).map(|()| named)
            }
        }
    }

    /// True if a finished picture stands in its place. A render that broke off does not replace it.
    pub fn has_finished_one(&self) -> bool {
        match &self.place {
            Destination::File(file) => beside_finished(file.target()) != file.target(),
            Destination::Stdout(_) => false,
        }
    }

    fn encode_rest(&mut self, completeness: Completeness) -> Result<(), OutputError> {
        // An encoder that is gone has an error to tell, which joining it brings.
        let _ = self.messages.send(Message::Finish(completeness));
        self.join_encoder()
    }

    /// Waits for the encoder, which must be about to end, and tells how it went.
    fn join_encoder(&mut self) -> Result<(), OutputError> {
        let encoder = self.encoder.take().ok_or_else(|| self.encode_error("writing failed before"))?;
        let encoded = encoder.join().unwrap_or_else(|_| Err("the encoder panicked".to_owned()));
        encoded.map_err(|what| self.encode_error(&what))
    }

    fn encode_error(&self, what: &str) -> OutputError {
        OutputError::Encode { path: self.path().to_owned(), what: what.to_owned() }
    }
}

/// Hands a whole picture to whoever reads standard output.
fn write_to_stdout(mut file: File) -> Result<(), OutputError> {
    let mut stdout = std::io::stdout().lock();
    let copied = file.rewind().and_then(|()| std::io::copy(&mut file, &mut stdout)).and_then(|_| stdout.flush());
    copied.map_err(|source| OutputError::Write { path: STDOUT.into(), source })
}

/// The place of an unfinished picture: its own place, or `name.incomplete.exr` beside a finished file.
fn beside_finished(target: &Path) -> PathBuf {
    let candidates = std::iter::once(target.to_owned()).chain(names_beside(target, "incomplete"));
    let mut free = candidates.take(MOST_BESIDE).filter(|path| !is_finished(path));
    free.next().unwrap_or_else(|| target.to_owned())
}

/// True if the file there is to be kept: anything but a picture that says that its render broke off.
pub(super) fn is_finished(path: &Path) -> bool {
    let note = BROKEN_OFF_KEY;
    if let Ok(Ok(meta)) = input::open_to_decode(path).map(|file| MetaData::read_from_buffered(file, false)) {
        return meta
            .headers
            .iter()
            .all(|header| header.own_attributes.other.get(&Text::from(note)) != Some(&AttributeValue::I32(1)));
    }
    // A preview has its note right before its end.
    let mut end = Vec::new();
    let read = input::open(path).and_then(|mut file| {
        let length = file.seek(SeekFrom::End(0))?;
        file.seek(SeekFrom::Start(length.saturating_sub(BYTES_OF_NOTE)))?;
        file.read_to_end(&mut end)
    });
    let says_so = end.windows(note.len()).any(|window| window == note.as_bytes());
    match read {
        Ok(_) => !says_so,
        Err(error) => error.kind() != std::io::ErrorKind::NotFound,
    }
}

#[cfg(test)]
mod tests;
