//! Pictures of blends and rough materials by the reference: the two ways to treat a blend and the three estimators show the same,
//! and a blend of one material is that material.

use crate::common::effort::in_full;
use glam::DVec3;
use gpt::compare::{ImageComparison, ImageView, TileSettings, compare_replications};
use gpt::cpu::ReferenceRenderer;
use gpt::film::Band;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::*;
use gpt::spectrum::Spectrum;

const SIDE: u32 = 24;
/// Renders of each picture, every one with a seed of its own.
const REPLICATIONS: u32 = 10;

type Pixels = Vec<[f32; 3]>;

fn render(scene: &Scene) -> Pixels {
    let mut pixels = Vec::new();
    let request = RenderRequest { rows: 0..SIDE, samples: 0..scene.render.spp };
    let mut on_band = |band: Band| {
        pixels.extend(band.mean);
        Ok(())
    };
    let mut renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    let report = renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    assert_eq!(report.non_finite_samples, 0);
    pixels
}

fn replications(scene: &Scene, first_seed: u32) -> Vec<Pixels> {
    let with_seed = |seed| {
        let mut scene = scene.clone();
        scene.render.seed = seed;
        render(&scene)
    };
    (first_seed..first_seed + REPLICATIONS).map(with_seed).collect()
}

fn compare(first: &[Pixels], second: &[Pixels]) -> ImageComparison {
    fn of(all: &[Pixels]) -> Vec<ImageView<'_>> {
        all.iter().map(|pixels| ImageView { width: SIDE, pixels }).collect()
    }
    let settings = TileSettings { tile: 8, ..TileSettings::default() };
    compare_replications(&of(first), &of(second), &settings).expect("the pictures have the same size")
}

/// The two agree, and would not if one had 2 % more energy.
fn assert_same(what: &str, first: &[Pixels], second: &[Pixels]) {
    let comparison = compare(first, second);
    let rejected: Vec<String> = comparison.rejected().map(ToString::to_string).collect();
    assert!(rejected.is_empty(), "{what}:\n{}", rejected.join("\n"));
    let brighter: Vec<Pixels> =
        second.iter().map(|pixels| pixels.iter().map(|pixel| pixel.map(|value| 1.02 * value)).collect()).collect();
    assert!(!compare(first, &brighter).agrees(), "{what}: 2 % more energy would pass");
}

fn grey(value: f64) -> ColorInput {
    ColorInput::grey(value)
}

/// A grey floor under a rectangle light, seen from above at a slant, with room for things on it.
fn stage() -> Scene {
    let mut scene = Scene {
        film: FilmSettings { size: [SIDE; 2], ..FilmSettings::default() },
        render: RenderSettings { spp: 64, max_depth: 6, roulette_depth: 0.into(), ..RenderSettings::default() },
        camera: Camera {
            position: DVec3::new(0.0, 3.0, 6.0),
            look_at: DVec3::new(0.0, 0.7, 0.0),
            projection: Projection::Perspective { vertical_fov_degrees: 35.0 },
            ..Camera::default()
        },
        ..Scene::default()
    };
    let floor = material(&mut scene, MaterialKind::Diffuse { reflectance: grey(0.5) }, None);
    shape(&mut scene, Geometry::Plane(Plane { point: DVec3::ZERO, normal: DVec3::Y }), floor);
    let emission = Emission { radiance: ColorInput::Constant(Spectrum::new(4.0, 3.0, 2.0)), two_sided: false };
    let lamp = material(&mut scene, MaterialKind::Emissive, Some(emission));
    let (corner, edge_u, edge_v) = (DVec3::new(-1.5, 4.0, -1.5), DVec3::X * 3.0, DVec3::Z * 3.0);
    shape(&mut scene, Geometry::Rectangle(Rectangle { corner, edge_u, edge_v }), lamp);
    scene
}

fn material(scene: &mut Scene, kind: MaterialKind, emission: Option<Emission>) -> MaterialId {
    scene.materials.push(Material {
        name: scene.materials.len().to_string(),
        kind,
        normal_map: None,
        emission,
        two_sided: true,
        interior: None,
    });
    scene.materials.len() - 1
}

fn shape(scene: &mut Scene, geometry: Geometry, material: MaterialId) {
    let (label, transform) = (scene.shapes.len().to_string(), Transform::default());
    scene.shapes.push(Shape { label, geometry, material, transform, motion: None, portal: false, receiver: 0 });
}

fn ball(scene: &mut Scene, x: f64, material: MaterialId) {
    shape(scene, Geometry::Sphere(Sphere { center: DVec3::new(x, 0.8, 0.0), radius: 0.8 }), material);
}

fn blend(scene: &mut Scene, first: MaterialId, second: MaterialId, weight: BlendWeight) -> MaterialId {
    material(scene, MaterialKind::Blend { materials: [first, second], weight }, None)
}

fn metal(alpha: f64) -> MaterialKind {
    let (fresnel, facets) = (ConductorFresnel::Reflectance(grey(0.8)), Microfacets::ggx(grey(alpha)));
    MaterialKind::Conductor { fresnel, facets, specular_reflectance: grey(1.0), film: None }
}

fn rough_glass(facets: Microfacets) -> MaterialKind {
    MaterialKind::RoughGlass {
        ior: 1.5,
        facets,
        reflectance: grey(1.0),
        transmittance: grey(1.0),
        thin: false,
        film: None,
        dispersion: None,
    }
}

