//! The arguments of `gpt denoise`.

use std::path::PathBuf;

use clap::Args;

use crate::cli::picture_arguments::DisplayArguments;

#[derive(Debug, Args)]
pub struct DenoiseArguments {
    /// The picture (.exr); its layers Albedo and N, as `gpt render --aov albedo,normal` makes them, are used where it has them
    #[arg(value_name = "IN.exr")]
    pub picture: PathBuf,
    /// Denoised picture to write: .exr (linear float), .hdr, .png or .jpg (sRGB preview), or - (standard output, EXR); may be given several times
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
    #[command(flatten)]
    pub display: DisplayArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}
