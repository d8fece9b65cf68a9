use std::sync::Arc;

use glam::Vec3;

use super::*;
use gpt_scene::light_examples::delta_light_examples;

use crate::compare::sidak;
use crate::effort::in_full;
use crate::reference::warp;
use crate::scene::light::LightStrength;
use crate::scene::{
    ColorInput, Cylinder, DirectionalLight, Disk, Emission, Environment, EnvironmentRadiance, Estimator, Geometry, ImageData,
    ImageTexture, Material, MaterialKind, Mesh, PointLight, Rectangle, Shape, Sky, Sphere, SpotLight, Texture, TextureFilter,
    TextureKind, TextureWrap, Transform,
};
use crate::spectrum::Spectrum;
use crate::statistics::random::SplitMix64;
use crate::statistics::{SphereBins, chi_squared_test, density_by_differences, test_directional_sampler};

/// A scene whose shapes all emit grey radiance 2 from both sides, with a point light of intensity 3.
fn glowing(shapes: Vec<Geometry>) -> (Scene, World) {
    let emission = Emission { radiance: ColorInput::grey(2.0), two_sided: true };
    let material = Material {
        name: "glow".into(),
        kind: MaterialKind::Emissive,
        normal_map: None,
        emission: Some(emission),
        two_sided: true,
        interior: None,
    };
    let shape = |geometry| Shape {
        label: "shape".into(),
        geometry,
        material: 0,
        transform: Transform::default(),
        motion: None,
        portal: false,
        receiver: 0,
    };
    let scene = Scene {
        materials: vec![material],
        shapes: shapes.into_iter().map(shape).collect(),
        lights: vec![Light::Point(PointLight {
            position: DVec3::new(0.0, 5.0, 0.0),
            intensity: Spectrum::grey(3.0),
            profile: None,
        })],
        ..Scene::default()
    };
    let world = World::new(&scene).expect("the scene is sound");
    (scene, world)
}

fn sphere() -> Geometry {
    Geometry::Sphere(Sphere { center: DVec3::new(0.0, 3.0, 0.0), radius: 0.7 })
}

fn rectangle() -> Geometry {
    let (edge_u, edge_v) = (DVec3::new(2.0, 0.1, 0.0), DVec3::new(0.5, 0.0, 1.0));
    Geometry::Rectangle(Rectangle { corner: DVec3::new(-1.0, 2.0, -0.5), edge_u, edge_v })
}

/// Perpendicular, so that it is drawn by solid angle.
fn true_rectangle() -> Geometry {
    let (edge_u, edge_v) = (DVec3::new(2.0, 0.5, 0.0), DVec3::new(0.25, -1.0, 1.5));
    Geometry::Rectangle(Rectangle { corner: DVec3::new(-1.0, 2.0, -0.5), edge_u, edge_v })
}

fn triangle() -> Geometry {
    let positions = [[-1.0, 1.5, 0.0], [1.0, 2.0, 0.3], [0.0, 1.0, 1.0]].map(Vec3::from).to_vec();
    Geometry::Mesh(Arc::new(Mesh { positions, faces: vec![[0, 1, 2]], ..Mesh::default() }))
}

fn disk() -> Geometry {
    Geometry::Disk(Disk { center: DVec3::new(0.5, 1.0, -2.0), normal: DVec3::new(0.1, -1.0, 0.4), radius: 1.5 })
}

/// The reference points: beside the lights, below, above, and inside the sphere.
const REFERENCES: [DVec3; 4] =
    [DVec3::new(0.3, 0.0, 0.1), DVec3::new(-2.0, 1.4, 3.0), DVec3::new(0.1, 9.0, 0.4), DVec3::new(0.0, 3.2, 0.1)];

const STRATEGIES: [LightSampling; 3] = [LightSampling::Cone, LightSampling::Visible, LightSampling::Area];

