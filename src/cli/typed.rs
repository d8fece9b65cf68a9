//! The words that were typed, and command lines that say them again to another process: of a plan's chunks, and in hints.
//!
//! They are made from what clap read, whichever arguments there are, so that a new one is passed on without anybody thinking of it.

use std::ffi::{OsStr, OsString};
use std::fmt;

use clap::parser::ValueSource;
use clap::{Arg, ArgMatches, CommandFactory, Error, FromArgMatches};

use super::arguments::Arguments;
use super::shell::quoted;

/// The arguments of a subcommand as they were typed.
#[derive(Debug)]
pub struct Typed {
    known: Vec<Arg>,
    matches: ArgMatches,
}

impl Typed {
    /// Reads a whole command line, the program's name included: what it asks for, and the words in which it does.
    ///
    /// # Errors
    /// Whatever clap has to say, help and the version included.
    pub fn parse(words: impl IntoIterator<Item = OsString>) -> Result<(Arguments, Self), Error> {
        let mut command = Arguments::command();
        let mut matches = command.try_get_matches_from_mut(words)?;
        let arguments = Arguments::from_arg_matches(&matches).map_err(|error| error.format(&mut command))?;
        // Without a subcommand the line above has failed.
        let (name, matches) = matches.remove_subcommand().unwrap_or_default();
        let known = command.find_subcommand(&name).map_or_else(Vec::new, |command| command.get_arguments().cloned().collect());
        Ok((arguments, Self { known, matches }))
    }

    /// Every option that was typed, but for those with these names.
    pub fn options_but(&self, left_out: &[&str]) -> Vec<OsString> {
        self.options(|name| !left_out.contains(&name))
    }

    /// The options with these names, as far as they were typed.
    pub fn options_of(&self, names: &[&str]) -> Vec<OsString> {
        self.options(|name| names.contains(&name))
    }

    fn options(&self, wanted: impl Fn(&str) -> bool) -> Vec<OsString> {
        let was_typed = |argument: &&Arg| {
            let name = argument.get_id().as_str();
            wanted(name) && self.matches.value_source(name) == Some(ValueSource::CommandLine)
        };
        let options = self.known.iter().filter(|argument| !argument.is_positional()).filter(was_typed);
        options.flat_map(|argument| self.words(argument)).collect()
    }

    /// An option with all that it was given.
    fn words(&self, argument: &Arg) -> Vec<OsString> {
        let long = argument.get_long().map(|name| format!("--{name}"));
        let short = argument.get_short().map(|letter| format!("-{letter}"));
        let flag = long.or(short).unwrap_or_default();
        if !argument.get_action().takes_values() {
            return vec![flag.into()];
        }
        let occurrences = self.matches.get_raw_occurrences(argument.get_id().as_str()).into_iter().flatten();
        let joint = argument.get_value_delimiter().unwrap_or(',').to_string();
        let values = occurrences.map(|values| values.collect::<Vec<_>>().join(OsStr::new(&joint)));
        values.flat_map(|value| option(&flag, &value)).collect()
    }
}

/// An option and its value, in two words, or in one where the value would be taken for an option.
fn option(flag: &str, value: &OsStr) -> Vec<OsString> {
    if value.as_encoded_bytes().starts_with(b"-") {
        let mut word = OsString::from(format!("{flag}="));
        word.push(value);
        vec![word]
    } else {
        vec![flag.into(), value.to_owned()]
    }
}

/// A command line of this program for another process.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine(Vec<OsString>);

impl CommandLine {
    /// Begins with the program and its subcommand.
    pub fn new(subcommand: &str) -> Self {
        Self(vec!["gpt".into(), subcommand.into()])
    }

    /// A file, a folder or another argument without a flag.
    pub fn with(mut self, argument: impl AsRef<OsStr>) -> Self {
        let argument = argument.as_ref();
        let mut word = OsString::new();
        // A file's name that begins as an option does is one with its folder.
        if argument.len() > 1 && argument.as_encoded_bytes().starts_with(b"-") {
            word.push("./");
        }
        word.push(argument);
        self.0.push(word);
        self
    }

    pub fn with_option(mut self, flag: &str, value: impl AsRef<OsStr>) -> Self {
        self.0.extend(option(flag, value.as_ref()));
        self
    }

    pub fn with_flag(mut self, flag: &str) -> Self {
        self.0.push(flag.into());
        self
    }

    /// Options that were typed.
    pub fn with_options(mut self, options: Vec<OsString>) -> Self {
        self.0.extend(options);
        self
    }

    /// The words.
    ///
    /// # Errors
    /// One that is no text, and would be another one in a text.
    pub fn words(&self) -> Result<Vec<String>, OsString> {
        self.0.iter().map(|word| word.clone().into_string()).collect()
    }
}

