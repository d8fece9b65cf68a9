//! `gpt plan`.

use std::ffi::OsString;
use std::path::PathBuf;

use gpt::choice::Choice;
use gpt::film::Layer;
use gpt::load::{self, LoadOptions, ModelView, SceneSource};
use gpt::merge::chunks;
use gpt::plan::host::{HostNeeds, host_memory};
use gpt::render::layers::contradiction;
use gpt::render::options::PARTS_OF_STRATA;
use gpt::scene::NumberOrAuto;
use gpt::{RenderOptions, Scene};
use serde::Serialize;

use super::arguments::PlanArguments;
use super::check::{device_memory, guess_time};
use super::exit::{Exit, Failure};
use super::frames::{FrameArguments, FrameList};
use super::layers::{INTERVALS_OF_PARTS, MATTES_OF_PARTS};
use super::sequence::bad_frame;
use super::typed::{CommandLine, Typed};
use super::{settings, terminal};

/// The chunks of a job, for schedulers. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Job {
    scene: String,
    width: u32,
    height: u32,
    spp: u32,
    /// The device whose memory is reported.
    device: String,
    chunks: Vec<Chunk>,
    /// None where chunks are whole frames.
    merge: Option<Merge>,
    exit_codes: ExitCodes,
}

#[derive(Serialize)]
struct Chunk {
    index: u32,
    /// The frames that it renders, as --frames has them.
    #[serde(skip_serializing_if = "Option::is_none")]
    frames: Option<String>,
    /// Absolute index of the first sample, and samples per pixel.
    first_sample: u32,
    spp: u32,
    output: String,
    command: Vec<String>,
    /// The command as a line for a shell.
    shell: String,
    device_bytes: u64,
    /// The host's memory with a state, within a factor of two.
    host_bytes: u64,
    /// That the CPU would take, by a few samples; a graphics card takes a fraction.
    cpu_seconds: f64,
}

#[derive(Serialize)]
struct Merge {
    output: String,
    command: Vec<String>,
    shell: String,
    host_bytes: u64,
}

/// The meaning of a chunk's exit codes for a scheduler.
#[derive(Serialize)]
struct ExitCodes {
    done: [u8; 1],
    retry: [u8; 2],
    give_up: [u8; 3],
}

/// Bytes of a merge: of the program, and of each pixel's sums and one part.
const MERGE_PROGRAM_BYTES: u64 = 32 << 20;
const MERGE_BYTES: u64 = 40 + 40;

/// Arguments of `gpt plan` that chunks have in words of their own. All others are passed on to `gpt render` as they were typed.
const OF_THE_PLAN: [&str; 4] = ["chunks", "frames", "output", "spp"];

/// Prints the chunks of a job as JSON.
pub fn run(arguments: &PlanArguments, typed: &Typed) -> Result<Exit, Failure> {
    let source = SceneSource::parse(Some(&arguments.scene))?;
    if matches!(source, SceneSource::StandardInput) {
        return Err(Failure::usage("chunks are rendered by other processes, which do not have this standard input: name a file"));
    }
    let view = ModelView { size: arguments.size, ..ModelView::default() };
    let mut scene = source.load(&LoadOptions { view, ..arguments.access.options(arguments.strict) })?;
    if let Some(summary) = scene.import_report.summary().filter(|_| arguments.strict) {
        return Err(load::SceneError::in_file(&scene.name, summary).into());
    }
    settings::apply_to(arguments.size, &arguments.settings, &mut scene)?;
    match &arguments.frames {
        Some(frames) => plan_frames((arguments, typed), &scene, frames),
        None => plan_samples((arguments, typed), &scene),
    }
}

