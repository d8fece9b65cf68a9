//! Buffers, what they are packed by, and accessors into them.

use std::borrow::Cow;
use std::cell::Cell;
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::rc::Rc;

use base64::Engine as _;

use super::json::{Accessor, Packed, Root, extension};
use super::meshopt;
use crate::load::error::show;
use crate::load::files::{Files, MOST_MODEL_BYTES};

/// Bytes to which buffers are padded.
const PADDING: u64 = 4;
/// Most elements of accessors without a buffer, whose elements are 0, and most bytes that are decoded of all accessors, each time that one is asked for:
/// for each byte of the files, and beside a first amount. An accessor takes a line, and may say that it has any number of elements.
const MOST_ZEROS: (u64, u64) = (16, 1 << 22);
const MOST_DECODED: (u64, u64) = (256, 1 << 28);
/// Most bytes that packed views take once they are unpacked, for each byte of the files and beside a first amount.
const MOST_UNPACKED: (u64, u64) = (256, 1 << 20);

/// Contents of the file's buffers. Errors are sentences without the file's name.
pub struct Buffers<'r> {
    root: &'r Root,
    /// Buffers of one file share its bytes.
    buffers: Vec<Rc<[u8]>>,
    /// Views that meshopt packed, by their index.
    unpacked: HashMap<usize, Vec<u8>>,
    /// How much of [`MOST_ZEROS`] and of [`MOST_DECODED`] is left.
    zeros_left: Cell<u64>,
    bytes_left: Cell<u64>,
}

impl<'r> Buffers<'r> {
    pub fn load(files: &Files, folder: &Path, root: &'r Root, mut binary: Option<Vec<u8>>) -> Result<Self, String> {
        let mut buffers: Vec<Rc<[u8]>> = Vec::new();
        let mut of_uris: HashMap<&str, Rc<[u8]>> = HashMap::new();
        for (index, buffer) in root.buffers.iter().enumerate() {
            let of_buffer = |message: String| format!("buffers[{index}]: {message}");
            let is_stand_in = ["EXT_meshopt_compression", "KHR_meshopt_compression"].iter().any(|name| {
                buffer.extensions.get(*name).and_then(|value| value.get("fallback")).and_then(|f| f.as_bool()) == Some(true)
            });
            let bytes: Rc<[u8]> = match &buffer.uri {
                Some(uri) => match of_uris.get(uri.as_str()) {
                    Some(known) => known.clone(),
                    None => {
                        let bytes: Rc<[u8]> = read_uri(files, folder, uri).map_err(of_buffer)?.1.into();
                        of_uris.insert(uri, bytes.clone());
                        bytes
                    }
                },
                None if is_stand_in => Rc::default(),
                None if index == 0 && binary.is_some() => binary.take().unwrap_or_default().into(),
                None => return Err(of_buffer("it names no file, and the file brings no data for it".to_owned())),
            };
            // Missing bytes of a padding are not needed.
            if bytes.len() as u64 + PADDING <= buffer.byte_length && !is_stand_in {
                let message = format!("it has {} bytes, and {} are said to be there", bytes.len(), buffer.byte_length);
                return Err(of_buffer(message));
            }
            buffers.push(bytes);
        }
        let there = bytes_of(&buffers);
        let most = |(factor, first): (u64, u64)| Cell::new(there.saturating_mul(factor).saturating_add(first));
        let [zeros_left, bytes_left] = [MOST_ZEROS, MOST_DECODED].map(most);
        let mut loaded = Self { root, buffers, unpacked: HashMap::new(), zeros_left, bytes_left };
        loaded.unpack()?;
        Ok(loaded)
    }

    fn unpack(&mut self) -> Result<(), String> {
        let there = bytes_of(&self.buffers);
        let mut left = there.saturating_mul(MOST_UNPACKED.0) + MOST_UNPACKED.1;
        for (index, view) in self.root.buffer_views.iter().enumerate() {
            let of_view = |message: String| format!("bufferViews[{index}]: {message}");
            let packed = match extension::<Packed>(&view.extensions, "EXT_meshopt_compression").map_err(of_view)? {
                Some(packed) => packed,
                None => match extension::<Packed>(&view.extensions, "KHR_meshopt_compression").map_err(of_view)? {
                    Some(packed) => packed,
                    None => continue,
                },
            };
            let bytes = self.range(packed.buffer, packed.byte_offset, packed.byte_length).map_err(of_view)?;
            let size = packed.count.saturating_mul(packed.byte_stride);
            left = left.checked_sub(size).ok_or_else(|| of_view(format!("it would be {size} bytes, unpacked")))?;
            let unpacked =
                meshopt::unpack(&packed, bytes).map_err(|reason| of_view(format!("EXT_meshopt_compression: {reason}")))?;
            self.unpacked.insert(index, unpacked);
        }
        Ok(())
    }

