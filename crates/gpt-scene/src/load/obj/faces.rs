//! Faces of OBJ files, as parts of one material each.

use std::collections::HashMap;
use std::path::Path;

use glam::{DVec3, Vec2, Vec3};

use super::mtl::Libraries;
use super::statements::{FREE_FORM, HARMLESS, is_statement};
use super::vertices::{Kind, Vertices};
use crate::load::mends::Mends;
use crate::load::model::{ModelFile, ModelPart, Substitute};
use crate::load::polygon::triangulate;
use crate::load::printable::short_list;
use crate::load::spelling::lines::{Statements, before_spaced_comment, first_word, trimmed, without_comment, words};
use crate::load::spelling::names::unquoted;
use crate::load::spelling::numbers::integer;
use crate::scene::Mesh;

/// The value of each `mtllib`, and its line.
pub fn libraries(text: &str) -> Vec<(usize, String)> {
    let written = |(line, statement): (usize, std::borrow::Cow<'_, str>)| {
        let (word, rest) = first_word(&statement);
        (word.eq_ignore_ascii_case("mtllib") && !rest.is_empty()).then(|| (line, unquoted(rest).to_owned()))
    };
    Statements::new(text, is_statement).filter_map(written).collect()
}

/// Contents of a model that are not rendered, and are no fault.
#[derive(Debug, Default)]
pub struct LeftOut {
    pub points_and_lines: usize,
    pub without_area: usize,
    coloured: usize,
    crossing: usize,
    first_crossing: usize,
}

impl LeftOut {
    pub fn warnings(&self, name: &str) -> Vec<String> {
        let mut warnings = Vec::new();
        if self.points_and_lines > 0 {
            warnings.push(format!("{name}: {} points and lines are left out: they have no surface", self.points_and_lines));
        }
        if self.coloured > 0 {
            warnings.push(format!("{name}: the colours of {} vertices are left out: a material gives the colour", self.coloured));
        }
        if self.crossing > 0 {
            let (line, count) = (self.first_crossing, self.crossing);
            let list = if count == 1 { format!("line {line}") } else { format!("line {line} and {} more lines", count - 1) };
            warnings.push(format!("{name}: polygons that cross themselves may be filled in wrongly: {list}"));
        }
        if self.without_area > 0 {
            warnings.push(format!("{name}: {} triangles without area were left out", self.without_area));
        }
        warnings
    }
}

/// Indices of a corner's position, texture coordinates and normal; the last two may be missing.
type Corner = (u32, Option<u32>, Option<u32>);

/// Faces that are read.
pub struct Faces<'a> {
    vertices: Vertices,
    mends: &'a mut Mends,
    /// The model's path and its libraries, where its materials are wanted.
    materials: Option<(&'a Path, &'a mut Libraries)>,
    /// How many positions, texture coordinates and normals stand before the statement, which indices below 0 count back from.
    so_far: [usize; 3],
    /// The material of the faces that come, and whether there is one yet.
    material: Option<usize>,
    names: HashMap<String, Option<usize>>,
    /// Names of materials that no library has, and the line of the first.
    unknown: (Option<usize>, Vec<String>),
    file: ModelFile,
    part: PartInTheMaking,
    left_out: LeftOut,
}

/// Faces of one material which have all or none of normals and texture coordinates.
#[derive(Default)]
struct PartInTheMaking {
    material: Option<usize>,
    has: [bool; 2],
    mesh: Mesh,
    corners: HashMap<Corner, u32>,
}

impl<'a> Faces<'a> {
    pub fn new(vertices: Vertices, mends: &'a mut Mends, materials: Option<(&'a Path, &'a mut Libraries)>) -> Self {
        let left_out = LeftOut { coloured: vertices.coloured, ..LeftOut::default() };
        Self {
            vertices,
            mends,
            materials,
            so_far: [0; 3],
            material: None,
            names: HashMap::new(),
            unknown: (None, Vec::new()),
            file: ModelFile::default(),
            part: PartInTheMaking::default(),
            left_out,
        }
    }

