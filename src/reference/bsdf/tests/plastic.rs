//! Plastic: what its surface reflects, and what comes back from below it.

use super::*;
use crate::scene::material::diffuse_reflectance;

fn rough(alpha: f64) -> PlasticInterface {
    PlasticInterface::rough(1.5, alpha, MicrofacetDistribution::Ggx, Masking::HeightCorrelated)
}

/// ∫ value dω by samples spread evenly, each channel.
fn albedo(lobe: Lobe, view: View) -> Spectrum {
    let count = 100_000;
    let bsdf = single(lobe, view);
    cube_points(count, 5).filter_map(|[u1, u2, u]| bsdf.sample(u, u1, u2)).map(|sample| sample.weight).sum::<Spectrum>()
        / f64::from(count)
}

/// 2 ∫ F(μ) μ dμ by midpoints, from either side; 0.5963 from within glass of 1.5, as the literature has it.
#[test]
fn diffuse_reflectance_is_the_mean_of_fresnel() {
    for ior in [1.0005, 1.01, 1.1, 1.5, 2.4] {
        for eta in [ior, 1.0 / ior] {
            let count = 200_000;
            let at = |step: u32| (f64::from(step) + 0.5) / f64::from(count);
            let sum: f64 = (0..count).map(|step| 2.0 * at(step) * dielectric_reflectance(at(step), eta)).sum();
            let (mean, closed) = (sum / f64::from(count), diffuse_reflectance(eta));
            assert!((mean - closed).abs() < 2e-6 + 0.02 * (ior < 1.001) as u32 as f64 * mean, "{eta}: {mean} {closed}");
        }
    }
    assert!((diffuse_reflectance(1.0 / 1.5) - 0.5963).abs() < 1e-4);
    assert_eq!(diffuse_reflectance(1.0), 0.0);
}

/// F + (1 − F)·ρ, since as much gets out from below as in (reciprocity); nonlinear, ρ is (1 − R)·ρ/(1 − ρR).
#[test]
fn smooth_plastic_has_its_known_albedo() {
    for ior in [1.2, 1.5, 2.0] {
        let interface = PlasticInterface::smooth(ior);
        let internal = interface.internal_reflectance();
        for degrees in [0.0, 40.0, 75.0, 86.0, 140.0] {
            let view = view(degrees, 0.0);
            let fresnel = dielectric_reflectance(view.wo.z.abs(), ior);
            let expected = |base: Spectrum| Spectrum::grey(fresnel) + base * (1.0 - fresnel);
            for (nonlinear, base) in
                [(false, orange()), (true, orange() * (1.0 - internal) / (Spectrum::WHITE - orange() * internal))]
            {
                let found = albedo(plastic(interface.clone(), orange(), nonlinear), view);
                assert!(
                    (found - expected(base)).map(f64::abs).max_component() < 1e-3,
                    "{ior} at {degrees}: {found} {}",
                    expected(base)
                );
            }
            let white = albedo(plastic(interface.clone(), Spectrum::WHITE, true), view);
            assert!((white - Spectrum::WHITE).map(f64::abs).max_component() < 1e-3, "{white}");
        }
    }
}

/// The table holds what rough glass of the same microfacets lets through.
#[test]
fn the_table_of_rough_plastic_is_what_rough_glass_transmits() {
    for (distribution, masking) in
        [(MicrofacetDistribution::Ggx, Masking::HeightCorrelated), (MicrofacetDistribution::Beckmann, Masking::Separable)]
    {
        for alpha in [0.1, 0.5, 1.0] {
            let interface = PlasticInterface::rough(1.5, alpha, distribution, masking);
            let table = interface.transmittance_table().expect("it is rough");
            // Angles of the table's own entries.
            for node in [63, 40, 12, 3] {
                let degrees = (node as f64 / 63.0).acos().to_degrees();
                let facets = Facets { alpha: DVec2::splat(alpha), distribution, masking, anisotropic: false };
                let dielectric = Dielectric { reflectance: Spectrum::BLACK, ..clear(1.5) };
                // Undoes the scaling of radiance.
                let transmitted = 2.25 * albedo(Lobe::RoughGlass(RoughGlass { dielectric, facets }), view(degrees, 0.0)).r();
                let found = f64::from(table[node]);
                assert!((found - transmitted).abs() < 2e-3, "{distribution:?} {alpha} at {degrees}: {found} {transmitted}");
            }
        }
    }
}

/// Narrow microfacets are a smooth surface, in what is reflected and in what comes back.
#[test]
fn narrow_rough_plastic_is_smooth_plastic() {
    let (narrow, smooth) = (rough(0.01), PlasticInterface::smooth(1.5));
    assert!((narrow.internal_reflectance() - smooth.internal_reflectance()).abs() < 2e-3);
    for degrees in [5.0, 45.0, 70.0] {
        let [a, b] =
            [narrow.clone(), smooth.clone()].map(|interface| albedo(plastic(interface, orange(), true), view(degrees, 0.0)));
        assert!((a - b).map(f64::abs).max_component() < 3e-3, "{degrees}: {a} {b}");
    }
}

/// White plastic of any roughness sends no more back than it gets.
#[test]
fn white_rough_plastic_makes_no_energy() {
    for alpha in [0.05, 0.2, 0.5, 1.0] {
        for nonlinear in [false, true] {
            for degrees in [0.0, 50.0, 80.0, 88.0] {
                let found = albedo(plastic(rough(alpha), Spectrum::WHITE, nonlinear), view(degrees, 0.0)).r();
                println!("{alpha} at {degrees}: {found}");
                assert!(found < 1.0 + 1e-3, "{alpha} at {degrees}: {found}");
            }
        }
    }
}
