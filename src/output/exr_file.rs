//! OpenEXR pictures, f32 or f16, in scan lines or tiles, of one part or more, written block by block as rows come.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::io::{Seek, SeekFrom, Write};
use std::sync::Arc;
use std::thread::available_parallelism;

use exr::block::chunk::Chunk;
use exr::block::writer::{ChunkWriter, ChunksWriter, ParallelBlocksCompressor};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::error::{Error, UnitResult};
use exr::math::RoundingMode;
use exr::meta::attribute::{
    AttributeValue, ChannelDescription, Chromaticities, IntegerBounds, LevelMode, LineOrder, SampleType, Text, TileDescription,
};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, Headers, MetaData};
use exr::prelude::{Compression, Vec2, f16};
use rayon::prelude::*;

use super::layers::{LayerChannel, LayerPicture, LayerSource, SAMPLE_COUNT, sample_variance};
use super::provenance::{self, LAYERS_KEY, PICTURE_HIGH_KEY, PICTURE_LOW_KEY};
use super::rows::{Completeness, Row, Rows};
use super::spec::{ExrCompression, PartSpec, PictureSpec};
use crate::film::{Layer, variance};
use crate::picture_file::open_exr::{self, DIGEST_KEY, LineDigests};

/// Blocks compressed at once. Each takes 32 rows of memory, so more would be felt at 8K.
const COMPRESSING_THREADS: usize = 4;
/// Width and height of a tile in pixels.
const TILE: usize = 64;
/// Channels of every file.
const COLOURS: [&str; 3] = ["R", "G", "B"];
/// Channels of a part, in alphabetical order: what rounding to a colour lost is its remainder, and variances are those of samples, as in layers.
const PART: [&str; 10] =
    ["B", "G", "R", "Remainder.B", "Remainder.G", "Remainder.R", SAMPLE_COUNT, "Variance.B", "Variance.G", "Variance.R"];
/// Bytes before the header in every file: the magic number and the version.
const PREAMBLE_BYTES: u64 = 8;

/// Encodes all rows of the picture. The error is a sentence.
pub(super) fn write<W: Write + Seek>(mut writer: W, mut rows: Rows, spec: &PictureSpec) -> Result<(), String> {
    let have_counts = rows.have_counts().map_err(|_| "the render broke off".to_owned())?;
    let layout = Layout::new(spec, have_counts);
    let mut first = headers(spec, &layout, (spec.samples_wanted(), Completeness::Finished));
    state_picture_ends(&mut first[0], rows.picture_ends());
    state_digest(&mut first[0], &open_exr::placeholder());
    let headers_at_first: Headers = first.into_iter().collect();
    let mut digests = LineDigests::default();
    exr::block::write(&mut writer, headers_at_first, true, |meta, chunks| {
        write_blocks(&meta, chunks, (&mut rows, &layout, &mut digests))
    })
    .map_err(|error| error.to_string())?;

    // The header went out before the samples were counted and the pixels hashed, and with its attributes in no order, for they were in a hash map.
    // Numbers and digests have a fixed length, so it is written again in place, sorted: equal pictures are equal files.
    let completeness = rows.wait_for_finish().map_err(|_| "the render broke off".to_owned())?;
    let mut last = headers(spec, &layout, (rows.fewest_samples(), completeness));
    state_picture_ends(&mut last[0], rows.picture_ends());
    let digest = digests.finish(&last);
    state_digest(&mut last[0], &digest);
    writer.seek(SeekFrom::Start(PREAMBLE_BYTES)).map_err(|error| error.to_string())?;
    for header in &last {
        writer.write_all(&sorted_bytes(header).map_err(|error| error.to_string())?).map_err(|error| error.to_string())?;
    }
    writer.flush().map_err(|error| error.to_string())
}

