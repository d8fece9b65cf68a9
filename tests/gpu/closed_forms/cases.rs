//! The family of closed forms that hold on average.

use std::f64::consts::PI;

use glam::DVec3;
use gpt::scene::*;
use gpt::spectrum::Spectrum;

use super::scenes::*;

/// A scene all of whose pixels have the same expectation.
pub struct Case {
    pub name: String,
    /// The number of the scene, of which there is a case for each estimator, and which one this is.
    pub of_scene: [usize; 2],
    pub scene: Scene,
    pub expected: [f64; 3],
}

pub const ALL: [Estimator; 3] = [Estimator::Mis, Estimator::Nee, Estimator::Bsdf];
/// The estimators that see point lights.
pub const WITH_LIGHT_SAMPLING: [Estimator; 2] = [Estimator::Mis, Estimator::Nee];

pub fn all() -> Vec<Case> {
    let mut cases = Vec::new();
    furnaces(&mut cases);
    inward_spheres(&mut cases);
    environments(&mut cases);
    sphere_lights(&mut cases);
    triangle_lights(&mut cases);
    cases
}

pub fn push(cases: &mut Vec<Case>, name: &str, scene: &Scene, expected: Spectrum, estimators: &[Estimator]) {
    let number = cases.last().map_or(0, |case| case.of_scene[0] + 1);
    for (index, &estimator) in estimators.iter().enumerate() {
        let mut scene = scene.clone();
        scene.render.estimator = estimator;
        if estimator == Estimator::Nee {
            // Light sampling alone is the noisiest.
            scene.render.spp *= 3;
        }
        let (name, of_scene) = (format!("{name}, {estimator:?}"), [number, index]);
        cases.push(Case { name, of_scene, scene, expected: expected.to_rgb() });
    }
}

/// Off the centre, looking askew.
fn inside() -> Camera {
    camera(DVec3::new(0.2, -0.3, 0.1), DVec3::new(1.0, 0.5, -0.7), 60.0)
}

/// Closed Lambert surface of albedo ρ that emits Le = 1 everywhere: 1/(1−ρ); direct light alone: 1 + ρ.
fn furnaces(cases: &mut Vec<Case>) {
    let unit_box = Geometry::Box(Cuboid { min: -DVec3::ONE, max: DVec3::ONE });
    let tube = Geometry::Cylinder(Cylinder { from: DVec3::NEG_Y, to: DVec3::Y, radius: 1.0 });
    // They reach beyond the tube, so that no light gets out where they meet it.
    let lid = |center: DVec3| Geometry::Disk(Disk { center, normal: DVec3::Y, radius: 1.01 });
    let rooms = [
        ("sphere", vec![sphere(DVec3::ZERO, 1.0)]),
        ("box", vec![unit_box]),
        ("mesh", vec![cube_mesh()]),
        ("tube", vec![tube, lid(DVec3::NEG_Y), lid(DVec3::Y)]),
    ];
    for (name, room) in rooms {
        for albedo in [0.5, 0.8] {
            let mut scene = scene(64, inside());
            // Roulette adds noise and waits, lest it hide 1 %: the longer, the brighter the walls.
            scene.render.roulette_depth = if albedo > 0.5 { 24 } else { 9 }.into();
            let walls = glowing(&mut scene, albedo, 1.0);
            room.iter().for_each(|part| shape(&mut scene, part.clone(), walls));
            // Emitting walls that meet at an edge give light sampling alone infinite variance.
            let estimators = if name == "sphere" { &ALL[..] } else { &[Estimator::Mis, Estimator::Bsdf] };
            push(cases, &format!("furnace {name}, albedo {albedo}"), &scene, Spectrum::grey(1.0 / (1.0 - albedo)), estimators);
            if name == "sphere" {
                scene.render.max_depth = 2;
                push(cases, &format!("furnace {name}, albedo {albedo}, direct"), &scene, Spectrum::grey(1.0 + albedo), &ALL);
                scene.render.heuristic = MisHeuristic::Balance;
                push(
                    cases,
                    &format!("the same, balance, albedo {albedo}"),
                    &scene,
                    Spectrum::grey(1.0 + albedo),
                    &[Estimator::Mis],
                );
            }
        }
    }
}

/// Unit sphere seen from inside, albedo ½: (I/r²)(ρ/π)/(1−ρ) with point lights in the centre, Le/(1−ρ) where it glows.
fn inward_spheres(cases: &mut Vec<Case>) {
    for count in [1, 4] {
        let mut scene = scene(128, inside());
        let walls = diffuse(&mut scene, 0.5);
        shape(&mut scene, sphere(DVec3::ZERO, 1.0), walls);
        let light =
            Light::Point(PointLight { position: DVec3::ZERO, intensity: Spectrum::grey(PI / f64::from(count)), profile: None });
        scene.lights = vec![light; count as usize];
        push(cases, &format!("{count} point lights in a sphere"), &scene, Spectrum::WHITE, &WITH_LIGHT_SAMPLING);
    }
    let mut scene = scene(128, inside());
    let walls = glowing(&mut scene, 0.5, 0.5);
    shape(&mut scene, sphere(DVec3::ZERO, 1.0), walls);
    push(cases, "glowing sphere from inside", &scene, Spectrum::WHITE, &ALL);
}

