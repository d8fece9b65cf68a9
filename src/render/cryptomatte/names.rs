//! Names of what mattes are of, and the identifiers that they are hashed to.

use std::collections::BTreeMap;

/// The names of a scene's objects or materials, in its order, and their identifiers.
pub(super) struct Names {
    ids: Vec<u32>,
    manifest: BTreeMap<String, u32>,
}

impl Names {
    pub(super) fn of<'a>(names: impl Iterator<Item = &'a str>) -> Self {
        let (mut ids, mut manifest) = (Vec::new(), BTreeMap::new());
        for name in names {
            let id = identifier(name);
            ids.push(id);
            manifest.insert(name.to_owned(), id);
        }
        Self { ids, manifest }
    }

    /// The identifier of the scene's object or material of this number, as the bits of a number in single precision.
    pub(super) fn id(&self, number: usize) -> u32 {
        self.ids.get(number).copied().unwrap_or(0)
    }

    /// The header's entries of a layer of this name.
    pub(super) fn notes(&self, layer: &str) -> Vec<(String, String)> {
        // Seven digits of the hash of its name tell a layer from the others.
        let key = format!("{:08x}", murmur3(layer.as_bytes()));
        let entry = |what: &str, text: &str| (format!("cryptomatte/{}/{what}", &key[..7]), text.to_owned());
        let ids: BTreeMap<&str, String> = self.manifest.iter().map(|(name, id)| (name.as_str(), format!("{id:08x}"))).collect();
        vec![
            entry("name", layer),
            entry("hash", "MurmurHash3_32"),
            entry("conversion", "uint32_to_float32"),
            // A map of texts is always JSON.
            entry("manifest", &in_ascii(&serde_json::to_string(&ids).unwrap_or_default())),
        ]
    }
}

/// JSON in which other letters than those of ASCII are escaped, for headers have no others.
fn in_ascii(json: &str) -> String {
    let mut text = String::with_capacity(json.len());
    for letter in json.chars() {
        if letter.is_ascii() {
            text.push(letter);
        } else {
            text.extend(letter.encode_utf16(&mut [0; 2]).iter().map(|unit| format!("\\u{unit:04x}")));
        }
    }
    text
}

/// The hash of a name, whose bits are always those of a normal number in single precision: where the exponent would be that of zero, of numbers
/// below the least, of infinity or of none, one bit of it is turned over.
fn identifier(name: &str) -> u32 {
    let hash = murmur3(name.as_bytes());
    match (hash >> 23) & 255 {
        0 | 255 => hash ^ (1 << 23),
        _ => hash,
    }
}

/// MurmurHash3 by Appleby (2011), in its form of 32 bits for x86, with seed 0.
fn murmur3(bytes: &[u8]) -> u32 {
    let scrambled = |block: u32| block.wrapping_mul(0xcc9e_2d51).rotate_left(15).wrapping_mul(0x1b87_3593);
    let mut hash = 0_u32;
    let blocks = bytes.chunks_exact(4);
    let rest = blocks.remainder();
    for block in blocks {
        hash ^= scrambled(u32::from_le_bytes([block[0], block[1], block[2], block[3]]));
        hash = hash.rotate_left(13).wrapping_mul(5).wrapping_add(0xe654_6b64);
    }
    hash ^= scrambled(rest.iter().rev().fold(0, |word, byte| (word << 8) | u32::from(*byte)));
    hash ^= bytes.len() as u32;
    hash = (hash ^ (hash >> 16)).wrapping_mul(0x85eb_ca6b);
    hash = (hash ^ (hash >> 13)).wrapping_mul(0xc2b2_ae35);
    hash ^ (hash >> 16)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Published values of the hash, and those of Cryptomatte's specification: "hello" in single precision is 6.0705627102400005816e-17.
    #[test]
    fn hashes_are_the_published_ones() {
        for (text, hash) in
            [("", 0), ("a", 0x3c25_69b2), ("abc", 0xb3dd_93fa), ("hello", 0x248b_fa47), ("hello, world", 0x149b_bb7f)]
        {
            assert_eq!(murmur3(text.as_bytes()), hash, "{text}");
        }
        assert_eq!(murmur3(b"The quick brown fox jumps over the lazy dog"), 0x2e4f_f723);
        assert_eq!(f32::from_bits(identifier("hello")), 6.070_562_710_24e-17_f64 as f32);
    }

    #[test]
    fn identifiers_are_normal_numbers() {
        let ids = (0..20_000).map(|number| identifier(&format!("object {number}")));
        assert!(ids.map(f32::from_bits).all(f32::is_normal));
        assert!(identifier("") == 1 << 23 && murmur3(b"") == 0);
    }

    #[test]
    fn the_manifest_is_plain_json() {
        let names = Names::of(["a \"wall\"", "küche 厨房 🍳"].into_iter());
        let notes = names.notes("CryptoObject");
        assert!(notes.iter().all(|(key, text)| key.starts_with("cryptomatte/") && key.is_ascii() && text.is_ascii()));
        let manifest: BTreeMap<String, String> = serde_json::from_str(&notes[3].1).expect("JSON");
        assert_eq!(manifest["küche 厨房 🍳"], format!("{:08x}", names.id(1)));
        assert_eq!(names.id(2), 0, "what is not there has none");
    }
}