/// A light's sampling states the density that the map has, and that following a ray to the same point finds.
#[test]
fn densities_of_light_samples_are_right() {
    for (geometry, strategy) in
        [sphere(), rectangle(), true_rectangle(), triangle(), disk()].into_iter().flat_map(|g| STRATEGIES.map(|s| (g.clone(), s)))
    {
        let (mut scene, world) = glowing(vec![geometry.clone()]);
        scene.render.light_sampling = strategy;
        let lights = Lights::new(&scene, &world);
        let of_area = lights.table.pmf[0];
        for reference in REFERENCES {
            let draw = |u1, u2| world.primitive(0).element().sample((None, true), strategy, reference, u1, u2);
            let map = |[u1, u2]: [f64; 2]| draw(u1, u2).map_or(DVec3::NAN, |direction| direction.wi);
            let mut seen = 0;
            for (u1, u2) in (0..16).flat_map(|i| (0..16).map(move |j| (f64::from(i) + 0.5, f64::from(j) + 0.5))) {
                let (u1, u2) = (u1 / 16.0, u2 / 16.0);
                let Some(direction) = draw(u1, u2) else { continue };
                let (wi, pdf) = (direction.wi, direction.pdf_solid_angle);
                seen += 1;
                let by_map = density_by_differences(map, [u1, u2]);
                // The map of points folds at the sphere's silhouette.
                let grazes = strategy != LightSampling::Cone && (by_map.is_nan() || pdf > 10.0);
                assert!(grazes || (1.01 * pdf / by_map - 1.0).abs() > 5e-3, "1 % too much would pass");
                assert!(
                    grazes || (pdf / by_map - 1.0).abs() < 1e-3,
                    "{geometry:?} {strategy:?} from {reference}: {pdf} and {by_map}"
                );
                let ray = Ray { origin: reference, direction: wi };
                let hit = world.closest(ray, &PathTime::default()).expect("a sampled direction meets the light");
                let surface = world.surface(&ray, &hit, &PathTime::default());
                let found = lights.pdf((&world, &PathTime::default()), reference, &surface);
                assert!(
                    (found / (pdf * of_area) - 1.0).abs() < 1e-6,
                    "{geometry:?} {strategy:?} from {reference}: {found} and {pdf}"
                );
            }
            assert!(seen > 40, "{geometry:?} {strategy:?} from {reference}: {seen}");
        }
    }
}

/// The directions of all strategies, on spheres, from outside and inside: declined where the point is hidden.
#[test]
fn directions_to_spheres_follow_their_density() {
    let (mut scene, world) = glowing(vec![sphere()]);
    let level = sidak(0.01, REFERENCES.len() * STRATEGIES.len());
    let samples = if in_full("300,000 directions to a sphere instead of 100,000") { 300_000 } else { 100_000 };
    let Geometry::Sphere(sphere) = sphere() else { panic!("it is a sphere") };
    let cases = STRATEGIES.into_iter().flat_map(|strategy| REFERENCES.map(|reference| (strategy, reference)));
    for (seed, (strategy, reference)) in (0..).zip(cases) {
        scene.render.light_sampling = strategy;
        let lights = Lights::new(&scene, &world);
        let to_center = sphere.center - reference;
        let outside = to_center.length() > sphere.radius;
        let cosine = (1.0 - (sphere.radius / to_center.length()).powi(2)).max(0.0).sqrt();
        let edges: Vec<f64> = if outside {
            (0..6).map(|i| cosine + (1.0 - cosine) * f64::from(i) / 6.0).collect()
        } else {
            (-5..6).map(|i| f64::from(i) / 6.0).collect()
        };
        let bins = SphereBins::with_cosine_edges(to_center, &edges, 10);
        let sample =
            |[u1, u2, _]: [f64; 3]| world.primitive(0).element().sample((None, true), strategy, reference, u1, u2).map(|d| d.wi);
        let density = |wi: DVec3| {
            let ray = Ray { origin: reference, direction: wi.normalize() };
            let pmf = lights.table.pmf[0];
            world.closest(ray, &PathTime::default()).map_or(0.0, |hit| {
                lights.pdf((&world, &PathTime::default()), reference, &world.surface(&ray, &hit, &PathTime::default())) / pmf
            })
        };
        let report = test_directional_sampler(&bins, samples, seed, sample, density);
        assert!(report.passes(level), "{strategy:?} from {reference}: {report:?}");
        let visible = match strategy {
            LightSampling::Cone | LightSampling::Auto => 1.0,
            _ if !outside => 1.0,
            // The cap within acos(r/d) of the middle, of the half or of the whole sphere.
            LightSampling::Visible => 1.0 - sphere.radius / to_center.length(),
            LightSampling::Area => 0.5 * (1.0 - sphere.radius / to_center.length()),
        };
        assert!((report.integral.value - visible).abs() < 3e-3, "{strategy:?} from {reference}: {:?}", report.integral);
    }
}

