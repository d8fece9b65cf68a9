//! Settings of the command line, which override those of the scene.

use clap::Args;
use gpt::render::options::{PARTS_OF_STRATA, fits};
use gpt::scene::Scene;
use gpt::scene::settings::MOST_SAMPLES;

use super::exit::Failure;
use super::setting_flags::SettingFlags;
use super::values::{parse_region, parse_size};

/// Arguments that override the scene's own `[film]` and `[render]`.
#[derive(Debug, Default, Args)]
pub struct EstimateArguments {
    /// Render a part of the samples, from this absolute index on: 0 and 128, with --spp 128 each, together are those of --spp 256; `gpt merge` joins parts
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(..i64::from(MOST_SAMPLES)))]
    pub first_sample: Option<u32>,
    /// Render a region: first column and row, width and height in pixels; `gpt merge` joins regions
    #[arg(long, value_name = "X,Y,W,H", value_parser = parse_region)]
    pub crop: Option<[u32; 4]>,
    /// Width and height in pixels
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<[u32; 2]>,
    #[command(flatten)]
    pub settings: SettingFlags,
}

impl EstimateArguments {
    /// True if the render is a part of a picture, which is joined with others.
    pub fn is_part(&self) -> bool {
        self.first_sample.is_some() || self.crop.is_some()
    }
}

/// Overrides what was given.
///
/// # Errors
/// Combinations that no single flag shows to be wrong, and a scene file's own size that cannot be rendered.
pub fn apply(arguments: &EstimateArguments, scene: &mut Scene) -> Result<(), Failure> {
    apply_to(arguments.size, &arguments.settings, scene)?;
    if let Some(crop) = arguments.crop
        && !fits(crop, scene.film.size)
    {
        let ([x, y, columns, rows], [width, height]) = (crop, scene.film.size);
        return Err(Failure::usage(format!(
            "--crop {x},{y},{columns},{rows}: the region does not lie within the picture of {width}x{height} pixels"
        )));
    }
    let first_sample = arguments.first_sample.unwrap_or(0);
    if first_sample.checked_add(scene.render.spp).is_none_or(|end| end > MOST_SAMPLES) {
        return Err(Failure::usage(format!("--first-sample and the samples per pixel together must stay within {MOST_SAMPLES}")));
    }
    if first_sample > 0 && scene.render.uses_strata() {
        return Err(Failure::usage(format!("--first-sample {first_sample}: {PARTS_OF_STRATA}")));
    }
    Ok(())
}

/// Overrides size and settings, where they are given.
///
/// # Errors
/// The errors of [`check`].
pub fn apply_to(size: Option<[u32; 2]>, settings: &SettingFlags, scene: &mut Scene) -> Result<(), Failure> {
    if let Some(size @ [width, height]) = size {
        scene.film.size = size;
        scene.camera.check_views(size).map_err(|message| Failure::usage(format!("--size {width}x{height}: {message}")))?;
    }
    for setting in &settings.0 {
        setting.apply(&mut scene.render);
    }
    check(scene)
}

/// Checks that the scene can be rendered with its settings and those of the command line together.
///
/// # Errors
/// A usage error that names the setting, for the scene file's own are checked before; and a size that cannot be rendered.
pub fn check(scene: &Scene) -> Result<(), Failure> {
    scene.film.check().map_err(|bad| Failure::BadScene(format!("{}: film.{bad}", scene.name)))?;
    scene.render.check().map_err(|bad| Failure::Usage { message: bad.to_string(), help: bad.help })
}

#[cfg(test)]
mod tests {
    use clap::{Command, FromArgMatches};
    use gpt::scene::{Estimator, RenderSettings};

    use super::*;

    /// The overrides that these arguments of `gpt render` make.
    fn flags(arguments: &str) -> EstimateArguments {
        let command = EstimateArguments::augment_args(Command::new("gpt").no_binary_name(true));
        let matches = command.try_get_matches_from(arguments.split_whitespace()).expect("valid arguments");
        EstimateArguments::from_arg_matches(&matches).expect("valid arguments")
    }

    #[test]
    fn flags_win_and_the_rest_stays() {
        let mut scene = Scene::default();
        apply(&flags("--spp 7 --size 3x4 --estimator bsdf"), &mut scene).unwrap();
        assert_eq!(scene.film.size, [3, 4]);
        assert_eq!(scene.render, RenderSettings { spp: 7, estimator: Estimator::Bsdf, ..RenderSettings::default() });
    }

    #[test]
    fn combinations_that_cannot_be_are_refused() {
        let mut scene = Scene::default();
        scene.render.roulette_depth = 0.into();
        assert!(matches!(apply(&flags("--max-depth 0"), &mut scene), Err(Failure::Usage { .. })));
        let past_the_end = flags(&format!("--first-sample {}", MOST_SAMPLES - 5));
        assert!(matches!(apply(&past_the_end, &mut Scene::default()), Err(Failure::Usage { .. })));
        for stratified in ["--sampler stratified", "--pixel-sampler stratified"] {
            assert!(apply(&flags(stratified), &mut Scene::default()).is_ok());
            let part = flags(&format!("--first-sample 4 {stratified}"));
            assert!(matches!(apply(&part, &mut Scene::default()), Err(Failure::Usage { .. })));
        }
        assert!(matches!(apply(&flags("--size 8x8 --crop 5,0,4,1"), &mut Scene::default()), Err(Failure::Usage { .. })));
        assert!(apply(&flags("--size 8x8 --crop 5,0,3,1"), &mut Scene::default()).is_ok());
        assert!(apply(&flags("--first-sample 4 --sampler quadrant"), &mut Scene::default()).is_ok());
        let mut huge = Scene::default();
        huge.film.size = [100_000, 1];
        assert!(matches!(apply(&EstimateArguments::default(), &mut huge), Err(Failure::BadScene(_))));
    }
}
