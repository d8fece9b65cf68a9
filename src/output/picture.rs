//! One picture file in the making: a thread encodes and writes while the render goes on.

use std::ffi::OsStr;
use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Text};

use super::atomic::{AtomicFile, follow_links};
use super::error::OutputError;
use super::format::PictureFormat;
use super::provenance::BROKEN_OFF_KEY;
use super::rows::{Completeness, Message, Rows};
use super::spec::PictureSpec;
use super::{exr_file, hdr_file, jpeg_file, png_file};
use crate::film::Band;
use crate::input;
use crate::patience::{self, Watched};

/// Bands that wait for the encoder; with the one it works on and the one being rendered, this bounds the memory.
const WAITING_BANDS: usize = 1;
/// The path that is standard output.
pub const STDOUT: &str = "-";
/// The last bytes of a preview, in which the note stands that its render broke off.
const BYTES_OF_NOTE: u64 = 64;
/// Unfinished pictures that are kept beside a finished one.
const MOST_BESIDE: usize = 1000;

/// A file that takes bands and appears, whole, at [`PictureFile::finish`]. Dropped before that, it leaves nothing.
pub struct PictureFile {
    place: Place,
    messages: SyncSender<Message>,
    /// None once it was joined.
    encoder: Option<JoinHandle<Result<(), String>>>,
    rows_taken: u32,
    spec: PictureSpec,
}

/// The encoder ended before it was told to.
struct Gone;

/// Where a picture goes.
enum Place {
    File(AtomicFile),
    /// Kept in a file without a name until it is whole: encoders go back to the header.
    Stdout(File),
}

