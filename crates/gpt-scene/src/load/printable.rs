//! Text from files, fit to be printed: without control characters, and no longer than a person reads.

/// Most characters of a message.
const LONGEST: usize = 1000;
/// Most names of a list; where there are hardly more, they are listed too.
const MOST_NAMES: usize = 10;
const HARDLY_MORE: usize = 2;

/// Control characters, which a terminal would obey, as their pictures: the escape character becomes `␛`. Line ends and tabs stay. So do all
/// other characters but those that reverse the direction of what follows.
pub fn printable(text: &str) -> String {
    text.chars().map(printable_character).collect()
}

pub(super) fn printable_character(character: char) -> char {
    match u32::from(character) {
        _ if character == '\n' || character == '\t' => character,
        code @ 0..=0x1f => char::from_u32(0x2400 + code).unwrap_or(char::REPLACEMENT_CHARACTER),
        0x7f => '␡',
        0x80..=0x9f | 0x202a..=0x202e | 0x2066..=0x2069 => char::REPLACEMENT_CHARACTER,
        _ => character,
    }
}

/// The text, without its middle where it is long.
pub(super) fn short(text: &str) -> String {
    let length = text.chars().count();
    if length <= LONGEST {
        return text.to_owned();
    }
    let half = LONGEST / 2;
    let (start, end): (String, String) = (text.chars().take(half).collect(), text.chars().skip(length - half).collect());
    format!("{start} … {end}")
}

/// The names, separated by commas; of many, the first ten and how many more there are.
pub fn short_list<Name: AsRef<str>>(names: &[Name]) -> String {
    let shown = if names.len() <= MOST_NAMES + HARDLY_MORE { names.len() } else { MOST_NAMES };
    let list: Vec<String> = names[..shown].iter().map(|name| short_name(name.as_ref())).collect();
    let list = list.join(", ");
    if shown == names.len() { list } else { format!("{list}, and {} more", names.len() - shown) }
}

/// A name, cut where it is longer than names are.
fn short_name(name: &str) -> String {
    match name.char_indices().nth(80) {
        Some((end, _)) => format!("{}…", &name[..end]),
        None => name.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_terminal_has_nothing_to_obey() {
        assert_eq!(printable("a\x1b[2Jb\x07\r\n\tc\u{9b}31m\u{202e}"), "a␛[2Jb␇␍\n\tc\u{fffd}31m\u{fffd}");
        assert_eq!(printable("Straße 東京"), "Straße 東京");
    }

    #[test]
    fn long_texts_and_lists_are_cut() {
        assert_eq!(short("short"), "short");
        let cut = short(&"ß".repeat(100_000));
        assert!(cut.chars().count() < LONGEST + 10 && cut.contains(" … "));
        let names: Vec<String> = (0..100).map(|name| name.to_string()).collect();
        assert_eq!(short_list(&names), "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, and 90 more");
        assert_eq!(short_list(&names[..12]).matches(',').count(), 11);
        assert_eq!(short_list(&["x".repeat(1000)]).chars().count(), 81);
    }
}
