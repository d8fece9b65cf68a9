//! Messages and answers: coloured on a terminal, plain text elsewhere.

use std::io::{self, ErrorKind, IsTerminal, Write};

use gpt::load::printable;

use super::exit::Failure;
use super::scene_error;

/// Escape sequences of colours.
pub const GREEN: &str = "\x1b[32m";
pub const RED: &str = "\x1b[31m";

/// A text in a colour where stdout has colours.
pub fn coloured(colour: &str, text: &str) -> String {
    if has_colours(&io::stdout()) { format!("{colour}{text}\x1b[0m") } else { text.to_owned() }
}

/// True for a terminal, unless NO_COLOR asks for no colours (no-color.org) or the terminal has none.
fn has_colours(stream: &impl IsTerminal) -> bool {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    stream.is_terminal() && !set("NO_COLOR") && !dumb
}

/// Prints one error to stderr.
pub fn print_error(failure: &Failure) {
    let _ = write!(io::stderr(), "{}", scene_error::drawn(failure, has_colours(&io::stderr())));
}

/// Prints a warning to stderr.
pub fn warn(message: &str) {
    let _ = writeln!(io::stderr(), "warning: {}", printable(message));
}

/// Prints something worth knowing to stderr.
pub fn note(message: &str) {
    let _ = writeln!(io::stderr(), "{}", printable(message));
}

/// Writes a command's answer to stdout. A reader that went away (`| head`) is no failure.
///
/// # Errors
/// Other failures to write, a full disk for example.
pub fn answer(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Failure::Other(format!("cannot write to stdout: {error}"))),
        _ => Ok(()),
    }
}

/// Writes a value as [`answer`] does, as indented JSON.
///
/// # Errors
/// The errors of [`answer`].
pub fn answer_json(value: &impl serde::Serialize) -> Result<(), Failure> {
    let json = serde_json::to_string_pretty(value).map_err(|error| Failure::Other(error.to_string()))?;
    answer(&(json + "\n"))
}

/// Width of the terminal that stderr is, in columns; of others what terminals have by default.
pub fn columns() -> usize {
    terminal_size::terminal_size_of(io::stderr()).map_or(80, |(terminal_size::Width(columns), _)| usize::from(columns))
}

/// A number with three or more digits, a unit prefix where it is large, and its unit: `1.50 Msample/s`.
pub fn with_unit(number: f64, unit: &str) -> String {
    let (scaled, prefix) = match number.abs() {
        large if large >= 1e9 => (number / 1e9, "G"),
        large if large >= 1e6 => (number / 1e6, "M"),
        large if large >= 1e3 => (number / 1e3, "k"),
        _ => return format!("{number:.0} {unit}").trim_end().to_owned(),
    };
    format!("{scaled:.2} {prefix}{unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_numbers_get_a_prefix() {
        assert_eq!(with_unit(12.0, "ray"), "12 ray");
        assert_eq!(with_unit(12.0, ""), "12");
        assert_eq!(with_unit(1_500_000.0, ""), "1.50 M");
        assert_eq!(with_unit(2.5e9, "sample/s"), "2.50 Gsample/s");
    }
}
