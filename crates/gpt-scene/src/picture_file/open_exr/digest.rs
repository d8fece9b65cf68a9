//! The digest of what a file of this program holds: its pixels as they come out of the file, where they lie, and what its header says of them.
//!
//! Compression does not check itself: a flipped bit decodes to other numbers. Each line is hashed with its place and the hashes are added, so lines may
//! come in any order, as threads bring them. The digest finds damage; it is no signature.

use std::borrow::Cow;

use exr::block::UncompressedBlock;
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, SampleType, Text};
use exr::meta::header::Header;
use sha2::{Digest, Sha256};

use super::blocks::{Line, for_each_block, numbers_of};
use crate::input::AnyFile;

/// Key of the digest in a header.
pub const DIGEST_KEY: &str = "gpt:digest";
/// Attributes of this program begin so.
const OWN: &[u8] = b"gpt:";
/// Bytes of a line's hash that are added, and of the digest.
const BYTES: usize = 16;

/// Sums up the lines of a part, in any order.
#[derive(Debug, Clone, Default)]
pub struct LineDigests {
    sum: u128,
    lines: u64,
}

impl LineDigests {
    /// Adds the lines of a block, as they stand in memory, of a file of these parts. Channels are numbered through all parts.
    pub fn add(&mut self, headers: &[Header], block: &UncompressedBlock) {
        let Some(header) = headers.get(block.index.layer) else { return };
        let before = first_channel(headers, block.index.layer);
        for line in block.lines(&header.channels) {
            let place = [before + line.location.channel, line.location.position.x(), line.location.position.y()];
            let mut hash = Sha256::new();
            place.iter().for_each(|number| hash.update((*number as u64).to_le_bytes()));
            hash.update(little_endian(line.value, header.channels.list[line.location.channel].sample_type));
            self.sum = self.sum.wrapping_add(u128::from_le_bytes(first_bytes(hash)));
            self.lines += 1;
        }
    }

    /// The digest of a file that has these lines and these parts; the first one's entries are the file's, of which its own does not count.
    pub fn finish(&self, headers: &[Header]) -> String {
        let Some(header) = headers.first() else { return placeholder() };
        let mut hash = Sha256::new();
        hash.update(self.sum.to_le_bytes());
        hash.update(self.lines.to_le_bytes());
        // Windows that are moved together are the same picture.
        let (data, shown) = (header.own_attributes.layer_position, header.shared_attributes.display_window);
        for (of_data, of_shown) in [(data.x(), shown.position.x()), (data.y(), shown.position.y())] {
            hash.update((i64::from(of_data) - i64::from(of_shown)).to_le_bytes());
        }
        for number in [header.layer_size.x(), header.layer_size.y(), shown.size.x(), shown.size.y()] {
            hash.update((number as u64).to_le_bytes());
        }
        let mut text = |text: &[u8]| {
            hash.update((text.len() as u64).to_le_bytes());
            hash.update(text);
        };
        for channel in headers.iter().flat_map(|header| &header.channels.list) {
            text(channel.name.as_slice());
            text(&[match channel.sample_type {
                SampleType::U32 => 0,
                SampleType::F16 => 1,
                SampleType::F32 => 2,
            }]);
        }
        let own = header.own_attributes.other.iter().filter(|(key, _)| key.as_slice().starts_with(OWN));
        let mut own: Vec<_> = own.filter(|(key, _)| !states_digest(key)).map(|(key, value)| (key.as_slice(), value)).collect();
        own.sort_unstable_by_key(|(key, _)| *key);
        for (key, value) in own {
            text(key);
            match value {
                AttributeValue::Text(value) => text(value.as_slice()),
                AttributeValue::I32(value) => text(&value.to_le_bytes()),
                // This program writes no other kinds.
                _ => {}
            }
        }
        first_bytes(hash).iter().map(|byte| format!("{byte:02x}")).collect()
    }

