//! Surfaces, and the table of shapes.

mod closed_mesh;
mod cuboid;
mod cylinder;
mod disk;
mod mesh;
mod mesh_model;
mod model;
mod plane;
mod rectangle;
mod sphere;
pub(crate) mod tessellation;

use std::fmt;
use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec3};

use super::check::{Check, within_range};
use super::light_links::ReceiverId;
use super::material::MaterialId;
use super::motion::{Motion, MotionStep};
use super::transform::Transform;
pub use model::Enclosure;
pub(super) use model::Extent;
use model::ShapeModel;
use tessellation::Tessellated;

/// The table of shapes: a row for each. From these rows every layer makes what chooses among its modules, so a shape is
/// a row here and a file of its module's name wherever it is represented: `scene/shape` is what it is, `load/file/shape` reads it,
/// `packed/shape` packs it, `reference/shape` intersects and samples it in f64.
///
/// A row: variant of [`Geometry`], type of its data, module, name in scene files. Then, unless it is made of another shape's primitives, its
/// own primitive: its name; that of its file in `shaders/geometry/shape` and of the functions there; what the names of
/// its number and switches hold; its `SurfaceSampling`, its `SurfaceCoordinates` and its `Curvature` (`packed/shape`).
#[doc(hidden)]
#[macro_export]
macro_rules! shape_table {
    ($what:ident) => {
        $what! {
            Mesh(Arc<Mesh>) mesh "mesh" => Triangle triangle TRIANGLE Area Edges Flat,
            Sphere(Sphere) sphere "sphere" => Sphere sphere SPHERE Own Normal Curved,
            Rectangle(Rectangle) rectangle "rectangle" => Quad quad QUAD Area Edges Flat,
            Disk(Disk) disk "disk" => Disk disk DISK Area None Flat,
            Box(Cuboid) cuboid "box",
            Cylinder(Cylinder) cylinder "cylinder" => Cylinder cylinder CYLINDER Area Edges Curved,
            Plane(Plane) plane "plane" => Plane plane PLANE Infinite None Flat,
        }
    };
}
#[doc(hidden)]
pub use shape_table;

macro_rules! geometries {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        /// A surface in its own space.
        #[derive(Debug, Clone)]
        pub enum Geometry {
            $($variant($type),)*
        }

        impl Geometry {
            /// The name of its kind in scene files.
            pub fn kind_name(&self) -> &'static str {
                match self {
                    $(Self::$variant(_) => $name,)*
                }
            }

            fn model(&self) -> &dyn ShapeModel {
                match self {
                    $(Self::$variant(shape) => shape,)*
                }
            }
        }
    };
}
shape_table!(geometries);

pub use cuboid::Cuboid;
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use mesh::Mesh;
pub use plane::Plane;
pub use rectangle::Rectangle;
pub use sphere::Sphere;

impl Geometry {
    /// Checks its numbers; the error is the mistake, in words.
    pub(super) fn check(&self) -> Check {
        self.model().check()
    }

    /// Why it has no texture coordinates, and what to use instead; None: it has them.
    pub fn lacks_uv(&self) -> Option<&'static str> {
        self.model().lacks_uv()
    }

    /// The part of space that its fronts look away from.
    pub fn enclosure(&self) -> Enclosure {
        self.model().enclosure()
    }

    /// Triangles in its place.
    pub(crate) fn tessellated(&self) -> Tessellated {
        self.model().tessellated()
    }

    pub(super) fn extent(&self, map: &DAffine3) -> Option<Extent> {
        self.model().extent(map)
    }

    /// True if it keeps its form only under a scaling by one factor along every axis.
    pub fn is_round(&self) -> bool {
        self.model().is_round()
    }

    /// The mistake of a round shape that is scaled otherwise, in words.
    pub fn stays_round(&self) -> String {
        format!("a {} can only be scaled by the same factor along every axis", self.kind_name())
    }

    /// True if it has neither bounds nor an area: it cannot move, and no light or portal has this shape.
    pub fn is_infinite(&self) -> bool {
        self.model().is_infinite()
    }

    /// Faces that a ray is tested against one by one where the shape is a portal.
    pub fn faces(&self) -> usize {
        self.model().faces()
    }
}

