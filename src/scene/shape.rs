//! Where surfaces are.

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::material::MaterialId;
use super::motion::{FARTHEST, Motion, MotionStep};
use super::transform::Transform;

/// One surface: geometry in its own space, where it stands, and what it is made of.
#[derive(Debug, Clone)]
pub struct Shape {
    /// How errors and reports call it: its type and place in the file, or an object's name.
    pub label: String,
    pub geometry: Geometry,
    /// The material of the whole shape; a mesh may carry one per face instead.
    pub material: MaterialId,
    /// From the shape's own space to the world at shutter time 0.
    pub transform: Transform,
    /// How it moves while the shutter is open, from where `transform` puts it; None: at rest.
    pub motion: Option<Motion>,
    /// Directions to the environment are sampled through this shape as if it were a light. Only faces of a `pass` material let them
    /// through; those that emit are lights anyway.
    pub portal: bool,
}

#[derive(Debug, Clone)]
pub enum Geometry {
    Mesh(Arc<Mesh>),
    /// Normal outward.
    Sphere {
        center: DVec3,
        radius: f64,
    },
    /// Parallelogram; normal along edge_u × edge_v. UV (0,0) at `corner`, u along edge_u.
    Rectangle {
        corner: DVec3,
        edge_u: DVec3,
        edge_v: DVec3,
    },
    Disk {
        center: DVec3,
        normal: DVec3,
        radius: f64,
    },
    /// Axis-aligned in its own space; normals outward.
    Box {
        min: DVec3,
        max: DVec3,
    },
    /// Infinite; never a light.
    Plane {
        point: DVec3,
        normal: DVec3,
    },
}

/// Triangles with shared vertices. Front faces are counter-clockwise.
#[derive(Debug, Clone, Default)]
pub struct Mesh {
    pub positions: Vec<Vec3>,
    /// One per position, or empty.
    pub normals: Vec<Vec3>,
    /// One per position, or empty.
    pub uvs: Vec<Vec2>,
    pub faces: Vec<[u32; 3]>,
    /// One material per face, or empty: then the shape's material is that of every face.
    pub face_materials: Vec<MaterialId>,
    /// Interpolate normals over the faces (needs `normals`); false: flat facets.
    pub smooth: bool,
}

impl Shape {
    /// The transform turns left hands into right hands. Fronts stay on the side of the material they are on in the shape's own
    /// space: see [`Shape::world_faces`]; a rectangle's normal is then along `−(edge_u × edge_v)` of the transformed edges.
    pub fn is_mirrored(&self) -> bool {
        self.transform.to_affine().matrix3.determinant() < 0.0
    }

    /// A mesh's vertices in the world at shutter time 0, computed in double precision and rounded once; empty for other shapes.
    pub fn world_positions(&self) -> Vec<Vec3> {
        let Geometry::Mesh(mesh) = &self.geometry else { return Vec::new() };
        let map = self.transform.to_affine();
        mesh.positions.iter().map(|&position| map.transform_point3(position.as_dvec3()).as_vec3()).collect()
    }

    /// A mesh's unit vertex normals in the world, by the inverse transpose; empty where the mesh has none. They stay on the side
    /// they are on in the shape's own space, as the front does.
    pub fn world_normals(&self) -> Vec<Vec3> {
        let Geometry::Mesh(mesh) = &self.geometry else { return Vec::new() };
        let map = self.transform.to_affine().matrix3.inverse().transpose();
        mesh.normals.iter().map(|&normal| (map * normal.as_dvec3()).normalize_or(DVec3::Y).as_vec3()).collect()
    }

    /// A mesh's faces, whose front in the world is where they are counter-clockwise. A mirroring transform would turn fronts into
    /// backs, so the order of corners is then reversed (the first corner stays the first).
    pub fn world_faces(&self) -> Vec<[u32; 3]> {
        let Geometry::Mesh(mesh) = &self.geometry else { return Vec::new() };
        let mirrored = self.is_mirrored();
        mesh.faces.iter().map(|&[a, b, c]| if mirrored { [a, c, b] } else { [a, b, c] }).collect()
    }
}

impl Shape {
    /// Those of its faces, else its own.
    pub fn materials(&self) -> impl Iterator<Item = MaterialId> {
        let of_faces: &[MaterialId] = match &self.geometry {
            Geometry::Mesh(mesh) => &mesh.face_materials,
            _ => &[],
        };
        of_faces.iter().copied().chain(of_faces.is_empty().then_some(self.material))
    }

    /// Where the shape's own (0, 0, 0) is in the world at time 0: what motions turn and scale about.
    pub fn origin(&self) -> DVec3 {
        self.transform.to_affine().translation
    }

    /// The map from the shape's place in the world at time 0 to that at `time`; None: it rests.
    pub fn moved_by(&self, time: f64) -> Option<DAffine3> {
        self.motion.as_ref().map(|motion| motion.at(time, self.origin()))
    }

    /// Whether renderers can follow the shape's motion while the shutter is open.
    ///
    /// # Errors
    /// What is wrong, in words, and in which step of the motion if it is a single one.
    pub fn check_motion(&self, shutter: [f64; 2]) -> Result<(), (Option<usize>, String)> {
        let Some(motion) = &self.motion else { return Ok(()) };
        if matches!(self.geometry, Geometry::Plane { .. }) {
            return Err((None, "an infinite plane cannot move; use a large rectangle".to_owned()));
        }
        if self.portal {
            return Err((None, "a portal cannot move".to_owned()));
        }
        let round = matches!(self.geometry, Geometry::Sphere { .. } | Geometry::Disk { .. });
        for (index, step) in motion.steps.iter().enumerate() {
            step.check(shutter).map_err(|message| (Some(index), message))?;
            if let MotionStep::Scale(scale) = step
                && round
                && scale.max_element() != scale.min_element()
            {
                let message = "spheres and disks can only be scaled by the same factor along every axis";
                return Err((Some(index), message.to_owned()));
            }
        }
        let ends = shutter.map(|time| motion.at(time, self.origin()));
        let in_range = |map: &DAffine3| map.to_cols_array().iter().all(|number| number.abs() <= FARTHEST);
        if ends.iter().all(|map| in_range(map) && map.matrix3.determinant().is_normal()) {
            return Ok(());
        }
        Err((None, "the motion leaves the range of numbers".to_owned()))
    }
}
