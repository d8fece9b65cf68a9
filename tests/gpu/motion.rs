//! Motion blur: coverage over time in closed form, a shutter that stands still, what moving shapes sweep, and what is refused.

use std::path::Path;

use crate::common::device::DEVICE;
use crate::common::effort::in_full;
use crate::common::picture::render;
use crate::statistics::random::SplitMix64;
use glam::{DVec3, Vec3};
use gpt::compare::{Moments, one_sample_t_test_beyond, sidak};
use gpt::cpu::ReferenceRenderer;
use gpt::gpu::GpuRenderer;
use gpt::load;
use gpt::load::SceneError;
use gpt::packed::motion::PackedMotion;
use gpt::packed::primitive::WorldPrimitive;
use gpt::packed::shape::{Disk, PrimitiveGeometry, Quad, Sphere, Triangle};
use gpt::plan::{PlanOptions, StageMode};
use gpt::scene::{LightSampling, Motion, MotionStep, Scene, Shape, Transform, TransformStep};

const BOTH: [(&str, StageMode); 2] = [("gpu, fused", StageMode::Fused), ("gpu, wavefront", StageMode::Wavefront)];

/// The picture by the reference and by these ways to run.
fn pictures(scene: &Scene, ways: &[(&'static str, StageMode)]) -> Vec<(&'static str, Vec<[f32; 3]>)> {
    let reference = render(&mut ReferenceRenderer::new(scene).expect("the scene is supported"), scene);
    let mut pictures = vec![("cpu", reference)];
    if let Some(device) = DEVICE.as_ref() {
        for &(name, stages) in ways {
            let options = PlanOptions { stages: Some(stages), ..PlanOptions::default() };
            pictures.push((name, render(&mut GpuRenderer::on(device, scene, &options).expect("the scene fits"), scene)));
        }
    }
    pictures
}

fn load(text: &str) -> Result<Scene, SceneError> {
    load::load_toml_str(text, "test.toml", Path::new(""))
}

/// Pixels along a side of the pictures of the closed forms, which show x and y from −1 to 1.
const SIDE: u32 = 16;

/// Parallel rays along −z towards one shape that emits radiance 1 and nothing else.
fn glow(shutter: [f64; 2], shape: &str) -> Scene {
    glow_before(&format!("shutter = {shutter:?}"), shape)
}

/// The scene with further lines of the camera.
fn glow_before(camera: &str, shape: &str) -> Scene {
    let text = format!(
        "[film]\nsize = [{SIDE}, {SIDE}]\n[render]\nspp = 1024\nmax_depth = 1\nsampler = \"halton\"\n[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\n\
         projection = \"orthographic\"\nheight = 2\n{camera}\n[[material]]\nname = \"glow\"\ntype = \"emissive\"\n\
         radiance = 1\n[[shape]]\nmaterial = \"glow\"\n{shape}\n"
    );
    load(&text).unwrap_or_else(|error| panic!("{error}"))
}

/// A case and the share of the time for which the shape covers a point (x, y).
type Coverage = (&'static str, Scene, fn(f64, f64) -> f64);

/// Cameras before a shape at rest: one that goes by, and one whose window grows.
fn cameras() -> [Coverage; 2] {
    let at_frame = |camera: &str, shape: &str| glow_before(camera, shape).at_frame(0.0).expect("it can be rendered");
    // At a speed of 6 from x = −3 to 3, as the sphere below.
    let passing = "shutter = [0.25, 1.25]\nkeyframes = [{ frame = 0.25, position = [-3, 0, 9], look_at = [-3, 0, 0] }, \
                   { frame = 1.25, position = [3, 0, 9], look_at = [3, 0, 0] }]";
    let sphere = "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.6";
    // From a height of 1 to 4, so that the disk's radius in windows falls from 1.2 to 0.3.
    let growing = "shutter = [0, 1]\nkeyframes = [{ frame = 0, height = 1 }, { frame = 1, height = 4 }]";
    let disk = "type = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 0.6";
    [
        ("camera that goes by", at_frame(passing, sphere), |_, y| 2.0 * (0.36 - y * y).max(0.0).sqrt() / 6.0),
        ("window that grows", at_frame(growing, disk), |x, y| ((1.2 / x.hypot(y) - 1.0) / 3.0).clamp(0.0, 1.0)),
    ]
}

fn coverages() -> [Coverage; 5] {
    // From x = −3 to 3 while the shutter is open: it passes all of the picture at a speed of 6.
    let flying = "type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 0.6\nmotion = [{ translate = [3, 0, 0] }]";
    // Half a bar of half width 0.3 about the z axis, a quarter of a turn: at a distance ρ it covers an angle of asin 0.3/ρ on either side.
    let turning = "type = \"rectangle\"\ncorner = [0, -0.3, 0]\nedge_u = [2, 0, 0]\nedge_v = [0, 0.6, 0]\n\
                   motion = [{ rotate = [0, 0, 1], degrees = 360 }]";
    // Its radius grows evenly from 0.3 to 0.9.
    let growing = "type = \"disk\"\ncenter = [0, 0, 0]\nnormal = [0, 0, 1]\nradius = 0.3\nmotion = [{ scale = 3 }]";
    // A mesh of a square that widens from half width 0.3 to 0.9 along x alone.
    let widening = "type = \"mesh\"\npositions = [[-0.3, -2, 0], [0.3, -2, 0], [0.3, 2, 0], [-0.3, 2, 0]]\n\
                    faces = [[0, 1, 2], [0, 2, 3]]\nmotion = [{ scale = [3, 1, 1] }]";
    // A bar of half width 0.6 that goes from x = −3 to 3 before rows that are each exposed for a quarter of the time, from the top: it leans.
    let passing = "type = \"rectangle\"\ncorner = [-3.6, -2, 0]\nedge_u = [1.2, 0, 0]\nedge_v = [0, 4, 0]\nmotion = [{ translate = [6, 0, 0] }]";
    [
        ("bar before a rolling shutter", glow_before("rolling_shutter = 0.25", passing), |x, y| {
            let row = ((1.0 - y) / 2.0 * f64::from(SIDE)).floor();
            let start = 0.75 * row / f64::from(SIDE - 1);
            let covered = [x + 2.4, x + 3.6].map(|time| (time / 6.0).clamp(start, start + 0.25));
            (covered[1] - covered[0]) / 0.25
        }),
        ("flying sphere", glow([-1.0, 1.0], flying), |_, y| 2.0 * (0.36 - y * y).max(0.0).sqrt() / 6.0),
        ("turning bar", glow([0.0, 1.0], turning), |x, y| {
            let distance = x.hypot(y);
            if distance <= 0.3 { f64::NAN } else { 2.0 * (0.3 / distance).asin() / std::f64::consts::TAU }
        }),
        ("growing disk", glow([0.0, 1.0], growing), |x, y| ((0.9 - x.hypot(y)) / 0.6).clamp(0.0, 1.0)),
        ("widening mesh", glow([0.0, 1.0], widening), |x, _| ((0.9 - x.abs()) / 0.6).clamp(0.0, 1.0)),
    ]
}

/// Mean over a pixel, by the midpoint rule.
fn expected(coverage: fn(f64, f64) -> f64, column: u32, row: u32) -> f64 {
    let points = 64;
    let at =
        |index: u32, point: u32| (f64::from(index) + (f64::from(point) + 0.5) / f64::from(points)) * 2.0 / f64::from(SIDE) - 1.0;
    let sum: f64 = (0..points * points).map(|i| coverage(at(column, i % points), -at(row, i / points))).sum();
    sum / f64::from(points * points)
}

/// Every pixel's share of its closed form has the mean 1, by Student's t-test over pixels, which shift the sampler's sequence by hashes
/// of their own; with 1 % of energy added the same test fails.
#[test]
#[ignore = "slow"]
fn coverage_over_time_follows_its_closed_form() {
    let cases: Vec<Coverage> = coverages().into_iter().chain(cameras()).collect();
    let level = sidak(0.01, 3 * cases.len());
    let everywhere = in_full("coverage over time by either way to run");
    for (index, (name, scene, coverage)) in cases.into_iter().enumerate() {
        let ways = if everywhere { &BOTH[..] } else { &BOTH[index % 2..=index % 2] };
        for (device, pixels) in pictures(&scene, ways) {
            let mut shares = Moments::default();
            for (index, pixel) in (0..).zip(&pixels) {
                let expected = expected(coverage, index % SIDE, index / SIDE);
                if expected > 0.05 {
                    shares.push(f64::from(pixel[1]) / expected);
                }
            }
            println!("{device}, {name}: {} ± {} over {} pixels", shares.mean(), shares.standard_error(), shares.count());
            assert!(shares.count() > 50, "{device}, {name}");
            let rejects = |truth: f64| one_sample_t_test_beyond(&shares, truth, 1e-4).p_value < level;
            assert!(!rejects(1.0), "{device}, {name}: {} ± {}", shares.mean(), shares.standard_error());
            assert!(rejects(1.0 / 1.01), "{device}, {name} would pass with 1 % of energy added");
        }
    }
}

/// A floor, a lamp and three shapes that scale, turn and fly.
fn stage() -> Scene {
    let text = r#"
[film]
size = [40, 30]
[render]
spp = 16
max_depth = 3
[camera]
position = [0, 1.6, 6]
look_at = [0, 0.8, 0]
vfov = 40
[[texture]]
name = "checks"
type = "checker"
a = 0.9
b = 0.1
scale = [6, 4]
[[material]]
name = "checked"
type = "diffuse"
reflectance = { texture = "checks" }
[[material]]
name = "glow"
type = "emissive"
radiance = [9, 7, 5]
[[shape]]
type = "rectangle"
corner = [-6, 0, -6]
edge_u = [0, 0, 12]
edge_v = [12, 0, 0]
material = "checked"
[[shape]]
type = "rectangle"
corner = [-1, 0, -1]
edge_u = [2, 0, 0]
edge_v = [0, 0, 2]
material = "glow"
transform = [{ translate = [0, 4, 0] }]
motion = [{ rotate = [0, 0, 1], degrees = 30 }, { scale = [1.5, 1, 0.8] }]
[[shape]]
type = "sphere"
center = [0, 0, 0]
radius = 0.6
material = "checked"
transform = [{ translate = [-1.2, 0.7, 0] }]
motion = [{ scale = 1.3 }, { rotate = [0.2, 1, 0.1], degrees = 200 }, { translate = [0.4, 0.1, 0] }]
[[shape]]
type = "mesh"
positions = [[1, 0, -0.7], [-1, 0, -0.7], [0, 1, 0.7], [0, -1, 0.7]]
faces = [[0, 1, 2], [1, 0, 3], [2, 3, 0], [3, 2, 1]]
uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
normals = [[1, 0.1, -0.7], [-1, 0.1, -0.7], [0, 1, 0.7], [0, -1, 0.7]]
smooth = true
material = "checked"
transform = [{ translate = [1, 1.1, 0] }]
motion = [{ rotate = [0.3, 1, 0], degrees = 90 }, { scale = [1.2, 0.8, 1] }]
"#;
    load(text).unwrap_or_else(|error| panic!("{error}"))
}

/// The scene as it is at a time, without any motion.
fn frozen(scene: &Scene, time: f64) -> Scene {
    let mut still = scene.clone();
    for shape in &mut still.shapes {
        if let Some(map) = shape.moved_by(time) {
            shape.transform.steps.push(TransformStep::Matrix(map));
            shape.motion = None;
        }
    }
    still
}

/// A shutter that opens and closes at one instant sees the scene of that instant.
#[test]
#[ignore = "slow"]
fn an_instant_is_the_still_scene() {
    let mut scene = stage();
    // Lamps that rest are drawn by the angle that they fill, and those that move by their area.
    scene.render.light_sampling = LightSampling::Area;
    scene.camera.shutter = [0.4, 0.4];
    let equal_share = |a: &[[f32; 3]], b: &[[f32; 3]]| {
        let near = |(p, q): (&[f32; 3], &[f32; 3])| p.iter().zip(q).all(|(x, y)| (x - y).abs() <= 1e-3 * (1.0 + x.abs()));
        a.iter().zip(b).filter(|pair| near(*pair)).count() as f64 / a.len() as f64
    };
    let ways = if in_full("an instant by the wavefront") { &BOTH[..] } else { &BOTH[..1] };
    let moving = pictures(&scene, ways);
    let [still, later] = [0.4, 0.42].map(|time| pictures(&frozen(&scene, time), ways));
    for (index, (device, picture)) in moving.iter().enumerate() {
        // A path in ten thousand or so takes another turn by rounding, at edges of checks and of shapes.
        let share = equal_share(picture, &still[index].1);
        assert!(share > 0.98, "{device}: {share}");
        let share = equal_share(picture, &later[index].1);
        assert!(share < 0.9, "{device}, a little later: {share}");
    }
}

fn random_vector(random: &mut SplitMix64, size: f64) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|_| (2.0 * random.uniform() - 1.0) * size))
}