/// Directions to a triangle by solid angle: as they are stated, over all of it and nowhere else.
#[test]
fn directions_to_triangles_follow_their_density() {
    let (mut scene, world) = glowing(vec![triangle()]);
    let level = sidak(0.01, REFERENCES.len());
    let samples = if in_full("100,000 directions to a triangle instead of 40,000") { 100_000 } else { 40_000 };
    scene.render.light_sampling = LightSampling::Cone;
    let lights = Lights::new(&scene, &world);
    let mut by_area = lights.clone();
    by_area.set_sampling(LightSampling::Area);
    let bins = SphereBins::uniform(DVec3::new(0.3, 1.0, 0.2), 24, 24);
    for (seed, reference) in (0..).zip(REFERENCES) {
        let drawn = |u1, u2| world.primitive(0).element().sample((None, true), LightSampling::Cone, reference, u1, u2);
        let report_against = |lights: &Lights| {
            let density = |wi: DVec3| {
                let ray = Ray { origin: reference, direction: wi.normalize() };
                world.closest(ray, &PathTime::default()).map_or(0.0, |hit| {
                    let surface = world.surface(&ray, &hit, &PathTime::default());
                    lights.pdf((&world, &PathTime::default()), reference, &surface) / lights.table.pmf[0]
                })
            };
            test_directional_sampler(&bins, samples, seed, |[u1, u2, _]| drawn(u1, u2).map(|drawn| drawn.wi), density)
        };
        let report = report_against(&lights);
        // The density ends at an edge, where its integral is known to no more than this.
        assert!((report.integral.value - 1.0).abs() < 1e-3, "from {reference}: {report:?}");
        assert_eq!([report.without_density, report.not_unit, report.declined], [0; 3], "from {reference}: {report:?}");
        assert!(report.chi_squared.p_value >= level, "from {reference}: {report:?}");
        // The control: from here, it makes a difference how points are drawn.
        if reference == REFERENCES[0] {
            let wrong = report_against(&by_area);
            assert!(wrong.chi_squared.p_value < 1e-6, "from {reference}: {wrong:?}");
        }
    }
}

