//! `--checkpoint` and `--resume`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use gpt::film::{KernelLayer, RenderedLayer};
use gpt::output::{OutputError, PictureFormat, PictureSpec, is_finished_picture};
use gpt::render::checkpoint::{Checkpoint, DEFAULT_INTERVAL, Identity, path_beside, path_of_layer, remove_state};
use gpt::scene::BulkDigest;
use gpt::{RenderOptions, Renderer, Scene};

use super::arguments::CheckpointArguments;
use super::exit::Failure;
use super::pictures::is_stdout;
use super::terminal;

/// The checkpoint of a render, if it has one.
pub struct Kept {
    pub checkpoint: Option<Checkpoint>,
    /// Samples that an earlier render finished, over all pixels.
    pub resumed_samples: u64,
    /// The place of the last state, or why it could not be saved.
    saved: Option<Result<PathBuf, OutputError>>,
}

/// Checks that there is a file to put a state beside, if one is asked for.
///
/// # Errors
/// A usage error.
pub fn check(arguments: &CheckpointArguments, outputs: &[(PathBuf, PictureFormat)]) -> Result<(), Failure> {
    if arguments.is_asked_for() && first_file(outputs).is_none() {
        return Err(Failure::usage(
            "--checkpoint and --resume keep their state beside a picture file, and standard output is none: add -o FILE",
        ));
    }
    Ok(())
}

impl CheckpointArguments {
    /// True if states are saved.
    pub fn is_asked_for(&self) -> bool {
        self.checkpoint.is_some() || self.resume
    }
}

/// The state that is kept beside pictures, where one is.
pub fn state_beside(arguments: &CheckpointArguments, outputs: &[PathBuf]) -> Option<PathBuf> {
    let first = outputs.iter().find(|path| !is_stdout(path)).filter(|_| arguments.is_asked_for());
    first.map(|path| path_beside(path))
}

fn first_file(outputs: &[(PathBuf, PictureFormat)]) -> Option<&Path> {
    outputs.iter().map(|(path, _)| path.as_path()).find(|path| !is_stdout(path))
}

/// True if every picture stands in its place, finished and of this render. `shown` is what is known of the
/// files beside the render.
pub fn all_are_finished(
    outputs: &[(PathBuf, PictureFormat)],
    (scene, bulk): (&Scene, Option<&BulkDigest>),
    options: &RenderOptions,
    shown: &PictureSpec,
) -> bool {
    if outputs.iter().any(|(path, _)| is_stdout(path) || !path.is_file()) {
        return false;
    }
    let provenance = match bulk {
        Some(bulk) => Renderer::provenance_with(bulk, scene, options, ""),
        None => Renderer::provenance_of(scene, options, ""),
    };
    let provenance = Some(provenance);
    let [width, height] = options.crop.map_or(scene.film.size, |[_, _, width, height]| [width, height]);
    let spec = PictureSpec { width, height, provenance, ..shown.clone() };
    outputs.iter().all(|(path, format)| is_finished_picture(path, *format, &spec))
}

/// The picture beside which states stand, where they are asked for.
fn kept_picture<'o>(arguments: &CheckpointArguments, outputs: &'o [(PathBuf, PictureFormat)]) -> Option<&'o Path> {
    first_file(outputs).filter(|_| arguments.is_asked_for())
}

/// Looks for the state of this identity that the render goes on from, and how many samples it has, over all pixels.
fn begin(
    (path, identity): (PathBuf, Identity),
    arguments: &CheckpointArguments,
    renderer: &Renderer,
    started: Instant,
    quiet: bool,
) -> Result<(Checkpoint, u64), Failure> {
    let interval = arguments.checkpoint.unwrap_or(DEFAULT_INTERVAL);
    let mut checkpoint = Checkpoint::new(path, identity, renderer.device(), interval, started)?;
    let place = checkpoint.path().display().to_string();
    if !arguments.resume {
        if checkpoint.path().exists() {
            terminal::note(&format!(
                "{place} is the state of an earlier render and will be replaced; --resume would go on from it"
            ));
        }
        return Ok((checkpoint, 0));
    }
    let Some((device, samples)) = checkpoint.find(renderer.film())? else { return Ok((checkpoint, 0)) };
    if device != renderer.device() {
        let ours = renderer.device();
        terminal::note(&format!("{place} was rendered on {device}, and {ours} goes on: the picture has the rounding of both"));
    }
    if !quiet {
        terminal::note(&format!("going on from {place}, {}", terminal::with_unit(samples as f64, "samples")));
    }
    Ok((checkpoint, samples))
}