/// One to three steps at random.
fn random_motion(random: &mut SplitMix64) -> Motion {
    let count = 1 + (random.uniform() * 3.0) as usize;
    let step = |random: &mut SplitMix64| match (random.uniform() * 3.0) as u32 {
        0 => MotionStep::Scale(DVec3::splat(0.3 + 2.0 * random.uniform())),
        1 => MotionStep::Rotate { axis: random_vector(random, 1.0), degrees: 720.0 * (random.uniform() - 0.5) },
        _ => MotionStep::Translate(random_vector(random, 3.0)),
    };
    Motion::new((0..count).map(|_| step(random)).collect())
}

/// A primitive of a random kind, and a function that gives points of it by two numbers in [0, 1].
fn random_primitive(random: &mut SplitMix64) -> (PrimitiveGeometry, Box<dyn Fn(f64, f64) -> DVec3>) {
    let corner = random_vector(random, 2.0);
    let [edge_u, edge_v] = std::array::from_fn(|_| random_vector(random, 1.0));
    let radius = 0.1 + random.uniform();
    let normal = edge_u.normalize();
    let tangent = normal.any_orthonormal_vector();
    let circle = move |v: f64| {
        let (sine, cosine) = (v * std::f64::consts::TAU).sin_cos();
        tangent * cosine + normal.cross(tangent) * sine
    };
    match (random.uniform() * 4.0) as u32 {
        0 => {
            let corners: [Vec3; 3] = [corner, corner + edge_u, corner + edge_v].map(|p| p.as_vec3());
            let [a, b, c] = corners.map(|p| p.as_dvec3());
            let point = move |u: f64, v: f64| a + (b - a) * (1.0 - u.sqrt()) + (c - a) * v * u.sqrt();
            (Triangle(corners).into(), Box::new(point))
        }
        1 => {
            let point = move |u, v| corner + edge_u * u + edge_v * v;
            (Quad { corner, edge_u, edge_v }.into(), Box::new(point))
        }
        2 => {
            let point = move |u: f64, v| {
                let z = 2.0 * u - 1.0;
                corner + radius * (normal * z + circle(v) * (1.0 - z * z).sqrt())
            };
            (Sphere { center: corner, radius }.into(), Box::new(point))
        }
        _ => {
            let point = move |u: f64, v| corner + radius * u.sqrt() * circle(v);
            (Disk { center: corner, normal, radius }.into(), Box::new(point))
        }
    }
}

