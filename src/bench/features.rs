//! What a feature costs: used, and only compiled in.
//!
//! Every feature is measured in a room beside the same room without it, in turn. *Compiled in* renders the plain room by kernels that hold
//! the feature's code though nothing there needs it: what "a scene compiles only what it uses" saves. *Used* renders a room that has it.

use std::time::Instant;

use serde::Serialize;

use super::interval::{Ratio, Spread};
use super::scenes::Room;
use super::subject::{BenchError, Devices, SceneSubject, Subject};
use crate::gpu::{Device, GpuRenderer};
use crate::plan::{PlanOptions, TraversalChoice};
use crate::renderer::{DeviceChoice, Observer, RenderError, RenderRequest, Renderer};
use crate::scene::Scene;

/// A feature, where it is used, and the switches that compile it.
pub struct Feature {
    pub name: &'static str,
    room: Room,
    /// Empty where nothing but use brings it in.
    switches: &'static [&'static str],
    /// It needs the hierarchy: the plain room is then measured with one as well. What does not move may still stand outside of it, where few
    /// shapes are faster, so that the two differ by more than the feature.
    hierarchy: bool,
}

const TEXTURE: &str = "type = \"diffuse\"\nreflectance = { texture = \"pattern\" }";

/// All that are measured.
pub fn features() -> Vec<Feature> {
    let material =
        |name, material, switches| Feature { name, room: Room { material, ..Room::default() }, switches, hierarchy: false };
    let textured = |name, more, switches| Feature {
        name,
        room: Room { material: TEXTURE, more, ..Room::default() },
        switches,
        hierarchy: false,
    };
    let with = |name, room, switches| Feature { name, room, switches, hierarchy: false };
    let plain = Room::default;
    vec![
        material("mirror", "type = \"mirror\"\nreflectance = 0.9", &["MIRROR"]),
        material("glass", "type = \"glass\"\nior = 1.5", &["GLASS"]),
        material("glossy", "type = \"glossy\"\nreflectance = 0.7\nexponent = 50", &["GLOSSY", "ROUGHNESS"]),
        material("phong", "type = \"phong\"\ndiffuse = 0.4\nspecular = 0.4\nexponent = 50", &["COLOR1", "PHONG", "ROUGHNESS"]),
        material("conductor", "type = \"conductor\"\nreflectance = 0.9\nroughness = 0.4", &["CONDUCTOR", "ROUGHNESS"]),
        material(
            "rough glass",
            "type = \"rough_glass\"\nior = 1.5\nroughness = 0.4",
            &["COLOR1", "NON_DELTA_TRANSMISSION", "ROUGHNESS", "ROUGH_GLASS"],
        ),
        with(
            "blend of two lobes",
            Room {
                material: "type = \"blend\"\nmaterials = [\"white\", \"shine\"]\nweight = { type = \"fresnel\", ior = 1.5 }",
                more: "[[material]]\nname = \"shine\"\ntype = \"mirror\"\nreflectance = 1",
                ..plain()
            },
            &["BLENDS", "MIRROR", "MIXTURE", "MORE_LOBES"],
        ),
        textured(
            "checker texture",
            "[[texture]]\nname = \"pattern\"\ntype = \"checker\"\na = 0.2\nb = 0.8\nscale = [4, 4]",
            &["CHECKERS", "PROCEDURAL_TEXTURES", "TEXTURES"],
        ),
        textured(
            "perlin texture",
            "[[texture]]\nname = \"pattern\"\ntype = \"perlin\"\na = 0.2\nb = 0.8\nscale = 4\noctaves = 4",
            &["PERLIN", "PROCEDURAL_TEXTURES", "TEXTURES"],
        ),
        textured(
            "worley texture",
            "[[texture]]\nname = \"pattern\"\ntype = \"worley\"\na = 0.2\nb = 0.8\nscale = 4",
            &["PROCEDURAL_TEXTURES", "TEXTURES", "WORLEY"],
        ),
        with(
            "sphere",
            Room { object: "type = \"sphere\"\ncenter = [-0.5, 0.7, -0.4]\nradius = 0.6\nmaterial = \"subject\"", ..plain() },
            &["SPHERES"],
        ),
        with(
            "point light",
            Room { more: "[[light]]\ntype = \"point\"\nposition = [0, 1.8, 1]\nintensity = 1", ..plain() },
            &["POINT_LIGHT"],
        ),
        with(
            "spot light",
            Room {
                more: "[[light]]\ntype = \"spot\"\nposition = [0, 1.8, 1]\ndirection = [0, -1, -0.5]\nintensity = 1\nangle = 40",
                ..plain()
            },
            &["SPOT_LIGHT"],
        ),
        with(
            "sky",
            Room {
                more: "[[light]]\ntype = \"sky\"\nzenith = [0.4, 0.7, 1.6]\nhorizon = [1.5, 1.4, 1.2]\nground = [0.2, 0.2, 0.15]",
                ..plain()
            },
            &["ENVIRONMENT", "SKY"],
        ),
        with(
            "lens",
            Room { camera: "aperture = { shape = \"disk\", radius = 0.05 }\nfocus_distance = 4.4", ..plain() },
            &["LENS"],
        ),
        with(
            "gaussian filter",
            Room { film: "filter = { type = \"gaussian\", radius = 1.5 }", ..plain() },
            // A box sampled as another filter's curve is another picture.
            &[],
        ),
        with("halton sampler", Room { render: "sampler = \"halton\"", ..plain() }, &[]),
        with("independent sampler", Room { render: "sampler = \"independent\"", ..plain() }, &[]),
        Feature {
            name: "motion",
            room: Room {
                camera: "shutter = [0, 1]",
                object: "type = \"box\"\nmin = [-0.9, 0, -0.8]\nmax = [-0.1, 1.3, 0]\nmaterial = \"subject\"\n\
                         motion = [{ translate = [0.1, 0.1, 0] }]",
                ..plain()
            },
            switches: &["ATTRIBUTES", "MOTION"],
            hierarchy: true,
        },
    ]
}

