//! PLY files (Turk 1994): text or binary in both byte orders, packed by gzip or not.
//!
//! Vertices have positions, normals and texture coordinates; faces are triangles and polygons, or strips of triangles as in the Stanford models.
//! Everything else is read over and named in a warning. What a file says wrongly is mended or left out, counted and reported ([`Mends`]).

mod data;
mod elements;
mod header;

use std::collections::HashSet;
use std::io::{BufRead, BufReader, Cursor, Read, SeekFrom};
use std::path::Path;

use flate2::bufread::MultiGzDecoder;
use glam::{DVec3, Vec2, Vec3};

use crate::input::{self, AnyFile};
use crate::load::encoding;
use crate::load::error::{SceneError, show};
use crate::load::files::{Files, MOST_MODEL_BYTES};
use crate::load::memory;
use crate::load::mends::Mends;
use crate::load::model::{FARTHEST, MeshAttribute, ModelFile, ModelPart};
use crate::load::polygon::triangulate;
use crate::load::printable::short_list;
use crate::scene::Mesh;
use data::{Data, Text};
use elements::{Role, Roles};
use header::{Element, Format, Kind};

/// Stands for an index below 0, which begins a new strip, and for one that no vertex can have.
const NO_VERTEX: u32 = u32::MAX;

/// Reads a PLY file. Its faces have no materials of their own.
pub fn load(files: &Files, path: &Path) -> Result<ModelFile, SceneError> {
    open(files, path, false)
}

/// Loads a mesh and the other numbers of its vertices and faces, such as colours.
pub fn load_with_attributes(files: &Files, path: &Path) -> Result<ModelFile, SceneError> {
    open(files, path, true)
}

fn open(files: &Files, path: &Path, with_rest: bool) -> Result<ModelFile, SceneError> {
    let name = show(path);
    let cannot_be_read = |error: std::io::Error| SceneError::in_file(&name, format!("cannot be read: {error}"));
    let mut file = files.open(path).map_err(cannot_be_read)?;
    let packed = file.fill_buf().map_err(cannot_be_read)?.starts_with(&[0x1f, 0x8b]);
    let mut model = if packed {
        let most = most_unpacked(&mut file).map_err(cannot_be_read)?;
        // One byte more tells a file that is too large from one that ends there.
        let mut unpacked = BufReader::new(MultiGzDecoder::new(file).take(most + 1));
        let model = read(&name, &mut unpacked, with_rest);
        if unpacked.get_ref().limit() == 0 {
            let what = format!("unpacked, it is more than the {} MiB that are read of a file of its size", most >> 20);
            return Err(SceneError::in_file(&name, what));
        }
        model?
    } else {
        read(&name, &mut file, with_rest)?
    };
    model.substitutes.iter_mut().for_each(|(file, _)| path.clone_into(file));
    Ok(model)
}

/// Most bytes of a packed file once it is unpacked: so many for each of its own, and a first amount. Models take a tenth packed, and zeros a thousandth.
fn most_unpacked(file: &mut AnyFile) -> std::io::Result<u64> {
    const FACTOR: u64 = 128;
    const FIRST: u64 = 1 << 24;
    let length = file.seek(SeekFrom::End(0))?;
    file.rewind()?;
    Ok(length.saturating_mul(FACTOR).saturating_add(FIRST).min(MOST_MODEL_BYTES))
}

/// The content that is read so far.
#[derive(Default)]
struct Model {
    /// A position that cannot be read is not finite.
    vertices: Option<Mesh>,
    /// Corners of all faces one after the other, and where each face ends.
    corners: Vec<u32>,
    ends: Vec<usize>,
    /// Faces of which it is reported already that they are left out.
    spoiled: HashSet<usize>,
    /// Material number of each face, where the file has them.
    groups: Option<Vec<u32>>,
    strips: Vec<u32>,
    attributes: Vec<MeshAttribute>,
    without_effect: Vec<String>,
    mends: Mends,
}

