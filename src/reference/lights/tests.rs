use std::sync::Arc;

use glam::{DVec2, Vec3};

use super::*;
use crate::scene::{ColorInput, Emission, Environment, Geometry, Material, MaterialKind, Mesh, Shape, Transform};
use crate::statistics::{SphereBins, density_by_differences, sidak, test_directional_sampler, worst_jacobian_deviation};

/// A scene whose shapes all emit grey radiance 2 from both sides, with a point light of intensity 3.
fn glowing(shapes: Vec<Geometry>) -> (Scene, World) {
    let emission = Emission { radiance: ColorInput::grey(2.0), two_sided: true };
    let material = Material { name: "glow".into(), kind: MaterialKind::Emissive, normal_map: None, emission: Some(emission) };
    let shape = |geometry| Shape {
        label: "shape".into(),
        geometry,
        material: 0,
        transform: Transform::default(),
        motion: None,
        portal: false,
    };
    let scene = Scene {
        materials: vec![material],
        shapes: shapes.into_iter().map(shape).collect(),
        lights: vec![Light::Point { position: DVec3::new(0.0, 5.0, 0.0), intensity: DVec3::splat(3.0) }],
        ..Scene::default()
    };
    let world = World::new(&scene).expect("the scene is sound");
    (scene, world)
}

fn sphere() -> Geometry {
    Geometry::Sphere { center: DVec3::new(0.0, 3.0, 0.0), radius: 0.7 }
}

fn rectangle() -> Geometry {
    let (edge_u, edge_v) = (DVec3::new(2.0, 0.1, 0.0), DVec3::new(0.5, 0.0, 1.0));
    Geometry::Rectangle { corner: DVec3::new(-1.0, 2.0, -0.5), edge_u, edge_v }
}

fn triangle() -> Geometry {
    let positions = [[-1.0, 1.5, 0.0], [1.0, 2.0, 0.3], [0.0, 1.0, 1.0]].map(Vec3::from).to_vec();
    Geometry::Mesh(Arc::new(Mesh { positions, faces: vec![[0, 1, 2]], ..Mesh::default() }))
}

fn disk() -> Geometry {
    Geometry::Disk { center: DVec3::new(0.5, 1.0, -2.0), normal: DVec3::new(0.1, -1.0, 0.4), radius: 1.5 }
}

/// The reference points: beside the lights, below, above, and inside the sphere.
const REFERENCES: [DVec3; 4] =
    [DVec3::new(0.3, 0.0, 0.1), DVec3::new(-2.0, 1.4, 3.0), DVec3::new(0.1, 9.0, 0.4), DVec3::new(0.0, 3.2, 0.1)];

/// What a light's sampling states is what the map does, and what following a ray to the same point finds.
#[test]
fn densities_of_light_samples_are_right() {
    for geometry in [sphere(), rectangle(), triangle(), disk()] {
        let (scene, world) = glowing(vec![geometry.clone()]);
        let lights = Lights::new(&scene, &world);
        let of_area = lights.table.pmf[0];
        for reference in REFERENCES {
            let draw = |u1, u2| {
                let direction = sample_primitive(world.primitive(0), reference, u1, u2).expect("every point can be seen");
                (direction.wi, direction.pdf_solid_angle)
            };
            let map = |[u1, u2]: [f64; 2]| draw(u1, u2).0;
            for (u1, u2) in (0..16).flat_map(|i| (0..16).map(move |j| (f64::from(i) + 0.5, f64::from(j) + 0.5))) {
                let (u1, u2) = (u1 / 16.0, u2 / 16.0);
                let (wi, pdf) = draw(u1, u2);
                let by_map = density_by_differences(map, [u1, u2]);
                assert!((pdf / by_map - 1.0).abs() < 1e-4, "{geometry:?} from {reference}: {pdf} and {by_map}");
                let ray = Ray { origin: reference, direction: wi };
                let hit = world.closest(ray).expect("a sampled direction meets the light");
                let surface = world.surface(&ray, &hit);
                let found = lights.pdf(&world, reference, &surface);
                assert!((found / (pdf * of_area) - 1.0).abs() < 1e-9, "{geometry:?} from {reference}: {found} and {pdf}");
            }
            let control = worst_jacobian_deviation(map, |_| 0.0, 2);
            assert!(control.relative > 0.5);
        }
    }
}

