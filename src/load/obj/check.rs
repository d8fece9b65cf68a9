//! Checks an OBJ file line by line before `tobj` reads it, which itself names no lines, takes an index 0 for a missing one and takes
//! polylines for polygons.

use std::collections::{BTreeMap, BTreeSet};

use super::polygons::{self, Polygon};
use crate::load::error::SceneError;
use crate::load::model::FARTHEST;

/// What the check found, and the text `tobj` is to read.
pub struct Checked {
    /// Lines joined where they were continued, without polylines and vertex colours, concave polygons cut into triangles.
    pub text: String,
    /// What stands after every `mtllib`.
    pub libraries: Vec<String>,
    pub used_materials: BTreeSet<String>,
    pub warnings: Vec<String>,
}

/// Numbers of positions, uvs and normals: those before a line, which an index below 0 counts back from, and those in all.
struct Counts {
    so_far: [usize; 3],
    in_all: [usize; 3],
    positions: Vec<[f32; 3]>,
    /// Positions that carry a colour.
    coloured: usize,
}

const KINDS: [&str; 3] = ["position", "uv coordinate", "normal"];

/// Statements that say nothing about surfaces here: groups, smoothing, display attributes, points and lines.
const HARMLESS: [&str; 14] =
    ["o", "g", "s", "mg", "p", "l", "usemap", "maplib", "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj"];

pub fn check(name: &str, text: &str) -> Result<Checked, SceneError> {
    let mut found = Checked {
        text: String::with_capacity(text.len()),
        libraries: Vec::new(),
        used_materials: BTreeSet::new(),
        warnings: Vec::new(),
    };
    let count = |statement: &str| text.lines().filter(|line| line.split_whitespace().next() == Some(statement)).count();
    let mut counts =
        Counts { so_far: [0; 3], in_all: [count("v"), count("vt"), count("vn")], positions: Vec::new(), coloured: 0 };
    let mut polygons: Vec<Polygon> = Vec::new();
    let mut unknown: BTreeMap<String, usize> = BTreeMap::new();
    let mut lines = text.lines().enumerate();
    let mut joined = String::new();
    while let Some((index, line)) = lines.next() {
        let mut line = line;
        if line.trim_end().ends_with('\\') {
            joined.clear();
            while let Some(start) = line.trim_end().strip_suffix('\\') {
                joined.push_str(start);
                joined.push(' ');
                line = lines.next().map_or("", |(_, next)| next);
            }
            joined.push_str(line);
            line = &joined;
        }
        let wrong = |message: String| SceneError::in_line(name, index + 1, message);
        // A material's name may contain the sign of a comment; the lines of numbers may end in one.
        let numbers = line.trim_start().starts_with(['v', 'f', '#']);
        let line = if numbers { line.split('#').next().unwrap_or("") } else { line }.trim();
        let (statement, rest) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
        match statement {
            "" | "l" => continue,
            "v" => counts.vertex(0, rest).map_err(wrong)?,
            "vt" => counts.vertex(1, rest).map_err(wrong)?,
            "vn" => counts.vertex(2, rest).map_err(wrong)?,
            "f" => {
                if counts.face(rest).map_err(wrong)? > 3 {
                    let start = found.text.len();
                    let positions_before = counts.so_far[0];
                    polygons.push(Polygon { line: index + 1, start, end: start + line.len(), positions_before });
                }
            }
            "mtllib" => found.libraries.push(rest.trim().to_owned()),
            "usemtl" if rest.trim().is_empty() => return Err(wrong("`usemtl` names no material".to_owned())),
            "usemtl" => {
                found.used_materials.insert(rest.trim().to_owned());
            }
            other if HARMLESS.contains(&other) => {}
            other => *unknown.entry(other.chars().take(20).collect()).or_default() += 1,
        }
        if statement == "v" && (6..=7).contains(&rest.split_whitespace().count()) {
            // Colours are not rendered, and tobj wants them of all vertices or of none.
            counts.coloured += 1;
            let coordinates: Vec<&str> = line.split_whitespace().take(4).collect();
            found.text.push_str(&coordinates.join(" "));
            found.text.push('\n');
            continue;
        }
        if statement == "vt" && rest.split_whitespace().nth(1).is_none() {
            // A texture of one dimension: tobj wants two.
            found.text.push_str(line);
            found.text.push_str(" 0\n");
            continue;
        }
        found.text.push_str(line);
        found.text.push('\n');
    }
    if !unknown.is_empty() {
        let list: Vec<String> = unknown.iter().take(8).map(|(statement, count)| format!("{statement} ({count})")).collect();
        found.warnings.push(format!("{name}: lines that are not understood were left out: {}", list.join(", ")));
    }
    if counts.coloured > 0 {
        let coloured = counts.coloured;
        found.warnings.push(format!("{name}: the colours of {coloured} vertices are left out: a material gives the colour"));
    }
    let (text, crossings) = polygons::cut(found.text, &polygons, &counts.positions);
    found.text = text;
    if let Some(line) = crossings.first_line {
        let count = crossings.count;
        let list = if count == 1 { format!("line {line}") } else { format!("line {line} and {} more lines", count - 1) };
        found.warnings.push(format!("{name}: polygons that cross themselves may be filled in wrongly: {list}"));
    }
    Ok(found)
}

