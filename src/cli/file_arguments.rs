//! The arguments on files of a scene, in every command that reads scenes.

use std::path::PathBuf;

use clap::Args;
use gpt::load::LoadOptions;

/// Which files a scene may name.
#[derive(Debug, Default, Args)]
pub struct FileArguments {
    /// Refuse files that the scene names outside of this folder, wherever links lead
    #[arg(long, value_name = "DIR", help_heading = "The scene", global = true)]
    pub assets_root: Option<PathBuf>,
}

impl FileArguments {
    /// The options of reading a scene.
    pub fn options(&self, strict: bool) -> LoadOptions {
        LoadOptions { assets_root: self.assets_root.clone(), strict, ..LoadOptions::default() }
    }
}
