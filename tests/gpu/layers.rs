//! Layers beside the picture: the device against the reference, channel by channel, and both against closed forms.

use std::path::Path;
use std::sync::LazyLock;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use glam::DVec3;
use gpt::cpu::ReferenceRenderer;
use gpt::film::{Band, KernelLayer};
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::plan::{PlanOptions, StageMode};
use gpt::reference::layer::layer_scene;
use gpt::renderer::{RenderRequest, Renderer, Silent};
use gpt::scene::Scene;

pub(crate) const SPP: u32 = 8;
const BOTH: [StageMode; 2] = [StageMode::Fused, StageMode::Wavefront];

/// Means and counts of a layer's pixels.
#[derive(Debug, PartialEq)]
pub(crate) struct Pixels {
    pub means: Vec<[f32; 3]>,
    pub counts: Vec<u32>,
}

fn pixels(renderer: &mut dyn Renderer, height: u32) -> Pixels {
    let mut found = Pixels { means: Vec::new(), counts: Vec::new() };
    let request = RenderRequest { rows: 0..height, samples: 0..SPP };
    let mut on_band = |band: Band| {
        found.counts.extend(band.counts.clone().unwrap_or_else(|| vec![band.samples; band.mean.len()]));
        found.means.extend(band.mean);
        Ok(())
    };
    renderer.render(&request, &Silent, &mut on_band).expect("rendering succeeds");
    found
}

fn on_cpu(scene: &Scene, layer: KernelLayer) -> Pixels {
    let scene = layer_scene(scene, layer);
    pixels(&mut ReferenceRenderer::of_layer(&scene, Some(layer)).expect("it can be rendered"), scene.film.size[1])
}

/// By these ways in which stages run; None without a device.
fn on_gpu(scene: &Scene, layer: KernelLayer, ways: &[StageMode]) -> Option<Vec<Pixels>> {
    let device = DEVICE.as_ref()?;
    let scene = layer_scene(scene, layer);
    let by_way = |&stages: &StageMode| {
        let options = PlanOptions { stages: Some(stages), layer: Some(layer), ..PlanOptions::default() };
        pixels(&mut GpuRenderer::on(device, &scene, &options).expect("the scene fits"), scene.film.size[1])
    };
    Some(ways.iter().map(by_way).collect())
}

fn built_in(name: &str) -> Scene {
    let mut scene = load::load(Some(name)).expect("it is built in");
    scene.film.size = [32, 24];
    scene.render.spp = SPP;
    scene
}

/// Share of pixels in which every channel agrees within a part of the layer's mean value and of its own.
fn agreement(a: &Pixels, b: &Pixels) -> f64 {
    let usual = a.means.iter().flatten().map(|value| value.abs().min(1e3)).sum::<f32>() / (3 * a.means.len()) as f32;
    let agrees = |(place, (a_mean, b_mean)): (usize, (&[f32; 3], &[f32; 3]))| {
        let near = a_mean.iter().zip(b_mean).all(|(x, y)| (x - y).abs() <= 1e-3 * (usual + x.abs()));
        near && a.counts[place] == b.counts[place]
    };
    let pairs = a.means.iter().zip(&b.means).enumerate();
    pairs.map(agrees).filter(|agrees| *agrees).count() as f64 / a.means.len() as f64
}

