//! The arguments of every command, as clap reads them.

use std::ffi::OsString;
use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Parser, Subcommand};
use gpt::compare::Metric;
use gpt::film::Layer;
use gpt::plan::Fault;
use gpt::renderer::DeviceChoice;
use gpt::scene::settings::MOST_SAMPLES;
use gpt::{IntervalBasis, IntervalScope};

use super::access_arguments::AccessArguments;
use super::bench::BenchArguments;
use super::choice::by_name;
use super::denoise::DenoiseArguments;
use super::edit::EditArguments;
use super::exit::Exit;
use super::film::FilmArguments;
use super::frames::{FrameArguments, FrameList, parse_frame};
use super::installing_arguments::{CompletionsArguments, ManArguments};
use super::machine_progress::ProgressFormat;
use super::measure::MeasureArguments;
use super::model_arguments::ModelArguments;
use super::picture_arguments::{DisplayArguments, ExrArguments};
use super::referee::RefereeArguments;
use super::regroup::RegroupArguments;
use super::setting_flags::SettingFlags;
use super::settings::EstimateArguments;
use super::test_arguments::TestArguments;
use super::traversal::TraversalArguments;
use super::values::{parse_confidence, parse_device, parse_pixel, parse_seconds, parse_share, parse_size};
use super::view::ViewArguments;

/// A headless GPU path tracer that proves its pictures against a CPU reference.
#[derive(Debug, Parser)]
#[command(name = "gpt", version, after_help = Exit::list())]
pub struct Arguments {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to picture files
    #[command(after_help = RENDER_EXAMPLES)]
    Render(Box<RenderArguments>),
    /// Change the materials of a scene file in the browser, beside the picture, and save them
    Edit(EditArguments),
    /// Cut a render into chunks for several machines, with their commands, memory and time, as JSON
    Plan(PlanArguments),
    /// Join parts of a picture that `gpt render` wrote with --first-sample or --crop
    Merge(MergeArguments),
    /// Take the noise out of a picture by Open Image Denoise, into a second file, and say what that did to its energy
    Denoise(DenoiseArguments),
    /// Weigh the light groups of a picture anew, without rendering it again: brighter, darker, in another colour
    Regroup(RegroupArguments),
    /// Measure how far two pictures are apart; exit code 7 if they differ
    Compare(CompareArguments),
    /// Test whether scenes still render to their golden pictures, noise considered; exit code 7 if one does not
    #[command(after_help = TEST_EXAMPLES)]
    Test(TestArguments),
    /// Render on the GPU and by the CPU reference with the same random numbers; exit code 7 if they differ
    Verify(VerifyArguments),
    /// Let a renderer render small scenes whose pictures are known, and say what it gets wrong
    Referee(RefereeArguments),
    /// Measure run time against error, speed, and what features cost; writes JSON, CSV and a page to look at
    Bench(Box<BenchArguments>),
    /// Measure light at the meters of a scene, in W/m² and lux, with intervals that hold the truth
    Measure(Box<MeasureArguments>),
    /// Say whether a scene is valid, all that is wrong with it, what is in it, and what memory and time it takes
    Check(CheckArguments),
    /// Write a scene of another program as a scene file that can be edited and renders the same picture
    Import(ImportArguments),
    /// Write a scene as one of Mitsuba 3, pbrt-v4 or glTF 2.0, as far as it can be said there
    Export(ExportArguments),
    /// List the built-in scenes, or print one
    Scenes(ScenesArguments),
    /// List the graphics adapters, their limits, and which one `--device auto` takes
    Devices(DevicesArguments),
    /// Print what a shell needs to complete commands, options and their values
    Completions(CompletionsArguments),
    /// Print the man page, or write one for each command
    Man(ManArguments),
}

