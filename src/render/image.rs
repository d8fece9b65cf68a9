//! A picture in memory.

use std::path::Path;
use std::sync::Arc;

use super::progressive::Outcome;
use crate::compare::{self, Comparison};
use crate::error::Error;
use crate::film::{Band, Layer};
use crate::output::{self, LayerChannel, OutputError, PictureFile, PictureFormat, PictureSpec, Provenance, read_picture};

/// A picture: linear Rec. 709 radiance, row by row from the top.
///
/// ```
/// let grey = gpt::Image::from_pixels(4, 2, vec![[0.5; 3]; 8]).expect("as many pixels as that");
/// assert_eq!((grey.width(), grey.pixels()[7]), (4, [0.5; 3]));
/// assert!(gpt::Image::from_pixels(4, 2, Vec::new()).is_none());
/// ```
#[derive(Debug, Clone)]
pub struct Image {
    pixels: output::Image,
    /// The outcome of the render that made the picture; None for a picture that was read.
    rendered: Option<Rendered>,
    /// Warnings about a picture that was read.
    warnings: Vec<String>,
}

/// Facts of a render beside its pixels.
#[derive(Debug, Clone)]
struct Rendered {
    provenance: Provenance,
    outcome: Outcome,
    /// Samples of the pixel that has fewest.
    fewest_samples: u32,
    /// Samples of each pixel, where they may differ.
    counts: Option<Vec<u32>>,
    /// The ends of each pixel's interval, where they were asked for.
    ends: Option<[Vec<[f32; 3]>; 2]>,
    /// The ends of the interval of the picture's mean, where one was asked for.
    picture_ends: Option<[[f64; 3]; 2]>,
}

impl Image {
    /// The picture that bands make together; black where none came.
    pub(super) fn rendered([width, height]: [u32; 2], bands: &[Band], provenance: Provenance, outcome: Outcome) -> Self {
        let mut pixels = vec![[0.0; 3]; width as usize * height as usize];
        let (mut rows, mut fewest_samples) = (0, u32::MAX);
        let mut counts = bands.iter().any(|band| band.counts.is_some()).then(|| vec![0; pixels.len()]);
        let have_ends = bands.iter().any(|band| !band.low.is_empty());
        let mut ends = have_ends.then(|| [vec![[0.0; 3]; pixels.len()], vec![[f32::INFINITY; 3]; pixels.len()]]);
        for band in bands {
            let start = band.first_row as usize * width as usize;
            pixels[start..start + band.mean.len()].copy_from_slice(&band.mean);
            if let (Some(counts), Some(of_band)) = (&mut counts, &band.counts) {
                counts[start..start + of_band.len()].copy_from_slice(of_band);
            }
            if let Some([low, high]) = &mut ends {
                low[start..start + band.low.len()].copy_from_slice(&band.low);
                high[start..start + band.high.len()].copy_from_slice(&band.high);
            }
            rows += band.rows;
            fewest_samples = fewest_samples.min(band.samples);
        }
        let fewest_samples = if rows == height { fewest_samples } else { 0 };
        let pixels = output::Image { width, height, pixels };
        let picture_ends = bands.last().and_then(|band| band.picture_ends);
        let rendered = Rendered { provenance, outcome, fewest_samples, counts, ends, picture_ends };
        Self { pixels, rendered: Some(rendered), warnings: Vec::new() }
    }

    /// A picture of these pixels, row by row from the top; None where there is no pixel, or their number is not `width * height`.
    pub fn from_pixels(width: u32, height: u32, pixels: Vec<[f32; 3]>) -> Option<Self> {
        let is_picture = !pixels.is_empty() && pixels.len() as u64 == u64::from(width) * u64::from(height);
        is_picture.then_some(Self { pixels: output::Image { width, height, pixels }, rendered: None, warnings: Vec::new() })
    }

