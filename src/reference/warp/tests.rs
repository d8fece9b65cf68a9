//! Every map against its density: by χ² over the sphere, and by its Jacobian.

use super::*;
use crate::compare::sidak;
use crate::statistics::{SphereBins, test_directional_sampler, worst_jacobian_deviation};

struct Warp {
    name: String,
    map: Box<dyn Fn(f64, f64) -> DVec3>,
    pdf: Box<dyn Fn(DVec3) -> f64>,
    /// Limits of the cosine's bins.
    edges: Vec<f64>,
}

fn warp(
    name: impl Into<String>,
    map: impl Fn(f64, f64) -> DVec3 + 'static,
    pdf: impl Fn(DVec3) -> f64 + 'static,
    edges: Vec<f64>,
) -> Warp {
    Warp { name: name.into(), map: Box::new(map), pdf: Box::new(pdf), edges }
}

fn warps() -> Vec<Warp> {
    let even = || (-7..8).map(|i| f64::from(i) / 8.0).collect::<Vec<_>>();
    let mut warps = vec![
        warp("sphere", uniform_sphere, |_| UNIFORM_SPHERE_PDF, even()),
        warp("hemisphere", uniform_hemisphere, |w| if w.z >= 0.0 { UNIFORM_HEMISPHERE_PDF } else { 0.0 }, even()),
        warp("cosine", cosine_hemisphere, |w| cosine_hemisphere_pdf(w.z), even()),
    ];
    for one_minus_cos in [1e-3, 0.3, 1.0] {
        let inside = move |w: DVec3| if 1.0 - w.z <= one_minus_cos { cone_pdf(one_minus_cos) } else { 0.0 };
        let edges = (0..8).map(|i| 1.0 - one_minus_cos * f64::from(8 - i) / 8.0).collect();
        warps.push(warp(format!("cone {one_minus_cos}"), move |a, b| cone(one_minus_cos, a, b), inside, edges));
    }
    for exponent in [1.0, 10.0, 500.0] {
        let edges = (0..12).map(|i| (f64::from(i) / 12.0).powf(1.0 / (exponent + 1.0))).collect();
        let pdf = move |w: DVec3| phong_lobe_pdf(exponent, w.z);
        warps.push(warp(format!("Phong {exponent}"), move |a, b| phong_lobe(exponent, a, b), pdf, edges));
    }
    warps
}

#[test]
fn directions_follow_their_densities() {
    let warps = warps();
    let level = sidak(0.01, warps.len());
    for (seed, Warp { name, map, pdf, edges }) in (0..).zip(&warps) {
        let bins = SphereBins::with_cosine_edges(DVec3::Z, edges, 12);
        let report = test_directional_sampler(&bins, 1_000_000, seed, |[a, b, _]| Some(map(a, b)), pdf);
        assert!(report.passes(level), "{name}: {report:?}");
        assert!((report.integral.value - 1.0).abs() < 1e-6, "{name}: {:?}", report.integral);
    }
}

/// The lobes as two of the sources print them, θ = acos ξ for the cosine lobe and (1−ξ)^(1/(1+n)) taken for θ, are found out.
#[test]
fn wrong_maps_are_rejected() {
    let even: Vec<f64> = (-7..8).map(|i| f64::from(i) / 8.0).collect();
    let bins = SphereBins::with_cosine_edges(DVec3::Z, &even, 12);
    let cosine =
        test_directional_sampler(&bins, 20_000, 1, |[a, b, _]| Some(uniform_hemisphere(a, b)), |w| cosine_hemisphere_pdf(w.z));
    assert!(!cosine.passes(1e-6));
    let phong = |[a, b, _]: [f64; 3]| Some(direction((1.0 - a).powf(1.0 / 11.0).cos(), (1.0 - a).powf(1.0 / 11.0).sin(), b));
    assert!(!test_directional_sampler(&bins, 20_000, 2, phong, |w| phong_lobe_pdf(10.0, w.z)).passes(1e-6));
}

#[test]
fn jacobians_are_the_densities() {
    for Warp { name, map, pdf, .. } in warps() {
        let worst = worst_jacobian_deviation(|[a, b]| map(a, b), &pdf, 16);
        assert!(worst.relative < 1e-4, "{name}: {worst:?}");
        let control = worst_jacobian_deviation(|[a, b]| map(a, b), |w| 1.01 * pdf(w), 16);
        assert!(control.relative > 5e-3, "{name}: {control:?}");
    }
}

#[test]
fn points_are_uniform_on_disks_and_triangles() {
    let on_disk = |[a, b]: [f64; 2]| disk(3.0, a, b).extend(0.0);
    assert!(worst_jacobian_deviation(on_disk, |_| 1.0 / (9.0 * PI), 16).relative < 1e-4);
    // The triangle of weights has area ½.
    let on_triangle = |[a, b]: [f64; 2]| triangle(a, b).extend(0.0);
    assert!(worst_jacobian_deviation(on_triangle, |_| 2.0, 16).relative < 1e-4);
    for i in 0..64 {
        let p = triangle(f64::from(i) / 64.0, f64::from(i * 37 % 64) / 64.0);
        assert!(p.min_element() >= 0.0 && p.x + p.y <= 1.0, "{p}");
    }
}
