//! The layers of a render: which are wanted, and the channels that they come to.

use std::path::PathBuf;
use std::time::Instant;

use gpt::choice::Choice;
use gpt::film::Layer;
use gpt::output::{ExrCompression, LayerChannel, PictureFormat, PictureSpec};
use gpt::render::cryptomatte;
use gpt::render::layers::{contradiction, notes_of_groups, render_layers};
use gpt::{RenderOptions, Scene};

use super::arguments::RenderArguments;
use super::checkpoint;
use super::exit::Failure;
use super::progress::Progress;
use super::view::Watching;

/// Why mattes are not rendered in parts.
pub const MATTES_OF_PARTS: &str = "a file keeps the six largest shares of a pixel, so parts of its samples would not add up to the whole picture's; \
     regions (--crop) do";

/// Why intervals are not of parts.
pub const INTERVALS_OF_PARTS: &str = "intervals are of all samples of a picture, and those of parts do not add up to them";

/// Layers that are rendered.
#[derive(Default)]
pub struct Layers {
    channels: Vec<LayerChannel>,
    names: Vec<Layer>,
    /// Entries of the header that say what they hold.
    notes: Vec<(String, String)>,
}

impl Layers {
    /// The channels of all layers.
    pub fn channels(&self) -> &[LayerChannel] {
        &self.channels
    }

    /// The names of the light groups among them.
    pub fn groups(&self, scene: &Scene) -> Vec<String> {
        names_of_groups(&self.names, scene)
    }

    /// The picture with them.
    pub fn in_picture(self, spec: PictureSpec) -> PictureSpec {
        PictureSpec { layers: self.channels, layer_names: self.names, notes: self.notes, ..spec }
    }
}

/// The names of the light groups that are among these layers of a scene.
pub fn names_of_groups(layers: &[Layer], scene: &Scene) -> Vec<String> {
    if layers.contains(&Layer::Groups) { scene.light_group_names().into_iter().map(str::to_owned).collect() } else { Vec::new() }
}

/// The layers that are asked for, by the command line or else by the scene, and those that denoising is helped by.
pub fn wanted(arguments: &RenderArguments, scene: &Scene) -> Vec<Layer> {
    let asked = if arguments.exr.aov.is_empty() { &scene.layers } else { &arguments.exr.aov };
    let helpful: &[Layer] = if arguments.denoise { &[Layer::Albedo, Layer::Normal] } else { &[] };
    asked.iter().chain(helpful).copied().collect()
}

/// The layers that the files of a render will have: those that are wanted, where a file can hold them.
///
/// # Errors
/// A usage error where files or parts cannot have them.
pub fn of_files(arguments: &RenderArguments, scene: &Scene, outputs: &[(PathBuf, PictureFormat)]) -> Result<Vec<Layer>, Failure> {
    let wanted = wanted(arguments, scene);
    if wanted.is_empty() {
        return Ok(wanted);
    }
    let (flag, by_scene) = match (arguments.exr.aov.is_empty(), arguments.denoise) {
        (false, _) => ("--aov", false),
        (true, true) => ("--denoise", false),
        // Files that hold no layers are no mistake of the command line.
        (true, false) => ("[output] of the scene", true),
    };
    if !outputs.iter().any(|(_, format)| *format == PictureFormat::Exr) {
        let no_file = || Failure::usage(format!("{flag}: layers go into an .exr file, and -o names none"));
        return if by_scene { Ok(Vec::new()) } else { Err(no_file()) };
    }
    if wanted.contains(&Layer::Cryptomatte) {
        if arguments.exr.compression == ExrCompression::Pxr24 {
            let why = "cryptomatte: --compression pxr24 drops bits of numbers, and identifiers need all of theirs";
            return Err(Failure::usage(format!("{flag} {why}")));
        }
        if arguments.estimate.first_sample.is_some() {
            return Err(Failure::usage(format!("{flag} cryptomatte with --first-sample: {MATTES_OF_PARTS}")));
        }
    }
    Ok(wanted)
}

/// Layers are rendered only of scenes that have them: light groups where they add up to the picture, motion vectors where it is flat.
///
/// # Errors
/// A usage error about the first that is not.
pub fn check(arguments: &RenderArguments, options: &RenderOptions, (scene, wanted): (&Scene, &[Layer])) -> Result<(), Failure> {
    let asked = if arguments.exr.aov.is_empty() { "[output] of the scene:" } else { "--aov" };
    match contradiction(wanted, scene, options) {
        Some((layer, message)) => Err(Failure::usage(format!("{asked} {}: {message}", layer.name()))),
        None => Ok(()),
    }
}

/// Renders these layers. With `--checkpoint`, each has a state of its own.
///
/// # Errors
/// Errors of the device and the files, and an interrupt.
pub fn render(
    arguments: &RenderArguments,
    options: &RenderOptions,
    (scene, wanted): (&Scene, Vec<Layer>),
    outputs: &[(PathBuf, PictureFormat)],
    (started, progress, watching): (Instant, &Progress, &Watching<'_>),
) -> Result<Layers, Failure> {
    if wanted.is_empty() {
        return Ok(Layers::default());
    }
    let of_part = arguments.estimate.is_part();
    let mut last = None;
    let rendered = render_layers(scene, options, (&wanted, of_part), watching, &mut |renderer, layer| {
        progress.clear();
        let kept = checkpoint::of_layer(&arguments.checkpoint, (renderer, layer), outputs, started, arguments.quiet)?;
        last = kept.as_ref().map(|checkpoint| checkpoint.path().to_owned());
        Ok::<_, Failure>(kept)
    });
    progress.clear();
    let Some(channels) = rendered? else {
        return Err(last.filter(|path| path.exists()).map_or(Failure::Interrupted, Failure::InterruptedWithState));
    };
    let mut notes = if wanted.contains(&Layer::Cryptomatte) { cryptomatte::notes(scene) } else { Vec::new() };
    if wanted.contains(&Layer::Groups) {
        notes.extend(notes_of_groups(scene));
    }
    Ok(Layers { channels, names: wanted, notes })
}
