//! `gpt plan`.

use std::path::PathBuf;

use gpt::Scene;
use gpt::film::Layer;
use gpt::load;
use gpt::merge::chunks;
use gpt::plan::host::{HostNeeds, host_memory};
use gpt::render::options::PARTS_OF_STRATA;
use serde::Serialize;

use super::arguments::PlanArguments;
use super::check::{device_memory, guess_time};
use super::exit::{Exit, Failure};
use super::frames::{FrameArguments, FrameList};
use super::layers::MATTES_OF_PARTS;
use super::sequence::bad_frame;
use super::{settings, terminal};

/// The chunks of a job, for schedulers. Its keys stay as they are; new ones may be added.
#[derive(Serialize)]
struct Job {
    scene: String,
    width: u32,
    height: u32,
    spp: u32,
    /// The device whose memory is told.
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
    /// The same for a shell.
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

/// What exit codes of chunks mean for a scheduler.
#[derive(Serialize)]
struct ExitCodes {
    done: [u8; 1],
    retry: [u8; 2],
    give_up: [u8; 3],
}

/// Bytes of a merge: of the program, and of each pixel's sums and one part.
const MERGE_PROGRAM_BYTES: u64 = 32 << 20;
const MERGE_BYTES: u64 = 40 + 40;

/// Prints the chunks of a job as JSON.
pub fn run(arguments: &PlanArguments) -> Result<Exit, Failure> {
    let mut scene = load::load_with(Some(&arguments.scene), &arguments.access.options(false))?;
    settings::apply_to(arguments.size, &arguments.settings, &mut scene)?;
    match &arguments.frames {
        Some(frames) => plan_frames(arguments, &scene, frames),
        None => plan_samples(arguments, &scene),
    }
}

/// Chunks of whole frames: nothing is left to join.
fn plan_frames(arguments: &PlanArguments, scene: &Scene, frames: &FrameList) -> Result<Exit, Failure> {
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
    let seconds = guess_time(&first)?;
    let [width, height] = scene.film.size;
    let host_bytes = host_bytes(scene);
    let spp = scene.render.spp;
    let output = output.display().to_string();
    let cut = chunks(count, arguments.chunks).enumerate().map(|(index, range)| {
        let frames = FrameList::words(&numbers[range.start as usize..range.end as usize]);
        let mut command = render_command(arguments);
        command.extend(["--frames".into(), frames.clone(), "--spp".into(), spp.to_string()]);
        command.extend(["--resume".into(), "-o".into(), output.clone()]);
        Chunk {
            index: index as u32,
            frames: Some(frames),
            first_sample: 0,
            spp,
            output: output.clone(),
            shell: shell(&command),
            command,
            device_bytes,
            host_bytes,
            cpu_seconds: seconds * range.len() as f64,
        }
    });
    let chunks = cut.collect();
    let scene = scene.name.clone();
    terminal::answer_json(&Job { scene, width, height, spp, device, chunks, merge: None, exit_codes: ExitCodes::default() })?;
    Ok(Exit::Done)
}

/// What a chunk's render takes of the host's memory.
fn host_bytes(scene: &Scene) -> u64 {
    let pixels = scene.film.size.map(u64::from).iter().product();
    host_memory(scene, &HostNeeds { pixels, checkpoint: true, ..HostNeeds::default() }).total()
}

/// The words with which every chunk's command begins: the scene, and what is set for it.
fn render_command(arguments: &PlanArguments) -> Vec<String> {
    let mut command: Vec<String> = vec!["gpt".into(), "render".into(), arguments.scene.to_string_lossy().into_owned()];
    if let Some([width, height]) = arguments.size {
        command.extend(["--size".into(), format!("{width}x{height}")]);
    }
    for assignment in arguments.settings.0.iter().filter(|assignment| assignment.setting().name != "spp") {
        command.extend([assignment.setting().flag.into(), assignment.value().to_string()]);
    }
    if !arguments.aov.is_empty() {
        command.extend(["--aov".into(), Layer::list(&arguments.aov)]);
    }
    if let Some(root) = &arguments.access.assets_root {
        command.extend(["--assets-root".into(), root.display().to_string()]);
    }
    command
}

/// Chunks of the samples of one picture, and the command that joins them.
fn plan_samples(arguments: &PlanArguments, scene: &Scene) -> Result<Exit, Failure> {
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
    let (device, device_bytes) = device_memory(scene)?;
    let seconds = guess_time(scene)?;
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
            let mut command = render_command(arguments);
            command.extend(["--first-sample".into(), samples.start.to_string(), "--spp".into(), count.to_string()]);
            command.extend(["--resume".into(), "-o".into(), output.clone()]);
            Chunk {
                index,
                frames: None,
                first_sample: samples.start,
                spp: count,
                output,
                shell: shell(&command),
                command,
                device_bytes,
                host_bytes,
                cpu_seconds: seconds * f64::from(count) / f64::from(spp),
            }
        })
        .collect();
    let output = output.display().to_string();
    let mut command: Vec<String> = vec!["gpt".into(), "merge".into()];
    command.extend(cut.iter().map(|chunk| chunk.output.clone()));
    command.extend(["--spp".into(), spp.to_string(), "-o".into(), output.clone()]);
    let merge = Merge { output, shell: shell(&command), command, host_bytes: MERGE_PROGRAM_BYTES + pixels * MERGE_BYTES };
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

/// The words of a command as a POSIX shell reads them.
fn shell(command: &[String]) -> String {
    let plain = |word: &str| {
        !word.is_empty() && word.chars().all(|letter| letter.is_ascii_alphanumeric() || "-_./:,=+@%".contains(letter))
    };
    let quoted = |word: &String| if plain(word) { word.clone() } else { format!("'{}'", word.replace('\'', r"'\''")) };
    command.iter().map(quoted).collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shells_read_the_words_as_they_are() {
        let words = ["gpt", "my scene.toml", "it's", "--spp", "4", ""].map(str::to_owned);
        assert_eq!(shell(&words), r"gpt 'my scene.toml' 'it'\''s' --spp 4 ''");
    }
}
