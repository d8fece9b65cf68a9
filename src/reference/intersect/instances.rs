//! Groups of meshes in their places: a hierarchy over the places, and one in each group's own space, where rays are taken to.

use glam::{DAffine3, DVec3};

use super::hierarchy::{Hierarchy, PreparedRay};
use super::mesh_data::MeshData;
use super::owner::{Owner, SurfaceId};
use super::pose::{self, PathTime, Pose};
use super::ray::Local;
use super::shape::{self, Placement, Primitive, Triangle};
use crate::scene::{Instances as Entry, MaterialId, Motion, Scene, Shape};

/// All instances of a scene.
#[derive(Debug, Clone)]
pub struct Instances {
    hierarchy: Hierarchy,
    /// In the hierarchy's leaf order.
    placed: Vec<Placed>,
    groups: Vec<Group>,
    motions: Vec<Motion>,
    /// Number of the scene's shapes, behind which instances are numbered.
    shapes: usize,
}

/// A group in one place.
#[derive(Debug, Clone)]
struct Placed {
    /// Among all instances, in the order of the scene.
    number: usize,
    group: usize,
    map: DAffine3,
    at_rest: Pose,
    /// Index of its motion, and what that is about.
    motion: Option<(usize, DVec3)>,
    /// In place of the group's own.
    material: Option<MaterialId>,
}

/// The meshes of a group, in its own space.
#[derive(Debug, Clone)]
struct Group {
    hierarchy: Hierarchy,
    /// In leaf order.
    triangles: Vec<Triangle>,
    /// Shapes are counted in the group.
    owners: Vec<Owner>,
    meshes: Vec<MeshData>,
    bounds: [DVec3; 2],
}

/// A triangle of a group where it stands.
pub struct PlacedTriangle<'a> {
    pub triangle: &'a Triangle,
    pub mesh: &'a MeshData,
    /// Face of the mesh.
    pub face: usize,
    pub pose: Pose,
}

impl Default for Instances {
    fn default() -> Self {
        let hierarchy = Hierarchy::build(&[]).0;
        Self { hierarchy, placed: Vec::new(), groups: Vec::new(), motions: Vec::new(), shapes: 0 }
    }
}

impl Instances {
    /// The scene has been checked. The second value are the boxes of all instances.
    pub fn new(scene: &Scene) -> (Self, Vec<[DVec3; 2]>) {
        if scene.instances.is_empty() {
            return (Self::default(), Vec::new());
        }
        let groups: Vec<Group> = scene.groups.iter().map(|group| Group::new(scene, &group.shapes)).collect();
        let (mut unsorted, mut boxes, mut motions) = (Vec::new(), Vec::new(), Vec::new());
        let mut number = 0;
        for entry in &scene.instances {
            let group = &groups[entry.group];
            let is_met = scene.are_visible(entry) && !group.triangles.is_empty();
            let motion = entry.motion.as_ref().map(|motion| {
                motions.push(motion.clone());
                motions.len() - 1
            });
            for map in entry.maps() {
                if is_met {
                    let at_rest = Pose::new(map);
                    let motion = motion.map(|motion| (motion, entry.origin_of_motion(&map)));
                    unsorted.push(Placed { number, group: entry.group, map, at_rest, motion, material: entry.material });
                    boxes.push(bounds(entry, group, &map, scene.camera.shutter));
                }
                number += 1;
            }
        }
        let (hierarchy, order) = Hierarchy::build(&boxes);
        let placed = order.iter().map(|&index| unsorted[index as usize].clone()).collect();
        (Self { hierarchy, placed, groups, motions, shapes: scene.shapes.len() }, boxes)
    }

    /// Calls `visit` for every crossing with a triangle in (0, limit), with the limit at hand. It gives back the limit from there on; a negative
    /// one ends the search.
    pub fn traverse(
        &self,
        ray: &PreparedRay,
        limit: f64,
        time: &PathTime,
        mut visit: impl FnMut(SurfaceId, f64, Local, f64) -> f64,
    ) {
        self.hierarchy.traverse(ray, limit, |instance, limit| {
            let placed = &self.placed[instance];
            let group = &self.groups[placed.group];
            let local = PreparedRay::new(self.pose(placed, time).ray_to_rest(&ray.ray));
            let mut remaining = limit;
            group.hierarchy.traverse(&local, limit, |triangle, limit| {
                remaining = match Primitive::Triangle(group.triangles[triangle]).intersect(&local, limit) {
                    Some((distance, at)) => visit(SurfaceId::Instanced { instance, triangle }, distance, at, limit),
                    None => limit,
                };
                remaining
            });
            remaining
        });
    }

    /// Instances count as shapes behind those of the scene, and triangles of a group as parts of them.
    pub fn owner(&self, instance: usize, triangle: usize) -> Owner {
        let placed = &self.placed[instance];
        let own = self.groups[placed.group].owners[triangle];
        Owner { shape: self.shapes + placed.number, part: triangle, material: placed.material.unwrap_or(own.material) }
    }

    pub fn triangle(&self, instance: usize, triangle: usize, time: &PathTime) -> PlacedTriangle<'_> {
        let placed = &self.placed[instance];
        let group = &self.groups[placed.group];
        let owner = group.owners[triangle];
        PlacedTriangle {
            triangle: &group.triangles[triangle],
            mesh: &group.meshes[owner.shape],
            face: owner.part,
            pose: self.pose(placed, time),
        }
    }

    fn pose(&self, placed: &Placed, time: &PathTime) -> Pose {
        match placed.motion {
            None => placed.at_rest,
            Some((motion, origin)) => Pose::new(self.motions[motion].at(time.value(), origin) * placed.map),
        }
    }
}

impl Group {
    fn new(scene: &Scene, shapes: &[Shape]) -> Self {
        let mut unsorted = Vec::new();
        for (index, shape) in shapes.iter().enumerate() {
            for (part, primitive) in shape::primitives(&Placement::new(shape)) {
                let material = shape.face_material(part);
                if let Primitive::Triangle(triangle) = primitive
                    && !scene.materials[material].is_nothing()
                {
                    unsorted.push((triangle, Owner { shape: index, part, material }));
                }
            }
        }
        let boxes: Vec<[DVec3; 2]> = unsorted.iter().map(|(triangle, _)| triangle.corner_bounds()).collect();
        let bounds = boxes
            .iter()
            .fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], [least, most]| [low.min(*least), high.max(*most)]);
        let (hierarchy, order) = Hierarchy::build(&boxes);
        let (triangles, owners) = order.iter().map(|&index| unsorted[index as usize]).unzip();
        Self { hierarchy, triangles, owners, meshes: shapes.iter().map(MeshData::new).collect(), bounds }
    }
}

/// A box around all that an instance sweeps while the shutter is open.
fn bounds(entry: &Entry, group: &Group, map: &DAffine3, shutter: [f64; 2]) -> [DVec3; 2] {
    let [min, max] = group.bounds;
    let corner = |index: usize| DVec3::select(glam::BVec3::new(index & 1 != 0, index & 2 != 0, index & 4 != 0), max, min);
    let placed = (0..8).map(|index| map.transform_point3(corner(index)));
    let [low, high] = placed.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)]);
    // Rounding, of rays on their way to the group and back.
    let margin = 1e-9 * (low.abs().max(high.abs()).max_element() + (high - low).max_element());
    let at_rest = [low - margin, high + margin];
    entry.motion.as_ref().map_or(at_rest, |motion| pose::swept_by(motion, entry.origin_of_motion(map), at_rest, shutter))
}