const RENDER_EXAMPLES: &str = "Examples:
  gpt render                                              the Cornell box, to cornell.exr and cornell.png
  gpt render scene.toml --spp 1024 -o picture.exr -o picture.png
  gpt render scene.toml --time-limit 60 --adaptive        the best picture of a minute
  gpt render scene.toml --target-error 1e-3               as many samples as the error needs
  gpt render bunny.ply --up z --turn 30 --material gold --environment sky.exr
  gpt render model.obj --save-scene model.toml            a scene of a model, to go on with
  gpt render scene.toml --frames 1-100 -o picture.####.exr  an animation, by the scene's keyframes
  gpt render scene.toml --view --watch                    in the browser, and again whenever a file changes
  gpt render scene.toml --exposure auto --tonemap filmic -o preview.jpg";

const TEST_EXAMPLES: &str = "Examples:
  gpt test scenes --bless                                 makes scenes/golden/NAME.exr of each scenes/NAME.toml
  gpt test scenes --junit test.xml --html test.html       tests them, in CI too
  gpt test scenes cornell --change 5%                     one scene, and larger changes only
  gpt test scenes --update                                accepts what differs
  gpt test scenes --candidate-dir other                   pictures of another program, other/NAME.exr";

#[derive(Debug, Args)]
pub struct RenderArguments {
    /// A .toml scene, an .obj or .ply model, a glTF .gltf or .glb, a Mitsuba .xml, a .pbrt, the name of a built-in scene, or - for a .toml scene on the standard input [default: cornell]
    pub scene: Option<OsString>,
    #[command(flatten)]
    pub access: AccessArguments,
    #[command(flatten)]
    pub model: ModelArguments,
    /// A lat-long map (.exr, .hdr) that lights the scene in place of its own environment; of a model, in place of all lights
    #[arg(long, value_name = "FILE", help_heading = SCENE)]
    pub environment: Option<PathBuf>,
    /// Write what is rendered as a scene file too, which renders the same picture
    #[arg(long, value_name = "FILE.toml", help_heading = SCENE)]
    pub save_scene: Option<PathBuf>,
    /// Picture to write: .exr (linear float), .hdr (linear, shared exponent), .png or .jpg (sRGB preview), or - (standard output, EXR); may be
    /// given several times [default: SCENE-name.exr and SCENE-name.png]
    #[arg(short, long = "output", value_name = "FILE", help_heading = PICTURE_FILES)]
    pub outputs: Vec<PathBuf>,
    #[command(flatten, next_help_heading = PICTURE_FILES)]
    pub display: DisplayArguments,
    #[command(flatten, next_help_heading = PICTURE_FILES)]
    pub exr: ExrArguments,
    /// Denoise the pictures too, into NAME.denoised.exr and so on beside them, by Open Image Denoise; parts (--first-sample, --crop) get the layers that `gpt merge --denoise` needs
    #[arg(long, help_heading = PICTURE_FILES)]
    pub denoise: bool,
    #[command(flatten, next_help_heading = "The picture")]
    pub estimate: EstimateArguments,
    #[command(flatten, next_help_heading = "Frames")]
    pub frames: FrameArguments,
    #[command(flatten, next_help_heading = "Stopping, and where samples go")]
    pub goal: GoalArguments,
    /// auto (discrete, integrated, then software GPU; the CPU integrator if there is none), gpu, cpu, or part of an adapter's name
    #[arg(long, default_value = "auto", value_parser = parse_device, help_heading = DEVICE)]
    pub device: DeviceChoice,
    /// Fail (exit code 4) where `auto` finds no graphics device, rather than render on the CPU
    #[arg(long, help_heading = DEVICE)]
    pub require_device: bool,
    /// Take a device for lost (exit code 5) that does not finish a submission, of a second at most, in this time [default: 60; 300 on software devices]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, help_heading = DEVICE)]
    pub device_timeout: Option<Duration>,
    #[command(flatten, next_help_heading = "Stopping, and where samples go")]
    pub checkpoint: CheckpointArguments,
    #[command(flatten, next_help_heading = DEVICE)]
    pub traversal: TraversalArguments,
    #[command(flatten, next_help_heading = "While rendering")]
    pub live: ViewArguments,
    /// Write what the render did and how long it took as JSON; - is standard output
    #[arg(long, value_name = "FILE.json", help_heading = REPORT)]
    pub stats: Option<PathBuf>,
    /// Print progress to standard output, once a second: words, JSON lines, or the form of Open Job Description
    #[arg(long, value_name = "FORMAT", value_enum)]
    pub progress: Option<ProgressFormat>,
    /// No progress on stderr
    #[arg(short, long, help_heading = REPORT)]
    pub quiet: bool,
    /// Exit with code 6 if a sample was not finite, and with code 3 where something else would stand for what is missing or wrong in a model or a material, or an import is not exact
    #[arg(long, help_heading = REPORT)]
    pub strict: bool,
}

