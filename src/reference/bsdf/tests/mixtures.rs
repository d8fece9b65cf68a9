//! How blends become lobes, and how one of them is chosen.

use super::*;
use crate::reference::intersect::{PathTime, Ray, World};
use crate::scene::{BlendMode, BlendWeight, Emission, Geometry, Material, MaterialKind, Rectangle, Shape, Transform};

/// A scene of one rectangle in the plane z = 0, front up, made of the last material.
fn scene(kinds: Vec<MaterialKind>, mode: BlendMode) -> Scene {
    let mut scene = Scene::default();
    scene.render.blend = mode;
    for (index, kind) in kinds.into_iter().enumerate() {
        scene.materials.push(Material {
            name: index.to_string(),
            kind,
            normal_map: None,
            emission: None,
            two_sided: true,
            interior: None,
        });
    }
    let geometry =
        Geometry::Rectangle(Rectangle { corner: DVec3::new(-5.0, -5.0, 0.0), edge_u: DVec3::X * 10.0, edge_v: DVec3::Y * 10.0 });
    let material = scene.materials.len() - 1;
    let transform = Transform::default();
    scene.shapes.push(Shape { label: "square".into(), geometry, material, transform, motion: None, portal: false, receiver: 0 });
    scene
}

/// The rectangle's middle.
pub(super) fn surface(scene: &Scene) -> Surface {
    let world = World::new(scene).expect("the scene is sound");
    let ray = Ray { origin: DVec3::Z, direction: -DVec3::Z };
    world.surface(&ray, &world.closest(ray, &PathTime::default()).expect("the rectangle is there"), &PathTime::default())
}

fn bsdf(scene: &Scene, u_blend: f64) -> Bsdf {
    Bsdf::new(scene, &surface(scene), at_degrees(30.0, 0.4), u_blend)
}

fn grey(reflectance: f64) -> MaterialKind {
    MaterialKind::Diffuse { reflectance: ColorInput::grey(reflectance) }
}

fn mirror_kind(reflectance: f64) -> MaterialKind {
    MaterialKind::Mirror { reflectance: ColorInput::grey(reflectance) }
}

fn blend(first: usize, second: usize, value: f64) -> MaterialKind {
    MaterialKind::Blend { materials: [first, second], weight: BlendWeight::Constant { value } }
}

fn samples(bsdf: &Bsdf) -> Vec<Option<BsdfSample>> {
    cube_points(500, 21).map(|[u1, u2, u]| bsdf.sample(u, u1, u2)).collect()
}

/// w0 of 0 and 1, and a partner that is black, leave the other material as it is: the same samples, bit for bit.
#[test]
fn a_blend_with_one_part_is_that_part() {
    let kinds = || {
        let conductor = MaterialKind::Conductor {
            fresnel: crate::scene::ConductorFresnel::Reflectance(ColorInput::grey(0.7)),
            facets: Microfacets::ggx(ColorInput::grey(0.3)),
            specular_reflectance: ColorInput::grey(1.0),
            film: None,
        };
        let phong = MaterialKind::Phong {
            diffuse: ColorInput::grey(0.3),
            specular: ColorInput::grey(0.4),
            exponent: ColorInput::grey(9.0),
        };
        let one = ColorInput::grey(1.0);
        [
            grey(0.6),
            mirror_kind(0.8),
            conductor,
            phong,
            MaterialKind::Glass { ior: 1.5, reflectance: one, transmittance: one, thin: false, film: None, dispersion: None },
        ]
    };
    for mode in [BlendMode::Mixture, BlendMode::Pick] {
        for pure in kinds() {
            let alone = samples(&bsdf(&scene(vec![pure.clone()], mode), 0.3));
            for other in kinds() {
                for (kinds, what) in [
                    (vec![pure.clone(), other.clone(), blend(0, 1, 1.0)], "w0 = 1"),
                    (vec![other.clone(), pure.clone(), blend(0, 1, 0.0)], "w0 = 0"),
                    (vec![other.clone(), pure.clone(), blend(0, 1, 0.0), blend(2, 0, 1.0)], "nested"),
                ] {
                    let blended = bsdf(&scene(kinds, mode), 0.3);
                    assert_eq!(samples(&blended), alone, "{what}, {mode:?}");
                }
            }
        }
    }
}

