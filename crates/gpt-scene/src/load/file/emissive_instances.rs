//! Instances that emit: area lights are sampled one by one, so each stands in the scene as shapes of its own.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::resolver::Resolver;
use crate::scene::{Geometry, Group, Instances, MaterialId, Mesh, Shape, TransformStep};

/// Most triangles of all copies that an entry makes.
const MOST_TRIANGLES: usize = 20_000_000;

impl Resolver<'_> {
    /// True, for each group, where some face of it emits.
    pub(super) fn emissive_groups(&self, emits: &[bool]) -> Vec<bool> {
        let is_emissive = |group: &Group| group.shapes.iter().flat_map(Shape::materials).any(|id| emits[id]);
        self.scene.groups.iter().map(is_emissive).collect()
    }

    /// The meshes of the group for each place.
    ///
    /// # Errors
    /// In words, that they are too many.
    pub(super) fn emissive_copies(&self, instances: &Instances) -> Result<Vec<Shape>, String> {
        let group = &self.scene.groups[instances.group];
        let triangles = group.triangles().saturating_mul(instances.places.len());
        if triangles > MOST_TRIANGLES {
            return Err(format!(
                "it emits, and its {} instances have {triangles} triangles, which stand in the scene one by one; at most {MOST_TRIANGLES} are possible",
                instances.places.len()
            ));
        }
        let meshes: Vec<Shape> = group.shapes.iter().map(|shape| self.made_of(shape, instances.material)).collect();
        let copy = |number: usize, map: DAffine3, shape: &Shape| {
            let mut copy = shape.clone();
            copy.receiver = instances.receiver;
            copy.label = format!("{}, number {number}", instances.label);
            let Some(motion) = &instances.motion else {
                copy.transform.steps.push(TransformStep::Matrix(map));
                return copy;
            };
            let origin = instances.origin_of_motion(&map);
            about(&mut copy, map.inverse().transform_point3(origin));
            let placed = DAffine3 { translation: origin, ..map };
            copy.transform.steps = vec![TransformStep::Matrix(placed)];
            copy.motion = Some(motion.clone());
            copy
        };
        let copies = instances.maps().enumerate();
        Ok(copies.flat_map(|(number, map)| meshes.iter().map(move |shape| copy(number, map, shape))).collect())
    }

    /// A mesh of another material; faces of a `pass` material stay openings.
    fn made_of(&self, shape: &Shape, material: Option<MaterialId>) -> Shape {
        let Some(material) = material else { return shape.clone() };
        let mut made = shape.clone();
        let replaced = |id: MaterialId| if self.scene.materials[id].is_nothing() { id } else { material };
        made.material = replaced(shape.material);
        if let Geometry::Mesh(mesh) = &mut made.geometry
            && !mesh.face_materials.is_empty()
        {
            let face_materials = mesh.face_materials.iter().map(|id| replaced(*id)).collect();
            *mesh = Arc::new(Mesh { face_materials, ..Mesh::clone(mesh) });
        }
        made
    }
}

/// Moves a mesh's vertices in the group's space, so that `origin` is (0, 0, 0) there and the mesh's own: shapes move about that.
fn about(shape: &mut Shape, origin: DVec3) {
    let map = shape.transform.to_affine();
    if map == DAffine3::IDENTITY && origin == DVec3::ZERO {
        return;
    }
    let (normals, faces) = (shape.world_normals(), shape.world_faces());
    if let Geometry::Mesh(mesh) = &mut shape.geometry {
        let place = |position: &Vec3| (map.transform_point3(position.as_dvec3()) - origin).as_vec3();
        *mesh = Arc::new(Mesh { positions: mesh.positions.iter().map(place).collect(), normals, faces, ..Mesh::clone(mesh) });
    }
}
