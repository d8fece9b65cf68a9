//! NanoVDB files (`.nvdb`) of version 32: either segments, each a header, descriptions of grids, and the grids, perhaps compressed; or grids
//! alone. A grid is a block of memory as devices have it: its head, a tree's head, and nodes that refer to their children by distances in bytes.

use std::collections::HashSet;
use std::io::Read as _;

use flate2::read::ZlibDecoder;

use super::blosc;
use super::bytes::Bytes;
use super::choice::{VolumeError, choose, with_cause};
use super::dense::{ActiveBox, Dense, Node, Tile, map_of_rows, place_in_node};
use super::number::{Number, Value, ValueType};
use super::placed_grid::PlacedGrid;

/// Begins files of segments, the first also grids within them; and grids of newer programs.
const OLD_SIGNATURE: &[u8; 8] = b"NanoVDB0";
const GRID_SIGNATURE: &[u8; 8] = b"NanoVDB1";
const FILE_SIGNATURE: &[u8; 8] = b"NanoVDB2";
/// The version that is read, the upper bits of a number.
const MAJOR: u32 = 32;
const MAJOR_SHIFT: u32 = 21;
/// Bytes of a grid that Blosc compresses at once.
const MOST_CHUNK: u64 = 1 << 30;
/// Bytes of heads.
const GRID_HEAD: u64 = 672;
const NAME_BYTES: usize = 256;
/// The class of grids that are level sets.
const LEVEL_SET: u32 = 1;

pub fn is_signature(content: &[u8]) -> bool {
    [OLD_SIGNATURE, GRID_SIGNATURE, FILE_SIGNATURE].iter().any(|signature| content.starts_with(*signature))
}

/// A grid in a file.
struct Description {
    name: String,
    /// Bytes of the grid, and those that it takes in the file.
    size: u64,
    stored: u64,
    place: u64,
    codec: u16,
}

pub fn read(content: &[u8], name: Option<&str>, memory: u64) -> Result<PlacedGrid, VolumeError> {
    let descriptions = if content.starts_with(GRID_SIGNATURE) { bare_grids(content) } else { segments(content) }?;
    let names: Vec<String> = descriptions.iter().map(|description| description.name.clone()).collect();
    let chosen = &descriptions[choose(&names, name)?];
    let mut bytes = Bytes::from(content, chosen.place)?;
    let stored = bytes.take(usize::try_from(chosen.stored).map_err(|_| "it ends early".to_owned())?)?;
    let decompressed;
    let grid = match chosen.codec {
        0 => stored.get(..usize::try_from(chosen.size).unwrap_or(usize::MAX)).ok_or_else(|| "it ends early".to_owned())?,
        codec => {
            decompressed = decompress(stored, chosen.size, codec, memory)?;
            &decompressed
        }
    };
    let grid = Grid::new(grid)?;
    let (map, is_level_set) = (grid.map()?, grid.class()? == LEVEL_SET);
    grid.dense(memory)?.into_grid(map).map_err(|reason| with_cause(reason, is_level_set))
}

fn check_version(version: u32) -> Result<(), String> {
    let major = version >> MAJOR_SHIFT;
    if major == MAJOR {
        return Ok(());
    }
    Err(format!(
        "its version of the format NanoVDB is {major}; {MAJOR} is read, and `nanovdb_convert` makes it of an OpenVDB file"
    ))
}

/// The grids of a file of segments.
fn segments(content: &[u8]) -> Result<Vec<Description>, String> {
    let mut bytes = Bytes::new(content);
    let mut all = Vec::new();
    while bytes.left() > 0 {
        let signature: [u8; 8] = bytes.array()?;
        if &signature != OLD_SIGNATURE && &signature != FILE_SIGNATURE {
            return Err("one of its segments does not begin as such a segment does".to_owned());
        }
        check_version(bytes.u32()?)?;
        let (count, codec) = (bytes.u16()?, bytes.u16()?);
        let first = all.len();
        for _ in 0..count {
            let (size, stored) = (bytes.u64()?, bytes.u64()?);
            // Keys, types and boxes, which the grid has as well.
            bytes.take(120)?;
            let name_bytes = bytes.u32()? as usize;
            bytes.take(36)?;
            let name = bytes.take(name_bytes)?;
            all.push(Description { name: text_to_zero(name), size, stored, place: 0, codec });
        }
        for description in &mut all[first..] {
            description.place = bytes.place();
            bytes.take(usize::try_from(description.stored).unwrap_or(usize::MAX))?;
        }
    }
    Ok(all)
}

