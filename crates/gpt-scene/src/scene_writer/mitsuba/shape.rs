//! Shapes.

use glam::{DAffine3, DMat3, DVec3, Vec2, Vec3};
use toml::{Table, Value};

use super::Writer;
use super::keys::{Keys, as_number, entries, flag, number, text, transform, vector};
use super::xml::{Element, matrix};
use crate::load::SceneError;
use crate::load::file::writer::ply;
use crate::scene::Mesh;

/// Half the side of the rectangle that stands for an infinite plane.
const PLANE: f64 = 1e4;

impl Writer<'_> {
    pub fn shape(&mut self, index: usize, shape: &Keys<'_>) -> Result<(), SceneError> {
        if let Some(element) = self.shape_element(&format!("shape[{index}]"), shape)? {
            let element = self.with_media(element, self.original.shapes.get(index), false);
            self.xml.push(element);
        }
        Ok(())
    }

    /// `[[group]]` as a shape group, and the instances that name it.
    pub fn group(&mut self, index: usize, group: &Table) -> Result<(), SceneError> {
        let name = text(group, "name").unwrap_or_default();
        let mut element = Element::new("shape", "shapegroup").id(&group_id(name));
        for (number, shape) in entries(group, "shape").into_iter().map(Keys::of).enumerate() {
            if let Some(shape) = self.shape_element(&format!("group[{index}].shape[{number}]"), &shape)? {
                let original = self.original.groups.get(index).and_then(|group| group.shapes.get(number));
                element = element.with(self.with_media(shape, original, true));
            }
        }
        self.xml.push(element);
        Ok(())
    }

    /// `[[instance]]`, an instance for each place.
    pub fn instances(&mut self, index: usize, instances: &Keys<'_>) {
        // The scene has the places, wherever the file keeps them.
        let _ = (instances.contains_key("places"), instances.contains_key("file"));
        let all = instances.get("transform").map_or(DAffine3::IDENTITY, transform);
        let group = group_id(text(instances, "group").unwrap_or_default());
        let places = self.original.instances.get(index).map_or(&[][..], |instances| &instances.places);
        for own in places {
            let element = Element::new("shape", "instance").transform("to_world", &matrix(&(all * *own)));
            self.xml.push(element.reference(&group));
        }
    }

    fn shape_element(&mut self, place: &str, shape: &Keys<'_>) -> Result<Option<Element>, SceneError> {
        if flag(shape, "portal") == Some(true) {
            self.drop("portal", place, "its directions are not sampled by themselves");
        }
        let around = shape.get("transform").map_or(DAffine3::IDENTITY, transform);
        let mirrors = around.matrix3.determinant() < 0.0;
        let textured = text(shape, "material").is_some_and(|name| self.shows_texture(name, 0));
        let (element, own) = match text(shape, "type").unwrap_or_default() {
            "mesh" => {
                let element = self.mesh(shape, place)?;
                // A mirror turns faces over there, unless normals of the file say where their fronts are.
                let turns = mirrors && flag(shape, "smooth") == Some(false);
                (if turns { element.boolean("flip_normals", true) } else { element }, DAffine3::IDENTITY)
            }
            "sphere" => {
                let (center, radius) = (vector(shape, "center").unwrap_or_default(), number(shape, "radius").unwrap_or(1.0));
                let element = Element::new("shape", "sphere");
                // There a mirror turns spheres inside out.
                let element = if mirrors { element.boolean("flip_normals", true) } else { element };
                if textured {
                    (element.float("radius", radius), DAffine3::from_translation(center) * about_z())
                } else {
                    (element.point("center", center).float("radius", radius), DAffine3::IDENTITY)
                }
            }
            "rectangle" => {
                let axis = |key: &str| vector(shape, key).unwrap_or(DVec3::X);
                let (corner, u, v) = (axis("corner"), axis("edge_u") * 0.5, axis("edge_v") * 0.5);
                (Element::new("shape", "rectangle"), frame(u, v, corner + u + v))
            }
            "disk" => {
                let normal = vector(shape, "normal").unwrap_or(DVec3::Z).normalize_or(DVec3::Z);
                let (u, v) = normal.any_orthonormal_pair();
                let radius = number(shape, "radius").unwrap_or(1.0);
                (Element::new("shape", "disk"), frame(u * radius, v * radius, vector(shape, "center").unwrap_or_default()))
            }
            "box" => {
                let (min, max) = (vector(shape, "min").unwrap_or_default(), vector(shape, "max").unwrap_or_default());
                let map = DAffine3::from_translation(0.5 * (min + max)) * DAffine3::from_scale(0.5 * (max - min));
                (Element::new("shape", "cube"), map)
            }
            "cylinder" => {
                let end = |key: &str| vector(shape, key).unwrap_or_default();
                let element = Element::new("shape", "cylinder").point("p0", end("from")).point("p1", end("to"));
                let element = element.float("radius", number(shape, "radius").unwrap_or(1.0));
                let along = end("to") - end("from");
                let is_upright = end("from") == DVec3::ZERO && along.truncate() == glam::DVec2::ZERO && along.z > 0.0;
                // Texture coordinates go round the other way there.
                let own = DAffine3::from_scale(DVec3::new(1.0, -1.0, 1.0));
                if textured && !is_upright {
                    self.approximate("texture on shape `cylinder`", place, "it is turned about the axis");
                }
                (element, if textured && is_upright { own } else { DAffine3::IDENTITY })
            }
            "plane" => {
                self.approximate("shape `plane`", place, "a rectangle of 20,000 units is taken");
                let normal = vector(shape, "normal").unwrap_or(DVec3::Y).normalize_or(DVec3::Y);
                let (u, v) = normal.any_orthonormal_pair();
                (Element::new("shape", "rectangle"), frame(u * PLANE, v * PLANE, vector(shape, "point").unwrap_or_default()))
            }
            other => {
                self.drop(&format!("shape `{other}`"), place, "it is left out");
                return Ok(None);
            }
        };
        if let (true, Some(kind @ ("box" | "disk" | "plane"))) = (textured, text(shape, "type")) {
            self.approximate(&format!("texture on shape `{kind}`"), place, "it lies otherwise there");
        }
        let map = around * own;
        let element = if map == DAffine3::IDENTITY { element } else { element.transform("to_world", &matrix(&map)) };
        let element = match text(shape, "material") {
            Some(name) => {
                let element = element.reference(name);
                match self.emission(name, place) {
                    Some(emitter) => element.with(emitter),
                    None => element,
                }
            }
            None => {
                self.drop("materials of a mesh file", place, "the shape is a diffuse grey");
                element
            }
        };
        self.drop_rest(shape, place);
        Ok(Some(element))
    }

    fn mesh(&mut self, shape: &Keys<'_>, place: &str) -> Result<Element, SceneError> {
        let smooth = flag(shape, "smooth");
        let Some(file) = text(shape, "file") else {
            let mut mesh = inline(shape);
            mesh.smooth = smooth.unwrap_or(!mesh.normals.is_empty());
            if mesh.smooth && mesh.normals.is_empty() {
                mesh.compute_smooth_normals();
            }
            let name = self.files.add_file(&format!("{}.ply", file_of(place)), ply(&mesh, None));
            return Ok(Element::new("shape", "ply").string("filename", &name).boolean("face_normals", !mesh.smooth));
        };
        let lower = file.to_ascii_lowercase();
        if lower.ends_with(".gz") {
            self.drop("packed mesh file", place, "Mitsuba does not unpack it");
        }
        let kind = if lower.ends_with(".obj") { "obj" } else { "ply" };
        if smooth.is_none() {
            self.approximate("`smooth` that is not written", place, "Mitsuba makes normals where the file has none");
        }
        let name = self.file(file);
        let element = Element::new("shape", kind).string("filename", &name);
        // Our v runs upward in every file.
        let element = if kind == "obj" { element.boolean("flip_tex_coords", false) } else { element };
        Ok(if smooth == Some(false) { element.boolean("face_normals", true) } else { element })
    }
}

