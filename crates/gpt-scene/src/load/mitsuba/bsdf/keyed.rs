//! Values that the modules of BSDFs pass to each other.

use crate::load::file::colour::Colour;
use crate::load::file::material::{MaterialEntry, diffuse, pass};
use crate::load::import::Relief;
use crate::spectrum::Spectrum;

/// The BSDFs within another one.
#[derive(Debug, Default)]
pub struct NestedBsdfs {
    /// The names of their materials.
    pub names: Vec<String>,
    /// The map of normals or heights that all of them have.
    pub relief: Relief,
}

/// A material without a name, and whether both sides count.
pub type Keyed = (MaterialEntry, bool);

/// The ray goes on.
pub fn nothing() -> MaterialEntry {
    MaterialEntry::from(pass::Keys::default())
}

/// Reflects nothing: the reflectance of a diffuse surface is 0 where none is set.
pub fn black() -> MaterialEntry {
    MaterialEntry::from(diffuse::Keys::default())
}

/// A diffuse grey.
pub fn grey(reflectance: f64) -> Result<MaterialEntry, String> {
    let reflectance = Colour::constant(Spectrum::grey(reflectance))?;
    Ok(MaterialEntry::from(diffuse::Keys { reflectance, ..Default::default() }))
}
