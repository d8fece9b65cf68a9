//! Cryptomatte: which objects and materials cover a pixel, and how much of it (Friedman and Jones 2015, "Fully automatic ID mattes with support
//! for motion blur and transparency"; files as Psyop's specification 1.2.0 has them).
//!
//! Rays are those of the picture's own samples, followed by the CPU to the first surface that does not let them through. So mattes are the same
//! whatever device renders the picture, and edges, defocus and motion are as soft as they are in it.

mod names;
mod rank;

use std::io;
use std::sync::Arc;

use rayon::prelude::*;

use crate::cpu::ReferenceRenderer;
use crate::film::KernelLayer;
use crate::output::{LayerChannel, LayerPicture, LayerSource};
use crate::reference::layer::layer_scene;
use crate::renderer::{Observer, RenderError};
use crate::sampling::{Sampling, SequencePoint};
use crate::scene::Scene;

use names::Names;
use rank::{RANKS, ranked};

/// Samples of a pixel at most whose rays are followed: coverage is known to its inverse.
const MOST_SAMPLES: u32 = 128;
/// Rows that are followed at a time, before anybody is asked whether to go on.
const ROWS: u32 = 16;
/// Numbers of a pixel that a [`LayerPicture`] has.
const IN_PICTURE: usize = 3;

/// A kind of matte: by object, by material or by name.
struct Kind {
    name: &'static str,
    /// Identifier and coverage of each rank, in pairs.
    channels: [&'static str; 2 * RANKS],
    names: fn(&Scene) -> Names,
}

/// The channels of three layers of two ranks each.
macro_rules! channels {
    ($($layer:literal)*) => { [$(concat!($layer, ".R"), concat!($layer, ".G"), concat!($layer, ".B"), concat!($layer, ".A"),)*] };
}

const KINDS: [Kind; 2] = [
    Kind {
        name: "CryptoObject",
        channels: channels!("CryptoObject00" "CryptoObject01" "CryptoObject02"),
        names: |scene| Names::of(scene.shapes.iter().map(|shape| shape.label.as_str())),
    },
    Kind {
        name: "CryptoMaterial",
        channels: channels!("CryptoMaterial00" "CryptoMaterial01" "CryptoMaterial02"),
        names: |scene| Names::of(scene.materials.iter().map(|material| material.name.as_str())),
    },
];

/// The header entries of a file with mattes: their names, how these are hashed, and the hashes.
pub fn notes(scene: &Scene) -> Vec<(String, String)> {
    KINDS.iter().flat_map(|kind| (kind.names)(scene).notes(kind.name)).collect()
}

/// The channels of mattes.
pub fn channel_names() -> impl Iterator<Item = &'static str> {
    KINDS.into_iter().flat_map(|kind| kind.channels)
}

/// The channels of mattes whose numbers these pictures hold, three channels each.
pub fn channels(pictures: &[Arc<LayerPicture>]) -> Vec<LayerChannel> {
    let source = |place: usize| LayerSource::Component(pictures[place / IN_PICTURE].clone(), place % IN_PICTURE);
    channel_names().enumerate().map(|(place, name)| LayerChannel::new(name, source(place))).collect()
}

/// The mattes of objects and materials in a region of the picture: first column and row, width and height. None where the observer stopped it.
///
/// # Errors
/// A scene that is not valid, and what temporary files do.
pub fn mattes(
    scene: &Scene,
    [left, top, width, height]: [u32; 4],
    observer: &dyn Observer,
) -> Result<Option<Vec<LayerChannel>>, RenderError> {
    let names = KINDS.each_ref().map(|kind| (kind.names)(scene));
    let first = layer_scene(scene, KernelLayer::Position);
    let reference = ReferenceRenderer::new(&first)?;
    let samples = scene.render.spp.clamp(1, MOST_SAMPLES);
    let sampling = Sampling::from(&scene.render);
    let points: Vec<SequencePoint> = (0..samples).map(|sample| SequencePoint::new(&sampling, sample)).collect();
    let pictures = KINDS.each_ref().map(|_| pictures([width, height]));
    let [objects, materials] = pictures;
    let pictures = [objects?, materials?];
    let total = u64::from(height);
    for start in (0..height).step_by(ROWS as usize) {
        if observer.stop_requested() {
            return Ok(None);
        }
        let rows: Vec<[Vec<[f32; 2 * RANKS]>; 2]> = (start..(start + ROWS).min(height))
            .into_par_iter()
            .map(|y| {
                let owners = (0..width).map(|x| reference.owners(left + x, top + y, &points));
                let (mut of_objects, mut of_materials) = (Vec::new(), Vec::new());
                for owners in owners {
                    of_objects.push(ranked(owners.iter().map(|(owner, share)| (names[0].id(owner[0]), *share)), samples));
                    of_materials.push(ranked(owners.iter().map(|(owner, share)| (names[1].id(owner[1]), *share)), samples));
                }
                [of_objects, of_materials]
            })
            .collect();
        for (row, kinds) in rows.iter().enumerate() {
            for (pixels, pictures) in kinds.iter().zip(&pictures) {
                write_row(pictures, start + row as u32, pixels)?;
            }
        }
        observer.progress(u64::from((start + ROWS).min(height)), total);
    }
    Ok(Some(channels(&pictures.concat())))
}

fn pictures(size: [u32; 2]) -> io::Result<Vec<Arc<LayerPicture>>> {
    (0..2 * RANKS / IN_PICTURE).map(|_| LayerPicture::new(size).map(Arc::new)).collect()
}

fn write_row(pictures: &[Arc<LayerPicture>], y: u32, pixels: &[[f32; 2 * RANKS]]) -> io::Result<()> {
    for (number, picture) in pictures.iter().enumerate() {
        let part = |pixel: &[f32; 2 * RANKS]| std::array::from_fn(|place| pixel[number * IN_PICTURE + place]);
        let row: Vec<[f32; IN_PICTURE]> = pixels.iter().map(part).collect();
        picture.write_rows(y, &row)?;
    }
    Ok(())
}
