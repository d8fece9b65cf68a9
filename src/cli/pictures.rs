//! The files of one render together, and what is learned of the picture while it passes.

use std::io;
use std::path::{Path, PathBuf, absolute};
use std::sync::Arc;
use std::time::{Duration, Instant};

use gpt::film::Band;
use gpt::output::{OutputError, PictureFile, PictureFormat, PictureSpec, check_target};

use super::exit::Failure;

/// All picture files of a render.
pub struct Pictures {
    files: Vec<PictureFile>,
    bands: u64,
    pixels: u64,
    sum: [f64; 3],
    fewest_samples: u32,
    black: bool,
    waiting: Duration,
}

/// What the whole picture was like.
pub struct PictureSummary {
    /// Mean radiance of the pixels that were rendered.
    pub mean: [f64; 3],
    /// Samples per pixel of the band that has fewest, of those that came.
    pub fewest_samples: u32,
    /// No pixel has any light.
    pub black: bool,
    /// Time the render waited for the files.
    pub seconds_writing: f64,
}

impl Pictures {
    /// Begins the files.
    ///
    /// # Errors
    /// The first one that cannot be begun.
    pub fn create(outputs: &[(PathBuf, PictureFormat)], spec: &PictureSpec) -> Result<Self, OutputError> {
        let files: Result<_, _> = outputs.iter().map(|(path, format)| PictureFile::create(path, *format, spec)).collect();
        Ok(Self {
            files: files?,
            bands: 0,
            pixels: 0,
            sum: [0.0; 3],
            fewest_samples: u32::MAX,
            black: true,
            waiting: Duration::ZERO,
        })
    }

    /// Passes a band on to every file.
    ///
    /// # Errors
    /// The first file that cannot take it.
    pub fn write_band(&mut self, band: Band) -> io::Result<()> {
        let start = Instant::now();
        self.bands += 1;
        self.pixels += band.mean.len() as u64;
        self.fewest_samples = self.fewest_samples.min(band.samples);
        for pixel in &band.mean {
            for (sum, value) in self.sum.iter_mut().zip(pixel) {
                *sum += f64::from(*value);
            }
        }
        self.black &= band.mean.iter().all(|pixel| *pixel == [0.0; 3]);
        let band = Arc::new(band);
        for file in &mut self.files {
            file.write_band(&band)?;
        }
        self.waiting += start.elapsed();
        Ok(())
    }

    /// Whether anything was rendered.
    pub fn any(&self) -> bool {
        self.bands > 0
    }

    /// Puts the files in their places, unless nothing was rendered.
    ///
    /// # Errors
    /// The first file that cannot be finished.
    pub fn finish(self) -> Result<PictureSummary, OutputError> {
        let start = Instant::now();
        if self.bands > 0 {
            for file in self.files {
                file.finish()?;
            }
        }
        Ok(PictureSummary {
            mean: self.sum.map(|sum| sum / self.pixels.max(1) as f64),
            fewest_samples: if self.bands > 0 { self.fewest_samples } else { 0 },
            black: self.black,
            seconds_writing: (self.waiting + start.elapsed()).as_secs_f64(),
        })
    }
}

/// The formats that the paths' endings ask for, once it is sure that files can be put there.
///
/// # Errors
/// Usage errors for unknown endings and for a file named twice; missing folders.
pub fn output_formats(paths: &[PathBuf], stats: Option<&Path>) -> Result<Vec<(PathBuf, PictureFormat)>, Failure> {
    let mut outputs = Vec::with_capacity(paths.len());
    for path in paths {
        let format = PictureFormat::from_path(path).ok_or_else(|| Failure::Usage {
            message: format!("{}: the ending names no picture format", path.display()),
            help: Some("endings that work: .exr (linear float), .png (sRGB preview)".to_owned()),
        })?;
        outputs.push((path.clone(), format));
    }
    let mut targets: Vec<_> =
        paths.iter().map(PathBuf::as_path).chain(stats).map(|path| absolute(path).unwrap_or_else(|_| path.to_owned())).collect();
    targets.sort();
    if let Some(twice) = targets.windows(2).find(|pair| pair[0] == pair[1]) {
        return Err(Failure::usage(format!("{} is named twice", twice[0].display())));
    }
    for path in paths.iter().map(PathBuf::as_path).chain(stats) {
        check_target(path)?;
    }
    Ok(outputs)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_duplicates_and_folders_are_checked() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let formats = output_formats(&paths(&["a.exr", "b.PNG"]), None).unwrap();
        assert_eq!(formats.iter().map(|(_, format)| *format).collect::<Vec<_>>(), [PictureFormat::Exr, PictureFormat::Png]);
        assert!(matches!(output_formats(&paths(&["a.jpg"]), None), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["a.exr", "b.exr", "./a.exr"]), None), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["a.exr"]), Some(Path::new("a.exr"))), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["no/such/folder/a.exr"]), None), Err(Failure::Output(_))));
    }
}
