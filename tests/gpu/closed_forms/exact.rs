//! Closed forms without any noise: every pixel has the exact value.

use std::sync::{Arc, LazyLock};

use glam::{DVec3, Vec2, Vec3};
use gpt::scene::*;
use gpt::spectrum::Spectrum;

use super::devices;
use super::scenes::*;
use crate::common::effort::in_full;

/// To a camera ray all estimators are one; that they are is tried on spheres, as each costs the device a set of kernels.
fn assert_every_pixel(name: &str, scene: &Scene, expected: Spectrum) {
    let all = [Estimator::Mis, Estimator::Nee, Estimator::Bsdf];
    let estimators = if name == "sphere" { &all[..] } else { &all[..1] };
    // The wavefront has a set of kernels for each.
    static EVERYWHERE: LazyLock<bool> = LazyLock::new(|| in_full("exact pictures of every shape by the wavefront"));
    let wavefront = name == "sphere" || *EVERYWHERE;
    for &(device, render, _) in devices().iter().take(if wavefront { 3 } else { 2 }) {
        for &estimator in estimators {
            let mut scene = scene.clone();
            scene.render.estimator = estimator;
            let expected = expected.to_f32();
            for (index, pixel) in render(&scene).into_iter().enumerate() {
                assert_eq!(pixel, expected, "{device}, {name}, {estimator:?}, pixel {index}");
            }
        }
    }
}

/// Every finite shape and a plane around or before the camera, each wide enough to fill the picture, front towards the camera.
fn shapes_before_the_camera() -> Vec<(&'static str, Geometry)> {
    let corners = [[-30.0, -30.0, 0.0], [30.0, -30.0, 0.0], [0.0, 60.0, 0.0]];
    let rectangle = Geometry::Rectangle(Rectangle {
        corner: DVec3::new(-9.0, -9.0, 0.0),
        edge_u: DVec3::X * 18.0,
        edge_v: DVec3::new(1.0, 18.0, 0.0),
    });
    vec![
        ("sphere", sphere(-DVec3::Z, 1.5)),
        ("rectangle", rectangle),
        ("disk", Geometry::Disk(Disk { center: DVec3::ZERO, normal: DVec3::Z, radius: 9.0 })),
        ("box", Geometry::Box(Cuboid { min: DVec3::splat(-9.0), max: DVec3::new(9.0, 9.0, 0.0) })),
        ("plane", Geometry::Plane(Plane { point: DVec3::ZERO, normal: DVec3::Z })),
        ("mesh", triangle(corners)),
    ]
}

/// Two samples of a power of two: means are exact as well.
fn looking_down_z() -> Scene {
    scene(2, camera(DVec3::new(0.0, 0.0, 3.0), DVec3::ZERO, 20.0))
}

#[test]
fn a_light_looks_as_it_emits_from_the_front_and_black_from_behind() {
    let radiance = Spectrum::new(0.125, 17.0, 3.7);
    for (name, geometry) in shapes_before_the_camera() {
        let mut scene = looking_down_z();
        let light = emissive(&mut scene, radiance);
        shape(&mut scene, geometry, light);
        assert_every_pixel(name, &scene, radiance);
        if !matches!(name, "sphere" | "box") {
            scene.camera.position.z = -3.0;
            assert_every_pixel(&format!("{name} from behind"), &scene, Spectrum::BLACK);
        }
    }
}

#[test]
fn a_light_behind_a_pass_surface_looks_the_same() {
    let mut scene = looking_down_z();
    let light = emissive(&mut scene, Spectrum::WHITE);
    let nothing = material(&mut scene, MaterialKind::Pass, None);
    let [geometry, translucent] = [1.0, 0.5].map(|radius| sphere(-DVec3::Z * 0.5, 2.0 * radius));
    shape(&mut scene, geometry, light);
    shape(&mut scene, Geometry::Plane(Plane { point: DVec3::Z * 2.0, normal: (DVec3::Y + DVec3::Z).normalize() }), nothing);
    shape(&mut scene, translucent, nothing);
    assert_every_pixel("pass", &scene, Spectrum::WHITE);
}

/// Past asin(1/1.5) = 41.8° the underside of a pane of glass shows the floor below and nothing of the sky.
#[test]
fn total_internal_reflection_is_total() {
    let floor_radiance = Spectrum::new(0.75, 0.5, 0.25);
    let from = |height: f64| {
        // Looks up at 45° for height 3, more steeply below.
        let mut scene = scene(4, camera(DVec3::new(0.0, -height, 0.0), DVec3::new(3.0, 0.0, 0.0), 5.0));
        let pane = glass(&mut scene, 1.5);
        shape(&mut scene, floor(100.0), pane);
        let light = emissive(&mut scene, floor_radiance);
        shape(&mut scene, Geometry::Plane(Plane { point: -DVec3::Y * 20.0, normal: DVec3::Y }), light);
        environment(&mut scene, 1.0);
        scene
    };
    assert_every_pixel("total internal reflection", &from(3.0), floor_radiance);
    // At 31° most of the light comes through from the sky, squeezed by ior².
    let through = devices()[0].1(&from(5.0));
    let mean = through.iter().map(|pixel| f64::from(pixel[0])).sum::<f64>() / through.len() as f64;
    assert!(mean > 2.0 && mean < 2.25, "{mean}");
}

/// A light textured half black, half white, seen through its texture coordinates.
#[test]
fn emission_follows_its_texture() {
    let mut scene = looking_down_z();
    let texels = vec![Vec3::ZERO, Vec3::ONE];
    let image = Arc::new(ImageData { width: 2, height: 1, texels: texels.into(), has_alpha: false });
    let image = ImageTexture { image, wrap: [TextureWrap::Clamp; 2], filter: TextureFilter::Nearest, scale: [1.0; 2] };
    scene.textures.push(Texture::new("halves", TextureKind::Image(image)));
    let emission = Emission { radiance: ColorInput::ScaledTexture(0, Spectrum::grey(3.0)), two_sided: false };
    let light = material(&mut scene, MaterialKind::Emissive, Some(emission));
    let positions = [[-9.0, -9.0, 0.0], [9.0, -9.0, 0.0], [9.0, 9.0, 0.0], [-9.0, 9.0, 0.0]].map(Vec3::from).to_vec();
    let uvs = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Vec2::from).to_vec();
    let mesh = Mesh { positions, uvs, faces: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
    shape(&mut scene, Geometry::Mesh(Arc::new(mesh)), light);
    let [width, _] = scene.film.size;
    for &(device, render, _) in devices() {
        for (index, pixel) in (0..).zip(render(&scene)) {
            let expected = if index % width < width / 2 { 0.0 } else { 3.0 };
            assert_eq!(pixel, [expected; 3], "{device}, pixel {index}");
        }
    }
}
