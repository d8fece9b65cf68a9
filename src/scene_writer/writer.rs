//! A scene file in the making.

use super::names::Names;
use super::side_files::SideFiles;
use crate::scene::Scene;

/// What all its parts need to know.
pub struct Writer<'s> {
    pub scene: &'s Scene,
    /// Names by which textures and materials are written: each is there once.
    pub textures: Names,
    pub materials: Names,
    pub files: SideFiles,
}
