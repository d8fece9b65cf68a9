//! The container of a file: the JSON alone, or the chunks of a binary file; and the version of glTF.
//!
//! Older writers left paddings out or counted them wrongly, ended the JSON with zeros, or forgot the version. Where nothing else can be meant, the
//! file is read as it is meant.

use serde_json::Value;

use super::json::Asset;

/// The command that makes glTF 2.0 of glTF 1.0.
pub const UPGRADE_COMMAND: &str = "npx gltf-pipeline -i IN -o OUT.glb";
/// Bytes to which chunks of binary files are padded.
const ALIGNMENT: usize = 4;

/// The parts of a file.
pub struct Container<'b> {
    pub json: &'b [u8],
    /// The data that a binary file brings.
    pub binary: Option<Vec<u8>>,
    /// Its oddity, in words.
    pub oddity: Option<String>,
}

/// Takes a file apart. The error is a sentence without the file's name.
pub fn split(bytes: &[u8]) -> Result<Container<'_>, String> {
    if !bytes.starts_with(b"glTF") {
        return Ok(Container { json: trimmed(bytes), binary: None, oddity: None });
    }
    let number = |at: usize| -> Result<usize, String> {
        let word = bytes.get(at..at + 4).ok_or("the file ends early")?;
        Ok(u32::from_le_bytes([word[0], word[1], word[2], word[3]]) as usize)
    };
    match number(4)? {
        2 => {}
        1 => return Err("is binary glTF of version 1, of glTF 1.0; version 2 is read".to_owned()),
        version => return Err(format!("is binary glTF of version {version}; version 2 is read")),
    }
    let stated = number(8)?;
    let mut oddity = (stated != bytes.len()).then(|| format!("it says that it has {stated} bytes, and has {}", bytes.len()));
    let length = number(12)?;
    let end = length.checked_add(20).filter(|end| *end <= bytes.len());
    let end = end.ok_or_else(|| format!("the file ends early: a chunk of {length} bytes begins at byte 12"))?;
    if bytes.get(16..20) != Some(b"JSON") {
        return Err("its first chunk is not JSON".to_owned());
    }
    let json = trimmed(&bytes[20..end]);
    let mut at = end;
    while at + 8 <= bytes.len() {
        let kind = |at: usize| bytes.get(at + 4..at + 8);
        // A length that leaves out the padding is followed by the padding, and then by the next chunk.
        let padded = at.next_multiple_of(ALIGNMENT);
        if kind(at) != Some(b"BIN\0") && kind(padded) == Some(b"BIN\0") {
            at = padded;
        }
        let length = number(at)?;
        let start = at + 8;
        if kind(at) == Some(b"BIN\0") {
            let end = start.saturating_add(length);
            if end > bytes.len() {
                oddity.get_or_insert_with(|| format!("its data end {} bytes early", end - bytes.len()));
            }
            return Ok(Container { json, binary: Some(bytes[start..end.min(bytes.len())].to_vec()), oddity });
        }
        let end = start.checked_add(length).filter(|end| *end <= bytes.len());
        at = end.ok_or_else(|| format!("the file ends early: a chunk of {length} bytes begins at byte {at}"))?;
    }
    Ok(Container { json, binary: None, oddity })
}

/// The JSON without the mark of UTF-8 before it and the blanks and zeros behind it.
fn trimmed(json: &[u8]) -> &[u8] {
    let json = json.strip_prefix(&[0xef, 0xbb, 0xbf]).unwrap_or(json);
    let end = json.iter().rposition(|byte| !byte.is_ascii_whitespace() && *byte != 0).map_or(0, |last| last + 1);
    &json[..end]
}

/// Refuses other versions than the second. The first version's drafts wrote a number, and 1.0 has tables where 2.0 has lists.
///
/// # Errors
/// A sentence without the file's name.
pub fn check_version(asset: &Asset, has_tables: bool) -> Result<(), String> {
    let text = |value: &Value| match value {
        Value::String(text) => text.clone(),
        Value::Number(number) => number.to_string(),
        _ => String::new(),
    };
    let [version, least] = [&asset.version, &asset.min_version].map(|value| value.as_ref().map(text).unwrap_or_default());
    let of_version = |version: &str| format!("is glTF of version {version}; version 2.0 is read");
    if !least.is_empty() && least != "2.0" {
        return Err(of_version(&least));
    }
    match version.split('.').next() {
        Some("2") => Ok(()),
        Some("") | None if has_tables => Err(of_version("1.0, which states none")),
        Some("") | None => Ok(()),
        _ => Err(of_version(&version)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary file of chunks whose lengths are written as they are given.
    fn file(total: usize, json: (&[u8], usize), binary: (&[u8], usize)) -> Vec<u8> {
        let mut bytes = b"glTF".to_vec();
        [2, total, json.1].into_iter().for_each(|number| bytes.extend((number as u32).to_le_bytes()));
        bytes.extend(b"JSON");
        bytes.extend(json.0);
        bytes.extend((binary.1 as u32).to_le_bytes());
        bytes.extend(b"BIN\0");
        bytes.extend(binary.0);
        bytes
    }

    #[test]
    fn chunks_are_found_whatever_became_of_their_padding() {
        let whole = file(40, (b"{}  ", 4), (b"12345678", 8));
        let rows = [
            (whole.clone(), 8, false),
            // The length of the file is 0, or too large.
            (file(0, (b"{}  ", 4), (b"12345678", 8)), 8, true),
            (file(4000, (b"{}  ", 4), (b"12345678", 8)), 8, true),
            // The length leaves out a padding that is there, or there is none.
            (file(40, (b"{}\0\0", 2), (b"12345678", 8)), 8, false),
            (file(38, (b"{}", 2), (b"12345678", 8)), 8, false),
            // The length counts a padding that is not there.
            (file(39, (b"{}  ", 4), (b"1234567", 8)), 7, true),
        ];
        for (index, (bytes, data, is_odd)) in rows.into_iter().enumerate() {
            let found = split(&bytes).unwrap_or_else(|message| panic!("{index}: {message}"));
            assert_eq!((found.json, found.binary.map(|data| data.len())), (&b"{}"[..], Some(data)), "{index}");
            assert_eq!(found.oddity.is_some(), is_odd, "{index}: {:?}", found.oddity);
        }
        assert!(split(&whole[..18]).is_err() && split(&file(40, (b"{}  ", 400), (b"", 0))).is_err());
    }

    #[test]
    fn marks_blanks_and_zeros_around_json_are_left_out() {
        for text in [&b"\xef\xbb\xbf{}"[..], b"{}\0\0\0", b"{} \r\n\0 ", b"{}"] {
            assert_eq!(split(text).ok().map(|found| found.json), Some(&b"{}"[..]));
        }
    }
}