/// Names the interval of the picture's mean, where it is known.
fn state_picture_ends(header: &mut Header, ends: Option<[[f64; 3]; 2]>) {
    for (key, end) in [PICTURE_LOW_KEY, PICTURE_HIGH_KEY].into_iter().zip(ends.into_iter().flatten()) {
        let text = end.map(|number| number.to_string()).join(" ");
        header.own_attributes.other.insert(Text::from(key), AttributeValue::Text(header_text(&text)));
    }
}

fn state_digest(header: &mut Header, digest: &str) {
    header.own_attributes.other.insert(Text::from(DIGEST_KEY), AttributeValue::Text(Text::from(digest)));
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

/// The source of blocks, and the sum of what is hashed of them.
type BlockSource<'a> = (&'a mut Rows, &'a Layout, &'a mut LineDigests);

fn write_blocks<W: Write + Seek>(meta: &MetaData, chunks: &mut ChunkWriter<W>, source: BlockSource<'_>) -> UnitResult {
    if meta.headers.len() > 1 {
        // The library would keep the blocks of later parts until those of earlier ones are all there, and rows come once.
        return for_each_band(meta, source, |blocks| {
            let compress = |(index, block): (usize, UncompressedBlock)| Ok((index, block.compress_to_chunk(&meta.headers)?));
            let compressed: Vec<(usize, Chunk)> = blocks.into_par_iter().map(compress).collect::<Result<_, Error>>()?;
            compressed.into_iter().try_for_each(|(index, chunk)| chunks.write_chunk(index, chunk))
        });
    }
    let threads = available_parallelism().map_or(1, usize::from).min(COMPRESSING_THREADS);
    let pool = || rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    if let Some(mut compressor) = ParallelBlocksCompressor::new_with_thread_pool(meta, chunks, pool) {
        for_each_band(meta, source, |blocks| {
            blocks.into_iter().try_for_each(|(index, block)| compressor.add_block_to_compression_queue(index, block))
        })
    } else {
        let mut compressor = chunks.sequential_blocks_compressor(meta);
        for_each_band(meta, source, |blocks| {
            blocks.into_iter().try_for_each(|(index, block)| compressor.compress_block(index, block))
        })
    }
}

/// The parts of a file and their channels.
struct Layout {
    /// One of each part, by the name that the part has where there are several.
    parts: Vec<(String, Vec<Channel>)>,
}

impl Layout {
    /// `have_counts`: the file says how many samples each pixel has.
    fn new(spec: &PictureSpec, have_counts: bool) -> Self {
        let mut parts: Vec<(String, Vec<Channel>)> = Vec::new();
        for channel in channels(spec, have_counts) {
            let name = if spec.exr.parts { part_of(&channel.name) } else { PICTURE_PART };
            match parts.iter_mut().find(|(part, _)| part == name) {
                Some((_, channels)) => channels.push(channel),
                None => parts.push((name.to_owned(), vec![channel])),
            }
        }
        // The picture comes first: programs that read one part read that.
        parts.sort_by_key(|(name, _)| name != PICTURE_PART);
        Self { parts }
    }

    fn channels(&self) -> impl Iterator<Item = &Channel> {
        self.parts.iter().flat_map(|(_, channels)| channels)
    }
}

/// Name of the part of the picture itself.
const PICTURE_PART: &str = "rgba";

/// The part to which a channel belongs, by the names that compositing programs have for layers.
fn part_of(channel: &str) -> &str {
    match channel {
        "R" | "G" | "B" | "A" => PICTURE_PART,
        "Z" => "depth",
        _ => channel.rsplit_once('.').map_or(channel, |(layer, _)| layer),
    }
}

/// A channel of the file.
struct Channel {
    name: Cow<'static, str>,
    sample_type: SampleType,
    content: Content,
}

enum Content {
    /// Red, green or blue.
    Colour(usize),
    /// One of the channels of a part, by its place in their list.
    Part(usize),
    Layer(LayerSource),
}

