//! Polygons of OBJ files that `tobj` would fill wrongly, written as triangles before it reads them.
//!
//! `tobj` makes a fan of triangles about a polygon's first corner. That is right for convex polygons and few others.

use glam::DVec3;

use crate::load::polygon::{Triangles, triangulate};

/// A face of more than three corners.
pub struct Polygon {
    /// In the OBJ file, from 1.
    pub line: usize,
    /// Where its statement stands in the text for `tobj`.
    pub start: usize,
    pub end: usize,
    /// Positions before the line, which indices below 0 count back from.
    pub positions_before: usize,
}

/// Lines of polygons that cross themselves.
#[derive(Default)]
pub struct Crossings {
    pub first_line: Option<usize>,
    pub count: usize,
}

/// The text, with the triangles of every polygon that a fan would fill wrongly, as statements in its place.
pub fn cut(text: String, polygons: &[Polygon], positions: &[[f32; 3]]) -> (String, Crossings) {
    let mut crossings = Crossings::default();
    let mut cut = String::new();
    let mut copied = 0;
    for polygon in polygons {
        let words: Vec<&str> = text[polygon.start..polygon.end].split_whitespace().skip(1).collect();
        let place = |word: &&str| position(word, polygon.positions_before).and_then(|index| positions.get(index));
        let Some(corners) =
            words.iter().map(|word| place(word).map(|at| at.map(f64::from).into())).collect::<Option<Vec<DVec3>>>()
        else {
            continue; // The check of the face has refused such an index.
        };
        let Some(Triangles { triangles, crosses }) = triangulate(&corners) else { continue };
        if crosses {
            crossings.first_line.get_or_insert(polygon.line);
            crossings.count += 1;
        }
        cut.push_str(&text[copied..polygon.start]);
        copied = polygon.end;
        let statements = triangles.iter().map(|&[a, b, c]| format!("f {} {} {}", words[a], words[b], words[c]));
        cut.push_str(&statements.collect::<Vec<_>>().join("\n"));
    }
    if copied == 0 {
        return (text, crossings);
    }
    cut.push_str(&text[copied..]);
    (cut, crossings)
}

/// The index of a corner's position, from 0.
fn position(corner: &str, positions_before: usize) -> Option<usize> {
    let written: i64 = corner.split('/').next()?.parse().ok()?;
    let from_start = if written < 0 { positions_before as i64 + written } else { written - 1 };
    usize::try_from(from_start).ok()
}
