//! Radiance's pictures (`.hdr`, `.pic`): RGBE and XYZE, in any orientation, divided by their exposures.

mod header;

use std::io::{Cursor, Read};

use glam::{DMat3, DVec3};
use image::ImageDecoder;
use image::codecs::hdr::HdrDecoder;

use super::pixels::{Sink, linear};
use crate::input::AnyFile;
use crate::scene::ColorSpace;
use header::RadianceHeader;

/// A Radiance picture whose header was read.
pub struct RadianceFile {
    /// At the first scan line.
    file: AnyFile,
    header: RadianceHeader,
    color_space: ColorSpace,
}

impl RadianceFile {
    /// Reads the header.
    ///
    /// # Errors
    /// A file that is no such picture.
    pub fn open(mut file: AnyFile, color_space: Option<ColorSpace>) -> Result<Self, String> {
        let header = RadianceHeader::read(&mut file)?;
        Ok(Self { file, header, color_space: color_space.unwrap_or(ColorSpace::Linear) })
    }

    pub fn size(&self) -> [u32; 2] {
        self.header.resolution.size()
    }

    pub fn notes(&self) -> &[String] {
        &self.header.notes
    }

    /// Answers [`super::PictureFile::converts`].
    pub fn converts(&self) -> bool {
        self.header.matrix.is_some()
    }

    /// Answers [`super::PictureFile::is_plain`].
    pub fn is_plain(&self) -> bool {
        self.header.matrix.is_none() && self.header.resolution.is_usual()
    }

    /// True if the header states a view.
    pub fn has_view(&self) -> bool {
        self.header.has_view
    }

    /// Does the work of [`super::PictureFile::decode`].
    pub fn decode(self, sink: Sink<'_>) -> Result<(), String> {
        let Self { file, header: RadianceHeader { resolution, matrix, .. }, color_space } = self;
        let [lines, length] = resolution.scan_lines();
        // The decoder of scan lines reads one orientation of one header: it is given that.
        let plain = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {lines} +X {length}\n");
        let decoder =
            HdrDecoder::new(Cursor::new(plain).chain(file)).map_err(|error| format!("is not a valid image: {error}"))?;
        let mut pixels = vec![[0.0_f32; 3]; lines as usize * length as usize];
        decoder.read_image(bytemuck::cast_slice_mut(&mut pixels)).map_err(|error| format!("is not a valid image: {error}"))?;
        let finish = |[red, green, blue]: [f32; 3]| {
            let colour = [red, green, blue].map(|value| linear(value, color_space));
            let [red, green, blue] = matrix.map_or(colour, |matrix: DMat3| {
                (matrix * DVec3::from(colour.map(f64::from))).to_array().map(|value| value as f32)
            });
            [red, green, blue, 1.0]
        };
        for (line, pixels) in pixels.chunks_exact(length.max(1) as usize).enumerate() {
            let row: Vec<[f32; 4]> = pixels.iter().map(|pixel| finish(*pixel)).collect();
            if resolution.is_usual() {
                sink([0, line], &row);
            } else {
                row.iter().enumerate().for_each(|(place, pixel)| sink(resolution.place(line as u32, place as u32), &[*pixel]));
            }
        }
        Ok(())
    }
}
