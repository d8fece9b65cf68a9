use std::sync::atomic::{AtomicU32, Ordering};

use glam::DVec3;

use super::*;
use crate::film::Band;
use crate::renderer::Silent;
use crate::scene::{
    BlendWeight, Camera, ColorInput, Emission, FilmSettings, Geometry, Light, Material, MaterialKind, Plane, PointLight,
    Projection, Shape, Sphere, Transform,
};
use crate::spectrum::Spectrum;

/// A diffuse, a mirror and a glass sphere on a floor, under a sphere light and a point light.
fn scene(size: [u32; 2]) -> Scene {
    let mut scene = Scene { film: FilmSettings { size, ..FilmSettings::default() }, ..Scene::default() };
    scene.camera = Camera {
        position: DVec3::new(0.0, 2.0, 8.0),
        look_at: DVec3::new(0.0, 0.8, 0.0),
        projection: Projection::Perspective { vertical_fov_degrees: 40.0 },
        ..Camera::default()
    };
    scene.render.spp = 4;
    let grey = ColorInput::grey;
    let kinds = [
        MaterialKind::Diffuse { reflectance: ColorInput::Constant(Spectrum::new(0.8, 0.5, 0.3)) },
        MaterialKind::Mirror { reflectance: grey(0.9) },
        MaterialKind::Glass {
            ior: 1.5,
            reflectance: grey(1.0),
            transmittance: grey(1.0),
            thin: false,
            film: None,
            dispersion: None,
        },
        MaterialKind::Emissive,
    ];
    for (index, kind) in kinds.into_iter().enumerate() {
        let emission = (index == 3).then(|| Emission { radiance: grey(20.0), two_sided: false });
        scene.materials.push(Material {
            name: index.to_string(),
            kind,
            normal_map: None,
            emission,
            two_sided: true,
            interior: None,
        });
    }
    let floor = Geometry::Plane(Plane { point: DVec3::ZERO, normal: DVec3::Y });
    let ball = |x: f64, y: f64, radius: f64| Geometry::Sphere(Sphere { center: DVec3::new(x, y, 0.0), radius });
    let shapes =
        [(floor, 0), (ball(-2.2, 1.0, 1.0), 0), (ball(0.0, 1.0, 1.0), 1), (ball(2.2, 1.0, 1.0), 2), (ball(1.0, 4.0, 0.5), 3)];
    for (geometry, material) in shapes {
        let transform = Transform::default();
        scene.shapes.push(Shape {
            label: "shape".into(),
            geometry,
            material,
            transform,
            motion: None,
            portal: false,
            receiver: 0,
        });
    }
    scene.lights.push(Light::Point(PointLight {
        position: DVec3::new(-3.0, 4.0, 2.0),
        intensity: Spectrum::grey(10.0),
        profile: None,
    }));
    scene
}

fn render(scene: &Scene, request: RenderRequest, observer: &dyn Observer) -> (RenderReport, Vec<Band>) {
    let mut bands = Vec::new();
    let mut renderer = ReferenceRenderer::new(scene).expect("the scene is supported");
    let report = renderer.render(&request, observer, &mut |band| {
        bands.push(band);
        Ok(())
    });
    (report.expect("rendering succeeds"), bands)
}

#[test]
fn halves_of_the_samples_make_the_whole() {
    let scene = scene([24, 16]);
    let [first, second, whole] = [0..8, 8..16, 0..16].map(|samples| {
        let (report, bands) = render(&scene, RenderRequest { rows: 0..16, samples: samples.clone() }, &Silent);
        assert_eq!(report.samples, 24 * 16 * u64::from(samples.end - samples.start));
        assert_eq!(report.non_finite_samples, 0);
        assert!(report.rays > 2 * report.samples);
        bands.into_iter().next().expect("there is a band")
    });
    for i in 0..whole.mean.len() {
        for channel in 0..3 {
            let mean = 0.5 * (first.mean[i][channel] + second.mean[i][channel]);
            assert!((mean - whole.mean[i][channel]).abs() <= 1e-6 * mean, "pixel {i}");
        }
        let second_moment = 0.5 * (first.second_moment[i] + second.second_moment[i]);
        assert!((second_moment - whole.second_moment[i]).abs() <= 1e-6 * second_moment);
    }
    assert_ne!(first.mean, second.mean);
}

