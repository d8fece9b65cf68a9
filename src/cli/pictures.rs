//! The files of one render together, and what is learned of the picture while it passes.

use std::io::{self, IsTerminal};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use gpt::film::Band;
use gpt::output::{OutputError, PICTURE_ENDINGS, PictureFile, PictureFormat, PictureSpec};

use super::exit::Failure;
use super::outputs;
pub use super::outputs::is_stdout;

/// All picture files of a render.
pub struct Pictures {
    files: Vec<PictureFile>,
    /// Errors of files that could not be written; the others go on.
    failures: Vec<OutputError>,
    bands: u64,
    pixels: u64,
    sum: [f64; 3],
    samples: Option<[u32; 2]>,
    black: bool,
    waiting: Duration,
}

/// A summary of the finished pictures.
pub struct PictureSummary {
    /// Files that are in their places.
    pub places: Vec<PathBuf>,
    /// Files that are not.
    pub failures: Vec<OutputError>,
    /// Mean radiance of the pixels that were rendered.
    pub mean: [f64; 3],
    /// Samples of the pixels that have fewest (on average, where samples follow the noise) and most, of those that were rendered.
    pub samples: [u32; 2],
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
            failures: Vec::new(),
            bands: 0,
            pixels: 0,
            sum: [0.0; 3],
            samples: None,
            black: true,
            waiting: Duration::ZERO,
        })
    }

    /// Passes a band on to every file that can still be written.
    ///
    /// # Errors
    /// None of them can.
    pub fn write_band(&mut self, band: Band) -> io::Result<()> {
        let start = Instant::now();
        self.bands += 1;
        self.pixels += band.mean.len() as u64;
        let of_band = samples_of(&band);
        let [fewest, most] = self.samples.unwrap_or(of_band);
        self.samples = Some([fewest.min(of_band[0]), most.max(of_band[1])]);
        for pixel in &band.mean {
            for (sum, value) in self.sum.iter_mut().zip(pixel) {
                *sum += f64::from(*value);
            }
        }
        self.black &= band.mean.iter().all(|pixel| *pixel == [0.0; 3]);
        let band = Arc::new(band);
        let failures = &mut self.failures;
        self.files.retain_mut(|file| match file.write_band(&band) {
            Ok(()) => true,
            Err(source) => {
                failures.push(OutputError::Write { path: file.path().to_owned(), source });
                false
            }
        });
        self.waiting += start.elapsed();
        if self.files.is_empty() {
            // There is nobody left to render for.
            return Err(io::Error::other("no picture file can be written"));
        }
        Ok(())
    }

    /// True if anything was rendered.
    pub fn any(&self) -> bool {
        self.bands > 0
    }

    /// Files that could not be written so far.
    pub fn take_failures(&mut self) -> Vec<OutputError> {
        std::mem::take(&mut self.failures)
    }

    /// Gives up the files in whose places finished pictures are: what they would hold is kept elsewhere.
    pub fn give_up_beside_finished(&mut self) {
        self.files.retain(|file| !file.has_finished_one());
    }

    /// Puts the files in their places, unless nothing was rendered. `broke_off`: the render did, and finished pictures that are there stay.
    pub fn finish(self, broke_off: bool) -> PictureSummary {
        let start = Instant::now();
        let (mut places, mut failures) = (Vec::new(), self.failures);
        for file in self.files.into_iter().filter(|_| self.bands > 0) {
            let path = file.path().to_owned();
            match if broke_off { file.finish_broken_off() } else { file.finish().map(|()| path) } {
                Ok(place) => places.push(place),
                Err(failure) => failures.push(failure),
            }
        }
        PictureSummary {
            places,
            failures,
            mean: self.sum.map(|sum| sum / self.pixels.max(1) as f64),
            samples: self.samples.unwrap_or_default(),
            black: self.black,
            seconds_writing: (self.waiting + start.elapsed()).as_secs_f64(),
        }
    }
}

/// Fewest and most samples of a band's pixels; for the fewest, what is spent on average where samples follow the noise.
fn samples_of(band: &Band) -> [u32; 2] {
    let most = band.counts.iter().flatten().copied().max();
    [band.samples, most.unwrap_or(band.samples)]
}

/// The formats that the paths' endings ask for, once it is sure that files can be put there. `-` is standard output, as EXR. `others`: files that are
/// written beside the pictures. `inputs`: files that are read.
///
/// # Errors
/// Usage errors for unknown endings, and as [`outputs::check`].
pub fn output_formats<'a>(
    paths: &'a [PathBuf],
    others: impl IntoIterator<Item = &'a Path>,
    inputs: impl IntoIterator<Item = &'a Path>,
) -> Result<Vec<(PathBuf, PictureFormat)>, Failure> {
    let mut formats = Vec::with_capacity(paths.len());
    for path in paths {
        let format = if is_stdout(path) { Some(PictureFormat::Exr) } else { PictureFormat::from_path(path) };
        let format = format.ok_or_else(|| Failure::Usage {
            message: format!("{}: the ending names no picture format", path.display()),
            help: Some(format!("endings that work: {PICTURE_ENDINGS}; - is standard output, as EXR")),
        })?;
        if is_stdout(path) && io::stdout().is_terminal() {
            return Err(Failure::usage(
                "-o - writes a picture to standard output, which is a terminal here: send it to a file or a program",
            ));
        }
        formats.push((path.clone(), format));
    }
    outputs::check(paths.iter().map(PathBuf::as_path).chain(others), inputs)?;
    Ok(formats)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn endings_duplicates_and_folders_are_checked() {
        let paths = |names: &[&str]| names.iter().map(PathBuf::from).collect::<Vec<_>>();
        let formats = output_formats(&paths(&["a.exr", "b.PNG"]), None, None).unwrap();
        assert_eq!(formats.iter().map(|(_, format)| *format).collect::<Vec<_>>(), [PictureFormat::Exr, PictureFormat::Png]);
        assert!(matches!(output_formats(&paths(&["a.tif"]), None, None), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["a.exr", "b.exr", "./a.exr"]), None, None), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["a.exr"]), Some(Path::new("a.exr")), None), Err(Failure::Usage { .. })));
        assert!(matches!(output_formats(&paths(&["-"]), Some(Path::new("-")), None), Err(Failure::Usage { .. })));
        let input = std::iter::once(Path::new("./a.exr"));
        assert!(matches!(output_formats(&paths(&["a.exr"]), None, input), Err(Failure::Output(OutputError::Input { .. }))));
        assert!(matches!(output_formats(&paths(&["no/such/folder/a.exr"]), None, None), Err(Failure::Output(_))));
    }
}