/// All channels in the alphabetical order of their names, in which they lie one after another in a scan line. `have_counts`: the file says how
/// many samples each pixel has.
fn channels(spec: &PictureSpec, have_counts: bool) -> Vec<Channel> {
    let colour = if spec.exr.half { SampleType::F16 } else { SampleType::F32 };
    let is_layer = |name: &str| spec.layers.iter().any(|layer| layer.name == name);
    let of_layer = |LayerChannel { name, source }: LayerChannel| Channel {
        name,
        sample_type: if matches!(source, LayerSource::Whole(..)) { SampleType::U32 } else { SampleType::F32 },
        content: Content::Layer(source),
    };
    let mut channels: Vec<Channel> = if spec.part.is_some() {
        let of_part = |(place, name): (usize, &'static str)| Channel {
            name: name.into(),
            sample_type: SampleType::F32,
            content: Content::Part(place),
        };
        // Variances that are rendered say more than those that are taken from luminance.
        PART.into_iter().enumerate().filter(|(_, name)| !is_layer(name)).map(of_part).collect()
    } else {
        let of_colour = |(place, name): (usize, &'static str)| Channel {
            name: name.into(),
            sample_type: colour,
            content: Content::Colour(place),
        };
        let count = LayerChannel::new(SAMPLE_COUNT, LayerSource::Count);
        let counts = (have_counts && !is_layer(SAMPLE_COUNT)).then_some(count).map(of_layer);
        COLOURS.into_iter().enumerate().map(of_colour).chain(counts).collect()
    };
    channels.extend(spec.layers.iter().cloned().map(of_layer));
    channels.sort_unstable_by(|one, other| one.name.cmp(&other.name));
    channels
}

/// Packs the rows as the file wants them, and hands over the blocks of all parts band by band from the top, each with its number in its part.
fn for_each_band(
    meta: &MetaData,
    (rows, layout, digests): BlockSource<'_>,
    mut write: impl FnMut(Vec<(usize, UncompressedBlock)>) -> UnitResult,
) -> UnitResult {
    let headers = &meta.headers;
    let is_part = layout.channels().any(|channel| matches!(channel.content, Content::Part(_)));
    // All parts have blocks of one size, so that those of a band stand one behind the other in each.
    let mut indices: Vec<_> = meta.enumerate_ordered_header_block_indices().collect();
    indices.sort_by_key(|(_, index)| index.pixel_position.y());
    for band in indices.chunk_by(|(_, one), (_, other)| one.pixel_position.y() == other.pixel_position.y()) {
        let Some((_, first)) = band.first() else { continue };
        let first_row = first.pixel_position.y();
        // By row, then by channel.
        let mut packed: Vec<Vec<Vec<u8>>> = Vec::with_capacity(first.pixel_size.height());
        for row in first_row..first_row + first.pixel_size.height() {
            let layers = layer_rows(layout, row as u32)?;
            let row = rows.next_row().map_err(|_| Error::Aborted)?;
            let of_part = if is_part { part_values(&row) } else { Vec::new() };
            let pack = |channel: &Channel| {
                let mut data = Vec::with_capacity(row.mean.len() * channel.sample_type.bytes_per_sample());
                pack(channel, &row, (&layers, &of_part), &mut data);
                data
            };
            packed.push(layout.channels().map(pack).collect());
        }
        let mut blocks = Vec::with_capacity(band.len());
        for &(number, index) in band {
            let block = cut_block(&packed, layout, index);
            if loses_something(&headers[index.layer]) {
                // The digest is of what comes out of the file.
                let chunk = block.clone().compress_to_chunk(headers)?;
                digests.add(headers, &UncompressedBlock::decompress_chunk(chunk, meta, false)?);
            } else {
                digests.add(headers, &block);
            }
            blocks.push((number, block));
        }
        write(blocks)?;
    }
    rows.wait_for_finish().map_err(|_| Error::Aborted).map(|_| ())
}

