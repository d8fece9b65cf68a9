//! `gpt denoise`, and `gpt render --denoise`.

mod arguments;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use gpt::denoise::bias::Bias;
use gpt::denoise::library::{Library, OidnError};
use gpt::denoise::{Raw, denoise};
use gpt::film::Band;
use gpt::output::{Channels, Display, Image, OutputError, PartSpec, PictureFile, PictureFormat, PictureSpec, read_picture};
use serde::Serialize;

pub use arguments::DenoiseArguments;

use super::exit::{Exit, Failure};
use super::pictures::{is_stdout, output_formats};
use super::terminal;

/// Keys of the header: what denoised a picture, and what that did to it.
pub const DENOISER_KEY: &str = "gpt:denoiser";
pub const BIAS_KEY: &str = "gpt:denoiserBias";

/// The JSON that `--json` prints. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Report<'a> {
    denoiser: &'a str,
    library: String,
    layers: &'a str,
    bias: &'a Bias,
    outputs: Vec<String>,
}

/// Denoises a picture.
pub fn run(arguments: &DenoiseArguments) -> Result<Exit, Failure> {
    let outputs = output_formats(&arguments.outputs, None, Some(arguments.picture.as_path()))?;
    let raw = read_raw(&arguments.picture)?;
    let library = Library::open()?;
    let done = denoise_into(&library, &raw, &outputs, arguments.display.display())?;
    if arguments.json {
        terminal::answer_json(&Report {
            denoiser: &done.denoiser,
            library: library.path().display().to_string(),
            layers: done.layers,
            bias: &done.bias,
            outputs: outputs.iter().map(|(path, _)| path.display().to_string()).collect(),
        })?;
    } else {
        terminal::note(&done.sentence(&outputs));
    }
    Ok(Exit::Done)
}

/// The outcome of denoising.
struct Denoised {
    denoiser: String,
    layers: &'static str,
    bias: Bias,
}

impl Denoised {
    /// The outcome in a sentence for people.
    fn sentence(&self, outputs: &[(PathBuf, PictureFormat)]) -> String {
        let files: Vec<String> = outputs.iter().map(|(path, _)| path.display().to_string()).collect();
        format!("{}: by {}, layers: {}; {}", files.join(", "), self.denoiser, self.layers, self.bias)
    }
}

/// A picture with the layers that help to denoise it.
fn read_raw(picture: &Path) -> Result<Raw, Failure> {
    let read = read_picture(picture)?;
    read.warnings(picture).iter().for_each(|warning| terminal::warn(warning));
    if read.covered[2..].contains(&0) {
        return Err(Failure::BadScene(format!("{}: it has no pixel in its display window", picture.display())));
    }
    Ok(Raw::of(read, &Channels::read(picture)?))
}

/// Denoises a picture, and writes what comes of it.
///
/// # Errors
/// A file that cannot be written, and what the library says.
fn denoise_into(
    library: &Library,
    raw: &Raw,
    outputs: &[(PathBuf, PictureFormat)],
    display: Display,
) -> Result<Denoised, Failure> {
    let denoised = denoise(library, raw)?;
    let bias = Bias::of(raw, &denoised).map_err(|error| Failure::BadScene(error.to_string()))?;
    let denoiser = format!("Open Image Denoise {}", library.version()?);
    let notes = vec![(DENOISER_KEY.to_owned(), denoiser.clone()), (BIAS_KEY.to_owned(), bias.to_string())];
    for (path, format) in outputs {
        write(&denoised, path, *format, (display, notes.clone(), raw.placed))?;
    }
    Ok(Denoised { denoiser, layers: raw.layers(), bias })
}

fn write(
    image: &Image,
    path: &Path,
    format: PictureFormat,
    (display, notes, placed): (Display, Vec<(String, String)>, Option<PartSpec>),
) -> Result<(), OutputError> {
    let Image { width, height, ref pixels } = *image;
    let mut file =
        PictureFile::create(path, format, &PictureSpec { width, height, display, notes, placed, ..PictureSpec::default() })?;
    let band = Band { width, rows: height, mean: pixels.clone(), ..Band::default() };
    file.write_band(&Arc::new(band)).map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
    file.finish()
}

/// The file of a render that denoising reads.
///
/// # Errors
/// Outputs without an EXR file.
pub fn raw_output(outputs: &[(PathBuf, PictureFormat)]) -> Result<&Path, Failure> {
    let raw = outputs.iter().find(|(path, format)| *format == PictureFormat::Exr && !is_stdout(path));
    let missing = || Failure::usage("--denoise: the picture is read from an .exr file, and -o names none");
    raw.map(|(path, _)| path.as_path()).ok_or_else(missing)
}

/// Denoises the pictures of a render that is over: from its EXR file, which has the layers, into one more of each format.
///
/// # Errors
/// A file that cannot be read, and as [`denoise_into`].
pub fn denoise_render(
    library: &Library,
    outputs: &[(PathBuf, PictureFormat)],
    display: Display,
    quiet: bool,
) -> Result<(), Failure> {
    let raw = raw_output(outputs)?;
    let beside = beside(outputs);
    // The next render of the same scene writes it again.
    let picture = read_raw(raw)?;
    let done = denoise_into(library, &picture, &beside, display)?;
    if !quiet {
        terminal::note(&done.sentence(&beside));
    }
    Ok(())
}

/// The name of the denoised picture beside one of a render: `name.denoised.exr` beside `name.exr`.
fn denoised_name(path: &Path) -> PathBuf {
    let mut name = path.file_stem().unwrap_or_default().to_os_string();
    name.push(".denoised.");
    name.push(path.extension().unwrap_or_default());
    path.with_file_name(name)
}

fn beside(outputs: &[(PathBuf, PictureFormat)]) -> Vec<(PathBuf, PictureFormat)> {
    let files = outputs.iter().filter(|(path, _)| !is_stdout(path));
    files.map(|(path, format)| (denoised_name(path), *format)).collect()
}

/// The files that denoising writes beside pictures; none where nothing is denoised.
pub fn files_beside(is_asked_for: bool, outputs: &[PathBuf]) -> Vec<PathBuf> {
    outputs.iter().filter(|path| is_asked_for && !is_stdout(path)).map(|path| denoised_name(path)).collect()
}

impl From<OidnError> for Failure {
    fn from(error: OidnError) -> Self {
        Self::Other(error.to_string())
    }
}
