//! Shapes to primitives in world space, in the order in which the scene names them.

use std::collections::{BTreeMap, BTreeSet};

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use obvhs::aabb::Aabb;

use super::attributes::TriangleAttributes;
use super::constants::NONE;
use super::instance::{WorldGroup, WorldInstance};
use super::motion::PackedMotion;
use super::primitive::WorldPrimitive;
use super::shape::{self, Placement};
use crate::binary_tree::parts::Pose;
use crate::film::KernelLayer;
use crate::scene::animation::unevenness;
use crate::scene::{Geometry, Instances, MaterialId, Scene, Shape, Transform, TransformStep};

/// All primitives of a scene, and the attributes of those that have some.
#[derive(Debug, Default)]
pub struct WorldGeometry {
    pub primitives: Vec<WorldPrimitive>,
    pub attributes: Vec<TriangleAttributes>,
    /// Windows that directions to the environment are sampled through; rays do not meet them.
    pub portals: Vec<WorldPrimitive>,
    /// Motions of the shapes that move, and their words in the device's layout.
    pub motions: Vec<PackedMotion>,
    pub motion_words: Vec<[f32; 4]>,
    /// Meshes that are stored once, and where they stand.
    pub groups: Vec<WorldGroup>,
    pub instances: Vec<WorldInstance>,
    /// Poses in a frame: each shape with keyframes in the pose in which its tree is built
    /// ([`Scene::first_poses`]).
    pub posed: Option<BTreeMap<usize, Pose>>,
    /// Behind the attributes of every primitive stand others whose texture coordinates are its second ones, or the same.
    pub second_uvs: bool,
}

/// Surfaces made of `pass` are left out: to every ray they are not there.
pub fn collect(scene: &Scene) -> WorldGeometry {
    let mut world = WorldGeometry { second_uvs: uses_second_uvs(scene), ..WorldGeometry::default() };
    let shows_coordinates = scene.ready_for == Some(KernelLayer::Uv);
    let textured = scene.materials_that(|material| shows_coordinates || material.uses_texture() || material.is_anisotropic());
    for (index, shape) in scene.shapes.iter().enumerate() {
        let first = world.primitives.len();
        let second = world.second_corners(shape);
        shape::add(&Placement::new(shape, &textured), &mut |geometry, attributes, face| {
            let primitive = WorldPrimitive { shape: index, ..WorldPrimitive::new(geometry, shape.face_material(face)) };
            world.add(scene, primitive, attributes, second.get(face));
        });
        // Geometry that no ray meets, a shape of `pass` or a mesh without faces, need not move.
        let met = world.primitives.len() > first;
        if let Some(motion) = PackedMotion::new(shape, scene.camera.shutter).filter(|_| met) {
            world.set_in_motion(first, motion);
        }
    }
    world.add_instances(scene, &textured);
    world.posed = scene
        .first_poses
        .as_deref()
        .map(|poses| poses.iter().map(|&(shape, pose)| (shape, in_pose(scene, shape, pose))).collect());
    world
}

/// Some texture lies by second texture coordinates, and some mesh has them.
fn uses_second_uvs(scene: &Scene) -> bool {
    let has_second = |shape: &Shape| matches!(&shape.geometry, Geometry::Mesh(mesh) if !mesh.second_uvs.is_empty());
    let mut shapes = scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes));
    scene.textures.iter().any(|texture| texture.by_second_uvs) && shapes.any(has_second)
}

/// The primitives of a shape, turned and scaled by `pose`.
fn in_pose(scene: &Scene, shape: usize, pose: DMat3) -> Pose {
    let unevenness = unevenness(scene.shapes[shape].transform.to_affine().matrix3 * pose.inverse());
    let steps = vec![TransformStep::Matrix(DAffine3::from_mat3(pose))];
    let shape = Shape { transform: Transform { steps }, motion: None, ..scene.shapes[shape].clone() };
    // No texture coordinates are needed.
    let textured = vec![false; scene.materials.len()];
    let mut boxes = Vec::new();
    shape::add(&Placement::new(&shape, &textured), &mut |geometry, _, face| {
        if !scene.materials[shape.face_material(face)].is_nothing() {
            boxes.extend(geometry.bounds().map(|(low, high)| Aabb::new(low.into(), high.into())));
        }
    });
    Pose { boxes, unevenness }
}