    fn range(&self, buffer: usize, offset: u64, length: u64) -> Result<&[u8], String> {
        let bytes = self.buffers.get(buffer).ok_or_else(|| format!("there is no buffers[{buffer}]"))?;
        let there = bytes.len() as u64;
        let end = offset.checked_add(length).filter(|end| offset <= there && *end < there + PADDING);
        let end = end.map(|end| end.min(there));
        let end =
            end.ok_or_else(|| format!("its bytes from {offset} on, {length} of them, lie beyond the end of buffers[{buffer}]"))?;
        Ok(&bytes[offset as usize..end as usize])
    }

    /// The bytes of a view.
    pub fn view(&self, index: usize) -> Result<&[u8], String> {
        if let Some(bytes) = self.unpacked.get(&index) {
            return Ok(bytes);
        }
        let view = self.root.buffer_views.get(index).ok_or_else(|| format!("there is no bufferViews[{index}]"))?;
        self.range(view.buffer, view.byte_offset, view.byte_length).map_err(|message| format!("bufferViews[{index}]: {message}"))
    }

    fn accessor(&self, index: usize) -> Result<&'r Accessor, String> {
        self.root.accessors.get(index).ok_or_else(|| format!("there is no accessors[{index}]"))
    }

    /// Elements of an accessor of one of these types, as numbers one after the other. Integers that stand for fractions become them.
    pub fn numbers(&self, index: usize, types: &[&str]) -> Result<(Vec<f32>, usize), String> {
        let accessor = self.accessor(index)?;
        let of_accessor = |message: String| format!("accessors[{index}]: {message}");
        if !types.contains(&accessor.r#type.as_str()) {
            return Err(of_accessor(format!("its elements are of type {}, not {}", accessor.r#type, types.join(" or "))));
        }
        let width = components(&accessor.r#type).ok_or_else(|| of_accessor(format!("there is no type {}", accessor.r#type)))?;
        let kind = Component::of(accessor.component_type).map_err(of_accessor)?;
        let decode = |bytes: &[u8]| kind.number(bytes, accessor.normalized);
        self.elements(accessor, width, kind, decode).map(|numbers| (numbers, width)).map_err(of_accessor)
    }

    /// The largest integer that an accessor's elements can be, where they are none that stand for fractions.
    pub fn largest_of_whole_numbers(&self, index: usize) -> Option<f32> {
        let accessor = self.root.accessors.get(index).filter(|accessor| !accessor.normalized)?;
        Component::of(accessor.component_type).ok()?.largest()
    }

    /// Elements of an accessor of indices.
    pub fn indices(&self, index: usize) -> Result<Vec<u32>, String> {
        let accessor = self.accessor(index)?;
        let of_accessor = |message: String| format!("accessors[{index}]: {message}");
        let kind = Component::of(accessor.component_type).map_err(of_accessor)?;
        if accessor.r#type != "SCALAR" || !matches!(kind, Component::U8 | Component::U16 | Component::U32) {
            return Err(of_accessor("indices are unsigned integers".to_owned()));
        }
        self.elements(accessor, 1, kind, |bytes| kind.index(bytes)).map_err(of_accessor)
    }

    fn elements<T: Copy + Default>(
        &self,
        accessor: &Accessor,
        width: usize,
        kind: Component,
        decode: impl Fn(&[u8]) -> T,
    ) -> Result<Vec<T>, String> {
        let size = kind.size() * width;
        let take = |left: &Cell<u64>, count: u64| left.get().checked_sub(count).map(|rest| left.set(rest));
        if accessor.buffer_view.is_none() && take(&self.zeros_left, accessor.count).is_none() {
            return Err(format!(
                "it has {} elements and no buffer, which is more than a file of this size has use for",
                accessor.count
            ));
        }
        let decodes = || {
            let what = "accessors are read over and over, or overlap: it is the one with which they are more than a file of this size has use for";
            take(&self.bytes_left, accessor.count.saturating_mul(size as u64)).ok_or(what)
        };
        let mut elements = match accessor.buffer_view {
            None => vec![T::default(); accessor.count as usize * width],
            Some(view) => {
                let stride = self.root.buffer_views.get(view).and_then(|view| view.byte_stride).unwrap_or(size as u64);
                let bytes = self.strided(view, accessor.byte_offset, accessor.count, stride, size)?;
                decodes()?;
                let mut elements = Vec::with_capacity(accessor.count as usize * width);
                for element in 0..accessor.count as usize {
                    let start = element * stride as usize;
                    let element = &bytes[start..start + size];
                    elements.extend(element.chunks_exact(kind.size()).map(&decode));
                }
                elements
            }
        };
        let Some(sparse) = &accessor.sparse else { return Ok(elements) };
        let index_kind = Component::of(sparse.indices.component_type)?;
        let index_size = index_kind.size();
        let indices =
            self.strided(sparse.indices.buffer_view, sparse.indices.byte_offset, sparse.count, index_size as u64, index_size)?;
        let values = self.strided(sparse.values.buffer_view, sparse.values.byte_offset, sparse.count, size as u64, size)?;
        for (place, value) in indices.chunks_exact(index_size).zip(values.chunks_exact(size)).take(sparse.count as usize) {
            let place = index_kind.index(place) as usize;
            let element = elements.get_mut(place * width..(place + 1) * width);
            let element =
                element.ok_or_else(|| format!("a sparse value stands at {place}, and there are {} elements", accessor.count))?;
            element.iter_mut().zip(value.chunks_exact(kind.size())).for_each(|(number, bytes)| *number = decode(bytes));
        }
        Ok(elements)
    }

    /// The bytes of so many elements of a view.
    fn strided(&self, view: usize, offset: u64, count: u64, stride: u64, size: usize) -> Result<&[u8], String> {
        let bytes = self.view(view)?;
        if count == 0 {
            return Ok(&[]);
        }
        let last = (count - 1)
            .checked_mul(stride)
            .and_then(|last| last.checked_add(offset))
            .and_then(|last| last.checked_add(size as u64));
        match last {
            Some(end) if end <= bytes.len() as u64 && stride >= size as u64 => Ok(&bytes[offset as usize..end as usize]),
            _ => Err(format!("its {count} elements do not fit into bufferViews[{view}]")),
        }
    }
}

/// Bytes of all buffers, each file's once.
fn bytes_of(buffers: &[Rc<[u8]>]) -> u64 {
    let mut seen = HashSet::new();
    buffers.iter().filter(|bytes| seen.insert(Rc::as_ptr(bytes).cast::<u8>())).map(|bytes| bytes.len() as u64).sum()
}

/// Numbers of an element; None of a type that is not known.
fn components(name: &str) -> Option<usize> {
    Some(match name {
        "SCALAR" => 1,
        "VEC2" => 2,
        "VEC3" => 3,
        "VEC4" => 4,
        "MAT4" => 16,
        _ => return None,
    })
}

/// How a number is stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    fn of(number: u64) -> Result<Self, String> {
        Ok(match number {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            other => return Err(format!("there is no componentType {other}")),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    /// `bytes` are as many as the size says.
    fn number(self, bytes: &[u8], normalized: bool) -> f32 {
        let [a, b, c, d]: [u8; 4] = std::array::from_fn(|at| bytes.get(at).copied().unwrap_or(0));
        let value = match self {
            Self::I8 => f32::from(a as i8),
            Self::U8 => f32::from(a),
            Self::I16 => f32::from(i16::from_le_bytes([a, b])),
            Self::U16 => f32::from(u16::from_le_bytes([a, b])),
            Self::U32 => u32::from_le_bytes([a, b, c, d]) as f32,
            Self::F32 => f32::from_le_bytes([a, b, c, d]),
        };
        match self.largest().filter(|_| normalized) {
            Some(largest) => (value / largest).max(-1.0),
            None => value,
        }
    }

    /// The largest integer; None of other numbers.
    fn largest(self) -> Option<f32> {
        Some(match self {
            Self::I8 => 127.0,
            Self::U8 => 255.0,
            Self::I16 => 32_767.0,
            Self::U16 => 65_535.0,
            Self::U32 => u32::MAX as f32,
            Self::F32 => return None,
        })
    }

    fn index(self, bytes: &[u8]) -> u32 {
        let [a, b, c, d]: [u8; 4] = std::array::from_fn(|at| bytes.get(at).copied().unwrap_or(0));
        match self {
            Self::I8 | Self::U8 => a.into(),
            Self::I16 | Self::U16 => u16::from_le_bytes([a, b]).into(),
            Self::U32 | Self::F32 => u32::from_le_bytes([a, b, c, d]),
        }
    }
}

/// The bytes of a `data:` URI or of a file, with the media type that a `data:` URI states.
pub fn read_uri(files: &Files, folder: &Path, uri: &str) -> Result<(Option<String>, Vec<u8>), String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (head, body) = data.split_once(',').ok_or("its data: URI has no data")?;
        let (media, is_base64) = head.strip_suffix(";base64").map_or((head, false), |media| (media, true));
        let bytes = if is_base64 {
            let body: String = body.chars().filter(|character| !character.is_whitespace()).collect();
            let engine = base64::engine::GeneralPurpose::new(
                &base64::alphabet::STANDARD,
                base64::engine::GeneralPurposeConfig::new()
                    .with_decode_padding_mode(base64::engine::DecodePaddingMode::Indifferent)
                    .with_decode_allow_trailing_bits(true),
            );
            engine.decode(body).map_err(|error| format!("its data: URI is not base64: {error}"))?
        } else {
            percent_decoded(body).into_owned()
        };
        return Ok((Some(media.to_owned()), bytes));
    }
    let path = file_of(files, folder, uri)?;
    let bytes = files.read(&path, MOST_MODEL_BYTES).map_err(|error| format!("{}: cannot be read: {error}", show(&path)))?;
    Ok((None, bytes.into_owned()))
}

/// The file that a URI names.
pub fn file_of(files: &Files, folder: &Path, uri: &str) -> Result<std::path::PathBuf, String> {
    let short = |uri: &str| uri.chars().take(80).collect::<String>();
    if uri.contains("://") {
        return Err(format!("{} is not on this machine; only files are read", short(uri)));
    }
    let decoded = String::from_utf8_lossy(&percent_decoded(uri)).into_owned();
    let found = files.find(folder, &decoded).or_else(|| files.find(folder, uri));
    found.map(|found| found.path).ok_or_else(|| format!("there is no file {}", short(&decoded)))
}

/// `%20` is a blank.
fn percent_decoded(text: &str) -> Cow<'_, [u8]> {
    if !text.contains('%') {
        return Cow::Borrowed(text.as_bytes());
    }
    let bytes = text.as_bytes();
    let mut decoded = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        let hex = bytes.get(at + 1..at + 3).and_then(|hex| std::str::from_utf8(hex).ok());
        match hex.filter(|_| bytes[at] == b'%').and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                decoded.push(byte);
                at += 3;
            }
            None => {
                decoded.push(bytes[at]);
                at += 1;
            }
        }
    }
    Cow::Owned(decoded)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn integers_that_stand_for_fractions_become_them() {
        let rows = [
            (Component::I8, &[0x81][..], -1.0),
            (Component::I8, &[0x80], -1.0),
            (Component::U8, &[255], 1.0),
            (Component::I16, &[0xff, 0x7f], 1.0),
            (Component::U16, &[0, 0x80], 32_768.0 / 65_535.0),
        ];
        for (kind, bytes, expected) in rows {
            assert_eq!(kind.number(bytes, true), expected, "{kind:?}");
        }
        assert_eq!(Component::I8.number(&[0x81], false), -127.0);
    }

    #[test]
    fn names_of_files_may_be_encoded() {
        assert_eq!(&*percent_decoded("a%20b%2"), b"a b%2");
        let (media, bytes) = read_uri(&Files::default(), Path::new(""), "data:image/png;base64,AQID").unwrap();
        assert_eq!((media.as_deref(), &bytes[..]), (Some("image/png"), &[1, 2, 3][..]));
        assert!(read_uri(&Files::default(), Path::new(""), "data:;base64,?").is_err());
        assert!(read_uri(&Files::default(), Path::new(""), "https://example.com/a.bin").is_err());
    }
}
