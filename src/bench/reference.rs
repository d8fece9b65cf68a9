//! The picture that errors are measured against, and how wrong it is itself.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use super::subject::{BenchError, Subject};
use crate::compare::Moments;
use crate::compare::relative_weight;
use crate::film::Band;
use crate::output::{
    AtomicFile, Display, Image, OutputError, PictureFile, PictureFormat, PictureSpec, Provenance, read_image, read_picture,
};
use crate::scene::{self, Scene};

/// Independent pictures that a reference is the mean of: their scatter says how far it is from the truth.
pub const PARTS: u32 = 8;
/// Seeds of the parts; those of what is measured are hashed and so do not meet them but by chance.
const FIRST_SEED: u32 = 0x5eed_0000;

/// Mean squared errors of a reference, estimated from the scatter of its parts, with their standard errors.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct OwnError {
    pub mse: f64,
    pub mse_standard_error: f64,
    pub relmse: f64,
    pub relmse_standard_error: f64,
}

/// A reference that errors are measured against.
#[derive(Debug, Clone)]
pub struct Reference {
    pub image: Image,
    /// None for a file that somebody gave: nothing is known of its error.
    pub own_error: Option<OwnError>,
    /// Samples per pixel, where they are known.
    pub spp: Option<u32>,
    /// Its origin, for people.
    pub origin: String,
    /// Properties of its pixels that its file states and nothing uses.
    pub warnings: Vec<String>,
}

impl Reference {
    /// A picture that somebody gave.
    ///
    /// # Errors
    /// A file that cannot be read, a picture of another size, and one with values that are not finite.
    pub fn from_file(path: &Path, size: [u32; 2]) -> Result<Self, BenchError> {
        let picture = read_picture(path)?;
        let (warnings, image) = (picture.warnings(path), picture.image);
        if [image.width, image.height] != size {
            return Err(crate::compare::SizeMismatch { sizes: [size, [image.width, image.height]] }.into());
        }
        if image.pixels.iter().flatten().any(|value| !value.is_finite()) {
            return Err(BenchError::UnsuitableReference(format!(
                "{}: the reference has pixels that are not finite",
                path.display()
            )));
        }
        Ok(Self { image, own_error: None, spp: None, origin: path.display().to_string(), warnings })
    }

    /// Renders [`PARTS`] pictures and takes their mean; at least `spp` samples per pixel in all.
    ///
    /// # Errors
    /// Errors of the subject.
    pub fn render(subject: &mut dyn Subject, spp: u32) -> Result<Self, BenchError> {
        let part_spp = spp.div_ceil(PARTS).max(1);
        let mut size = [0, 0];
        let mut pixels: Vec<[Moments; 3]> = Vec::new();
        for part in 0..PARTS {
            let picture = subject.render(FIRST_SEED + part, part_spp)?.picture;
            pixels.resize(picture.pixels.len(), [Moments::default(); 3]);
            size = [picture.width, picture.height];
            for (moments, pixel) in pixels.iter_mut().zip(&picture.pixels) {
                moments.iter_mut().zip(pixel).for_each(|(moments, value)| moments.push(f64::from(*value)));
            }
        }
        let mean = pixels.iter().map(|pixel| pixel.map(|moments| moments.mean() as f32)).collect();
        let image = Image { width: size[0], height: size[1], pixels: mean };
        let own_error = Some(own_error(&pixels, &image));
        Ok(Self { image, own_error, spp: Some(part_spp * PARTS), origin: "rendered".to_owned(), warnings: Vec::new() })
    }

    /// The part to subtract from a measured error, and its uncertainty: zeros where nothing is known.
    pub fn correction(&self) -> OwnError {
        self.own_error.unwrap_or_default()
    }
}

/// The variance of the parts' mean, averaged over pixels and channels.
fn own_error(pixels: &[[Moments; 3]], image: &Image) -> OwnError {
    let mut errors = [Moments::default(); 2];
    for (moments, pixel) in pixels.iter().zip(&image.pixels) {
        let weights = pixel.map(|value| relative_weight(value.into()));
        let variances = moments.map(|moments| moments.variance() / moments.count() as f64);
        errors[0].push(variances.iter().sum::<f64>() / 3.0);
        errors[1].push(variances.iter().zip(weights).map(|(variance, weight)| variance * weight).sum::<f64>() / 3.0);
    }
    let [mse, relmse] = errors;
    OwnError {
        mse: mse.mean(),
        mse_standard_error: mse.standard_error(),
        relmse: relmse.mean(),
        relmse_standard_error: relmse.standard_error(),
    }
}

/// A folder of references that were made before.
pub struct Store {
    pub folder: PathBuf,
}

/// The record beside a stored picture.
#[derive(Serialize, Deserialize)]
struct Record {
    /// Everything that decides the picture, in words.
    made_of: String,
    spp: u32,
    own_error: OwnError,
}

impl Store {
    /// The folder that the system has for such things, or one in the current folder where it has none.
    pub fn default_folder() -> PathBuf {
        dirs::cache_dir().map_or_else(|| PathBuf::from("gpt-references"), |folder| folder.join("gpt").join("references"))
    }