/// A word in the quotation of a POSIX shell.
impl fmt::Display for CommandLine {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let quoted: Vec<String> = self.0.iter().map(|word| quoted(&word.to_string_lossy())).collect();
        f.write_str(&quoted.join(" "))
    }
}

/// A subcommand as clap knows it, for tests that walk through its arguments.
#[cfg(test)]
pub fn subcommand(name: &str) -> clap::Command {
    let mut command = Arguments::command();
    command.build();
    command.find_subcommand(name).expect("there is such a command").clone()
}

#[cfg(test)]
mod tests {
    use clap::{Args, Command};

    use super::super::access_arguments::AccessArguments;
    use super::*;

    /// Values of which each option takes one at least: awkward ones first.
    const VALUES: [&str; 12] =
        ["-a 'b'=$c d", "a 'b' $c", "a b=-c", "a.exr", "2", "3x4", "0.5", "gold", "1,2", "5000", "1,2,3,4", "localhost:1"];

    fn parsed(words: &[&str]) -> Option<Typed> {
        Typed::parse(words.iter().map(OsString::from)).ok().map(|(_, typed)| typed)
    }

    /// The option as it can be typed.
    fn typed(argument: &Arg, before: &[&str]) -> Typed {
        let long = argument.get_long().map(|name| format!("--{name}"));
        let flag = long.or(argument.get_short().map(|letter| format!("-{letter}"))).expect("options have a name");
        let named = argument.get_possible_values().first().map(|value| value.get_name().to_owned());
        let values = named.into_iter().chain(VALUES.map(str::to_owned));
        let with_value = |value: &str| if value.is_empty() { flag.clone() } else { format!("{flag}={value}") };
        let mut tried = std::iter::once(String::new()).chain(values).map(|value| with_value(&value));
        let typed = tried.find_map(|word| parsed(&[before, &[word.as_str()]].concat()));
        typed.unwrap_or_else(|| panic!("{flag} takes none of the values that are tried"))
    }

    /// Every option of every command is said again as it was typed.
    #[test]
    fn every_option_is_passed_on() {
        let begun: [(&str, &[&str]); 4] = [
            ("render", &["gpt", "render", "a.toml", "--view"]),
            ("plan", &["gpt", "plan", "a.toml", "--chunks", "2"]),
            ("verify", &["gpt", "verify", "a.toml", "--pixel", "1,2"]),
            ("test", &["gpt", "test", "scenes"]),
        ];
        for (name, before) in begun {
            for argument in subcommand(name).get_arguments().filter(|argument| !argument.is_positional()) {
                let id = argument.get_id().as_str();
                if ["help", "version"].contains(&id) || before.iter().any(|word| *word == format!("--{id}")) {
                    continue;
                }
                // Some are refused beside others, and need others.
                let first = typed(argument, before);
                let words = first.options_of(&[id]);
                assert!(!words.is_empty(), "{name}: {id} is lost");
                let before = before.iter().map(OsString::from);
                let (_, again) = Typed::parse(before.chain(words.iter().cloned())).unwrap_or_else(|error| panic!("{error}"));
                assert_eq!(again.options_of(&[id]), words, "{name}: {id}");
                assert!(!again.options_but(&[id]).contains(&words[0]), "{name}: {id}");
            }
        }
    }

    /// Options that decide how a scene is read have one name wherever a scene is read.
    #[test]
    fn access_is_said_alike_by_every_command() {
        let access = AccessArguments::augment_args(Command::new("gpt"));
        for name in ["render", "plan", "verify", "check", "import", "export", "measure"] {
            let command = subcommand(name);
            for argument in access.get_arguments() {
                let same = command.get_arguments().find(|one| one.get_id() == argument.get_id()).expect("it is flattened");
                assert_eq!((same.get_long(), same.get_short()), (argument.get_long(), argument.get_short()), "{name}");
            }
        }
    }

    #[test]
    fn values_survive_in_their_order() {
        let before =
            ["gpt", "render", "a.toml", "-D", "b=1 2", "-D", "a=-3", "-D=-x=y", "--camera=-left eye", "--aov", "albedo,normal"];
        let typed = parsed(&before).expect("valid arguments");
        let words = ["-D", "b=1 2", "-D", "a=-3", "-D=-x=y", "--camera=-left eye", "--aov", "albedo,normal"];
        assert_eq!(typed.options_but(&[]), words);
        let line = CommandLine::new("render").with("-odd.toml").with_options(typed.options_but(&["aov"]));
        assert_eq!(line.to_string(), "gpt render ./-odd.toml -D 'b=1 2' -D a=-3 -D=-x=y '--camera=-left eye'");
        assert_eq!(line.words().expect("text").len(), 9);
    }

    #[test]
    fn shells_read_the_words_as_they_are() {
        let line = CommandLine::new("render").with("my scene.toml").with("it's").with_option("--spp", "4").with("");
        assert_eq!(line.to_string(), r"gpt render 'my scene.toml' 'it'\''s' --spp 4 ''");
    }
}
