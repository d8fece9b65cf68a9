//! The arguments on files of a scene, in every command that reads scenes.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use gpt::load::LoadOptions;
use gpt::patience;

use super::values::parse_seconds;

/// Which files a scene may name, and how long they are waited for.
#[derive(Debug, Default, Args)]
pub struct FileArguments {
    /// Refuse files that the scene names outside of this folder, wherever links lead
    #[arg(long, value_name = "DIR", help_heading = "The scene", global = true)]
    pub assets_root: Option<PathBuf>,
    /// Give up files whose file system does not answer for so long, when they are read and when they are written
    #[arg(long, value_name = "SECONDS", default_value = "120", value_parser = parse_seconds, help_heading = "The scene", global = true)]
    pub file_timeout: Duration,
}

impl FileArguments {
    /// The options of reading a scene. From now on, files are waited for as long as that is asked for.
    pub fn options(&self, strict: bool) -> LoadOptions {
        patience::set_limit(self.file_timeout);
        LoadOptions { assets_root: self.assets_root.clone(), strict, ..LoadOptions::default() }
    }
}
