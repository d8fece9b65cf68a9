//! Runs a renderer's command for one picture.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use gpt::output::read_image;
use gpt::renderer::DeviceChoice;

use super::arguments::{KnownRenderer, RunArguments, SceneForm};
use crate::cli::exit::Failure;
use crate::cli::interrupt;

/// Runners of renderers that are Python packages, each one small file: `RUNNER {scene} {output} {spp} {seed} …`.
const MITSUBA: &str = include_str!("runners/run_mitsuba.py");
const CYCLES: &str = include_str!("runners/run_cycles.py");
const LUXCORE: &str = include_str!("runners/run_luxcore.py");

/// The status by which a renderer says that it cannot be asked for this scene; its last line is the reason.
const NOT_SUPPORTED: i32 = 64;

/// How often a renderer is looked after.
const POLL: Duration = Duration::from_millis(10);

/// A renderer as a command.
pub struct Runner {
    /// Its name in reports.
    pub name: String,
    pub form: SceneForm,
    /// The program and its arguments, in which words in braces stand for values.
    words: Vec<String>,
    timeout: Duration,
}

/// One picture that is wanted.
pub struct Wanted<'a> {
    pub scene: &'a Path,
    pub output: &'a Path,
    pub size: [u32; 2],
    pub spp: u32,
    pub seed: u32,
}

impl Runner {
    /// The renderer that the arguments name; None where pictures are given. Runners are written to `folder`.
    ///
    /// # Errors
    /// A command that cannot be parsed; files that cannot be written.
    pub fn of(arguments: &RunArguments, folder: &Path) -> Result<Option<Self>, Failure> {
        let of_python = |name: &str, text: &str| -> Result<Vec<String>, Failure> {
            let path = folder.join(name);
            std::fs::write(&path, text).map_err(|error| Failure::Other(format!("{}: {error}", path.display())))?;
            let words = ["{scene}", "{output}", "{spp}", "{seed}"].map(str::to_owned);
            Ok([arguments.python.clone(), path.display().to_string()].into_iter().chain(words).collect())
        };
        let (name, form, words) = match (arguments.renderer, &arguments.command) {
            (Some(KnownRenderer::Gpt), _) => {
                let program = std::env::current_exe().map_err(|error| Failure::Other(format!("the program itself: {error}")))?;
                let mut words = vec![program.display().to_string()];
                words.extend(
                    ["render", "{scene}", "--spp", "{spp}", "--seed", "{seed}", "-o", "{output}", "--quiet"].map(str::to_owned),
                );
                words.extend(["--device".to_owned(), device_word(&arguments.device)]);
                ("gpt", SceneForm::Toml, words)
            }
            (Some(KnownRenderer::Mitsuba), _) => {
                let words = of_python("run_mitsuba.py", MITSUBA)?.into_iter().chain(["llvm_ad_rgb".to_owned()]).collect();
                ("Mitsuba (llvm)", SceneForm::Mitsuba, words)
            }
            (Some(KnownRenderer::MitsubaScalar), _) => {
                let words = of_python("run_mitsuba.py", MITSUBA)?.into_iter().chain(["scalar_rgb".to_owned()]).collect();
                ("Mitsuba (scalar)", SceneForm::Mitsuba, words)
            }
            (Some(KnownRenderer::Cycles), _) => {
                let words =
                    of_python("run_cycles.py", CYCLES)?.into_iter().chain(["{width}", "{height}"].map(str::to_owned)).collect();
                ("Cycles", SceneForm::Gltf, words)
            }
            (Some(KnownRenderer::Luxcore), _) => ("LuxCore", SceneForm::Toml, of_python("run_luxcore.py", LUXCORE)?),
            (None, Some(command)) => {
                let words = words_of(command)?;
                let name = Path::new(&words[0]).file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
                let name = arguments.name.clone().unwrap_or(name);
                return Ok(Some(Self { name, form: arguments.form, words, timeout: arguments.timeout }));
            }
            (None, None) => return Ok(None),
        };
        let name = arguments.name.clone().unwrap_or_else(|| name.to_owned());
        Ok(Some(Self { name, form, words, timeout: arguments.timeout }))
    }

    /// The command as it is run, for reports.
    pub fn command(&self) -> String {
        self.words.iter().map(|word| crate::cli::shell::quoted(word)).collect::<Vec<_>>().join(" ")
    }

    /// Renders a picture.
    ///
    /// # Errors
    /// A sentence on what the renderer did wrong, or cannot do.
    pub fn render(&self, wanted: &Wanted<'_>) -> Result<Picture, NoPicture> {
        self.run(wanted).map_err(NoPicture::Failed).and_then(|refused| match refused {
            Some(reason) => Err(NoPicture::NotSupported(reason)),
            None => read(wanted.output).map_err(NoPicture::Failed),
        })
    }

