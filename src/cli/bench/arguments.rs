//! The arguments of `gpt bench`.

use std::path::PathBuf;
use std::time::Duration;

use clap::{Args, Subcommand, ValueEnum};
use gpt::bench::growth::Growth;
use gpt::bench::setting::Axes;
use gpt::renderer::DeviceChoice;
use gpt::scene::settings::MOST_SAMPLES;

use crate::cli::choice::by_name;
use crate::cli::file_arguments::FileArguments;
use crate::cli::film::FilmArguments;
use crate::cli::setting_flags::SettingAxes;
use crate::cli::traversal::TraversalArguments;
use crate::cli::values::{parse_device, parse_seconds, parse_size};

#[derive(Debug, Args)]
pub struct BenchArguments {
    /// Take a device for lost (exit code 5) that does not finish a submission, or a kernel's compilation, in this time [default: 60; 300 on software devices]
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, global = true)]
    pub device_timeout: Option<Duration>,
    #[command(flatten)]
    pub files: FileArguments,
    #[command(subcommand)]
    pub bench: Bench,
}

#[derive(Debug, Subcommand)]
pub enum Bench {
    /// Error against samples and time for chosen settings, with what one buys over the other
    ///
    /// Renders pictures of rising numbers of samples, over and over with independent random numbers, settings in turn, and measures their error
    /// against a reference. Options that take several values (separated by commas) are combined in every way; the first combination is what
    /// the others are compared with. The same value twice makes two settings that should come out equal: a check of the measurement.
    ///
    /// Writes into the output folder: report.html (charts, tables, pictures at equal time; needs nothing but a browser), convergence.json
    /// (all results), convergence.csv (every picture's error and time). A summary goes to stdout.
    #[command(after_help = "Examples:\n  \
        gpt bench convergence cornell veach-mis --sampler halton,sobol,independent\n  \
        gpt bench convergence veach-mis --estimator mis,nee,bsdf --spp 1024 --size 384x256\n  \
        gpt bench convergence scene.toml --device gpu,cpu --reference converged.exr\n  \
        gpt bench convergence --denoise no,yes                  what denoising buys, and where it stops\n  \
        gpt bench convergence --sampler halton,halton        the measurement against itself\n\n\
        How it is measured: an error is the mean over the replications, with Student's 95 % interval; the reference's own error, known from the scatter of \
        its 8 independent parts, is taken off. The slope is fitted to log error over log samples, replication by replication. What is left of the \
        last level's squared error when its variance is taken away is bias; where chance would show as much less than once in 1000 times, it is \
        flagged as a floor. Ratios are medians over the replications, pair by pair, with the distribution-free interval of a median; one that holds \
        1 is inside the noise. Fewer than 6 replications decide nothing.")]
    Convergence(Box<ConvergenceArguments>),
    /// Samples and rays a second, time per stage, memory, and how they grow
    ///
    /// One table for the scenes as they are, and one for each thing that grows: triangles (hills under a sky), resolution and samples (of the
    /// first scene), lights (of 10,000 triangles so many emit), leaves of a blend, instances of a tree. Rows of a table take turns.
    ///
    /// Writes report.html, speed.json and speed.csv into the output folder; a summary goes to stdout.
    #[command(after_help = "Examples:\n  \
        gpt bench speed cornell veach-mis scene.toml\n  \
        gpt bench speed --growth triangles --all --device cpu\n  \
        gpt bench speed --stages wavefront --size 512x512 --spp 8\n\n\
        Stage times are the device's own time stamps around every dispatch of one pass that fills the pool of paths; adapters without time stamps \
        have none. Scenes that do not fit the device say so in their row.")]
    Speed(SpeedArguments),
    /// Measure the cost of each feature: used, and only compiled in
    ///
    /// A room of two boxes and a lamp is rendered without the feature, by kernels that hold it though nothing needs it, and with the feature in use;
    /// the three take turns. Only on a GPU, real or software, since only its kernels leave out what a scene does not use.
    ///
    /// Writes report.html, features.json and features.csv into the output folder; a line for each feature goes to stdout.
    #[command(after_help = "Examples:\n  gpt bench features\n  gpt bench features glass 'rough glass' --rounds 15")]
    Features(FeatureArguments),
}

#[derive(Debug, Args)]
pub struct SpeedArguments {
    /// .toml scenes, .obj or .ply models, or names of built-in scenes [default: cornell, spheres and veach-mis]
    pub scenes: Vec<String>,
    /// auto, gpu, cpu, or part of an adapter's name
    #[arg(long, default_value = "auto", value_parser = parse_device)]
    pub device: DeviceChoice,
    /// How the stages run [default: as the plan decides]
    #[arg(long)]
    pub stages: Option<StagesName>,
    #[command(flatten)]
    pub traversal: TraversalArguments,
    #[command(flatten)]
    pub film: FilmArguments,
    /// Quantities that grow [default: everything, and the scenes as they are]
    #[arg(long, value_name = "WHAT,…", value_delimiter = ',', value_parser = by_name::<Growth>())]
    pub growth: Vec<Growth>,
    /// The larger sizes too: up to ten million triangles, 4096x4096 pixels, 10,000 lights, 64 leaves, a million trees. Takes minutes and gigabytes
    #[arg(long)]
    pub all: bool,
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = parse_size)]
    pub size: [u32; 2],
    /// Samples per pixel of a run
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub spp: u32,
    /// Edges of a path at most in every scene, 0 for no limit; 2 is the camera's ray and one bounce [default: as the scenes say]
    #[arg(long, value_name = "N")]
    pub depth: Option<u32>,
    /// Measured runs of each, after one that is thrown away; 6 are needed for a verdict
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rounds: u32,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// How the stages run, as it is typed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum StagesName {
    /// One kernel traces whole paths
    Fused,
    /// Separate kernels over queues
    Wavefront,
}

