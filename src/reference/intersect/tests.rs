use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DVec2, DVec3, Vec2, Vec3, Vec3Swizzles};

use super::*;
use crate::scene::{
    Cuboid, Disk, Geometry, Material, MaterialKind, Mesh, Plane, Rectangle, Scene, Shape, Sphere, Transform, TransformStep,
};
use crate::statistics::random::SplitMix64;

fn world(shapes: Vec<(Geometry, Vec<TransformStep>)>) -> World {
    let kinds = [MaterialKind::Emissive, MaterialKind::Pass];
    let material =
        |kind| Material { name: "material".into(), kind, normal_map: None, emission: None, two_sided: true, interior: None };
    let shape = |(geometry, steps)| Shape {
        label: "shape".into(),
        geometry,
        material: 0,
        transform: Transform { steps },
        motion: None,
        portal: false,
        receiver: 0,
    };
    let shapes = shapes.into_iter().map(shape).collect();
    World::new(&Scene { materials: kinds.map(material).to_vec(), shapes, ..Scene::default() }).expect("the scene is sound")
}

fn random_direction(random: &mut SplitMix64) -> DVec3 {
    let (z, phi) = (2.0 * random.uniform() - 1.0, TAU * random.uniform());
    let r = (1.0 - z * z).sqrt();
    DVec3::new(r * phi.cos(), r * phi.sin(), z)
}

fn random_point(random: &mut SplitMix64, size: f64) -> DVec3 {
    DVec3::new(random.uniform() - 0.5, random.uniform() - 0.5, random.uniform() - 0.5) * size
}

/// A closed, finely divided sphere; its edges and corners are where rays could slip through.
fn sphere_mesh(rings: u32, segments: u32) -> Mesh {
    let mut positions = vec![Vec3::Y, -Vec3::Y];
    for ring in 1..rings {
        for segment in 0..segments {
            let theta = ring as f32 / rings as f32 * std::f32::consts::PI;
            let phi = segment as f32 / segments as f32 * std::f32::consts::TAU;
            positions.push(Vec3::new(theta.sin() * phi.sin(), theta.cos(), theta.sin() * phi.cos()));
        }
    }
    let at = |ring: u32, segment: u32| 2 + (ring - 1) * segments + segment % segments;
    let mut faces = Vec::new();
    for segment in 0..segments {
        faces.push([0, at(1, segment), at(1, segment + 1)]);
        faces.push([1, at(rings - 1, segment + 1), at(rings - 1, segment)]);
        for ring in 1..rings - 1 {
            let [a, b] = [at(ring, segment), at(ring, segment + 1)];
            let [c, d] = [at(ring + 1, segment), at(ring + 1, segment + 1)];
            faces.extend([[a, c, d], [a, d, b]]);
        }
    }
    Mesh { positions, faces, ..Mesh::default() }
}

#[test]
fn the_hierarchy_finds_what_a_search_over_everything_finds() {
    let mut random = SplitMix64::new(1);
    let mut shapes = vec![(Geometry::Mesh(Arc::new(sphere_mesh(16, 20))), vec![TransformStep::Scale(DVec3::new(2.0, 1.0, 3.0))])];
    for _ in 0..40 {
        let center = random_point(&mut random, 8.0);
        shapes.push((Geometry::Sphere(Sphere { center, radius: 0.3 }), vec![]));
        shapes.push((Geometry::Disk(Disk { center: -center, normal: center, radius: 0.5 }), vec![]));
        shapes.push((Geometry::Box(Cuboid { min: center.yzx(), max: center.yzx() + 0.4 }), vec![]));
    }
    let world = world(shapes);
    let count = world.indices_in_scene_order().len();
    let mut hits = 0;
    for _ in 0..20_000 {
        let ray = Ray { origin: random_point(&mut random, 12.0), direction: random_direction(&mut random) };
        let prepared = PreparedRay::new(ray);
        let (mut nearest, mut limit) = (None, f64::INFINITY);
        for index in 0..count {
            if let Some((distance, _)) = world.primitive(index).intersect(&prepared, limit) {
                (nearest, limit) = (Some(index), distance);
            }
        }
        let found = world.closest(ray, &PathTime::default());
        assert_eq!(found.map(|hit| hit.surface), nearest.map(SurfaceId::Primitive));
        assert_eq!(found.map_or(f64::INFINITY, |hit| hit.distance), limit);
        hits += usize::from(nearest.is_some());
        let transmittance = |limit| world.transmittance(ray, limit, None, &PathTime::default(), |_| false, |_| 1.0);
        assert_eq!(transmittance(f64::INFINITY), if nearest.is_some() { 0.0 } else { 1.0 });
        assert_eq!(transmittance(limit), 1.0);
    }
    assert!(hits > 2_000, "{hits}");
}