#[test]
fn diffuse_lobes_are_one_lobe_of_the_mean() {
    let mean = 0.25 * 0.8 + 0.75 * (0.5 * 0.4 + 0.5 * 0.1);
    let kinds = vec![grey(0.8), grey(0.4), grey(0.1), blend(1, 2, 0.5), blend(0, 3, 0.25)];
    let blended = samples(&bsdf(&scene(kinds, BlendMode::Mixture), 0.5));
    let alone = samples(&bsdf(&scene(vec![grey(mean)], BlendMode::Mixture), 0.5));
    for (a, b) in blended.into_iter().zip(alone) {
        let (a, b) = (a.expect("Lambert reflects"), b.expect("Lambert reflects"));
        assert_eq!((a.wi, a.density), (b.wi, b.density));
        assert!(a.weight.distance(b.weight) < 1e-15);
    }
}

/// The diffuse lobe comes first wherever it stands in the tree; the others follow in the tree's order, the rest of the number
/// becoming the lobe's own.
#[test]
fn lobes_are_chosen_in_order_by_weight_times_reflectance() {
    let white = ColorInput::grey(1.0);
    let glass =
        MaterialKind::Glass { ior: 1.5, reflectance: white, transmittance: white, thin: false, film: None, dispersion: None };
    // Mirror 0.5 × 0.8, glass 0.25 × 1, diffuse 0.25 × 0.6: diffuse 0.15, mirror 0.40, glass 0.25 of 0.80 in all.
    let kinds = vec![mirror_kind(0.8), glass, grey(0.6), blend(1, 2, 0.5), blend(0, 3, 0.5)];
    let blended = bsdf(&scene(kinds, BlendMode::Mixture), 0.5);
    let wo = blended.view.wo;
    let reflected = DVec3::new(-wo.x, -wo.y, wo.z);
    let (first, second) = (0.15 / 0.8, 0.55 / 0.8);
    let fresnel = dielectric_reflectance(wo.z, 1.5);
    for i in 0..1000 {
        let u = (f64::from(i) + 0.5) / 1000.0;
        let sample = blended.sample(u, 0.3, 0.6).expect("all three scatter");
        if u < first {
            assert!(sample.density != Density::Delta);
            // Diffuse alone is no delta lobe: its value over its share of the density.
            assert!((sample.weight.r() - 0.25 * 0.6 / first).abs() < 1e-12);
        } else if u < second {
            assert!((sample.wi - reflected).length() < 1e-12 && sample.density == Density::Delta);
            assert!((sample.weight.r() - 0.5 * 0.8 / (second - first)).abs() < 1e-12);
        } else {
            let own = (u - second) / (1.0 - second);
            assert_eq!(sample.wi.z > 0.0, own < fresnel, "{own} {fresnel}");
            let scale = if own < fresnel { 1.0 } else { 1.0 / 2.25 };
            assert!((sample.weight.r() - 0.25 / (1.0 - second) * scale).abs() < 1e-12);
        }
    }
}

#[test]
fn picking_takes_one_material_by_its_weight() {
    let kinds = vec![mirror_kind(0.8), grey(0.3), grey(0.6), blend(1, 2, 0.5), blend(0, 3, 0.5)];
    let scene = scene(kinds, BlendMode::Pick);
    let of = |u_blend: f64| bsdf(&scene, u_blend);
    for i in 0..100 {
        let u = (f64::from(i) + 0.5) / 100.0;
        let sample = of(u).sample(0.9, 0.3, 0.6).expect("all scatter");
        let expected = if u < 0.5 {
            0.8
        } else if u < 0.75 {
            0.3
        } else {
            0.6
        };
        assert_eq!(sample.density == Density::Delta, u < 0.5);
        assert!((sample.weight.r() - expected).abs() < 1e-12, "{u}: {sample:?}");
    }
}

