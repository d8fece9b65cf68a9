//! The nodes of a tree: first all of them with their masks and the values of tiles, then the values of leaves in the same order.

use std::collections::HashSet;

use super::values::{Format, is_set};
use super::version::NODE_MASK_COMPRESSION;
use crate::load::volume::bytes::Bytes;
use crate::load::volume::dense::{ActiveBox, Dense, Node, Tile, place_in_node};
use crate::load::volume::number::Value;

/// Reads a tree with so many bits of a coordinate at each level, from the top to leaves, into at most so many bytes of memory.
pub fn read(mut bytes: Bytes<'_>, dimensions: &[u32], format: &Format, memory: u64) -> Result<Dense, String> {
    let buffers = bytes.i32()?;
    if buffers != 1 {
        return Err(format!("its grid has {buffers} buffers, and not 1"));
    }
    let topology = bytes;
    let background = format.value(&mut bytes)?;
    let walk = Walk { dimensions, format, background };
    let (leaf_bits, leaf_side) = (dimensions[dimensions.len() - 1], 1_usize << dimensions[dimensions.len() - 1]);
    let mut active = ActiveBox::default();
    let mut leaves = Vec::new();
    bytes = walk.root(topology, &mut |node| match node {
        Node::Tile(tile) => active.add_tile(&tile),
        Node::Leaf { origin, content: mask } => {
            active.add_leaf(origin, leaf_side, mask);
            leaves.push((origin, mask));
        }
    })?;
    let mut dense = Dense::new(active, format.stored.channels, background, memory)?;
    // Now that the box is known, tiles are read again: there may be more of them than memory holds.
    walk.root(topology, &mut |node| {
        if let Node::Tile(tile) = node {
            dense.fill(&tile);
        }
    })?;
    let mut values = vec![background; 1 << (3 * leaf_bits)];
    for (origin, mask) in leaves {
        // The mask comes once more; in old files the origin and the number of buffers too.
        bytes.take(mask.len())?;
        let mut buffers = 1;
        if format.version < NODE_MASK_COMPRESSION {
            bytes.coordinate()?;
            buffers = bytes.u8()?;
        }
        if buffers != 1 {
            return Err(format!("a leaf of its grid has {buffers} buffers, and not 1"));
        }
        format.values(&mut bytes, mask, background, &mut values)?;
        dense.set_leaf(origin, leaf_side, &values);
    }
    Ok(dense)
}

/// A way through all nodes.
struct Walk<'w> {
    dimensions: &'w [u32],
    format: &'w Format,
    background: Value,
}

/// Who is told of tiles, and of leaves with their masks.
type Visit<'v, 'b> = &'v mut dyn FnMut(Node<&'b [u8]>);

impl Walk<'_> {
    /// Visits all tiles and leaves; the place after them.
    fn root<'b>(&self, mut bytes: Bytes<'b>, visit: Visit<'_, 'b>) -> Result<Bytes<'b>, String> {
        self.format.value(&mut bytes)?;
        let (tiles, children) = (bytes.u32()?, bytes.u32()?);
        let side = 1_i64 << self.dimensions.iter().sum::<u32>();
        // Cubes that overlap would be filled in over and over.
        let mut origins = HashSet::new();
        let mut origin = |bytes: &mut Bytes<'b>| {
            let origin = bytes.coordinate()?;
            let is_new = origin.iter().all(|index| index % side == 0) && origins.insert(origin);
            if is_new { Ok(origin) } else { Err(format!("its grid has a second node at {origin:?}, or one at the wrong place")) }
        };
        for _ in 0..tiles {
            let origin = origin(&mut bytes)?;
            let value = self.format.value(&mut bytes)?;
            let is_active = bytes.u8()? != 0;
            visit(Node::Tile(Tile { origin, side, value, is_active }));
        }
        for _ in 0..children {
            let origin = origin(&mut bytes)?;
            self.node(&mut bytes, origin, 0, visit)?;
        }
        Ok(bytes)
    }

    fn node<'b>(&self, bytes: &mut Bytes<'b>, origin: [i64; 3], level: usize, visit: Visit<'_, 'b>) -> Result<(), String> {
        let bits = self.dimensions[level];
        let count = 1_usize << (3 * bits);
        if level + 1 == self.dimensions.len() {
            visit(Node::Leaf { origin, content: bytes.take(count / 8)? });
            return Ok(());
        }
        let (children, active) = (bytes.take(count / 8)?, bytes.take(count / 8)?);
        let is_tile = |index: &usize| !is_set(children, *index);
        let child_side = 1_i64 << self.dimensions[level + 1..].iter().sum::<u32>();
        let place = |index: usize| {
            let [x, y, z] = place_in_node(index, 1 << bits);
            [origin[0] + x * child_side, origin[1] + y * child_side, origin[2] + z * child_side]
        };
        // Old files have values for tiles alone.
        let has_all = self.format.version >= NODE_MASK_COMPRESSION;
        let tiles = (0..count).filter(is_tile);
        let mut values = vec![self.background; if has_all { count } else { tiles.clone().count() }];
        self.format.values(bytes, active, self.background, &mut values)?;
        for (number, index) in tiles.enumerate() {
            let value = values[if has_all { index } else { number }];
            visit(Node::Tile(Tile { origin: place(index), side: child_side, value, is_active: is_set(active, index) }));
        }
        for index in (0..count).filter(|index| is_set(children, *index)) {
            self.node(bytes, place(index), level + 1, visit)?;
        }
        Ok(())
    }
}