/// Random motions of random primitives at random times stay in the boxes that the hierarchy is built of. Boxes of the first and the last
/// time alone would not do.
#[test]
fn boxes_hold_all_that_moving_shapes_sweep() {
    let mut random = SplitMix64::new(7);
    let mut outside_of_both_ends = 0;
    for _ in 0..400 {
        let mut shape: Shape = stage().shapes.swap_remove(0);
        shape.transform = Transform { steps: vec![TransformStep::Translate(random_vector(&mut random, 3.0))] };
        shape.motion = Some(random_motion(&mut random));
        let open = random.uniform() - 0.5;
        let shutter = [open, open + random.uniform()];
        if shape.check_motion(shutter).is_err() {
            continue;
        }
        let (geometry, point) = random_primitive(&mut random);
        let swept = |shutter| {
            let motion = PackedMotion::new(&shape, shutter).expect("the shape moves");
            motion.swept(&WorldPrimitive::new(geometry, 0)).expect("the primitive is finite")
        };
        let (low, high) = swept(shutter);
        let ends = shutter.map(|time| swept([time, time]));
        let (ends_low, ends_high) = (ends[0].0.min(ends[1].0), ends[0].1.max(ends[1].1));
        for _ in 0..200 {
            let time = shutter[0] + (shutter[1] - shutter[0]) * random.uniform();
            let at_rest = point(random.uniform(), random.uniform());
            let p = shape.moved_by(time).expect("the shape moves").transform_point3(at_rest);
            let inside = |low: Vec3, high: Vec3| p.cmpge(low.as_dvec3()).all() && p.cmple(high.as_dvec3()).all();
            assert!(inside(low, high), "{:?} {geometry:?} at {time} of {shutter:?}: {p} not in {low} to {high}", shape.motion);
            outside_of_both_ends += usize::from(!inside(ends_low, ends_high));
        }
    }
    assert!(outside_of_both_ends > 1000, "{outside_of_both_ends}");
}

