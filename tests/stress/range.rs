//! Radiance, distances, throughputs and densities at both ends of what a scene may ask for.

use std::fmt::Write as _;
use std::sync::Arc;

use glam::{DVec3, Vec3};
use gpt::plan::PlanOptions;
use gpt::scene::{Environment, EnvironmentRadiance, ImageData, Light, Scene};

use super::support::{Effort, Finding, compare_with, judge, mean_of, measured, scene};

pub fn findings(effort: Effort) -> Vec<Finding> {
    let mut findings = Vec::new();
    findings.extend(judge("lights of radiance 1e-6 and 1e6 in one picture", &dim_and_bright(), &dim_and_bright()));
    findings.extend(tiny_far_lights());
    findings.extend(rectangles(effort));
    findings.extend(triangles(effort));
    findings.extend(spheres(effort));
    findings.extend(judge("environment with a sun of 1e5 over a sky of 1", &sun(), &sun()));
    findings.extend(white_boxes(effort));
    findings.extend(densities(effort));
    findings
}

/// Two rooms side by side, each with a lamp of its own, and a slit in the wall between them.
fn dim_and_bright() -> Scene {
    let mut text = String::from(
        r#"
[film]
size = [48, 48]
[render]
spp = 8
max_depth = 6
[camera]
position = [0, 1, 4.2]
look_at = [0, 1, 0]
vfov = 45
[[material]]
name = "white"
type = "diffuse"
reflectance = 0.6
"#,
    );
    for (name, radiance, x) in [("dim", "1e-6", -1.3), ("bright", "1e6", 0.7)] {
        let _ = write!(
            text,
            "[[material]]\nname = \"{name}\"\ntype = \"emissive\"\nradiance = {radiance}\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [{x}, 1.98, -0.5]\nedge_u = [0.6, 0, 0]\nedge_v = [0, 0, 0.6]\nmaterial = \"{name}\"\n"
        );
    }
    for (min, max) in
        [([-2.0, -0.1, -1.0], [2.0, 0.0, 1.5]), ([-0.02, 0.0, -1.0], [0.02, 1.9, 1.5]), ([-2.0, 0.0, -1.1], [2.0, 2.2, -1.0])]
    {
        let _ = write!(text, "[[shape]]\ntype = \"box\"\nmin = {min:?}\nmax = {max:?}\nmaterial = \"white\"\n");
    }
    scene(&text)
}

/// A floor under a light of size 1e-4 at a distance of 1e4, in closed form: radiance = ρ/π · L · A · cos θ / d².
fn tiny_far_lights() -> Vec<Finding> {
    let albedo = 0.5;
    let radius = 0.5e-4;
    let light = |shape: &str| {
        scene(&format!(
            "[film]\nsize = [16, 16]\n[render]\nspp = 16\nmax_depth = 4\n\
             [camera]\nposition = [0, 1, 0.1]\nlook_at = [0, 0, 0]\nvfov = 20\n\
             [[material]]\nname = \"floor\"\ntype = \"diffuse\"\nreflectance = {albedo}\n\
             [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = 1e16\n\
             [[shape]]\ntype = \"rectangle\"\ncorner = [-1, 0, 1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0, -2]\nmaterial = \"floor\"\n{shape}"
        ))
    };
    let sphere =
        light(&format!("[[shape]]\ntype = \"sphere\"\ncenter = [0, 1e4, 0]\nradius = {radius:e}\nmaterial = \"light\"\n"));
    let panel = light(&format!(
        "[[shape]]\ntype = \"rectangle\"\ncorner = [-{radius:e}, 1e4, -{radius:e}]\nedge_u = [1e-4, 0, 0]\nedge_v = [0, 0, 1e-4]\nmaterial = \"light\"\n"
    ));
    let disk = light(&format!(
        "[[shape]]\ntype = \"disk\"\ncenter = [0, 1e4, 0]\nnormal = [0, -1, 0]\nradius = {radius:e}\nmaterial = \"light\"\n"
    ));
    let round = std::f64::consts::PI * radius * radius;
    [("sphere", sphere, round), ("panel", panel, 1e-8), ("disk", disk, round)]
        .into_iter()
        .filter_map(|(name, scene, area)| {
            let truth = albedo / std::f64::consts::PI * 1e16 * area / 1e8;
            against_truth(format!("{name} of size 1e-4 at a distance of 1e4"), &scene, truth, 2e-6)
        })
        .collect()
}

