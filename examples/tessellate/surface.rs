//! Grids of vertices with exact normals, written as an OBJ file.

use std::collections::HashMap;
use std::fmt::Write;

use glam::{DVec2, DVec3};

/// A point of a surface.
#[derive(Debug, Clone, Copy)]
pub struct Vertex {
    pub position: DVec3,
    /// Unit length, outward.
    pub normal: DVec3,
    pub uv: DVec2,
}

/// Faces whose corners share positions, normals and texture coordinates that are written alike.
#[derive(Debug, Default)]
pub struct Surface {
    positions: Lines,
    normals: Lines,
    uvs: Lines,
    faces: Vec<Vec<[usize; 3]>>,
}

/// Lines of an OBJ file, each once.
#[derive(Debug, Default)]
struct Lines {
    text: String,
    numbers: HashMap<String, usize>,
}

impl Lines {
    /// The line's number, counted from one as OBJ files do.
    fn number(&mut self, line: String) -> usize {
        let next = self.numbers.len() + 1;
        *self.numbers.entry(line).or_insert_with_key(|line| {
            self.text += line;
            next
        })
    }
}

impl Surface {
    /// Adds `columns` × `rows` faces with corners at `vertex(u, v)`, u and v from 0 to 1. Their front is where the normals point.
    pub fn add_grid(&mut self, columns: usize, rows: usize, vertex: impl Fn(f64, f64) -> Vertex) {
        let at = |column: usize, row: usize| vertex(column as f64 / columns as f64, row as f64 / rows as f64);
        for row in 0..rows {
            for column in 0..columns {
                self.add_face([at(column, row), at(column + 1, row), at(column + 1, row + 1), at(column, row + 1)]);
            }
        }
    }

    fn add_face(&mut self, mut corners: [Vertex; 4]) {
        let across = (corners[2].position - corners[0].position).cross(corners[3].position - corners[1].position);
        if across.dot(corners.iter().map(|corner| corner.normal).sum()) < 0.0 {
            corners.reverse();
        }
        let mut face: Vec<[usize; 3]> = corners.iter().map(|corner| self.corner(corner)).collect();
        // At a pole one side of the grid is a point: the face is a triangle.
        face.dedup_by_key(|corner| corner[0]);
        if face.first().map(|corner| corner[0]) == face.last().map(|corner| corner[0]) {
            face.pop();
        }
        if face.len() >= 3 {
            self.faces.push(face);
        }
    }

    fn corner(&mut self, vertex: &Vertex) -> [usize; 3] {
        let (position, normal, uv) = (vertex.position, vertex.normal, vertex.uv);
        [
            self.positions.number(line("v", &position.to_array(), 1e5)),
            self.uvs.number(line("vt", &uv.to_array(), 1e4)),
            self.normals.number(line("vn", &normal.to_array(), 1e4)),
        ]
    }

    /// The faces as an OBJ file.
    pub fn to_obj(&self) -> String {
        let mut text = [&self.positions, &self.uvs, &self.normals].map(|lines| lines.text.as_str()).concat();
        for face in &self.faces {
            text += "f";
            for [position, uv, normal] in face {
                // Writing to a string cannot fail.
                let _ = write!(text, " {position}/{uv}/{normal}");
            }
            text += "\n";
        }
        text
    }
}

/// A line of numbers rounded to a part of `steps`.
fn line(key: &str, numbers: &[f64], steps: f64) -> String {
    let mut line = key.to_owned();
    for number in numbers {
        // Adding zero turns -0 into 0, so that both are written alike.
        let _ = write!(line, " {}", (number * steps).round() / steps + 0.0);
    }
    line + "\n"
}
