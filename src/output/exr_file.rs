//! OpenEXR pictures: RGB scan lines, f32 or f16, written block by block.

use std::io::{Seek, SeekFrom, Write};
use std::thread::available_parallelism;

use exr::block::UncompressedBlock;
use exr::block::writer::{ChunkWriter, ChunksWriter, ParallelBlocksCompressor};
use exr::error::{Error, UnitResult};
use exr::meta::attribute::{AttributeValue, ChannelDescription, Chromaticities, IntegerBounds, LineOrder, SampleType, Text};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers, MetaData};
use exr::prelude::{Compression, Vec2, f16};

use super::provenance::Entry;
use super::rows::{Completeness, PartRow, Rows};
use super::spec::{ExrCompression, PartSpec, PictureSpec};
use crate::film::variance;

/// Blocks compressed at once. Each takes 32 rows of memory, so more would be felt at 8K.
const COMPRESSING_THREADS: usize = 4;
/// Channels of every file, in alphabetical order, and the one of pixels that differ in their numbers of samples.
const COLOURS: [&str; 3] = ["B", "G", "R"];
const COUNT: &str = "SampleCount";
/// Channels of a part, in alphabetical order: what rounding to a colour lost is its remainder, and variances are those of the means.
const PART: [&str; 10] =
    ["B", "G", "R", "Remainder.B", "Remainder.G", "Remainder.R", COUNT, "Variance.B", "Variance.G", "Variance.R"];
/// Bytes before the header in every file: the magic number and the version.
const PREAMBLE_BYTES: u64 = 8;

/// Encodes all rows of the picture. The error is a sentence.
pub(super) fn write<W: Write + Seek>(mut writer: W, mut rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let have_counts = rows.have_counts().map_err(|_| "the render broke off".to_owned())?;
    let first = header(spec, spec.samples_wanted(), Completeness::Finished, have_counts);
    let headers: Headers = [first].into_iter().collect();
    exr::block::write(&mut writer, headers, true, |meta, chunks| write_blocks(&meta, chunks, &mut rows))
        .map_err(|error| error.to_string())?;

    // The header went out before the samples were counted, and with its attributes in no order, for they were in a hash map. Numbers have a
    // fixed length, so it is written again in place, sorted: equal pictures are equal files.
    let completeness = rows.wait_for_finish().map_err(|_| "the render broke off".to_owned())?;
    let last = header(spec, rows.fewest_samples(), completeness, have_counts);
    writer.seek(SeekFrom::Start(PREAMBLE_BYTES)).map_err(|error| error.to_string())?;
    writer.write_all(&sorted_bytes(&last).map_err(|error| error.to_string())?).map_err(|error| error.to_string())?;
    writer.flush().map_err(|error| error.to_string())
}

/// The header as it stands in a file, its attributes in the order of their names.
fn sorted_bytes(header: &Header) -> Result<Vec<u8>, Error> {
    let mut attributes: Vec<_> = header.all_named_attributes().collect();
    attributes.sort_unstable_by_key(|(name, _)| *name);
    let mut bytes = Vec::new();
    for (name, value) in &attributes {
        exr::meta::attribute::write(name, value, &mut bytes)?;
    }
    // An empty name ends the list.
    bytes.push(0);
    Ok(bytes)
}

fn write_blocks<W: Write + Seek>(meta: &MetaData, chunks: &mut ChunkWriter<W>, rows: &mut Rows) -> UnitResult {
    let threads = available_parallelism().map_or(1, usize::from).min(COMPRESSING_THREADS);
    let pool = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    if let Some(mut compressor) = ParallelBlocksCompressor::new_with_thread_pool(meta, chunks, pool) {
        for_each_block(meta, rows, |index, block| compressor.add_block_to_compression_queue(index, block))
    } else {
        let mut compressor = chunks.sequential_blocks_compressor(meta);
        for_each_block(meta, rows, |index, block| compressor.compress_block(index, block))
    }
}

/// Packs the rows as the file wants them, block by block from the top.
fn for_each_block(meta: &MetaData, rows: &mut Rows, mut write: impl FnMut(usize, UncompressedBlock) -> UnitResult) -> UnitResult {
    let bytes_per_pixel = meta.headers[0].channels.bytes_per_pixel;
    let half = meta.headers[0].channels.list[0].sample_type == SampleType::F16;
    for (index_in_file, index) in meta.enumerate_ordered_header_block_indices() {
        let mut data = Vec::with_capacity(index.pixel_size.area() * bytes_per_pixel);
        let is_part = meta.headers[0].channels.list.len() == PART.len();
        for _ in 0..index.pixel_size.height() {
            if is_part {
                let row = rows.next_part_row().map_err(|_| Error::Aborted)?;
                pack_part_row(&row, &mut data);
                continue;
            }
            let (row, counts) = rows.next_row().map_err(|_| Error::Aborted)?;
            // Channels lie one after another in a scan line, in the alphabetical order of their names.
            for channel in [2, 1, 0] {
                if half {
                    data.extend(row.iter().flat_map(|pixel| to_half(pixel[channel]).to_ne_bytes()));
                } else {
                    data.extend(row.iter().flat_map(|pixel| pixel[channel].to_ne_bytes()));
                }
            }
            if meta.headers[0].channels.list.len() > COLOURS.len() {
                let count = |pixel: usize| counts.of(pixel) as f32;
                data.extend((0..row.len()).flat_map(|pixel| count(pixel).to_ne_bytes()));
            }
        }
        write(index_in_file, UncompressedBlock { index, data })?;
    }
    rows.wait_for_finish().map_err(|_| Error::Aborted).map(|_| ())
}

