//! Directions that graze a surface, critical angles, and the ends of every weight and roughness.

use gpt::scene::Scene;

use super::support::{Effort, Finding, LEAST_MATCHING, judge, judge_with, scene};

/// Between an index of 10 and air the squared cosine of the refracted direction has 100 times the error of the incident one.
const LEAST_OUT_OF_DENSE_GLASS: f64 = 0.93;

pub fn findings(effort: Effort) -> Vec<Finding> {
    let mut findings = Vec::new();
    let elevations = effort.pick(vec![0.001], vec![1.0, 0.1, 0.01, 0.001]);
    for (name, material) in LOBES {
        for &elevation in &elevations {
            let scene = seen_at(elevation, material);
            let case = format!("{name}, seen {elevation}° above its plane");
            findings.extend(judge(case, &scene, &scene));
        }
    }
    for (name, material) in WEIGHTS {
        let scene = seen_at(20.0, material);
        findings.extend(judge(*name, &scene, &scene));
    }
    for roughness in effort.pick(vec![1e-2, 0.0101], vec![1e-4, 0.0099, 0.01, 0.0101, 0.03, 0.1, 0.3, 1.0]) {
        for (name, kind) in [("metal", "type = \"conductor\"\nreflectance = 0.9"), ("glass", "type = \"rough_glass\"\nior = 1.5")]
        {
            let scene = seen_at(20.0, &format!("{kind}\nroughness = {roughness}\n"));
            findings.extend(judge(format!("{name} of roughness {roughness}"), &scene, &scene));
        }
    }
    for exponent in effort.pick(vec![1e6], vec![1e2, 1e4, 1e6, 1e8, 1e10, 1e15]) {
        for (name, kind) in [
            ("glossy", "type = \"glossy\"\nreflectance = 0.8"),
            ("phong", "type = \"phong\"\ndiffuse = 0.3\nspecular = 0.5"),
            ("Phong glass", "type = \"rough_glass\""),
        ] {
            let scene = seen_at(20.0, &format!("{kind}\nexponent = {exponent:e}\n"));
            findings.extend(judge(format!("{name} of exponent {exponent:e}"), &scene, &scene));
        }
    }
    for ior in effort.pick(vec![1.5], vec![1.0, 1.000_01, 1.5, 10.0]) {
        for (name, kind) in [
            ("smooth", "type = \"glass\""),
            ("rough", "type = \"rough_glass\"\nalpha = 0.05"),
            ("Phong", "type = \"rough_glass\"\nexponent = 1000"),
        ] {
            let scene = critical(ior, kind);
            let case = format!("{name} glass, ior {ior}, from inside about the critical angle");
            let least = if ior > 5.0 { LEAST_OUT_OF_DENSE_GLASS } else { LEAST_MATCHING };
            findings.extend(judge_with(case, &scene, &scene, least));
        }
    }
    findings
}

const LOBES: &[(&str, &str)] = &[
    ("diffuse", "type = \"diffuse\"\nreflectance = 0.8\n"),
    ("mirror", "type = \"mirror\"\n"),
    ("glossy, exponent 50", "type = \"glossy\"\nreflectance = 0.8\nexponent = 50\n"),
    ("glossy, exponent 0", "type = \"glossy\"\nreflectance = 0.8\nexponent = 0\n"),
    ("phong, exponent 20", "type = \"phong\"\ndiffuse = 0.4\nspecular = 0.5\nexponent = 20\n"),
    ("glass", "type = \"glass\"\n"),
    ("rough glass, width 0.3", "type = \"rough_glass\"\nalpha = 0.3\n"),
    ("Phong glass, exponent 30", "type = \"rough_glass\"\nexponent = 30\n"),
    ("metal, width 0.3", "type = \"conductor\"\npreset = \"gold\"\nalpha = 0.3\n"),
    ("metal, width 1", "type = \"conductor\"\nreflectance = 0.9\nalpha = 1\n"),
];

