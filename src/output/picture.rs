//! One picture file in the making: a thread encodes and writes while the render goes on.

use std::io::{BufWriter, Error};
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::{self, JoinHandle};

use super::atomic::AtomicFile;
use super::error::OutputError;
use super::format::PictureFormat;
use super::rows::{Message, Rows};
use super::spec::PictureSpec;
use super::{exr_file, png_file};
use crate::film::Band;

/// Bands that wait for the encoder; with the one it works on and the one being rendered, this bounds the memory.
const WAITING_BANDS: usize = 1;

/// A file that takes bands and appears, whole, at [`PictureFile::finish`]. Dropped before that, it leaves nothing.
pub struct PictureFile {
    file: AtomicFile,
    messages: SyncSender<Message>,
    /// None once it was joined.
    encoder: Option<JoinHandle<Result<(), String>>>,
    rows_taken: u32,
    spec: PictureSpec,
}

impl PictureFile {
    /// Begins the file; `format` is what the path's ending asked for.
    ///
    /// # Errors
    /// As [`AtomicFile::create`].
    pub fn create(path: &Path, format: PictureFormat, spec: &PictureSpec) -> Result<Self, OutputError> {
        let file = AtomicFile::create(path)?;
        let writer = BufWriter::with_capacity(1 << 18, file.handle()?);
        let (messages, receiver) = sync_channel(WAITING_BANDS);
        let rows = Rows::new(receiver, spec.width);
        let encoder_spec = spec.clone();
        let encoder = thread::spawn(move || match format {
            PictureFormat::Exr => exr_file::write(writer, rows, &encoder_spec),
            PictureFormat::Png => png_file::write(writer, rows, &encoder_spec),
        });
        Ok(Self { file, messages, encoder: Some(encoder), rows_taken: 0, spec: spec.clone() })
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
        let sent = self.messages.send(Message::Band(band.clone()));
        sent.map_err(|_| {
            Error::other(self.join_encoder().err().unwrap_or_else(|| self.encode_error("the encoder stopped early")))
        })
    }

    /// Finishes the file with what came, black where nothing came, and puts it in its place.
    ///
    /// # Errors
    /// What the encoder or the file system said.
    pub fn finish(mut self) -> Result<(), OutputError> {
        // An encoder that is gone has an error to tell, which joining it brings.
        let _ = self.messages.send(Message::Finish);
        self.join_encoder()?;
        self.file.commit()
    }

    /// Waits for the encoder, which must be about to end, and tells how it went.
    fn join_encoder(&mut self) -> Result<(), OutputError> {
        let encoder = self.encoder.take().ok_or_else(|| self.encode_error("writing failed before"))?;
        let encoded = encoder.join().unwrap_or_else(|_| Err("the encoder panicked".to_owned()));
        encoded.map_err(|what| self.encode_error(&what))
    }

    fn encode_error(&self, what: &str) -> OutputError {
        OutputError::Encode { path: self.file.path().to_owned(), what: what.to_owned() }
    }
}

#[cfg(test)]
mod tests {
    use exr::meta::MetaData;
    use exr::meta::attribute::AttributeValue;
    use exr::prelude::{Text, Vec2};

    use super::*;
    use crate::output::{Provenance, read_image, srgb_byte};
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
        PictureSpec { width, height, exposure: 0.0, provenance: Some(provenance) }
    }

    fn value(x: u32, y: u32) -> [f32; 3] {
        [x as f32 * 0.1 - 1.0, 1e6 / (y + 1) as f32, (x * y) as f32 * 1e-6]
    }

    fn band(first_row: u32, rows: u32, width: u32, samples: u32) -> Arc<Band> {
        let mean = (first_row..first_row + rows).flat_map(|y| (0..width).map(move |x| value(x, y))).collect();
        Arc::new(Band { first_row, width, rows, samples, mean, second_moment: vec![] })
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
    fn a_png_holds_the_exposed_picture_in_srgb() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        let spec = PictureSpec { exposure: -2.0, ..spec(30, 20, 1) };
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

    #[test]
    fn a_broken_off_render_leaves_no_file_and_bad_bands_are_refused() {
        let folder = tempfile::tempdir().unwrap();
        for (name, format) in [("a.exr", PictureFormat::Exr), ("a.png", PictureFormat::Png)] {
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
