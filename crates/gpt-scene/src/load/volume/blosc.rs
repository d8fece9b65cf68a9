//! Chunks that the library Blosc 1 compressed, as OpenVDB and NanoVDB write them: a header of 16 bytes, the places of blocks, and blocks, each
//! perhaps in one part for each byte of a number, of which all first bytes were put before all second ones ("shuffled").

use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::bytes::Bytes;

/// Bits of the header's flags.
const SHUFFLED: u8 = 1;
const COPIED: u8 = 1 << 1;
const BITS_SHUFFLED: u8 = 1 << 2;
const NOT_SPLIT: u8 = 1 << 4;
/// A block is split where a number has no more bytes than this, and each part has at least so many.
const MOST_PARTS: usize = 16;
const LEAST_PART: usize = 128;

/// Decompresses a chunk to exactly these bytes.
///
/// # Errors
/// A sentence about a chunk that is damaged or has another length, and about a compressor that neither library uses.
pub fn decompress(chunk: &[u8], output: &mut [u8]) -> Result<(), String> {
    let mut header = Bytes::new(chunk);
    let [_version, _inner_version, flags, number_size] = header.array()?;
    let (length, block, compressed) = (header.u32()? as usize, header.u32()? as usize, header.u32()? as usize);
    if length != output.len() {
        return Err(format!("a block of it decompresses to {length} bytes, and not to {}", output.len()));
    }
    if compressed > chunk.len() {
        return Err("a compressed block of it ends early".to_owned());
    }
    if flags & COPIED != 0 {
        output.copy_from_slice(header.take(length)?);
        return Ok(());
    }
    if length == 0 {
        return Ok(());
    }
    if block == 0 || flags & BITS_SHUFFLED != 0 {
        return Err("a block of it is compressed by Blosc in a way that OpenVDB does not use".to_owned());
    }
    let number_size = usize::from(number_size);
    let mut shuffled = Vec::new();
    for block_output in output.chunks_mut(block) {
        let mut part = Bytes::from(chunk, header.u32()?.into())?;
        let is_whole = block_output.len() == block;
        let is_split =
            flags & NOT_SPLIT == 0 && is_whole && (1..=MOST_PARTS).contains(&number_size) && block / number_size >= LEAST_PART;
        let parts = if is_split { number_size } else { 1 };
        let is_shuffled = flags & SHUFFLED != 0 && number_size > 1;
        let target = if is_shuffled {
            shuffled.resize(block_output.len(), 0);
            &mut shuffled[..]
        } else {
            &mut block_output[..]
        };
        if target.len() % parts != 0 {
            return Err("a compressed block of it is damaged".to_owned());
        }
        let part_length = target.len() / parts;
        for target in target.chunks_mut(part_length) {
            let size = part.u32()? as usize;
            decompress_part(flags >> 5, part.take(size)?, target)?;
        }
        if is_shuffled {
            unshuffle(&shuffled, block_output, number_size);
        }
    }
    Ok(())
}

fn decompress_part(compressor: u8, part: &[u8], target: &mut [u8]) -> Result<(), String> {
    if part.len() == target.len() {
        target.copy_from_slice(part);
        return Ok(());
    }
    let length = match compressor {
        1 => lz4_flex::block::decompress_into(part, target).ok(),
        3 => ZlibDecoder::new(part).read_exact(target).ok().map(|()| target.len()),
        _ => {
            return Err(
                "a block of it is compressed by Blosc in a way that OpenVDB does not use (neither LZ4 nor zlib)".to_owned()
            );
        }
    };
    if length == Some(target.len()) { Ok(()) } else { Err("a compressed block of it is damaged".to_owned()) }
}

/// Puts the bytes of each number together again. What is left after the last whole number was not moved.
fn unshuffle(shuffled: &[u8], output: &mut [u8], number_size: usize) {
    let count = output.len() / number_size;
    for (index, number) in output.chunks_exact_mut(number_size).enumerate() {
        for (byte, target) in number.iter_mut().enumerate() {
            *target = shuffled[byte * count + index];
        }
    }
    let whole = count * number_size;
    output[whole..].copy_from_slice(&shuffled[whole..]);
}