impl PictureFile {
    /// Begins the file; `format` is what the path's ending asked for. The path [`STDOUT`] is standard output.
    ///
    /// # Errors
    /// As [`AtomicFile::create`]; a system that starts no more threads.
    pub fn create(path: &Path, format: PictureFormat, spec: &PictureSpec) -> Result<Self, OutputError> {
        let failure = |source| OutputError::Write { path: path.to_owned(), source };
        let place = if path == Path::new(STDOUT) {
            Place::Stdout(tempfile::tempfile().map_err(failure)?)
        } else {
            Place::File(AtomicFile::create(path)?)
        };
        let handle = match &place {
            Place::File(file) => file.handle()?,
            Place::Stdout(file) => file.try_clone().map_err(failure)?,
        };
        let writer = BufWriter::with_capacity(1 << 18, Watched(handle));
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
            Place::File(file) => file.path(),
            Place::Stdout(_) => Path::new(STDOUT),
        }
    }

    /// Takes the next band; waits while the encoder is behind.
    ///
    /// # Errors
    /// A band of another width, one that overlaps an earlier one, or an encoder that gave up, with what it said.
    ///
    /// A file system that does not answer ends the file as well.
    pub fn write_band(&mut self, band: &Arc<Band>) -> Result<(), Error> {
        let pixels = u64::from(band.width) * u64::from(band.rows);
        let end = band.first_row.checked_add(band.rows);
        let fits = band.width == self.spec.width && end.is_some_and(|end| end <= self.spec.height);
        if !fits || band.first_row < self.rows_taken || band.mean.len() as u64 != pixels {
            return Err(Error::other(format!("the band at row {} does not fit the picture", band.first_row)));
        }
        self.rows_taken = band.first_row + band.rows;
        self.send(Message::Band(band.clone()))?.map_err(|Gone| {
            Error::other(self.join_encoder().err().unwrap_or_else(|| self.encode_error("the encoder stopped early")))
        })
    }

    /// Finishes the file with what came, black where nothing came, and puts it in its place.
    ///
    /// # Errors
    /// What the encoder or the file system said.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.encode_rest(Completeness::Finished)?;
        match self.place {
            Place::File(file) => file.commit(),
            Place::Stdout(file) => write_to_stdout(file),
        }
    }

    /// As [`PictureFile::finish`], of a render that broke off. A finished picture that is in the place stays there, and this one goes beside
    /// it. Where it went.
    ///
    /// # Errors
    /// As [`PictureFile::finish`].
    pub fn finish_broken_off(mut self) -> Result<PathBuf, OutputError> {
        self.encode_rest(Completeness::BrokenOff)?;
        match self.place {
            Place::Stdout(file) => write_to_stdout(file).map(|()| PathBuf::from(STDOUT)),
            Place::File(file) => {
                let place = beside_finished(file.target());
                // As the person would name it, unless a link leads elsewhere.
                let named = file.path().with_file_name(place.file_name().unwrap_or_default());
                let named = if follow_links(&named).is_ok_and(|meant| meant == place) { named } else { place.clone() };
                file.commit_as(&place).map(|()| named)
            }
        }
    }

    /// Whether a finished picture stands in its place, which one that broke off does not replace.
    pub fn has_finished_one(&self) -> bool {
        match &self.place {
            Place::File(file) => beside_finished(file.target()) != file.target(),
            Place::Stdout(_) => false,
        }
    }

    fn encode_rest(&mut self, completeness: Completeness) -> Result<(), OutputError> {
        let sent = self.send(Message::Finish(completeness));
        // An encoder that is gone has an error to tell, which joining it brings.
        let _ = sent.map_err(|source| self.write_error(source))?;
        self.join_encoder()
    }

    /// Hands something to the encoder. The error is that of a file that does not answer, which is given up.
    fn send(&mut self, message: Message) -> Result<Result<(), Gone>, Error> {
        let Some(encoder) = &self.encoder else { return Ok(Err(Gone)) };
        match patience::send(&self.messages, message, encoder) {
            Ok(()) => Ok(Ok(())),
            Err(error) if error.kind() == ErrorKind::BrokenPipe => Ok(Err(Gone)),
            Err(error) => {
                self.encoder = None;
                Err(error)
            }
        }
    }

    fn write_error(&self, source: Error) -> OutputError {
        OutputError::Write { path: self.path().to_owned(), source }
    }

    /// Waits for the encoder, which must be about to end, and tells how it went.
    fn join_encoder(&mut self) -> Result<(), OutputError> {
        let encoder = self.encoder.take().ok_or_else(|| self.encode_error("writing failed before"))?;
        let joined = patience::join(encoder).map_err(|source| self.write_error(source))?;
        let encoded = joined.unwrap_or_else(|_| Err("the encoder panicked".to_owned()));
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

/// Where a picture may go that is not finished: its own place, or beside what is there and finished, as `name.incomplete.exr`.
fn beside_finished(target: &Path) -> PathBuf {
    let part = |part: Option<&OsStr>| part.unwrap_or_default().to_os_string();
    let [stem, ending] = [part(target.file_stem()), part(target.extension())];
    let candidates = (0..).map(|number| {
        let mut name = stem.clone();
        match number {
            0 => {}
            1 => name.push(".incomplete"),
            _ => name.push(format!(".incomplete-{number}")),
        }
        name.push(".");
        name.push(&ending);
        target.with_file_name(name)
    });
    let mut free = candidates.take(MOST_BESIDE).filter(|path| !is_finished(path));
    free.next().unwrap_or_else(|| target.to_owned())
}

/// Whether what stands there is to be kept: anything but a picture that says that its render broke off.
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
    let read = input::open_own(path).and_then(|mut file| {
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
mod tests {
    use exr::meta::MetaData;
    use exr::meta::attribute::AttributeValue;
    use exr::prelude::{Text, Vec2};

    use super::*;
    use crate::output::{Display, Exposure, ExrCompression, ExrOptions, Provenance, ToneCurve, read_image, srgb_byte};
    use crate::scene::settings::SETTINGS;
    use crate::scene::{Filter, RenderSettings};

    fn spec(width: u32, height: u32, spp: u32) -> PictureSpec {
        let settings = RenderSettings { spp, seed: u32::MAX, ..RenderSettings::default() };
        let provenance = Provenance {
            scene: "küche 厨房".to_owned(),
            scene_hash: "0123abcd".to_owned(),
            settings,
            filter: Filter::default(),
            first_sample: 128,
            target_error: None,
            adaptive: false,
            device: "a device".to_owned(),
        };
        PictureSpec { width, height, display: Display::CLIP, provenance: Some(provenance), ..PictureSpec::default() }
    }

    fn value(x: u32, y: u32) -> [f32; 3] {
        [x as f32 * 0.1 - 1.0, 1e6 / (y + 1) as f32, (x * y) as f32 * 1e-6]
    }

    fn band(first_row: u32, rows: u32, width: u32, samples: u32) -> Arc<Band> {
        let mean = (first_row..first_row + rows).flat_map(|y| (0..width).map(move |x| value(x, y))).collect();
        Arc::new(Band { first_row, width, rows, samples, mean, ..Band::default() })
    }

    #[test]
    fn an_exr_comes_back_bit_by_bit_with_its_attributes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(37, 41, 64)).unwrap();
        for (first_row, rows) in [(0, 5), (5, 30), (35, 6)] {
            file.write_band(&band(first_row, rows, 37, 64)).unwrap();
        }
        file.finish().unwrap();

        let image = read_image(&path).unwrap();
        assert_eq!((image.width, image.height), (37, 41));
        for (index, pixel) in image.pixels.iter().enumerate() {
            assert_eq!(*pixel, value(index as u32 % 37, index as u32 / 37), "pixel {index}");
        }
        let meta = MetaData::read_from_file(&path, true).unwrap();
        let header = &meta.headers[0];
        assert_eq!(header.shared_attributes.chromaticities.unwrap().red, Vec2(0.64, 0.33));
        let attribute = |name: &str| header.own_attributes.other[&Text::from(name)].clone();
        assert_eq!(attribute("gpt:scene"), AttributeValue::Text(Text::from("küche ??")));
        assert_eq!(attribute("gpt:seed"), AttributeValue::Text(Text::from("4294967295")));
        assert_eq!(attribute("gpt:sampler"), AttributeValue::Text(Text::from("sobol")));
        for setting in SETTINGS {
            assert!(header.own_attributes.other.contains_key(&Text::from(setting.header)), "{}", setting.header);
        }
        assert_eq!(attribute("gpt:lightSampling"), AttributeValue::Text(Text::from("cone")));
        assert_eq!(attribute("gpt:maxDepth"), AttributeValue::I32(16));
        assert_eq!(attribute("gpt:device"), AttributeValue::Text(Text::from("a device")));
        assert_eq!(attribute("gpt:firstSample"), AttributeValue::I32(128));
        assert_eq!(attribute("gpt:samples"), AttributeValue::I32(64));
        assert_eq!(attribute("gpt:complete"), AttributeValue::I32(1));
    }

    #[test]
    fn an_unfinished_render_says_so_and_is_black_where_nothing_came() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        for (rows_rendered, samples_expected) in [(20, 0), (40, 7)] {
            let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(8, 40, 64)).unwrap();
            file.write_band(&band(0, 10, 8, 64)).unwrap();
            file.write_band(&band(10, rows_rendered - 10, 8, 7)).unwrap();
            file.finish().unwrap();
            let image = read_image(&path).unwrap();
            let black = image.pixels.iter().filter(|pixel| **pixel == [0.0; 3]).count();
            assert_eq!(black, (40 - rows_rendered as usize) * 8);
            let meta = MetaData::read_from_file(&path, true).unwrap();
            let attribute = |name: &str| meta.headers[0].own_attributes.other[&Text::from(name)].clone();
            assert_eq!(attribute("gpt:samples"), AttributeValue::I32(samples_expected));
            assert_eq!(attribute("gpt:samplesWanted"), AttributeValue::I32(64));
            assert_eq!(attribute("gpt:complete"), AttributeValue::I32(0));
        }
    }

    #[test]
    fn equal_pictures_are_equal_files() {
        let folder = tempfile::tempdir().unwrap();
        // Ten attributes in the order of a hash map agree by chance once in millions.
        for format in ["exr", "png", "jpg", "hdr"] {
            let [a, b] = ["a", "b"].map(|name| {
                let path = folder.path().join(name).with_extension(format);
                let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec(64, 40, 8)).unwrap();
                file.write_band(&band(0, 40, 64, 8)).unwrap();
                file.finish().unwrap();
                std::fs::read(&path).unwrap()
            });
            assert!(a == b, "{format}");
        }
    }

    #[test]
    fn pixels_that_differ_in_their_samples_carry_them() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        let counts: Vec<u32> = (0..8 * 40).map(|pixel| if pixel < 100 { 7 } else { 3 }).collect();
        let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec(8, 40, 64)).unwrap();
        for (first_row, pixels) in [(0, 0..160), (20, 160..320)] {
            let band = Band::clone(&band(first_row, 20, 8, 3));
            file.write_band(&Arc::new(Band { counts: Some(counts[pixels].to_vec()), ..band })).unwrap();
        }
        file.finish().unwrap();
        let image = exr::prelude::read_first_flat_layer_from_file(&path).unwrap();
        let channels = &image.layer_data.channel_data.list;
        assert_eq!(channels.iter().map(|channel| channel.name.to_string()).collect::<Vec<_>>(), ["B", "G", "R", "SampleCount"]);
        let found: Vec<u32> = channels[3].sample_data.values_as_f32().map(|count| count as u32).collect();
        assert_eq!(found, counts);
        assert_eq!(read_image(&path).unwrap().pixels[5], value(5, 0));
    }

    /// In its own place only where no finished picture is.
    #[test]
    fn a_picture_that_broke_off_replaces_no_finished_one() {
        let folder = tempfile::tempdir().unwrap();
        let write = |name: &str, samples: u32, is_finished: bool| {
            let path = folder.path().join(name);
            let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec(8, 40, 64)).unwrap();
            file.write_band(&band(0, 40, 8, samples)).unwrap();
            let place = if is_finished { file.finish().map(|()| path) } else { file.finish_broken_off() };
            place.unwrap().file_name().unwrap().to_str().unwrap().to_owned()
        };
        for ending in ["exr", "png", "jpg", "hdr"] {
            let [a, beside] = [format!("a.{ending}"), format!("a.incomplete.{ending}")];
            // Fewer samples than wanted, as a time limit leaves them, are no break.
            for (samples, is_finished, place) in
                [(3, false, &a), (4, false, &a), (5, true, &a), (6, false, &beside), (7, false, &beside), (8, true, &a)]
            {
                assert_eq!(write(&a, samples, is_finished), *place, "{samples} samples");
            }
            assert_eq!(write(&beside, 9, true), beside);
            assert_eq!(write(&a, 10, false), format!("a.incomplete-2.{ending}"));
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 4 * 3);
    }

    #[test]
    fn a_png_holds_the_exposed_picture_in_srgb() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let display = Display { exposure: Exposure::Stops(-2.0), ..Display::CLIP };
        let spec = PictureSpec { display, ..spec(30, 20, 1) };
        let mut file = PictureFile::create(&path, PictureFormat::Png, &spec).unwrap();
        file.write_band(&band(0, 20, 30, 1)).unwrap();
        file.finish().unwrap();
        let decoded = image::open(&path).unwrap().into_rgb8();
        for (x, y, pixel) in decoded.enumerate_pixels() {
            assert_eq!(pixel.0, value(x, y).map(|radiance| srgb_byte(radiance / 4.0)));
        }
        let bytes = std::fs::read(&path).unwrap();
        assert!(bytes.windows(4).any(|window| window == b"sRGB"));
    }

    /// Of the whole picture, whose last rows are brighter by far; as JPEG, with its losses, as well.
    #[test]
    fn automatic_exposure_sees_the_whole_picture() {
        let folder = tempfile::tempdir().unwrap();
        let grey = |rows: u32, first_row, value: f32| {
            let mean = vec![[value; 3]; rows as usize * 16];
            Arc::new(Band { first_row, width: 16, rows, samples: 1, mean, ..Band::default() })
        };
        for (name, tolerance) in [("a.png", 0), ("a.jpg", 3)] {
            let path = folder.path().join(name);
            let display = Display { exposure: Exposure::Auto, ..Display::CLIP };
            let spec = PictureSpec { display, ..spec(16, 32, 1) };
            let mut file = PictureFile::create(&path, PictureFormat::from_path(&path).unwrap(), &spec).unwrap();
            file.write_band(&grey(16, 0, 0.01)).unwrap();
            file.write_band(&grey(16, 16, 1.0)).unwrap();
            file.finish().unwrap();
            // The geometric mean, 0.1, becomes 0.18.
            let decoded = image::open(&path).unwrap().into_rgb8();
            for (row, value) in [(0, 0.018), (31, 1.8)] {
                let found = decoded.get_pixel(3, row).0[1];
                assert!(found.abs_diff(srgb_byte(value)) <= tolerance, "{name}, row {row}: {found}");
            }
        }
    }

    #[test]
    fn tone_curves_show_in_the_picture() {
        let folder = tempfile::tempdir().unwrap();
        let mut bytes = Vec::new();
        for tone_curve in ToneCurve::ALL {
            let path = folder.path().join("a.png");
            let spec = PictureSpec { display: Display { tone_curve, ..Display::CLIP }, ..spec(30, 20, 1) };
            let mut file = PictureFile::create(&path, PictureFormat::Png, &spec).unwrap();
            file.write_band(&band(0, 20, 30, 1)).unwrap();
            file.finish().unwrap();
            bytes.push(image::open(&path).unwrap().into_rgb8().into_raw());
        }
        assert!(bytes[0] != bytes[1] && bytes[1] != bytes[2] && bytes[0] != bytes[2]);
    }

    /// Without loss, but for pxr24 and for halves, which keep 16 and 11 bits.
    #[test]
    fn exr_files_keep_what_their_options_promise() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        for compression in ExrCompression::ALL {
            for half in [false, true] {
                let spec = PictureSpec { exr: ExrOptions { half, compression }, ..spec(37, 20, 1) };
                let mut file = PictureFile::create(&path, PictureFormat::Exr, &spec).unwrap();
                file.write_band(&band(0, 20, 37, 1)).unwrap();
                file.finish().unwrap();
                let tolerance = match (half, compression) {
                    (true, _) => 2.0_f32.powi(-11),
                    (false, ExrCompression::Pxr24) => 2.0_f32.powi(-16),
                    (false, _) => 0.0,
                };
                for (index, found) in read_image(&path).unwrap().pixels.iter().enumerate() {
                    let wanted = value(index as u32 % 37, index as u32 / 37);
                    for (found, wanted) in found.iter().zip(wanted) {
                        let wanted = if half { wanted.min(65_504.0) } else { wanted };
                        let error = (found - wanted).abs();
                        // Below 2^-14, halves have steps of 2^-24.
                        assert!(
                            error <= tolerance * wanted.abs() + if half { 3e-8 } else { 0.0 },
                            "{compression:?} {half}: {found} {wanted}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_radiance_file_is_read_back_within_its_eight_bits() {
        let folder = tempfile::tempdir().unwrap();
        // Rows of fewer than 8 pixels are written another way.
        for width in [5, 300] {
            let path = folder.path().join("a.hdr");
            let mut file = PictureFile::create(&path, PictureFormat::Hdr, &spec(width, 20, 1)).unwrap();
            file.write_band(&band(0, 20, width, 1)).unwrap();
            file.finish().unwrap();
            for (index, found) in read_image(&path).unwrap().pixels.iter().enumerate() {
                let wanted = value(index as u32 % width, index as u32 / width).map(|channel| channel.max(0.0));
                let largest = wanted.into_iter().fold(0.0, f32::max);
                for (found, wanted) in found.iter().zip(wanted) {
                    assert!((found - wanted).abs() <= largest / 128.0, "{index}: {found} {wanted}");
                }
            }
        }
    }

    #[test]
    fn a_broken_off_render_leaves_no_file_and_bad_bands_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for (name, format) in [("a.exr", PictureFormat::Exr), ("a.png", PictureFormat::Png), ("a.jpg", PictureFormat::Jpeg)] {
            let mut file = PictureFile::create(&folder.path().join(name), format, &spec(8, 40, 64)).unwrap();
            file.write_band(&band(0, 10, 8, 64)).unwrap();
            assert!(file.write_band(&band(5, 10, 8, 64)).is_err(), "an overlap");
            assert!(file.write_band(&band(10, 10, 7, 64)).is_err(), "another width");
            assert!(file.write_band(&band(30, 11, 8, 64)).is_err(), "past the end");
            drop(file);
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
