//! Text in whatever encoding it comes.

use std::borrow::Cow;

use encoding_rs::{Encoding, UTF_8, UTF_16BE, UTF_16LE, WINDOWS_1252};

/// The encoding a text most likely has: by the mark that it begins with, else UTF-8 where it is valid, UTF-16 where every other byte is 0, and
/// Windows-1252, which any bytes are, in the end.
pub fn of(bytes: &[u8]) -> &'static Encoding {
    if let Some((marked, _)) = Encoding::for_bom(bytes) {
        return marked;
    }
    let start = &bytes[..bytes.len().min(1000) & !1];
    let zeros = |first: usize| start.iter().skip(first).step_by(2).filter(|byte| **byte == 0).count();
    // Most characters of these files are ASCII.
    if zeros(1) > start.len() / 4 && zeros(0) == 0 {
        UTF_16LE
    } else if zeros(0) > start.len() / 4 && zeros(1) == 0 {
        UTF_16BE
    } else if std::str::from_utf8(bytes).is_ok() {
        UTF_8
    } else {
        WINDOWS_1252
    }
}

/// The text, and the name of its encoding where that is not UTF-8.
pub fn decode(bytes: &[u8]) -> (Cow<'_, str>, Option<&'static str>) {
    let encoding = of(bytes);
    let (text, _) = encoding.decode_with_bom_removal(bytes);
    (text, (encoding != UTF_8).then(|| encoding.name()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn encodings_are_recognised() {
        let text = "newmtl Möbel\nKd 1 1 1\n";
        let utf_16 = |to_bytes: fn(u16) -> [u8; 2]| text.encode_utf16().flat_map(to_bytes).collect::<Vec<u8>>();
        let latin: Vec<u8> = text.chars().map(|character| character as u8).collect();
        let marked = [&[0xff, 0xfe][..], &utf_16(u16::to_le_bytes)].concat();
        let rows = [
            (text.as_bytes().to_vec(), None),
            ([&[0xef, 0xbb, 0xbf][..], text.as_bytes()].concat(), None),
            (marked, Some("UTF-16LE")),
            (utf_16(u16::to_le_bytes), Some("UTF-16LE")),
            (utf_16(u16::to_be_bytes), Some("UTF-16BE")),
            (latin, Some("windows-1252")),
        ];
        for (bytes, name) in rows {
            assert_eq!(decode(&bytes), (Cow::Borrowed(text), name));
        }
        assert_eq!(decode(b""), (Cow::Borrowed(""), None));
    }
}
