//! When two names are one.

use std::borrow::Cow;

use unicode_normalization::{UnicodeNormalization, is_nfc};

use super::lines::trimmed;

/// A name as it is compared: in composed characters (Unicode's NFC), since some programs and file systems take `ö` apart, without blanks around
/// it and with one in place of several.
pub fn canonical(name: &str) -> Cow<'_, str> {
    let name = trimmed(name);
    let single = || !name.contains(char::is_control) && !name.contains("  ");
    if is_nfc(name) && single() {
        return Cow::Borrowed(name);
    }
    let words: Vec<&str> = super::lines::words(name).collect();
    Cow::Owned(words.join(" ").nfc().collect())
}

/// A name as it is compared where upper and lower case do not matter.
pub fn folded(name: &str) -> String {
    canonical(name).to_lowercase().nfc().collect()
}

/// Without quotes around it.
pub fn unquoted(name: &str) -> &str {
    let name = trimmed(name);
    let inner = |quote: char| name.strip_prefix(quote)?.strip_suffix(quote);
    inner('"').or_else(|| inner('\'')).map_or(name, trimmed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn composed_and_decomposed_names_are_one() {
        assert_eq!(canonical("Mo\u{308}bel"), canonical("Möbel"));
        assert_eq!(canonical(" a  b\t"), "a b");
        assert_ne!(canonical("Mobel"), canonical("Möbel"));
        assert_ne!(canonical("Red"), canonical("red"));
        assert_eq!(folded("MO\u{308}BEL"), folded("möbel"));
    }

    #[test]
    fn quotes_go_in_pairs() {
        assert_eq!(unquoted("\"my wood.png\""), "my wood.png");
        assert_eq!(unquoted("'a'"), "a");
        assert_eq!(unquoted("\"a"), "\"a");
        assert_eq!(unquoted("\""), "\"");
    }
}