/// Balls of nested blends: every kind of lobe, a light among them, weights by angle and by noise.
fn blended_balls() -> Scene {
    let mut scene = stage();
    let (a, b) = (Spectrum::BLACK, Spectrum::WHITE);
    for kind in [TextureKind::Perlin { scale: 8.0, octaves: 3, a, b, seed: 1 }, TextureKind::Worley { scale: 9.0, a, b, seed: 2 }]
    {
        scene.textures.push(Texture::new(scene.textures.len().to_string(), kind));
    }
    let red =
        material(&mut scene, MaterialKind::Diffuse { reflectance: ColorInput::Constant(Spectrum::new(0.8, 0.2, 0.1)) }, None);
    let blue = MaterialKind::Phong {
        diffuse: ColorInput::Constant(Spectrum::new(0.1, 0.2, 0.5)),
        specular: grey(0.3),
        exponent: grey(20.0),
    };
    let blue = material(&mut scene, blue, None);
    let mirror = material(&mut scene, MaterialKind::Mirror { reflectance: grey(0.9) }, None);
    let steel = material(&mut scene, metal(0.2), None);
    let frosted = material(&mut scene, rough_glass(Microfacets::ggx(grey(0.3))), None);
    let emission = Emission { radiance: grey(0.5), two_sided: false };
    let glow = material(&mut scene, MaterialKind::Emissive, Some(emission));
    let marble = blend(&mut scene, red, blue, BlendWeight::Texture { texture: 0 });
    let ceramic = blend(&mut scene, marble, mirror, BlendWeight::Fresnel { ior: 1.5, exact: true });
    let spotted = blend(&mut scene, steel, frosted, BlendWeight::Texture { texture: 1 });
    let ember = blend(&mut scene, glow, spotted, BlendWeight::Reverse { of: Box::new(BlendWeight::Facing { power: 0.5 }) });
    ball(&mut scene, -1.1, ceramic);
    ball(&mut scene, 1.1, ember);
    scene
}

#[test]
#[ignore = "slow"]
fn pick_and_mixture_agree() {
    let mut scene = blended_balls();
    let mixture = replications(&scene, 100);
    scene.render.blend = BlendMode::Pick;
    let pick = replications(&scene, 200);
    assert_same("pick and mixture", &mixture, &pick);
}

/// Light sampling from both sides of a surface that transmits, shadow rays from the side the light is on, and densities that
/// match: the estimators agree on a ball and a pane of each kind between light, floor and camera.
#[test]
#[ignore = "slow"]
fn the_estimators_agree_on_rough_materials() {
    let kinds = [
        ("rough glass", rough_glass(Microfacets::ggx(grey(0.4)))),
        ("Phong glass", rough_glass(Microfacets::phong(grey(8.0)))),
        ("metal", metal(0.3)),
        ("glossy", MaterialKind::Glossy { reflectance: grey(0.8), exponent: grey(15.0) }),
        ("phong", MaterialKind::Phong { diffuse: grey(0.3), specular: grey(0.5), exponent: grey(25.0) }),
    ];
    let everywhere = in_full("estimators on Phong glass, phong and glossy surfaces");
    for (name, kind) in kinds.into_iter().filter(|(name, _)| everywhere || ["rough glass", "metal"].contains(name)) {
        let mut scene = stage();
        scene.render.max_depth = 4;
        let material = material(&mut scene, kind, None);
        ball(&mut scene, -1.1, material);
        let (corner, edge_u, edge_v) = (DVec3::new(0.2, 1.2, -1.0), DVec3::X * 2.0, DVec3::new(0.0, 0.3, 2.0));
        shape(&mut scene, Geometry::Rectangle(Rectangle { corner, edge_u, edge_v }), material);
        // Glass makes the most noise.
        let spp = if name.ends_with("glass") { 128 } else { 32 };
        let [mis, nee, bsdf] = [(Estimator::Mis, 1), (Estimator::Nee, 4), (Estimator::Bsdf, 4)].map(|(estimator, times)| {
            scene.render.estimator = estimator;
            scene.render.spp = times * spp;
            replications(&scene, 1000 + estimator as u32 * 50)
        });
        assert_same(&format!("{name}, mis and nee"), &mis, &nee);
        assert_same(&format!("{name}, mis and bsdf"), &mis, &bsdf);
    }
}

/// w0 of 0 or 1, or a mean of equals, is the pure material's picture, bit for bit.
#[test]
fn a_blend_of_one_material_is_that_material() {
    let one = grey(1.0);
    let kinds = [
        MaterialKind::Diffuse { reflectance: grey(0.7) },
        MaterialKind::Mirror { reflectance: grey(0.7) },
        MaterialKind::Glass { ior: 1.5, reflectance: one, transmittance: one, thin: false, film: None, dispersion: None },
        metal(0.3),
        rough_glass(Microfacets::ggx(grey(0.3))),
    ];
    for kind in kinds {
        let mut scene = stage();
        scene.render.spp = 8;
        let pure = material(&mut scene, kind.clone(), None);
        let other =
            material(&mut scene, MaterialKind::Phong { diffuse: grey(0.1), specular: grey(0.3), exponent: grey(9.0) }, None);
        let first = blend(&mut scene, pure, other, BlendWeight::Constant { value: 1.0 });
        let second = blend(
            &mut scene,
            other,
            first,
            BlendWeight::Threshold { tau: 2.0, of: Box::new(BlendWeight::Facing { power: 1.0 }) },
        );
        for mode in [BlendMode::Mixture, BlendMode::Pick] {
            scene.render.blend = mode;
            let of = |material: MaterialId| {
                let mut scene = scene.clone();
                ball(&mut scene, 0.0, material);
                render(&scene)
            };
            let alone = of(pure);
            assert_eq!(of(first), alone, "{kind:?}");
            assert_eq!(of(second), alone, "{kind:?}");
            assert_ne!(of(other), alone, "{kind:?}");
        }
    }
}
