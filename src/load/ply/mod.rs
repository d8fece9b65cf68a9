//! PLY files (Turk 1994): text or binary in both byte orders, packed by gzip or not, read by `ply-rs-bw`.
//!
//! Vertices have positions, normals and texture coordinates; faces are triangles and polygons, or strips of triangles as in the Stanford models.
//! Everything else is read over and named in a warning.

mod elements;

use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;
use glam::{DVec3, Vec2, Vec3};
use ply_rs_bw::parser::{ParseError, Parser, Reader};
use ply_rs_bw::ply::{ElementDef, Header, PropertyAccess};

use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_MODEL_BYTES};
use crate::load::model::{FARTHEST, MeshAttribute, ModelFile, Part};
use crate::load::polygon::triangulate;
use crate::load::printable::short_list;
use crate::scene::Mesh;
use elements::{Corners, Declared, Ignored, NO_VERTEX, Vertex};

/// Elements that are read at a time, so that memory is that of the mesh and not that of the file beside it.
const CHUNK: usize = 1 << 14;

/// Reads a PLY file. Its faces have no materials of their own.
pub fn load(files: &Files, path: &Path) -> Result<ModelFile, SceneError> {
    open::<false>(files, path)
}

/// The same with what vertices and faces have beside what makes a mesh: colours and other numbers.
pub fn load_with_attributes(files: &Files, path: &Path) -> Result<ModelFile, SceneError> {
    open::<true>(files, path)
}

fn open<const REST: bool>(files: &Files, path: &Path) -> Result<ModelFile, SceneError> {
    let name = show(path);
    let cannot_be_read = |error: std::io::Error| SceneError::in_file(&name, format!("cannot be read: {error}"));
    let mut file = files.open(path).map_err(cannot_be_read)?;
    let packed = file.fill_buf().map_err(cannot_be_read)?.starts_with(&[0x1f, 0x8b]);
    if packed {
        read::<REST>(&name, &mut BufReader::new(MultiGzDecoder::new(file).take(MOST_MODEL_BYTES)))
    } else {
        read::<REST>(&name, &mut file)
    }
}

/// One type for packed and plain files: the parser is large, and compiled for each type that it reads from.
type Source<'a> = Reader<&'a mut dyn BufRead>;

/// What is read so far.
#[derive(Default)]
struct Model {
    vertices: Option<Mesh>,
    /// Corners of all faces one after the other, and where each face ends.
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// What stands for the material of each face, where the file says so.
    groups: Option<Vec<u32>>,
    strips: Vec<u32>,
    attributes: Vec<MeshAttribute>,
    without_effect: Vec<String>,
}

fn read<const REST: bool>(name: &str, source: &mut dyn BufRead) -> Result<ModelFile, SceneError> {
    let refused = |error: ParseError| SceneError::in_file(name, in_one_line(&error));
    let mut reader = Reader::new(source);
    let header = Parser::<Ignored>::new().read_header(&mut reader).map_err(refused)?;
    let mut model = Model::default();
    for element in header.elements.values() {
        model.element::<REST>(element, &header, &mut reader).map_err(|error| match error {
            Refusal::Parse(error) => refused(error),
            Refusal::Content(why) => SceneError::in_file(name, why),
        })?;
    }
    model.finish(name).map_err(|why| SceneError::in_file(name, why))
}

enum Refusal {
    Parse(ParseError),
    Content(String),
}

impl From<ParseError> for Refusal {
    fn from(error: ParseError) -> Self {
        Self::Parse(error)
    }
}

impl Model {
    fn element<const REST: bool>(
        &mut self,
        element: &ElementDef,
        header: &Header,
        reader: &mut Source<'_>,
    ) -> Result<(), Refusal> {
        if element.properties.is_empty() {
            // Nothing of it stands in the file.
            return Ok(());
        }
        let declared = Declared(element);
        match element.name.as_str() {
            "vertex" => self.vertices::<REST>(&declared, header, reader),
            "face" | "tristrips" if declared.has_corners() => {
                let known = elements::corner_names();
                let strips = element.name == "tristrips";
                let keeps_rest = REST && !strips;
                if !keeps_rest {
                    self.without_effect.extend(declared.without_effect(&known));
                }
                let mut rest = Rest::new(if keeps_rest { declared.attributes(&known) } else { Vec::new() });
                if declared.has_groups() && !strips {
                    self.groups = Some(Vec::new());
                }
                in_chunks(element, header, reader, |Corners::<REST> { corners, group, rest: numbers }| {
                    if strips {
                        self.strips.extend(corners);
                        self.strips.push(NO_VERTEX);
                    } else if corners.len() > 2 {
                        self.corners.extend(corners);
                        self.ends.push(self.corners.len());
                        self.groups.iter_mut().for_each(|groups| groups.push(group));
                        rest.push(&numbers);
                    }
                    Ok(())
                })?;
                self.attributes.extend(rest.attributes(true));
                Ok(())
            }
            _ => {
                self.without_effect.push(format!("the element {}", element.name));
                in_chunks(element, header, reader, |Ignored| Ok(()))
            }
        }
    }