/// Groups of `gpt render --help`.
const SCENE: &str = "The scene";
const PICTURE_FILES: &str = "Picture files";
const DEVICE: &str = "Device";
const REPORT: &str = "Messages";

#[derive(Debug, Args)]
pub struct ScenesArguments {
    /// The scene to print, as a scene file; none: all are listed
    pub name: Option<String>,
}

/// The conditions that end a render before its last sample, and the choice of pixels that get more samples.
#[derive(Debug, Default, Args)]
pub struct GoalArguments {
    /// Stop after this time since the program's start, with a whole picture of fewer samples per pixel
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, conflicts_with = "crop")]
    pub time_limit: Option<Duration>,
    /// Stop once the picture's relative mean squared error is below X by what was sampled, with a margin for chance; light that no path has found is not in it. --spp is then the most it may take
    #[arg(long, value_name = "X", value_parser = parse_target, conflicts_with_all = ["first_sample", "crop"])]
    pub target_error: Option<f64>,
    /// Give noisy pixels more samples and calm ones fewer, --spp on average; unbiased
    #[arg(long, conflicts_with_all = ["first_sample", "crop"])]
    pub adaptive: bool,
    #[command(flatten)]
    pub interval: IntervalArguments,
}

/// The intervals that a render states.
#[derive(Debug, Default, Args)]
pub struct IntervalArguments {
    /// Stop once the truth is known to this share, such as 1%: half of each interval's width is at most so much of its value, or of a tenth of the picture's. The intervals hold however often one looks. --spp is the most it may take
    #[arg(long, value_name = "SHARE", value_parser = parse_share, conflicts_with_all = ["first_sample", "crop", "adaptive", "target_error"])]
    pub target_interval: Option<f64>,
    /// The probability that all intervals hold, those of --target-interval and those of the layers low and high each [default: 99%]
    #[arg(long, value_name = "SHARE", value_parser = parse_confidence)]
    pub confidence: Option<f64>,
    /// The quantities whose intervals are to become so narrow [default: picture]
    #[arg(long, value_name = "OF", value_parser = by_name::<IntervalScope>())]
    pub interval_of: Option<IntervalScope>,
    /// The assumption on which upper ends of intervals stand [default: bound, where the scene has one]
    #[arg(long, value_name = "BASIS", value_parser = by_name::<IntervalBasis>())]
    pub interval_by: Option<IntervalBasis>,
}

/// How a render that breaks off is saved and continued.
#[derive(Debug, Default, Args)]
pub struct CheckpointArguments {
    /// Save the state of the render in FILE.checkpoint beside the first picture, every so many seconds and where the render breaks off; the end removes it
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub checkpoint: Option<Duration>,
    /// Go on from that state, if there is one, and save further ones [every 60 s]; render nothing where all pictures are finished
    #[arg(long)]
    pub resume: bool,
}