    /// The stored reference of this scene at this size and with these settings; None where there is none that can be used.
    pub fn find(&self, scene: &Scene, device: &str, spp: u32) -> Option<Reference> {
        let (made_of, paths) = self.place(scene, device, spp);
        let record: Record = serde_json::from_slice(&std::fs::read(&paths[1]).ok()?).ok()?;
        let image = read_image(&paths[0]).ok()?;
        let fits = record.made_of == made_of && [image.width, image.height] == scene.film.size;
        fits.then(|| Reference {
            image,
            own_error: Some(record.own_error),
            spp: Some(record.spp),
            origin: format!("made earlier, kept in {}", paths[0].display()),
            warnings: Vec::new(),
        })
    }

    /// Keeps a reference that was rendered; says where.
    ///
    /// # Errors
    /// Errors of the file system.
    pub fn keep(&self, scene: &Scene, device: &str, spp: u32, reference: &Reference) -> Result<PathBuf, BenchError> {
        let write_failure = |source| OutputError::Write { path: self.folder.clone(), source };
        std::fs::create_dir_all(&self.folder).map_err(write_failure)?;
        let (made_of, [picture, record]) = self.place(scene, device, spp);
        write_exr(&picture, scene, device, reference)?;
        let content = Record { made_of, spp: reference.spp.unwrap_or(spp), own_error: reference.correction() };
        let json = serde_json::to_vec_pretty(&content).map_err(|error| write_failure(error.into()))?;
        AtomicFile::write(&record, &json)?;
        Ok(picture)
    }

    /// The text of all that decides the picture, and the places of it and its record.
    fn place(&self, scene: &Scene, device: &str, spp: u32) -> (String, [PathBuf; 2]) {
        let made_of = format!(
            "{} {:?} {:?} {PARTS} parts of {} {device} {}",
            scene::digest(scene),
            scene.film,
            scene::RenderSettings { spp: 0, seed: 0, ..scene.render.clone() },
            spp.div_ceil(PARTS),
            env!("CARGO_PKG_VERSION")
        );
        let hash = Sha256::digest(made_of.as_bytes());
        let key: String = hash.iter().take(8).map(|byte| format!("{byte:02x}")).collect();
        // A scene's name comes from a file's name and so is one.
        let stem = self.folder.join(format!("{}-{key}", scene.name));
        let with_ending = |ending: &str| PathBuf::from(format!("{}.{ending}", stem.display()));
        (made_of, [with_ending("exr"), with_ending("json")])
    }
}

fn write_exr(path: &Path, scene: &Scene, device: &str, reference: &Reference) -> Result<(), BenchError> {
    let image = &reference.image;
    let samples = reference.spp.unwrap_or(0);
    let provenance = Provenance {
        scene: scene.name.clone(),
        scene_hash: scene::digest(scene),
        settings: scene::RenderSettings { spp: samples, seed: FIRST_SEED, ..scene.render.clone() },
        filter: scene.film.filter,
        first_sample: 0,
        adaptive: false,
        target_error: None,
        interval: None,
        device: device.to_owned(),
    };
    let (width, height, display) = (image.width, image.height, Display::CLIP);
    let spec = PictureSpec { width, height, display, provenance: Some(provenance), ..PictureSpec::default() };
    let mut file = PictureFile::create(path, PictureFormat::Exr, &spec)?;
    let mean = image.pixels.clone();
    let band = Band { first_row: 0, width: image.width, rows: image.height, samples, mean, ..Band::default() };
    file.write_band(&Arc::new(band)).map_err(|source| OutputError::Write { path: path.into(), source })?;
    Ok(file.finish()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bench::synthetic::Synthetic;

    #[test]
    fn a_reference_knows_its_own_error() {
        let mut subject = Synthetic { sigma: 0.3, ..Synthetic::default() };
        let reference = Reference::render(&mut subject, 80).unwrap();
        let own = reference.own_error.unwrap();
        let expected = 0.09 / 80.0;
        assert!((own.mse - expected).abs() < 4.0 * own.mse_standard_error, "{own:?}, {expected}");
        assert!(own.mse_standard_error < 0.05 * expected);
        // The control: a wrong claim is many standard errors off.
        assert!((own.mse - 1.5 * expected).abs() > 8.0 * own.mse_standard_error);
    }

    #[test]
    fn what_is_kept_is_found_again_and_only_for_what_it_was_made_of() {
        let folder = tempfile::tempdir().unwrap();
        let store = Store { folder: folder.path().join("new") };
        let mut scene = Scene { name: "grey".to_owned(), ..Scene::default() };
        scene.film.size = [16, 8];
        let mut subject = Synthetic { size: [16, 8], ..Synthetic::default() };
        let reference = Reference::render(&mut subject, 64).unwrap();
        assert!(store.find(&scene, "device", 64).is_none());
        store.keep(&scene, "device", 64, &reference).unwrap();
        let found = store.find(&scene, "device", 64).unwrap();
        assert_eq!((found.image.pixels, found.own_error), (reference.image.pixels, reference.own_error));
        assert!(store.find(&scene, "device", 128).is_none() && store.find(&scene, "other", 64).is_none());
        scene.render.max_depth += 1;
        assert!(store.find(&scene, "device", 64).is_none());
        scene.render.max_depth -= 1;
        let broken = store.place(&scene, "device", 64).1;
        std::fs::write(&broken[0], b"no picture").unwrap();
        assert!(store.find(&scene, "device", 64).is_none());
    }
}
