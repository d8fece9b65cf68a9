//! The numbers of a part's channels, as they come out of its blocks.

use std::io::SeekFrom;

use exr::block::chunk::{Chunk, CompressedBlock};
use exr::block::reader::ChunksReader;
use exr::block::{BlockIndex, UncompressedBlock};
use exr::io::PeekRead;
use exr::math::Vec2;
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::prelude::{Compression, f16};

use super::windows::Windows;
use crate::input::AnyFile;

/// Advice for a file that is not read as it was saved.
pub const RESAVE: &str = "`oiiotool IN.exr --compression zip -o OUT.exr` (openimageio-tools) saves it anew";

/// Pixels from which on several threads decompress: as many as there are cores start for each file, which takes longer than a small one.
const WORTH_THREADS: usize = 1 << 16;

/// Numbers of one channel side by side: which channel, the first one's column and row in the data window, and the numbers.
pub type Line<'l> = (usize, [usize; 2], &'l [f32]);

/// Reads the channels that are `wanted` of a part, at full resolution, line by line. Lines of one row of a block come together, in the order of the
/// channels. What the display window does not show is left out where a whole block lies outside.
pub fn read_lines(mut file: AnyFile, part: usize, wanted: &[usize], mut take: impl FnMut(Line<'_>)) -> Result<(), String> {
    let failure = |error: exr::error::Error| error.to_string();
    let meta = MetaData::read_from_buffered(&mut file, false).map_err(failure)?;
    if meta.headers.get(part).is_some_and(is_subsampled) {
        return subsampled_lines(file, &meta, part, wanted, &mut take);
    }
    file.rewind().map_err(|error| error.to_string())?;
    let mut numbers = Vec::new();
    let is_shown = |windows: Windows, block: &BlockIndex| {
        let size = [block.pixel_size.width(), block.pixel_size.height()];
        windows.show([block.pixel_position.x(), block.pixel_position.y()], size)
    };
    let windows = meta.headers.get(part).map(Windows::of).ok_or("it has no such part")?;
    let take_block = |headers: &[Header], block: UncompressedBlock| {
        let header = &headers[part];
        for line in block.lines(&header.channels) {
            let channel = line.location.channel;
            if wanted.contains(&channel) {
                numbers_of(header.channels.list[channel].sample_type, line.value, &mut numbers);
                take((channel, [line.location.position.x(), line.location.position.y()], &numbers));
            }
        }
    };
    for_each_block(file, |block| block.layer == part && is_shown(windows, block), take_block).map(|_| ())
}

/// Reads the blocks at full resolution that are asked for, in any order, and answers the headers of all parts.
pub fn for_each_block(
    file: AnyFile,
    is_wanted: impl Fn(&BlockIndex) -> bool,
    mut take: impl FnMut(&[Header], UncompressedBlock),
) -> Result<Vec<Header>, String> {
    let reader = exr::block::read(file, false).map_err(|error| error.to_string())?;
    let headers = reader.headers().to_vec();
    let reader = reader
        .filter_chunks(false, |_, _, block: BlockIndex| block.level == Vec2(0, 0) && is_wanted(&block))
        .map_err(|error| error.to_string())?;
    let insert = |_: &_, block: UncompressedBlock| {
        take(&headers, block);
        Ok(())
    };
    let read = if headers.iter().all(|header| header.layer_size.area() < WORTH_THREADS) {
        reader.decompress_sequential(false, insert)
    } else {
        reader.decompress_parallel(false, insert)
    };
    read.map_err(|error| error.to_string())?;
    Ok(headers)
}

/// True where some channel has fewer numbers than pixels.
pub fn is_subsampled(header: &Header) -> bool {
    header.channels.list.iter().any(|channel| channel.sampling != Vec2(1, 1))
}

/// Numbers as they stand in memory, in single precision.
pub fn numbers_of(kind: SampleType, bytes: &[u8], numbers: &mut Vec<f32>) {
    numbers.clear();
    match kind {
        SampleType::F16 => numbers.extend(bytes.as_chunks().0.iter().map(|bytes| f16::from_ne_bytes(*bytes).to_f32())),
        SampleType::F32 => numbers.extend(bytes.as_chunks().0.iter().map(|bytes| f32::from_ne_bytes(*bytes))),
        SampleType::U32 => numbers.extend(bytes.as_chunks().0.iter().map(|bytes| u32::from_ne_bytes(*bytes) as f32)),
    }
}

/// Reads the lines of a part some of whose channels have fewer numbers than pixels, which the library's own reader refuses. The file stands behind
/// its headers.
fn subsampled_lines(
    mut file: AnyFile,
    meta: &MetaData,
    part: usize,
    wanted: &[usize],
    take: &mut impl FnMut(Line<'_>),
) -> Result<(), String> {
    let failure = |error: exr::error::Error| error.to_string();
    let header = &meta.headers[part];
    let (size, start) = (header.layer_size, header.own_attributes.layer_position);
    let divides = |step: usize, side: usize, start: i32| {
        step > 0 && side.is_multiple_of(step) && i64::try_from(step).is_ok_and(|step| i64::from(start) % step == 0)
    };
    let fits = |Vec2(x, y): Vec2<usize>| divides(x, size.width(), start.x()) && divides(y, size.height(), start.y());
    if !header.channels.list.iter().all(|channel| fits(channel.sampling)) {
        return Err("a channel's xSampling or ySampling does not divide the data window".to_owned());
    }
    let tables = MetaData::read_offset_tables(&mut PeekRead::new(&mut file), &meta.headers).map_err(failure)?;
    for offset in tables.get(part).into_iter().flatten() {
        file.seek(SeekFrom::Start(*offset)).map_err(|error| error.to_string())?;
        let chunk = Chunk::read(&mut file, meta).map_err(failure)?;
        if chunk.layer_index == part {
            chunk_lines(header, chunk, wanted, take)?;
        }
    }
    Ok(())
}

/// The lines of a block of a part some of whose channels have fewer numbers than pixels. Such a part is flat and has scan lines.
fn chunk_lines(header: &Header, chunk: Chunk, wanted: &[usize], take: &mut impl FnMut(Line<'_>)) -> Result<(), String> {
    let CompressedBlock::ScanLine(block) = chunk.compressed_block else {
        return Err("has channels of reduced resolution in tiles, which OpenEXR does not allow".to_owned());
    };
    let first = i64::from(block.y_coordinate) - i64::from(header.own_attributes.layer_position.y());
    let (width, height) = (header.layer_size.width(), header.layer_size.height());
    let first = usize::try_from(first).ok().filter(|row| *row < height).ok_or("has a block outside of its data window")?;
    let rows = header.compression.scan_lines_per_block().min(height - first);
    let lines = || {
        let of_row = move |row: usize| {
            let channels = header.channels.list.iter().enumerate();
            // A data window begins at a multiple of every channel's step, so rows may be counted within it.
            channels.filter(move |(_, channel)| row.is_multiple_of(channel.sampling.y())).map(move |(place, channel)| {
                let bytes = width / channel.sampling.x() * channel.sample_type.bytes_per_sample();
                (place, row / channel.sampling.y(), bytes)
            })
        };
        (first..first + rows).flat_map(of_row)
    };
    let length: usize = lines().map(|(_, _, bytes)| bytes).sum();
    let bytes = decompress(header, block.compressed_pixels_le, ([width, rows], first), length)?;
    let mut rest = bytes.as_slice();
    let mut numbers = Vec::new();
    for (channel, row, length) in lines() {
        let (line, after) = rest.split_at_checked(length).ok_or("has a block that is too short")?;
        rest = after;
        if wanted.contains(&channel) {
            numbers_of(header.channels.list[channel].sample_type, line, &mut numbers);
            take((channel, [0, row], &numbers));
        }
    }
    Ok(())
}

/// The bytes of a block that has so many. The library takes a block to have as many numbers of each channel as it has pixels, so it is reported of a part
/// whose blocks have this length: methods that see bytes alone, of one channel; others, of pixels that take less.
fn decompress(
    header: &Header,
    bytes: Vec<u8>,
    ([width, rows], first): ([usize; 2], usize),
    length: usize,
) -> Result<Vec<u8>, String> {
    let method = header.compression;
    let mut adjusted = header.clone();
    let section = match method {
        Compression::Uncompressed | Compression::RLE | Compression::ZIP1 | Compression::ZIP16 => {
            // Every kind of number takes an even number of bytes.
            let one = ChannelDescription::new("bytes", SampleType::F16, false);
            adjusted.channels = ChannelList::new([one].into_iter().collect());
            adjusted.layer_size = Vec2(length / 2, 1);
            IntegerBounds::new((0, 0), (length / 2, 1))
        }
        _ => {
            let pixels = width * rows;
            if !length.is_multiple_of(pixels) {
                return Err(format!("has channels of reduced resolution in {method}, which is not read; {}", RESAVE));
            }
            adjusted.channels.bytes_per_pixel = length / pixels;
            IntegerBounds::new((0, i32::try_from(first).unwrap_or(0)), (width, rows))
        }
    };
    let decoded = method.decompress_image_section_from_le(&adjusted, bytes, section, false);
    decoded.map_err(|error| format!("has a broken block: {error}"))
}