    /// Reads an OpenEXR file, or a PNG, JPEG, Radiance HDR or another of the common formats, by its content, in its display window. Integers are
    /// taken for sRGB where the file says nothing else.
    ///
    /// # Errors
    /// [`Error::Read`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, Error> {
        let path = path.as_ref();
        let read = read_picture(path)?;
        Ok(Self { warnings: read.warnings(path), pixels: read.image, rendered: None })
    }

    /// Properties that the file of a picture states and nothing uses, such as the shape of pixels, in sentences.
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Columns.
    pub fn width(&self) -> u32 {
        self.pixels.width
    }

    /// Rows.
    pub fn height(&self) -> u32 {
        self.pixels.height
    }

    /// Red, green and blue of every pixel, row by row from the top.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels.pixels
    }

    /// Samples of a pixel of a picture that was rendered.
    #[doc(hidden)]
    pub fn samples(&self, pixel: usize) -> u32 {
        let of = |rendered: &Rendered| rendered.counts.as_ref().map_or(rendered.fewest_samples, |counts| counts[pixel]);
        self.rendered.as_ref().map_or(0, of)
    }

    /// The low and the high ends of all pixels' intervals, row by row from the top, of a picture that was rendered with layers of them
    /// ([`IntervalOptions::layers`](crate::IntervalOptions)).
    pub fn interval_ends(&self) -> Option<&[Vec<[f32; 3]>; 2]> {
        self.rendered.as_ref().and_then(|rendered| rendered.ends.as_ref())
    }

    /// Samples of the pixel that has fewest, of a picture that was rendered.
    pub(super) fn fewest_samples(&self) -> u32 {
        self.rendered.as_ref().map_or(0, |rendered| rendered.fewest_samples)
    }

    /// The fingerprint of the scene of a picture that was rendered.
    pub(super) fn scene_hash(&self) -> Option<&str> {
        self.rendered.as_ref().map(|rendered| rendered.provenance.scene_hash.as_str())
    }

    /// The outcome of the render, for a picture that was rendered.
    pub fn outcome(&self) -> Option<&Outcome> {
        self.rendered.as_ref().map(|rendered| &rendered.outcome)
    }

    /// Writes the picture. The ending names the format: `.exr` holds the values as they are, `.hdr` rounds them to 8 bits
    /// and an exponent, `.png` and `.jpg` are previews in sRGB, tone-mapped by AgX. The file's header
    /// says how a rendered picture was made. The file appears whole or not at all, over an older one of that name.
    ///
    /// # Errors
    /// [`Error::Write`].
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), Error> {
        Ok(self.write(path.as_ref(), PictureSpec::default())?)
    }

    /// Writes the picture as [`Image::save`] does, an EXR file with these layers and entries of the header.
    ///
    /// # Errors
    /// [`Error::Write`].
    #[doc(hidden)]
    pub fn save_with(
        &self,
        path: impl AsRef<Path>,
        (layers, layer_names): (Vec<LayerChannel>, Vec<Layer>),
        notes: Vec<(String, String)>,
    ) -> Result<(), Error> {
        Ok(self.write(path.as_ref(), PictureSpec { layers, layer_names, notes, ..PictureSpec::default() })?)
    }

    fn write(&self, path: &Path, spec: PictureSpec) -> Result<(), OutputError> {
        let format = PictureFormat::from_path(path).ok_or_else(|| OutputError::BadTarget {
            path: path.to_owned(),
            what: "the ending names no picture format; .exr, .hdr, .png and .jpg do",
        })?;
        let output::Image { width, height, ref pixels } = self.pixels;
        let provenance = self.rendered.as_ref().map(|rendered| rendered.provenance.clone());
        let mut file = PictureFile::create(path, format, &PictureSpec { width, height, provenance, ..spec })?;
        let samples = self.fewest_samples();
        let counts = self.rendered.as_ref().and_then(|rendered| rendered.counts.clone());
        let picture_ends = self.rendered.as_ref().and_then(|rendered| rendered.picture_ends);
        let mean = pixels.clone();
        let band = Band { first_row: 0, width, rows: height, samples, counts, mean, picture_ends, ..Band::default() };
        file.write_band(&Arc::new(band)).map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
        file.finish()
    }
}

/// Measures how far a picture is from its reference.
///
/// ```
/// let picture = |grey: f32| gpt::Image::from_pixels(8, 8, vec![[grey; 3]; 64]).expect("as many pixels as that");
/// let comparison = gpt::compare(&picture(0.4), &picture(0.5))?;
/// assert!((comparison.largest.difference - 0.1).abs() < 1e-6);
/// # Ok::<(), gpt::Error>(())
/// ```
///
/// # Errors
/// [`Error::Sizes`].
pub fn compare(image: &Image, reference: &Image) -> Result<Comparison, Error> {
    Ok(compare::compare(&image.pixels, &reference.pixels)?)
}
