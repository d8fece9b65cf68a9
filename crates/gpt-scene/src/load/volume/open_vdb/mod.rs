//! OpenVDB files (`.vdb`) of version 220 and later: a header, properties of the file, and grids one after the other, each after a description that
//! says where it stands.
//!
//! - `tree`: the nodes of a grid's tree; `values`: the compressed values of a node; `map`: the transform from index space.

mod map;
mod tree;
mod values;
mod version;

use std::collections::HashSet;

use super::bytes::Bytes;
use super::choice::{VolumeError, choose, with_cause};
use super::number::{Number, ValueType};
use super::placed_grid::PlacedGrid;
use values::Compression;
use version::{NEWEST, NODE_MASK_COMPRESSION, SELECTIVE_COMPRESSION};

const SIGNATURE: &[u8; 8] = b" BDV\0\0\0\0";
/// Bytes of the identifier in the header.
const IDENTIFIER: usize = 36;
/// Ends the type of grids whose numbers are saved in half precision.
const HALF_SUFFIX: &str = "_HalfFloat";
/// Stands before the number that tells grids of one name apart.
const NUMBER_SEPARATOR: char = '\x1e';

pub fn is_signature(content: &[u8]) -> bool {
    content.starts_with(SIGNATURE)
}

/// A grid's description.
struct Description {
    /// The name with the number that tells equal names apart.
    unique_name: String,
    /// The type of the tree, such as `Tree_float_5_4_3`.
    tree_type: String,
    /// Numbers are saved in half precision.
    is_half: bool,
    /// The grid whose tree this one shares; empty where it has its own.
    parent: String,
    /// The place of the grid in the file.
    place: u64,
}

impl Description {
    fn name(&self) -> &str {
        self.unique_name.split(NUMBER_SEPARATOR).next().unwrap_or_default()
    }
}

/// The header's words that matter.
struct Header {
    version: u32,
    /// For all grids of old files.
    compression: Compression,
}

pub fn read(content: &[u8], name: Option<&str>, memory: u64) -> Result<PlacedGrid, VolumeError> {
    let mut bytes = Bytes::from(content, SIGNATURE.len() as u64)?;
    let header = header(&mut bytes)?;
    skip_properties(&mut bytes)?;
    let descriptions = descriptions(content, &mut bytes)?;
    let names: Vec<String> = descriptions.iter().map(|description| description.name().to_owned()).collect();
    let chosen = &descriptions[choose(&names, name)?];
    let mut grid = Bytes::from(content, chosen.place)?;
    let mut opening = opening(&mut grid, &header)?;
    let mut owner = chosen;
    let mut seen = HashSet::new();
    while !owner.parent.is_empty() {
        let parent = descriptions.iter().find(|other| other.unique_name == owner.parent);
        owner = parent.ok_or_else(|| format!("its grid shares the tree of `{}`, which it does not have", owner.parent))?;
        if !seen.insert(&owner.unique_name) {
            return Err("its grids share their trees in a circle".to_owned().into());
        }
        grid = Bytes::from(content, owner.place)?;
        opening.compression = self::opening(&mut grid, &header)?.compression;
    }
    let (dimensions, stored) = tree_type(owner)?;
    let format = values::Format { version: header.version, compression: opening.compression, stored, is_half: owner.is_half };
    let dense = tree::read(grid, &dimensions, &format, memory)?;
    dense.into_grid(opening.map).map_err(|reason| with_cause(reason, opening.is_level_set))
}

fn header(bytes: &mut Bytes<'_>) -> Result<Header, String> {
    let version = bytes.u32()?;
    if !(SELECTIVE_COMPRESSION..=NEWEST).contains(&version) {
        let advice = if version > NEWEST { "is too new" } else { "is too old: a newer OpenVDB can read it and write it again" };
        return Err(format!(
            "its version of the format OpenVDB, {version}, {advice} ({SELECTIVE_COMPRESSION} to {NEWEST} are read)"
        ));
    }
    let _library = [bytes.u32()?, bytes.u32()?];
    if bytes.u8()? == 0 {
        return Err("it was written as a stream, without the places of its grids; OpenVDB's `vdb_tool -read IN -write OUT` writes it anew".to_owned());
    }
    let mut compression = Compression::default();
    if version < NODE_MASK_COMPRESSION {
        compression.zip = bytes.u8()? != 0;
    }
    bytes.take(IDENTIFIER)?;
    Ok(Header { version, compression })
}

