//! Shapes to primitives in world space, in the order in which the scene names them.

use std::collections::BTreeSet;

use glam::{DAffine3, DVec3, Vec2, Vec3};

use super::constants::NONE;
use super::motion::PackedMotion;
use super::primitive::{PrimitiveGeometry, TriangleAttributes, WorldPrimitive};
use crate::scene::{Geometry, Material, MaterialId, MaterialKind, Mesh, Scene, Shape};

/// All primitives of a scene, and the attributes of those that have some.
#[derive(Debug, Default)]
pub struct WorldGeometry {
    pub primitives: Vec<WorldPrimitive>,
    pub attributes: Vec<TriangleAttributes>,
    /// Windows that directions to the environment are sampled through; rays do not meet them.
    pub portals: Vec<WorldPrimitive>,
    /// Of the shapes that move, and the same as the device reads them.
    pub motions: Vec<PackedMotion>,
    pub motion_words: Vec<[f32; 4]>,
}

/// Surfaces made of `pass` are left out: to every ray they are not there.
pub fn collect(scene: &Scene) -> WorldGeometry {
    let mut world = WorldGeometry::default();
    let textured = scene.materials_that(Material::uses_texture);
    for (index, shape) in scene.shapes.iter().enumerate() {
        let transform = shape.transform.to_affine();
        let first = world.primitives.len();
        if let Geometry::Mesh(mesh) = &shape.geometry {
            add_mesh(scene, shape, mesh, &textured, &mut world);
        } else {
            add_analytic(shape, &transform, textured[shape.material], &mut world);
            if is_pass(scene, shape.material) {
                let unseen = world.primitives.drain(first..);
                world.portals.extend(unseen.filter(|primitive| shape.portal && !primitive.is_plane()));
            }
        }
        world.primitives[first..].iter_mut().for_each(|primitive| primitive.shape = index);
        // What no ray meets, a shape of `pass` or a mesh without faces, need not move.
        let met = world.primitives.len() > first;
        if let Some(motion) = PackedMotion::new(shape, scene.camera.shutter).filter(|_| met) {
            world.set_in_motion(first, motion);
        }
    }
    world
}

impl WorldGeometry {
    /// What its surfaces are made of.
    pub fn materials(&self) -> BTreeSet<MaterialId> {
        self.primitives.iter().map(|primitive| primitive.material).collect()
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
                self.attributes.push(TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::ZERO, Vec2::X, Vec2::Y]));
            }
            self.attributes[primitive.attributes as usize].motion = word;
        }
        self.motions.push(motion);
    }
}

fn is_pass(scene: &Scene, material: usize) -> bool {
    matches!(scene.materials[material].kind, MaterialKind::Pass)
}

fn add_analytic(shape: &Shape, transform: &DAffine3, textured: bool, world: &mut WorldGeometry) {
    let point = |p: DVec3| transform.transform_point3(p);
    let vector = |v: DVec3| transform.transform_vector3(v);
    let normal = |n: DVec3| (transform.matrix3.inverse().transpose() * n).normalize();
    // Checked when the scene was read: spheres and disks are scaled evenly.
    let scale = transform.matrix3.determinant().abs().cbrt();
    let attributes = if textured { analytic_attributes(shape, transform) } else { None };
    let mut push = |geometry| {
        let mut primitive = WorldPrimitive::new(geometry, shape.material);
        if let Some(attributes) = attributes {
            primitive.attributes = world.attributes.len() as u32;
            world.attributes.push(attributes);
        }
        world.primitives.push(primitive);
    };
    // A mirroring transform would turn fronts into backs; walking along edge u the other way keeps them.
    let quad = |corner: DVec3, edge_u: DVec3, edge_v: DVec3| {
        let (corner, edge_u) = if shape.is_mirrored() { (corner + edge_u, -edge_u) } else { (corner, edge_u) };
        PrimitiveGeometry::Quad { corner: point(corner), edge_u: vector(edge_u), edge_v: vector(edge_v) }
    };
    match shape.geometry {
        // Added by its own function.
        Geometry::Mesh(_) => {}
        Geometry::Sphere { center, radius } => {
            push(PrimitiveGeometry::Sphere { center: point(center), radius: radius * scale });
        }
        Geometry::Rectangle { corner, edge_u, edge_v } => {
            push(quad(corner, edge_u, edge_v));
        }
        Geometry::Disk { center, normal: n, radius } => {
            push(PrimitiveGeometry::Disk { center: point(center), normal: normal(n), radius: radius * scale });
        }
        Geometry::Plane { point: p, normal: n } => push(PrimitiveGeometry::Plane { point: point(p), normal: normal(n) }),
        Geometry::Box { min, max } => {
            for [corner, edge_u, edge_v] in box_faces(min, max) {
                if edge_u.cross(edge_v) != DVec3::ZERO {
                    push(quad(corner, edge_u, edge_v));
                }
            }
        }
    }
}