/// From inside a closed mesh every ray meets it, those aimed at corners and along edges included.
#[test]
fn meshes_are_watertight() {
    let mesh = sphere_mesh(24, 32);
    let world = world(vec![(Geometry::Mesh(Arc::new(mesh.clone())), vec![])]);
    let mut random = SplitMix64::new(2);
    for face in &mesh.faces {
        let [a, b, _] = face.map(|corner| mesh.positions[corner as usize].as_dvec3());
        for step in 0..8 {
            let target = a.lerp(b, f64::from(step) / 8.0);
            let origin = random_point(&mut random, 0.9);
            let ray = Ray { origin, direction: (target - origin).normalize() };
            assert!(world.closest(ray, &PathTime::default()).is_some(), "{origin} to {target}");
            // Along an axis, with zeros in the direction.
            let axis = Ray { origin: DVec3::new(target.x, 0.0, target.z) * 0.999, direction: DVec3::Y };
            assert!(world.closest(axis, &PathTime::default()).is_some(), "{axis:?}");
        }
    }
}

/// Boxes stand edge to edge and their own faces do too.
#[test]
fn boxes_have_no_gaps() {
    let world = world(vec![(
        Geometry::Box(Cuboid { min: DVec3::new(100.0, -7.0, 3.0), max: DVec3::new(101.0, -5.5, 3.3) }),
        vec![TransformStep::Rotate { axis: DVec3::new(1.0, 2.0, 3.0), degrees: 33.0 }],
    )]);
    let to_world = TransformStep::Rotate { axis: DVec3::new(1.0, 2.0, 3.0), degrees: 33.0 }.to_affine();
    let mut random = SplitMix64::new(3);
    for _ in 0..20_000 {
        // A point on one of the edges along z.
        let (x, y) = (if random.uniform() < 0.5 { 100.0 } else { 101.0 }, if random.uniform() < 0.5 { -7.0 } else { -5.5 });
        let target = to_world.transform_point3(DVec3::new(x, y, 3.0 + 0.3 * random.uniform()));
        let origin = to_world.transform_point3(DVec3::new(100.2 + 0.5 * random.uniform(), -6.0, 3.1));
        assert!(world.closest(Ray { origin, direction: (target - origin).normalize() }, &PathTime::default()).is_some());
    }
}

/// A ray that leaves a convex surface outward never meets it again; inward, it meets the far side and not where it started.
#[test]
fn rays_leave_surfaces_cleanly() {
    let mut random = SplitMix64::new(4);
    for offset in [DVec3::ZERO, DVec3::new(1e4, -3e5, 20.0)] {
        for (geometry, size) in [
            (Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 1.0 }), 1.0),
            (Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 1e4 }), 1e4),
            (Geometry::Box(Cuboid { min: DVec3::splat(-1.0), max: DVec3::new(2.0, 0.5, 1.0) }), 2.0),
            (Geometry::Mesh(Arc::new(sphere_mesh(2, 5))), 1.0),
        ] {
            let world = world(vec![(geometry, vec![TransformStep::Translate(offset)])]);
            for _ in 0..4_000 {
                let target = offset + random_point(&mut random, 0.2 * size);
                let origin = target + random_direction(&mut random) * (5.0 * size);
                let ray = Ray { origin, direction: (target - origin).normalize() };
                let hit = world.closest(ray, &PathTime::default()).expect("the ray is aimed at the inside");
                let point = world.surface(&ray, &hit, &PathTime::default()).point;
                let mut direction = random_direction(&mut random);
                if random.uniform() < 0.3 {
                    // Grazing.
                    direction = (direction - point.normal * direction.dot(point.normal) * (1.0 - 1e-6)).normalize();
                }
                let outward = direction.dot(point.normal) > 0.0;
                let start = point.leave_towards(direction);
                let again = world.closest(Ray { origin: start, direction }, &PathTime::default());
                assert_eq!(again.is_some(), !outward, "{point:?} {direction}");
                if let Some(again) = again {
                    // The chord of a sphere is as long as the direction is steep; faces of a mesh end at edges.
                    assert!(again.distance > 0.0);
                }
                assert!((start - point.position).length() < 1e-6 * size.max(1.0));
            }
        }
    }
}