/// The axis about which texture coordinates of spheres turn is +Z there and +Y here.
fn about_z() -> DAffine3 {
    DAffine3::from_mat3(DMat3::from_cols(DVec3::Y, DVec3::NEG_Z, DVec3::NEG_X).transpose())
}

/// No material has this name.
fn group_id(name: &str) -> String {
    format!("group {name}")
}

/// The name of a shape's file: `shape-3`, `group-0-shape-3`.
fn file_of(place: &str) -> String {
    place.replace(['[', '.'], "-").replace(']', "")
}

fn inline(shape: &Keys<'_>) -> Mesh {
    let rows = |key: &str| -> Vec<Vec<f64>> {
        let list = shape.get(key).and_then(Value::as_array);
        let row = |row: &Value| row.as_array().map(|row| row.iter().filter_map(as_number).collect()).unwrap_or_default();
        list.map(|list| list.iter().map(row).collect()).unwrap_or_default()
    };
    let at = |row: &[f64], place: usize| row.get(place).copied().unwrap_or(0.0);
    let triples = |key: &str| -> Vec<Vec3> {
        rows(key).iter().map(|row| DVec3::new(at(row, 0), at(row, 1), at(row, 2)).as_vec3()).collect()
    };
    Mesh {
        positions: triples("positions"),
        normals: triples("normals"),
        uvs: rows("uvs").iter().map(|row| Vec2::new(at(row, 0) as f32, at(row, 1) as f32)).collect(),
        faces: rows("faces").iter().map(|row| [0, 1, 2].map(|corner| at(row, corner) as u32)).collect(),
        ..Mesh::default()
    }
}

/// The map of the plane z = 0 to the one along these axes, its front along their product.
fn frame(u: DVec3, v: DVec3, middle: DVec3) -> DAffine3 {
    DAffine3 { matrix3: DMat3::from_cols(u, v, u.cross(v).normalize_or(DVec3::Z)), translation: middle }
}