fn read(name: &str, source: &mut dyn BufRead, with_rest: bool) -> Result<ModelFile, SceneError> {
    let refused = |why: String| SceneError::in_file(name, why);
    let failed = |error: std::io::Error| refused(format!("cannot be read: {error}"));
    let start = source.fill_buf().map_err(failed)?;
    let in_other_encoding = matches!(start, [0xff, 0xfe, ..] | [0xfe, 0xff, ..] | [b'p' | b'P', 0, ..] | [0, b'p' | b'P', ..]);
    if start.starts_with(&[0xef, 0xbb, 0xbf]) {
        source.consume(3);
    }
    if in_other_encoding {
        let bytes = read_text(source).map_err(failed)?;
        let (text, encoding) = encoding::decode(&bytes);
        let mut file = read(name, &mut Cursor::new(text.trim_start_matches('\0').as_bytes()), with_rest)?;
        file.warnings.extend(encoding.map(|encoding| format!("{name}: it is not in UTF-8, and read as {encoding}")));
        return Ok(file);
    }
    let mut model = Model::default();
    let header = header::read(source, &mut model.mends).map_err(refused)?;
    let bytes;
    let text;
    let mut data = match header.format {
        Format::Binary { big_endian } => Data::Binary { reader: source, big_endian, failure: None },
        Format::Text => {
            bytes = read_text(source).map_err(failed)?;
            text = encoding::decode(&bytes).0;
            let elements = header.elements.iter().filter(|element| !element.properties.is_empty());
            let counts = elements.map(|element| element.count);
            let count = counts.into_iter().try_fold(0_u64, |sum, count| Some(sum.saturating_add(count?)));
            Data::Text(Text::new(&text, header.lines, count))
        }
    };
    let mut is_whole = true;
    for element in header.elements.iter().filter(|element| !element.properties.is_empty()) {
        if !is_whole {
            break;
        }
        is_whole = model.element(element, &mut data, with_rest).map_err(refused)?;
    }
    if is_whole {
        data.finish(&mut model.mends).map_err(failed)?;
    } else if let Data::Binary { failure: Some(error), .. } = data {
        return Err(failed(error));
    }
    model.finish(name).map_err(refused)
}

/// All that is left of a file of text.
fn read_text(source: &mut dyn BufRead) -> std::io::Result<Vec<u8>> {
    input::read_to_end(source, 0, MOST_MODEL_BYTES.min(memory::available() / 2))
}

impl Model {
    /// Reads all elements of one kind. False where the file ends before the last of them.
    fn element(&mut self, element: &Element, data: &mut Data, with_rest: bool) -> Result<bool, String> {
        let of_faces = |with_rest| Roles::of_faces(element, with_rest);
        let read = match element.name.as_str() {
            "vertex" if self.vertices.is_none() => self.vertices(element, data, with_rest)?,
            "face" if of_faces(false).has(&[Role::Corners]) => self.faces(element, data, of_faces(with_rest)),
            "tristrips" if of_faces(false).has(&[Role::Corners]) => self.strips(element, data, of_faces(false)),
            _ => {
                self.without_effect.push(format!("the element {}", element.name));
                let skip = |data: &mut Data, mends: &mut Mends, _| {
                    element.properties.iter().try_for_each(|property| data.skip(property.kind, mends))
                };
                rows(element, data, &mut self.mends, skip)
            }
        };
        if let Some(count) = element.count.filter(|&count| read < count) {
            let what = "the file ends too early, and what is there of it is taken";
            self.mends.add_at(what, || format!("{read} of its {count} elements `{}`", element.name));
        }
        Ok(element.count.is_none_or(|count| read == count))
    }

    fn vertices(&mut self, element: &Element, data: &mut Data, with_rest: bool) -> Result<u64, String> {
        let mut roles = Roles::of_vertices(element, with_rest);
        if !roles.has(&[0, 1, 2].map(Role::Position)) {
            return Err("its vertices have no numbers x, y and z".to_owned());
        }
        self.without_effect.append(&mut roles.without_effect);
        let has_normals = roles.has(&[0, 1, 2].map(Role::Normal));
        let has_uvs = roles.has(&[0, 1].map(Role::Uv));
        let has_second_uvs = roles.has(&[0, 1].map(Role::SecondUv));
        let mut mesh = Mesh::default();
        let mut numbers = vec![0.0; roles.rest.count()];
        let read = rows(element, data, &mut self.mends, |data, mends, index| {
            let (mut position, mut normal, mut uv, mut second_uv) = ([0.0; 3], [0.0; 3], [0.0; 2], [0.0; 2]);
            for (property, role) in element.properties.iter().zip(&roles.of) {
                let Kind::Scalar(of) = property.kind else {
                    data.skip(property.kind, mends)?;
                    continue;
                };
                let value = data.scalar(of, mends)?;
                match *role {
                    Role::Position(axis) => position[axis] = value as f32,
                    Role::Normal(axis) => normal[axis] = value as f32,
                    Role::Uv(axis) => uv[axis] = value as f32,
                    Role::SecondUv(axis) => second_uv[axis] = value as f32,
                    Role::Attribute(place) => numbers[place] = (value * of.share()) as f32,
                    Role::Corners | Role::Group | Role::Nothing => {}
                }
            }
            let position = Vec3::from(position);
            let is_there = position.is_finite() && position.abs().max_element() <= FARTHEST;
            mesh.positions.push(if is_there { position } else { Vec3::NAN });
            if has_normals {
                let normal = Vec3::from(normal);
                if is_there && !normal.is_finite() {
                    data.mend(mends, "normals that are no three numbers are computed", "vertex", index);
                }
                mesh.normals.push(unit(normal));
            }
            let of_vertex = [(has_uvs, uv, &mut mesh.uvs), (has_second_uvs, second_uv, &mut mesh.second_uvs)];
            for (_, uv, uvs) in of_vertex.into_iter().filter(|(is_there, ..)| *is_there) {
                let uv = Vec2::from(uv);
                if is_there && !uv.is_finite() {
                    data.mend(mends, "texture coordinates that are no numbers are 0", "vertex", index);
                }
                uvs.push(if uv.is_finite() { uv } else { Vec2::ZERO });
            }
            roles.rest.push(&numbers);
            Some(())
        });
        self.attributes.extend(roles.rest.attributes(false));
        self.vertices = Some(mesh);
        Ok(read)
    }

