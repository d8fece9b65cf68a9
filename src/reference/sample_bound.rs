//! How bright a sample of a pixel can be, derived from the scene.
//!
//! A path's radiance is the sum of what it finds, throughput times emission times weight. Let every BSDF's f·|cosθ| be at most `gain` times the
//! density with which it draws directions. Then:
//!
//! - throughput grows by `gain` at most at a surface, and roulette, which keeps a path with a probability of its throughput, raises it to 1 at most
//!   ([`crate::reference::roulette`]);
//! - emission that the path meets counts throughput · Le at most, as weights are at most 1;
//! - a light sample of density p counts throughput · f·|cosθ|·Le·w(p)/p. With q the BSDF's density, f·|cosθ| ≤ gain·q, and the power heuristic of
//!   exponent β has w·q/p = x^(β−1)/(1 + x^β) for x = p/q, at most (β−1)^((β−1)/β)/β: 1 for the balance heuristic, 1/2 for β = 2.
//!
//! So a path of d edges is at most Le · Σ throughput · (1 + samples · gain · share) bright. Where that argument has a gap, there is no bound: lights of
//! no extent, whose light falls off with the squared distance; lobes whose sampling fits only roughly; media, stacks and guides; surfaces that a path
//! passes without an end of its edge, which it may do any number of times.

use std::fmt;

use gpt_scene::scene::texture::{KnownRanges, range_of_texture};

use crate::reference::bsdf::conductor_reflectance;
use crate::reference::roulette;
use crate::sampling::mis::Heuristic;
use crate::scene::{
    BlendWeight, ChannelInput, ColorInput, ConductorFresnel, Environment, EnvironmentRadiance, Estimator, Guiding,
    HemisphereSampling, Light, Material, MaterialId, MaterialKind, MicrofacetDistribution, Microfacets, Scene, Shape,
};
use crate::spectrum::Spectrum;

/// Why samples have no bound, in words that follow "samples have no bound: ".
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unbounded(String);

impl fmt::Display for Unbounded {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(&self.0)
    }
}

fn none<T>(why: impl Into<String>) -> Result<T, Unbounded> {
    Err(Unbounded(why.into()))
}

/// The brightest that a sample can be, channel by channel.
///
/// # Errors
/// Why there is no bound.
pub fn sample_bound(scene: &Scene) -> Result<Spectrum, Unbounded> {
    let settings = &scene.render;
    if settings.clamp > 0.0 {
        return Ok(Spectrum::grey(settings.clamp));
    }
    if settings.max_depth == 0 {
        return none("paths have no greatest depth (max_depth)");
    }
    if settings.guiding != Guiding::Off {
        return none("paths are guided");
    }
    if !scene.media.is_empty() {
        return none("the scene has media");
    }
    let share_of_light_sample = match settings.estimator {
        Estimator::Bsdf => 0.0,
        Estimator::Mis => largest_share(Heuristic::from(settings))?,
        Estimator::Nee | Estimator::Choose => return none("lights are sampled without weights (--estimator)"),
    };
    let light = brightest_light(scene)?;
    let gain = largest_gain(scene)?;
    Ok(light * paths(scene, gain, share_of_light_sample))
}

/// The most that w·q/p can be for a sample of density p, which the other strategy draws with density q.
fn largest_share(heuristic: Heuristic) -> Result<f64, Unbounded> {
    match heuristic {
        Heuristic::Power(beta) if beta < 1.0 => none("the exponent of the heuristic is below 1"),
        Heuristic::Power(beta) => Ok((beta - 1.0).powf((beta - 1.0) / beta) / beta),
        Heuristic::Cutoff(_) => Ok(1.0),
    }
}

