//! OpenEXR files put together byte by byte, with what a library for writing them does not allow.

use exr::meta::attribute::{ChannelDescription, ChannelList, IntegerBounds, SampleType};
use exr::meta::header::Header;
use exr::meta::{BlockDescription, attribute::LineOrder};
use exr::prelude::{Compression, Vec2};

/// Numbers of a channel: its name, the step of its columns and rows, and the number of a pixel, counted within the data window.
pub struct Channel {
    pub name: &'static str,
    pub step: [usize; 2],
    pub number: fn(usize, usize) -> f32,
}

/// A flat file of scan lines in single precision.
pub struct ExrBytes {
    pub channels: Vec<Channel>,
    /// First column and row, width and height.
    pub data: [i32; 4],
    pub display: [i32; 4],
    pub compression: Compression,
    /// Name, type and content.
    pub attributes: Vec<(&'static str, &'static str, Vec<u8>)>,
    /// The version of the file and its flags.
    pub flags: u32,
}

impl ExrBytes {
    /// One that is whole, in its display window.
    pub fn new([width, height]: [i32; 2], channels: Vec<Channel>) -> Self {
        let window = [0, 0, width, height];
        Self { channels, data: window, display: window, compression: Compression::Uncompressed, attributes: Vec::new(), flags: 2 }
    }

    pub fn with(mut self, name: &'static str, kind: &'static str, content: &[u8]) -> Self {
        self.attributes.push((name, kind, content.to_vec()));
        self
    }

    pub fn with_floats(self, name: &'static str, kind: &'static str, numbers: &[f32]) -> Self {
        self.with(name, kind, &numbers.iter().flat_map(|number| number.to_le_bytes()).collect::<Vec<_>>())
    }

    pub fn bytes(&self) -> Vec<u8> {
        let [left, top, width, height] = self.data;
        let mut bytes = vec![0x76, 0x2f, 0x31, 0x01];
        bytes.extend(self.flags.to_le_bytes());
        let mut list = Vec::new();
        for channel in &self.channels {
            list.extend(channel.name.bytes().chain([0]));
            for number in [2, 0, channel.step[0] as i32, channel.step[1] as i32] {
                list.extend(number.to_le_bytes());
            }
        }
        list.push(0);
        let window = |[left, top, width, height]: [i32; 4]| -> Vec<u8> {
            [left, top, left + width - 1, top + height - 1].iter().flat_map(|edge| edge.to_le_bytes()).collect()
        };
        let method = match self.compression {
            Compression::Uncompressed => 0,
            Compression::RLE => 1,
            Compression::ZIP1 => 2,
            Compression::ZIP16 => 3,
            Compression::PIZ => 4,
            Compression::PXR24 => 5,
            other => panic!("{other} is not written here"),
        };
        let mut attribute = |name: &str, kind: &str, content: &[u8]| {
            bytes.extend(name.bytes().chain([0]).chain(kind.bytes()).chain([0]));
            bytes.extend((content.len() as i32).to_le_bytes());
            bytes.extend(content);
        };
        let has = |wanted: &str| self.attributes.iter().any(|(name, ..)| *name == wanted);
        attribute("channels", "chlist", &list);
        attribute("compression", "compression", &[method]);
        attribute("dataWindow", "box2i", &window(self.data));
        attribute("displayWindow", "box2i", &window(self.display));
        attribute("lineOrder", "lineOrder", &[0]);
        if !has("pixelAspectRatio") {
            attribute("pixelAspectRatio", "float", &1.0_f32.to_le_bytes());
        }
        attribute("screenWindowCenter", "v2f", &[0; 8]);
        attribute("screenWindowWidth", "float", &1.0_f32.to_le_bytes());
        for (name, kind, content) in &self.attributes {
            attribute(name, kind, content);
        }
        bytes.push(0);
        let header = self.header();
        let rows = self.compression.scan_lines_per_block() as i32;
        let blocks: Vec<(i32, Vec<u8>)> = (0..height)
            .step_by(rows as usize)
            .map(|row| (row, self.block(&header, row, rows.min(height - row), width)))
            .collect();
        let mut offset = bytes.len() + 8 * blocks.len();
        for (_, block) in &blocks {
            bytes.extend((offset as u64).to_le_bytes());
            offset += 8 + block.len();
        }
        for (row, block) in &blocks {
            bytes.extend((top + row).to_le_bytes().into_iter().chain((block.len() as i32).to_le_bytes()));
            bytes.extend(block);
        }
        let _ = left;
        bytes
    }

    fn block(&self, header: &Header, first: i32, rows: i32, width: i32) -> Vec<u8> {
        let mut bytes = Vec::new();
        for row in first as usize..(first + rows) as usize {
            for Channel { step, number, .. } in self.channels.iter().filter(|channel| row.is_multiple_of(channel.step[1])) {
                bytes.extend((0..width as usize).step_by(step[0]).flat_map(|column| number(column, row).to_ne_bytes()));
            }
        }
        if self.compression == Compression::Uncompressed {
            return bytes;
        }
        // Methods that see bytes alone are told of one row of numbers; others follow the channels themselves.
        let by_bytes = matches!(self.compression, Compression::RLE | Compression::ZIP1 | Compression::ZIP16);
        let (told, section) = if by_bytes {
            let mut told = header.clone();
            let one = ChannelDescription::new("bytes", SampleType::F16, false);
            told.channels = ChannelList::new([one].into_iter().collect());
            told.layer_size = Vec2(bytes.len() / 2, 1);
            (told, IntegerBounds::new((0, 0), (bytes.len() / 2, 1)))
        } else {
            (header.clone(), IntegerBounds::new((0, first), (width as usize, rows as usize)))
        };
        self.compression.compress_image_section_to_le(&told, bytes, section).expect("it can be compressed")
    }

    fn header(&self) -> Header {
        let describe = |channel: &Channel| ChannelDescription {
            sampling: Vec2(channel.step[0], channel.step[1]),
            ..ChannelDescription::new(channel.name, SampleType::F32, false)
        };
        let channels = self.channels.iter().map(describe).collect();
        let size = Vec2(self.data[2] as usize, self.data[3] as usize);
        Header::new("a".into(), size, channels).with_encoding(
            self.compression,
            BlockDescription::ScanLines,
            LineOrder::Increasing,
        )
    }
}
