//! Which files a scene may name, and what is shown of them.

use clap::Args;
use gpt::load::LoadOptions;
use gpt::scene::CameraPreset;

use super::choice::by_name;
use super::file_arguments::FileArguments;

/// Which files a scene may name, and what is shown of one that holds several things.
#[derive(Debug, Default, Args)]
pub struct AccessArguments {
    #[command(flatten)]
    pub files: FileArguments,
    /// Give a value to a parameter that a Mitsuba file names as $KEY; may be given several times
    #[arg(short = 'D', value_name = "KEY=VALUE", value_parser = parse_definition)]
    pub definitions: Vec<(String, String)>,
    /// Look through this camera of an imported file that has several
    #[arg(long, value_name = "NAME")]
    pub camera: Option<String>,
    /// See the scene so from where its camera stands; without --size, the picture's follows from the height of the scene's
    #[arg(long, value_name = "PROJECTION", value_parser = by_name::<CameraPreset>())]
    pub projection: Option<CameraPreset>,
    /// Show this variant of the materials of a glTF that has several
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
}

impl AccessArguments {
    /// Does the work of [`FileArguments::options`], with what is shown.
    pub fn options(&self, strict: bool) -> LoadOptions {
        LoadOptions {
            definitions: self.definitions.clone(),
            camera: self.camera.clone(),
            preset: self.projection,
            variant: self.variant.clone(),
            ..self.files.options(strict)
        }
    }
}

fn parse_definition(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE")?;
    if key.is_empty() { Err("expected KEY=VALUE".to_owned()) } else { Ok((key.to_owned(), value.to_owned())) }
}