impl WorldGeometry {
    /// Materials of its surfaces.
    pub fn materials(&self) -> BTreeSet<MaterialId> {
        let of_groups = self.groups.iter().flat_map(|group| &group.primitives);
        let of_primitives = self.primitives.iter().chain(of_groups).map(|primitive| primitive.material);
        of_primitives.chain(self.instances.iter().filter_map(|instance| instance.material)).collect()
    }

    /// Gives all surfaces the material that stands for theirs.
    pub fn replace_materials(&mut self, replacement: impl Fn(MaterialId) -> MaterialId) {
        let of_groups = self.groups.iter_mut().flat_map(|group| &mut group.primitives);
        self.primitives.iter_mut().chain(of_groups).for_each(|primitive| primitive.material = replacement(primitive.material));
        self.instances.iter_mut().for_each(|instance| instance.material = instance.material.map(&replacement));
    }

    /// Groups that are named, and where they stand. What no ray meets is left out.
    fn add_instances(&mut self, scene: &Scene, textured: &[bool]) {
        // Which group of the world a group of the scene is; None of those without a place or a face.
        let mut places: Vec<Option<usize>> = vec![None; scene.groups.len()];
        for (index, group) in scene.groups.iter().enumerate() {
            let entries = || scene.instances.iter().filter(|entry| entry.group == index && !entry.places.is_empty());
            let visible = entries().any(|entry| scene.are_visible(entry));
            // Texture coordinates are needed where any of the materials that stand for the group's own asks for them.
            let replaced_by_textured = entries().filter_map(|entry| entry.material).any(|id| textured[id]);
            let all = vec![true; textured.len()];
            let textured = if replaced_by_textured { &all } else { textured };
            let primitives = if visible { self.group(scene, &group.shapes, textured) } else { Vec::new() };
            if !primitives.is_empty() {
                places[index] = Some(self.groups.len());
                self.groups.push(WorldGroup { primitives });
            }
        }
        for entry in &scene.instances {
            let Some(group) = places[entry.group].filter(|_| scene.are_visible(entry)) else { continue };
            let Instances { material, pivot, receiver, .. } = *entry;
            let mut packed = [NONE; 2];
            for (number, map) in entry.maps().enumerate() {
                // About its place each has the same motion, and about another point one of its own.
                if let Some(motion) = &entry.motion
                    && (number == 0 || pivot.is_some())
                {
                    let from_place = pivot.map_or(DVec3::ZERO, |pivot| pivot - map.translation);
                    packed = self.add_motion(PackedMotion::of_instance(motion, from_place, scene.camera.shutter));
                }
                let [motion, motion_word] = packed;
                self.instances.push(WorldInstance { group, map, material, motion, motion_word, receiver });
            }
        }
    }