/// The grids of a file that has nothing else.
fn bare_grids(content: &[u8]) -> Result<Vec<Description>, String> {
    let mut bytes = Bytes::new(content);
    let mut all = Vec::new();
    while bytes.left() > 0 {
        let place = bytes.place();
        let head = Bytes::from(content, place)?.take(GRID_HEAD as usize)?;
        let size = Bytes::from(head, 32)?.u64()?;
        if !head.starts_with(GRID_SIGNATURE) || size < GRID_HEAD {
            return Err("one of its grids does not begin as such a grid does".to_owned());
        }
        bytes.take(usize::try_from(size).unwrap_or(usize::MAX))?;
        all.push(Description { name: text_to_zero(&head[40..40 + NAME_BYTES]), size, stored: size, place, codec: 0 });
    }
    Ok(all)
}

fn text_to_zero(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|&byte| byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// The bytes of a grid that is compressed by zlib (1) or Blosc (2), in chunks after their sizes.
fn decompress(stored: &[u8], size: u64, codec: u16, memory: u64) -> Result<Vec<u8>, String> {
    if size > memory {
        return Err(format!("its grid takes {} MiB, and there are {} MiB of memory for it", size >> 20, memory >> 20));
    }
    let damaged = || "a compressed block of it is damaged".to_owned();
    let mut bytes = Bytes::new(stored);
    let mut grid = Vec::new();
    while (grid.len() as u64) < size {
        let length = bytes.u64()?;
        let chunk = bytes.take(usize::try_from(length).unwrap_or(usize::MAX))?;
        match codec {
            // Only as much memory is taken as there is content for.
            1 => ZlibDecoder::new(chunk).take(size).read_to_end(&mut grid).map_err(|_| damaged())?,
            2 => {
                let (start, wanted) = (grid.len(), (size - grid.len() as u64).min(MOST_CHUNK) as usize);
                // LZ4 makes at most 255 bytes of one.
                if wanted / 256 > chunk.len() {
                    return Err(damaged());
                }
                grid.resize(start + wanted, 0);
                blosc::decompress(chunk, &mut grid[start..])?;
                wanted
            }
            _ => return Err(format!("its grid is compressed by the unknown method {codec}")),
        };
        if codec == 1 && grid.len() as u64 != size {
            return Err(damaged());
        }
    }
    Ok(grid)
}

/// A node's values by how they are stored.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Leaves {
    Plain,
    /// So many bits of a share of the range of values in the leaf.
    Bits(usize),
    /// So many bits as the leaf says.
    BitsOfLeaf,
}

/// Places of things in nodes, which differ by the type of values.
struct Layout {
    value: ValueType,
    leaves: Leaves,
    root_background: u64,
    root_size: u64,
    tile_value: u64,
    tile_size: u64,
    upper_table: u64,
    lower_table: u64,
    leaf_table: u64,
    /// Bytes of an entry of a node's table: a value, or a distance to a child.
    entry: u64,
}

impl Layout {
    /// The layout for a type of grid by its number.
    fn of(kind: u32) -> Option<Self> {
        let value = |number, channels| ValueType { number, channels };
        let float = Self {
            value: value(Number::Float, 1),
            leaves: Leaves::Plain,
            root_background: 28,
            root_size: 64,
            tile_value: 20,
            tile_size: 32,
            upper_table: 8256,
            lower_table: 1088,
            leaf_table: 96,
            entry: 8,
        };
        let double = Self {
            value: value(Number::Double, 1),
            root_background: 32,
            root_size: 96,
            tile_value: 24,
            leaf_table: 128,
            ..float
        };
        Some(match kind {
            1 => float,
            2 => double,
            4 => Self { value: value(Number::Int32, 1), ..float },
            5 => Self { value: value(Number::Int64, 1), ..double },
            6 => Self { value: value(Number::Float, 3), root_size: 96, leaf_table: 128, entry: 16, ..float },
            7 => Self {
                value: value(Number::Double, 3),
                root_size: 128,
                tile_size: 64,
                upper_table: 8288,
                lower_table: 1120,
                leaf_table: 160,
                entry: 24,
                ..double
            },
            9 => Self { value: value(Number::Half, 1), ..float },
            13 => Self { leaves: Leaves::Bits(4), ..float },
            14 => Self { leaves: Leaves::Bits(8), ..float },
            15 => Self { leaves: Leaves::Bits(16), ..float },
            16 => Self { leaves: Leaves::BitsOfLeaf, ..float },
            _ => return None,
        })
    }
}