    fn faces(&mut self, element: &Element, data: &mut Data, mut roles: Roles) -> u64 {
        self.without_effect.append(&mut roles.without_effect);
        let mut groups = roles.has(&[Role::Group]).then(Vec::new);
        let mut numbers = vec![0.0; roles.rest.count()];
        let mut list = Vec::new();
        let (corners, ends, spoiled) = (&mut self.corners, &mut self.ends, &mut self.spoiled);
        let read = rows(element, data, &mut self.mends, |data, mends, index| {
            let start = corners.len();
            let mut group = NO_VERTEX;
            for (property, role) in element.properties.iter().zip(&roles.of) {
                match (property.kind, *role) {
                    (Kind::List { count, item }, role) => {
                        data.list(count, item, &mut list, mends)?;
                        if role == Role::Corners {
                            corners.truncate(start);
                            corners.extend(list.iter().map(|&index| vertex(index)));
                        }
                    }
                    (Kind::Scalar(of), role) => {
                        let value = data.scalar(of, mends)?;
                        match role {
                            Role::Group => group = vertex(value),
                            Role::Attribute(place) => numbers[place] = (value * of.share()) as f32,
                            _ => {}
                        }
                    }
                }
            }
            if data.is_spoiled() {
                data.mend(mends, "faces that are not whole are left out", "face", index);
                spoiled.insert(ends.len());
                corners.truncate(start);
            }
            ends.push(corners.len());
            groups.iter_mut().for_each(|groups| groups.push(group));
            roles.rest.push(&numbers);
            Some(())
        });
        // The last face is cut where the file ends within it.
        corners.truncate(ends.last().copied().unwrap_or(0));
        self.groups = groups;
        self.attributes.extend(roles.rest.attributes(true));
        read
    }

    fn strips(&mut self, element: &Element, data: &mut Data, mut roles: Roles) -> u64 {
        self.without_effect.append(&mut roles.without_effect);
        let mut list = Vec::new();
        let strips = &mut self.strips;
        rows(element, data, &mut self.mends, |data, mends, index| {
            for (property, role) in element.properties.iter().zip(&roles.of) {
                match (property.kind, *role) {
                    (Kind::List { count, item }, Role::Corners) => {
                        let read = data.list(count, item, &mut list, mends);
                        strips.extend(list.iter().map(|&index| vertex(index)));
                        strips.push(NO_VERTEX);
                        // All strips are one list as a rule, so that what there is of it is taken.
                        read?;
                    }
                    (kind, _) => data.skip(kind, mends)?,
                }
            }
            if data.is_spoiled() {
                data.mend(mends, "strips that are not whole end early", "strip", index);
            }
            Some(())
        })
    }

