//! The arguments of `gpt referee`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand, ValueEnum};
use gpt::renderer::DeviceChoice;
use gpt::scene::settings::MOST_SAMPLES;

use crate::cli::values::{parse_device, parse_seconds};

/// Groups of `gpt referee run --help`.
const RENDERER: &str = "The renderer";
const REPORTS: &str = "Reports";

const EXAMPLES: &str = "Examples:
  gpt referee list                                        what is tested, and what decides
  gpt referee run --renderer gpt --device cpu             gpt's reference
  gpt referee run --renderer mitsuba --html mitsuba.html  Mitsuba 3, where python3 has it
  gpt referee run lights textures --command 'mine {scene} -o {output} -s {spp}' --form gltf
  gpt referee export suite && gpt referee run --pictures mine
                                                          pictures made by hand, mine/lights-point.exr and so on";

#[derive(Debug, Args)]
pub struct RefereeArguments {
    #[command(subcommand)]
    pub action: RefereeAction,
}

#[derive(Debug, Subcommand)]
pub enum RefereeAction {
    /// List the tests, each with what it asks and what decides
    List(ListArguments),
    /// Write every test as files that any renderer can use: scenes, true pictures with their errors, and what is tested
    Export(ExportSuiteArguments),
    /// Let a renderer render the suite, and say what it gets wrong; exit code 7 if something is
    #[command(after_help = EXAMPLES)]
    Run(Box<RunArguments>),
}

#[derive(Debug, Args)]
pub struct ListArguments {
    /// Tests or families by their names [default: all]
    #[arg(value_name = "TEST")]
    pub tests: Vec<String>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct ExportSuiteArguments {
    /// Folder to write to, which is made
    #[arg(value_name = "DIR")]
    pub folder: PathBuf,
    /// Tests or families by their names [default: all]
    #[arg(value_name = "TEST")]
    pub tests: Vec<String>,
}

/// Renderers that need no command.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum KnownRenderer {
    /// This program, on --device
    Gpt,
    /// Mitsuba 3, the Python package `mitsuba`, variant llvm_ad_rgb
    Mitsuba,
    /// Mitsuba 3, variant scalar_rgb
    MitsubaScalar,
    /// Blender's Cycles, the Python package `bpy`, which imports glTF
    Cycles,
    /// LuxCore, the Python packages `pyluxcore`, `numpy` and `OpenEXR`, by a part of the scene files of this program
    Luxcore,
}

/// The form in which a scene is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SceneForm {
    /// A scene file of this program
    Toml,
    /// A scene of Mitsuba 3
    Mitsuba,
    /// Binary glTF 2.0
    Gltf,
    /// A scene of pbrt-v4
    Pbrt,
}

#[derive(Debug, Args)]
#[command(group = clap::ArgGroup::new("judged").required(true).args(["renderer", "command", "pictures"]))]
pub struct RunArguments {
    /// Tests or families by their names [default: all]
    #[arg(value_name = "TEST")]
    pub tests: Vec<String>,
    /// A renderer that needs no command
    #[arg(long, value_name = "NAME", help_heading = RENDERER)]
    pub renderer: Option<KnownRenderer>,
    /// A command that renders a test, or ends with status 64 and a reason where it cannot be asked: {scene}, {output} (.exr), {spp}, {seed}, {width} and {height} stand for what they say
    #[arg(long, value_name = "COMMAND", help_heading = RENDERER)]
    pub command: Option<String>,
    /// Pictures that were made before, NAME.exr and, with other random numbers, NAME-2.exr in this folder
    #[arg(long, value_name = "DIR", help_heading = RENDERER)]
    pub pictures: Option<PathBuf>,
    /// The form in which {scene} is written
    #[arg(long, value_name = "FORM", default_value = "toml", help_heading = RENDERER)]
    pub form: SceneForm,
    /// The renderer's name in reports [default: that of --renderer, or the command's first word]
    #[arg(long, value_name = "TEXT", help_heading = RENDERER)]
    pub name: Option<String>,
    /// Samples per pixel of a picture
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES)), help_heading = RENDERER)]
    pub spp: u32,
    /// Pictures of each test, with random numbers of their own; two tell faults of single pixels from noise
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u32).range(1..=64), help_heading = RENDERER)]
    pub runs: u32,
    /// The first tests of each family alone, with 64 samples per pixel
    #[arg(long, help_heading = RENDERER)]
    pub quick: bool,
    /// Give up a picture after this time
    #[arg(long, value_name = "SECONDS", default_value = "120", value_parser = parse_seconds, help_heading = RENDERER)]
    pub timeout: Duration,
    /// Device of `--renderer gpt`: auto, gpu, cpu, or part of an adapter's name
    #[arg(long, default_value = "auto", value_parser = parse_device, help_heading = RENDERER)]
    pub device: DeviceChoice,
    /// The Python that has Mitsuba or Blender
    #[arg(long, value_name = "PROGRAM", default_value = "python3", help_heading = RENDERER)]
    pub python: String,
    /// Differences that are known and meant: lines of `"TEST" = "reason"`; they are listed and no failure
    #[arg(long, value_name = "FILE.toml", help_heading = RENDERER)]
    pub exceptions: Option<PathBuf>,
    /// The probability that a right renderer is said to differ in any test
    #[arg(long, value_name = "P", default_value_t = 0.01, value_parser = parse_probability, help_heading = REPORTS)]
    pub false_alarms: f64,
    /// Print JSON
    #[arg(long, help_heading = REPORTS)]
    pub json: bool,
    /// Write the outcome as JUnit XML, which CI services show
    #[arg(long, value_name = "FILE.xml", help_heading = REPORTS)]
    pub junit: Option<PathBuf>,
    /// Write a page that shows true pictures beside the renderer's
    #[arg(long, value_name = "FILE.html", help_heading = REPORTS)]
    pub html: Option<PathBuf>,
    /// Write a badge
    #[arg(long, value_name = "FILE.svg", help_heading = REPORTS)]
    pub badge: Option<PathBuf>,
    /// Keep scenes and pictures in this folder
    #[arg(long, value_name = "DIR", help_heading = REPORTS)]
    pub keep: Option<PathBuf>,
    /// No progress on stderr
    #[arg(short, long, help_heading = REPORTS)]
    pub quiet: bool,
}

fn parse_probability(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| *number > 0.0 && *number < 1.0);
    number.ok_or_else(|| "expected a number between 0 and 1".to_owned())
}
