//! `gpt plan`.

use std::path::PathBuf;

use gpt::load;
use gpt::merge::chunks;
use gpt::render::options::PARTS_OF_STRATA;
use serde::Serialize;

use super::arguments::PlanArguments;
use super::check::{device_memory, guess_time};
use super::exit::{Exit, Failure};
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
    merge: Merge,
    exit_codes: ExitCodes,
}

#[derive(Serialize)]
struct Chunk {
    index: u32,
    /// Absolute index of the first sample, and samples per pixel.
    first_sample: u32,
    spp: u32,
    output: String,
    command: Vec<String>,
    /// The same for a shell.
    shell: String,
    device_bytes: u64,
    /// What the host holds of the film at most, and of a checkpoint.
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

/// Bytes a pixel: of the state of a render, and of the sums of a merge.
const STATE_BYTES: u64 = 36;
const MERGE_BYTES: u64 = 40 + 40;

/// Prints the chunks of a job as JSON.
pub fn run(arguments: &PlanArguments) -> Result<Exit, Failure> {
    let mut scene = load::load_with(Some(&arguments.scene), &arguments.access.options(false))?;
    settings::apply_to(arguments.size, &arguments.settings, &mut scene)?;
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
    let (device, device_bytes) = device_memory(&scene)?;
    let seconds = guess_time(&scene)?;
    let pixels = scene.film.size.map(u64::from).iter().product::<u64>();
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
            let mut command: Vec<String> = vec!["gpt".into(), "render".into(), arguments.scene.to_string_lossy().into_owned()];
            if let Some([width, height]) = arguments.size {
                command.extend(["--size".into(), format!("{width}x{height}")]);
            }
            for assignment in arguments.settings.0.iter().filter(|assignment| assignment.setting().name != "spp") {
                command.extend([assignment.setting().flag.into(), assignment.value().to_string()]);
            }
            if let Some(root) = &arguments.access.assets_root {
                command.extend(["--assets-root".into(), root.display().to_string()]);
            }
            command.extend(["--first-sample".into(), samples.start.to_string(), "--spp".into(), count.to_string()]);
            command.extend(["--resume".into(), "-o".into(), output.clone()]);
            Chunk {
                index,
                first_sample: samples.start,
                spp: count,
                output,
                shell: shell(&command),
                command,
                device_bytes,
                host_bytes: pixels * STATE_BYTES,
                cpu_seconds: seconds * f64::from(count) / f64::from(spp),
            }
        })
        .collect();
    let output = output.display().to_string();
    let mut command: Vec<String> = vec!["gpt".into(), "merge".into()];
    command.extend(cut.iter().map(|chunk| chunk.output.clone()));
    command.extend(["--spp".into(), spp.to_string(), "-o".into(), output.clone()]);
    let merge = Merge { output, shell: shell(&command), command, host_bytes: pixels * MERGE_BYTES };
    let [width, height] = scene.film.size;
    let exit_codes = ExitCodes { done: [0], retry: [5, 130], give_up: [2, 3, 4] };
    terminal::answer_json(&Job { scene: scene.name.clone(), width, height, spp, device, chunks: cut, merge, exit_codes })?;
    Ok(Exit::Done)
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