#[derive(Debug, Args)]
pub struct PlanArguments {
    /// A .toml scene, an .obj or .ply model, or the name of a built-in scene
    pub scene: OsString,
    #[command(flatten)]
    pub access: AccessArguments,
    /// How many chunks
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub chunks: u32,
    /// Cut these frames of the scene's keyframes into chunks of whole frames, such as 1-100; #### in the picture's name stands for a frame's number
    #[arg(long, value_name = "FRAMES", value_parser = FrameList::parse)]
    pub frames: Option<FrameList>,
    /// Picture that the merge writes [default: SCENE-name.exr, with --frames SCENE-name.####.exr]
    #[arg(short, long, value_name = "FILE.exr")]
    pub output: Option<PathBuf>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Layers that the picture has beside it, as `gpt render --aov` renders them
    #[arg(long, value_name = "LAYER,…", value_delimiter = ',', value_parser = by_name::<Layer>())]
    pub aov: Vec<Layer>,
    #[command(flatten)]
    pub settings: SettingFlags,
    /// Refuse what `gpt render --strict` refuses (exit code 3), and have the chunks rendered with it
    #[arg(long)]
    pub strict: bool,
}

#[derive(Debug, Args)]
pub struct MergeArguments {
    /// The parts, in any order
    #[arg(required = true, value_name = "PART.exr")]
    pub parts: Vec<PathBuf>,
    /// Picture to write: .exr (linear float), .png (sRGB preview), or - (standard output, EXR); may be given several times
    #[arg(short, long = "output", value_name = "FILE", required = true)]
    pub outputs: Vec<PathBuf>,
    /// Samples per pixel that the picture shall have, so that missing ones at its end are noticed [default: up to the last part's last]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MOST_SAMPLES)))]
    pub spp: Option<u32>,
    /// Join what there is, though samples or regions are missing
    #[arg(long)]
    pub partial: bool,
    /// Say how many more parts it would take to bring the relative mean squared error below X
    #[arg(long, value_name = "X", value_parser = parse_target)]
    pub target_error: Option<f64>,
    /// Denoise the picture as well, by Open Image Denoise, into NAME.denoised.exr and so on; parts of `gpt render --denoise` have what helps it
    #[arg(long)]
    pub denoise: bool,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
pub struct CompareArguments {
    /// The picture
    #[arg(value_name = "A")]
    pub picture: PathBuf,
    /// Its reference
    #[arg(value_name = "B")]
    pub reference: PathBuf,
    /// Show this metric only, and judge by it
    #[arg(long, value_parser = by_name::<Metric>())]
    pub metric: Option<Metric>,
    /// Largest metric that still counts as equal (psnr: the smallest); without --metric the largest
    /// difference of a value
    #[arg(long, value_name = "X", allow_negative_numbers = true, value_parser = parse_tolerance)]
    pub tolerance: Option<f64>,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Write a page that shows both pictures, where they differ, and how they look to the eye
    #[arg(long, value_name = "FILE.html")]
    pub html: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub struct VerifyArguments {
    /// A .toml scene, an .obj or .ply model, a glTF .gltf or .glb, a Mitsuba .xml, a .pbrt, or the name of a built-in scene [default: closed forms and every built-in scene]
    pub scene: Option<OsString>,
    #[command(flatten)]
    pub access: AccessArguments,
    /// Follow one path of the pixel at column X, row Y on both devices and print it side by side [scene: cornell]
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub pixel: Option<[u32; 2]>,
    /// Which sample of that pixel
    #[arg(long, value_name = "N", default_value_t = 0, requires = "pixel", value_parser = clap::value_parser!(u32).range(..i64::from(MOST_SAMPLES)))]
    pub sample: u32,
    /// Samples per pixel [default: 16]
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    pub spp: Option<u32>,
    /// Verify frame N of the scene's keyframes [default: the scene as it is without a frame; built-in scenes with keyframes at frame 0 too]
    #[arg(long, value_name = "N", value_parser = parse_frame, requires = "scene")]
    pub frame: Option<u32>,
    /// Picture size in pixels [default: the scene's, shrunk to 128 pixels along the longer side]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Key of every random number [default: the scene's]
    #[arg(long, value_name = "N")]
    pub seed: Option<u32>,
    /// auto, gpu, or part of an adapter's name
    #[arg(long, default_value = "gpu", value_parser = parse_device)]
    pub device: DeviceChoice,
    /// Take a device for lost (exit code 5) that does not finish a submission, or a kernel's compilation, in this time [default: 60; 300 on software devices]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds)]
    pub device_timeout: Option<Duration>,
    #[command(flatten)]
    pub traversal: TraversalArguments,
    #[command(flatten)]
    pub film: FilmArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Folder for the pictures that show a difference; made where there is one
    #[arg(long, value_name = "FOLDER", default_value = "gpt-verify")]
    pub evidence: PathBuf,
    /// Compile a fault into the GPU's kernels, to see verify fail: one BSDF times 1.01, no MIS weights, or one light skipped
    #[arg(long, value_name = "FAULT", value_parser = by_name::<Fault>())]
    pub plant: Option<Fault>,
}

#[derive(Debug, Args)]
pub struct CheckArguments {
    /// A .toml scene, an .obj or .ply model, a glTF .gltf or .glb, a Mitsuba .xml, a .pbrt, the name of a built-in scene, or - for a .toml scene on the standard input
    #[arg(required_unless_present = "schema")]
    pub scene: Option<OsString>,
    #[command(flatten)]
    pub access: AccessArguments,
    /// Exit with code 3 where something else would stand for what is missing or wrong in a model or a material, or an import is not exact
    #[arg(long)]
    pub strict: bool,
    /// Print also how the device would render it: the plan with its reasons, and which parts of the kernels are compiled
    #[arg(long)]
    pub plan: bool,
    #[command(flatten)]
    pub traversal: TraversalArguments,
    #[command(flatten)]
    pub film: FilmArguments,
    /// Print JSON
    #[arg(long)]
    pub json: bool,
    /// Print the JSON Schema of scene files instead
    #[arg(long, conflicts_with_all = ["scene", "json"])]
    pub schema: bool,
}

#[derive(Debug, Args)]
pub struct ImportArguments {
    /// A glTF .gltf or .glb, a Mitsuba .xml, a .pbrt, or a model, .obj or .ply
    pub scene: PathBuf,
    /// Scene file to write; what the scene embeds goes into a folder beside it
    #[arg(short, long, value_name = "SCENE.toml")]
    pub output: PathBuf,
    #[command(flatten)]
    pub access: AccessArguments,
    /// Exit with code 3, and write nothing, where the import is not exact
    #[arg(long)]
    pub strict: bool,
}

#[derive(Debug, Args)]
pub struct ExportArguments {
    /// Whatever `gpt render` takes: a scene, a model, or the name of a built-in scene
    pub scene: OsString,
    /// Scene of Mitsuba (.xml), pbrt (.pbrt) or glTF (.glb, .gltf) to write; what the scene embeds goes into a folder beside it, or into the .glb
    #[arg(short, long, value_name = "FILE")]
    pub output: PathBuf,
    #[command(flatten)]
    pub access: AccessArguments,
    /// Exit with code 3, and write nothing, where something cannot be said exactly
    #[arg(long)]
    pub strict: bool,
}

#[derive(Debug, Args)]
pub struct DevicesArguments {
    /// Print JSON
    #[arg(long)]
    pub json: bool,
}

fn parse_target(text: &str) -> Result<f64, String> {
    let target = text.parse().ok().filter(|target: &f64| target.is_finite() && *target > 0.0);
    target.ok_or_else(|| "expected a relative mean squared error above 0, for example 0.001".to_owned())
}

fn parse_tolerance(text: &str) -> Result<f64, String> {
    let tolerance: f64 = text.parse().map_err(|_| "expected a number".to_owned())?;
    if tolerance.is_nan() { Err("expected a number".to_owned()) } else { Ok(tolerance) }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn limits_are_positive_numbers() {
        assert_eq!(parse_seconds("1.5"), Ok(Duration::from_millis(1500)));
        assert_eq!(parse_target("1e-3"), Ok(1e-3));
        for bad in ["0", "-1", "nan", "inf", "1e300s", "soon"] {
            assert!(parse_seconds(bad).is_err() && parse_target(bad).is_err(), "{bad}");
        }
        assert!(parse_seconds("1e300").is_err());
    }
}