/// The largest number of half precision stands for what is beyond: of a picture it is as bright, and it is a number.
fn to_half(value: f32) -> f16 {
    let largest = f16::MAX.to_f32();
    f16::from_f32(if value.is_nan() { value } else { value.clamp(-largest, largest) })
}

/// Adds a row of a part, channel after channel.
fn pack_part_row(row: &PartRow<'_>, data: &mut Vec<u8>) {
    let values = |pixel: usize| {
        let mean = row.mean[pixel];
        let remainder = row.remainder.get(pixel).copied().unwrap_or_default();
        let count = row.counts.of(pixel);
        let exact = std::array::from_fn(|channel| f64::from(mean[channel]) + f64::from(remainder[channel]));
        let second_moment = row.second_moment.get(pixel).copied().unwrap_or_default();
        let variance = variance(exact, f64::from(second_moment), f64::from(count)).map(|variance| variance as f32);
        let [[r, g, b], [rest_r, rest_g, rest_b], [var_r, var_g, var_b]] = [mean, remainder, variance];
        [b, g, r, rest_b, rest_g, rest_r, count as f32, var_b, var_g, var_r]
    };
    let pixels: Vec<[f32; PART.len()]> = (0..row.mean.len()).map(values).collect();
    for channel in 0..PART.len() {
        data.extend(pixels.iter().flat_map(|pixel| pixel[channel].to_ne_bytes()));
    }
}

/// Channels of a part, in alphabetical order.
pub fn part_channels() -> impl Iterator<Item = &'static str> {
    PART.into_iter()
}

/// `have_counts`: the file says how many samples each pixel has, in a channel of its own.
fn header(spec: &PictureSpec, samples: u32, completeness: Completeness, have_counts: bool) -> Header {
    let usual = COLOURS.iter().copied().chain(have_counts.then_some(COUNT));
    let names: Vec<&str> = if spec.part.is_some() { PART.to_vec() } else { usual.collect() };
    let is_half = spec.exr.half && spec.part.is_none();
    let colour = if is_half { SampleType::F16 } else { SampleType::F32 };
    let sample_type = |name| if name == COUNT { SampleType::F32 } else { colour };
    let channels = names.into_iter().map(|name| ChannelDescription::new(name, sample_type(name), false)).collect::<Vec<_>>();
    let size = Vec2(spec.width as usize, spec.height as usize);
    let mut header = Header::new(Text::from("gpt"), size, channels.into_iter().collect()).with_encoding(
        match spec.exr.compression {
            // Of a part, nothing may be lost.
            ExrCompression::Pxr24 if spec.part.is_some() => Compression::ZIP16,
            choice => compression(choice),
        },
        BlockDescription::ScanLines,
        LineOrder::Increasing,
    );
    // A part's name is for files of several parts; some readers would put it before the channels' names.
    header.own_attributes.layer_name = None;
    header.own_attributes.software_name = Some(Text::from(concat!("gpt ", env!("CARGO_PKG_VERSION"))));
    for (key, entry) in spec.header_entries(samples, completeness) {
        header.own_attributes.other.insert(Text::from(key), attribute(entry));
    }
    header.shared_attributes.chromaticities = Some(REC_709);
    if let Some(PartSpec { film, origin }) = spec.part {
        let [x, y] = origin.map(|place| i32::try_from(place).unwrap_or(i32::MAX));
        header.own_attributes.layer_position = Vec2(x, y);
        header.shared_attributes.display_window = IntegerBounds::from_dimensions((film[0] as usize, film[1] as usize));
    }
    header
}

fn compression(choice: ExrCompression) -> Compression {
    match choice {
        ExrCompression::None => Compression::Uncompressed,
        ExrCompression::Rle => Compression::RLE,
        ExrCompression::Zips => Compression::ZIP1,
        ExrCompression::Zip => Compression::ZIP16,
        ExrCompression::Piz => Compression::PIZ,
        ExrCompression::Pxr24 => Compression::PXR24,
    }
}

/// An entry as the header has it.
pub(super) fn attribute(entry: Entry) -> AttributeValue {
    match entry {
        Entry::Text(text) => AttributeValue::Text(header_text(&text)),
        Entry::Number(number) => AttributeValue::I32(i32::try_from(number).unwrap_or(i32::MAX)),
    }
}

/// The header's text is Latin-1; other characters become question marks.
fn header_text(text: &str) -> Text {
    let known: String = text.chars().map(|character| if u32::from(character) < 256 { character } else { '?' }).collect();
    Text::new_or_none(known).unwrap_or_else(|| Text::from("?"))
}

/// Primaries and white point (D65) of Rec. ITU-R BT.709, CIE 1931 xy.
const REC_709: Chromaticities =
    Chromaticities { red: Vec2(0.64, 0.33), green: Vec2(0.3, 0.6), blue: Vec2(0.15, 0.06), white: Vec2(0.3127, 0.329) };
