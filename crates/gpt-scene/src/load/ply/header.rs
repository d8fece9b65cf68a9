//! Headers of PLY files: the elements that a file has, and how they are written.

use std::io::{self, BufRead};

use crate::load::mends::Mends;
use crate::load::spelling::lines::{trimmed, words};
use crate::load::spelling::numbers::integer;

/// Longest header in bytes.
const LONGEST: usize = 1 << 20;

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    Text,
    Binary { big_endian: bool },
}

#[derive(Debug)]
pub struct Header {
    pub format: Format,
    pub elements: Vec<Element>,
    /// Lines that it has.
    pub lines: usize,
}

#[derive(Debug)]
pub struct Element {
    pub name: String,
    /// None: as many as there are.
    pub count: Option<u64>,
    pub properties: Vec<Property>,
}

#[derive(Debug)]
pub struct Property {
    /// In lower case.
    pub name: String,
    pub kind: Kind,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Scalar(Type),
    List { count: Type, item: Type },
}

/// How a number is written in binary.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
    /// A name that is not known; text needs none.
    Unknown,
}

impl Type {
    fn of(name: &str) -> Self {
        match name.to_ascii_lowercase().as_str() {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "int64" => Self::I64,
            "uint64" => Self::U64,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => Self::Unknown,
        }
    }

    /// Bytes.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 | Self::Unknown => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }

    /// The number in as many bytes as it has, the least significant one first.
    pub fn decode(self, bytes: [u8; 8]) -> f64 {
        let word = u64::from_le_bytes(bytes);
        match self {
            Self::I8 => f64::from(word as i8),
            Self::U8 | Self::Unknown => f64::from(word as u8),
            Self::I16 => f64::from(word as i16),
            Self::U16 => f64::from(word as u16),
            Self::I32 => f64::from(word as i32),
            Self::U32 => f64::from(word as u32),
            Self::I64 => word as i64 as f64,
            Self::U64 => word as f64,
            Self::F32 => f64::from(f32::from_bits(word as u32)),
            Self::F64 => f64::from_bits(word),
        }
    }

    /// The factor of a number, where integers stand for shares of 1.
    pub fn share(self) -> f64 {
        match self {
            Self::U8 => 1.0 / 255.0,
            Self::U16 => 1.0 / 65_535.0,
            _ => 1.0,
        }
    }
}

/// Lines of bytes, which end in LF, CR or both, as the first one does where both are possible.
struct HeaderLines<'r> {
    reader: &'r mut dyn BufRead,
    read: usize,
    /// The first line ended in CR alone.
    by_cr: Option<bool>,
}

impl HeaderLines<'_> {
    fn byte(&mut self) -> io::Result<Option<u8>> {
        let byte = self.reader.fill_buf()?.first().copied();
        if byte.is_some() {
            self.reader.consume(1);
            self.read += 1;
        }
        Ok(byte)
    }

    /// None where the file ends, or the header is too long.
    fn next(&mut self) -> io::Result<Option<String>> {
        let mut line = Vec::new();
        loop {
            match self.byte()? {
                None if line.is_empty() => return Ok(None),
                None | Some(b'\n') => break,
                Some(b'\r') => {
                    // Data may begin with the byte of LF.
                    let has_both = self.by_cr != Some(true) && self.reader.fill_buf()?.first() == Some(&b'\n');
                    self.by_cr.get_or_insert(!has_both);
                    if has_both {
                        self.byte()?;
                    }
                    break;
                }
                Some(byte) => line.push(byte),
            }
            if self.read > LONGEST {
                return Ok(None);
            }
        }
        Ok(Some(String::from_utf8_lossy(&line).into_owned()))
    }
}

/// Reads the header and leaves the reader where data begin. The error says what is wrong, without the file's name.
pub fn read(reader: &mut dyn BufRead, mends: &mut Mends) -> Result<Header, String> {
    let cannot_be_read = |error: io::Error| format!("cannot be read: {error}");
    let mut lines = HeaderLines { reader, read: 0, by_cr: None };
    let mut header = Header { format: Format::Text, elements: Vec::new(), lines: 0 };
    let mut format = None;
    let mut is_begun = false;
    let mut unknown_type = None;
    while let Some(line) = lines.next().map_err(cannot_be_read)? {
        header.lines += 1;
        let line = trimmed(&line);
        if line.is_empty() {
            continue;
        }
        if !is_begun {
            if !line.eq_ignore_ascii_case("ply") {
                return Err("is not a PLY file: it does not begin with `ply`".to_owned());
            }
            is_begun = true;
            continue;
        }
        let mut rest = words(line);
        let statement = rest.next().unwrap_or("").to_ascii_lowercase();
        let rest: Vec<&str> = rest.collect();
        match (statement.as_str(), rest.as_slice()) {
            ("comment" | "obj_info", _) => {}
            (statement, _) if statement.starts_with('#') => {}
            ("end_header", _) => {
                header.format = format.unwrap_or_else(|| {
                    mends.add("a header without `format` is taken to be of text", header.lines, line);
                    Format::Text
                });
                return match unknown_type {
                    Some((number, line)) if header.format != Format::Text => {
                        Err(format!("is not a valid PLY file: line {number}, `{line}`: the type is not known"))
                    }
                    _ => Ok(header),
                };
            }
            ("format", [name, ..]) => {
                format = Some(match name.to_ascii_lowercase().as_str() {
                    "ascii" => Format::Text,
                    "binary_little_endian" => Format::Binary { big_endian: false },
                    "binary_big_endian" => Format::Binary { big_endian: true },
                    _ => {
                        let which = "it is none of ascii, binary_little_endian and binary_big_endian";
                        return Err(format!("is not a valid PLY file: line {}, `{line}`: {which}", header.lines));
                    }
                });
            }
            ("element", [name, count @ ..]) => {
                let count = count.first().and_then(|count| integer(count)).filter(|count| (0.0..1e15).contains(&count.value));
                if count.is_none() {
                    mends.add("of an element without a number there are as many as there is room for", header.lines, line);
                }
                let count = count.map(|count| count.value as u64);
                header.elements.push(Element { name: name.to_ascii_lowercase(), count, properties: Vec::new() });
            }
            ("property", [.., name]) if !header.elements.is_empty() && matches!(rest.len(), 2 | 4) => {
                let types: Vec<Type> = rest[..rest.len() - 1].iter().map(|name| Type::of(name)).collect();
                let kind = match (rest[0].eq_ignore_ascii_case("list"), types.as_slice()) {
                    (true, [_, count, item]) => Kind::List { count: *count, item: *item },
                    (_, types) => Kind::Scalar(types[0]),
                };
                let is_unknown = match kind {
                    Kind::Scalar(kind) => kind == Type::Unknown,
                    Kind::List { count, item } => count == Type::Unknown || item == Type::Unknown,
                };
                if is_unknown && unknown_type.is_none() {
                    unknown_type = Some((header.lines, line.chars().take(60).collect::<String>()));
                }
                let last = header.elements.last_mut().expect("there is one");
                last.properties.push(Property { name: name.to_ascii_lowercase(), kind });
            }
            _ => mends.add("lines of the header that are not understood are left out", header.lines, line),
        }
    }
    if !is_begun {
        return Err("is not a PLY file: it does not begin with `ply`".to_owned());
    }
    Err("is not a valid PLY file: it ends before its header does".to_owned())
}