#[derive(Debug, Args)]
pub struct FeatureArguments {
    /// Features to measure [default: all; an unknown name lists them]
    pub features: Vec<String>,
    /// auto, gpu, or part of an adapter's name
    #[arg(long, default_value = "gpu", value_parser = parse_device)]
    pub device: DeviceChoice,
    /// Picture size in pixels
    #[arg(long, value_name = "WxH", default_value = "256x256", value_parser = parse_size)]
    pub size: [u32; 2],
    /// Samples per pixel of a run
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(1..=1 << 20))]
    pub spp: u32,
    /// Measured runs of each, after one that is thrown away; 6 are needed for a verdict
    #[arg(long, value_name = "N", default_value_t = 9, value_parser = clap::value_parser!(u32).range(1..=1000))]
    pub rounds: u32,
    #[command(flatten)]
    pub output: OutputArguments,
}

#[derive(Debug, Args)]
pub struct ConvergenceArguments {
    /// .toml scenes, .obj or .ply models, or names of built-in scenes [default: cornell]
    pub scenes: Vec<String>,
    #[command(flatten)]
    pub axes: AxisArguments,
    /// Most samples per pixel; the schedule doubles up to it
    #[arg(long, value_name = "N", default_value_t = 256, value_parser = clap::value_parser!(u32).range(1..=1 << 24))]
    pub spp: u32,
    /// Levels of the schedule: with 5 and --spp 256 they are 16, 32, 64, 128, 256
    #[arg(long, value_name = "N", default_value_t = 6, value_parser = clap::value_parser!(u32).range(1..=20))]
    pub levels: u32,
    /// Independent pictures of each level; 6 are needed for a verdict
    #[arg(long, value_name = "N", default_value_t = 7, value_parser = clap::value_parser!(u32).range(2..=1000))]
    pub replications: u32,
    /// Picture size in pixels [default: the scene's, shrunk to 128 pixels along the longer side]
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    /// Longest path in edges, 0 = unlimited [default: the scene's]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..=i64::from(MOST_SAMPLES)))]
    pub max_depth: Option<u32>,
    /// Key of all random numbers of the measurement
    #[arg(long, value_name = "N", default_value_t = 0)]
    pub seed: u32,
    /// The picture that errors are measured against, of the same size; only for a single scene [default: one is made, and kept for next time]
    #[arg(long, value_name = "FILE")]
    pub reference: Option<PathBuf>,
    /// Samples per pixel of a reference that is made, with the scene's own settings on the first device [default: 16 times --spp]
    #[arg(long, value_name = "N", conflicts_with = "reference", value_parser = clap::value_parser!(u32).range(8..=i64::from(MOST_SAMPLES)))]
    pub reference_spp: Option<u32>,
    /// Folder in which references are kept [default: the user's folder for caches]
    #[arg(long, value_name = "FOLDER", conflicts_with = "reference")]
    pub references: Option<PathBuf>,
    #[command(flatten)]
    pub output: OutputArguments,
}

/// Options that may have several values, combined in every way.
#[derive(Debug, Args)]
#[command(next_help_heading = "What is compared (values separated by commas; default: the scene's own)")]
pub struct AxisArguments {
    /// Devices: auto, gpu, cpu, or part of an adapter's name
    #[arg(long, value_name = "DEVICE,…", value_delimiter = ',', value_parser = parse_device)]
    device: Vec<DeviceChoice>,
    #[command(flatten)]
    settings: SettingAxes,
    /// Denoise the pictures by Open Image Denoise with albedo and normals; its time counts, and the error
    /// that it leaves is a floor
    #[arg(long, value_name = "NO|YES,…", value_delimiter = ',', value_parser = clap::builder::BoolishValueParser::new())]
    denoise: Vec<bool>,
}

impl From<&AxisArguments> for Axes {
    fn from(arguments: &AxisArguments) -> Self {
        Self { devices: arguments.device.clone(), settings: arguments.settings.0.clone(), denoise: arguments.denoise.clone() }
    }
}

#[derive(Debug, Args)]
pub struct OutputArguments {
    /// Folder for the results; made where there is none [default: gpt-bench/ and the bench's name]
    #[arg(short, long, value_name = "FOLDER")]
    pub output: Option<PathBuf>,
    /// No progress on stderr
    #[arg(short, long)]
    pub quiet: bool,
}
