//! Primitives of meshes: triangles, strips and fans.

use std::sync::Arc;

use glam::{DAffine2, DVec2, Vec2, Vec3};
use serde_json::{Map, Value};

use super::importer::Importer;
use super::json::Primitive;
use super::made::{Bending, Coordinates, Form, MadePrimitive, Paint};
use super::variant;
use crate::load::file::syntax::TextureEntry;
use crate::load::import::Blocks;
use crate::load::model::{FARTHEST, MeshAttribute};
use crate::scene::Mesh;

/// `COLOR_0`.
struct Colours {
    attribute: MeshAttribute,
    /// A number for each vertex, where some is below 1.
    alpha: Option<Vec<f32>>,
}

impl Importer<'_> {
    /// None where there is nothing to render.
    pub fn primitive(&mut self, mesh: usize, index: usize, bending: Bending) -> Result<Option<MadePrimitive>, String> {
        if bending.is_none()
            && let Some(made) = self.meshes.get(&(mesh, index))
        {
            return Ok(Some(made.clone()));
        }
        let of = &self.root.meshes[mesh];
        let primitive = of.primitives[index].clone();
        let key = format!("meshes[{mesh}].primitives[{index}]");
        let mode = primitive.mode.unwrap_or(4);
        if !(4..=6).contains(&mode) {
            let other = format!("mode {mode}");
            let what = ["points", "lines", "lines", "lines"].get(mode as usize).map_or(other.as_str(), |what| what);
            self.drop(what, &key, "they have no surface and are left out");
            return Ok(None);
        }
        if primitive.extensions.contains_key("KHR_draco_mesh_compression") && !self.has_data(&primitive.attributes)? {
            return Err(format!("its data are packed by Draco, which is not read: `{}` unpacks them", super::DRACO_COMMAND));
        }
        let named = variant::material_of(self.variant, &primitive);
        let mut material = self.material(named)?;
        let Some(base) = self.geometry(&primitive, mode, &key)? else { return Ok(None) };
        let mut deformation = self.deformation(&primitive, base, bending.weights.unwrap_or(&of.weights), bending)?;
        let is_deformed = bending.is_animated();
        let mut built = if is_deformed { Mesh::clone(&deformation.base) } else { deformation.at_rest() };
        check_range(&built)?;
        complete_normals(&mut built);
        let colours = self.colours(&primitive, material.coordinates, built.positions.len(), &key)?;
        self.coordinates(&primitive, material.coordinates, &mut built, &key)?;
        let can_be_split = !is_deformed && colours.is_none();
        let is_framed = self.frame(&primitive, material.coordinates, &mut built, can_be_split, &key)?;
        let mut form = Form { is_framed, is_outline: self.is_outline(mesh, named, &built), paint: None };
        if form.is_outline {
            self.approximate("outline: a closed surface that looks inward", &key, "the camera alone sees it");
        }
        if is_deformed && built.drop_degenerate_faces() > 0 {
            self.drop("face without area of a deformed mesh", &key, "it is left out, at frames where it has area too");
        }
        if built.faces.is_empty() {
            self.drop("primitive without a face that has area", &key, "it is left out");
            return Ok(None);
        }
        if let Some(colours) = colours {
            let is_beside = material.coordinates.is_some();
            let blocks = if is_beside { Blocks::beside(&mut built) } else { Blocks::of(&mut built) };
            deformation.spread(blocks.corners());
            let (name, place) = (self.scene.free_texture_name(&format!("{key}.COLOR_0")), self.place(&key));
            let made = blocks.texture(&colours.attribute, colours.alpha.as_deref(), &place);
            let mut entry = made.ok_or("COLOR_0 makes no picture")?;
            entry.name = place.at(name.clone());
            entry.second_uvs = is_beside.then_some(true);
            self.scene.file.texture.push(TextureEntry::Image(entry));
            form.paint = Some(Paint { texture: name, has_alpha: colours.alpha.is_some() });
        }
        if form != Form::default() {
            material = self.material_as(named, &form)?;
        }
        built.smooth = !built.normals.is_empty();
        let (triangles, mesh_of_file) = (built.faces.len() as u64, Arc::new(built));
        let deformation = if is_deformed {
            deformation.base = mesh_of_file.clone();
            let rest = deformation.at_rest();
            check_range(&rest)?;
            self.scene.add_deformed(&mesh_of_file, rest);
            let place = self.place(&key);
            Some(Box::new(place.at(self.deformation_entry(&deformation, bending, &place)?)))
        } else {
            None
        };
        let made = MadePrimitive { mesh: mesh_of_file, material: material.name, triangles, deformation };
        if bending.is_none() {
            self.meshes.insert((mesh, index), made.clone());
        }
        Ok(Some(made))
    }

    /// The primitive before anything bends it.
    fn geometry(&mut self, primitive: &Primitive, mode: u64, key: &str) -> Result<Option<Mesh>, String> {
        if !primitive.attributes.contains_key("POSITION") {
            self.drop("primitive without positions", key, "it is left out");
            return Ok(None);
        }
        let positions = self.triples(&primitive.attributes, "POSITION")?.unwrap_or_default();
        let normals = self.triples(&primitive.attributes, "NORMAL")?.unwrap_or_default();
        let count = positions.len();
        if !normals.is_empty() && normals.len() != count {
            return Err(format!("there are {} normals for {count} positions", normals.len()));
        }
        let indices = match primitive.indices {
            Some(accessor) => self.buffers.indices(accessor)?,
            None => (0..count as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|index| **index as usize >= count) {
            return Err(format!("a face uses vertex {index}, but there are only {count} (counted from 0)"));
        }
        if mode == 4 && !indices.len().is_multiple_of(3) {
            self.drop("indices that make no whole triangle", key, "the last ones are left out");
        }
        Ok(Some(Mesh { positions, normals, faces: triangles(&indices, mode), ..Mesh::default() }))
    }

    /// The vertices' colours, which multiply the base colour and its alpha.
    fn colours(
        &mut self,
        primitive: &Primitive,
        coordinates: Option<Coordinates>,
        count: usize,
        key: &str,
    ) -> Result<Option<Colours>, String> {
        let Some(accessor) = accessor(&primitive.attributes, "COLOR_0")? else { return Ok(None) };
        let (mut numbers, channels) = self.buffers.numbers(accessor, &["VEC3", "VEC4"])?;
        // Colours are fractions, whether integers say so or not.
        if let Some(largest) = self.buffers.largest_of_whole_numbers(accessor) {
            self.approximate("COLOR_0 of integers that are not normalized", key, "they are taken for fractions");
            numbers.iter_mut().for_each(|number| *number /= largest);
        }
        let value = |number: f32| if number.is_finite() { number.clamp(0.0, 1.0) } else { 0.0 };
        let values: Vec<Vec3> = numbers
            .chunks_exact(channels)
            .map(|colour| Vec3::new(value(colour[0]), value(colour[1]), value(colour[2])))
            .collect();
        if values.len() != count {
            return Err(format!("there are {} COLOR_0 for {count} positions", values.len()));
        }
        let alpha = (channels == 4).then(|| numbers.chunks_exact(4).map(|colour| value(colour[3])).collect::<Vec<_>>());
        let alpha = alpha.filter(|alpha| alpha.iter().any(|alpha| *alpha < 1.0));
        if alpha.is_none() && values.iter().all(|colour| *colour == Vec3::ONE) {
            return Ok(None);
        }
        if coordinates.is_some_and(|coordinates| coordinates.second.is_some()) {
            self.drop("COLOR_0 of a material with two sets of texture coordinates", key, "the textures alone count");
            return Ok(None);
        }
        Ok(Some(Colours { attribute: MeshAttribute { name: "color".to_owned(), of_faces: false, values }, alpha }))
    }

    /// Texture coordinates as the material wants them. v runs upward here.
    fn coordinates(
        &mut self,
        primitive: &Primitive,
        wanted: Option<Coordinates>,
        mesh: &mut Mesh,
        key: &str,
    ) -> Result<(), String> {
        let Some(Coordinates { set, map, second }) = wanted else { return Ok(()) };
        let count = mesh.positions.len();
        match self.texture_coordinates(primitive, set, &map, count)? {
            Some(uvs) => mesh.uvs = uvs,
            None => {
                let place = self.place(key).to_string();
                let instead = "the texture at (0, 0) is everywhere";
                self.scene.report.approximate("texture on a primitive without texture coordinates", place, instead);
                mesh.uvs = vec![Vec2::ZERO; count];
            }
        }
        let Some(second) = second else { return Ok(()) };
        match self.texture_coordinates(primitive, second, &DAffine2::IDENTITY, count)? {
            Some(uvs) => mesh.second_uvs = uvs,
            None => {
                let place = self.place(key).to_string();
                let what = format!("texture by TEXCOORD_{second} on a primitive without it");
                self.scene.report.approximate(&what, place, format!("it lies by TEXCOORD_{set}"));
            }
        }
        Ok(())
    }

    /// A set of texture coordinates, one for each position; None where the primitive has none of that number.
    fn texture_coordinates(
        &self,
        primitive: &Primitive,
        set: u64,
        map: &DAffine2,
        count: usize,
    ) -> Result<Option<Vec<Vec2>>, String> {
        let name = format!("TEXCOORD_{set}");
        let Some(accessor) = accessor(&primitive.attributes, &name)? else { return Ok(None) };
        let (numbers, _) = self.buffers.numbers(accessor, &["VEC2"])?;
        let uvs = numbers.as_chunks::<2>().0.iter().map(|&[u, v]| {
            let at = map.transform_point2(DVec2::new(u.into(), v.into()));
            Vec2::new(at.x as f32, (1.0 - at.y) as f32)
        });
        let uvs: Vec<Vec2> = uvs.collect();
        if uvs.len() != count {
            return Err(format!("there are {} {name} for {count} positions", uvs.len()));
        }
        if uvs.iter().any(|uv| !uv.is_finite()) {
            return Err(format!("{name} has numbers that are not finite"));
        }
        Ok(Some(uvs))
    }

    /// The positions stand in the file, and not only packed.
    fn has_data(&self, attributes: &Map<String, Value>) -> Result<bool, String> {
        let Some(index) = accessor(attributes, "POSITION")? else { return Ok(false) };
        Ok(self.root.accessors.get(index).is_some_and(|accessor| accessor.buffer_view.is_some() || accessor.sparse.is_some()))
    }

    pub fn triples(&self, attributes: &Map<String, Value>, name: &str) -> Result<Option<Vec<Vec3>>, String> {
        let Some(accessor) = accessor(attributes, name)? else { return Ok(None) };
        let (numbers, _) = self.buffers.numbers(accessor, &["VEC3"])?;
        Ok(Some(numbers.as_chunks::<3>().0.iter().map(|xyz| Vec3::from_array(*xyz)).collect()))
    }
}

