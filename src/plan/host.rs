//! How much of the host's memory a render takes, stated before it is taken.
//!
//! Unlike the device's arrays, which the plan sizes, these are estimates by what was measured (`docs/large-jobs.md`): readers, hierarchies in the
//! making and drivers take what they take. The peak of a render's resident memory is within [`HOST_FACTOR`] of it either way.

use std::collections::HashSet;
use std::ptr;
use std::sync::Arc;

use super::memory::Memory;
use crate::film::MOST_FILM_PIXELS;
use crate::scene::{ImageData, Light, MediumGrids, Scene, SceneSummary, TextureKind};

/// By how much an estimate may be off, either way.
pub const HOST_FACTOR: f64 = 2.0;

/// The program itself on the CPU, and with a graphics driver: a software driver compiles kernels, and keeps what it compiles.
const PROGRAM_BYTES: [u64; 2] = [22 << 20, 170 << 20];
/// A triangle as it is read, packed and sorted into a hierarchy.
const TRIANGLE_BYTES: u64 = 350;
/// A place where a group stands.
const INSTANCE_BYTES: u64 = 350;
/// Bytes for each of a picture's: as it is decoded, and as it is packed.
const PICTURE_FACTOR: u64 = 2;
/// Bytes for each of a grid's: as it is read, and as it is packed.
const GRID_FACTOR: u64 = 2;
/// Bytes per pixel of the film's sums: on the CPU; on a device, with the copy that is read back. A software
/// device's film is in the host's memory.
const FILM_BYTES: [u64; 2] = [36, 64];
/// Bytes per pixel of rows on their way to files.
const BAND_BYTES: u64 = 24;
/// Pixels on their way to files at a time, at most.
const BAND_PIXELS: u64 = 1 << 20;
/// Bytes per pixel for adaptive sampling, and for a target error: means, doublings and streams.
const ADAPTIVE_BYTES: u64 = 64;
const TARGET_BYTES: u64 = 36;
/// Bytes per pixel of the sums for intervals and of the sample under way.
const INTERVAL_BYTES: u64 = 96;
/// Bytes per pixel that takes part in the estimate of the error, and the most such pixels.
const STREAM_BYTES: u64 = 128;
const STREAM_PIXELS: u64 = 1 << 18;
/// Bytes per pixel of a checkpoint that is being written.
const STATE_BYTES: u64 = 36;

/// Settings beside the scene on which the host's memory depends.
#[derive(Debug, Clone, Copy, Default)]
pub struct HostNeeds {
    /// Pixels of the picture, or of the region that is rendered.
    pub pixels: u64,
    /// The CPU renders, and no driver is loaded.
    pub on_cpu: bool,
    pub adaptive: bool,
    pub target_error: bool,
    /// Intervals are stated.
    pub intervals: bool,
    /// States are kept.
    pub checkpoint: bool,
}

/// The host's memory for a render, by what takes it.
pub fn host_memory(scene: &Scene, needs: &HostNeeds) -> Memory {
    let HostNeeds { pixels, on_cpu, adaptive, target_error, intervals, checkpoint } = *needs;
    let way = usize::from(!on_cpu);
    let summary = SceneSummary::of(scene);
    let triangles = (summary.triangles + summary.group_triangles) as u64;
    let of_textures = scene.textures.iter().filter_map(|texture| match &texture.kind {
        TextureKind::Image(texture) => Some(&*texture.image),
        _ => None,
    });
    // Many textures may show one picture.
    let mut seen = HashSet::new();
    let images =
        of_textures.chain(scene.lights.iter().filter_map(Light::image)).filter(|image| seen.insert(ptr::from_ref(*image)));
    let pictures: usize = images.map(|image: &ImageData| image.texels.as_bytes().len()).sum();
    let mut seen = HashSet::new();
    let volumes = scene.media.iter().filter_map(|medium| medium.grids.as_deref()).flat_map(MediumGrids::volumes);
    let grids = volumes.filter(|volume| seen.insert(Arc::as_ptr(&volume.grid)));
    let grids: u64 = grids.map(|volume| 4 * volume.grid.values().len() as u64).sum();
    let film = pixels.min(MOST_FILM_PIXELS);
    let of = |is_so: bool, bytes: u64| if is_so { bytes } else { 0 };
    let steps =
        of(adaptive, ADAPTIVE_BYTES * pixels) + of(target_error, TARGET_BYTES * pixels) + of(intervals, INTERVAL_BYTES * pixels);
    let streams = of(target_error, STREAM_BYTES * pixels.min(STREAM_PIXELS));
    let arrays = [
        ("program", PROGRAM_BYTES[way]),
        ("triangles", TRIANGLE_BYTES * triangles + INSTANCE_BYTES * summary.instances as u64),
        ("pictures", PICTURE_FACTOR * pictures as u64),
        ("grids", GRID_FACTOR * grids),
        ("film", FILM_BYTES[way] * film),
        ("rows", BAND_BYTES * pixels.min(BAND_PIXELS)),
        ("steps", steps + streams),
        ("state", of(checkpoint, STATE_BYTES * film)),
    ];
    Memory { arrays: arrays.into_iter().filter(|(_, bytes)| *bytes > 0).collect() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_asked_for_takes_memory() {
        let scene = crate::load::load(Some("cornell")).expect("it is built in");
        let of = |needs: HostNeeds| host_memory(&scene, &needs).total();
        let small = HostNeeds { pixels: 100, on_cpu: true, ..HostNeeds::default() };
        let large = HostNeeds { pixels: 1 << 22, ..small };
        assert!(of(small) < 33 << 20 && of(large) > of(small) + (140 << 20));
        for more in [
            HostNeeds { on_cpu: false, ..large },
            HostNeeds { adaptive: true, ..large },
            HostNeeds { target_error: true, ..large },
            HostNeeds { checkpoint: true, ..large },
        ] {
            assert!(of(more) > of(large) + (100 << 20), "{more:?}");
        }
        // A picture beyond what a film holds is rendered in bands.
        let bands = HostNeeds { pixels: 1 << 28, ..small };
        assert!(of(bands) < 2 << 30, "{}", of(bands));
    }
}
