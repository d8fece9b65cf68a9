//! The arguments of `gpt test`.

use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use gpt::picture_test::TestSettings;
use gpt::renderer::DeviceChoice;
use gpt::scene::settings::MOST_SAMPLES;

use crate::cli::file_arguments::FileArguments;
use crate::cli::values::{parse_device, parse_seconds};

/// Groups of `gpt test --help`.
const LOOKED_FOR: &str = "What is looked for";
const GOLDEN: &str = "Golden pictures";
const REPORTS: &str = "Reports";
const DEVICE: &str = "Device";

#[derive(Debug, Args)]
pub struct TestArguments {
    /// Folder of scene files (.toml), with their golden pictures in its subfolder `golden`
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Scenes by their names, without the ending [default: all of the folder]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<String>,
    #[command(flatten)]
    pub files: FileArguments,
    /// Make the golden pictures of these scenes, and accept what they show
    #[arg(long, help_heading = GOLDEN, conflicts_with_all = ["update", "candidate_dir"])]
    pub bless: bool,
    /// Make golden pictures where there is none, and where a picture differs; others stay byte for byte
    #[arg(long, help_heading = GOLDEN, conflicts_with = "candidate_dir")]
    pub update: bool,
    /// Test the pictures of another program, SCENE.exr and so on in this folder, in place of rendering
    #[arg(long, value_name = "DIR", help_heading = GOLDEN)]
    pub candidate_dir: Option<PathBuf>,
    /// The change that is to be found, as a share of a tile's energy: 1% or 0.01
    #[arg(long, value_name = "SHARE", default_value = "1%", value_parser = parse_share, help_heading = LOOKED_FOR)]
    pub change: f64,
    /// The probability with which it is found
    #[arg(long, value_name = "P", default_value = "99%", value_parser = parse_share, help_heading = LOOKED_FOR)]
    pub power: f64,
    /// The probability that a run finds a difference, in any of its scenes, where there is none
    #[arg(long, value_name = "P", default_value = "1%", value_parser = parse_share, help_heading = LOOKED_FOR)]
    pub false_alarms: f64,
    /// Pixels along a tile's side
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1024), help_heading = LOOKED_FOR)]
    pub tile: u32,
    /// Samples per pixel that a render takes at most, though larger changes only are found then
    #[arg(long, value_name = "N", default_value_t = 4096, value_parser = clap::value_parser!(u32).range(2..=i64::from(MOST_SAMPLES / 16)), help_heading = LOOKED_FOR)]
    pub max_spp: u32,
    /// Find a difference also where ꟻLIP, 0 to 1, is on average above X; noise counts
    #[arg(long, value_name = "X", value_parser = parse_share, help_heading = LOOKED_FOR)]
    pub flip: Option<f64>,
    /// Other random numbers: another run of the same test
    #[arg(long, value_name = "N", default_value_t = 0, help_heading = LOOKED_FOR)]
    pub seed: u32,
    /// auto (discrete, integrated, then software GPU; the CPU integrator if there is none), gpu, cpu, or part of an adapter's name
    #[arg(long, default_value = "auto", value_parser = parse_device, help_heading = DEVICE)]
    pub device: DeviceChoice,
    /// Fail (exit code 4) where `auto` finds no graphics device, rather than render on the CPU
    #[arg(long, help_heading = DEVICE)]
    pub require_device: bool,
    /// Take a device for lost (exit code 5) that does not finish a submission in this time [default: 60; 300 on software devices]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, help_heading = DEVICE)]
    pub device_timeout: Option<Duration>,
    /// Print JSON
    #[arg(long, help_heading = REPORTS)]
    pub json: bool,
    /// Write the outcome as JUnit XML, which CI services show
    #[arg(long, value_name = "FILE.xml", help_heading = REPORTS)]
    pub junit: Option<PathBuf>,
    /// Write a page that shows the pictures and where they differ [default: gpt-test.html, where something differs]
    #[arg(long, value_name = "FILE.html", help_heading = REPORTS)]
    pub html: Option<PathBuf>,
    /// No progress on stderr
    #[arg(short, long, help_heading = REPORTS)]
    pub quiet: bool,
}

impl TestArguments {
    /// How each of so many scenes is tested: false alarms are those of all together.
    pub fn settings(&self, scenes: usize) -> TestSettings {
        TestSettings {
            change: self.change,
            power: self.power,
            false_alarms: gpt::compare::sidak(self.false_alarms, scenes),
            tile: self.tile,
            most_samples: self.max_spp,
        }
    }
}

/// A share between 0 and 1, which may be written in per cent.
fn parse_share(text: &str) -> Result<f64, String> {
    let (number, factor) = text.strip_suffix('%').map_or((text, 1.0), |number| (number.trim(), 0.01));
    let share = number.parse::<f64>().ok().map(|number| number * factor);
    share
        .filter(|share| *share > 0.0 && *share < 1.0)
        .ok_or_else(|| "expected a share between 0 and 1, or between 0% and 100%".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_are_numbers_or_per_cents() {
        assert_eq!(parse_share("0.25"), Ok(0.25));
        assert_eq!(parse_share("25%"), Ok(0.25));
        for bad in ["0", "1", "100%", "-1%", "nan", "%", "", "1 in 2"] {
            assert!(parse_share(bad).is_err(), "{bad}");
        }
    }
}