/// What is wanted.
#[derive(Debug, Clone)]
pub struct FeatureOptions {
    pub device: DeviceChoice,
    pub size: [u32; 2],
    pub spp: u32,
    /// Measured rounds, after one that is thrown away.
    pub rounds: u32,
}

/// One way of rendering a feature's room.
#[derive(Debug, Clone, Serialize)]
pub struct Variant {
    pub seconds: Spread,
    /// To one sample of every pixel, the driver's compiler included; a driver that keeps kernels answers from what it kept.
    pub first_picture_seconds: f64,
    pub rays_per_sample: f64,
    /// Time over that of the plain room, run by run.
    pub time: Ratio,
}

/// What one feature costs.
#[derive(Debug, Clone, Serialize)]
pub struct FeatureCost {
    pub feature: String,
    pub switches: Vec<&'static str>,
    pub off: Variant,
    /// None where nothing but use compiles it.
    pub compiled_in: Option<Variant>,
    pub used: Variant,
    /// The plain room came out the same with the feature compiled in as without, but for rounding.
    pub compiled_in_agrees: Option<bool>,
}

/// Measures one feature.
///
/// # Errors
/// What the device reports, and [`BenchError::Interrupted`].
pub fn measure(
    feature: &Feature,
    options: &FeatureOptions,
    devices: &mut Devices,
    observer: &dyn Observer,
) -> Result<FeatureCost, BenchError> {
    let Some(device) = devices.get(&options.device)? else {
        let message = "only a GPU's kernels leave out what a scene does not use; there is no adapter";
        return Err(RenderError::NoDevice(message.to_owned()).into());
    };
    let sized = |room: &Room| -> Result<Scene, BenchError> {
        let mut scene = room.scene()?;
        scene.film.size = options.size;
        Ok(scene)
    };
    let (plain, with) = (sized(&Room::default())?, sized(&feature.room)?);
    let plan = |switches: &[&'static str]| PlanOptions {
        traversal: if feature.hierarchy { TraversalChoice::Bvh } else { TraversalChoice::Auto },
        compile_in: switches.to_vec(),
        ..PlanOptions::default()
    };
    let mut candidates = vec![Candidate::new(&device, &plain, &plan(&[]), observer)?];
    if !feature.switches.is_empty() {
        candidates.push(Candidate::new(&device, &plain, &plan(feature.switches), observer)?);
    }
    candidates.push(Candidate::new(&device, &with, &plan(&[]), observer)?);
    for round in 0..=options.rounds {
        for turn in 0..candidates.len() {
            let index = (turn + round as usize) % candidates.len();
            candidates[index].run(options.spp, round > 0)?;
        }
    }
    let compiled_in_agrees = (candidates.len() == 3).then(|| agree(&candidates[0].pixels, &candidates[1].pixels));
    let first: Vec<f64> = candidates[0].seconds.clone();
    let mut variants = candidates.into_iter().map(|candidate| candidate.finish(&first));
    let missing = || BenchError::Internal("a variant was not measured".to_owned());
    let off = variants.next().ok_or_else(missing)?;
    let used = variants.next_back().ok_or_else(missing)?;
    Ok(FeatureCost {
        feature: feature.name.to_owned(),
        switches: feature.switches.to_vec(),
        off,
        compiled_in: variants.next(),
        used,
        compiled_in_agrees,
    })
}

