//! The container of a file: JSON alone, or the chunks of a binary file.

use serde_json::Value;

/// JSON for people.
pub fn text(root: &Value) -> Vec<u8> {
    format!("{root:#}\n").into_bytes()
}

/// A chunk of JSON and one of data, if there is some.
pub fn binary(root: &Value, data: Vec<u8>) -> Vec<u8> {
    let json = padded(root.to_string().into_bytes(), b' ');
    let data = padded(data, 0);
    let mut chunks = Vec::new();
    for (kind, content) in [(b"JSON", json), (b"BIN\0", data)] {
        if !content.is_empty() {
            chunks.extend((content.len() as u32).to_le_bytes());
            chunks.extend(kind);
            chunks.extend(content);
        }
    }
    let mut file = b"glTF".to_vec();
    file.extend(2_u32.to_le_bytes());
    file.extend((12 + chunks.len() as u32).to_le_bytes());
    file.extend(chunks);
    file
}

fn padded(mut content: Vec<u8>, with: u8) -> Vec<u8> {
    content.resize(content.len().next_multiple_of(4), with);
    content
}

/// A path relative to the file as a URI.
pub fn uri(path: &str) -> String {
    let is_plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let encoded = |byte: u8| if is_plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") };
    path.replace('\\', "/").bytes().map(encoded).collect()
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn chunks_are_whole_words() {
        let file = binary(&json!({ "a": 1 }), vec![1, 2, 3, 4, 5]);
        assert_eq!(&file[..12], [b"glTF".as_slice(), &[2, 0, 0, 0], &(file.len() as u32).to_le_bytes()].concat());
        assert_eq!(&file[12..28], [&[8, 0, 0, 0], b"JSON".as_slice(), b"{\"a\":1} "].concat());
        assert_eq!(&file[28..], [&[8, 0, 0, 0], b"BIN\0".as_slice(), &[1, 2, 3, 4, 5, 0, 0, 0]].concat());
        assert_eq!(binary(&json!({}), Vec::new()).len(), 24, "no empty chunk");
    }

    #[test]
    fn paths_become_uris() {
        assert_eq!(uri("a room.files/ä#1.png"), "a%20room.files/%C3%A4%231.png");
        assert_eq!(uri("../a-b_c.bin"), "../a-b_c.bin");
    }
}
