//! Glass, smooth and rough.

use super::*;

/// Reflected and transmitted power sum to 1 for clear glass and to the tints for tinted glass.
#[test]
fn glass_keeps_the_energy() {
    for boundary in [clear(1.5), clear(0.7), tinted(1.5)] {
        for degrees in [0.0, 30.0, 41.7, 41.9, 60.0, 85.0, 100.0, 139.0, 150.0, 180.0] {
            let bsdf = single(glass(boundary), view(degrees, 0.0));
            let eta = if degrees < 90.0 { boundary.ior } else { 1.0 / boundary.ior };
            let fresnel = dielectric_reflectance(bsdf.view.wo.z.abs(), eta);
            // The lobe is chosen by one number, so a fine grid of it gives the mean.
            let n = 20_000;
            let mean: Spectrum = (0..n)
                .filter_map(|i| bsdf.sample((f64::from(i) + 0.5) / f64::from(n), 0.0, 0.0))
                .map(|sample| sample.weight * sample.eta * sample.eta)
                .sum::<Spectrum>()
                / f64::from(n);
            let expected = boundary.reflectance * fresnel + boundary.transmittance * (1.0 - fresnel);
            assert!(mean.distance(expected) < 1e-3, "{boundary:?} at {degrees}: {mean} {expected}");
        }
    }
}

/// Through rough glass as through smooth: what a facet reflects and what it lets through is all there is, but for what facets send
/// on to each other. Narrow facets lose next to nothing.
#[test]
fn narrow_rough_glass_keeps_the_energy() {
    for degrees in [0.0, 40.0, 70.0, 110.0, 150.0] {
        for lobe in [rough_glass(clear(1.5), 0.005), phong_glass(clear(1.5), 20_000.0)] {
            let bsdf = single(lobe, view(degrees, 0.0));
            let n = 20_000;
            let weight = |[u1, u2, u]: [f64; 3]| bsdf.sample(u, u1, u2).map_or(Spectrum::BLACK, |s| s.weight * s.eta * s.eta);
            let mean = cube_points(n, 1).map(weight).sum::<Spectrum>() / f64::from(n);
            assert!(mean.distance(Spectrum::WHITE) < 5e-3, "{lobe:?} at {degrees}: {mean}");
        }
    }
}

/// Past the critical angle of the shading normal Phong glass has no refracted direction; a tint of 0 reflects nothing then.
#[test]
fn total_reflection_leaves_nothing_to_transmit() {
    let black_mirror = Dielectric { reflectance: Spectrum::BLACK, ..clear(1.5) };
    for lobe in [glass(black_mirror), phong_glass(black_mirror, 30.0)] {
        let bsdf = single(lobe, view(120.0, 0.0));
        assert!(cube_points(100, 2).all(|[u1, u2, u]| bsdf.sample(u, u1, u2).is_none()));
    }
    let clear = single(phong_glass(clear(1.5), 30.0), view(120.0, 0.0));
    for sample in cube_points(100, 2).filter_map(|[u1, u2, u]| clear.sample(u, u1, u2)) {
        assert!(sample.wi.z < 0.0 && sample.eta == 1.0);
    }
}

/// Light goes straight through rough glass that does not bend it.
#[test]
fn rough_glass_of_ior_one_is_not_there() {
    let kind = MaterialKind::RoughGlass {
        ior: 1.0,
        facets: Microfacets::ggx(ColorInput::grey(0.3)),
        thin: false,
        reflectance: ColorInput::grey(1.0),
        transmittance: ColorInput::grey(1.0),
        film: None,
        dispersion: None,
    };
    let scene = Scene::default();
    let lookup = Lookup { scene: &scene, uv: DVec2::ZERO.into(), cosine: 1.0, normal: DVec3::Z, front: true, by_camera: false };
    let lobe = Lobe::of(&kind, &lookup).expect("glass scatters");
    let view = view(50.0, 0.0);
    let sample = single(lobe, view).sample(0.3, 0.2, 0.9).expect("light goes on");
    assert!((sample.wi + view.wo).length() < 1e-12 && sample.weight.distance(Spectrum::WHITE) < 1e-12);
}