/// A room made ready, and its runs.
struct Candidate<'a> {
    subject: SceneSubject<'a>,
    first_picture_seconds: f64,
    seconds: Vec<f64>,
    rays_per_sample: f64,
    pixels: Vec<[f32; 3]>,
}

impl<'a> Candidate<'a> {
    fn new(device: &Device, scene: &Scene, plan: &PlanOptions, observer: &'a dyn Observer) -> Result<Self, BenchError> {
        let start = Instant::now();
        let mut renderer = GpuRenderer::on(device, scene, plan)?;
        renderer.render(&RenderRequest { rows: 0..scene.film.size[1], samples: 0..1 }, observer, &mut |_| Ok(()))?;
        Ok(Self {
            first_picture_seconds: start.elapsed().as_secs_f64(),
            subject: SceneSubject { renderer: Box::new(renderer), size: scene.film.size, observer },
            seconds: Vec::new(),
            rays_per_sample: f64::NAN,
            pixels: Vec::new(),
        })
    }

    fn run(&mut self, spp: u32, counts: bool) -> Result<(), BenchError> {
        let run = self.subject.render(1, spp)?;
        self.rays_per_sample = run.rays as f64 / run.samples as f64;
        self.pixels = run.picture.pixels;
        if counts {
            self.seconds.push(run.seconds);
        }
        Ok(())
    }

    fn finish(self, off: &[f64]) -> Variant {
        Variant {
            seconds: Spread::of(&self.seconds),
            first_picture_seconds: self.first_picture_seconds,
            rays_per_sample: self.rays_per_sample,
            time: Ratio::of_pairs(self.seconds.iter().copied().zip(off.iter().copied())),
        }
    }
}

/// Other code may round otherwise, which moves a path here and there; a feature that does something it should not moves most pixels.
fn agree(one: &[[f32; 3]], other: &[[f32; 3]]) -> bool {
    let close = |(a, b): (&[f32; 3], &[f32; 3])| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= 1e-3 * a.abs().max(0.1));
    let same = one.iter().zip(other).filter(|pair| close(*pair)).count();
    same as f64 >= 0.98 * one.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::packed::PackedScene;
    use crate::plan::{DeviceLimits, Plan};
    use crate::shader::switches;

    /// A feature's room brings in the switches that are compiled in for it, and the plain room does not.
    #[test]
    fn rooms_use_what_they_are_named_for() {
        let enabled = |room: &Room, feature: &Feature| {
            let scene = room.scene().unwrap();
            let packed = PackedScene::new(&scene).unwrap();
            let traversal = if feature.hierarchy { TraversalChoice::Bvh } else { TraversalChoice::Auto };
            let options = PlanOptions { traversal, ..PlanOptions::default() };
            Plan::new(&scene, &packed, &DeviceLimits::default(), &options).unwrap().switches.enabled
        };
        for feature in features() {
            let [off, used] = [&Room::default(), &feature.room].map(|room| enabled(room, &feature));
            for switch in feature.switches {
                assert!(switches::find(switch).is_some(), "{}: there is no switch {switch}", feature.name);
                assert!(used.contains(switch), "{}: its room does not need {switch}: {used:?}", feature.name);
            }
            assert!(feature.switches.iter().any(|switch| !off.contains(switch)) || feature.switches.is_empty());
        }
    }

    /// The check of the pictures lets rounding pass and nothing else.
    #[test]
    fn a_picture_that_changes_is_told_from_rounding() {
        let pixels = vec![[0.5, 0.2, 0.1]; 1000];
        let mut rounded = pixels.clone();
        rounded[7] = [0.9; 3];
        rounded.iter_mut().for_each(|pixel| pixel[0] *= 1.0 + 1e-6);
        assert!(agree(&pixels, &rounded));
        let darker: Vec<[f32; 3]> = pixels.iter().map(|pixel| pixel.map(|value| 0.99 * value)).collect();
        assert!(!agree(&pixels, &darker));
    }
}
