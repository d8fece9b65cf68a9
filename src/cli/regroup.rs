//! `gpt regroup`

use std::path::{Path, PathBuf};
use std::sync::Arc;

use clap::Args;
use gpt::film::{Band, Layer};
use gpt::output::{OutputError, PictureFile, PictureFormat, PictureSpec};
use gpt::regroup::{GroupWeight, GroupedPicture, RegroupError, Regrouped};

use super::exit::{Exit, Failure};
use super::picture_arguments::DisplayArguments;
use super::pictures::output_formats;
use super::terminal;

#[derive(Debug, Args)]
pub struct RegroupArguments {
    /// The picture (.exr) with light groups, as `gpt render --aov groups` makes it
    #[arg(value_name = "IN.exr")]
    pub picture: PathBuf,
    /// A light group and what its light is multiplied by: a factor (2, 0.5, 0 for none), an sRGB colour (#ffddaa), which multiplies by its components in linear light, or both (2,#ffddaa); may be given once for each group, and others stay as they are
    #[arg(short, long = "group", value_name = "NAME=FACTOR,#RRGGBB", required = true, value_parser = str::parse::<GroupWeight>)]
    pub groups: Vec<GroupWeight>,
    /// Picture to write: .exr (linear float, with the groups as they are now), .hdr, .png or .jpg (sRGB preview), or - (standard output, EXR); may be given several times
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub display: DisplayArguments,
}

/// Weighs the light groups of a picture anew.
pub fn run(arguments: &RegroupArguments) -> Result<Exit, Failure> {
    let path = arguments.picture.as_path();
    let outputs = output_formats(&arguments.outputs, None, Some(path))?;
    let failure = |error| match error {
        RegroupError::Read(error) => Failure::Picture(error),
        error @ (RegroupError::Unknown { .. } | RegroupError::Twice(_)) => {
            Failure::usage(format!("--group: {}: {error}", path.display()))
        }
        error @ RegroupError::Temporary(_) => Failure::Other(error.to_string()),
        error => Failure::BadScene(format!("{}: {error}", path.display())),
    };
    let grouped = GroupedPicture::read(path).map_err(failure)?;
    grouped.notes.iter().for_each(|note| terminal::warn(&format!("{}: {note}", path.display())));
    let regrouped = grouped.weighed(&arguments.groups).map_err(failure)?;
    if let Some(left_out) = left_out(&regrouped.dropped) {
        terminal::note(&left_out);
    }
    let Regrouped { picture, layers, layer_names, header, placed, .. } = regrouped;
    let (width, height) = (picture.width, picture.height);
    let spec = PictureSpec {
        width,
        height,
        display: arguments.display.display(),
        layers,
        layer_names,
        notes: header,
        placed,
        ..PictureSpec::default()
    };
    let band = Arc::new(Band { width, rows: height, mean: picture.pixels, ..Band::default() });
    for (output, format) in &outputs {
        write(output, *format, &spec, &band)?;
    }
    Ok(Exit::Done)
}

fn write(path: &Path, format: PictureFormat, spec: &PictureSpec, band: &Arc<Band>) -> Result<(), OutputError> {
    let mut file = PictureFile::create(path, format, spec)?;
    file.write_band(band).map_err(|source| OutputError::Write { path: path.to_owned(), source })?;
    file.finish()
}

/// A sentence about layers that are left out.
fn left_out(dropped: &[Layer]) -> Option<String> {
    let names = Layer::list(dropped);
    (!dropped.is_empty()).then(|| format!("layers of the light as it was are left out: {}", names.replace(',', ", ")))
}