/// A point of a floor under the middle of a rectangle light, from so near that it fills the sky to where its points are drawn by area
/// because the solid angle is too small for single precision. In closed form: radiance = ρ · L · F, with
/// F = 2/π · (x/√(1+x²) · atan(y/√(1+x²)) + y/√(1+y²) · atan(x/√(1+y²))), x and y half the sides over the height.
fn rectangles(effort: Effort) -> Vec<Finding> {
    let sizes = effort.pick(vec![1.0], vec![1e-4, 1.0, 1e4]);
    let heights = effort.pick(vec![0.02, 1.0, 4.3, 1e3], vec![0.02, 0.1, 1.0, 4.0, 4.3, 30.0, 1e3, 1e6]);
    let mut findings = Vec::new();
    for (size, height) in sizes.iter().flat_map(|&size: &f64| heights.iter().map(move |&height| (size, height))) {
        let [width, depth, above] = [1.5 * size, size, height * size];
        let [x, y] = [0.5 * width / above, 0.5 * depth / above];
        let part = |x: f64, y: f64| x / (1.0 + x * x).sqrt() * (y / (1.0 + x * x).sqrt()).atan();
        let truth = 0.5 * 2.0 / std::f64::consts::PI * (part(x, y) + part(y, x));
        let eye = 0.3 * above.min(size);
        let lamp = format!(
            "type = \"rectangle\"\ncorner = [{:e}, {above:e}, {:e}]\nedge_u = [{width:e}, 0, 0]\nedge_v = [0, 0, {depth:e}]\n",
            -0.5 * width,
            -0.5 * depth
        );
        let scene = point_under(&lamp, eye);
        let case = format!("rectangle of size {size:e} at {height} times its size");
        findings.extend(against_truth(case, &scene, truth, 1e-3));
    }
    findings
}

/// A point of a floor and a triangle light: overhead from so near that it fills the sky to so far that its points are drawn by area, aside in a plane
/// that all but holds the point, and as narrow as a hair. In closed form (Lambert): radiance = ρ · L · Σ θ cos γ / 2π over the edges, θ the angle that an
/// edge is seen under, γ that of the normal of the plane through it and the point with the floor's.
fn triangles(effort: Effort) -> Vec<Finding> {
    let sizes = effort.pick(vec![1.0, 1e4], vec![1e-4, 1.0, 1e4]);
    let heights = effort.pick(vec![0.005, 1.0, 800.0, 1e6], vec![0.005, 0.02, 0.1, 1.0, 4.0, 30.0, 800.0, 1e3, 1e6]);
    let asides = effort.pick(vec![0.02, 0.01], vec![0.1, 0.02, 0.01, 0.005]);
    let widths = effort.pick(vec![1e-2], vec![0.1, 1e-2, 1e-3]);
    let overhead = heights.iter().map(|height| {
        let corners = [[-0.7, 1.0, -0.4], [0.8, 1.0, -0.5], [0.1, 1.1, 0.6]].map(|[x, y, z]| DVec3::new(x, y * height, z));
        (format!("at {height} times its size"), corners, 0.3 * height.min(1.0))
    });
    let aside = asides.iter().map(|&off: &f64| {
        let corners = [DVec3::new(1.0, 0.1, off), DVec3::new(3.0, 0.1, off), DVec3::new(1.5, 2.0, off)];
        (format!("seen from {off} times its size off its plane"), corners, 0.04)
    });
    let narrow = widths.iter().map(|&width: &f64| {
        let corners = [DVec3::new(-0.5, 1.0, 0.0), DVec3::new(0.5, 1.0, 0.0), DVec3::new(0.5, 1.0, width)];
        (format!("{width} times as wide as long"), corners, 0.3)
    });
    let cases: Vec<(String, [DVec3; 3], f64)> = overhead.chain(aside).chain(narrow).collect();
    let of_size = |&size: &f64| {
        let finding = move |(name, corners, eye): &(String, [DVec3; 3], f64)| {
            let truth = 0.5 * lambert(corners).abs();
            let positions = corners.map(|corner| (size * corner).to_array());
            let lamp = format!("type = \"mesh\"\npositions = {positions:?}\nfaces = [[0, 1, 2]]\n");
            let scene = point_under(&lamp, size * eye);
            against_truth(format!("triangle of size {size:e} {name}"), &scene, truth, 1e-3)
        };
        cases.iter().filter_map(finding).collect::<Vec<_>>()
    };
    sizes.iter().flat_map(of_size).collect()
}

