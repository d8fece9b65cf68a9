//! `docs/cli.md`, made from clap's commands.

use std::fmt::Write;

use clap::builder::StyledStr;
use clap::{Arg, Command, CommandFactory};

use crate::cli::arguments::Arguments;

/// The whole page; `remake` is the command that makes it.
pub fn page(remake: &str) -> String {
    let mut program = Arguments::command();
    program.build();
    let mut page = format!("<!-- Made by `{remake}`: change src/cli, not this page. -->\n\n# Command line\n\n");
    let _ = writeln!(page, "{}\n\n```\n{}\n```\n", plain(program.get_about()), usage(&program));
    for command in commands(&program) {
        let _ =
            writeln!(page, "- [`{0}`](#{1}): {2}", name(command), name(command).replace(' ', "-"), plain(command.get_about()));
    }
    let _ = write!(page, "\n{}", block(program.get_after_help()));
    for command in commands(&program) {
        describe(&mut page, command, "##");
    }
    page.truncate(page.trim_end().len());
    page + "\n"
}

fn describe(page: &mut String, command: &Command, heading: &str) {
    let about = command.get_long_about().or(command.get_about());
    let _ = write!(page, "\n{heading} {}\n\n{}\n\n```\n{}\n```\n", name(command), plain(about), usage(command));
    let arguments: Vec<&Arg> = command.get_arguments().filter(|argument| !is_help(argument) && !argument.is_hide_set()).collect();
    let mut headings: Vec<Option<&str>> = Vec::new();
    for argument in &arguments {
        if !headings.contains(&argument.get_help_heading()) {
            headings.push(argument.get_help_heading());
        }
    }
    for heading in headings {
        if let Some(heading) = heading {
            let _ = write!(page, "\n{heading}:\n");
        }
        page.push('\n');
        for argument in arguments.iter().filter(|argument| argument.get_help_heading() == heading) {
            describe_argument(page, argument);
        }
    }
    let after = block(command.get_after_help());
    if !after.is_empty() {
        let _ = write!(page, "\n{after}");
    }
    for command in commands(command) {
        describe(page, command, &format!("{heading}#"));
    }
}

fn describe_argument(page: &mut String, argument: &Arg) {
    let takes_value = argument.get_action().takes_values();
    let defaults: Vec<_> = argument.get_default_values().iter().filter_map(|value| value.to_str()).collect();
    let default = if takes_value && !defaults.is_empty() { format!(" [default: {}]", defaults.join(",")) } else { String::new() };
    let _ = writeln!(page, "- `{}`: {}{default}", spelling(argument), plain(argument.get_long_help().or(argument.get_help())));
    if takes_value {
        for value in argument.get_possible_values() {
            let _ = writeln!(page, "  - `{}`: {}", value.get_name(), plain(value.get_help()));
        }
    }
}

/// The argument as it is typed.
fn spelling(argument: &Arg) -> String {
    let values: Vec<&str> = argument.get_value_names().into_iter().flatten().map(|name| name.as_str()).collect();
    let values = values.join(" ");
    if argument.is_positional() {
        return values;
    }
    let short = argument.get_short().map(|short| format!("-{short}"));
    let flags: Vec<String> = short.into_iter().chain(argument.get_long().map(|long| format!("--{long}"))).collect();
    let flags = flags.join(", ");
    if argument.get_action().takes_values() { format!("{flags} {values}") } else { flags }
}

/// The commands below a command, but for clap's own.
fn commands(command: &Command) -> impl Iterator<Item = &Command> {
    command.get_subcommands().filter(|command| command.get_name() != "help")
}

fn is_help(argument: &Arg) -> bool {
    ["help", "version"].contains(&argument.get_id().as_str())
}

fn name(command: &Command) -> &str {
    command.get_display_name().map_or(command.get_name(), |_| command.get_bin_name().unwrap_or_default())
}

fn usage(command: &Command) -> String {
    let usage = command.clone().render_usage().to_string();
    usage.trim_start_matches("Usage: ").trim_end().to_owned()
}

/// The text without colours and line breaks, but with its paragraphs.
fn plain(text: Option<&StyledStr>) -> String {
    let text = text.map(StyledStr::to_string).unwrap_or_default();
    let paragraphs = text.split("\n\n").map(|paragraph| paragraph.split_whitespace().collect::<Vec<_>>().join(" "));
    paragraphs.collect::<Vec<_>>().join("\n\n")
}

/// The text as it is laid out for a terminal; empty where there is none.
fn block(text: Option<&StyledStr>) -> String {
    text.map_or_else(String::new, |text| format!("```\n{}\n```\n", text.to_string().trim_end()))
}