/// A level of nodes that are not leaves.
#[derive(Clone, Copy)]
struct Level {
    side: usize,
    /// Side of a child in voxels.
    child_side: i64,
}

const UPPER: Level = Level { side: 32, child_side: 128 };
const LOWER: Level = Level { side: 16, child_side: 8 };
const LEAF_SIDE: usize = 8;
const LEAF_VOXELS: usize = 512;
/// Side of a root's child in voxels, by its bits.
const ROOT_BITS: u32 = 12;
/// Bits of a coordinate in a root's key.
const KEY_BITS: u32 = 21;
/// Masks of nodes and of leaves begin here.
const NODE_MASKS: u64 = 32;
const LEAF_MASK: u64 = 16;

/// A grid's block of memory.
struct Grid<'b> {
    bytes: &'b [u8],
    layout: Layout,
}

/// Who is told of tiles, and of leaves with their places in the block.
type Visit<'v> = &'v mut dyn FnMut(Node<u64>) -> Result<(), String>;

impl<'b> Grid<'b> {
    fn new(bytes: &'b [u8]) -> Result<Self, String> {
        let at = |place| Bytes::from(bytes, place);
        let signature = at(0)?.take(8)?;
        if signature != OLD_SIGNATURE && signature != GRID_SIGNATURE {
            return Err("its grid does not begin as such a grid does".to_owned());
        }
        check_version(at(16)?.u32()?)?;
        let kind = at(636)?.u32()?;
        let layout = Layout::of(kind).ok_or_else(|| {
            format!("its grid is of type {kind} of NanoVDB; float, double, half, int32, int64, vec3f, vec3d and the quantised fp4, fp8, fp16 and fpN are read")
        })?;
        Ok(Self { bytes, layout })
    }

