//! `[[shape]]`

use std::sync::Arc;

use glam::DAffine3;

use super::ply::ply;
use super::side_files::is_on_disk;
use super::value::{direction, line, number, numbers, pair_f32, text, vector, vector_f32};
use super::writer::Writer;
use crate::scene::{Geometry, MaterialId, Mesh, MeshSource, MotionStep, Scene, Shape, TransformStep};

/// Larger meshes that come from no file lie in one beside the scene file.
const MOST_INLINE_FACES: usize = 24;

/// The file that the scene file names for a mesh.
pub fn named_file<'s>(scene: &'s Scene, mesh: &Arc<Mesh>) -> Option<&'s MeshSource> {
    scene.sources.mesh(mesh).filter(|source| is_on_disk(&source.path))
}

impl Writer<'_> {
    pub fn shape(&mut self, shape: &Shape) -> String {
        let material = |writer: &Self| line("material", &writer.materials.quoted(shape.material));
        let keys = match &shape.geometry {
            Geometry::Mesh(mesh) => self.mesh(shape, mesh),
            Geometry::Sphere(sphere) => {
                line("center", &vector(sphere.center)) + &line("radius", &number(sphere.radius)) + &material(self)
            }
            Geometry::Rectangle(rectangle) => [
                line("corner", &vector(rectangle.corner)),
                line("edge_u", &vector(rectangle.edge_u)),
                line("edge_v", &vector(rectangle.edge_v)),
                material(self),
            ]
            .concat(),
            Geometry::Disk(disk) => [
                line("center", &vector(disk.center)),
                line("normal", &direction(disk.normal)),
                line("radius", &number(disk.radius)),
                material(self),
            ]
            .concat(),
            Geometry::Box(cuboid) => line("min", &vector(cuboid.min)) + &line("max", &vector(cuboid.max)) + &material(self),
            Geometry::Plane(plane) => {
                line("point", &vector(plane.point)) + &line("normal", &direction(plane.normal)) + &material(self)
            }
        };
        let mut out = format!("\n[[shape]]\ntype = \"{}\"\n{keys}", shape.geometry.kind_name());
        if !shape.transform.steps.is_empty() {
            out += &line("transform", &steps(shape.transform.steps.iter().map(transform_step)));
        }
        if let Some(motion) = &shape.motion {
            out += &line("motion", &steps(motion.steps.iter().map(motion_step)));
        }
        if shape.portal {
            out += &line("portal", "true");
        }
        out
    }

    fn mesh(&mut self, shape: &Shape, mesh: &Arc<Mesh>) -> String {
        let scene = self.scene;
        if let Some(source) = named_file(scene, mesh) {
            return self.named_mesh(shape, source);
        }
        let smooth = line("smooth", &mesh.smooth.to_string());
        if mesh.faces.len() > MOST_INLINE_FACES || mesh.smooth || !mesh.face_materials.is_empty() {
            return self.mesh_beside(shape, mesh) + &smooth;
        }
        let list = |items: Vec<String>| format!("[{}]", items.join(", "));
        let mut out = line("positions", &list(mesh.positions.iter().map(|&position| vector_f32(position)).collect()));
        out += &line("faces", &list(mesh.faces.iter().map(|[a, b, c]| format!("[{a}, {b}, {c}]")).collect()));
        if !mesh.uvs.is_empty() {
            out += &line("uvs", &list(mesh.uvs.iter().map(|&uv| pair_f32(uv)).collect()));
        }
        out + &line("material", &self.materials.quoted(shape.material)) + &smooth
    }

    fn named_mesh(&self, shape: &Shape, source: &MeshSource) -> String {
        let mut out = line("file", &self.files.name_of(&source.path));
        if !source.own_materials {
            out += &line("material", &self.materials.quoted(shape.material));
        } else if !source.replaced.is_empty() {
            let id = |name: &str| self.scene.materials.iter().position(|material| material.name == name);
            let rows = source.replaced.iter().filter_map(|(of_file, name)| Some((of_file, id(name)?)));
            let rows: Vec<String> =
                rows.map(|(of_file, id)| format!("{} = {}", text(of_file), self.materials.quoted(id))).collect();
            out += &line("materials", &format!("{{ {} }}", rows.join(", ")));
        }
        if let Some(smooth) = source.smooth {
            out += &line("smooth", &smooth.to_string());
        }
        out
    }

    /// Writes the mesh into a file of its own; faces of several materials have a number in place of theirs.
    fn mesh_beside(&mut self, shape: &Shape, mesh: &Mesh) -> String {
        let name = format!("mesh-{}.ply", self.files.len() + 1);
        if mesh.face_materials.is_empty() {
            return line("file", &self.files.add(&name, ply(mesh, None)))
                + &line("material", &self.materials.quoted(shape.material));
        }
        let mut used: Vec<MaterialId> = mesh.face_materials.clone();
        used.sort_unstable();
        used.dedup();
        // Every material of a face is among those that are used.
        let group = |id: &MaterialId| used.binary_search(id).unwrap_or_default() as u32;
        let groups: Vec<u32> = mesh.face_materials.iter().map(group).collect();
        let rows: Vec<String> =
            used.iter().enumerate().map(|(group, &id)| format!("{group} = {}", self.materials.quoted(id))).collect();
        line("file", &self.files.add(&name, ply(mesh, Some(&groups)))) + &line("materials", &format!("{{ {} }}", rows.join(", ")))
    }
}

fn steps(written: impl Iterator<Item = String>) -> String {
    format!("[{}]", written.collect::<Vec<_>>().join(", "))
}

fn transform_step(step: &TransformStep) -> String {
    match *step {
        TransformStep::Scale(factors) => format!("{{ scale = {} }}", vector(factors)),
        TransformStep::Rotate { axis, degrees } => {
            format!("{{ rotate = {}, degrees = {} }}", direction(axis), number(degrees))
        }
        TransformStep::Translate(offset) => format!("{{ translate = {} }}", vector(offset)),
        TransformStep::Matrix(DAffine3 { matrix3, translation }) => {
            let row = |row: usize| [matrix3.row(row).x, matrix3.row(row).y, matrix3.row(row).z, translation[row]];
            let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat();
            format!("{{ matrix = {} }}", numbers(&rows))
        }
    }
}

fn motion_step(step: &MotionStep) -> String {
    match *step {
        MotionStep::Scale(factors) => format!("{{ scale = {} }}", vector(factors)),
        MotionStep::Rotate { axis, degrees } => format!("{{ rotate = {}, degrees = {} }}", direction(axis), number(degrees)),
        MotionStep::Translate(offset) => format!("{{ translate = {} }}", vector(offset)),
    }
}