    /// Runs the command; the reason, where it says that it cannot be asked.
    fn run(&self, wanted: &Wanted<'_>) -> Result<Option<String>, String> {
        let values = [
            ("{scene}", wanted.scene.display().to_string()),
            ("{output}", wanted.output.display().to_string()),
            ("{spp}", wanted.spp.to_string()),
            ("{seed}", wanted.seed.to_string()),
            ("{width}", wanted.size[0].to_string()),
            ("{height}", wanted.size[1].to_string()),
        ];
        let filled = |word: &String| values.iter().fold(word.clone(), |word, (name, value)| word.replace(name, value));
        let words: Vec<String> = self.words.iter().map(filled).collect();
        let _ = std::fs::remove_file(wanted.output);
        let log_path = wanted.output.with_extension("log");
        let log = std::fs::File::create(&log_path).map_err(|error| format!("{}: {error}", log_path.display()))?;
        let errors = log.try_clone().map_err(|error| error.to_string())?;
        let mut command = Command::new(&words[0]);
        command.args(&words[1..]).stdin(Stdio::null()).stdout(log).stderr(errors);
        let mut child = command.spawn().map_err(|error| format!("`{}` cannot be run: {error}", words[0]))?;
        let start = Instant::now();
        let status = loop {
            match child.try_wait() {
                Ok(Some(status)) => break status,
                Ok(None) if start.elapsed() > self.timeout || interrupt::requested() => {
                    let _ = child.kill();
                    let _ = child.wait();
                    return Err(format!("it took more than {} s", self.timeout.as_secs_f64()));
                }
                Ok(None) => std::thread::sleep(POLL),
                Err(error) => return Err(format!("it cannot be waited for: {error}")),
            }
        };
        if status.success() {
            return Ok(None);
        }
        let said = std::fs::read(&log_path).unwrap_or_default();
        let last = last_words(&String::from_utf8_lossy(&said));
        if status.code() == Some(NOT_SUPPORTED) { Ok(Some(last)) } else { Err(format!("it ended with {status}: {last}")) }
    }
}

/// The reason why there is no picture, in a sentence.
pub enum NoPicture {
    /// The renderer cannot be asked.
    NotSupported(String),
    Failed(String),
}

/// A picture that was read.
pub struct Picture {
    pub width: u32,
    pub pixels: Vec<[f32; 3]>,
}

/// Reads a picture of linear numbers.
///
/// # Errors
/// A sentence: it is missing, cannot be read, or holds codes of 8 bits.
pub fn read(path: &Path) -> Result<Picture, String> {
    let bytes = std::fs::read(path).map_err(|_| "it wrote no picture".to_owned())?;
    let codes: [(&[u8], &str); 3] = [(b"\x89PNG", "PNG"), (b"\xff\xd8\xff", "JPEG"), (b"GIF8", "GIF")];
    if let Some((_, format)) = codes.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Err(format!("its picture is a {format}: codes for a display, not linear numbers"));
    }
    let image = read_image(path).map_err(|error| error.to_string())?;
    Ok(Picture { width: image.width, pixels: image.pixels })
}

fn device_word(device: &DeviceChoice) -> String {
    match device {
        DeviceChoice::Auto => "auto".to_owned(),
        DeviceChoice::Gpu => "gpu".to_owned(),
        DeviceChoice::Cpu => "cpu".to_owned(),
        DeviceChoice::Named(name) => name.clone(),
    }
}

/// The last line that is not empty, cut to a sentence's length.
fn last_words(text: &str) -> String {
    let line = text.lines().rev().map(str::trim).find(|line| !line.is_empty()).unwrap_or("it said nothing");
    line.chars().take(300).collect()
}

/// The words of a command, between blanks; quotation marks hold a word together.
fn words_of(command: &str) -> Result<Vec<String>, Failure> {
    let (mut words, mut word, mut mark) = (Vec::new(), None::<String>, None);
    for character in command.chars() {
        match (mark, character) {
            (Some(open), close) if open == close => mark = None,
            (Some(_), inner) => word.get_or_insert_default().push(inner),
            (None, '\'' | '"') => {
                mark = Some(character);
                word.get_or_insert_default();
            }
            (None, blank) if blank.is_whitespace() => words.extend(word.take()),
            (None, plain) => word.get_or_insert_default().push(plain),
        }
    }
    if mark.is_some() {
        return Err(Failure::usage("a quotation mark of --command is not closed"));
    }
    words.extend(word);
    if words.is_empty() {
        return Err(Failure::usage("--command is empty"));
    }
    for needed in ["{scene}", "{output}"] {
        if !words.iter().any(|word| word.contains(needed)) {
            return Err(Failure::usage(format!("--command has no {needed}")));
        }
    }
    Ok(words)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_cut_into_words() {
        let words = words_of("a  'b c' --x=\"{scene}\" {output} ''").expect("it is a command");
        assert_eq!(words, ["a", "b c", "--x={scene}", "{output}", ""]);
        for bad in ["", "a {scene}", "a {output}", "a 'b {scene} {output}"] {
            assert!(words_of(bad).is_err(), "{bad}");
        }
    }
}
