//! The evidence of two renderings that differ: both pictures, their difference, and a heat map.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::Verdict;
use crate::film::Band;
use crate::output::{Display, OutputError, PictureFile, PictureFormat, PictureSpec, Provenance};
use crate::scene::Scene;

/// Writes `SCENE-gpu.exr`, `SCENE-cpu.exr`, `SCENE-difference.exr` (gpu − cpu) and `SCENE-heat.png` into a folder.
///
/// # Errors
/// Errors of writing.
pub fn write(folder: &Path, scene: &Scene, verdict: &Verdict) -> Result<Vec<PathBuf>, OutputError> {
    let difference: Vec<[f32; 3]> =
        verdict.gpu.iter().zip(&verdict.cpu).map(|(a, b)| [a[0] - b[0], a[1] - b[1], a[2] - b[2]]).collect();
    let heat: Vec<[f32; 3]> = difference.iter().zip(&verdict.cpu).map(|(d, reference)| heat_color(d, reference)).collect();
    let pictures = [
        ("gpu.exr", PictureFormat::Exr, verdict.gpu.clone()),
        ("cpu.exr", PictureFormat::Exr, verdict.cpu.clone()),
        ("difference.exr", PictureFormat::Exr, difference),
        ("heat.png", PictureFormat::Png, heat),
    ];
    let mut written = Vec::new();
    for (ending, format, pixels) in pictures {
        let path = folder.join(format!("{}-{ending}", verdict.scene));
        write_picture(&path, format, (scene, verdict), pixels)?;
        written.push(path);
    }
    Ok(written)
}

/// Black where the two agree, then blue, red and yellow for relative differences of 10⁻⁵, 10⁻³ and 10⁻¹ and more.
fn heat_color(difference: &[f32; 3], reference: &[f32; 3]) -> [f32; 3] {
    let largest = |color: &[f32; 3]| color.iter().fold(0.0_f32, |m, x| m.max(x.abs()));
    let relative = largest(difference) / largest(reference).max(1e-6);
    let decades = (relative.max(1e-7).log10() + 7.0).clamp(0.0, 6.0);
    let ramp = |from: f32, to: f32| ((decades - from) / (to - from)).clamp(0.0, 1.0);
    let blue = ramp(0.0, 2.0) * (1.0 - ramp(2.0, 4.0));
    [ramp(2.0, 4.0), ramp(4.0, 6.0), blue]
}

fn write_picture(
    path: &Path,
    format: PictureFormat,
    (scene, verdict): (&Scene, &Verdict),
    pixels: Vec<[f32; 3]>,
) -> Result<(), OutputError> {
    let provenance = Provenance {
        scene: verdict.scene.clone(),
        scene_hash: String::new(),
        settings: scene.render.clone(),
        filter: scene.film.filter,
        first_sample: 0,
        target_error: None,
        adaptive: false,
        interval: None,
        device: verdict.device.clone(),
    };
    let (width, height) = (verdict.width, verdict.height);
    let spec = PictureSpec { width, height, display: Display::CLIP, provenance: Some(provenance), ..PictureSpec::default() };
    let mut file = PictureFile::create(path, format, &spec)?;
    let band =
        Band { first_row: 0, width: verdict.width, rows: verdict.height, samples: verdict.spp, mean: pixels, ..Band::default() };
    file.write_band(&Arc::new(band)).map_err(|source| OutputError::Write { path: path.into(), source })?;
    file.finish()
}