/// One surface: geometry in its own space, where it stands, and what it is made of.
#[derive(Clone)]
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
    /// The group of receivers that it belongs to.
    pub receiver: ReceiverId,
}

/// Prints a receiver where it is one of its own: fingerprints of scenes without light links stay as they are.
impl fmt::Debug for Shape {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { label, geometry, material, transform, motion, portal, receiver } = self;
        let mut fields = formatter.debug_struct("Shape");
        fields.field("label", label).field("geometry", geometry).field("material", material);
        fields.field("transform", transform).field("motion", motion).field("portal", portal);
        if *receiver != 0 {
            fields.field("receiver", receiver);
        }
        fields.finish()
    }
}

impl Shape {
    /// All of its faces have the material of the shape.
    pub fn face_materials_agree(&self) -> bool {
        self.geometry.model().face_materials().is_empty()
    }

    /// The materials of its faces, else its own. One may be named more than once.
    pub fn materials(&self) -> impl Iterator<Item = MaterialId> {
        let of_faces = self.geometry.model().face_materials();
        of_faces.iter().copied().chain(of_faces.is_empty().then_some(self.material))
    }

    /// The material of one of its faces.
    pub fn face_material(&self, face: usize) -> MaterialId {
        self.geometry.model().face_materials().get(face).copied().unwrap_or(self.material)
    }

    /// The lower and upper corner of an upright box around the shape where its transform puts it; None of what is infinite.
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        self.geometry.model().bounds(&self.transform.to_affine())
    }

    /// The shape by itself encloses something, with one material all around.
    pub fn is_closed(&self) -> bool {
        self.face_materials_agree() && self.geometry.enclosure().is_closed()
    }

    /// A distance from `point` within which all of the shape lies; of an infinite plane the distance of the plane.
    pub(super) fn farthest_from(&self, point: DVec3) -> f64 {
        self.geometry.model().farthest_from(&self.transform.to_affine(), point)
    }

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

    /// The place of the shape's own (0, 0, 0) in the world at time 0, about which motions turn and scale.
    pub fn origin(&self) -> DVec3 {
        self.transform.to_affine().translation
    }

    /// The map from the shape's place in the world at time 0 to that at `time`; None: it rests.
    pub fn moved_by(&self, time: f64) -> Option<DAffine3> {
        self.motion.as_ref().map(|motion| motion.at(time, self.origin()))
    }

    /// Checks that it has a place: its transform leaves a volume within the range of numbers, and round
    /// shapes stay round.
    ///
    /// # Errors
    /// The mistake, in words.
    pub fn check_place(&self) -> Result<(), String> {
        let map = self.transform.to_affine();
        let determinant = map.matrix3.determinant();
        if determinant == 0.0 || !determinant.is_finite() || !map.translation.is_finite() {
            return Err("the transform is singular".into());
        }
        if self.geometry.is_round() && self.transform.uniform_scale().is_none() {
            return Err(self.geometry.stays_round());
        }
        within_range(self.farthest_from(DVec3::ZERO))
    }

    /// Checks that renderers can follow the shape's motion while the shutter is open.
    ///
    /// # Errors
    /// The mistake, in words, and its step of the motion if it is in a single one.
    pub fn check_motion(&self, shutter: [f64; 2]) -> Result<(), (Option<usize>, String)> {
        let Some(motion) = &self.motion else { return Ok(()) };
        if self.geometry.is_infinite() {
            return Err((None, "an infinite plane cannot move; use a large rectangle".to_owned()));
        }
        if self.portal {
            return Err((None, "a portal cannot move".to_owned()));
        }
        let shares = shutter.map(|time| motion.share(time));
        for (index, step) in motion.steps.iter().enumerate() {
            step.check(shares).map_err(|message| (Some(index), message))?;
            if let MotionStep::Scale(scale) = step
                && self.geometry.is_round()
                && scale.max_element() != scale.min_element()
            {
                return Err((Some(index), self.geometry.stays_round()));
            }
        }
        let origin = self.origin();
        let checked = motion.check_ends(shutter, origin);
        checked.and_then(|()| motion.check_reach(shutter, origin, self.farthest_from(origin))).map_err(|message| (None, message))
    }
}
