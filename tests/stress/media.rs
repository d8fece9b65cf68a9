//! Media from all but nothing to all but opaque, phase functions as narrow as may be asked for, grids of one voxel, and boundaries where rays begin
//! or end.

use std::fmt::Write as _;

use gpt::scene::Scene;

use gpt::plan::PlanOptions;

use super::support::{Effort, Finding, compare_with, judge, judge_with, mean_difference, measured, scene};

pub fn findings(effort: Effort) -> Vec<Finding> {
    let mut findings = Vec::new();
    findings.extend(depths(effort));
    findings.extend(thin_layers());
    findings.extend(narrow_phases(effort));
    findings.extend(grids(effort));
    findings.extend(boundaries());
    findings
}

const BOX: &str = "[[shape]]\ntype = \"box\"\nmin = [-0.7, 0.1, -0.5]\nmax = [0.3, 1.1, 0.5]\nmaterial = \"edge\"\n";
const NULL_BOUNDARY: &str = "type = \"pass\"";
const GLASS_BOUNDARY: &str = "type = \"glass\"\nior = 1.33";

/// A floor under a ball light, a point light and a weak sky, the keys of the medium "body", its boundary, and what stands there.
fn room(medium: &str, boundary: &str, shapes: &str) -> Scene {
    scene(&format!(
        r#"
[film]
size = [40, 40]
[render]
spp = 16
max_depth = 8
[camera]
position = [0, 1, 4]
look_at = [0, 0.7, 0]
vfov = 40
[[medium]]
name = "body"
{medium}
[[material]]
name = "edge"
{boundary}
interior = "body"
[[material]]
name = "grey"
type = "diffuse"
reflectance = 0.6
[[material]]
name = "lamp"
type = "emissive"
radiance = 8
[[light]]
type = "point"
position = [1.2, 2, 1.5]
intensity = 6
[[light]]
type = "environment"
radiance = [0.1, 0.15, 0.2]
[[shape]]
type = "box"
min = [-3, -1, -3]
max = [3, 0, 3]
material = "grey"
[[shape]]
type = "sphere"
center = [0.9, 0.5, 0.2]
radius = 0.3
material = "lamp"
{shapes}"#
    ))
}

/// Coefficients of a medium by its optical depth over a unit of length.
fn of_depth(depth: f64, phase: &str) -> String {
    let [absorption, scattering] = [[0.1, 0.07, 0.14], [0.9, 0.63, 1.26]].map(|channels| channels.map(|value| value * depth));
    format!("absorption = {absorption:?}\nscattering = {scattering:?}\nphase = {phase}")
}

const ISOTROPIC: &str = "{ type = \"isotropic\" }";

/// A body of unit size.
fn depths(effort: Effort) -> Vec<Finding> {
    let depths = effort.pick(vec![1e-6, 1.0, 1e3, 1e6], vec![1e-6, 1e-4, 1e-2, 1.0, 1e2, 1e3, 1e4, 1e5, 1e6]);
    let mut findings = Vec::new();
    for depth in depths {
        for (name, boundary) in [("behind a null boundary", NULL_BOUNDARY), ("behind glass", GLASS_BOUNDARY)] {
            let scene = room(&of_depth(depth, ISOTROPIC), boundary, BOX);
            findings.extend(judge_depth(format!("body of optical depth {depth:e} {name}"), depth, &scene));
        }
    }
    findings
}

/// Paths within 2,000 units of optical depth are to be the reference's. Beyond, a mean free path is not much longer than the rounding of places, and
/// the mean is to be so, to 3e-8 of the depth.
fn judge_depth(case: String, depth: f64, scene: &Scene) -> Option<Finding> {
    if depth < 2e3 {
        return judge(case, scene, scene);
    }
    let verdict = compare_with(scene, scene, &PlanOptions::default())?;
    let is_right = verdict.non_finite_samples == 0 && mean_difference(&verdict) < 3e-8 * depth;
    Some(measured(case, &verdict).require(is_right, || format!("{verdict:#?}")))
}