    fn vertices<const REST: bool>(
        &mut self,
        declared: &Declared,
        header: &Header,
        reader: &mut Source<'_>,
    ) -> Result<(), Refusal> {
        if !declared.has_positions() {
            return Err(Refusal::Content("its vertices have no numbers x, y and z".to_owned()));
        }
        let known = elements::vertex_names();
        if !REST {
            self.without_effect.extend(declared.without_effect(&known));
        }
        let mut rest = Rest::new(if REST { declared.attributes(&known) } else { Vec::new() });
        let (has_normals, has_uvs) = (declared.has_normals(), declared.has_uvs());
        let has_second_uvs = declared.has_second_uvs();
        let mut mesh = Mesh::default();
        in_chunks(declared.0, header, reader, |vertex: Vertex<REST>| {
            let index = mesh.positions.len();
            let position = Vec3::from(vertex.position);
            if !position.is_finite() || position.abs().max_element() > FARTHEST {
                return Err(format!("vertex {index} stands at {position}: not within 1e18"));
            }
            mesh.positions.push(position);
            if has_normals {
                mesh.normals.push(unit(Vec3::from(vertex.normal)));
            }
            let of_vertex = [(has_uvs, vertex.uv, &mut mesh.uvs), (has_second_uvs, vertex.second_uv, &mut mesh.second_uvs)];
            for (_, uv, uvs) in of_vertex.into_iter().filter(|(is_there, ..)| *is_there) {
                let uv = Vec2::from(uv);
                if !uv.is_finite() {
                    return Err(format!("vertex {index} has the texture coordinates {uv}: not finite"));
                }
                uvs.push(uv);
            }
            rest.push(&vertex.rest);
            Ok(())
        })?;
        self.attributes.extend(rest.attributes(false));
        self.vertices = Some(mesh);
        Ok(())
    }

    fn finish(self, name: &str) -> Result<ModelFile, String> {
        let mut warnings = Vec::new();
        if !self.without_effect.is_empty() {
            warnings.push(format!("{name}: left out: {}", short_list(&self.without_effect)));
        }
        let mut mesh = self.vertices.ok_or("it has no vertices")?;
        if self.ends.is_empty() && self.strips.is_empty() {
            return Err("there is nothing to render in the model: it has points and no faces".to_owned());
        }
        let count = mesh.positions.len();
        if let Some(place) = self.corners.iter().position(|&index| index as usize >= count) {
            let face = self.ends.partition_point(|&end| end <= place);
            return Err(no_such_vertex(&format!("face {face}"), self.corners[place], count));
        }
        if let Some(&index) = self.strips.iter().find(|&&index| index != NO_VERTEX && index as usize >= count) {
            return Err(no_such_vertex("a strip", index, count));
        }
        let mut crossing = 0;
        let mut start = 0;
        // The number of the polygon that each triangle is of.
        let numbered = self.groups.is_some() || self.attributes.iter().any(|attribute| attribute.of_faces);
        let mut polygons = Vec::new();
        for (face, end) in self.ends.into_iter().enumerate() {
            crossing += usize::from(add_polygon(&mut mesh, &self.corners[start..end]));
            start = end;
            if numbered {
                polygons.resize(mesh.faces.len(), face);
            }
        }
        for strip in self.strips.split(|&index| index == NO_VERTEX) {
            // Every other triangle of a strip is turned the other way.
            let turned = |(number, corners): (usize, &[u32])| match number % 2 {
                0 => [corners[0], corners[1], corners[2]],
                _ => [corners[1], corners[0], corners[2]],
            };
            mesh.faces.extend(strip.windows(3).enumerate().map(turned));
        }
        if crossing > 0 {
            warnings.push(format!("{name}: {crossing} polygons cross themselves; they are filled as far as that can be"));
        }
        // Triangles of strips have no number.
        polygons.resize(if polygons.is_empty() { 0 } else { mesh.faces.len() }, usize::MAX);
        // They go with the faces that are dropped, as materials do.
        mesh.face_materials = polygons;
        let dropped = mesh.drop_degenerate_faces();
        let polygons = std::mem::take(&mut mesh.face_materials);
        if mesh.faces.is_empty() {
            return Err("there is nothing to render in the model: none of its faces has an area".to_owned());
        }
        if dropped > 0 {
            warnings.push(format!("{name}: {dropped} triangles without area were left out"));
        }
        let group = |of_faces: Vec<u32>| polygons.iter().map(|&face| of_faces.get(face).copied().unwrap_or(NO_VERTEX)).collect();
        let face_groups = self.groups.filter(|_| !polygons.is_empty()).map(group);
        let mut attributes = self.attributes;
        for attribute in attributes.iter_mut().filter(|attribute| attribute.of_faces) {
            let of_polygons = std::mem::take(&mut attribute.values);
            attribute.values = polygons.iter().map(|&face| of_polygons.get(face).copied().unwrap_or_default()).collect();
        }
        Ok(ModelFile { parts: vec![Part { mesh, material: None }], face_groups, attributes, warnings, ..ModelFile::default() })
    }
}