    pub fn read(&mut self, text: &str) {
        for (line, statement) in Statements::new(text, is_statement) {
            let (word, rest) = first_word(&statement);
            if let Some(kind) = Kind::of(word) {
                self.so_far[kind as usize] += 1;
                continue;
            }
            match word.to_ascii_lowercase().as_str() {
                // `fo` is what the first versions called it.
                "f" | "fo" => self.face(line, &statement, without_comment(rest)),
                "l" | "p" => self.left_out.points_and_lines += 1,
                "usemtl" => self.use_material(line, &statement, rest),
                "mtllib" if rest.is_empty() => self.mends.add("`mtllib` names no material library", line, &statement),
                "mtllib" => {}
                other if HARMLESS.contains(&other) => {}
                other if FREE_FORM.contains(&other) => {
                    self.mends.add("free-form curves and surfaces, and what calls other files, are left out", line, &statement);
                }
                _ => self.mends.add("lines that are not understood were left out", line, &statement),
            }
        }
    }

    /// The parts with what stands for materials that no library has, and what was left out.
    pub fn finish(mut self) -> (ModelFile, Option<Substitute>, LeftOut) {
        self.end_part();
        let (line, names) = self.unknown;
        let what = || format!("no material library has {}; their faces are magenta", short_list(&names));
        (self.file, line.map(|line| Substitute { line: Some(line), what: what() }), self.left_out)
    }

    fn use_material(&mut self, line: usize, statement: &str, name: &str) {
        let Some((model, libraries)) = &mut self.materials else { return };
        let name = trimmed(name);
        if name.is_empty() {
            self.mends.add("`usemtl` names no material, and faces after it have none", line, statement);
            self.material = None;
            return;
        }
        if let Some(known) = self.names.get(name) {
            self.material = *known;
            return;
        }
        self.material = Some(libraries.find(name).unwrap_or_else(|| {
            let name = before_spaced_comment(name).unwrap_or(name);
            self.unknown.0.get_or_insert(line);
            self.unknown.1.push(name.to_owned());
            libraries.add_missing(model, name)
        }));
        self.names.insert(name.to_owned(), self.material);
    }

    fn face(&mut self, line: usize, statement: &str, rest: &str) {
        let Some(mut corners) = self.corners(line, statement, rest) else { return };
        // A corner that is there twice in a row is one.
        corners.dedup_by_key(|corner| corner.0);
        if corners.len() > 3 && corners.first().map(|corner| corner.0) == corners.last().map(|corner| corner.0) {
            corners.pop();
        }
        if corners.len() < 3 {
            self.left_out.without_area += 1;
            return;
        }
        let has = [corners.iter().any(|corner| corner.1.is_some()), corners.iter().any(|corner| corner.2.is_some())];
        if self.part.material != self.material || self.part.has != has {
            self.end_part();
            self.part = PartInTheMaking { material: self.material, has, ..PartInTheMaking::default() };
        }
        let vertices: Vec<u32> = corners.iter().map(|corner| self.vertex(*corner)).collect();
        let fan = |corner: usize| [vertices[0], vertices[corner], vertices[corner + 1]];
        let places: Vec<DVec3> = corners.iter().map(|corner| self.vertices.positions[corner.0 as usize].as_dvec3()).collect();
        match (vertices.len() > 3).then(|| triangulate(&places)).flatten() {
            None => self.part.mesh.faces.extend((1..vertices.len() - 1).map(fan)),
            Some(cut) => {
                if cut.crosses {
                    self.left_out.crossing += 1;
                    self.left_out.first_crossing = if self.left_out.crossing == 1 { line } else { self.left_out.first_crossing };
                }
                self.part.mesh.faces.extend(cut.triangles.iter().map(|triangle| triangle.map(|corner| vertices[corner])));
            }
        }
    }