/// Names, types and values, of which nothing is used.
fn skip_properties(bytes: &mut Bytes<'_>) -> Result<(), String> {
    each_property(bytes, |_, _, _| ())
}

fn each_property(bytes: &mut Bytes<'_>, mut visit: impl FnMut(&str, &str, &[u8])) -> Result<(), String> {
    for _ in 0..bytes.u32()? {
        let (name, kind) = (bytes.text()?, bytes.text()?);
        let length = bytes.u32()? as usize;
        visit(&name, &kind, bytes.take(length)?);
    }
    Ok(())
}

fn descriptions<'b>(content: &'b [u8], bytes: &mut Bytes<'b>) -> Result<Vec<Description>, String> {
    let count = bytes.u32()?;
    let mut descriptions = Vec::new();
    for _ in 0..count {
        let (unique_name, mut tree_type, parent) = (bytes.text()?, bytes.text()?, bytes.text()?);
        let is_half = tree_type.ends_with(HALF_SUFFIX);
        if is_half {
            tree_type.truncate(tree_type.len() - HALF_SUFFIX.len());
        }
        let (place, _blocks, end) = (bytes.u64()?, bytes.u64()?, bytes.u64()?);
        if place < bytes.place() || end < place {
            return Err(format!("its grid `{unique_name}` cannot be at byte {place} and end at byte {end}"));
        }
        if end > content.len() as u64 {
            return Err(format!("it ends early: its grid `{unique_name}` ends at byte {end}, and there are {}", content.len()));
        }
        *bytes = Bytes::from(content, end)?;
        descriptions.push(Description { unique_name, tree_type, is_half, parent, place });
    }
    Ok(descriptions)
}

/// The part of a grid before its tree.
struct Opening {
    compression: Compression,
    map: glam::DAffine3,
    is_level_set: bool,
}

fn opening(bytes: &mut Bytes<'_>, header: &Header) -> Result<Opening, String> {
    let compression =
        if header.version >= NODE_MASK_COMPRESSION { Compression::from_bits(bytes.u32()?) } else { header.compression };
    let mut is_level_set = false;
    each_property(bytes, |name, _, value| is_level_set |= name == "class" && value == b"level set")?;
    Ok(Opening { compression, map: map::read(bytes)?, is_level_set })
}

/// The numbers of bits of a coordinate at each level, from the top to leaves, and how a value is stored.
fn tree_type(description: &Description) -> Result<(Vec<u32>, ValueType), String> {
    let refused = || {
        let Description { tree_type, .. } = description;
        format!(
            "its grid `{}` is of type {tree_type}; grids of one number (float, double, half, int32, int64) and of three (vec3s, vec3d) are read",
            description.name()
        )
    };
    let mut parts = description.tree_type.strip_prefix("Tree_").ok_or_else(refused)?.split('_');
    let (number, channels) = match parts.next().unwrap_or_default() {
        "float" => (Number::Float, 1),
        "double" => (Number::Double, 1),
        "half" => (Number::Half, 1),
        "int32" => (Number::Int32, 1),
        "int64" => (Number::Int64, 1),
        "vec3s" => (Number::Float, 3),
        "vec3d" => (Number::Double, 3),
        _ => return Err(refused()),
    };
    let dimensions: Vec<u32> = parts.map(str::parse).collect::<Result<_, _>>().map_err(|_| refused())?;
    let total = dimensions.iter().try_fold(0_u32, |sum, &bits| sum.checked_add(bits));
    let is_usual = (2..=4).contains(&dimensions.len())
        && dimensions.iter().all(|bits| (1..=5).contains(bits))
        && total.is_some_and(|total| total <= 20);
    if is_usual { Ok((dimensions, ValueType { number, channels })) } else { Err(refused()) }
}