/// A point of a floor under a sphere light that stands near the camera: its own numbers are small, and say nothing of the errors of rays that come
/// from afar. In closed form: radiance = ρ · L · (r/d)².
fn spheres(effort: Effort) -> Vec<Finding> {
    let heights = effort.pick(vec![1e4], vec![1e1, 1e2, 1e3, 1e4, 1e5]);
    let ways = [("cone", 1e-3), ("visible", 3e-3)];
    let finding = |(height, (way, margin)): (f64, (&str, f64))| {
        let lamp = format!("type = \"sphere\"\ncenter = [0, {height:e}, 0]\nradius = 1\n");
        let scene = lit_point(&lamp, way, [2.0, height, 0.0]);
        let case = format!("sphere at {height:e} radii from what it lights, drawn by \"{way}\", beside the camera");
        against_truth(case, &scene, 0.5 / (height * height), margin)
    };
    heights.iter().flat_map(|&height| ways.map(|way| (height, way))).filter_map(finding).collect()
}

/// The share of the light of a whole sky that comes to the origin of a floor from a polygon above it.
fn lambert(corners: &[DVec3]) -> f64 {
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    edges.map(|(from, to)| from.angle_between(*to) * from.cross(*to).normalize().y).sum::<f64>() / std::f64::consts::TAU
}

/// The origin of a floor of albedo ½ that a lamp of radiance 1 lights, as the keys of its shape say, seen from a place aside.
fn point_under(lamp: &str, eye: f64) -> Scene {
    lit_point(lamp, "cone", [eye, eye, 0.0])
}

/// A scene whose lamp is sampled in any way and seen from any place.
fn lit_point(lamp: &str, light_sampling: &str, eye: [f64; 3]) -> Scene {
    // A field of view so narrow that all pixels see the same point, which are replications of each other.
    scene(&format!(
        "[film]\nsize = [16, 16]\n[render]\nspp = 512\nmax_depth = 2\nestimator = \"nee\"\nlight_sampling = \"{light_sampling}\"\n\
         [camera]\nposition = {eye:?}\nlook_at = [0, 0, 0]\nvfov = 0.001\n\
         [[material]]\nname = \"floor\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = 1\ntwo_sided = true\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
         [[shape]]\n{lamp}material = \"light\"\n"
    ))
}

/// A comparison with the reference, and of the device's mean with a truth, to the relative `margin`.
fn against_truth(case: String, scene: &Scene, truth: f64, margin: f64) -> Option<Finding> {
    let verdict = compare_with(scene, scene, &PlanOptions::default())?;
    let error = mean_of(&verdict.gpu_mean) / truth - 1.0;
    Some(
        measured(case, &verdict)
            .with("error against the closed form", format!("{:.1e}", error.abs()))
            .require(error.abs() <= margin, || format!("the mean is off by {error:e}, at most {margin:e} is right"))
            .require(verdict.non_finite_samples == 0, || "some samples are not finite".to_owned()),
    )
}

/// Half a degree of a sky of 64 × 32 texels.
fn sun() -> Scene {
    let mut scene = scene(
        "[film]\nsize = [48, 48]\n[render]\nspp = 8\nmax_depth = 6\n\
         [camera]\nposition = [0, 1.5, 5]\nlook_at = [0, 0.7, 0]\nvfov = 40\n\
         [[material]]\nname = \"floor\"\ntype = \"diffuse\"\nreflectance = 0.5\n\
         [[material]]\nname = \"metal\"\ntype = \"conductor\"\nreflectance = 0.9\nroughness = 0.3\n\
         [[shape]]\ntype = \"plane\"\npoint = [0, 0, 0]\nnormal = [0, 1, 0]\nmaterial = \"floor\"\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [-0.8, 0.7, 0]\nradius = 0.7\nmaterial = \"floor\"\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [0.8, 0.7, 0]\nradius = 0.7\nmaterial = \"metal\"\n\
         [[light]]\ntype = \"environment\"\nradiance = 1\n",
    );
    let (width, height) = (64, 32);
    let mut texels = vec![Vec3::ONE; width * height];
    texels[7 * width + 12] = Vec3::splat(1e5);
    let image = ImageData { width: width as u32, height: height as u32, texels: texels.into(), has_alpha: false };
    let radiance = EnvironmentRadiance::Map(Arc::new(image));
    scene.lights = vec![Light::Environment(Environment {
        radiance,
        rotation_degrees: 0.0,
        turn: None,
        rows: Default::default(),
        mirrored: false,
    })];
    scene
}

/// Relative error of a path through n edges: 0.999 itself is rounded to f32, and every product is.
const PRODUCT_ERROR: f64 = 3e-5;
/// Share of bounces that may leak where walls meet at an acute angle. A ray starts off its wall by the error bound of its point, a
/// millionth of the wall's coordinates; closer than that to an acute edge, it may start behind the other wall.
const ACUTE_LEAKS: f64 = 2e-5;