/// A block of a band that is packed by row and channel: row by row, one channel behind the other.
fn cut_block(packed: &[Vec<Vec<u8>>], layout: &Layout, index: BlockIndex) -> UncompressedBlock {
    let before: usize = layout.parts[..index.layer].iter().map(|(_, channels)| channels.len()).sum();
    let channels = &layout.parts[index.layer].1;
    let bytes_per_pixel: usize = channels.iter().map(|channel| channel.sample_type.bytes_per_sample()).sum();
    let mut data = Vec::with_capacity(index.pixel_size.area() * bytes_per_pixel);
    let (first, end) = (index.pixel_position.x(), index.pixel_position.x() + index.pixel_size.width());
    for row in packed {
        for (channel, line) in channels.iter().zip(&row[before..]) {
            let bytes = channel.sample_type.bytes_per_sample();
            data.extend_from_slice(&line[first * bytes..end * bytes]);
        }
    }
    UncompressedBlock { index, data }
}

fn loses_something(header: &Header) -> bool {
    header.compression == Compression::PXR24 && header.channels.list.iter().any(|channel| channel.sample_type == SampleType::F32)
}

/// A row of each picture that layers come from, by its address.
fn layer_rows(layout: &Layout, row: u32) -> Result<BTreeMap<usize, Vec<[f32; 3]>>, Error> {
    let mut rows = BTreeMap::new();
    for channel in layout.channels() {
        if let Content::Layer(source) = &channel.content
            && let Some(picture) = source.picture()
            && let Entry::Vacant(entry) = rows.entry(Arc::as_ptr(picture) as usize)
        {
            entry.insert(picture.row(row)?);
        }
    }
    Ok(rows)
}

/// One row: the layers' values by the address of their picture, and those of a part's own channels.
type LayerRows<'a> = (&'a BTreeMap<usize, Vec<[f32; 3]>>, &'a [[f32; PART.len()]]);

/// Appends a row of a channel. Of a part, there are also the values of its own channels, pixel by pixel.
fn pack(channel: &Channel, row: &Row<'_>, (layers, of_part): LayerRows<'_>, data: &mut Vec<u8>) {
    let layer = |picture: &Arc<LayerPicture>| layers[&(Arc::as_ptr(picture) as usize)].iter();
    let (pixels, counts) = (row.mean, &row.counts);
    match &channel.content {
        Content::Colour(place) if channel.sample_type == SampleType::F16 => {
            data.extend(pixels.iter().flat_map(|pixel| to_half(pixel[*place]).to_ne_bytes()));
        }
        Content::Colour(place) => data.extend(pixels.iter().flat_map(|pixel| pixel[*place].to_ne_bytes())),
        Content::Part(place) => data.extend(of_part.iter().flat_map(|values| values[*place].to_ne_bytes())),
        Content::Layer(LayerSource::Count) => {
            data.extend((0..pixels.len()).flat_map(|pixel| (counts.of(pixel) as f32).to_ne_bytes()));
        }
        Content::Layer(LayerSource::Low(place)) => pack_ends(row.low, pixels.len(), *place, 0.0, data),
        Content::Layer(LayerSource::High(place)) => pack_ends(row.high, pixels.len(), *place, f32::INFINITY, data),
        Content::Layer(LayerSource::Component(picture, place)) => {
            data.extend(layer(picture).flat_map(|values| values[*place].to_ne_bytes()));
        }
        Content::Layer(LayerSource::Whole(picture, place)) => {
            data.extend(layer(picture).flat_map(|values| (values[*place] as u32).to_ne_bytes()));
        }
        Content::Layer(LayerSource::Variance(picture, place)) => {
            let variances = layer(picture)
                .zip(pixels)
                .enumerate()
                .map(|(pixel, (squares, means))| sample_variance(means[*place], squares[*place], counts.of(pixel)));
            data.extend(variances.flat_map(f32::to_ne_bytes));
        }
    }
}

/// Appends ends of intervals; rows that no sample reached have the one that is always right.
fn pack_ends(ends: &[[f32; 3]], pixels: usize, place: usize, unknown: f32, data: &mut Vec<u8>) {
    data.extend((0..pixels).flat_map(|pixel| ends.get(pixel).map_or(unknown, |end| end[place]).to_ne_bytes()));
}

