//! Coats that lie about other normals than what is below them.

use super::super::principled::Principled;
use super::super::principled_layers::PrincipledLayers;
use super::*;
use crate::compare::sidak;
use crate::reference::intersect::{NormalTexel, Tangents, UvSet};
use crate::statistics::{SphereBins, test_directional_sampler};

/// The lobe with a map of the coat's own that has this texel here.
fn mapped(lobe: Lobe, texel: Option<NormalTexel>) -> Lobe {
    let Lobe::Principled(principled) = lobe else { panic!("it is no principled lobe") };
    Lobe::Principled(Principled { layers: PrincipledLayers { coat_texel: texel, ..principled.layers }, ..principled })
}

/// A surface whose base is perturbed by some degrees, and whose coat is nearly not.
fn perturbed_below(wo_degrees: f64, tilt_degrees: f64) -> View {
    view(wo_degrees, tilt_degrees)
        .with_coat_normal(Some(at_degrees(4.0, 1.0)))
        .with_tangents(Some(Tangents::along(DVec3::new(1.0, 0.2, 0.0), DVec3::Y)))
}

/// Leans by about 31 degrees towards u and away from v.
const LEANING: DVec3 = DVec3::new(0.9, 0.3, 1.0);

fn leaning(scale: f64) -> Option<NormalTexel> {
    Some(NormalTexel { texel: LEANING, scale, set: UvSet::First })
}

const MATERIALS: [&str; 5] = [
    "base_color = [0.8, 0.2, 0.1]\nmetallic = 0.3\nroughness = 0.6\nclearcoat = 0.8\nclearcoat_roughness = 0.3",
    "base_color = 1\nmetallic = 1\nroughness = 0.3\nclearcoat = 1\nclearcoat_roughness = 0.5",
    "base_color = 0.9\nmetallic = 0\nroughness = 0.5\nclearcoat = 1",
    "base_color = 1\nmetallic = 0\nroughness = 0.4\ntransmission = 0.8\nclearcoat = 1\nclearcoat_roughness = 0.4",
    "base_color = 1\nmetallic = 0\nroughness = 0.4\ntransmission = 0.7\nthin = true\nclearcoat = 1\nclearcoat_roughness = 0.6",
];

fn surfaces(tilt_degrees: f64) -> Vec<(String, Bsdf)> {
    let mut surfaces = Vec::new();
    for keys in MATERIALS {
        for texel in [None, leaning(1.0), leaning(-0.6)] {
            for degrees in [10.0, 70.0, 130.0] {
                let name = format!("{} with {texel:?} at {degrees}", keys.replace('\n', ", "));
                surfaces.push((name, single(mapped(principled(keys), texel), perturbed_below(degrees, tilt_degrees))));
            }
        }
    }
    surfaces
}

#[test]
fn samples_follow_their_densities() {
    let surfaces = surfaces(25.0);
    let level = sidak(0.01, surfaces.len());
    let bins = SphereBins::uniform(DVec3::Z, 16, 12);
    for (seed, (name, bsdf)) in (900..).zip(&surfaces) {
        let draw = |[u1, u2, u_lobe]: [f64; 3]| {
            let sample = bsdf.sample(u_lobe, u1, u2)?;
            matches!(sample.density, Density::SolidAngle(_)).then_some(sample.wi)
        };
        let report = test_directional_sampler(&bins, 20_000, seed << 32, draw, |wi| bsdf.evaluate(wi).pdf);
        assert!(report.passes(level), "{name}: {report:?}");
    }
    // The control: the density of a coat that lies as its base does is another one.
    let (_, bsdf) = &surfaces[0];
    let draw = |[u1, u2, u_lobe]: [f64; 3]| bsdf.sample(u_lobe, u1, u2).map(|sample| sample.wi);
    let other = single(principled(MATERIALS[0]), view(10.0, 25.0));
    let report = test_directional_sampler(&bins, 20_000, 7 << 32, draw, |wi| other.evaluate(wi).pdf);
    assert!(!report.passes(level), "{report:?}");
}

/// Under a uniform light of 1 no more comes back than arrives, or than glTF's base gives back by itself, whichever way the coat leans.
#[test]
fn coats_make_no_energy() {
    let surfaces = surfaces(0.0);
    let per_material = surfaces.len() / MATERIALS.len();
    for (index, (name, bsdf)) in surfaces.iter().enumerate() {
        let count = 1 << 13;
        let reflected = |bsdf: &Bsdf| {
            let samples = cube_points(count, 40 + index as u64).filter_map(|[u1, u2, u_lobe]| bsdf.sample(u_lobe, u1, u2));
            samples.map(|s| (s.weight * s.eta * s.eta).max_component()).sum::<f64>() / f64::from(count)
        };
        let Lobe::Principled(coated) = principled(MATERIALS[index / per_material]) else { panic!("{name}") };
        let base = Lobe::Principled(Principled { layers: PrincipledLayers { coat: 0.0, ..coated.layers }, ..coated });
        let (mean, of_base) = (reflected(bsdf), reflected(&single(base, bsdf.view)));
        assert!(mean <= of_base.max(1.0) + 3e-3, "{name}: {mean}, of the base alone {of_base}");
        assert!(mean > 0.01, "{name}: {mean}");
    }
}

/// A smooth coat over black mirrors about its own normal: the surface's own, or as its own map bends it.
#[test]
fn smooth_coats_mirror_about_their_own_normals() {
    let lobe = principled("base_color = 0\nmetallic = 0\nspecular = 0\nroughness = 0.5\nclearcoat = 1");
    let view = perturbed_below(30.0, 25.0);
    let own = at_degrees(4.0, 1.0);
    let mirror = |normal: DVec3| 2.0 * view.wo.dot(normal) * normal - view.wo;
    let drawn = |texel: Option<NormalTexel>| single(mapped(lobe, texel), view).sample(0.0, 0.3, 0.4).expect("it reflects");
    let plain = drawn(None);
    assert!((plain.wi - mirror(own)).length() < 1e-12 && (plain.wi - mirror(view.normal())).length() > 0.1, "{plain:?}");
    // About u and v, which are nearly x and y.
    let tangents = Tangents::along(DVec3::new(1.0, 0.2, 0.0), DVec3::Y);
    for scale in [1.0, 0.5, -0.7] {
        let perturbed = tangents.direction(own, LEANING, scale).expect("it has tangents");
        let sample = drawn(leaning(scale));
        assert!((sample.wi - mirror(perturbed)).length() < 1e-12 && perturbed.dot(own) < 0.98, "{sample:?}");
        let fresnel = 0.04 + 0.96 * (1.0 - view.wo.dot(perturbed)).powi(5);
        assert!((sample.weight.r() - fresnel).abs() < 0.02, "all of the light that it reflects: {sample:?} {fresnel}");
    }
}
