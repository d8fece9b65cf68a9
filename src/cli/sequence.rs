//! The frames of one render, one after the other: what does not change is made ready once.

use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::load::SceneError;
use gpt::output::PictureFormat;
use gpt::render::choice::Choice;
use gpt::renderer::RenderError;
use gpt::scene::{BulkDigest, InvalidScene};
use gpt::{RenderOptions, Renderer, Scene};

use super::arguments::RenderArguments;
use super::exit::{Exit, Failure};
use super::frames::{Moment, named};
use super::pictures::is_stdout;
use super::progress::{Progress, Span};
use super::render::{self, Done, Frame};
use super::stats::{self, Stats};
use super::{interrupt, terminal};

/// What a frame begins with.
pub enum Ready {
    /// The first one: a device that may still be opening.
    Device(Choice),
    /// A later one: the renderer of the frame before, and that frame.
    Renderer(Box<Renderer>, Box<Scene>),
}

impl Ready {
    /// Makes a frame ready.
    ///
    /// # Errors
    /// As [`Renderer::on`].
    pub fn renderer(self, scene: &Scene, options: &RenderOptions) -> Result<Renderer, RenderError> {
        match self {
            Self::Device(choice) => Renderer::on(choice, scene, options),
            Self::Renderer(renderer, before) => renderer.at_frame(&before, scene),
        }
    }

    /// What was hashed for an earlier frame.
    pub fn bulk_digest(&self) -> Option<&BulkDigest> {
        match self {
            Self::Device(_) => None,
            Self::Renderer(renderer, _) => Some(renderer.bulk_digest()),
        }
    }
}

/// What all frames have in common.
pub struct Sequence<'a> {
    pub arguments: &'a RenderArguments,
    pub options: &'a RenderOptions,
    /// As it is without a frame.
    pub scene: &'a Scene,
    /// Names of files in which the number of the frame is missing.
    pub outputs: &'a [(PathBuf, PictureFormat)],
    pub moments: &'a [Moment],
    /// When the program began, and how long it took to read the scene.
    pub started: Instant,
    pub load_seconds: f64,
}

impl Sequence<'_> {
    /// Renders all frames. The first that breaks off or fails is the last.
    ///
    /// # Errors
    /// What the first frame that fails reports.
    pub fn render(&self, choice: Choice) -> Result<Exit, Failure> {
        let mut ready = Ready::Device(choice);
        let (mut worst, mut all_stats) = (Exit::Done, Vec::new());
        let several = self.arguments.frames.is_sequence();
        for (index, &moment) in self.moments.iter().enumerate() {
            if index > 0 && interrupt::requested() {
                worst = Exit::Interrupted;
                break;
            }
            let span = several.then(|| Span { frame: moment.frame().unwrap_or_default() as u32, index, count: self.moments.len() });
            let done = self.frame((index, moment), ready, span)?;
            all_stats.extend(done.stats);
            if done.exit != Exit::Done {
                worst = done.exit;
            }
            ready = done.ready;
            if worst == Exit::Interrupted {
                break;
            }
        }
        self.write_stats(&all_stats)?;
        if several {
            let names: Vec<String> = self.outputs.iter().map(|(path, _)| path.display().to_string()).collect();
            Progress::end_of_all(self.arguments.progress, worst == Exit::Done, &names);
        }
        Ok(worst)
    }

    fn frame(&self, (index, moment): (usize, Moment), ready: Ready, span: Option<Span>) -> Result<Done, Failure> {
        let number = match moment {
            Moment::Frame(number) => Some(number),
            Moment::Rest | Moment::Between(_) => None,
        };
        let started = if index == 0 { self.started } else { Instant::now() };
        let at_frame = |frame: f64| self.scene.at_frame(frame).map_err(|error| bad_frame(self.scene, &error));
        let scene = moment.frame().map_or_else(|| Ok(self.scene.clone()), at_frame)?;
        let outputs: Vec<(PathBuf, PictureFormat)> =
            self.outputs.iter().map(|(path, format)| (named(path, number), *format)).collect();
        let frame = Frame {
            arguments: self.arguments,
            options: self.options,
            scene,
            outputs: &outputs,
            moment,
            started,
            load_seconds: if index == 0 { self.load_seconds } else { started.elapsed().as_secs_f64() },
            span,
        };
        render::frame(frame, ready)
    }

    /// Writes the statistics of frames that share a file: of the only frame, an object, else a list.
    fn write_stats(&self, all: &[Stats]) -> Result<(), Failure> {
        let Some(path) = self.arguments.stats.as_deref() else { return Ok(()) };
        if has_own_stats(self.arguments, path) {
            return Ok(());
        }
        match all {
            _ if self.arguments.frames.is_sequence() => stats::write(path, &all),
            [only] => stats::write(path, only),
            _ => Ok(()),
        }
    }
}

/// Whether each frame has a file of its own for its statistics.
pub fn has_own_stats(arguments: &RenderArguments, path: &Path) -> bool {
    arguments.frames.first_number().is_some() && !is_stdout(path) && super::frames::has_place(path)
}

fn bad_frame(scene: &Scene, error: &InvalidScene) -> Failure {
    SceneError::in_file(&scene.name, error.to_string()).into()
}

/// Says what a scene with keyframes shows without a frame.
pub fn tell_of_keyframes(scene: &Scene) {
    if let Some([first, last]) = scene.animation.frames() {
        terminal::note(&format!(
            "the scene has keyframes from frame {first} to frame {last}; without --frame, --frames or --time they have no effect"
        ));
    }
}