const WEIGHTS: &[(&str, &str)] = &[
    (
        "facing weight, power 0: 1 everywhere",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"facing\", power = 0 }\n",
    ),
    (
        "facing weight, power 1e6: 0 everywhere",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"facing\", power = 1e6 }\n",
    ),
    ("constant weight 0", "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"constant\", value = 0 }\n"),
    ("constant weight 1", "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"constant\", value = 1 }\n"),
    ("constant weight 1e-7", "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"constant\", value = 1e-7 }\n"),
    (
        "Fresnel weight, ior 1: 1 but at grazing angles",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"fresnel\", ior = 1 }\n",
    ),
    (
        "Fresnel weight, exact, ior 1: 1",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"fresnel\", ior = 1, exact = true }\n",
    ),
    (
        "Fresnel weight, exact, ior 0.1: 0 past 5.7°",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"fresnel\", ior = 0.1, exact = true }\n",
    ),
    (
        "threshold 0 of facing: 1",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"threshold\", tau = 0, of = { type = \"facing\" } }\n",
    ),
    (
        "threshold 2 of facing: 0",
        "type = \"blend\"\nmaterials = [\"a\", \"b\"]\nweight = { type = \"threshold\", tau = 2, of = { type = \"facing\" } }\n",
    ),
];

/// A floor of the material, seen at the given elevation in degrees, with a lamp that shines along it and a sphere that stands on it, under a
/// sky whose horizon is bright.
fn seen_at(elevation: f64, material: &str) -> Scene {
    let height = 3.0 * elevation.to_radians().tan();
    let fov = (elevation * 1.9).clamp(0.001, 40.0);
    scene(&format!(
        "[film]\nsize = [48, 48]\n[render]\nspp = 8\nmax_depth = 5\n\
         [camera]\nposition = [0, {height:e}, 3]\nlook_at = [0, 0, 0]\nvfov = {fov:e}\n\
         [[material]]\nname = \"a\"\ntype = \"conductor\"\nreflectance = 0.8\nalpha = 0.2\n\
         [[material]]\nname = \"b\"\ntype = \"diffuse\"\nreflectance = [0.2, 0.5, 0.8]\n\
         [[material]]\nname = \"lamp\"\ntype = \"emissive\"\nradiance = 20\n\
         [[material]]\nname = \"floor\"\n{material}\
         [[shape]]\ntype = \"rectangle\"\ncorner = [-2.1, 0, 2]\nedge_u = [4.2, 0, 0]\nedge_v = [0, 0, -4.4]\nmaterial = \"floor\"\n\
         [[shape]]\ntype = \"sphere\"\ncenter = [0.3, 0.4, -0.7]\nradius = 0.4\nmaterial = \"floor\"\n\
         [[shape]]\ntype = \"rectangle\"\ncorner = [-1, 0.01, -2.1]\nedge_u = [2, 0, 0]\nedge_v = [0, 0.5, 0]\nmaterial = \"lamp\"\n\
         [[light]]\ntype = \"sky\"\nzenith = 0.2\nhorizon = 1\nground = 0.1\n"
    ))
}

/// From inside a block of glass, towards its surface: the middle of the picture looks at the critical angle, asin(1/ior).
fn critical(ior: f64, kind: &str) -> Scene {
    let angle = (1.0 / ior).asin();
    let (sine, cosine) = (angle.sin(), angle.cos().max(1e-4));
    scene(&format!(
        "[film]\nsize = [48, 48]\n[render]\nspp = 8\nmax_depth = 6\n\
         [camera]\nposition = [{:e}, {:e}, 0]\nlook_at = [0, 0, 0]\nup = [0, 0, 1]\nvfov = 1\n\
         [[material]]\nname = \"glass\"\n{kind}\nior = {ior}\n\
         [[shape]]\ntype = \"box\"\nmin = [-3, -2, -1]\nmax = [3, 0, 1]\nmaterial = \"glass\"\n\
         [[light]]\ntype = \"sky\"\nzenith = [0.2, 0.3, 0.9]\nhorizon = 1\nground = 0.1\n",
        -sine, -cosine
    ))
}
