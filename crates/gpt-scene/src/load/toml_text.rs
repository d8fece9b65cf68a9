//! Values and tables as the text of scene files, whoever writes them. Numbers come back bit for bit.

use std::fmt::Write as _;

/// Whole numbers below this are written without a point: all of them are exact.
const LARGEST_WHOLE: f64 = 1e15;

/// In the fewest digits that mean this number.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        // TOML writes it so, and reading then says where it is out of range.
        return "nan".to_owned();
    }
    let is_whole = value.fract() == 0.0 && value.abs() < LARGEST_WHOLE && !(value == 0.0 && value.is_sign_negative());
    if is_whole { format!("{value:.0}") } else { format!("{value:?}") }
}

/// Text in quotes, on one line.
pub fn text(value: &str) -> String {
    let mut quoted = String::from('"');
    for character in value.chars() {
        match character {
            '"' => quoted.push_str("\\\""),
            '\\' => quoted.push_str("\\\\"),
            control if control.is_control() => {
                // Writing to a text cannot fail.
                let _ = write!(quoted, "\\u{:04X}", u32::from(control));
            }
            other => quoted.push(other),
        }
    }
    quoted.push('"');
    quoted
}

/// Values, already written, as a list.
pub fn list(values: impl IntoIterator<Item = String>) -> String {
    format!("[{}]", values.into_iter().collect::<Vec<_>>().join(", "))
}

/// Keys with their values, already written, as a table within a line.
pub fn table<K: AsRef<str>>(entries: impl IntoIterator<Item = (K, String)>) -> String {
    let entries = entries.into_iter().map(|(key, value)| format!("{} = {value}", key.as_ref()));
    format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
}

/// `key = value` on a line.
pub fn line(key: &str, value: &str) -> String {
    format!("{key} = {value}\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(value: &str) -> toml::Value {
        toml::from_str::<toml::Table>(&line("x", value)).expect("it is TOML")["x"].clone()
    }

    #[test]
    fn numbers_come_back() {
        let numbers = [0.0, -0.0, 1.0, -17.0, 0.1, 1.0 / 3.0, 1e15, 1e18, 1e-18, 1e300, 1e-300, 123_456_789_012.0];
        let others = [f64::MIN_POSITIVE, f64::MAX, 2.0_f64.sqrt(), 123_456_789.123_456_79, f64::INFINITY, f64::NEG_INFINITY];
        for value in numbers.into_iter().chain(others) {
            let read = read(&number(value));
            let read = read.as_float().or(read.as_integer().map(|whole| whole as f64)).expect("a number");
            assert_eq!(read.to_bits(), value.to_bits(), "{value:?} as {}", number(value));
        }
        assert_eq!([number(2.0), number(0.5), number(f64::NAN), number(f64::INFINITY)], ["2", "0.5", "nan", "inf"]);
    }

    #[test]
    fn texts_lists_and_tables_come_back() {
        for name in ["plain", "a \"b\"", "back\\slash", "line\nbreak", "küche 厨房", "\u{7f}\u{1}\u{9f}", "'''", ""] {
            let written = table([("a", text(name)), ("b", list([text(name), number(1.5)]))]);
            assert!(!written.contains('\n'), "{written}");
            let read = read(&written);
            assert_eq!((read["a"].as_str(), read["b"][0].as_str()), (Some(name), Some(name)));
            assert_eq!(read["b"][1].as_float(), Some(1.5));
        }
    }
}
