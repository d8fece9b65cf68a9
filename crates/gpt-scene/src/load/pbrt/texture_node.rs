//! Textures as trees of what they are made of.

use std::path::PathBuf;
use std::rc::Rc;

use crate::load::file::syntax::{TextureFilterEntry, WrapEntry};
use crate::spectrum::Spectrum;

/// Most parts of a texture that are looked at, those that stand in several places counted each time.
pub const MOST_PARTS: u64 = 256;

/// A texture, or a constant in place of one.
#[derive(Debug)]
pub struct TextureNode {
    pub kind: NodeKind,
    /// Its parts, those that stand in several places counted each time.
    pub size: u64,
    /// Its name; empty where it has none.
    pub name: String,
}

#[derive(Debug)]
pub enum NodeKind {
    Constant(Spectrum),
    Image(ImageLeaf),
    Checker([Rc<TextureNode>; 2], Placement),
    /// The colours at (0, 0), (0, 1), (1, 0) and (1, 1), and between them.
    Bilinear([Spectrum; 4], Placement),
    Product([Rc<TextureNode>; 2]),
    /// The second one by the third's share, the first by the rest.
    Mix([Rc<TextureNode>; 3]),
}

/// A picture of a file.
#[derive(Debug, Clone)]
pub struct ImageLeaf {
    pub path: PathBuf,
    /// Integers are no codes of sRGB.
    pub is_linear: bool,
    pub wrap: WrapEntry,
    pub filter: Option<TextureFilterEntry>,
    pub scale: f64,
    /// 1 less the value, once it is scaled.
    pub inverts: bool,
    pub placement: Placement,
}

/// Factors of u and v, and what is added to them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    pub scale: [f64; 2],
    pub offset: [f64; 2],
}

impl Placement {
    pub const IDENTITY: Self = Self { scale: [1.0; 2], offset: [0.0; 2] };
}

impl TextureNode {
    pub fn constant(colour: Spectrum) -> Rc<Self> {
        Rc::new(Self { kind: NodeKind::Constant(colour), size: 1, name: String::new() })
    }

    pub fn as_constant(&self) -> Option<Spectrum> {
        if let NodeKind::Constant(colour) = &self.kind { Some(*colour) } else { None }
    }

    /// A texture of this name, made of its parts.
    pub fn of(kind: NodeKind, name: &str) -> Self {
        let within: &[Rc<Self>] = match &kind {
            NodeKind::Checker(parts, _) | NodeKind::Product(parts) => parts,
            NodeKind::Mix(parts) => parts,
            NodeKind::Constant(_) | NodeKind::Image(_) | NodeKind::Bilinear(..) => &[],
        };
        let size = within.iter().fold(1_u64, |sum, part| sum.saturating_add(part.size));
        Self { kind, size, name: name.to_owned() }
    }
}