/// Chunks of whole frames: nothing is left to join.
fn plan_frames((arguments, typed): (&PlanArguments, &Typed), scene: &Scene, frames: &FrameList) -> Result<Exit, Failure> {
    let FrameList(numbers) = frames;
    let count = numbers.len() as u32;
    if arguments.chunks > count {
        return Err(Failure::usage(format!(
            "--chunks {}: there are {count} frames, and a chunk has at least one",
            arguments.chunks
        )));
    }
    let wanted = FrameArguments { frames: Some(frames.clone()), ..FrameArguments::default() };
    wanted.times(&scene.animation)?;
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.####.exr", scene.name)));
    wanted.check_names("-o", std::iter::once(output.as_path()))?;
    let first = scene.at_frame(f64::from(numbers[0])).map_err(|error| bad_frame(scene, &error))?;
    let (device, device_bytes) = device_memory(&first)?;
    let seconds = guess_time(&first)?.seconds;
    let [width, height] = scene.film.size;
    let host_bytes = host_bytes(scene);
    let spp = scene.render.spp;
    let output = output.display().to_string();
    let cut = chunks(count, arguments.chunks).enumerate().map(|(index, range)| {
        let frames = FrameList::words(&numbers[range.start as usize..range.end as usize]);
        let command = render_command(arguments, typed).with_option("--frames", &frames).with_option("--spp", spp.to_string());
        let command = command.with_flag("--resume").with_option("-o", &output);
        Ok(Chunk {
            index: index as u32,
            frames: Some(frames),
            first_sample: 0,
            spp,
            output: output.clone(),
            shell: command.to_string(),
            command: words(&command)?,
            device_bytes,
            host_bytes,
            cpu_seconds: seconds * range.len() as f64,
        })
    });
    let chunks = cut.collect::<Result<_, Failure>>()?;
    let scene = scene.name.clone();
    terminal::answer_json(&Job { scene, width, height, spp, device, chunks, merge: None, exit_codes: ExitCodes::default() })?;
    Ok(Exit::Done)
}

/// Memory of the host that a chunk's render takes.
fn host_bytes(scene: &Scene) -> u64 {
    let pixels = scene.film.size.map(u64::from).iter().product();
    host_memory(scene, &HostNeeds { pixels, checkpoint: true, ..HostNeeds::default() }).total()
}

/// The command with which every chunk's begins: the scene, and all that was said of how it is read and rendered.
fn render_command(arguments: &PlanArguments, typed: &Typed) -> CommandLine {
    CommandLine::new("render").with(&arguments.scene).with_options(typed.options_but(&OF_THE_PLAN))
}

/// The words of a command for JSON.
///
/// # Errors
/// A usage error where one is no text.
fn words(command: &CommandLine) -> Result<Vec<String>, Failure> {
    let no_text = |word: OsString| {
        Failure::usage(format!(
            "{}: this name is not in UTF-8, so JSON cannot hold it: give it another one",
            word.to_string_lossy()
        ))
    };
    command.words().map_err(no_text)
}

