//! The gain of a guide: error times cost with it and without it, as guided paths estimate both.

use super::cost::costs;
use super::sum::{Rays, Sum};
use super::tried::{InView, TrialResult, errors_of_guiding};
use crate::reference::integrator::Integrator;
use crate::scene::FEW_PRIMITIVES;

/// Error times cost with the guide that the integrator has, over that without one, by so many pixels.
pub fn loss_with_guide(integrator: &mut Integrator, pixels: u32) -> f64 {
    let (found, estimates) = TrialResult::unguided(integrator, pixels);
    let in_view = InView::new(integrator, pixels);
    let costs = costs(integrator.primitive_count() <= FEW_PRIMITIVES);
    let cost = |rays: Rays, of_guide: f64| (1.0 + of_guide) * rays.path + costs.light_sample * rays.shadow;
    let unguided_rays = estimates.iter().fold(Rays::default(), |sum, estimate| sum.and(estimate.rays));
    let rays = found.rays().times(1.0 / TrialResult::paths(1));
    let [error, unguided_error] = errors_of_guiding(&found, &estimates, &in_view);
    let errors = if unguided_error > 0.0 { error / unguided_error } else { 1.0 };
    errors * cost(rays, costs.guide) / cost(unguided_rays, 0.0)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::super::super::budget::{Budget, Effort};
    use super::super::super::guide;
    use super::super::super::paths::{follow, pixel_of};
    use super::super::trial_path::{Record, TrialPath};
    use super::super::unguided::{UnguidedEstimate, UnguidedRecord};
    use super::*;
    use crate::compare::Moments;
    use crate::load;
    use crate::sampling::Sampling;
    use crate::scene::{Estimator, Guiding, MisHeuristic, NumberOrAuto, RenderSettings, SamplerKind};
    use crate::spectrum::Spectrum;

    /// A room 4 wide whose light comes round the end of a wall, from a lamp of this WIDTH, on glaze and a
    /// mirror too.
    const ROOM: &str = r#"
        film = { size = [32, 24] }
        render = { spp = 1, max_depth = 6, guiding = "on", light_samples = 1 }
        camera = { position = [1.5, 1.2, -1.5], look_at = [-1, 0.8, 0.3], vfov = 60 }
        material = [
            { name = "white", type = "diffuse", reflectance = 0.7 },
            { name = "glaze", type = "plastic", reflectance = [0.6, 0.2, 0.1] },
            { name = "half mirror", type = "blend", materials = ["white", "mirror"], weight = { type = "constant", value = 0.6 } },
            { name = "mirror", type = "mirror" },
            { name = "lamp", type = "emissive", radiance = 10 },
        ]
        shape = [
            { type = "box", min = [-4, 0, -2], max = [2, 2.5, 2], material = "white" },
            { type = "rectangle", corner = [-2, 0, -2], edge_u = [0, 0, 3.5], edge_v = [0, 2.5, 0], material = "white" },
            { type = "sphere", center = [-0.6, 0.5, 0.4], radius = 0.5, material = "glaze" },
            { type = "sphere", center = [0.6, 0.4, 0.9], radius = 0.4, material = "half mirror" },
            { type = "rectangle", corner = [-3.8, 2.45, -1.8], edge_u = [WIDTH, 0, 0], edge_v = [0, 0, WIDTH], material = "lamp" },
        ]
    "#;

    fn guided(width: &str, change: impl Fn(&mut RenderSettings)) -> Integrator {
        let mut scene =
            load::load_toml_str(&ROOM.replace("WIDTH", width), "room", Path::new("")).unwrap_or_else(|error| panic!("{error}"));
        change(&mut scene.render);
        let mut integrator = Integrator::new(&scene).expect("the reference renders it");
        assert!(guide::train(&mut integrator, Budget::new(&scene, Effort::default()), None).guide.is_some());
        integrator
    }

    /// Second moment of the light beyond the first edge, and number of rays, as guided paths estimate them or as
    /// they are.
    fn moments(integrator: &Integrator, seed: u32, value: impl Fn(UnguidedEstimate) -> [f64; 2]) -> [Moments; 2] {
        let settings = &integrator.scene().render;
        let sampling = Sampling { path: SamplerKind::Independent, seed, ..Sampling::from(settings) };
        let mut found = [Moments::default(); 2];
        for path in 0..40_000 {
            let mut watcher = TrialPath::<UnguidedRecord>::new(settings);
            follow(integrator, &sampling, pixel_of(path, integrator.scene().film.size), path, &mut watcher);
            for (moments, value) in found.iter_mut().zip(value(watcher.record.statistics())) {
                moments.push(value);
            }
        }
        found
    }

    /// Guided paths estimate the second moment and the rays of unguided ones.
    #[test]
    fn guided_paths_tell_what_unguided_ones_would_be() {
        let changes: [fn(&mut RenderSettings); 3] = [
            |_| (),
            |render| (render.heuristic, render.light_samples) = (MisHeuristic::Balance, 3.into()),
            |render| (render.estimator, render.roulette_depth) = (Estimator::Bsdf, NumberOrAuto::Number(2)),
        ];
        for change in changes {
            let mut integrator = guided("3", change);
            let with_rays = |moment: Spectrum, rays: Rays| [moment.sum(), rays.path + rays.shadow];
            let estimated = moments(&integrator, 1, |estimate| with_rays(estimate.unguided, estimate.rays));
            integrator.set_guide(None);
            let without = moments(&integrator, 2, |estimate| with_rays(estimate.guided, estimate.rays));
            // The estimate agrees, and does not if it were twice as much, or a tenth more.
            for (which, more) in [(0, 2.0), (1, 1.1)] {
                let [estimated, without] = [&estimated[which], &without[which]];
                let z = |factor: f64| {
                    (factor * estimated.mean() - without.mean())
                        / (factor * estimated.standard_error()).hypot(without.standard_error())
                };
                assert!(z(1.0).abs() < 4.5 && z(more) > 4.5, "{estimated:?} and {without:?}");
            }
        }
    }

    /// A guide pays where light comes through a gap, and not where an emitter lights what is seen.
    #[test]
    fn a_guide_pays_where_light_is_hard_to_find() {
        let behind_a_wall = loss_with_guide(&mut guided("0.2", |_| ()), 256);
        let mut cornell = load::load(Some("cornell")).expect("it is built in");
        (cornell.film.size, cornell.render.guiding) = ([32, 32], Guiding::On);
        let budget = Budget::new(&cornell, Effort::default());
        let mut cornell = Integrator::new(&cornell).expect("the reference renders it");
        assert!(guide::train(&mut cornell, budget, None).guide.is_some());
        let cornell = loss_with_guide(&mut cornell, 256);
        assert!(behind_a_wall < 0.7 && cornell > 1.0, "{behind_a_wall} and {cornell}");
    }
}
