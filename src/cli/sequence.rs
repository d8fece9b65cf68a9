//! The frames of one render, one after the other: what does not change is made ready once.

use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::load::SceneError;
use gpt::output::PictureFormat;
use gpt::render::stats::Stats;
use gpt::scene::InvalidScene;
use gpt::{RenderOptions, Renderer, Scene};

use super::arguments::RenderArguments;
use super::exit::{Exit, Failure};
use super::frames::{FrameTime, Span, has_place, named};
use super::pictures::is_stdout;
use super::progress::Progress;
use super::ready::Ready;
use super::render_summary::write_stats;
use super::view::Live;
use super::{interrupt, terminal};

/// One picture: the only one, or a frame of several.
pub struct Frame<'a> {
    pub arguments: &'a RenderArguments,
    pub options: &'a RenderOptions,
    pub scene: &'a Scene,
    pub outputs: &'a [(PathBuf, PictureFormat)],
    pub time: FrameTime,
    /// When it began, and how long it took until the scene was there.
    pub started: Instant,
    pub load_seconds: f64,
    /// Which of several it is.
    pub span: Option<Span>,
    /// The page and the viewer that show it meanwhile.
    pub live: &'a Live,
}

/// The outcome of a frame.
pub enum Done {
    /// The frame was finished before; the means to render it are still there.
    Before(Ready),
    /// A file of the scene changed meanwhile; the renderer is there still, if it was made.
    Outdated(Option<Box<Renderer>>),
    Now {
        exit: Exit,
        renderer: Box<Renderer>,
        stats: Box<Stats>,
    },
}

/// The function that renders a frame.
type Render<'r> = &'r dyn Fn(Frame<'_>, Ready) -> Result<Done, Failure>;

/// The settings that all frames share.
pub struct Sequence<'a> {
    pub arguments: &'a RenderArguments,
    pub options: &'a RenderOptions,
    /// The scene at rest, outside of any frame.
    pub scene: &'a Scene,
    /// Names of files in which the number of the frame is missing.
    pub outputs: &'a [(PathBuf, PictureFormat)],
    pub times: &'a [FrameTime],
    /// When the program began, and how long it took to read the scene.
    pub started: Instant,
    pub load_seconds: f64,
    /// The page and the viewer that show it meanwhile.
    pub live: &'a Live,
}

impl Sequence<'_> {
    /// Renders all frames. The first that breaks off or fails is the last. What rendered it may render another scene.
    ///
    /// # Errors
    /// Errors of the first frame that fails.
    pub fn render(&self, mut ready: Ready, render: Render<'_>) -> Result<(Exit, Option<Ready>), Failure> {
        let (mut worst, mut all_stats) = (Exit::Done, Vec::new());
        let several = self.arguments.frames.is_sequence();
        for (index, &time) in self.times.iter().enumerate() {
            if index > 0 && interrupt::requested() {
                worst = Exit::Interrupted;
                break;
            }
            let span = several.then(|| Span { frame: time.frame().unwrap_or_default() as u32, index, count: self.times.len() });
            let started = if index == 0 { self.started } else { Instant::now() };
            let scene = self.scene_at(time)?;
            match self.frame((index, time, started), &scene, ready, (span, render))? {
                Done::Before(before) => ready = before,
                Done::Outdated(renderer) => {
                    let ready = renderer.map(|renderer| Ready::Renderer(renderer, Box::new(scene.into_owned())));
                    return Ok((Exit::Interrupted, ready));
                }
                Done::Now { exit, renderer, stats } => {
                    all_stats.push(*stats);
                    ready = Ready::Renderer(renderer, Box::new(scene.into_owned()));
                    if exit != Exit::Done {
                        worst = exit;
                    }
                    if worst == Exit::Interrupted {
                        break;
                    }
                }
            }
        }
        self.write_stats(&all_stats)?;
        if several {
            let names: Vec<String> = self.outputs.iter().map(|(path, _)| path.display().to_string()).collect();
            Progress::end_of_all(self.arguments.progress, worst == Exit::Done, &names);
        }
        Ok((worst, Some(ready)))
    }

    fn scene_at(&self, time: FrameTime) -> Result<Cow<'_, Scene>, Failure> {
        let at_frame = |frame: f64| self.scene.at_frame(frame).map(Cow::Owned).map_err(|error| bad_frame(self.scene, &error));
        time.frame().map_or(Ok(Cow::Borrowed(self.scene)), at_frame)
    }

    fn frame(
        &self,
        (index, time, started): (usize, FrameTime, Instant),
        scene: &Scene,
        ready: Ready,
        (span, render): (Option<Span>, Render<'_>),
    ) -> Result<Done, Failure> {
        let outputs: Vec<(PathBuf, PictureFormat)> =
            self.outputs.iter().map(|(path, format)| (named(path, time.number()), *format)).collect();
        let frame = Frame {
            arguments: self.arguments,
            options: self.options,
            scene,
            outputs: &outputs,
            time,
            started,
            load_seconds: if index == 0 { self.load_seconds } else { started.elapsed().as_secs_f64() },
            span,
            live: self.live,
        };
        render(frame, ready)
    }

    /// Writes the statistics of frames that share a file, as a list.
    fn write_stats(&self, all: &[Stats]) -> Result<(), Failure> {
        let shared = self.arguments.stats.as_deref().filter(|path| !has_own_stats(self.arguments, path));
        shared.map_or(Ok(()), |path| write_stats(path, &all))
    }
}

/// True if a picture has a file of its own for its statistics: the only picture, or each of several frames.
pub fn has_own_stats(arguments: &RenderArguments, path: &Path) -> bool {
    !arguments.frames.is_sequence() || (!is_stdout(path) && has_place(path))
}

/// A frame of the scene that cannot be rendered, as a mistake of its file.
pub fn bad_frame(scene: &Scene, error: &InvalidScene) -> Failure {
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
