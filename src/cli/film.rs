//! `--film`: where the film's sums live on a graphics device.

use clap::{Args, ValueEnum};
use gpt::plan::FilmStorage;
use gpt::renderer::DeviceChoice;

use super::exit::Failure;

/// A place, as it is typed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum FilmName {
    /// Textures where the device reads and writes those of four floats, and buffers elsewhere
    #[default]
    Auto,
    /// Textures; refused where the device cannot read and write them
    Textures,
    /// Buffers, which every device has
    Buffers,
}

#[derive(Debug, Default, Args)]
pub struct FilmArguments {
    /// Place of the film's sums on a graphics device
    #[arg(long, value_name = "WHERE", default_value = "auto")]
    film: FilmName,
}

impl FilmArguments {
    /// The storage that a plan is asked for; None leaves the choice to the plan.
    pub fn storage(&self) -> Option<FilmStorage> {
        match self.film {
            FilmName::Auto => None,
            FilmName::Textures => Some(FilmStorage::Texture),
            FilmName::Buffers => Some(FilmStorage::Buffer),
        }
    }

    /// Does the work of [`FilmArguments::storage`] for a command that may run without a graphics device.
    ///
    /// # Errors
    /// A usage error where it is, and a place is asked for.
    pub fn storage_on(&self, device: &DeviceChoice) -> Result<Option<FilmStorage>, Failure> {
        if *device == DeviceChoice::Cpu && self.film != FilmName::Auto {
            return Err(Failure::Usage {
                message: "the CPU reference has one place for the film".to_owned(),
                help: Some("leave out --film, or choose a graphics device; `gpt devices` lists them".to_owned()),
            });
        }
        Ok(self.storage())
    }
}