/// A sphere with these lines added, seen with this shutter.
fn complaint(shutter: &str, shape: &str) -> Option<String> {
    let text = format!(
        "[camera]\nposition = [0, 0, 9]\nlook_at = [0, 0, 0]\nvfov = 40\nshutter = {shutter}\n[[light]]\ntype = \"environment\"\n\
         radiance = 1\n[[material]]\nname = \"m\"\ntype = \"diffuse\"\nreflectance = 0.5\n[[material]]\nname = \"gone\"\ntype = \"pass\"\n\
         [[shape]]\n{shape}\n"
    );
    load(&text).err().map(|error| error.to_string())
}

#[test]
fn motions_that_cannot_be_followed_are_refused_by_name() {
    let sphere = |motion: &str| format!("type = \"sphere\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"m\"\nmotion = {motion}");
    let plane = "type = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"m\"\nmotion = [{ translate = [1, 0, 0] }]";
    let portal = sphere("[{ translate = [1, 0, 0] }]").replace("\"m\"", "\"gone\"") + "\nportal = true";
    let identity = "[{ matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1] }]";
    let rows = [
        ("[0, 1]", sphere(identity), "a motion has no matrices"),
        ("[0, 1]", sphere("[{ translate = [1, 0, 0] }, { scale = -1 }]"), "the scale shrinks the shape to nothing"),
        ("[0.6, 0.8]", sphere("[{ scale = -1 }]"), "the scale shrinks the shape to nothing"),
        ("[0, 3]", sphere("[{ scale = 0.5 }]"), "the scale shrinks the shape to nothing"),
        ("[0, 1]", sphere("[{ scale = 0 }]"), "a scale of 0 flattens the shape"),
        ("[0, 1]", sphere("[{ scale = [1, 2, 1] }]"), "can only be scaled by the same factor along every axis"),
        ("[0, 2]", sphere("[{ rotate = [0, 1, 0], degrees = 20000 }]"), "turns more than 100 times while the shutter is open"),
        ("[0, 1]", sphere("[{ translate = [1e300, 0, 0] }]"), "expected a number of magnitude at most 1e18"),
        ("[0, 9]", sphere("[{ scale = 1e18 }]"), "the motion leaves the range of numbers"),
        ("[0, 1]", sphere("[{ rotate = [0, 1, 0] }]"), "`rotate` needs the key `degrees`"),
        ("[0, 1]", sphere("[{ translate = [1, 0, 0], scale = 2 }]"), "this has 2"),
        ("[0, 1]", sphere("0.5"), "an array of steps"),
        ("[0, 1]", plane.to_owned(), "an infinite plane cannot move"),
        ("[0, 1]", portal, "a portal cannot move"),
        ("[1, 0]", sphere("[{ scale = 2 }]"), "the shutter closes before it opens"),
    ];
    for (shutter, shape, expected) in rows {
        let complaint = complaint(shutter, &shape).unwrap_or_else(|| panic!("accepted: {shape}"));
        assert!(complaint.contains(expected) && complaint.contains("test.toml:"), "{complaint}");
    }
    for (shutter, motion) in
        [("[0, 0.4]", "[{ scale = -1 }]"), ("[0, 0]", "[{ scale = -1 }]"), ("[-1, 2]", "[]"), ("[0, 1]", "{ scale = 2 }")]
    {
        assert_eq!(complaint(shutter, &sphere(motion)), None, "{motion}");
    }
}
