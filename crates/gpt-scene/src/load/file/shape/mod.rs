//! `[[shape]]`: a file for each shape, with the keys it is written by.

pub mod cuboid;
pub mod cylinder;
pub mod deformation;
pub mod disk;
mod keys;
pub mod mesh;
mod mesh_file;
mod mesh_writer;
pub mod plane;
pub mod rectangle;
pub mod sphere;
pub mod transform;

use std::sync::Arc;

use glam::DVec3;
use schemars::JsonSchema;
use serde::Deserialize;

pub use self::transform::TransformEntry;

pub use self::keys::box_around;
use self::keys::{CommonKeys, CommonKeysMut, ShapeKeys, Written};
use super::resolver::Resolver;
use super::value::Located;
use super::writer::Writer;
use crate::load::error::SceneError;
use crate::scene::animation::DeformationTrack;
use crate::scene::shape::shape_table;
use crate::scene::{Geometry, MaterialKind, Shape, Transform};

/// The entries of a scene file, by the rows of the table of shapes.
macro_rules! entries {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        /// A surface.
        #[derive(Debug, Clone, Deserialize, JsonSchema)]
        #[serde(rename = "key:type", rename_all = "snake_case")]
        #[schemars(tag = "type", rename = "ShapeEntry")]
        pub enum ShapeEntry {
            $($variant($module::Keys),)*
        }

        /// Each type, and the keys of its geometry.
        const EXAMPLES: &[(&str, &[&str])] = &[$(($name, $module::Keys::EXAMPLES),)*];

        impl ShapeEntry {
            pub fn common_mut(&mut self) -> CommonKeysMut<'_> {
                match self {
                    $(Self::$variant(keys) => keys.common_mut(),)*
                }
            }

            pub fn common(&self) -> CommonKeys<'_> {
                match self {
                    $(Self::$variant(keys) => keys.common(),)*
                }
            }

            /// Points around it, by which a camera is placed, in its own space; none of what is infinite, or is a mesh.
            pub fn outline(&self) -> Vec<DVec3> {
                match self {
                    $(Self::$variant(keys) => keys.outline(),)*
                }
            }

            fn geometry(&self, resolver: &mut Resolver<'_>, entry: &mut Written<'_>) -> Result<Geometry, SceneError> {
                match self {
                    $(Self::$variant(keys) => keys.resolve(resolver, entry).map(Geometry::$variant),)*
                }
            }
        }

        /// The keys of a shape's geometry and its material, as a scene file has them.
        pub fn write_geometry(shape: &Shape, writer: &mut Writer<'_>) -> String {
            match &shape.geometry { $(Geometry::$variant(geometry) => $module::Keys::write(geometry, shape, writer),)* }
        }
    };
}
shape_table!(entries);