/// The accessor of an attribute.
pub fn accessor(attributes: &Map<String, Value>, name: &str) -> Result<Option<usize>, String> {
    let Some(value) = attributes.get(name) else { return Ok(None) };
    let index = value.as_u64().and_then(|index| usize::try_from(index).ok());
    index.map(Some).ok_or_else(|| format!("{name} names no accessor"))
}

/// Corners of triangles, of a list, a strip or a fan.
fn triangles(indices: &[u32], mode: u64) -> Vec<[u32; 3]> {
    match mode {
        5 => {
            let turned = |(at, corners): (usize, &[u32])| {
                if at.is_multiple_of(2) { [corners[0], corners[1], corners[2]] } else { [corners[0], corners[2], corners[1]] }
            };
            indices.windows(3).enumerate().map(turned).collect()
        }
        6 => indices.get(1..).unwrap_or_default().windows(2).map(|pair| [pair[0], pair[1], indices[0]]).collect(),
        _ => indices.as_chunks::<3>().0.to_vec(),
    }
}

fn check_range(mesh: &Mesh) -> Result<(), String> {
    let is_far = |position: &Vec3| !position.is_finite() || position.abs().max_element() > FARTHEST;
    match mesh.positions.iter().position(is_far) {
        Some(at) => Err(format!("vertex {at} stands at {}: not within 1e18", mesh.positions[at])),
        None => Ok(()),
    }
}

/// Normals of no length are those of the faces around.
fn complete_normals(mesh: &mut Mesh) {
    if mesh.normals.is_empty() || mesh.normals.iter().all(|normal| *normal != Vec3::ZERO && normal.is_finite()) {
        return;
    }
    let written = std::mem::take(&mut mesh.normals);
    crate::load::import::smooth_by_index(mesh);
    for (normal, written) in mesh.normals.iter_mut().zip(written) {
        if written != Vec3::ZERO && written.is_finite() {
            *normal = written;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_front() {
        assert_eq!(triangles(&[0, 1, 2, 3, 4], 5), [[0, 1, 2], [1, 3, 2], [2, 3, 4]]);
        assert_eq!(triangles(&[0, 1, 2, 3], 6), [[1, 2, 0], [2, 3, 0]]);
        assert_eq!(triangles(&[0, 1, 2, 3], 4), [[0, 1, 2]]);
        for mode in 4..=6 {
            assert!(triangles(&[], mode).is_empty() && triangles(&[7, 8], mode).is_empty());
        }
    }
}