    /// Holds the digest against the one that the header states. Answers whether it states one.
    ///
    /// # Errors
    /// Digests that differ.
    fn check(&self, headers: &[Header]) -> Result<bool, String> {
        let Some(header) = headers.first() else { return Ok(false) };
        let stated = header.own_attributes.other.iter().find(|(key, _)| states_digest(key));
        let Some((_, stated)) = stated else { return Ok(false) };
        if matches!(stated, AttributeValue::Text(stated) if stated.eq(self.finish(headers).as_str())) {
            return Ok(true);
        }
        Err(format!(
            "it does not hold what was written: its digest ({DIGEST_KEY}) differs. The file is damaged, or another program changed it; where that \
             was meant, remove the entry (`oiiotool IN.exr --eraseattrib {DIGEST_KEY} -o OUT.exr`)"
        ))
    }
}

/// A digest that is to be replaced, as long as any.
pub fn placeholder() -> String {
    "0".repeat(2 * BYTES)
}

/// The number of a part's first channel, counted through all parts.
pub fn first_channel(headers: &[Header], part: usize) -> usize {
    headers[..part].iter().map(|header| header.channels.list.len()).sum()
}

/// Reads the channels that are `wanted`, counted through all parts, of a whole file, as [`super::read_lines`] does of a part, and holds the digest
/// against what came.
///
/// # Errors
/// A damaged file, and one without a digest.
pub fn read_checked_lines(file: AnyFile, wanted: &[usize], mut take: impl FnMut(Line<'_>)) -> Result<(), String> {
    let mut numbers = Vec::new();
    let found = check_blocks(file, |headers, block| {
        let (header, before) = (&headers[block.index.layer], first_channel(headers, block.index.layer));
        for line in block.lines(&header.channels).filter(|line| wanted.contains(&(before + line.location.channel))) {
            let (channel, position) = (line.location.channel, line.location.position);
            numbers_of(header.channels.list[channel].sample_type, line.value, &mut numbers);
            take((before + channel, [position.x(), position.y()], &numbers));
        }
    })?;
    if found { Ok(()) } else { Err(format!("its header has no {DIGEST_KEY}")) }
}

/// Reads a whole file, and holds its digest against what came. Answers whether it has one: files of other programs have none.
///
/// # Errors
/// A file that is damaged, and one that cannot be read.
pub fn check_digest(mut file: AnyFile) -> Result<bool, String> {
    let meta = MetaData::read_from_buffered(&mut file, false).map_err(|error| format!("it is not a valid EXR: {error}"))?;
    file.rewind().map_err(|error| format!("it cannot be read: {error}"))?;
    let states = |header: &Header| header.own_attributes.other.keys().any(states_digest);
    if meta.headers.first().is_some_and(states) { check_blocks(file, |_, _| {}) } else { Ok(false) }
}

fn check_blocks(file: AnyFile, mut take: impl FnMut(&[Header], &UncompressedBlock)) -> Result<bool, String> {
    let mut digests = LineDigests::default();
    let headers = for_each_block(
        file,
        |_| true,
        |headers, block| {
            digests.add(headers, &block);
            take(headers, &block);
        },
    )?;
    digests.check(&headers)
}

fn states_digest(key: &Text) -> bool {
    key.as_slice() == DIGEST_KEY.as_bytes()
}

fn first_bytes(hash: Sha256) -> [u8; BYTES] {
    let mut bytes = [0; BYTES];
    bytes.copy_from_slice(&hash.finalize()[..BYTES]);
    bytes
}

/// The bytes of numbers as they stand in the file.
fn little_endian(bytes: &[u8], kind: SampleType) -> Cow<'_, [u8]> {
    if cfg!(target_endian = "little") {
        return Cow::Borrowed(bytes);
    }
    bytes.chunks(kind.bytes_per_sample()).flat_map(|number| number.iter().rev()).copied().collect()
}