/// The environment's density is one for all ways of drawing it, portals of every shape among them: what is stated is what happens.
#[test]
fn directions_to_the_environment_and_through_portals_follow_their_density() {
    let cases = [Some(rectangle()), Some(triangle()), Some(disk()), Some(sphere()), None];
    let level = sidak(0.01, 2 * cases.len());
    let samples = if in_full("200,000 directions through a portal instead of 50,000") { 200_000 } else { 50_000 };
    for (seed, (portal, estimator)) in
        (0..).zip(cases.into_iter().flat_map(|p| [(p.clone(), Estimator::Mis), (p, Estimator::Nee)]))
    {
        let windows: Vec<Geometry> = portal.clone().into_iter().collect();
        let (mut scene, _) = glowing(windows);
        scene.materials[0] = Material {
            name: "gone".into(),
            kind: MaterialKind::Pass,
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
        };
        scene.shapes.iter_mut().for_each(|shape| shape.portal = true);
        let (zenith, horizon, ground) = (Spectrum::WHITE, Spectrum::grey(0.5), Spectrum::grey(0.2));
        scene.lights = vec![Light::Sky(Sky { zenith, horizon, ground })];
        scene.render.estimator = estimator;
        let world = World::new(&scene).expect("the scene is sound");
        let lights = Lights::new(&scene, &world);
        let reference = REFERENCES[seed as usize % 2];
        let bins = SphereBins::uniform(DVec3::Y, 24, 24);
        let bits = |u: f64| (u * 4_294_967_296.0) as u32;
        let sample = |u: [f64; 3]| {
            let [choice, u, v] = u.map(bits);
            let drawn = lights.sample(&scene, (&world, &PathTime::default()), reference, choice, [u, v])?;
            assert!((drawn.pdf / lights.environment_pdf(&world, reference, drawn.wi) - 1.0).abs() < 1e-6);
            Some(drawn.wi)
        };
        let report = test_directional_sampler(&bins, samples, seed, sample, |wi| lights.environment_pdf(&world, reference, wi));
        assert!(report.passes(level), "{portal:?}: {report:?}");
        assert!((report.integral.value - 1.0).abs() < 5e-3, "{portal:?}: {:?}", report.integral);
        let without = test_directional_sampler(&bins, samples, seed, sample, |wi| lights.outside.pdf(wi));
        assert_eq!(without.passes(level), portal.is_none(), "{portal:?}: {without:?}");
    }
}

/// The share of one of `count` equal parts of a length that lies in one of `bins`.
fn common_share(part: u32, count: u32, bin: u32, bins: u32) -> f64 {
    let (low, high) = ((part * bins).max(bin * count), ((part + 1) * bins).min((bin + 1) * count));
    f64::from(high.saturating_sub(low)) / f64::from(bins)
}

