//! The keys by which a material's normals are bent. Parts of a blend have none: the blend itself has them.

use crate::load::file::material::MaterialEntry;
use crate::load::file::reference::TextureName;
use crate::load::file::value::{Located, Number};

/// The map that bends a material's normals, and how.
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

    /// A material with these keys.
    pub fn given_to(self, mut entry: MaterialEntry) -> MaterialEntry {
        let common = entry.common_mut();
        *common.normal_map = self.normal_map;
        *common.normal_scale = self.normal_scale;
        *common.bump_map = self.bump_map;
        *common.bump_scale = self.bump_scale;
        *common.normal_shadowing = self.normal_shadowing;
        *common.normal_mirroring = self.normal_mirroring;
        entry
    }
}