/// What texture coordinates need besides the primitive itself: of a sphere the rotation into its own space, of a rectangle that a
/// mirroring transform turned round the way back.
fn analytic_attributes(shape: &Shape, transform: &DAffine3) -> Option<TriangleAttributes> {
    match shape.geometry {
        Geometry::Sphere { .. } => {
            let to_local = transform.matrix3.inverse().transpose();
            let rows = to_local.to_cols_array_2d().map(|row| DVec3::from(row).normalize().as_vec3());
            Some(TriangleAttributes::new(rows, [Vec2::ZERO; 3]))
        }
        Geometry::Rectangle { .. } | Geometry::Box { .. } if shape.is_mirrored() => {
            Some(TriangleAttributes::new([Vec3::ZERO; 3], [Vec2::new(1.0, 0.0), Vec2::ZERO, Vec2::ONE]))
        }
        _ => None,
    }
}

/// Corner and edges of the faces −x, +x, −y, +y, −z, +z, with edge_u × edge_v outward.
fn box_faces(min: DVec3, max: DVec3) -> [[DVec3; 3]; 6] {
    let extent = max - min;
    let axis = |a: usize| DVec3::AXES[a % 3] * extent[a % 3];
    [0, 1, 2, 3, 4, 5].map(|face| {
        let a = face / 2;
        if face % 2 == 0 { [min, axis(a + 2), axis(a + 1)] } else { [min + axis(a), axis(a + 1), axis(a + 2)] }
    })
}

fn add_mesh(scene: &Scene, shape: &Shape, mesh: &Mesh, textured: &[bool], world: &mut WorldGeometry) {
    let positions = shape.world_positions();
    let normals = if mesh.smooth && !mesh.normals.is_empty() { shape.world_normals() } else { Vec::new() };
    for (index, face) in shape.world_faces().into_iter().enumerate() {
        let material = mesh.face_materials.get(index).copied().unwrap_or(shape.material);
        let corners = face.map(|corner| corner as usize);
        let mut primitive = WorldPrimitive::new(PrimitiveGeometry::Triangle(corners.map(|c| positions[c])), material);
        if is_pass(scene, material) {
            if shape.portal && primitive.area() > 0.0 {
                world.portals.push(primitive);
            }
            continue;
        }
        if !normals.is_empty() || (textured[material] && !mesh.uvs.is_empty()) {
            primitive.attributes = world.attributes.len() as u32;
            let corner_normals = if normals.is_empty() { [Vec3::ZERO; 3] } else { corners.map(|c| normals[c]) };
            let corner_uvs = if mesh.uvs.is_empty() { [Vec2::ZERO; 3] } else { corners.map(|c| mesh.uvs[c]) };
            world.attributes.push(TriangleAttributes::new(corner_normals, corner_uvs));
        }
        world.primitives.push(primitive);
    }
}
