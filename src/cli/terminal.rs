//! How messages look: colours and line art on a terminal, plain text elsewhere.

use std::io::{self, ErrorKind, IsTerminal, Write};

use gpt::load::printable;
use miette::{GraphicalTheme, MietteHandlerOpts, Report};

use super::exit::Failure;

/// Chooses how errors are drawn. Messages are never wrapped, so that paths in them can be copied and searched for.
pub fn install_error_style() {
    let style = |_: &(dyn miette::Diagnostic + 'static)| error_style();
    // Fails only if a style was chosen before, and this is called once.
    let _ = miette::set_hook(Box::new(style));
}

fn error_style() -> Box<dyn miette::ReportHandler> {
    let options = MietteHandlerOpts::new().wrap_lines(false).terminal_links(false);
    let on_a_terminal = io::stderr().is_terminal();
    Box::new(if on_a_terminal { options } else { options.graphical_theme(GraphicalTheme::none()) }.build())
}

/// Escape sequences of colours.
pub const GREEN: &str = "\x1b[32m";
pub const RED: &str = "\x1b[31m";

/// A text in a colour where stdout is a terminal, unless NO_COLOR asks for none (no-color.org) or the terminal has none.
pub fn coloured(colour: &str, text: &str) -> String {
    let set = |name: &str| std::env::var_os(name).is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|terminal| terminal == "dumb");
    if io::stdout().is_terminal() && !set("NO_COLOR") && !dumb { format!("{colour}{text}\x1b[0m") } else { text.to_owned() }
}

/// Prints one error to stderr.
pub fn print_error(report: Report) {
    let drawn = format!("Error: {report:?}");
    // On a terminal the drawing has colours of its own. What is in an error was made printable where it was made, but for names of files.
    let drawn = if io::stderr().is_terminal() { without_orders(&drawn) } else { printable(&drawn) };
    let _ = writeln!(io::stderr(), "{drawn}");
}

/// The text, with escape sequences that set colours and without any other.
fn without_orders(drawn: &str) -> String {
    let mut pieces = drawn.split('\x1b');
    let mut text = printable(pieces.next().unwrap_or_default());
    for piece in pieces {
        let sets_colours = piece.strip_prefix('[').is_some_and(|rest| {
            rest.trim_start_matches(|letter: char| letter.is_ascii_digit() || letter == ';').starts_with('m')
        });
        text.push(if sets_colours { '\x1b' } else { '␛' });
        text.push_str(&printable(piece));
    }
    text
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

/// As [`answer`], with a value as indented JSON.
///
/// # Errors
/// As [`answer`].
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
    fn errors_set_colours_and_nothing_else() {
        assert_eq!(without_orders("a\x1b[1;31mb\x1b[0m\x1b[2Jc\x1b]0;title\x07\n"), "a\x1b[1;31mb\x1b[0m␛[2Jc␛]0;title␇\n");
    }

    #[test]
    fn large_numbers_get_a_prefix() {
        assert_eq!(with_unit(12.0, "ray"), "12 ray");
        assert_eq!(with_unit(12.0, ""), "12");
        assert_eq!(with_unit(1_500_000.0, ""), "1.50 M");
        assert_eq!(with_unit(2.5e9, "sample/s"), "2.50 Gsample/s");
    }
}