    fn at(&self, place: u64) -> Result<Bytes<'b>, String> {
        Bytes::from(self.bytes, place)
    }

    /// The place of a node at a distance from another one.
    fn along(&self, place: u64, distance: i64) -> Result<u64, String> {
        let node = place.checked_add_signed(distance).filter(|&node| node < self.bytes.len() as u64);
        node.ok_or_else(|| "a node of its grid refers to one outside of the grid".to_owned())
    }

    fn class(&self) -> Result<u32, String> {
        self.at(632)?.u32()
    }

    /// The map from index space, which is the second half of a record that has it in single precision before.
    fn map(&self) -> Result<glam::DAffine3, String> {
        let mut bytes = self.at(296 + 88)?;
        let rows = bytes.f64s()?;
        let _inverse: [f64; 9] = bytes.f64s()?;
        Ok(map_of_rows(rows, bytes.f64s()?))
    }

    fn value(&self, place: u64) -> Result<Value, String> {
        Ok(self.layout.value.read(self.at(place)?.take(self.layout.value.size())?))
    }

    fn dense(&self, memory: u64) -> Result<Dense, String> {
        let root = self.along(GRID_HEAD, self.at(GRID_HEAD + 24)?.i64()?)?;
        let background = self.value(root + self.layout.root_background)?;
        let mut active = ActiveBox::default();
        self.walk(root, &mut |node| match node {
            Node::Tile(tile) => {
                active.add_tile(&tile);
                Ok(())
            }
            Node::Leaf { origin, content: place } => {
                active.add_leaf(origin, LEAF_SIDE, self.at(place + LEAF_MASK)?.take(LEAF_VOXELS / 8)?);
                Ok(())
            }
        })?;
        let mut dense = Dense::new(active, self.layout.value.channels, background, memory)?;
        let mut values = vec![background; LEAF_VOXELS];
        self.walk(root, &mut |node| match node {
            Node::Tile(tile) => {
                dense.fill(&tile);
                Ok(())
            }
            Node::Leaf { origin, content: place } => {
                self.leaf_values(place, &mut values)?;
                dense.set_leaf(origin, LEAF_SIDE, &values);
                Ok(())
            }
        })?;
        Ok(dense)
    }

    /// Visits all tiles and leaves.
    fn walk(&self, root: u64, visit: Visit<'_>) -> Result<(), String> {
        let Layout { root_size, tile_size, tile_value, .. } = self.layout;
        // Each node has one parent, so that there are no more than the block has room for.
        let mut nodes = self.bytes.len() as u64 / self.layout.leaf_table;
        let mut origins = HashSet::new();
        for tile in 0..u64::from(self.at(root + 24)?.u32()?) {
            let place = root + root_size + tile * tile_size;
            let mut bytes = self.at(place)?;
            let (key, child, state) = (bytes.u64()?, bytes.i64()?, bytes.u32()?);
            // A coordinate has 32 bits, of which the key has the upper ones.
            let coordinate = |shift: u32| i64::from(((key >> shift & ((1 << KEY_BITS) - 1)) as i32) << ROOT_BITS);
            let origin = [coordinate(2 * KEY_BITS), coordinate(KEY_BITS), coordinate(0)];
            if !origins.insert(origin) {
                return Err(format!("its grid has a second node at {origin:?}"));
            }
            if child == 0 {
                let value = self.value(place + tile_value)?;
                visit(Node::Tile(Tile { origin, side: 1 << ROOT_BITS, value, is_active: state != 0 }))?;
            } else {
                self.node(self.along(root, child)?, origin, &[UPPER, LOWER], &mut nodes, visit)?;
            }
        }
        Ok(())
    }

    fn node(&self, place: u64, origin: [i64; 3], levels: &[Level], nodes: &mut u64, visit: Visit<'_>) -> Result<(), String> {
        *nodes = nodes.checked_sub(1).ok_or_else(|| "nodes of its grid have several parents".to_owned())?;
        let [Level { side, child_side }, deeper @ ..] = levels else { return visit(Node::Leaf { origin, content: place }) };
        let count = side * side * side;
        let mut masks = self.at(place + NODE_MASKS)?;
        let (active, children) = (masks.take(count / 8)?, masks.take(count / 8)?);
        let table = if deeper.is_empty() { self.layout.lower_table } else { self.layout.upper_table };
        for index in 0..count {
            let entry = place + table + index as u64 * self.layout.entry;
            let [x, y, z] = place_in_node(index, *side);
            let origin = [origin[0] + x * child_side, origin[1] + y * child_side, origin[2] + z * child_side];
            let is_set = |mask: &[u8]| mask[index / 8] >> (index % 8) & 1 == 1;
            if is_set(children) {
                let child = self.along(place, self.at(entry)?.i64()?)?;
                self.node(child, origin, deeper, nodes, visit)?;
            } else {
                let value = self.value(entry)?;
                visit(Node::Tile(Tile { origin, side: *child_side, value, is_active: is_set(active) }))?;
            }
        }
        Ok(())
    }

    /// The values of a leaf. Quantised ones are shares of its range, of which the smallest value and the step stand before the table.
    fn leaf_values(&self, place: u64, values: &mut [Value]) -> Result<(), String> {
        let table = place + self.layout.leaf_table;
        let bits = match self.layout.leaves {
            Leaves::Plain => {
                let stored = self.at(table)?.take(values.len() * self.layout.value.size())?;
                values.iter_mut().zip(self.layout.value.read_all(stored)).for_each(|(value, stored)| *value = stored);
                return Ok(());
            }
            Leaves::Bits(bits) => bits,
            // The upper three bits of the flags are the logarithm of their number.
            Leaves::BitsOfLeaf => match self.at(place + 15)?.u8()? >> 5 {
                logarithm @ 0..=4 => 1 << logarithm,
                logarithm => return Err(format!("a leaf of its grid has values of 2^{logarithm} bits")),
            },
        };
        let mut range = self.at(table - 16)?;
        let (smallest, step) = (range.f32()?, range.f32()?);
        let codes = self.at(table)?.take(values.len() * bits / 8)?;
        for (index, value) in values.iter_mut().enumerate() {
            let first = index * bits;
            let code = match bits {
                16 => u16::from_le_bytes([codes[first / 8], codes[first / 8 + 1]]),
                _ => u16::from(codes[first / 8]) >> (first % 8) & ((1 << bits) - 1),
            };
            *value = [f32::from(code) * step + smallest; 3];
        }
        Ok(())
    }
}