#[test]
fn bands_hold_the_means_of_their_samples() {
    let scene = scene([9, 150]);
    let (_, bands) = render(&scene, RenderRequest { rows: 3..141, samples: 5..7 }, &Silent);
    let renderer = ReferenceRenderer::new(&scene).expect("the scene is supported");
    assert_eq!(bands.iter().map(|band| (band.first_row, band.rows)).collect::<Vec<_>>(), [(3, 64), (67, 64), (131, 10)]);
    for band in &bands {
        for (i, mean) in (0..).zip(&band.mean) {
            let (x, y) = (i % 9, band.first_row + i / 9);
            let [a, b] = [5, 6].map(|sample| Spectrum::from_rgb(renderer.radiance_of_sample(x, y, sample)));
            assert_eq!(*mean, ((a + b) * 0.5).to_f32(), "pixel {x}, {y}");
        }
    }
}

#[test]
fn a_trace_tells_where_the_radiance_came_from() {
    let scene = scene([20, 14]);
    let renderer = ReferenceRenderer::new(&scene).expect("the scene is supported");
    let mut connected = 0;
    for (x, y) in (0..20).flat_map(|x| (0..14).map(move |y| (x, y))) {
        let trace = renderer.trace(x, y, 3);
        assert_eq!(trace.radiance.to_rgb(), renderer.radiance_of_sample(x, y, 3));
        let mut sum = trace.escaped.map_or(Spectrum::BLACK, |found| found.contribution);
        for vertex in &trace.vertices {
            sum += vertex.emission.map_or(Spectrum::BLACK, |found| found.contribution);
            sum += vertex.light.map_or(Spectrum::BLACK, |light| light.contribution);
            connected += usize::from(vertex.light.is_some());
        }
        assert!(sum.distance(trace.radiance) <= 1e-12 * sum.to_vector().length(), "{trace:?}");
        assert!(trace.vertices.iter().zip(1..).all(|(vertex, depth)| vertex.depth == depth));
    }
    assert!(connected > 100, "{connected}");
}

/// Asks to stop when it was told of progress this often.
struct StopAfter(AtomicU32);

impl Observer for StopAfter {
    fn progress(&self, _done: u64, _total: u64) {
        let _ = self.0.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |left| Some(left.saturating_sub(1)));
    }
    fn stop_requested(&self) -> bool {
        self.0.load(Ordering::Relaxed) == 0
    }
}

#[test]
fn a_stopped_render_delivers_what_is_done() {
    let scene = scene([8, 200]);
    let request = || RenderRequest { rows: 0..200, samples: 0..10_000 };
    let (report, bands) = render(&scene, request(), &StopAfter(AtomicU32::new(2)));
    assert!(report.interrupted);
    assert_eq!(
        bands.iter().map(|band| (band.first_row, band.samples)).collect::<Vec<_>>(),
        [(0, 1), (64, 1), (128, 1), (192, 1)]
    );
    assert!(bands.iter().all(|band| band.counts.is_none()), "the first iteration is finished");
    let (report, bands) = render(&scene, request(), &StopAfter(AtomicU32::new(6)));
    let samples: Vec<u32> = bands.iter().map(|band| band.samples).collect();
    assert!(report.interrupted && samples.len() == 4 && samples[0] > samples[2] && samples[2] == 1, "{samples:?}");
    assert_eq!(report.samples, bands.iter().map(|band| u64::from(band.samples * band.rows) * 8).sum::<u64>());
}

