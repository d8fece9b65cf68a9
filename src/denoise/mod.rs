//! Denoising by Intel's Open Image Denoise, which is opened at run time where it is installed. It makes a second picture and says what it did
//! to the first one's energy; it is never part of a render.
//!
//! - [`library`]: finds the library, and calls it.
//! - [`bias`]: by how much the denoised picture differs from the raw one beyond what the raw one's noise explains.

pub mod bias;
mod functions;
pub mod library;
mod raw;

use crate::output::Image;

pub use raw::Raw;

use library::{Library, OidnError, Task};

/// The picture without noise. Layers are denoised by themselves before, so that none of their noise comes into the picture.
///
/// # Errors
/// Errors of the library.
pub fn denoise(library: &Library, raw: &Raw) -> Result<Image, OidnError> {
    let Image { width, height, ref pixels } = raw.picture;
    let size = [width as usize, height as usize];
    let alone = |layer: &'static str, values: &Vec<[f32; 3]>| library.run(&Task { size, inputs: &[(layer, values)], flags: &[] });
    let albedo = raw.albedo.as_ref().map(|values| alone("albedo", values)).transpose()?;
    let normal = raw.normal.as_ref().filter(|_| albedo.is_some()).map(|values| alone("normal", values)).transpose()?;
    let mut inputs: Vec<(&'static str, &Vec<[f32; 3]>)> = vec![("color", pixels)];
    inputs.extend(albedo.as_ref().map(|values| ("albedo", values)));
    inputs.extend(normal.as_ref().map(|values| ("normal", values)));
    let flags: &[&str] = if albedo.is_some() { &["hdr", "cleanAux"] } else { &["hdr"] };
    Ok(Image { width, height, pixels: library.run(&Task { size, inputs: &inputs, flags })? })
}
