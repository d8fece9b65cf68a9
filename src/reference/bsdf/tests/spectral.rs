//! Glass whose channels are not refracted alike.

use super::super::principled::Principled;
use super::super::principled_layers::PrincipledLayers;
use super::super::spectral_dielectric::SpectralDielectric;
use super::super::spectral_glass::SpectralGlass;
use super::*;
use crate::scene::Dispersion;

/// Strong dispersion: channels of 1.47, 1.51 and 1.58 or so.
const FLINT: Dispersion = Dispersion::Cauchy([1.42, 0.033, 0.0]);

fn smooth(iors: Spectrum, tints: Dielectric) -> SpectralDielectric {
    SpectralDielectric { iors, reflectance: tints.reflectance, transmittance: tints.transmittance, film: None }
}

/// The mean weight of samples in each direction that they have, over an even grid of the number that chooses.
fn by_direction(bsdf: &Bsdf, carried: Spectrum) -> Vec<(DVec3, Spectrum)> {
    let mut bsdf = bsdf.clone();
    bsdf.view = bsdf.view.with_carried(carried);
    let count = 200_000;
    let mut found: Vec<(DVec3, Spectrum)> = Vec::new();
    for index in 0..count {
        let Some(sample) = bsdf.sample((f64::from(index) + 0.5) / f64::from(count), 0.5, 0.5) else { continue };
        let weight = sample.weight / f64::from(count);
        match found.iter_mut().find(|(wi, _)| (*wi - sample.wi).length() < 1e-12) {
            Some((_, sum)) => *sum += weight,
            None => found.push((sample.wi, weight)),
        }
    }
    found
}

/// Each channel goes by its own index what plain glass of that index sends there, whatever the path carries of it.
#[test]
fn each_channel_is_plain_glass_of_its_index() {
    let iors = FLINT.channels(1.0);
    let tints = tinted(1.0);
    for degrees in [0.0, 40.0, 75.0, 110.0, 139.0, 142.0, 170.0] {
        for carried in [Spectrum::WHITE, Spectrum::new(1.0, 0.05, 0.3)] {
            let view = view(degrees, 0.0);
            let lobe = Lobe::SpectralGlass(SpectralGlass { dielectric: smooth(iors, tints) });
            let found = by_direction(&single(lobe, view), carried);
            for (channel, ior) in iors.to_rgb().into_iter().enumerate() {
                let eta = if view.front { ior } else { 1.0 / ior };
                let fresnel = dielectric_reflectance(view.wo.z.abs(), eta);
                let at = |wi: DVec3| {
                    let weights = found.iter().filter(|(other, _)| (*other - wi).length() < 1e-12);
                    weights.map(|(_, weight)| weight.to_rgb()[channel]).sum::<f64>()
                };
                let reflected = at(view.mirrored());
                let expected = tints.reflectance.to_rgb()[channel] * fresnel;
                assert!((reflected - expected).abs() < 1e-4, "{degrees}, {channel}: {reflected} {expected}");
                let Some(wi) = refract(view.wo, view.normal(), eta) else { continue };
                let expected = tints.transmittance.to_rgb()[channel] * (1.0 - fresnel) / (eta * eta);
                assert!(
                    (at(wi) - expected).abs() < 1e-4 * (1.0 + expected) + 2e-5,
                    "{degrees}, {channel}: {} {expected}",
                    at(wi)
                );
                // The control: an index a hundredth larger is another direction, where nothing goes.
                if let Some(other) =
                    refract(view.wo, view.normal(), 1.01 * eta).filter(|_| degrees % 180.0 > 5.0 && degrees < 175.0)
                {
                    assert_eq!(at(other), 0.0);
                }
            }
        }
    }
}