#[test]
fn large_pictures_come_band_by_band() {
    let mut scene = scene([4096, 1100]);
    scene.render.max_depth = 1;
    let (report, bands) = render(&scene, RenderRequest { rows: 0..1100, samples: 0..1 }, &Silent);
    let mut next = 0;
    for band in &bands {
        assert_eq!((band.first_row, band.width, band.samples), (next, 4096, 1));
        assert_eq!(band.mean.len(), 4096 * band.rows as usize);
        next += band.rows;
    }
    assert_eq!(next, 1100);
    assert_eq!((report.rays, report.samples), (4096 * 1100, 4096 * 1100));
}

#[test]
fn what_is_not_finite_is_counted_and_left_out() {
    let mut scene = scene([8, 8]);
    scene.render.max_depth = 1;
    let light = scene.materials[3].clone();
    scene.shapes.truncate(1);
    scene.shapes[0].geometry = Geometry::Sphere(Sphere { center: scene.camera.position, radius: 1.0 });
    let mut emit = |radiance: f64| {
        scene.materials[0] =
            Material { emission: Some(Emission { radiance: ColorInput::grey(radiance), two_sided: true }), ..light.clone() };
        scene.clone()
    };
    // A scene may hold what single precision does not.
    let (report, bands) = render(&emit(1e39), RenderRequest { rows: 0..8, samples: 0..3 }, &Silent);
    assert_eq!(report.non_finite_samples, 8 * 8 * 3);
    assert!(bands[0].mean.iter().all(|mean| *mean == [0.0; 3]));
    let (report, _) = render(&emit(1.0), RenderRequest { rows: 0..8, samples: 0..3 }, &Silent);
    assert_eq!(report.non_finite_samples, 0);
    // No scene may hold these, and no film takes them.
    for radiance in [f64::INFINITY, f64::NAN, -1.0] {
        assert!(ReferenceRenderer::new(&emit(radiance)).is_err(), "{radiance}");
        assert!(!is_acceptable(Spectrum::grey(radiance)) && is_acceptable(Spectrum::WHITE), "{radiance}");
    }
}

fn blend(first: usize, second: usize) -> MaterialKind {
    MaterialKind::Blend { materials: [first, second], weight: BlendWeight::Constant { value: 0.5 } }
}

fn blends_of_twice_the_blend_before(scene: &mut Scene, count: usize) {
    for _ in 0..count {
        let last = scene.materials.len() - 1;
        let material = Material { kind: blend(last, last), ..scene.materials[0].clone() };
        scene.materials.push(material);
    }
}

#[test]
fn a_blend_of_very_many_parts_renders() {
    let mut scene = scene([4, 4]);
    blends_of_twice_the_blend_before(&mut scene, 12);
    scene.shapes[0].material = scene.materials.len() - 1;
    let (report, _) = render(&scene, RenderRequest { rows: 0..4, samples: 0..1 }, &Silent);
    assert_eq!(report.non_finite_samples, 0);
}

#[test]
fn what_cannot_be_rendered_is_refused_by_name() {
    let refusal = |change: fn(&mut Scene)| {
        let mut scene = scene([4, 4]);
        change(&mut scene);
        ReferenceRenderer::new(&scene).expect_err("this is not supported").to_string()
    };
    assert!(refusal(|scene| scene.shapes[1].material = 99).contains("no material 99"));
    assert!(refusal(|scene| scene.materials[0].kind = blend(2, 0)).contains("contains itself"));
    assert!(refusal(|scene| (scene.materials[0].kind, scene.materials[1].kind) = (blend(1, 2), blend(2, 0))).contains("itself"));
    assert!(refusal(|scene| scene.materials[0].kind = blend(1, 99)).contains("no material 99"));
    assert!(refusal(|scene| blends_of_twice_the_blend_before(scene, 17)).contains("more than 65536"));
    assert!(refusal(|scene| (scene.render.max_depth, scene.render.roulette_depth) = (0, 0.into())).contains("never end"));
    assert!(
        refusal(|scene| scene.materials[0].kind = MaterialKind::Mirror { reflectance: ColorInput::Texture(0) })
            .contains("no texture")
    );
}
