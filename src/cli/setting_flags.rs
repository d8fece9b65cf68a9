//! The flags of the table of settings.

use clap::builder::{RangedU64ValueParser, StringValueParser, TypedValueParser, ValueParser};
use clap::{Arg, ArgAction, ArgMatches, Args, Command, Error, FromArgMatches};
use gpt::scene::settings::{Assignment, SETTINGS, Setting, Values};

use super::choice::{help, names};

/// A flag for each setting; what is given overrides the scene's `[render]`.
#[derive(Debug, Clone, Default)]
pub struct SettingFlags(pub Vec<Assignment>);

impl Args for SettingFlags {
    fn augment_args(command: Command) -> Command {
        let ordinary = "How the picture is estimated (default: what the scene says; in brackets, where it says nothing)";
        let study = "Study: settings that are there to compare strategies";
        let flags = SETTINGS.iter().map(|setting| {
            let sentences = format!("{} [{}]", help(setting.help()), setting.default());
            let heading = if setting.study { study } else { ordinary };
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
        Values::Real(..) | Values::WholeOr(..) => {
            let value = |text: String| setting.text(&text).map_err(|expected| format!("expected {expected}"));
            ValueParser::from(StringValueParser::new().try_map(value))
        }
        Values::Names(choices) => ValueParser::from(names(choices).try_map(|name| setting.name(&name))),
    };
    Arg::new(setting.name).long(setting.flag.trim_start_matches("--")).value_parser(parser)
}

/// The values that are given for the setting.
fn given(matches: &ArgMatches, setting: &Setting) -> Vec<Assignment> {
    matches.get_many(setting.name).into_iter().flatten().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn matches<A: Args>(arguments: &[&str]) -> A {
        let command = A::augment_args(Command::new("gpt").no_binary_name(true));
        let matches = command.try_get_matches_from(arguments).expect("valid arguments");
        A::from_arg_matches(&matches).expect("valid arguments")
    }

    /// Two values that the setting may have, as they are typed.
    fn two_values(setting: &Setting) -> [String; 2] {
        match setting.values {
            Values::Whole(least, _) => [(least + 1).to_string(), least.to_string()],
            Values::WholeOr(least, _, name) => [(least + 1).to_string(), name.name.to_owned()],
            Values::Real(least, _) => [(least + 0.5).to_string(), least.to_string()],
            Values::Names(names) => [names[1].name.to_owned(), names[0].name.to_owned()],
        }
    }

    fn given_settings(assignments: &[Assignment]) -> Vec<(&str, String)> {
        assignments.iter().map(|one| (one.setting().name, one.value().to_string())).collect()
    }

    #[test]
    fn every_setting_has_a_flag() {
        for setting in SETTINGS {
            let [value, _] = two_values(setting);
            let SettingFlags(given) = matches(&[setting.flag, &value]);
            assert_eq!(given_settings(&given), [(setting.name, value)]);
        }
    }

    #[test]
    fn every_setting_that_can_be_compared_takes_several_values() {
        for setting in SETTINGS.iter().filter(|setting| setting.compared) {
            let [first, second] = two_values(setting);
            let SettingAxes(axes) = matches(&[setting.flag, &format!("{first},{second}")]);
            assert_eq!(given_settings(&axes.concat()), [(setting.name, first), (setting.name, second)]);
        }
    }
}