impl Counts {
    fn vertex(&mut self, kind: usize, rest: &str) -> Result<(), String> {
        self.so_far[kind] += 1;
        let mut count = 0;
        let mut values = [0.0, 0.0, 0.0, 1.0];
        for word in rest.split_whitespace() {
            let value: f32 = word.parse().map_err(|_| format!("`{word}` is not a number"))?;
            if !value.is_finite() || value.abs() > FARTHEST {
                return Err(format!("the {} has the coordinate {word}: not a number within 1e18", KINDS[kind]));
            }
            if let Some(slot) = values.get_mut(count) {
                *slot = value;
            }
            count += 1;
            if kind == 0 && count == 4 && value == 0.0 && rest.split_whitespace().count() == 4 {
                return Err("the position's weight is 0".to_owned());
            }
        }
        if kind == 0 {
            let [x, y, z, weight] = values;
            let weight = if count == 4 { weight } else { 1.0 };
            self.positions.push([x / weight, y / weight, z / weight]);
        }
        let possible: &[usize] = [&[3, 4, 6, 7][..], &[1, 2, 3], &[3]][kind];
        if possible.contains(&count) {
            return Ok(());
        }
        Err(format!("a {} has {} numbers, found {count}", KINDS[kind], possible[..possible.len().min(2)].last().unwrap_or(&3)))
    }

    /// How many corners it has.
    fn face(&self, rest: &str) -> Result<usize, String> {
        let mut corners = 0;
        for corner in rest.split_whitespace() {
            corners += 1;
            let mut indices = corner.split('/');
            for kind in 0..3 {
                match indices.next() {
                    None => break,
                    Some("") if kind > 0 => {}
                    Some(index) => self.index(kind, index)?,
                }
            }
            if indices.next().is_some() {
                return Err(format!("`{corner}` has more than three indices"));
            }
        }
        if corners < 3 {
            return Err(format!("a face has at least 3 corners, found {corners}"));
        }
        Ok(corners)
    }

    fn index(&self, kind: usize, written: &str) -> Result<(), String> {
        let index: i64 = written.parse().map_err(|_| format!("`{written}` is not an index"))?;
        let count = if index < 0 { self.so_far[kind] } else { self.in_all[kind] };
        if index == 0 {
            return Err("indices count from 1, or back from -1; found 0".to_owned());
        }
        if index.unsigned_abs() > count as u64 {
            return Err(format!("the face uses {} {index}, but there are only {count}", KINDS[kind]));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn message(text: &str) -> String {
        check("a.obj", text).err().map(|error| error.to_string()).unwrap_or_default()
    }

    #[test]
    fn mistakes_name_their_line() {
        let start = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
        assert_eq!(message(&format!("{start}f 1 2 4")), "a.obj:4:1: the face uses position 4, but there are only 3");
        assert_eq!(message(&format!("{start}f -1 -2 -4")), "a.obj:4:1: the face uses position -4, but there are only 3");
        assert_eq!(message(&format!("{start}f 0 1 2")), "a.obj:4:1: indices count from 1, or back from -1; found 0");
        assert_eq!(message("v 0 nan 0"), "a.obj:1:1: the position has the coordinate nan: not a number within 1e18");
        assert_eq!(message("\nv 0 zero 0"), "a.obj:2:1: `zero` is not a number");
        assert_eq!(message(&format!("{start}f 1 2")), "a.obj:4:1: a face has at least 3 corners, found 2");
        assert_eq!(message(&format!("{start}f 1/1 2 3")), "a.obj:4:1: the face uses uv coordinate 1, but there are only 0");
    }

    #[test]
    fn colours_of_some_vertices_are_left_out_and_said() {
        let text = "v 0 0 0 1 0 0\nv 1 0 0\nv 0 1 0 0.5 1 0 1\nf 1 2 3\n";
        let checked = check("a.obj", text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(checked.text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        assert_eq!(checked.warnings, ["a.obj: the colours of 2 vertices are left out: a material gives the colour"]);
        assert_eq!(message("v 0 0 0 1 0"), "a.obj:1:1: a position has 4 numbers, found 5");
    }

    #[test]
    fn concave_faces_become_triangles_where_they_stand() {
        let corners = "v 0 0 0\nv 2 2 0\nv 0 1 0\nv -2 2 0\n";
        let checked = check("a.obj", &format!("{corners}f 2//1 3//1 4//1 1//1\nf 1 2 3 4\nvn 0 0 1\n"))
            .unwrap_or_else(|error| panic!("{error}"));
        let faces: Vec<&str> = checked.text.lines().filter(|line| line.starts_with('f')).collect();
        assert_eq!(faces.len(), 3, "{faces:?}");
        assert!(faces[..2].iter().all(|face| face.contains("3//1") && face.contains("1//1")), "{faces:?}");
        // From its reflex corner, or the one across, a fan is right and stays.
        assert_eq!(faces[2], "f 1 2 3 4");
        assert!(checked.warnings.is_empty());
    }

    #[test]
    fn a_face_that_crosses_itself_is_said() {
        let text = "v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n";
        let checked = check("a.obj", text).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(checked.warnings, ["a.obj: polygons that cross themselves may be filled in wrongly: line 5"]);
    }

    #[test]
    fn good_lines_pass_and_polylines_go() {
        let checked = check("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0 # corner\nl 1 2 3\nf 1 2 \\\n -1\n")
            .unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(checked.text, "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2   -1\n");
        assert!(checked.warnings.is_empty());
    }
}