/// Light of a point light that is scattered within a mean free path of 1/2000 below the boundary. On the device a ray starts above the surface,
/// by some 1/2000 of that path, and what it loses on the way down counts.
fn thin_layers() -> Option<Finding> {
    let scene = scene(
        r#"
[film]
size = [64, 64]
[render]
spp = 64
max_depth = 3
[camera]
position = [0, 1, 4]
look_at = [0, 0.5, 0]
vfov = 20
[[medium]]
name = "body"
scattering = 2000
absorption = 100
[[material]]
name = "edge"
type = "pass"
interior = "body"
[[light]]
type = "point"
position = [0.5, 2, 4]
intensity = 20
[[shape]]
type = "box"
min = [-2, -1, -1]
max = [2, 2, 0.5]
material = "edge"
"#,
    );
    let verdict = compare_with(&scene, &scene, &PlanOptions::default())?;
    let is_right = verdict.non_finite_samples == 0 && mean_difference(&verdict) < 4e-4;
    let finding = measured("light within a mean free path of 5e-4 below a boundary", &verdict);
    Some(finding.require(is_right, || format!("{verdict:#?}")))
}

fn narrow_phases(effort: Effort) -> Vec<Finding> {
    let means = effort.pick(vec![0.999, -0.999], vec![0.999, 0.99, 0.9, 0.0, -0.9, -0.99, -0.999]);
    let of_mean = |g: f64| {
        let phase = format!("{{ type = \"henyey_greenstein\", g = {g} }}");
        let scene = room(&of_depth(4.0, &phase), NULL_BOUNDARY, BOX);
        judge(format!("mean cosine {g}"), &scene, &scene)
    };
    means.into_iter().filter_map(of_mean).collect()
}

fn grids(effort: Effort) -> Vec<Finding> {
    let depths = effort.pick(vec![1e-6, 1.0, 1e4], vec![1e-6, 1e-3, 1.0, 1e2, 1e4, 1e6]);
    let filters = [("nearest", "background"), ("trilinear", "border")];
    let mut findings = Vec::new();
    for (depth, (filter, outside)) in depths.into_iter().flat_map(|depth| filters.map(|way| (depth, way))) {
        let place = "bounds = [[-0.7, 0.1, -0.5], [0.3, 1.1, 0.5]]";
        let voxel = format!(
            "density = {{ resolution = [1, 1, 1], values = [{depth:?}], filter = \"{filter}\", outside = \"{outside}\", {place} }}"
        );
        let scene = room(&(of_depth(1.0, ISOTROPIC) + "\n" + &voxel), NULL_BOUNDARY, BOX);
        findings.extend(judge_depth(format!("grid of one voxel of optical depth {depth:e}, {filter}"), depth, &scene));
    }
    // From empty to dense in one step.
    let steps = format!(
        "{}\ndensity = {{ resolution = [2, 2, 2], values = [0, 1e4, 1e-4, 0, 1, 0, 0, 1e3], filter = \"nearest\", {} }}",
        of_depth(1.0, ISOTROPIC),
        "bounds = [[-0.7, 0.1, -0.5], [0.3, 1.1, 0.5]]"
    );
    let scene = room(&steps, NULL_BOUNDARY, BOX);
    // A place that rounding puts beyond the face of a voxel is in another medium.
    findings.extend(judge_with("grid from 0 to 1e4 in a voxel", &scene, &scene, 0.97));
    findings
}

/// Boundaries that meet the camera, each other, and themselves.
fn boundaries() -> Vec<Finding> {
    let fog = of_depth(2.0, ISOTROPIC);
    let ball = |x: f64, radius: f64| {
        format!("[[shape]]\ntype = \"sphere\"\ncenter = [{x:?}, 0.6, 0]\nradius = {radius:?}\nmaterial = \"edge\"\n")
    };
    let on_the_camera = "[[shape]]\ntype = \"box\"\nmin = [-2, 0.1, -1]\nmax = [2, 2, 4]\nmaterial = \"edge\"\n";
    let nested = [0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3].iter().fold(String::new(), |mut text, radius| {
        let _ = write!(text, "{}", ball(-0.2, *radius));
        text
    });
    let tiny = ball(-0.2, 1e-3) + &ball(-0.4, 1e-4);
    [
        ("a camera on the face of a body", on_the_camera.to_owned()),
        ("bodies that overlap", ball(-0.5, 0.5) + &ball(0.0, 0.4)),
        ("seven bodies within each other", nested),
        ("bodies of 1e-3 and 1e-4", tiny),
        ("a body that touches the floor", ball(-0.4, 0.6)),
    ]
    .into_iter()
    .filter_map(|(name, shapes)| {
        let scene = room(&fog, NULL_BOUNDARY, &shapes);
        judge(name, &scene, &scene)
    })
    .collect()
}