/// Rounding decides at silhouettes and in refractions, in a few pixels.
#[test]
#[ignore = "slow"]
fn both_devices_make_the_same_layers() {
    // Every layer of every scene takes a kernel of its own, and several in the wavefront.
    let everywhere =
        in_full("layers of seven scenes and all by the wavefront; they are of one, and half of them of another by the wavefront");
    let scenes = ["spheres", "cornell", "teapot-plastic", "crystal", "lanterns", "gallery", "motion-blur"];
    for name in scenes.into_iter().filter(|name| everywhere || ["spheres", "cornell"].contains(name)) {
        let scene = built_in(name);
        let ways = if everywhere {
            &BOTH[..]
        } else if name == "cornell" {
            &BOTH[1..]
        } else {
            &BOTH[..1]
        };
        let mut earlier: Option<(KernelLayer, Pixels)> = None;
        for (index, layer) in KernelLayer::ALL.into_iter().enumerate() {
            if !everywhere && name == "cornell" && index % 2 == 1 {
                continue;
            }
            let reference = on_cpu(&scene, layer);
            let Some(found) = on_gpu(&scene, layer, ways) else { return };
            for way in &found {
                let share = agreement(&reference, way);
                assert!(share > 0.95, "{name}, {layer:?}: {share}");
                // Negative control: another layer is none of these.
                // Shapes without a transform stand in their own space.
                let may_be_equal = |other: KernelLayer| [other, layer] == [KernelLayer::Position, KernelLayer::ObjectPosition];
                if let Some((_, other)) = earlier.as_ref().filter(|(other, _)| !may_be_equal(*other)) {
                    let share = agreement(other, way);
                    assert!(
                        share < 0.95 || way.means.iter().all(|mean| *mean == [0.0; 3]),
                        "{name}, {layer:?} and the one before: {share}"
                    );
                }
            }
            for way in &found[1..] {
                assert!(agreement(&found[0], way) > 0.995, "{name}, {layer:?}: fused and wavefront");
            }
            earlier = Some((layer, reference));
        }
    }
}

pub(crate) fn scene(tables: &str) -> Scene {
    let text = format!(
        "[film]\nsize = [16, 12]\n[render]\nspp = {SPP}\npixel_sampler = \"none\"\n\
         [camera]\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n\
         [[material]]\nname = \"red\"\ntype = \"diffuse\"\nreflectance = [0.6, 0.2, 0.1]\n\
         [[material]]\nname = \"mirror\"\ntype = \"mirror\"\nreflectance = [0.9, 0.8, 0.7]\n{tables}\n\
         [[light]]\ntype = \"point\"\nposition = [1, 4, 3]\nintensity = 9\n"
    );
    load::load_toml_str(&text, "layers", Path::new("")).expect("the scene is valid")
}

/// All that make the layer: the device, if there is one, in the long form by both ways, and the reference.
pub(crate) fn everywhere(scene: &Scene, layer: KernelLayer) -> Vec<Pixels> {
    static EVERYWHERE: LazyLock<bool> = LazyLock::new(|| in_full("closed forms of layers by the wavefront"));
    let ways = if *EVERYWHERE { &BOTH[..] } else { &BOTH[..1] };
    on_gpu(scene, layer, ways).into_iter().flatten().chain([on_cpu(scene, layer)]).collect()
}

/// The ray through the middle of a pixel.
pub(crate) fn ray(scene: &Scene, pixel: usize) -> (DVec3, DVec3) {
    let [right, up, backward] = scene.camera.frame();
    let [width, height] = scene.film.size.map(f64::from);
    let half = 20.0_f64.to_radians().tan();
    let (x, y) = ((pixel % 16) as f64 + 0.5, (pixel / 16) as f64 + 0.5);
    let across = right * ((2.0 * x / width - 1.0) * half * width / height) + up * ((1.0 - 2.0 * y / height) * half);
    (scene.camera.position, (across - backward).normalize())
}

/// A plane across the viewing direction is everywhere at one depth, and its points lie on it.
#[test]
fn a_planes_depth_and_points_are_known() {
    let scene = scene("[[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 5]\nmaterial = \"red\"");
    for found in everywhere(&scene, KernelLayer::Depth) {
        let depth = 26.0_f64.sqrt();
        assert!(found.means.iter().all(|mean| (f64::from(mean[0]) - depth).abs() < 1e-4), "{:?}", found.means[0]);
        assert!(found.counts.iter().all(|count| *count == SPP));
    }
    for found in everywhere(&scene, KernelLayer::Position) {
        for (pixel, mean) in found.means.iter().enumerate() {
            let (origin, direction) = ray(&scene, pixel);
            let normal = DVec3::new(0.0, 1.0, 5.0);
            let expected = origin - direction * (origin.dot(normal) / direction.dot(normal));
            let error = (DVec3::from_array(mean.map(f64::from)) - expected).length();
            assert!(error < 1e-4, "{pixel}: {mean:?} instead of {expected}");
        }
    }
}

