//! Values that the modules of BSDFs pass to each other.

use crate::load::file::colour::Colour;
use crate::load::file::material::{MaterialEntry, diffuse, pass};
use crate::load::file::reference::TextureName;
use crate::load::file::value::{Located, Number};
use crate::spectrum::Spectrum;

/// The BSDFs within another one.
#[derive(Debug, Default)]
pub struct NestedBsdfs {
    /// The names of their materials.
    pub names: Vec<String>,
    /// The map of normals or heights that all of them have.
    pub relief: Relief,
}

/// The keys by which a material's normals are perturbed.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Relief {
    normal_map: Option<Located<TextureName>>,
    normal_scale: Option<Located<Number>>,
    bump_map: Option<Located<TextureName>>,
    bump_scale: Option<Located<Number>>,
    normal_shadowing: Option<Located<bool>>,
    normal_mirroring: Option<Located<bool>>,
}

impl Relief {
    /// Takes the keys from a material, which then lies as the surface does.
    pub fn take(entry: &mut MaterialEntry) -> Self {
        let common = entry.common_mut();
        Self {
            normal_map: common.normal_map.take(),
            normal_scale: common.normal_scale.take(),
            bump_map: common.bump_map.take(),
            bump_scale: common.bump_scale.take(),
            normal_shadowing: common.normal_shadowing.take(),
            normal_mirroring: common.normal_mirroring.take(),
        }
    }

    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}

/// A blend with the keys that bend the normals of all of its parts.
pub fn with_relief(mut entry: MaterialEntry, relief: Relief) -> MaterialEntry {
    let common = entry.common_mut();
    *common.normal_map = relief.normal_map;
    *common.normal_scale = relief.normal_scale;
    *common.bump_map = relief.bump_map;
    *common.bump_scale = relief.bump_scale;
    *common.normal_shadowing = relief.normal_shadowing;
    *common.normal_mirroring = relief.normal_mirroring;
    entry
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
