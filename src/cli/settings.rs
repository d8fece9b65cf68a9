//! The command line's wishes put over the scene's own settings.

use gpt::scene::Scene;

use super::arguments::{EstimateArguments, MAX_SAMPLES, check_size};
use super::exit::Failure;

/// Overrides what was given.
///
/// # Errors
/// Combinations that no single flag shows to be wrong, and a scene file's own size that cannot be rendered.
pub fn apply(arguments: &EstimateArguments, scene: &mut Scene) -> Result<(), Failure> {
    if let Some(size) = arguments.size {
        scene.film.size = size;
    }
    check_size(scene.film.size).map_err(|what| Failure::BadScene(format!("{}: film size: {what}", scene.name)))?;

    let render = &mut scene.render;
    set(&mut render.spp, arguments.spp);
    set(&mut render.max_depth, arguments.max_depth);
    set(&mut render.sampler, arguments.sampler);
    set(&mut render.estimator, arguments.estimator);
    set(&mut render.heuristic, arguments.heuristic);
    set(&mut render.seed, arguments.seed);
    set(&mut render.hemisphere, arguments.hemisphere);
    set(&mut render.light_sampling, arguments.light_sampling);
    set(&mut render.light_samples, arguments.light_samples);
    set(&mut render.light_samples_depth, arguments.light_samples_depth);
    set(&mut render.pixel_sampler, arguments.pixel_sampler.map(Into::into));
    set(&mut render.blend, arguments.blend);

    if arguments.first_sample.checked_add(render.spp).is_none_or(|end| end > MAX_SAMPLES) {
        return Err(Failure::usage(format!("--first-sample and the samples per pixel together must stay within {MAX_SAMPLES}")));
    }
    if arguments.max_depth == Some(0) && render.roulette_depth == 0 {
        let message = "`--max-depth 0` never ends a path, because the scene's roulette_depth is 0";
        return Err(Failure::usage(message));
    }
    Ok(())
}

fn set<T>(setting: &mut T, value: Option<T>) {
    if let Some(value) = value {
        *setting = value;
    }
}

#[cfg(test)]
mod tests {
    use gpt::scene::Estimator;

    use super::*;

    #[test]
    fn flags_win_and_the_rest_stays() {
        let mut scene = Scene::default();
        let arguments = EstimateArguments {
            spp: Some(7),
            size: Some([3, 4]),
            estimator: Some(Estimator::Bsdf),
            ..EstimateArguments::default()
        };
        apply(&arguments, &mut scene).unwrap();
        assert_eq!((scene.render.spp, scene.film.size, scene.render.estimator), (7, [3, 4], Estimator::Bsdf));
        assert_eq!(scene.render.max_depth, Scene::default().render.max_depth);
    }

    #[test]
    fn combinations_that_cannot_be_are_refused() {
        let mut scene = Scene::default();
        scene.render.roulette_depth = 0;
        let endless = EstimateArguments { max_depth: Some(0), ..EstimateArguments::default() };
        assert!(matches!(apply(&endless, &mut scene), Err(Failure::Usage { .. })));
        let past_the_end = EstimateArguments { first_sample: MAX_SAMPLES - 5, ..EstimateArguments::default() };
        assert!(matches!(apply(&past_the_end, &mut Scene::default()), Err(Failure::Usage { .. })));
        let mut huge = Scene::default();
        huge.film.size = [100_000, 1];
        assert!(matches!(apply(&EstimateArguments::default(), &mut huge), Err(Failure::BadScene(_))));
    }
}