    fn finish(mut self, name: &str) -> Result<ModelFile, String> {
        let mut warnings = Vec::new();
        if !self.without_effect.is_empty() {
            warnings.push(format!("{name}: left out: {}", short_list(&self.without_effect)));
        }
        let mut mesh = self.vertices.ok_or("it has no vertices")?;
        // The number of the polygon that each triangle is of.
        let numbered = self.groups.is_some() || self.attributes.iter().any(|attribute| attribute.of_faces);
        let mut crossing = 0;
        let mut polygons = Vec::new();
        let mut start = 0;
        for (face, end) in self.ends.into_iter().enumerate() {
            let indices = &self.corners[start..end];
            start = end;
            if self.spoiled.contains(&face) {
                continue;
            }
            if indices.len() < 3 {
                self.mends.add_at("faces of fewer than three corners are left out", || format!("face {face}"));
            } else if let Some(&index) = indices.iter().find(|&&index| index as usize >= mesh.positions.len()) {
                let what = "faces with a corner that is no vertex of the file are left out";
                self.mends.add_at(what, || no_such_vertex(face, index, mesh.positions.len()));
            } else if let Some(&index) = indices.iter().find(|&&index| !mesh.positions[index as usize].is_finite()) {
                let what = "faces with a corner whose position is no three numbers within 1e18 are left out";
                self.mends.add_at(what, || format!("face {face} uses vertex {index} (counted from 0)"));
            } else {
                crossing += usize::from(add_polygon(&mut mesh, indices));
                if numbered {
                    polygons.resize(mesh.faces.len(), face);
                }
            }
        }
        for strip in self.strips.split(|&index| index == NO_VERTEX) {
            for (number, corners) in strip.windows(3).enumerate() {
                let is_there = |index: u32| mesh.positions.get(index as usize).is_some_and(|position| position.is_finite());
                if let Some(index) = corners.iter().find(|&&index| !is_there(index)) {
                    let what = "triangles of strips with a corner that is no vertex of the file are left out";
                    self.mends.add_at(what, || format!("vertex {index} (counted from 0)"));
                    continue;
                }
                // Every other triangle of a strip is turned the other way.
                mesh.faces.push(match number % 2 {
                    0 => [corners[0], corners[1], corners[2]],
                    _ => [corners[1], corners[0], corners[2]],
                });
            }
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
        let mends = self.mends.into_substitutes();
        if mesh.faces.is_empty() {
            let why = match mends.first() {
                _ if dropped > 0 => "none of its faces has an area".to_owned(),
                Some(mend) => format!("it has points and no faces; {}", mend.what),
                None => "it has points and no faces".to_owned(),
            };
            return Err(format!("there is nothing to render in the model: {why}"));
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
        leave_out_unread(&mut mesh, &mut attributes);
        let parts = vec![ModelPart { mesh, material: None }];
        let substitutes = mends.into_iter().map(|mend| (Default::default(), mend)).collect();
        Ok(ModelFile { parts, face_groups, attributes, warnings, substitutes, ..ModelFile::default() })
    }
}

/// Reads the elements of one kind, and gives how many there were. `each` gives none where the file ended.
fn rows(
    element: &Element,
    data: &mut Data,
    mends: &mut Mends,
    mut each: impl FnMut(&mut Data, &mut Mends, u64) -> Option<()>,
) -> u64 {
    let mut read = 0;
    while element.count.is_none_or(|count| read < count) && data.begin(mends) {
        if each(data, mends, read).is_none() {
            break;
        }
        read += 1;
    }
    read
}

/// The index that a number is.
fn vertex(number: f64) -> u32 {
    if number >= 0.0 && number < f64::from(NO_VERTEX) && number.fract() == 0.0 { number as u32 } else { NO_VERTEX }
}

/// Takes vertices away whose positions could not be read, and which no face uses.
fn leave_out_unread(mesh: &mut Mesh, attributes: &mut [MeshAttribute]) {
    if mesh.positions.iter().all(|position| position.is_finite()) {
        return;
    }
    let kept: Vec<bool> = mesh.positions.iter().map(|position| position.is_finite()).collect();
    let number = |next: &mut u32, &is_kept: &bool| {
        *next += u32::from(is_kept);
        Some(*next - u32::from(is_kept))
    };
    let new: Vec<u32> = kept.iter().scan(0, number).collect();
    mesh.faces.iter_mut().flatten().for_each(|corner| *corner = new[*corner as usize]);
    retain(&mut mesh.positions, &kept);
    retain(&mut mesh.normals, &kept);
    retain(&mut mesh.uvs, &kept);
    retain(&mut mesh.second_uvs, &kept);
    attributes.iter_mut().filter(|attribute| !attribute.of_faces).for_each(|attribute| retain(&mut attribute.values, &kept));
}

fn retain<T>(items: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    items.retain(|_| *kept.next().unwrap_or(&true));
}

/// A normal of about length 1 stays as it is: what is made of it later is of length 1 in double precision. One of no length is computed
/// later.
fn unit(normal: Vec3) -> Vec3 {
    if (0.5..2.0).contains(&normal.length_squared()) { normal } else { normal.try_normalize().unwrap_or_default() }
}

fn no_such_vertex(face: usize, index: u32, count: usize) -> String {
    let which = if index == NO_VERTEX { "a vertex below 0, or none".to_owned() } else { format!("vertex {index}") };
    format!("face {face} uses {which}, but there are only {count} (counted from 0)")
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

#[cfg(test)]
mod tests;