/// The checkpoint of a layer, if there shall be one.
///
/// # Errors
/// The errors of [`Kept::begin`].
pub fn of_layer(
    arguments: &CheckpointArguments,
    (renderer, layer): (&Renderer, &RenderedLayer),
    outputs: &[(PathBuf, PictureFormat)],
    started: Instant,
    quiet: bool,
) -> Result<Option<Checkpoint>, Failure> {
    let Some(picture) = kept_picture(arguments, outputs) else { return Ok(None) };
    let state = (path_of_layer(picture, layer), renderer.identity().of_layer(layer));
    Ok(Some(begin(state, arguments, renderer, started, quiet)?.0))
}

/// Removes the states of layers: the picture with them is in its place.
pub fn remove_of_layers(arguments: &CheckpointArguments, outputs: &[(PathBuf, PictureFormat)], scene: &Scene) {
    if let Some(picture) = kept_picture(arguments, outputs) {
        let groups = scene.light_group_names().into_iter().map(|group| RenderedLayer::LightGroup(group.to_owned()));
        let layers = KernelLayer::ALL.into_iter().map(RenderedLayer::Kernel).chain(groups);
        layers.for_each(|layer| remove_state(&path_of_layer(picture, &layer)));
    }
}

/// Removes the states of a render that was killed after its picture was in place.
pub fn remove_beside_finished(arguments: &CheckpointArguments, outputs: &[(PathBuf, PictureFormat)], scene: &Scene) {
    if let Some(picture) = kept_picture(arguments, outputs) {
        remove_state(&path_beside(picture));
    }
    remove_of_layers(arguments, outputs, scene);
}

impl Kept {
    /// Looks for the state that the render goes on from.
    ///
    /// # Errors
    /// A state of another render, or a place where none can be.
    pub fn begin(
        arguments: &CheckpointArguments,
        renderer: &Renderer,
        outputs: &[(PathBuf, PictureFormat)],
        started: Instant,
        quiet: bool,
    ) -> Result<Self, Failure> {
        let mut kept = Self { checkpoint: None, resumed_samples: 0, saved: None };
        if let Some(picture) = kept_picture(arguments, outputs) {
            let found = begin((path_beside(picture), renderer.identity()), arguments, renderer, started, quiet)?;
            (kept.checkpoint, kept.resumed_samples) = (Some(found.0), found.1);
        }
        Ok(kept)
    }

    /// Waits for the last state of a render that broke off. Whether there is one.
    pub fn save(&mut self) -> bool {
        let Some(checkpoint) = &mut self.checkpoint else { return false };
        let path = checkpoint.path().to_owned();
        self.saved = match checkpoint.finish() {
            Ok(true) => Some(Ok(path)),
            Ok(false) => None,
            Err(failure) => Some(Err(failure)),
        };
        matches!(self.saved, Some(Ok(_)))
    }

    /// Says where the state is of a render that broke off, and why there is none.
    pub fn tell(&self) {
        match &self.saved {
            None => {}
            Some(Ok(path)) => terminal::note(&format!("{}: the state is saved; --resume goes on from it", path.display())),
            Some(Err(failure)) => terminal::warn(&format!("the state of the render is not saved: {failure}")),
        }
    }

    /// Removes the state: the picture is finished.
    pub fn remove(&mut self) {
        if let Some(checkpoint) = self.checkpoint.take() {
            checkpoint.remove();
        }
    }
}