#[test]
fn directions_to_spheres_follow_their_density() {
    let (scene, world) = glowing(vec![sphere()]);
    let lights = Lights::new(&scene, &world);
    let level = sidak(0.01, REFERENCES.len());
    let Primitive::Sphere(sphere) = world.primitive(0) else { panic!("the primitive is a sphere") };
    for (seed, reference) in (0..).zip(REFERENCES) {
        let to_center = sphere.center - reference;
        let outside = to_center.length() > sphere.radius;
        let cosine = (1.0 - (sphere.radius / to_center.length()).powi(2)).max(0.0).sqrt();
        let edges: Vec<f64> = if outside {
            (0..6).map(|i| cosine + (1.0 - cosine) * f64::from(i) / 6.0).collect()
        } else {
            (-5..6).map(|i| f64::from(i) / 6.0).collect()
        };
        let bins = SphereBins::with_cosine_edges(to_center, &edges, 10);
        let sample = |[u1, u2, _]: [f64; 3]| sample_primitive(world.primitive(0), reference, u1, u2).map(|d| d.wi);
        let density = |wi: DVec3| {
            let ray = Ray { origin: reference, direction: wi.normalize() };
            let pmf = lights.table.pmf[0];
            world.closest(ray).map_or(0.0, |hit| lights.pdf(&world, reference, &world.surface(&ray, &hit)) / pmf)
        };
        let report = test_directional_sampler(&bins, 1_000_000, seed, sample, density);
        assert!(report.passes(level), "{reference}: {report:?}");
        assert!((report.integral.value - 1.0).abs() < 1e-3, "{reference}: {:?}", report.integral);
    }
}

/// π·A·L for both sides of a surface, 4π·I for a point; chosen in that proportion.
#[test]
fn lights_are_chosen_by_power() {
    let (mut scene, world) = glowing(vec![sphere(), rectangle()]);
    let lights = Lights::new(&scene, &world);
    let rectangle_area = DVec3::new(2.0, 0.1, 0.0).cross(DVec3::new(0.5, 0.0, 1.0)).length();
    let powers = [2.0 * PI * 4.0 * PI * 0.49 * 2.0, 2.0 * PI * rectangle_area * 2.0, 4.0 * PI * 3.0];
    let total: f64 = powers.iter().sum();
    for (pmf, power) in lights.table.pmf.iter().zip(powers) {
        assert!((pmf - power / total).abs() < 1e-12, "{:?}", lights.table.pmf);
    }
    // An environment is chosen half of the time, and only where BSDF sampling leaves it to light sampling.
    let radiance = EnvironmentRadiance::Constant(DVec3::ONE);
    scene.lights.insert(0, Light::Environment(Environment { radiance, rotation_degrees: 0.0 }));
    assert_eq!(Lights::new(&scene, &world).table.pmf.len(), 3);
    scene.render.estimator = Estimator::Nee;
    let pmf = Lights::new(&scene, &world).table.pmf;
    assert!((pmf[2] - 0.5).abs() < 1e-12 && (pmf[3] - 0.5 * powers[2] / total).abs() < 1e-12, "{pmf:?}");
}

#[test]
fn the_back_of_a_one_sided_light_is_dark() {
    let (mut scene, world) = glowing(vec![rectangle()]);
    scene.lights.clear();
    let count = |scene: &Scene, reference: DVec3| {
        let lights = Lights::new(scene, &world);
        (0..64).filter(|&i| lights.sample(scene, &world, reference, 0, f64::from(i) / 64.0, 0.5).is_some()).count()
    };
    // edge_u × edge_v points down.
    let (below, above) = (DVec3::ZERO, DVec3::Y * 4.0);
    assert_eq!([count(&scene, below), count(&scene, above)], [64, 64]);
    for emission in scene.materials[0].emission.iter_mut() {
        emission.two_sided = false;
    }
    assert_eq!([count(&scene, below), count(&scene, above)], [64, 0]);
}

#[test]
fn small_spheres_far_away_keep_their_density() {
    // 1 − cosθmax is 5·10⁻¹³ here: formed as a difference it would have lost four digits.
    let sphere = Sphere { center: DVec3::new(0.0, 0.0, 1e6), radius: 1.0 };
    let direction = sample_primitive(&Primitive::Sphere(sphere), DVec3::ZERO, 0.99, 0.3).expect("the sphere can be seen");
    let solid_angle = PI * 1e-12;
    assert!((direction.pdf_solid_angle * solid_angle - 1.0).abs() < 1e-9);
    let offset = DVec2::new(direction.wi.x, direction.wi.y).length() * 1e6;
    assert!((offset - 0.99_f64.sqrt()).abs() < 1e-5, "{offset}");
}
