//! The arguments of `gpt edit`.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use gpt::load::SceneSource;
use gpt::renderer::DeviceChoice;

use super::super::exit::Failure;
use super::super::file_arguments::FileArguments;
use super::super::setting_flags::SettingFlags;
use super::super::traversal::TraversalArguments;
use super::super::values::{parse_device, parse_seconds, parse_size};

#[derive(Debug, Args)]
pub struct EditArguments {
    /// The scene file to edit (.toml)
    pub scene: OsString,
    #[command(flatten)]
    pub files: FileArguments,
    /// Width and height of the picture in pixels, which the file does not get
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    #[command(flatten)]
    pub settings: SettingFlags,
    /// auto (discrete, integrated, then software GPU; the CPU integrator if there is none), gpu, cpu, or part of an adapter's name
    #[arg(long, default_value = "auto", value_parser = parse_device)]
    pub device: DeviceChoice,
    /// Take a device for lost that does not finish a submission, of a second at most, in this time [default: 60; 300 on software devices]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub device_timeout: Option<Duration>,
    #[command(flatten)]
    pub traversal: TraversalArguments,
}

impl EditArguments {
    /// The scene file.
    ///
    /// # Errors
    /// A usage error for all that is no scene file of this program.
    pub fn file(&self) -> Result<PathBuf, Failure> {
        let name = self.scene.to_string_lossy();
        let (message, help) = match SceneSource::parse(Some(&self.scene))? {
            SceneSource::File(path) => return Ok(path),
            SceneSource::BuiltIn(name) => {
                (format!("{name} is a built-in scene"), format!("gpt scenes {name} > {name}.toml makes a file of it"))
            }
            SceneSource::StandardInput => {
                ("what comes on standard input cannot be saved".to_owned(), "write it to a file, and edit that".to_owned())
            }
            SceneSource::Model(_) | SceneSource::Import(_) => {
                let help = format!("gpt import {name} -o SCENE.toml makes a scene file of it, which can be edited");
                (format!("{name} is a file of another program; scene files, .toml, can be edited"), help)
            }
        };
        Err(Failure::Usage { message, help: Some(help) })
    }
}

#[cfg(test)]
mod tests {
    use clap::{Command, FromArgMatches};

    use super::*;

    #[test]
    fn scene_files_are_edited_and_all_else_says_how_to_make_one() {
        let file = |name: &str| {
            let command = EditArguments::augment_args(Command::new("edit").no_binary_name(true));
            let matches = command.try_get_matches_from([name]).expect("valid arguments");
            EditArguments::from_arg_matches(&matches).expect("valid arguments").file()
        };
        assert_eq!(file("a/b.toml").ok(), Some(PathBuf::from("a/b.toml")));
        for (name, advice) in [("cornell", "gpt scenes cornell > cornell.toml"), ("-", "file"), ("a.glb", "gpt import a.glb")] {
            match file(name) {
                Err(Failure::Usage { help: Some(help), .. }) => assert!(help.contains(advice), "{name}: {help}"),
                other => panic!("{name}: {other:?}"),
            }
        }
        assert!(file("no such scene").is_err());
    }
}