/// The sum over the edges of a path of the throughput with which light found there counts.
fn paths(scene: &Scene, gain: f64, share_of_light_sample: f64) -> f64 {
    let settings = &scene.render;
    let first_roulette = settings.first_roulette(false);
    let (mut throughput, mut sum) = (1.0, 0.0);
    for depth in 1..=settings.max_depth {
        sum += throughput;
        if depth == settings.max_depth {
            break;
        }
        let samples = f64::from(settings.light_samples_at(depth));
        sum += throughput * gain * share_of_light_sample * samples;
        throughput *= gain;
        if first_roulette.is_some_and(|first| depth >= first) {
            // Roulette divides by its chance, which is the throughput or the largest that there is.
            throughput = (throughput / roulette::survival(Spectrum::WHITE, depth)).max(1.0);
        }
    }
    sum
}

/// The brightest radiance that any light sends out.
fn brightest_light(scene: &Scene) -> Result<Spectrum, Unbounded> {
    let mut found = Spectrum::BLACK;
    for material in &scene.materials {
        if let Some(emission) = &material.emission {
            found = found.max(brightest(scene, &emission.radiance));
        }
    }
    for light in &scene.lights {
        match light {
            Light::Environment(Environment { radiance: EnvironmentRadiance::Constant(radiance), .. }) => {
                found = found.max(*radiance);
            }
            Light::Environment(Environment { radiance: EnvironmentRadiance::Map(map), .. }) => {
                let colors = map.texels.colors().map(|texel| Spectrum::from_f32(texel.to_array()));
                found = colors.fold(found, Spectrum::max);
            }
            Light::Sky(_) => return none("the scene has a sky"),
            _ => return none("the scene has a light of no extent, as a point, spot or directional light is"),
        }
    }
    Ok(found)
}

/// The most by which f·|cosθ| exceeds the density of a surface's directions.
fn largest_gain(scene: &Scene) -> Result<f64, Unbounded> {
    let of_camera = only_for_camera(scene);
    let lobe = |(id, material): (usize, &Material)| if of_camera[id] { Ok(Lobe::default()) } else { lobe_of(scene, material) };
    let lobes: Vec<Lobe> = scene.materials.iter().enumerate().map(lobe).collect::<Result<_, _>>()?;
    glass_is_closed(scene)?;
    let mut gain = lobes.iter().map(|lobe| lobe.alone).fold(0.0, f64::max);
    for material in scene.materials.iter().filter(|material| material.is_blend()) {
        // Lobe i is drawn with the probability wᵢsᵢ/Σwⱼsⱼ, so its sample counts Σwⱼsⱼ · cᵢ/sᵢ.
        let leaves = leaves_of(scene, material);
        let most = |of: fn(&Lobe) -> f64| leaves.iter().map(|&leaf| of(&lobes[leaf])).fold(0.0, f64::max);
        gain = f64::max(gain, most(|lobe| lobe.weight) * most(|lobe| lobe.excess));
    }
    Ok(gain)
}

/// For each material, true of one that lets paths through and is in nothing but blends that the camera alone sees the other part of. Paths go through
/// such blends without a trace, but for the camera's first ray, which meets the other part.
fn only_for_camera(scene: &Scene) -> Vec<bool> {
    let mut found: Vec<bool> = scene.materials.iter().map(Material::is_nothing).collect();
    for material in &scene.materials {
        match &material.kind {
            MaterialKind::Blend { weight: BlendWeight::Camera, materials: [first, _] } => found[*first] = false,
            _ => material.components().iter().for_each(|&part| found[part] = false),
        }
    }
    let shapes = scene.shapes.iter().chain(scene.groups.iter().flat_map(|group| &group.shapes));
    shapes.flat_map(Shape::materials).for_each(|material| found[material] = false);
    found
}

/// The materials that a blend is made of, at any depth, and that are no blends.
fn leaves_of(scene: &Scene, blend: &Material) -> Vec<MaterialId> {
    let mut is_seen = vec![false; scene.materials.len()];
    let (mut to_visit, mut leaves) = (blend.parts().to_vec(), Vec::new());
    while let Some(id) = to_visit.pop() {
        if std::mem::replace(&mut is_seen[id], true) {
            continue;
        }
        let part = &scene.materials[id];
        if part.is_blend() { to_visit.extend_from_slice(part.parts()) } else { leaves.push(id) }
    }
    leaves
}

