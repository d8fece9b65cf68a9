//! `[[shape]]`

use std::sync::Arc;

use crate::load::error::SceneError;
use crate::load::file::resolver::{LoadedMesh, Resolver};
use crate::load::file::syntax::{BoxShape, RectangleShape, ShapeEntry};
use crate::load::file::value::{Located, vector};
use crate::scene::{Geometry, MaterialId, MaterialKind, Shape, Transform};

/// Faces of all portals of a scene.
const MOST_PORTAL_FACES: usize = 256;

fn portal_faces(shape: &Shape) -> usize {
    match &shape.geometry {
        Geometry::Mesh(mesh) => mesh.faces.len(),
        Geometry::Box { .. } => 6,
        _ => 1,
    }
}

impl Resolver<'_> {
    pub(super) fn shapes(&mut self, written: &[Located<ShapeEntry>]) {
        for (index, entry) in written.iter().enumerate() {
            let shape = self.checked_shape(index, entry);
            let shape = self.note(shape);
            self.scene.shapes.extend(shape);
        }
    }

    fn checked_shape(&mut self, index: usize, entry: &Located<ShapeEntry>) -> Result<Shape, SceneError> {
        let shape = self.shape(index, entry)?;
        self.check_uvs(entry, &shape)?;
        if shape.portal {
            self.check_portal(entry, &shape)?;
        }
        Ok(shape)
    }

    /// Rays must be able to go through a portal, and every direction is tested against every portal.
    fn check_portal(&mut self, entry: &Located<ShapeEntry>, shape: &Shape) -> Result<(), SceneError> {
        if matches!(shape.geometry, Geometry::Plane { .. }) {
            return Err(self.error(&entry.span, "a plane cannot be a portal: no density covers it evenly"));
        }
        let earlier: usize = self.scene.shapes.iter().filter(|shape| shape.portal).map(portal_faces).sum();
        let faces = earlier + portal_faces(shape);
        if faces > MOST_PORTAL_FACES {
            let message = format!("the portals up to here have {faces} faces, at most {MOST_PORTAL_FACES} are possible");
            return Err(self.error(&entry.span, message).with_help("stand a rectangle in front of the opening"));
        }
        let is_pass = |id: &MaterialId| matches!(self.scene.materials[*id].kind, MaterialKind::Pass);
        // A surface that emits is sampled as the light it is.
        if !shape.materials().any(|id| is_pass(&id) || self.scene.emits(id)) {
            let name = &self.scene.materials[shape.material].name;
            let warning = format!(
                "{}: {} is a portal without effect: its material `{name}` lets no ray pass, one of type `pass` does",
                self.document.name, shape.label
            );
            self.scene.warnings.push(warning);
        }
        Ok(())
    }

    fn shape(&mut self, index: usize, entry: &Located<ShapeEntry>) -> Result<Shape, SceneError> {
        let common = entry.value.common();
        let transform = common.transform.map_or(Ok(Transform::default()), |transform| self.transform(transform))?;
        let motion = common.motion.map_or(Ok(None), |motion| self.motion(motion))?;
        let material = common.material.map(|name| self.material_id(name)).transpose()?;
        let (kind, geometry, material) = match &entry.value {
            ShapeEntry::Mesh(mesh) => {
                let LoadedMesh { mesh, material } = self.mesh(index, entry, mesh, material)?;
                ("mesh", Geometry::Mesh(mesh), material)
            }
            ShapeEntry::Sphere(sphere) => {
                let geometry = Geometry::Sphere { center: vector(sphere.center), radius: sphere.radius.0 };
                ("sphere", geometry, self.needed(entry, material)?)
            }
            ShapeEntry::Disk(disk) => {
                let (center, normal) = (vector(disk.center), self.direction(&disk.normal)?);
                ("disk", Geometry::Disk { center, normal, radius: disk.radius.0 }, self.needed(entry, material)?)
            }
            ShapeEntry::Rectangle(written) => ("rectangle", self.rectangle(written)?, self.needed(entry, material)?),
            ShapeEntry::Box(written) => ("box", self.r#box(written)?, self.needed(entry, material)?),
            ShapeEntry::Plane(plane) => {
                let (point, normal) = (vector(plane.point), self.direction(&plane.normal)?);
                ("plane", Geometry::Plane { point, normal }, self.needed(entry, material)?)
            }
        };
        let round = matches!(geometry, Geometry::Sphere { .. } | Geometry::Disk { .. });
        if let Some(written) = common.transform
            && round
            && transform.uniform_scale().is_none()
        {
            let message = format!("a {kind} can only be scaled by the same factor along every axis");
            return Err(self.error(&written.span, message).with_help("use a mesh for an ellipsoid or an ellipse"));
        }
        let label = format!("shape[{index}] ({kind})");
        let shape = Shape { label, geometry, material, transform, motion, portal: common.portal };
        common.motion.map_or(Ok(()), |written| self.check_motion(written, &shape))?;
        Ok(shape)
    }

    fn needed(&self, entry: &Located<ShapeEntry>, material: Option<MaterialId>) -> Result<MaterialId, SceneError> {
        material.ok_or_else(|| self.error(&entry.span, "the key `material` is missing"))
    }

    fn rectangle(&self, written: &RectangleShape) -> Result<Geometry, SceneError> {
        let (edge_u, edge_v) = (vector(written.edge_u.value), vector(written.edge_v.value));
        if edge_u.cross(edge_v).length() <= 1e-9 * edge_u.length() * edge_v.length() {
            return Err(self.error(&written.edge_v.span, "the rectangle has no area: its edges are parallel or of length 0"));
        }
        Ok(Geometry::Rectangle { corner: vector(written.corner), edge_u, edge_v })
    }

    fn r#box(&self, written: &BoxShape) -> Result<Geometry, SceneError> {
        let (min, max) = (vector(written.min), vector(written.max.value));
        let edges = max - min;
        if edges.min_element() < 0.0 {
            return Err(self.error(&written.max.span, "the box's `max` is below its `min`"));
        }
        if edges.to_array().into_iter().filter(|&edge| edge == 0.0).count() > 1 {
            return Err(self.error(&written.max.span, "the box has no area: at most one of its edges can have length 0"));
        }
        Ok(Geometry::Box { min, max })
    }

    /// A texture needs coordinates to be looked up at.
    fn check_uvs(&mut self, entry: &Located<ShapeEntry>, shape: &Shape) -> Result<(), SceneError> {
        let lacking = match &shape.geometry {
            Geometry::Mesh(mesh) if mesh.uvs.is_empty() => "the mesh has none",
            Geometry::Plane { .. } => "a plane has none; use a large rectangle",
            Geometry::Disk { .. } => "a disk has none; use a mesh with uvs, or a rectangle",
            _ => return Ok(()),
        };
        match shape.materials().find(|&material| self.uses_texture(material)) {
            Some(material) => {
                let name = &self.scene.materials[material].name;
                let message = format!("the material `{name}` uses a texture, which needs uv coordinates: {lacking}");
                let span = entry.value.common().material.map_or(&entry.span, |name| &name.span);
                Err(self.error(span, message))
            }
            None => Ok(()),
        }
    }

    /// A whole scene of one model with the materials of its file.
    pub(super) fn lone_mesh(&mut self, path: &std::path::Path) -> Result<(), SceneError> {
        let LoadedMesh { mesh, material } = self.mesh_file(path, None, None)?;
        self.scene.shapes.push(Shape {
            label: crate::load::error::show(path),
            geometry: Geometry::Mesh(Arc::clone(&mesh)),
            material,
            transform: Transform::default(),
            motion: None,
            portal: false,
        });
        Ok(())
    }
}