#[test]
fn front_stays_in_front_under_reflections() {
    let mirror = vec![TransformStep::Scale(DVec3::new(-1.0, 1.0, 1.0)), TransformStep::Translate(DVec3::new(0.0, 0.0, 0.1))];
    let outward = [
        Geometry::Sphere(Sphere { center: DVec3::ZERO, radius: 1.0 }),
        Geometry::Box(Cuboid { min: DVec3::splat(-0.5), max: DVec3::splat(0.5) }),
        Geometry::Mesh(Arc::new(sphere_mesh(8, 8))),
    ];
    let mut random = SplitMix64::new(5);
    for geometry in outward {
        for steps in [vec![], mirror.clone()] {
            let world = world(vec![(geometry.clone(), steps)]);
            for _ in 0..200 {
                let ray = Ray { origin: DVec3::ZERO, direction: random_direction(&mut random) };
                let hit = world.closest(ray, &PathTime::default()).expect("the shape is closed");
                assert!(world.surface(&ray, &hit, &PathTime::default()).point.normal.dot(ray.direction) > 0.0, "{geometry:?}");
            }
        }
    }
    for geometry in [
        Geometry::Rectangle(Rectangle { corner: DVec3::new(-1.0, -1.0, 0.0), edge_u: DVec3::X * 2.0, edge_v: DVec3::Y * 2.0 }),
        Geometry::Disk(Disk { center: DVec3::ZERO, normal: DVec3::Z, radius: 1.0 }),
        Geometry::Plane(Plane { point: DVec3::ZERO, normal: DVec3::Z }),
    ] {
        let world = world(vec![(geometry, mirror.clone())]);
        let ray = Ray { origin: DVec3::new(0.3, 0.2, 4.0), direction: -DVec3::Z };
        let surface =
            world.surface(&ray, &world.closest(ray, &PathTime::default()).expect("the shape is in front"), &PathTime::default());
        assert!((surface.point.normal - DVec3::Z).length() < 1e-12);
    }
}

/// Normals and texture coordinates are interpolated at the point that was hit, mirrored or not.
#[test]
fn attributes_are_interpolated_where_the_ray_hits() {
    let mut mesh = sphere_mesh(32, 48);
    mesh.normals = mesh.positions.clone();
    mesh.uvs = mesh.positions.iter().map(|p| Vec2::new(p.x, p.y)).collect();
    mesh.smooth = true;
    let mesh = Arc::new(mesh);
    let mut random = SplitMix64::new(6);
    for factor in [1.0, -1.0] {
        let world = world(vec![(Geometry::Mesh(mesh.clone()), vec![TransformStep::Scale(DVec3::new(factor, 1.0, 1.0))])]);
        for _ in 0..500 {
            let ray = Ray { origin: DVec3::ZERO, direction: random_direction(&mut random) };
            let surface =
                world.surface(&ray, &world.closest(ray, &PathTime::default()).expect("the mesh is closed"), &PathTime::default());
            let position = surface.point.position;
            assert!((surface.shading_normal - position.normalize()).length() < 1e-2);
            assert!((surface.uv - DVec2::new(factor * position.x, position.y)).length() < 1e-5);
        }
    }
}

#[test]
fn parallelograms_know_their_coordinates() {
    let (corner, edge_u, edge_v) = (DVec3::new(1.0, 2.0, 3.0), DVec3::new(2.0, 0.0, 1.0), DVec3::new(0.5, 3.0, 0.0));
    let geometry = Geometry::Rectangle(Rectangle { corner, edge_u, edge_v });
    for mirrored in [1.0, -1.0] {
        let world = world(vec![(geometry.clone(), vec![TransformStep::Scale(DVec3::new(mirrored, 1.0, 1.0))])]);
        let target = (corner + edge_u * 0.25 + edge_v * 0.75) * DVec3::new(mirrored, 1.0, 1.0);
        let origin = target + DVec3::new(0.3, 0.1, 5.0);
        let ray = Ray { origin, direction: (target - origin).normalize() };
        let surface = world.surface(
            &ray,
            &world.closest(ray, &PathTime::default()).expect("the ray is aimed at the rectangle"),
            &PathTime::default(),
        );
        assert!((surface.uv - DVec2::new(0.25, 0.75)).length() < 1e-12, "{}", surface.uv);
        assert!((surface.point.position - target).length() < 1e-12);
    }
}

#[test]
fn degenerate_triangles_and_rays_are_never_hit() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::X * 2.0];
    let mesh = Mesh { positions: corners.to_vec(), faces: vec![[0, 1, 2], [1, 1, 1]], ..Mesh::default() };
    let world = world(vec![(Geometry::Mesh(Arc::new(mesh)), vec![])]);
    for direction in [DVec3::Z, DVec3::X, DVec3::NAN] {
        assert!(world.closest(Ray { origin: DVec3::new(0.5, 0.0, -1.0), direction }, &PathTime::default()).is_none());
    }
    let empty = super::World::new(&Scene::default()).expect("an empty scene is a scene");
    assert!(empty.closest(Ray { origin: DVec3::ZERO, direction: DVec3::Z }, &PathTime::default()).is_none());
}