/// Bounds of a lobe.
#[derive(Debug, Clone, Copy, Default)]
struct Lobe {
    /// The weight s by which it is chosen among others.
    weight: f64,
    /// The most c that a sample counts that is drawn by it alone.
    alone: f64,
    /// The most of c/s.
    excess: f64,
}

fn lobe_of(scene: &Scene, material: &Material) -> Result<Lobe, Unbounded> {
    let of = |color: &ColorInput| brightest(scene, color).max_component();
    // Their samples count what they are chosen by.
    let plain = |weight: f64| Ok(Lobe { weight, alone: weight, excess: 1.0 });
    let name = &material.name;
    match &material.kind {
        MaterialKind::Diffuse { reflectance } => {
            let times = match scene.render.hemisphere {
                HemisphereSampling::Cosine => 1.0,
                HemisphereSampling::Uniform => 2.0,
            };
            Ok(Lobe { weight: of(reflectance), alone: times * of(reflectance), excess: times })
        }
        MaterialKind::Mirror { reflectance } => plain(of(reflectance)),
        MaterialKind::Conductor { fresnel, facets, specular_reflectance, film: None } if draws_visible(facets) => {
            let along_normal = match fresnel {
                ConductorFresnel::Complex { eta, k } => conductor_reflectance(1.0, *eta, *k),
                ConductorFresnel::Reflectance(ColorInput::Constant(reflectance)) => *reflectance,
                // A texture may be black somewhere; grazing light then outshines the lobe's weight without a bound.
                ConductorFresnel::Reflectance(_) => Spectrum::BLACK,
            };
            let tint = of(specular_reflectance);
            // Metal reflects all light at grazing angles, and is chosen by what it reflects along the normal.
            Ok(Lobe { weight: tint, alone: tint, excess: 1.0 / along_normal.min_component() })
        }
        MaterialKind::Glass { reflectance, transmittance, film: None, dispersion: None, .. } => {
            plain(of(reflectance).max(of(transmittance)))
        }
        MaterialKind::RoughGlass { facets, reflectance, transmittance, film: None, dispersion: None, thin: false, .. }
            if draws_visible(facets) =>
        {
            plain(of(reflectance).max(of(transmittance)))
        }
        MaterialKind::Emissive | MaterialKind::Blend { .. } => Ok(Lobe::default()),
        MaterialKind::Pass => none(format!("paths go through `{name}` as often as they like")),
        other => none(format!("`{name}` is {}, whose samples fit its lobe only roughly", other.type_name())),
    }
}

/// The brightest that a colour is.
fn brightest(scene: &Scene, input: &ColorInput) -> Spectrum {
    let Some(texture) = input.texture() else { return constant(input) };
    let (low, high) = range_of_texture(&scene.textures, texture, None, &mut KnownRanges::default());
    let most = low.abs().max(high.abs());
    let factor = match *input {
        ColorInput::ScaledTexture(_, factor) | ColorInput::Channel(ChannelInput { factor, .. }) => factor,
        _ => Spectrum::WHITE,
    };
    let value = factor * most;
    if input.is_squared() { value * value } else { value }
}

fn constant(input: &ColorInput) -> Spectrum {
    match *input {
        ColorInput::Constant(color) => color,
        _ => Spectrum::BLACK,
    }
}

/// Directions are drawn by the microfacets that are seen, so that a sample counts F·G2/G1 alone.
fn draws_visible(facets: &Microfacets) -> bool {
    facets.distribution != MicrofacetDistribution::Phong
}