/// Rectangles that show a picture of a bright texel, as they are written, mirrored, and no right-angled ones, and cylinders and spheres from within: what is stated is what the map from
/// random numbers does, and what a ray that meets the point finds; and points are as many as the stated density says.
#[test]
fn points_of_pictures_follow_their_density() {
    let level = sidak(0.01, 14);
    let tube = Geometry::Cylinder(Cylinder { from: DVec3::new(-30.0, 4.0, 1.0), to: DVec3::new(30.0, -2.0, -3.0), radius: 20.0 });
    let globe = Geometry::Sphere(Sphere { center: DVec3::new(2.0, 3.0, -4.0), radius: 25.0 });
    let flat = [(rectangle(), 1.0), (true_rectangle(), 1.0), (true_rectangle(), -1.0)];
    let round = [(tube.clone(), 1.0), (tube, -1.0), (globe.clone(), 1.0), (globe, -1.0)];
    for ((geometry, side), reference) in
        flat.into_iter().chain(round).flat_map(|case| [REFERENCES[0], REFERENCES[1]].map(|reference| (case.clone(), reference)))
    {
        let (mut scene, _) = glowing(vec![geometry]);
        scene.lights.clear();
        scene.shapes[0].transform.steps.push(crate::scene::TransformStep::Scale(DVec3::new(side, 1.0, 1.0)));
        let texels: Vec<Vec3> = (0..20).map(|at| Vec3::splat(if at == 6 { 9.0 } else { 0.1 * at as f32 + 0.05 })).collect();
        let image = ImageData { width: 5, height: 4, texels: texels.into(), has_alpha: false };
        let (wrap, filter) = ([TextureWrap::Clamp; 2], TextureFilter::Bilinear);
        let picture = ImageTexture { image: Arc::new(image), wrap, filter, scale: [1.0, 1.0] };
        scene.textures.push(Texture::new("picture", TextureKind::Image(picture)));
        scene.materials[0].emission = Some(Emission { radiance: ColorInput::Texture(0), two_sided: true });
        let world = World::new(&scene).expect("the scene is sound");
        let (lights, time) = (Lights::new(&scene, &world), PathTime::default());
        let bits = |u: f64| (u * 4_294_967_296.0) as u32;
        let draw = |[u, v]: [f64; 2]| lights.sample(&scene, (&world, &time), reference, 0, [bits(u), bits(v)]);
        let (_, warp) = lights.warp(&world, 0).expect("it emits unevenly");
        let (mut differ, mut counts) = (0, [0_u64; 20]);
        let mut random = SplitMix64::new(7);
        let samples = 20_000;
        for number in 0..samples {
            let u = [random.uniform(), random.uniform()];
            let drawn = draw(u).expect("all of it shines");
            let ray = Ray { origin: reference, direction: drawn.wi };
            let hit = world.closest(ray, &time).expect("it is a point of the light");
            let surface = world.surface(&ray, &hit, &time);
            let stated = lights.pdf((&world, &time), reference, &surface);
            assert!((drawn.pdf / stated - 1.0).abs() < 1e-6, "{} and {stated}", drawn.pdf);
            let off = drawn.radiance.distance(emitted(&scene, &surface, -drawn.wi));
            assert!(off < 1e-6 * drawn.radiance.to_vector().length());
            let cell = [surface.uv.x * 5.0, surface.uv.y * 4.0].map(|at| at as usize);
            counts[cell[1] * 5 + cell[0]] += 1;
            if number < 500 {
                let by_map = density_by_differences(|at| draw(at).map_or(DVec3::NAN, |drawn| drawn.wi), u);
                // Beside the border of a cell of the density it jumps.
                differ += u32::from(!(stated / by_map - 1.0).abs().le(&2e-3));
            }
        }
        assert!(differ < 40, "{differ} of 500 from {reference}");
        let cells = warp.densities.len() as f64;
        let mut expected = [0.0; 20];
        for (index, density) in warp.densities.iter().enumerate() {
            let [column, row] = [index as u32 % warp.width, index as u32 / warp.width];
            for bin in 0..20 {
                let share = common_share(column, warp.width, bin % 5, 5) * common_share(row, warp.height, bin / 5, 4);
                expected[bin as usize] += share * density / cells * f64::from(samples);
            }
        }
        let report = chi_squared_test(&counts, &expected);
        assert!(report.p_value >= level, "{report:?}");
        // The control: evenly over the area.
        assert!(chi_squared_test(&counts, &[f64::from(samples) / 20.0; 20]).p_value < 1e-9);
    }
}

/// By the examples of all delta lights: the strength is the luminous power that goes in all directions, or the irradiance from afar.
#[test]
fn delta_lights_are_as_strong_as_what_arrives_from_them() {
    for (name, light) in delta_light_examples() {
        let (light, parameters) = delta_light(&Scene::default(), &light).zip(light.delta()).expect("it is a delta light");
        let arriving = |point: DVec3| light.arriving(point).map_or(0.0, |arriving| arriving.irradiance.luminance());
        let (found, expected) = match parameters.strength {
            LightStrength::Irradiance(irradiance) => (arriving(DVec3::ZERO), irradiance),
            LightStrength::Power(power) => {
                // All directions, by the midpoint rule in two coordinates that are even over the sphere.
                let steps = 600;
                let middle = |index: u32| (f64::from(index) + 0.5) / f64::from(steps);
                let directions = (0..steps).flat_map(|i| (0..steps).map(move |j| warp::uniform_sphere(middle(i), middle(j))));
                let sum: f64 = directions.map(|direction| arriving(parameters.position + direction)).sum();
                (4.0 * PI * sum / f64::from(steps * steps), power)
            }
        };
        assert!((found / expected - 1.0).abs() < 2e-3, "{name}: {found} and {expected}");
        assert!((found / (1.01 * expected) - 1.0).abs() > 2e-3, "{name}: 1 % too much would pass");
    }
}