/// Under an environment of 1 all round, a lossless surface shows 1, a Lambert surface its albedo, a mirror its tint.
fn environments(cases: &mut Vec<Case>) {
    let tint = Spectrum::new(0.9, 0.5, 0.25);
    let input = ColorInput::Constant(tint);
    let one = ColorInput::grey(1.0);
    let kinds = [
        ("Lambert", MaterialKind::Diffuse { reflectance: input }, tint),
        ("mirror", MaterialKind::Mirror { reflectance: input }, tint),
        (
            "glass 1.5",
            MaterialKind::Glass { ior: 1.5, reflectance: one, transmittance: one, thin: false, film: None, dispersion: None },
            Spectrum::WHITE,
        ),
        (
            "glass 1/1.5",
            MaterialKind::Glass {
                ior: 1.0 / 1.5,
                reflectance: one,
                transmittance: one,
                thin: false,
                film: None,
                dispersion: None,
            },
            Spectrum::WHITE,
        ),
    ];
    for (name, kind, expected) in kinds {
        // To within about a degree of the sphere's silhouette, at asin(1/3) = 19.47° from its middle.
        let mut scene = scene(256, camera(DVec3::new(0.0, 0.0, 3.0), DVec3::new(0.6, 0.0, 0.0), 12.0));
        let material = material(&mut scene, kind, None);
        shape(&mut scene, sphere(DVec3::ZERO, 1.0), material);
        environment(&mut scene, 1.0);
        push(cases, &format!("{name} sphere under an environment"), &scene, expected, &ALL);
    }
}

/// A camera that sees so little of the floor around the origin that its radiance is the same in all pixels, to 10⁻⁶.
pub fn at_the_origin() -> Camera {
    camera(DVec3::new(1.5, 0.8, 1.1), DVec3::ZERO, 0.02)
}

/// A sphere of radius R and radiance L straight above: irradiance πL(R/d)².
fn sphere_lights(cases: &mut Vec<Case>) {
    let (radius, distance, albedo) = (0.6, 1.0, 0.5);
    let radiance = Spectrum::new(1.0, 2.0, 4.0);
    let up = DVec3::Y;
    let grounds = [
        ("rectangle", floor(20.0)),
        ("plane", Geometry::Plane(Plane { point: DVec3::ZERO, normal: up })),
        ("disk", Geometry::Disk(Disk { center: DVec3::ZERO, normal: up, radius: 20.0 })),
    ];
    for (name, ground) in grounds {
        let mut scene = scene(256, at_the_origin());
        // Further edges would add light that came off the floor and hit nothing but black: none. They only cost time.
        scene.render.max_depth = 2;
        let white = diffuse(&mut scene, albedo);
        shape(&mut scene, ground, white);
        let light = emissive(&mut scene, radiance);
        shape(&mut scene, sphere(up * distance, radius), light);
        let expected = radiance * albedo * (radius / distance).powi(2);
        push(cases, &format!("sphere light over a {name}"), &scene, expected, &ALL);
    }
}

/// A triangle light over a floor of albedo ½ (nori's fifth assignment; Lambert's formula), by area and by solid angle.
fn triangle_lights(cases: &mut Vec<Case>) {
    let table: [([[f32; 3]; 3], f64); 5] = [
        ([[-0.443432, 0.596366, 0.495985], [-0.320397, 0.0677699, -0.229359], [0.0341197, 0.11415, -0.343049]], 0.0898393),
        ([[0.461963, 0.397843, 0.412747], [-0.0381582, 0.851323, -0.156872], [0.195443, 0.891957, -0.260672]], 0.0229200),
        ([[0.100871, 0.289075, -0.422609], [-0.308386, 0.629587, 0.423966], [-0.373132, 0.237287, 0.351592]], 0.0534195),
        ([[-0.17575, 0.639397, 0.151268], [0.318604, 0.732996, 0.459771], [0.139095, 0.294498, 0.478556]], 0.0205314),
        ([[-0.17487, 0.447916, 0.367201], [-0.405259, 0.249607, -0.354079], [0.356029, 0.0918984, -0.132271]], 0.2617399),
    ];
    for (index, (corners, expected)) in table.into_iter().enumerate() {
        // The camera looks from below the light, where no triangle is in its way.
        let mut scene = scene(1024, camera(DVec3::new(1.0, 0.02, 1.0), DVec3::ZERO, 0.001));
        scene.render.max_depth = 2;
        let white = diffuse(&mut scene, 0.5);
        shape(&mut scene, floor(20.0), white);
        let light = emissive(&mut scene, Spectrum::WHITE);
        shape(&mut scene, triangle(corners), light);
        // BSDF samples seldom meet the dim ones: they would need many samples to see 1 %.
        let estimators = if expected > 0.08 { &ALL[..] } else { &WITH_LIGHT_SAMPLING };
        for strategy in [LightSampling::Area, LightSampling::Cone] {
            scene.render.light_sampling = strategy;
            push(cases, &format!("triangle light {index} by {strategy:?}"), &scene, Spectrum::grey(expected), estimators);
        }
    }
}