/// Each channel of the principled material goes by its own index what the layers of that index send there, whatever the path carries of it.
#[test]
fn each_channel_is_layers_of_its_index() {
    let iors = FLINT.channels(1.0);
    let keys = "base_color = [0.9, 0.5, 0.7]\nmetallic = 0\nroughness = 0\ntransmission = 1\nclearcoat = 0.5";
    let Lobe::Principled(plain) = principled(keys) else { panic!("it is principled") };
    let of = |iors: Option<Spectrum>, ior: f64| {
        Lobe::Principled(Principled { layers: PrincipledLayers { ior, ..plain.layers }, iors })
    };
    for degrees in [0.0, 40.0, 75.0, 110.0, 139.0, 142.0, 170.0] {
        for carried in [Spectrum::WHITE, Spectrum::new(1.0, 0.05, 0.3)] {
            let view = view(degrees, 0.0);
            let found = by_direction(&single(of(Some(iors), 1.5), view), carried);
            for (channel, ior) in iors.to_rgb().into_iter().enumerate() {
                let light = |found: &[(DVec3, Spectrum)], wi: DVec3| {
                    let weights = found.iter().filter(|(other, _)| (*other - wi).length() < 1e-12);
                    weights.map(|(_, weight)| weight.to_rgb()[channel]).sum::<f64>()
                };
                let expected = by_direction(&single(of(None, ior), view), Spectrum::WHITE);
                for (wi, _) in &expected {
                    let (found, expected) = (light(&found, *wi), light(&expected, *wi));
                    let off = (found - expected).abs();
                    assert!(off < 1e-4 * (1.0 + expected), "{degrees}, {channel}: {found} {expected}");
                }
                // Nothing comes from elsewhere.
                let sum = |found: &[(DVec3, Spectrum)]| found.iter().map(|(_, weight)| weight.to_rgb()[channel]).sum::<f64>();
                assert!((sum(&found) - sum(&expected)).abs() < 3e-4, "{degrees}, {channel}");
            }
        }
    }
}

/// A path that carries red alone draws the directions of red alone, and loses nothing.
#[test]
fn a_path_of_one_channel_draws_for_it_alone() {
    let lobe = Lobe::SpectralGlass(SpectralGlass { dielectric: smooth(FLINT.channels(1.0), clear(1.0)) });
    let found = by_direction(&single(lobe, view(50.0, 0.0)), Spectrum::new(0.3, 0.0, 0.0));
    assert_eq!(found.len(), 2, "{found:?}");
}

/// Without dispersion all channels go together, as through plain glass: one reflected direction and one refracted, of the same weights.
#[test]
fn equal_indices_are_plain_glass() {
    for degrees in [0.0, 50.0, 80.0, 120.0, 160.0] {
        let plain = by_direction(&single(glass(tinted(1.5)), view(degrees, 0.0)), Spectrum::WHITE);
        let lobe = Lobe::SpectralGlass(SpectralGlass { dielectric: smooth(Spectrum::grey(1.5), tinted(1.5)) });
        let spectral = by_direction(&single(lobe, view(degrees, 0.0)), Spectrum::new(0.2, 1.0, 0.5));
        assert_eq!(plain.len(), spectral.len(), "{degrees}");
        for (wi, weight) in &plain {
            let same = spectral.iter().find(|(other, _)| (*other - *wi).length() < 1e-12).expect("the same directions");
            assert!(same.1.distance(*weight) < 2e-4, "{degrees}: {} {weight}", same.1);
        }
    }
}

/// Through a prism of 60 degrees at the symmetric angle, light of index n is turned by 2·asin(n·sin 30°) − 60°, which is the least.
#[test]
fn prisms_turn_each_channel_by_its_index() {
    let iors = FLINT.channels(1.0);
    let half = 30.0_f64.to_radians();
    for (channel, ior) in iors.to_rgb().into_iter().enumerate() {
        let mut carried = [0.0; 3];
        carried[channel] = 1.0;
        let through = |incoming: DVec3, front_normal: DVec3| {
            let lobe = Lobe::SpectralGlass(SpectralGlass { dielectric: smooth(iors, clear(1.0)) });
            let view = View::new(-incoming, front_normal, front_normal).with_carried(Spectrum::from_rgb(carried));
            single(lobe, view).sample(0.999, 0.5, 0.5).expect("it goes through").wi
        };
        // Faces to the left and to the right of an edge at the top, their normals outward.
        let [left, right] = [-1.0, 1.0].map(|side| DVec3::new(side * half.cos(), half.sin(), 0.0));
        let incidence = (ior * half.sin()).asin();
        // Within a prism that is passed symmetrically light runs level.
        let incoming = -(left * incidence.cos()) + DVec3::new(half.sin(), half.cos(), 0.0) * incidence.sin();
        let inside = through(incoming, left);
        assert!((inside - DVec3::X).length() < 1e-12, "{channel}: {inside}");
        let turned = incoming.dot(through(inside, right)).acos();
        let expected = 2.0 * incidence - 2.0 * half;
        assert!((turned - expected).abs() < 1e-9, "{channel}: {turned} {expected}");
    }
}