/// The inside of closed white shapes that glow with radiance 1: 1/(1 − 0.999) = 1000. Followed for n edges without roulette, every path
/// is (1 − 0.999ⁿ) · 1000 exactly, so that one ray that leaks out shows.
fn white_boxes(effort: Effort) -> Vec<Finding> {
    let edges: i32 = effort.pick(2_000, 10_000);
    let truth = 1000.0 * (1.0 - 0.999_f64.powi(edges));
    let sphere = "[[shape]]\ntype = \"sphere\"\ncenter = [0.1, 0.2, 0.3]\nradius = 1\nmaterial = \"white\"\n";
    let cube = "[[shape]]\ntype = \"box\"\nmin = [-1, -0.9, -1.1]\nmax = [1, 0.8, 1.2]\nmaterial = \"white\"\n";
    let tetrahedron = "[[shape]]\ntype = \"mesh\"\npositions = [[-2, -1, -1.5], [2, -1, -1.5], [0, -1, 2], [0.1, 2.5, 0.1]]\n\
         faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]\nmaterial = \"white\"\n";
    [("sphere", sphere, 0.0), ("box", cube, 0.0), ("tetrahedron", tetrahedron, ACUTE_LEAKS)]
        .into_iter()
        .filter_map(|(name, shape, most_leaks)| {
            let scene = scene(&format!(
                "[film]\nsize = [8, 8]\n[render]\nspp = 1\nmax_depth = {edges}\nroulette_depth = 0\nestimator = \"bsdf\"\n\
                 [camera]\nposition = [0, 0, 0]\nlook_at = [0.3, 0.1, 1]\nvfov = 90\n\
                 [[material]]\nname = \"white\"\ntype = \"diffuse\"\nreflectance = 0.999\nemission = 1\nemission_two_sided = true\n{shape}"
            ));
            let verdict = compare_with(&scene, &scene, &PlanOptions::default())?;
            let errors = || verdict.gpu.iter().map(|pixel| (f64::from(pixel[0]) / truth - 1.0).abs());
            let (leaked, whole): (Vec<f64>, Vec<f64>) = errors().partition(|error| *error > PRODUCT_ERROR);
            let leaks = leaked.len() as f64 / (64.0 * f64::from(edges));
            let largest = whole.into_iter().fold(0.0, f64::max);
            Some(
                Finding::new(format!("white {name}, albedo 0.999, {edges} edges"))
                    .with("largest error of a path that stays inside", format!("{largest:.1e}"))
                    .with("leaks per bounce", format!("{leaks:.1e}"))
                    .with("not finite", verdict.non_finite_samples)
                    .require(leaks <= most_leaks, || format!("{leaks:e} of the bounces leak: {leaked:?}"))
                    .require(verdict.non_finite_samples == 0, || "some samples are not finite".to_owned()),
            )
        })
        .collect()
}

/// A glossy floor of any width under lights of any size: densities from next to nothing to next to infinity, weights at both ends.
fn densities(effort: Effort) -> Vec<Finding> {
    let widths = effort.pick(vec![1e-4, 1.0], vec![1e-4, 1e-3, 1e-2, 0.1, 1.0]);
    let radii = effort.pick(vec![1e-3, 1.0], vec![1e-4, 1e-2, 1.0]);
    let mut findings = Vec::new();
    for &alpha in &widths {
        for &radius in &radii {
            let radiance = 1.0 / (radius * radius);
            let scene = scene(&format!(
                "[film]\nsize = [48, 48]\n[render]\nspp = 8\nmax_depth = 3\n\
                 [camera]\nposition = [0, 1, 3]\nlook_at = [0, 0, 0]\nvfov = 40\n\
                 [[material]]\nname = \"metal\"\ntype = \"conductor\"\nreflectance = 0.9\nalpha = {alpha:e}\n\
                 [[material]]\nname = \"light\"\ntype = \"emissive\"\nradiance = {radiance:e}\n\
                 [[shape]]\ntype = \"rectangle\"\ncorner = [-2, 0, 2]\nedge_u = [4, 0, 0]\nedge_v = [0, 0, -4]\nmaterial = \"metal\"\n\
                 [[shape]]\ntype = \"sphere\"\ncenter = [0, 1.5, -2]\nradius = {radius:e}\nmaterial = \"light\"\n"
            ));
            findings.extend(judge(format!("metal of width {alpha:e} under a sphere light of radius {radius:e}"), &scene, &scene));
        }
    }
    findings
}