/// Numbers of an element beside those that make a mesh.
struct Rest {
    /// Names, and where the channels stand.
    declared: Vec<(String, Vec<usize>)>,
    values: Vec<Vec<Vec3>>,
}

impl Rest {
    /// What has neither one channel nor three, nor four of which the last is no colour, is left out.
    fn new(mut declared: Vec<(String, Vec<usize>)>) -> Self {
        declared.retain(|(_, places)| matches!(places.len(), 1 | 3 | 4));
        Self { values: vec![Vec::new(); declared.len()], declared }
    }

    fn push(&mut self, numbers: &[f32]) {
        for ((_, places), values) in self.declared.iter().zip(&mut self.values) {
            let channel = |number: usize| {
                let place = places.get(number).or(places.first());
                place.and_then(|&place| numbers.get(place)).copied().filter(|number| number.is_finite()).unwrap_or_default()
            };
            values.push(Vec3::new(channel(0), channel(1), channel(2)));
        }
    }

    fn attributes(self, of_faces: bool) -> impl Iterator<Item = MeshAttribute> {
        let named = self.declared.into_iter().zip(self.values);
        named.map(move |((name, _), values)| MeshAttribute { name, of_faces, values })
    }
}

/// A normal of about length 1 stays as it is: what is made of it later is of length 1 in double precision. One of no length is computed
/// later.
fn unit(normal: Vec3) -> Vec3 {
    if (0.5..2.0).contains(&normal.length_squared()) { normal } else { normal.try_normalize().unwrap_or_default() }
}

fn no_such_vertex(what: &str, index: u32, count: usize) -> String {
    let which = if index == NO_VERTEX { "a vertex below 0".to_owned() } else { format!("vertex {index}") };
    format!("{what} uses {which}, but there are only {count} (counted from 0)")
}

/// Adds a polygon's triangles; whether it crosses itself.
fn add_polygon(mesh: &mut Mesh, corners: &[u32]) -> bool {
    let fan = |mesh: &mut Mesh| mesh.faces.extend(corners[1..].windows(2).map(|pair| [corners[0], pair[0], pair[1]]));
    if corners.len() == 3 {
        fan(mesh);
        return false;
    }
    let positions: Vec<DVec3> = corners.iter().map(|&index| mesh.positions[index as usize].as_dvec3()).collect();
    match triangulate(&positions) {
        None => {
            fan(mesh);
            false
        }
        Some(cut) => {
            mesh.faces.extend(cut.triangles.iter().map(|triangle| triangle.map(|corner| corners[corner])));
            cut.crosses
        }
    }
}

/// Reads all elements of a kind, some at a time.
fn in_chunks<E: PropertyAccess>(
    element: &ElementDef,
    header: &Header,
    reader: &mut Source<'_>,
    mut each: impl FnMut(E) -> Result<(), String>,
) -> Result<(), Refusal> {
    let parser = Parser::<E>::new();
    let mut left = element.count;
    let mut chunk = element.clone();
    while left > 0 {
        chunk.count = left.min(CHUNK);
        let read = parser.read_payload_for_element(reader, &chunk, header).map_err(|error| match error.kind() {
            ErrorKind::UnexpectedEof => {
                Refusal::Content(format!("the file ends before the last of its {} elements `{}`", element.count, element.name))
            }
            _ => Refusal::Parse(error),
        })?;
        for one in read {
            each(one).map_err(Refusal::Content)?;
        }
        left -= chunk.count;
    }
    Ok(())
}

/// The parser's first line says what is wrong; those after it quote the line of the file.
fn in_one_line(error: &ParseError) -> String {
    const LONGEST: usize = 60;
    let text = error.to_string();
    let first = text.lines().next().unwrap_or_default();
    let what = first.split_once(": ").filter(|_| error.line().is_some()).map_or(first, |(_, what)| what).trim_end_matches('.');
    let quoted = text.lines().find_map(|line| line.trim_start().strip_prefix("String: '"));
    let place = match (error.line(), quoted) {
        (Some(number), Some(quoted)) => {
            let quoted: String = quoted.trim_end_matches('\'').chars().take(LONGEST).collect();
            format!("line {number}, `{quoted}`: ")
        }
        (Some(number), None) => format!("line {number}: "),
        (None, _) => String::new(),
    };
    format!("is not a valid PLY file: {place}{what}")
}

#[cfg(test)]
mod tests;