/// Radiance within glass is denser by the square of its index. What a path sees of it from without is not: paths that come out went in before. That takes
/// bodies that are closed, and a camera outside of them.
fn glass_is_closed(scene: &Scene) -> Result<(), Unbounded> {
    let is_glass = |material: &Material| {
        matches!(material.kind, MaterialKind::Glass { thin: false, .. } | MaterialKind::RoughGlass { thin: false, .. })
    };
    let of_glass = scene.materials_that(is_glass);
    if of_glass.iter().all(|is_so| !is_so) {
        return Ok(());
    }
    if !scene.instances.is_empty() || scene.shapes.iter().any(|shape| shape.motion.is_some()) || !scene.exposure.is_empty() {
        return none("the scene has glass, and something moves or is an instance");
    }
    let camera = scene.camera.position;
    for shape in scene.shapes.iter().filter(|shape| shape.materials().any(|material| of_glass[material])) {
        if !shape.is_closed() {
            return none(format!("{} is of glass and not closed", shape.label));
        }
        let lens = scene.camera.aperture.as_ref().map_or(0.0, |aperture| aperture.radius);
        let margin = lens + scene.camera.stereo.map_or(0.0, |stereo| 0.5 * stereo.eye_distance);
        let holds = |[low, high]: [glam::DVec3; 2]| camera.cmpge(low - margin).all() && camera.cmple(high + margin).all();
        if shape.bounds().is_none_or(holds) {
            return none(format!("the camera may be within {}, which is of glass", shape.label));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::load::load_toml_str;

    fn scene(rest: &str) -> Scene {
        let text = format!(
            "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\nvfov = 40\n[render]\nmax_depth = 3\nguiding = 'off'\n[[material]]\nname = 'grey'\n\
             type = 'diffuse'\nreflectance = 0.5\n[[shape]]\ntype = 'sphere'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'grey'\n{rest}"
        );
        load_toml_str(&text, "test", std::path::Path::new(".")).unwrap_or_else(|error| panic!("{error}"))
    }

    const LIGHT: &str = "[[light]]\ntype = 'environment'\nradiance = [2, 1, 0.5]\n";

    /// By hand: the camera's edge finds Le; the first surface a light sample of at most 1/2·1/2 Le and, behind a throughput of 1/2, Le again; the second
    /// half of each.
    #[test]
    fn a_diffuse_scene_has_the_bound_of_its_paths() {
        let bound = sample_bound(&scene(LIGHT)).expect("a bound");
        let sum = 1.0 + 0.25 + 0.5 + 0.125 + 0.25;
        assert!((bound.to_rgb()[0] - 2.0 * sum).abs() < 1e-12 && (bound.to_rgb()[2] - 0.5 * sum).abs() < 1e-12, "{bound:?}");
        let mut balance = scene(LIGHT);
        balance.render.heuristic = crate::scene::MisHeuristic::Balance;
        assert!((sample_bound(&balance).expect("a bound").r() - 2.0 * (1.0 + 0.5 + 0.5 + 0.25 + 0.25)).abs() < 1e-12);
        let mut clamped = scene(LIGHT);
        clamped.render.clamp = 3.0;
        assert_eq!(sample_bound(&clamped), Ok(Spectrum::grey(3.0)));
    }

    #[test]
    fn scenes_without_a_bound_say_why() {
        let why = |scene: &Scene| sample_bound(scene).expect_err("no bound").to_string();
        let point = scene("[[light]]\ntype = 'point'\nposition = [0, 3, 0]\nintensity = 1\n");
        assert!(why(&point).contains("no extent"), "{}", why(&point));
        let mut nee = scene(LIGHT);
        nee.render.estimator = Estimator::Nee;
        assert!(why(&nee).contains("--estimator"));
        let mut endless = scene(LIGHT);
        endless.render.max_depth = 0;
        assert!(why(&endless).contains("max_depth"));
        let plastic = scene(&format!("{LIGHT}[[material]]\nname = 'cup'\ntype = 'plastic'\nreflectance = 0.5\n"));
        assert!(why(&plastic).contains("`cup` is plastic"), "{}", why(&plastic));
        let within = "[[material]]\nname = 'glass'\ntype = 'glass'\n[[shape]]\ntype = 'sphere'\ncenter = [0, 0, 5]\nradius = 1\nmaterial = 'glass'\n";
        let inside = scene(&format!("{LIGHT}{within}"));
        assert!(why(&inside).contains("the camera may be within"), "{}", why(&inside));
        let outside = scene(&format!("{LIGHT}{}", within.replace("[0, 0, 5]", "[3, 0, 0]")));
        assert!(sample_bound(&outside).is_ok());
    }
}