/// Chunks of the samples of one picture, and the command that joins them.
fn plan_samples((arguments, typed): (&PlanArguments, &Typed), scene: &Scene) -> Result<Exit, Failure> {
    let spp = scene.render.spp;
    if arguments.chunks > spp {
        return Err(Failure::usage(format!(
            "--chunks {}: there are {spp} samples per pixel, and a chunk has at least one",
            arguments.chunks
        )));
    }
    if arguments.chunks > 1 && scene.render.uses_strata() {
        return Err(Failure::usage(format!("--chunks {}: {PARTS_OF_STRATA}", arguments.chunks)));
    }
    let layers = if arguments.aov.is_empty() { &scene.layers } else { &arguments.aov };
    if layers.contains(&Layer::Cryptomatte) {
        return Err(Failure::usage(format!("--chunks with the layer cryptomatte: {MATTES_OF_PARTS}")));
    }
    if layers.iter().any(|layer| matches!(layer, Layer::Low | Layer::High)) {
        return Err(Failure::usage(format!("--chunks with the layers low and high: {INTERVALS_OF_PARTS}")));
    }
    if let Some((layer, message)) = contradiction(layers, scene, &RenderOptions::default()) {
        return Err(Failure::usage(format!("--chunks with the layer {}: {message}", layer.name())));
    }
    let (device, device_bytes) = device_memory(scene)?;
    let seconds = guess_time(scene)?.seconds;
    let pixels = scene.film.size.map(u64::from).iter().product::<u64>();
    let host_bytes = host_bytes(scene);
    let output = arguments.output.clone().unwrap_or_else(|| PathBuf::from(format!("{}.exr", scene.name)));
    let digits = (arguments.chunks - 1).to_string().len();
    let part = |index: u32| {
        let stem = output.file_stem().unwrap_or_default().to_string_lossy();
        output.with_file_name(format!("{stem}.part-{index:0digits$}.exr")).display().to_string()
    };
    let cut: Vec<Chunk> = chunks(spp, arguments.chunks)
        .enumerate()
        .map(|(index, samples)| {
            let (index, count) = (index as u32, samples.len() as u32);
            let output = part(index);
            let command = render_command(arguments, typed).with_option("--first-sample", samples.start.to_string());
            let command = command.with_option("--spp", count.to_string());
            // All chunks learn as the whole picture does.
            let command = match scene.render.expected_spp {
                NumberOrAuto::Auto => command.with_option("--expected-spp", spp.to_string()),
                NumberOrAuto::Number(_) => command,
            };
            let command = command.with_flag("--resume").with_option("-o", &output);
            Ok(Chunk {
                index,
                frames: None,
                first_sample: samples.start,
                spp: count,
                output,
                shell: command.to_string(),
                command: words(&command)?,
                device_bytes,
                host_bytes,
                cpu_seconds: seconds * f64::from(count) / f64::from(spp),
            })
        })
        .collect::<Result<_, Failure>>()?;
    let command = cut.iter().fold(CommandLine::new("merge"), |command, chunk| command.with(&chunk.output));
    let command = command.with_option("--spp", spp.to_string()).with_option("-o", &output);
    let output = output.display().to_string();
    let merge = Merge {
        output,
        shell: command.to_string(),
        command: words(&command)?,
        host_bytes: MERGE_PROGRAM_BYTES + pixels * MERGE_BYTES,
    };
    let [width, height] = scene.film.size;
    let (scene, exit_codes) = (scene.name.clone(), ExitCodes::default());
    terminal::answer_json(&Job { scene, width, height, spp, device, chunks: cut, merge: Some(merge), exit_codes })?;
    Ok(Exit::Done)
}

impl Default for ExitCodes {
    fn default() -> Self {
        Self { done: [0], retry: [5, 130], give_up: [2, 3, 4] }
    }
}

#[cfg(test)]
mod tests {
    use super::super::typed::subcommand;
    use super::*;

    /// Every argument of `gpt plan` is one of the plan's own, or `gpt render` has it too and every chunk's command tells it.
    #[test]
    fn chunks_take_every_argument() {
        let render = subcommand("render");
        for argument in subcommand("plan").get_arguments().filter(|argument| !argument.is_positional()) {
            let id = argument.get_id().as_str();
            if id == "help" || OF_THE_PLAN.contains(&id) {
                continue;
            }
            let same = render.get_arguments().find(|one| one.get_id() == argument.get_id());
            let names = same.map(|one| (one.get_long(), one.get_short()));
            assert_eq!(names, Some((argument.get_long(), argument.get_short())), "gpt render has no {id}");
        }
        for id in OF_THE_PLAN {
            assert!(subcommand("plan").get_arguments().any(|argument| argument.get_id() == id), "{id}");
        }
    }

    #[test]
    fn what_was_said_of_the_scene_is_said_to_every_chunk() {
        let said = ["-D", "spp=4 5", "--camera", "left eye", "--variant=-red", "--assets-root", "a b"];
        let plan =
            ["gpt", "plan", "my room.xml", "--chunks", "2", "--spp", "8", "--strict", "--aov", "albedo,depth", "-o", "a.exr"];
        let (arguments, typed) = Typed::parse(plan.iter().chain(&said).map(OsString::from)).expect("valid arguments");
        let super::super::arguments::Command::Plan(arguments) = arguments.command else { panic!("another command") };
        let words = render_command(&arguments, &typed).words().expect("text");
        assert_eq!(words[..3], ["gpt", "render", "my room.xml"]);
        for word in ["spp=4 5", "left eye", "--variant=-red", "a b", "--strict", "albedo,depth"] {
            assert!(words.iter().any(|one| one == word), "{word} in {words:?}");
        }
        assert!(words.iter().all(|word| !["8", "a.exr", "--chunks"].contains(&word.as_str())), "{words:?}");
    }
}