    /// The corners of a face. None where one of them has no place, so that the face is left out.
    fn corners(&mut self, line: usize, statement: &str, rest: &str) -> Option<Vec<Corner>> {
        let joined = with_joined_slashes(rest);
        let mut corners = Vec::new();
        for word in words(joined.as_deref().unwrap_or(rest)) {
            let mut indices = word.split('/');
            let Some(position) = self.index(Kind::Position, indices.next().unwrap_or("")) else {
                let what = "faces with a corner that is no vertex of the file are left out";
                self.mends.add(what, line, statement);
                return None;
            };
            if !self.vertices.positions[position as usize].is_finite() {
                let (line, written) = &self.vertices.unread[0][&position];
                let what = "faces with a corner whose position is no three numbers within 1e18 are left out";
                self.mends.add(what, *line, written);
                return None;
            }
            let [uv, normal] = [Kind::Uv, Kind::Normal].map(|kind| match indices.next() {
                None | Some("") => None,
                Some(written) => {
                    let index = self.index(kind, written);
                    if index.is_none() {
                        let what = match kind {
                            Kind::Normal => "normals that are not there are computed",
                            _ => "texture coordinates that are not there are 0",
                        };
                        self.mends.add(what, line, statement);
                    }
                    index
                }
            });
            if indices.next().is_some() {
                self.mends.add("what follows the third index of a corner is left out", line, statement);
            }
            corners.push((position, self.readable(Kind::Uv, uv), self.readable(Kind::Normal, normal)));
        }
        if corners.len() < 3 {
            self.mends.add("faces of fewer than three corners are left out", line, statement);
            return None;
        }
        if joined.is_some() {
            self.mends.add("indices with blanks or commas between them are read as what they most likely are", line, statement);
        }
        Some(corners)
    }

    /// The index from 0 that is written, if there is such a thing in the file.
    fn index(&mut self, kind: Kind, written: &str) -> Option<u32> {
        let count = match kind {
            Kind::Position => self.vertices.positions.len(),
            Kind::Uv => self.vertices.uvs.len(),
            Kind::Normal => self.vertices.normals.len(),
        };
        let index = written.parse::<i64>().ok().or_else(|| integer(written).map(|number| number.value as i64))?;
        let from_start =
            if index < 0 { (self.so_far[kind as usize] as i64).checked_add(index)? } else { index.checked_sub(1)? };
        u32::try_from(from_start).ok().filter(|&place| (place as usize) < count)
    }

    /// The index, unless nothing can be read there; that is reported once.
    fn readable(&mut self, kind: Kind, index: Option<u32>) -> Option<u32> {
        let index = index?;
        let is_read = match kind {
            Kind::Uv => self.vertices.uvs[index as usize].is_finite(),
            _ => self.vertices.normals[index as usize].is_finite(),
        };
        if is_read {
            return Some(index);
        }
        if let Some((line, written)) = self.vertices.unread[kind as usize].remove(&index) {
            let what = match kind {
                Kind::Normal => "normals that are no three numbers within 1e18 are computed",
                _ => "texture coordinates that are no numbers within 1e18 are 0",
            };
            self.mends.add(what, line, &written);
        }
        None
    }

    /// The index of a corner among the part's vertices. What only some corners have is 0 for the others: a normal of no length is computed.
    fn vertex(&mut self, corner: Corner) -> u32 {
        let PartInTheMaking { has, mesh, corners, .. } = &mut self.part;
        *corners.entry(corner).or_insert_with(|| {
            let (position, uv, normal) = corner;
            mesh.positions.push(self.vertices.positions[position as usize]);
            if has[0] {
                mesh.uvs.push(uv.map_or(Vec2::ZERO, |index| self.vertices.uvs[index as usize]));
            }
            if has[1] {
                mesh.normals.push(normal.map_or(Vec3::ZERO, |index| self.vertices.normals[index as usize]));
            }
            mesh.positions.len() as u32 - 1
        })
    }

    fn end_part(&mut self) {
        let PartInTheMaking { material, mut mesh, .. } = std::mem::take(&mut self.part);
        self.left_out.without_area += mesh.drop_degenerate_faces();
        if !mesh.faces.is_empty() {
            self.file.parts.push(ModelPart { mesh, material });
        }
    }
}

/// The corners without blanks about their slashes, and with blanks in place of commas; None where there is none of both.
fn with_joined_slashes(rest: &str) -> Option<String> {
    let commas = rest.contains(',');
    let is_apart = |word: &str| word.starts_with('/') || word.ends_with('/');
    // Some programs end each corner in a slash, where the texture coordinates or normals are not there.
    let apart = words(rest).any(is_apart) && !words(rest).all(|word| word.ends_with('/') && !word.starts_with('/'));
    if !commas && !apart {
        return None;
    }
    let mut joined = String::with_capacity(rest.len());
    for word in words(&rest.replace(',', " ")) {
        // A word with a slash between numbers is a corner of its own.
        let is_rest = apart && joined.ends_with('/') && !word.trim_matches('/').contains('/');
        if !(joined.is_empty() || word.starts_with('/') || is_rest) {
            joined.push(' ');
        }
        joined.push_str(word);
    }
    Some(joined)
}
