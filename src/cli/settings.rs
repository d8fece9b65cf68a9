//! The flags of the table of settings, and what they put over the scene's own.

use clap::builder::{RangedU64ValueParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};
use gpt::scene::Scene;
use gpt::scene::settings::{Assignment, MOST_SAMPLES, SETTINGS, Setting, Values};

use super::arguments::EstimateArguments;
use super::choice::{help, names};
use super::exit::Failure;

/// A flag for each setting; what is given overrides the scene's `[render]`.
#[derive(Debug, Clone, Default)]
pub struct SettingFlags(pub Vec<Assignment>);

impl Args for SettingFlags {
    fn augment_args(command: Command) -> Command {
        let heading = "How the picture is estimated (default: what the scene says; in brackets, where it says nothing)";
        let flags = SETTINGS.iter().map(|setting| {
            let sentences = format!("{} [{}]", help(setting.help()), setting.default());
            flag(setting).value_name(setting.placeholder).help(sentences).help_heading(heading)
        });
        command.args(flags)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for SettingFlags {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        Ok(Self(SETTINGS.iter().flat_map(|setting| given(matches, setting)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

/// Flags that take several values of a setting, for the settings that `gpt bench convergence` compares.
#[derive(Debug, Clone, Default)]
pub struct SettingAxes(pub Vec<Vec<Assignment>>);

impl Args for SettingAxes {
    fn augment_args(command: Command) -> Command {
        let flags = SETTINGS.iter().filter(|setting| setting.compared).map(|setting| {
            let several = format!("{},…", setting.placeholder);
            flag(setting).value_name(several).help(help(setting.help())).value_delimiter(',').action(ArgAction::Append)
        });
        command.args(flags)
    }

    fn augment_args_for_update(command: Command) -> Command {
        Self::augment_args(command)
    }
}

impl FromArgMatches for SettingAxes {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, Error> {
        let compared = SETTINGS.iter().filter(|setting| setting.compared);
        Ok(Self(compared.map(|setting| given(matches, setting)).collect()))
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

fn flag(setting: &'static Setting) -> Arg {
    let parser = match setting.values {
        Values::Whole(least, most) => {
            let numbers = RangedU64ValueParser::<u32>::new().range(u64::from(least)..=u64::from(most));
            ValueParser::from(numbers.try_map(|number| setting.number(number.into())))
        }
        Values::Names(choices) => ValueParser::from(names(choices).try_map(|name| setting.name(&name))),
    };
    Arg::new(setting.name).long(setting.flag.trim_start_matches("--")).value_parser(parser)
}

/// The values that are given for the setting.
fn given(matches: &ArgMatches, setting: &Setting) -> Vec<Assignment> {
    matches.get_many(setting.name).into_iter().flatten().copied().collect()
}

/// Overrides what was given.
///
/// # Errors
/// Combinations that no single flag shows to be wrong, and a scene file's own size that cannot be rendered.
pub fn apply(arguments: &EstimateArguments, scene: &mut Scene) -> Result<(), Failure> {
    if let Some(size) = arguments.size {
        scene.film.size = size;
    }
    for setting in &arguments.settings.0 {
        setting.apply(&mut scene.render);
    }
    check(scene)?;
    if arguments.first_sample.checked_add(scene.render.spp).is_none_or(|end| end > MOST_SAMPLES) {
        return Err(Failure::usage(format!("--first-sample and the samples per pixel together must stay within {MOST_SAMPLES}")));
    }
    Ok(())
}

/// Whether the scene can be rendered with its settings and the command line's together.
///
/// # Errors
/// A usage error that names the setting, for the scene file's own are checked before; and a size that cannot be rendered.
pub fn check(scene: &Scene) -> Result<(), Failure> {
    scene.film.check().map_err(|bad| Failure::BadScene(format!("{}: film.{bad}", scene.name)))?;
    scene.render.check().map_err(|bad| Failure::Usage { message: bad.to_string(), help: bad.help })
}

#[cfg(test)]
mod tests {
    use gpt::scene::{Estimator, RenderSettings};

    use super::*;

    /// What these arguments of `gpt render` override.
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
    fn every_setting_has_a_flag() {
        for setting in SETTINGS {
            let value = match setting.values {
                Values::Whole(least, _) => (least + 1).to_string(),
                Values::Names(names) => names[1].name.to_owned(),
            };
            let given = flags(&format!("{} {value}", setting.flag)).settings.0;
            let found: Vec<_> = given.iter().map(|one| (one.setting().name, one.value().to_string())).collect();
            assert_eq!(found, [(setting.name, value)]);
        }
    }

    #[test]
    fn combinations_that_cannot_be_are_refused() {
        let mut scene = Scene::default();
        scene.render.roulette_depth = 0;
        assert!(matches!(apply(&flags("--max-depth 0"), &mut scene), Err(Failure::Usage { .. })));
        let past_the_end = flags(&format!("--first-sample {}", MOST_SAMPLES - 5));
        assert!(matches!(apply(&past_the_end, &mut Scene::default()), Err(Failure::Usage { .. })));
        let mut huge = Scene::default();
        huge.film.size = [100_000, 1];
        assert!(matches!(apply(&EstimateArguments::default(), &mut huge), Err(Failure::BadScene(_))));
    }
}