    /// Its index and its first word.
    fn add_motion(&mut self, packed: PackedMotion) -> [u32; 2] {
        let places = [self.motions.len() as u32, self.motion_words.len() as u32];
        self.motion_words.extend(packed.words());
        self.motions.push(packed);
        if self.attributes.is_empty() {
            // Kernels that know motion know attributes.
            self.attributes.push(TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::ZERO; 3]));
        }
        places
    }

    /// The faces of a group, in its own space.
    fn group(&mut self, scene: &Scene, shapes: &[Shape], textured: &[bool]) -> Vec<WorldPrimitive> {
        let mut primitives = Vec::new();
        for (index, shape) in shapes.iter().enumerate() {
            let second = self.second_corners(shape);
            shape::add(&Placement::new(shape, textured), &mut |geometry, attributes, face| {
                let material = shape.face_material(face);
                if scene.materials[material].is_nothing() {
                    return;
                }
                let mut primitive = WorldPrimitive { shape: index, ..WorldPrimitive::new(geometry, material) };
                if let Some(attributes) = attributes {
                    primitive.attributes = self.add_attributes(attributes, second.get(face));
                }
                primitives.push(primitive);
            });
        }
        primitives
    }

    fn add(
        &mut self,
        scene: &Scene,
        mut primitive: WorldPrimitive,
        attributes: Option<TriangleAttributes>,
        second: Option<&[Vec2; 3]>,
    ) {
        if scene.materials[primitive.material].is_nothing() {
            if scene.shapes[primitive.shape].portal && !primitive.is_infinite() && primitive.area() > 0.0 {
                self.portals.push(primitive);
            }
            return;
        }
        if let Some(attributes) = attributes {
            primitive.attributes = self.add_attributes(attributes, second);
        }
        self.primitives.push(primitive);
    }

    /// Their index.
    fn add_attributes(&mut self, attributes: TriangleAttributes, second: Option<&[Vec2; 3]>) -> u32 {
        let index = self.attributes.len() as u32;
        self.attributes.push(attributes);
        if self.second_uvs {
            self.attributes.push(second.map_or(attributes, |&uvs| TriangleAttributes::new([Vec3::ZERO; 3], uvs)));
        }
        index
    }

    /// The second texture coordinates at the corners of each face of a mesh; none where it has none, or nothing looks them up.
    fn second_corners(&self, shape: &Shape) -> Vec<[Vec2; 3]> {
        let Geometry::Mesh(mesh) = &shape.geometry else { return Vec::new() };
        if !self.second_uvs || mesh.second_uvs.is_empty() {
            return Vec::new();
        }
        shape.world_faces().into_iter().map(|face| face.map(|corner| mesh.second_uvs[corner as usize])).collect()
    }

    /// Moves the primitives from `first` on. Their attributes say how.
    fn set_in_motion(&mut self, first: usize, motion: PackedMotion) {
        let word = self.motion_words.len() as u32;
        self.motion_words.extend(motion.words());
        for primitive in &mut self.primitives[first..] {
            primitive.motion = self.motions.len() as u32;
            if primitive.attributes == NONE {
                primitive.attributes = self.attributes.len() as u32;
                // Texture coordinates that interpolate to themselves.
                let plain = TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::ZERO, Vec2::X, Vec2::Y]);
                self.attributes.extend(std::iter::repeat_n(plain, if self.second_uvs { 2 } else { 1 }));
            }
            self.attributes[primitive.attributes as usize].motion = word;
        }
        self.motions.push(motion);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::load_toml_str;

    const TURNED_THEN_SQUASHED: &str = r#"
[camera]
position = [0, 0, 6]
look_at = [0, 0, 0]
vfov = 40
shutter = [0, 0]
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.5
[[shape]]
type = "mesh"
positions = [[0, 0, 0], [1, 0, 0.5], [0, 1, 0.2], [1, 1, 1]]
faces = [[0, 1, 2], [1, 2, 3]]
material = "grey"
keyframes = [
    { frame = 0, rotate = [0, 1, 0], degrees = 0, translate = [0, 0, 0], scale = 1 },
    { frame = 10, rotate = [0, 1, 0], degrees = 60, translate = [2, 3, 0], scale = 3 },
    { frame = 20, rotate = [0, 1, 0], degrees = 60, translate = [2, 3, 0], scale = [1, 0.1, 1] },
]
[[light]]
type = "environment"
radiance = 1
"#;

    #[test]
    fn shapes_with_keyframes_have_one_pose_for_reference_and_are_uneven_where_they_are_squashed() {
        let scene = load_toml_str(TURNED_THEN_SQUASHED, "scene.toml", std::path::Path::new(".")).expect("a scene");
        assert!(collect(&scene).posed.is_none(), "without a frame nothing has to be followed");
        let pose = |frame: f64| {
            let world = collect(&scene.at_frame(frame).expect("a frame"));
            world.posed.expect("a frame").remove(&0).expect("the shape has keyframes")
        };
        let [start, turned, squashed] = [0.0, 10.0, 20.0].map(pose);
        for (pose, unevenness) in [(&start, 1.0), (&turned, 1.0), (&squashed, 10.0)] {
            assert!((pose.unevenness - unevenness).abs() < 1e-9, "{}", pose.unevenness);
            assert!(pose.boxes.len() == 2 && pose.boxes == start.boxes);
        }
    }
}
