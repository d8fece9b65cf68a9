//! Scenes in code.

use std::sync::Arc;

use glam::{DVec3, Vec3};
use gpt::scene::*;
use gpt::spectrum::Spectrum;

use super::SIDE;

/// An empty scene of [`SIDE`]² pixels with paths of any length.
pub fn scene(spp: u32, camera: Camera) -> Scene {
    Scene {
        film: FilmSettings { size: [SIDE; 2], ..FilmSettings::default() },
        render: RenderSettings { spp, max_depth: 0, roulette_depth: 5.into(), ..RenderSettings::default() },
        camera,
        ..Scene::default()
    }
}

pub fn camera(position: DVec3, look_at: DVec3, vertical_fov_degrees: f64) -> Camera {
    let up = if (look_at - position).normalize().y.abs() > 0.9 { DVec3::Z } else { DVec3::Y };
    Camera { position, look_at, up, projection: Projection::Perspective { vertical_fov_degrees }, ..Camera::default() }
}

/// Adds a material and gives its index.
pub fn material(scene: &mut Scene, kind: MaterialKind, emission: Option<Emission>) -> MaterialId {
    let name = format!("material {}", scene.materials.len());
    scene.materials.push(Material { name, kind, normal_map: None, emission, two_sided: true, interior: None });
    scene.materials.len() - 1
}

pub fn diffuse(scene: &mut Scene, reflectance: f64) -> MaterialId {
    material(scene, MaterialKind::Diffuse { reflectance: ColorInput::grey(reflectance) }, None)
}

/// A Lambert surface that emits from both sides.
pub fn glowing(scene: &mut Scene, reflectance: f64, radiance: f64) -> MaterialId {
    let emission = Emission { radiance: ColorInput::grey(radiance), two_sided: true };
    material(scene, MaterialKind::Diffuse { reflectance: ColorInput::grey(reflectance) }, Some(emission))
}

/// Emits from the front alone and reflects nothing.
pub fn emissive(scene: &mut Scene, radiance: Spectrum) -> MaterialId {
    let emission = Emission { radiance: ColorInput::Constant(radiance), two_sided: false };
    material(scene, MaterialKind::Emissive, Some(emission))
}

pub fn glass(scene: &mut Scene, ior: f64) -> MaterialId {
    let one = ColorInput::grey(1.0);
    material(
        scene,
        MaterialKind::Glass { ior, reflectance: one, transmittance: one, thin: false, film: None, dispersion: None },
        None,
    )
}

pub fn shape(scene: &mut Scene, geometry: Geometry, material: MaterialId) {
    let label = format!("shape {}", scene.shapes.len());
    let transform = Transform::default();
    scene.shapes.push(Shape { label, geometry, material, transform, motion: None, portal: false, receiver: 0 });
}

pub fn sphere(center: DVec3, radius: f64) -> Geometry {
    Geometry::Sphere(Sphere { center, radius })
}

/// A square around the origin in the plane y = 0, front upward.
pub fn floor(half: f64) -> Geometry {
    Geometry::Rectangle(Rectangle {
        corner: DVec3::new(-half, 0.0, half),
        edge_u: DVec3::X * (2.0 * half),
        edge_v: -DVec3::Z * (2.0 * half),
    })
}

pub fn triangle(corners: [[f32; 3]; 3]) -> Geometry {
    let positions = corners.map(Vec3::from).to_vec();
    Geometry::Mesh(Arc::new(Mesh { positions, faces: vec![[0, 1, 2]], ..Mesh::default() }))
}

/// The cube from −1 to 1 as a mesh, front outward.
pub fn cube_mesh() -> Geometry {
    let positions = (0..8).map(|i| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - 1.0).collect();
    let quads = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
    let faces = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Geometry::Mesh(Arc::new(Mesh { positions, faces, ..Mesh::default() }))
}

pub fn environment(scene: &mut Scene, radiance: f64) {
    let radiance = EnvironmentRadiance::Constant(Spectrum::grey(radiance));
    scene.lights.push(Light::Environment(Environment {
        radiance,
        rotation_degrees: 0.0,
        turn: None,
        rows: Default::default(),
        mirrored: false,
    }));
}