/// The place where the ray through a pixel's middle meets the sphere, if it does.
fn on_sphere(scene: &Scene, pixel: usize) -> Option<DVec3> {
    let (origin, direction) = ray(scene, pixel);
    let (along, beside) = (origin.dot(direction), origin.length_squared() - 1.0);
    let root = along * along - beside;
    (root > 0.0).then(|| origin + direction * (-along - root.sqrt()))
}

#[test]
fn a_spheres_normals_and_albedo_are_known_and_nothing_is_nothing() {
    let scene = scene("[[shape]]\ntype = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"red\"");
    for layer in [KernelLayer::Normal, KernelLayer::Albedo] {
        for found in everywhere(&scene, layer) {
            let mut met = 0;
            for (pixel, mean) in found.means.iter().enumerate() {
                let normal = on_sphere(&scene, pixel);
                met += usize::from(normal.is_some());
                let albedo = DVec3::new(0.6, 0.2, 0.1);
                let expected = normal.map_or(DVec3::ZERO, |normal| if layer == KernelLayer::Normal { normal } else { albedo });
                let error = (DVec3::from_array(mean.map(f64::from)) - expected).length();
                assert!(error < 1e-4, "{layer:?}, {pixel}: {mean:?} instead of {expected}");
                assert_eq!(found.counts[pixel], if normal.is_some() { SPP } else { 0 });
            }
            assert!((20..150).contains(&met), "{met} pixels show the sphere");
        }
    }
}

/// In a mirror one sees the albedo and the normal of what it shows, and the mirror's own depth.
#[test]
fn mirrors_are_followed() {
    let scene = scene(
        "[[shape]]\ntype = \"plane\"\npoint = [0, 0, -2]\nnormal = [0, 0, 1]\nmaterial = \"mirror\"\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, 0, 9]\nnormal = [0, 0, -1]\nmaterial = \"red\"",
    );
    let expected = [(KernelLayer::Albedo, DVec3::new(0.54, 0.16, 0.07)), (KernelLayer::Normal, DVec3::new(0.0, 0.0, -1.0))];
    for (layer, expected) in expected {
        for found in everywhere(&scene, layer) {
            let near = |mean: &[f32; 3]| (DVec3::from_array(mean.map(f64::from)) - expected).length() < 1e-5;
            assert!(found.means.iter().all(near), "{layer:?}: {:?}", found.means[0]);
        }
    }
    for found in everywhere(&scene, KernelLayer::Position) {
        assert!(found.means.iter().all(|mean| (mean[2] + 2.0).abs() < 1e-4), "{:?}", found.means[0]);
    }
}

/// The light that reaches the camera over one edge, two, and more, is all of it.
#[test]
fn layers_of_light_add_up_to_the_picture() {
    let scene = built_in("spheres");
    let picture = pixels(&mut ReferenceRenderer::new(&scene).expect("it can be rendered"), 24);
    let layers = [KernelLayer::Emission, KernelLayer::Direct, KernelLayer::Indirect].map(|layer| on_cpu(&scene, layer));
    for (pixel, mean) in picture.means.iter().enumerate() {
        for (channel, mean) in mean.iter().enumerate() {
            let sum: f32 = layers.iter().map(|layer| layer.means[pixel][channel]).sum();
            assert!((sum - mean).abs() <= 1e-5 * (1.0 + mean), "{pixel}: {sum} instead of {mean}");
        }
    }
    for layer in &layers {
        assert!(layer.means.iter().flatten().any(|value| *value > 0.01), "each has some of it");
    }
}
