//! Scenes of pbrt-v4.
//!
//! `lexer` and `parameter` read the text, `directives` follows it from one directive to the next and puts what it describes into a `world`, with the
//! transforms and the other `graphics_state` in force. The other modules say in the terms of scene files what each thing of the world means. Whatever
//! parameter no module asked for ends up in the report.

mod camera;
mod color_space;
mod converter;
mod directives;
mod graphics_state;
mod infinite;
mod infinite_lights;
mod instance;
mod lexer;
mod light;
mod material;
mod medium;
mod motion;
mod named_spectra;
mod parameter;
mod shape;
mod spectrum;
#[cfg(test)]
mod tests;
mod text;
mod texture;
mod texture_entry;
mod texture_node;
mod world;

use std::path::Path;

use self::converter::Converter;
use self::directives::Reader;
use super::error::SceneError;
use super::files::Files;
use super::import::{Description, handedness};

/// Reads a scene.
pub fn load(files: &Files, path: &Path) -> Result<Description, SceneError> {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let mut reader = Reader::new(files, folder.clone());
    reader.scene(path)?;
    let Reader { world, report, .. } = reader;
    let mut converter = Converter::new(files, folder, world);
    converter.scene.report.append(report);
    converter.all()?;
    let Converter { mut scene, .. } = converter;
    handedness::turn_mirrored(&mut scene);
    Ok(scene)
}