/// Emissive and black parts scatter nothing, alone or together.
#[test]
fn parts_that_scatter_nothing_take_no_samples() {
    for kinds in [
        vec![MaterialKind::Emissive],
        vec![grey(0.0)],
        vec![grey(0.0), MaterialKind::Emissive, blend(0, 1, 0.5)],
        vec![mirror_kind(0.0), grey(0.0), blend(0, 1, 0.5)],
    ] {
        let black = bsdf(&scene(kinds, BlendMode::Mixture), 0.5);
        assert!(black.sample(0.5, 0.5, 0.5).is_none() && !black.has_non_delta_lobe());
    }
    let half = bsdf(&scene(vec![grey(0.8), MaterialKind::Emissive, blend(0, 1, 0.5)], BlendMode::Mixture), 0.5);
    assert!(samples(&half).into_iter().all(|sample| sample.is_some_and(|sample| (sample.weight.r() - 0.4).abs() < 1e-15)));
}

#[test]
fn a_pass_part_lets_the_ray_go_on() {
    let blended = bsdf(&scene(vec![MaterialKind::Pass, grey(0.5), blend(0, 1, 0.25)], BlendMode::Mixture), 0.5);
    let share = 0.25 / (0.25 + 0.75 * 0.5);
    let mut passed = 0;
    for i in 0..1000 {
        let sample = blended.sample((f64::from(i) + 0.5) / 1000.0, 0.2, 0.7).expect("both scatter");
        if sample.is_null {
            passed += 1;
            assert_eq!((sample.wi, sample.density, sample.eta), (-blended.view.wo, Density::Delta, 1.0));
            assert!((sample.weight.r() - 0.25 / share).abs() < 1e-12);
        }
    }
    assert!((f64::from(passed) - 1000.0 * share).abs() < 1.0, "{passed}");
}

/// Σ wᵢ·Leᵢ, each part by its own rule of sides, and the blend's own.
#[test]
fn emission_is_blended() {
    use crate::reference::emission::{emitted, mean_exitance};
    use std::f64::consts::PI;
    let mut scene =
        scene(vec![MaterialKind::Emissive, grey(0.5), blend(0, 1, 0.25), mirror_kind(1.0), blend(2, 3, 0.5)], BlendMode::Pick);
    let emission = |radiance: f64, two_sided| Some(Emission { radiance: ColorInput::grey(radiance), two_sided });
    scene.materials[0].emission = emission(8.0, false);
    scene.materials[1].emission = emission(2.0, true);
    scene.materials[4].emission = emission(1.0, false);
    let surface = surface(&scene);
    let from = |degrees: f64| emitted(&scene, &surface, at_degrees(degrees, 1.0)).r();
    assert!((from(20.0) - (0.125 * 8.0 + 0.375 * 2.0 + 1.0)).abs() < 1e-12);
    assert!((from(170.0) - 0.375 * 2.0).abs() < 1e-12);
    assert!((mean_exitance(&scene, 4) - 2.0 * PI * 2.75).abs() < 1e-12);
    assert_eq!(mean_exitance(&scene, 3), 0.0);
    // Seen at an angle, a facing weight dims it.
    scene.materials[4].kind = MaterialKind::Blend { materials: [0, 3], weight: BlendWeight::Facing { power: 1.0 } };
    assert!((emitted(&scene, &surface, at_degrees(60.0, 1.0)).r() - 5.0).abs() < 1e-12);
    assert!((mean_exitance(&scene, 4) - PI * 5.0).abs() < 1e-12);
}
