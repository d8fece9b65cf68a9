//! Positions, texture coordinates and normals of OBJ files.

use std::borrow::Cow;
use std::collections::HashMap;

use glam::{Vec2, Vec3};

use super::statements::is_statement;
use crate::load::mends::Mends;
use crate::load::model::FARTHEST;
use crate::load::spelling::lines::{Statements, first_word, without_comment, words};
use crate::load::spelling::numbers::number;

/// All `v`, `vt` and `vn` of a file. What cannot be read is not finite.
#[derive(Default)]
pub struct Vertices {
    pub positions: Vec<Vec3>,
    pub uvs: Vec<Vec2>,
    pub normals: Vec<Vec3>,
    /// Positions that carry a colour.
    pub coloured: usize,
    /// Positions, texture coordinates and normals that cannot be read: their lines by their indices.
    pub unread: [HashMap<u32, (usize, String)>; 3],
}

/// The list that an index of a face's corner is for, in the order in which a corner has them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    Position,
    Uv,
    Normal,
}

impl Kind {
    /// The list that a statement adds to.
    pub fn of(word: &str) -> Option<Self> {
        match word {
            "v" | "V" => Some(Self::Position),
            "vt" | "VT" | "Vt" => Some(Self::Uv),
            "vn" | "VN" | "Vn" => Some(Self::Normal),
            _ => None,
        }
    }
}

/// Numbers of a statement that count, however many there are.
const MOST: usize = 8;

/// The numbers that were read; None stands for what is no number within 1e18.
struct Numbers {
    values: [Option<f32>; MOST],
    count: usize,
    is_odd: bool,
}

impl Numbers {
    fn read(rest: &str, wanted: usize) -> Self {
        // `1,2,3` and `1.0, 2.0`, but not the decimal commas of `1,5 2,5 3,5`.
        let separates = rest.contains(',') && (words(rest).count() < wanted || rest.contains('.') || rest.contains(", "));
        let rest: Cow<'_, str> = if separates { rest.replace(',', " ").into() } else { rest.into() };
        let mut numbers = Self { values: [None; MOST], count: 0, is_odd: separates };
        for word in words(&rest) {
            // Colours are not rendered, so that nothing depends on how they are spelled.
            let read = if numbers.count < 4 { number::<f32>(word).filter(|number| number.value.abs() <= FARTHEST) } else { None };
            if let Some(slot) = numbers.values.get_mut(numbers.count) {
                *slot = read.map(|number| number.value);
            }
            numbers.is_odd |= read.is_some_and(|number| number.is_odd);
            numbers.count += 1;
        }
        numbers
    }

    /// The first ones, where each of them is a number.
    fn first<const N: usize>(&self) -> Option<[f32; N]> {
        let mut first = [0.0; N];
        for (slot, value) in first.iter_mut().zip(self.values) {
            *slot = value?;
        }
        Some(first)
    }
}

impl Vertices {
    pub fn read(text: &str, mends: &mut Mends) -> Self {
        let mut vertices = Self::default();
        for (line, statement) in Statements::new(text, is_statement) {
            let (word, rest) = first_word(&statement);
            let Some(kind) = Kind::of(word) else { continue };
            vertices.statement(kind, line, &statement, without_comment(rest), mends);
        }
        vertices
    }

    fn statement(&mut self, kind: Kind, line: usize, statement: &str, rest: &str, mends: &mut Mends) {
        let wanted = if kind == Kind::Uv { 1 } else { 3 };
        let numbers = Numbers::read(rest, wanted);
        if numbers.is_odd {
            mends.add("numbers in an odd spelling are read as what they most likely are", line, statement);
        }
        let is_read = match kind {
            Kind::Position => {
                let position = self.position(&numbers, line, statement, mends);
                self.positions.push(position.unwrap_or(Vec3::NAN));
                position.is_some()
            }
            Kind::Uv => {
                let v = if numbers.count < 2 { Some(0.0) } else { numbers.values[1] };
                let uv = numbers.values[0].zip(v).map(|(u, v)| Vec2::new(u, v));
                self.uvs.push(uv.unwrap_or(Vec2::NAN));
                uv.is_some()
            }
            Kind::Normal => {
                let normal = numbers.first::<3>().map(Vec3::from);
                self.normals.push(normal.unwrap_or(Vec3::NAN));
                normal.is_some()
            }
        };
        let most = [7, 3, 3][kind as usize];
        if numbers.count > most || (kind == Kind::Position && numbers.count == 5) {
            mends.add("numbers behind those of a vertex are left out", line, statement);
        }
        if !is_read {
            let index = [self.positions.len(), self.uvs.len(), self.normals.len()][kind as usize] as u32 - 1;
            self.unread[kind as usize].insert(index, (line, statement.chars().take(60).collect()));
        }
    }

    fn position(&mut self, numbers: &Numbers, line: usize, statement: &str, mends: &mut Mends) -> Option<Vec3> {
        if let (2, Some([x, y])) = (numbers.count, numbers.first()) {
            mends.add("a position of two numbers has 0 for its third", line, statement);
            return Some(Vec3::new(x, y, 0.0));
        }
        let position = Vec3::from(numbers.first::<3>()?);
        if numbers.count > 5 {
            self.coloured += 1;
        }
        if numbers.count != 4 {
            return Some(position);
        }
        // The weight of rational curves, by which homogeneous coordinates are divided.
        match numbers.values[3].map(|weight| position / weight) {
            Some(position) if position.is_finite() && position.abs().max_element() <= FARTHEST => Some(position),
            _ => {
                mends.add("a position's weight that it cannot be divided by is left out", line, statement);
                Some(position)
            }
        }
    }
}