/// The largest number of half precision stands for what is beyond: of a picture it is as bright, and it is a number.
fn to_half(value: f32) -> f16 {
    let largest = f16::MAX.to_f32();
    f16::from_f32(if value.is_nan() { value } else { value.clamp(-largest, largest) })
}

/// The values of a part's channels in a row, pixel by pixel.
fn part_values(row: &Row<'_>) -> Vec<[f32; PART.len()]> {
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
    (0..row.mean.len()).map(values).collect()
}

/// Channels of a part, in alphabetical order.
pub fn part_channels() -> impl Iterator<Item = &'static str> {
    PART.into_iter()
}

/// The headers of all parts, of a picture whose pixels have so many samples at least. The first one's entries are the file's.
fn headers(spec: &PictureSpec, layout: &Layout, state: (u32, Completeness)) -> Vec<Header> {
    let several = layout.parts.len() > 1;
    let of_part = |(place, (name, channels)): (usize, &(String, Vec<Channel>))| {
        let mut header = if place == 0 { header(spec, channels, state) } else { plain_header(spec, channels) };
        // A part's name is for files of several parts; some readers would put it before the channels' names.
        header.own_attributes.layer_name = several.then(|| Text::from(name.as_str()));
        if place > 0 && name.starts_with("Crypto") {
            state_notes(&mut header, spec);
        }
        header
    };
    layout.parts.iter().enumerate().map(of_part).collect()
}

fn header(spec: &PictureSpec, channels: &[Channel], (samples, completeness): (u32, Completeness)) -> Header {
    let mut header = plain_header(spec, channels);
    for (key, entry) in spec.header_entries(samples, completeness) {
        header.own_attributes.other.insert(Text::from(key), attribute(entry));
    }
    header.own_attributes.other.extend(layers_entry(spec).map(|(key, value)| (Text::from(key), value)));
    state_notes(&mut header, spec);
    header
}

fn state_notes(header: &mut Header, spec: &PictureSpec) {
    for (key, text) in &spec.notes {
        header.own_attributes.other.insert(header_text(key), AttributeValue::Text(header_text(text)));
    }
}

/// A part's header with what all parts state.
fn plain_header(spec: &PictureSpec, channels: &[Channel]) -> Header {
    let describe = |channel: &Channel| ChannelDescription::new(&*channel.name, channel.sample_type, false);
    let channels = channels.iter().map(describe).collect();
    let size = Vec2(spec.width as usize, spec.height as usize);
    let tiles =
        TileDescription { tile_size: Vec2(TILE, TILE), level_mode: LevelMode::Singular, rounding_mode: RoundingMode::Down };
    let mut header = Header::new(Text::from("gpt"), size, channels).with_encoding(
        match spec.exr.compression {
            // A part must lose nothing.
            ExrCompression::Pxr24 if spec.part.is_some() => Compression::ZIP16,
            choice => compression(choice),
        },
        if spec.exr.tiled { BlockDescription::Tiles(tiles) } else { BlockDescription::ScanLines },
        LineOrder::Increasing,
    );
    header.own_attributes.software_name = Some(Text::from(concat!("gpt ", env!("CARGO_PKG_VERSION"))));
    header.shared_attributes.chromaticities = Some(REC_709);
    if let Some(PartSpec { film, origin }) = spec.part.or(spec.placed) {
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

/// Which layers a file has, where it has any.
pub(super) fn layers_entry(spec: &PictureSpec) -> Option<(&'static str, AttributeValue)> {
    let list = || AttributeValue::Text(Text::from(Layer::list(&spec.layer_names).as_str()));
    (!spec.layer_names.is_empty()).then(|| (LAYERS_KEY, list()))
}

/// An entry as the header has it.
pub(super) fn attribute(entry: provenance::Entry) -> AttributeValue {
    match entry {
        provenance::Entry::Text(text) => AttributeValue::Text(header_text(&text)),
        provenance::Entry::Number(number) => AttributeValue::I32(i32::try_from(number).unwrap_or(i32::MAX)),
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