/// Name of the type, and type and geometry as TOML, of examples of every shape.
pub fn examples() -> impl Iterator<Item = (&'static str, String)> {
    let of_type = |&(name, examples): &(&'static str, &'static [&'static str])| {
        examples.iter().map(move |keys| (name, format!("[[shape]]\ntype = \"{name}\"\n{keys}\n")))
    };
    EXAMPLES.iter().flat_map(of_type)
}

/// Faces of all portals of a scene.
const MOST_PORTAL_FACES: usize = 256;

impl ShapeEntry {
    /// Keyframes move it, or a node does.
    pub(in crate::load::file) fn is_animated(&self) -> bool {
        let track = self.common().track;
        track.keyframes.is_some() || track.node.is_some()
    }
}

impl Resolver<'_> {
    pub(super) fn shapes(&mut self, written: &[Located<ShapeEntry>]) {
        for (index, entry) in written.iter().enumerate() {
            let shape = self.checked_shape(index, entry);
            let deformation = self.deformation.take();
            if let Some(shape) = self.note(shape) {
                let track = self.shape_track(entry.value.common().track, &shape);
                self.note(track);
                if let (Some(deformation), Geometry::Mesh(rest)) = (deformation, &shape.geometry) {
                    let (rest, place) = (rest.clone(), shape.transform.to_affine());
                    let track =
                        DeformationTrack { shape: self.scene.shapes.len(), deformation: Arc::new(deformation), rest, place };
                    Arc::make_mut(&mut self.scene.animation).deformations.push(track);
                }
                self.scene.shapes.push(shape);
            }
        }
    }

    pub(in crate::load::file) fn checked_shape(
        &mut self,
        index: usize,
        entry: &Located<ShapeEntry>,
    ) -> Result<Shape, SceneError> {
        let shape = self.shape(index, entry)?;
        self.check_uvs(entry, &shape)?;
        if shape.portal {
            self.check_portal(entry, &shape)?;
        }
        Ok(shape)
    }

    fn shape(&mut self, index: usize, entry: &Located<ShapeEntry>) -> Result<Shape, SceneError> {
        let common = entry.value.common();
        let transform = common.transform.map_or(Ok(Transform::default()), |transform| self.transform(transform))?;
        let motion = common.motion.map_or(Ok(None), |motion| self.motion(motion))?;
        let material = common.material.map(|name| self.material_id(name)).transpose()?;
        let mut written = Written { place: &entry.place, index, material };
        let geometry = entry.value.geometry(self, &mut written)?;
        let Some(material) = written.material else { return Err(self.error(&entry.place, "the key `material` is missing")) };
        if let Some(written) = common.transform
            && geometry.is_round()
            && transform.uniform_scale().is_none()
        {
            let help = "use a mesh for an ellipsoid or an ellipse";
            return Err(self.error(&written.place, geometry.stays_round()).with_help(help));
        }
        let label = format!("shape[{index}] ({})", geometry.kind_name());
        let receiver = self.receiver(common.receiver)?;
        let shape = Shape { label, geometry, material, transform, motion, portal: common.portal, receiver };
        let place = common.transform.map_or(&entry.place, |written| &written.place);
        shape.check_place().map_err(|message| self.error(place, message))?;
        common.motion.map_or(Ok(()), |written| self.check_motion(written, &shape))?;
        Ok(shape)
    }

    /// Rays must be able to go through a portal, and every direction is tested against every portal.
    fn check_portal(&mut self, entry: &Located<ShapeEntry>, shape: &Shape) -> Result<(), SceneError> {
        if shape.geometry.is_infinite() {
            return Err(self.error(&entry.place, "a plane cannot be a portal: no density covers it evenly"));
        }
        let earlier: usize = self.scene.shapes.iter().filter(|shape| shape.portal).map(|shape| shape.geometry.faces()).sum();
        let faces = earlier + shape.geometry.faces();
        if faces > MOST_PORTAL_FACES {
            let message = format!("the portals up to here have {faces} faces, at most {MOST_PORTAL_FACES} are possible");
            return Err(self.error(&entry.place, message).with_help("stand a rectangle in front of the opening"));
        }
        let is_pass = |id: usize| matches!(self.scene.materials[id].kind, MaterialKind::Pass);
        // A surface that emits is sampled as the light it is.
        if !shape.materials().any(|id| is_pass(id) || self.scene.emits(id)) {
            let name = &self.scene.materials[shape.material].name;
            let warning = format!(
                "{}: {} is a portal without effect: its material `{name}` lets no ray pass, one of type `pass` does",
                self.document.name, shape.label
            );
            self.scene.warnings.push(warning);
        }
        Ok(())
    }

    /// A texture needs coordinates to be looked up at.
    fn check_uvs(&mut self, entry: &Located<ShapeEntry>, shape: &Shape) -> Result<(), SceneError> {
        let Some(lacking) = shape.geometry.lacks_uv() else { return Ok(()) };
        match shape.materials().find(|&material| self.uses_texture(material)) {
            Some(material) => {
                let name = &self.scene.materials[material].name;
                let message = format!("the material `{name}` uses a texture, which needs uv coordinates: {lacking}");
                let span = entry.value.common().material.map_or(&entry.place, |name| &name.place);
                Err(self.error(span, message))
            }
            None => Ok(()),
        }
    }
}