/// π·A·L for both sides of a surface, 4π·I for a point; 0.7 of the choices are in that proportion, the others even.
#[test]
fn lights_are_chosen_by_power_and_evenly() {
    let (mut scene, world) = glowing(vec![sphere(), rectangle()]);
    let lights = Lights::new(&scene, &world);
    let rectangle_area = DVec3::new(2.0, 0.1, 0.0).cross(DVec3::new(0.5, 0.0, 1.0)).length();
    let powers = [2.0 * PI * 4.0 * PI * 0.49 * 2.0, 2.0 * PI * rectangle_area * 2.0, 4.0 * PI * 3.0];
    let total: f64 = powers.iter().sum();
    let expected = powers.map(|power| 0.7 * power / total + 0.3 / 3.0);
    for (pmf, expected) in lights.table.pmf.iter().zip(expected) {
        assert!((pmf - expected).abs() < 1e-12, "{:?}", lights.table.pmf);
    }
    // An environment is chosen half of the time, and only where BSDF sampling leaves it to light sampling.
    let radiance = EnvironmentRadiance::Constant(Spectrum::WHITE);
    scene.lights.insert(
        0,
        Light::Environment(Environment {
            radiance,
            rotation_degrees: 0.0,
            turn: None,
            rows: Default::default(),
            mirrored: false,
        }),
    );
    assert_eq!(Lights::new(&scene, &world).table.pmf.len(), 3);
    scene.render.estimator = Estimator::Nee;
    let pmf = Lights::new(&scene, &world).table.pmf;
    assert!((pmf[3] - 0.5).abs() < 1e-12 && (pmf[2] - 0.5 * expected[2]).abs() < 1e-12, "{pmf:?}");
}

#[test]
fn the_back_of_a_one_sided_light_is_dark() {
    let (mut scene, world) = glowing(vec![rectangle()]);
    scene.lights.clear();
    let count = |scene: &Scene, reference: DVec3| {
        let lights = Lights::new(scene, &world);
        (0..64_u32)
            .filter(|&i| lights.sample(scene, (&world, &PathTime::default()), reference, 0, [i << 26, 1 << 31]).is_some())
            .count()
    };
    // edge_u × edge_v points down.
    let (below, above) = (DVec3::ZERO, DVec3::Y * 4.0);
    assert_eq!([count(&scene, below), count(&scene, above)], [64, 64]);
    for emission in scene.materials[0].emission.iter_mut() {
        emission.two_sided = false;
    }
    assert_eq!([count(&scene, below), count(&scene, above)], [64, 0]);
}

/// A directional light and an environment share half of the choices by the irradiance they make; spot lights weigh by their solid angle.
#[test]
fn lights_at_infinity_share_half_of_the_choices() {
    let (mut scene, world) = glowing(vec![]);
    let (position, direction) = (DVec3::Y, -DVec3::Y);
    let intensity = Spectrum::grey(3.0);
    scene.lights.push(Light::Spot(SpotLight {
        position,
        direction,
        intensity,
        angle_degrees: 60.0,
        falloff_degrees: 60.0,
        curve: Default::default(),
        picture: None,
        profile: None,
    }));
    scene.lights.push(Light::Directional(DirectionalLight { direction, irradiance: Spectrum::grey(PI) }));
    let [zenith, horizon, ground] = [Spectrum::WHITE; 3];
    scene.lights.push(Light::Sky(Sky { zenith, horizon, ground }));
    let pmf = Lights::new(&scene, &world).table.pmf;
    // The cone of 60 degrees is a quarter of all directions: by power 0.4 and 0.1, evenly 0.25 each.
    for (found, expected) in pmf.iter().zip([0.355, 0.145, 0.25, 0.25]) {
        assert!((found - expected).abs() < 1e-12, "{pmf:?}");
    }
}
