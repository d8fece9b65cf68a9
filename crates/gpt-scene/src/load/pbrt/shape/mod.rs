//! Shapes: spheres, disks and cylinders (`quadric`), triangles (`mesh`), bilinear patches (`bilinear`) and subdivided meshes (`loop_subdivision`).

mod bilinear;
mod loop_subdivision;
mod mesh;
mod orientation;
mod quadric;

use std::sync::Arc;

use glam::{DAffine3, DVec3};

use super::converter::{Converter, MaterialLooks, is_flat};
use super::graphics_state::Maps;
use super::light::AreaLight;
use super::parameter::Entity;
use super::texture_entry::Use;
use super::world::ShapeRecord;
use crate::load::error::SceneError;
use crate::load::file::shape::{ShapeEntry, mesh as mesh_shape};
use crate::load::file::value::Located;
use crate::load::import::{Input, MOST_SHAPES, Sides, mesh_of, turn_inside_out};
use crate::scene::Mesh;

/// The use of a shape's geometry.
#[derive(Debug, Clone, Copy)]
struct Needs {
    looks: MaterialLooks,
    /// Its front is turned, and that is seen.
    flips: bool,
    /// The shape has to be made of triangles.
    as_mesh: bool,
}

/// A shape's geometry in a space that a map puts into the world.
struct Geometry {
    entry: ShapeEntry,
    map: DAffine3,
    /// The area of each surface that gives off the power of a light by itself: all of it, or its triangles.
    areas: Vec<f64>,
}

/// A shape with its material, without its place.
pub struct Surface {
    pub entry: ShapeEntry,
    /// From its own space to that in which its transforms are, and those.
    pub own: DAffine3,
    pub maps: Maps,
    pub sides: Sides,
}

impl Converter<'_> {
    /// Adds a shape that stands for itself.
    pub fn shape(&mut self, record: &ShapeRecord) -> Result<(), SceneError> {
        match self.surface(record, false, false)? {
            Some(surface) => self.add_surface(&surface, &surface.maps, &record.entity),
            None => Ok(()),
        }
    }

    /// Adds a shape where these transforms put it.
    pub fn add_surface(&mut self, surface: &Surface, maps: &Maps, entity: &Entity) -> Result<(), SceneError> {
        let spot = &entity.spot;
        if self.scene.file.shape.len() >= MOST_SHAPES {
            return Err(spot.error(format!("the scene has more than {MOST_SHAPES} shapes, instances counted")));
        }
        let mut entry = surface.entry.clone();
        let placed = maps.map(|map| map * surface.own);
        *entry.common_mut().transform = self.transform(&placed[0], spot)?;
        *entry.common_mut().motion = self.motion(&placed, spot)?;
        let place = spot.place();
        let mut enclosures = std::mem::take(&mut self.enclosures);
        enclosures.note(&self.scene, &entry, surface.sides.clone(), &place);
        self.enclosures = enclosures;
        self.scene.file.shape.push(place.at(entry));
        Ok(())
    }

    /// A shape of the scene, or of a group; None where nothing of it is rendered.
    pub fn surface(&mut self, record: &ShapeRecord, is_of_group: bool, as_mesh: bool) -> Result<Option<Surface>, SceneError> {
        let ShapeRecord { entity, maps, .. } = record;
        let spot = &entity.spot;
        if is_flat(maps) {
            return Err(entity.error("the transform flattens the shape or leaves the range of numbers"));
        }
        let mut material = self.material(&record.material, spot)?;
        let looks = self.looks.get(&material).copied().unwrap_or_default();
        let light = self.light_of(record, looks, is_of_group)?;
        let alpha = match self.float_node(entity, "alpha")? {
            Some(node) => self.input(&node, Use::Share, entity.spot_of("alpha"))?,
            None => Input::grey(1.0),
        };
        let mut sides = self.sides_of(record)?;
        let is_textured = looks.is_textured || alpha.constant().is_none();
        let is_textured = is_textured || light.as_ref().is_some_and(|light| light.radiance.constant().is_none());
        // A front that no one tells from the back need not be turned.
        let has_front = light.as_ref().is_some_and(|light| !light.both_sides)
            || (sides.is_boundary && !looks.is_nothing)
            || looks.tells_sides;
        let needs = Needs { looks: MaterialLooks { is_textured, ..looks }, flips: has_front, as_mesh };
        let geometry = self.geometry(record, needs)?;
        self.report_unused(entity);
        let Some(Geometry { mut entry, map, areas }) = geometry else { return Ok(None) };
        if looks.is_nothing && sides.is_boundary && turn_outwards(record, &mut entry) {
            std::mem::swap(&mut sides.inside, &mut sides.outside);
        }
        let is_unseen = alpha.constant().is_some_and(|share| share.r() <= 0.0);
        if let Some(light) = &light {
            let radiance = self.radiance(light, &areas, entity);
            if radiance.constant().is_none_or(|radiance| !radiance.is_black()) {
                material = self.giving_light(spot, &material, &radiance, light.both_sides)?;
            }
        }
        if is_unseen && light.is_some() {
            let instead = "the camera does not see it, and all other rays do; there nothing meets it";
            self.approximate(entity.spot_of("alpha"), "light of a shape that is not there", instead);
            material = self.unseen(spot, &material)?;
        } else if alpha.constant().is_none_or(|share| share.r() < 1.0) {
            material = self.opening(spot, &material, &alpha)?;
        }
        let place = spot.place();
        if is_of_group {
            let mut enclosures = std::mem::take(&mut self.enclosures);
            let filled = enclosures.of_group(&mut self.scene, material, &sides, &place);
            self.enclosures = enclosures;
            material = spot.possible(filled)?;
        }
        *entry.common_mut().material = Some(place.at(material));
        Ok(Some(Surface { entry, own: map, maps: *maps, sides }))
    }

    /// The light that a shape gives.
    fn light_of(
        &mut self,
        record: &ShapeRecord,
        looks: MaterialLooks,
        is_of_group: bool,
    ) -> Result<Option<AreaLight>, SceneError> {
        let Some(light) = &record.light else { return Ok(None) };
        let spot = &record.entity.spot;
        if is_of_group {
            self.drop(spot, "AreaLightSource of a shape within an object", "it gives no light, as there");
            return Ok(None);
        }
        if looks.is_nothing {
            self.drop(spot, "AreaLightSource of a shape of the material `interface`", "it gives no light, as there");
            return Ok(None);
        }
        let light = light.clone();
        self.area_light(&light)
    }

    /// The radiance of a shape that is made of surfaces of these areas.
    fn radiance(&mut self, light: &AreaLight, areas: &[f64], entity: &Entity) -> Input {
        let sum: f64 = areas.iter().sum();
        let mean = sum / areas.len().max(1) as f64;
        let is_uneven = areas.iter().any(|area| (area / mean - 1.0).abs() > 1e-3);
        if light.power.is_some() && is_uneven {
            let instead = "all triangles together give it off evenly; there each gives off the same power";
            self.approximate(&entity.spot, "power of a light of triangles of different sizes", instead);
        }
        light.radiance_of(mean.max(f64::MIN_POSITIVE))
    }

    /// The media on both sides of a shape.
    fn sides_of(&mut self, record: &ShapeRecord) -> Result<Sides, SceneError> {
        if record.inside == record.outside {
            return Ok(Sides::default());
        }
        let spot = &record.entity.spot;
        let (inside, outside) = (self.medium(&record.inside, spot)?, self.medium(&record.outside, spot)?);
        let is_boundary = inside != outside;
        Ok(Sides { inside, outside, is_boundary })
    }

    fn geometry(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Option<Geometry>, SceneError> {
        match record.entity.name.as_str() {
            "sphere" => self.sphere(record, needs).map(Some),
            "disk" => self.disk(record, needs).map(Some),
            "cylinder" => self.cylinder(record, needs).map(Some),
            "trianglemesh" => self.triangle_mesh(record, needs),
            "plymesh" => self.ply_mesh(record, needs),
            "bilinearmesh" => self.bilinear_mesh(record, needs),
            "loopsubdiv" => self.loop_subdivision(record, needs),
            other => {
                record.entity.all_without_effect();
                self.drop(&record.entity.spot, format!("Shape `{other}`"), "it is left out");
                Ok(None)
            }
        }
    }

    /// The geometry of a mesh in the shape's own space; None where nothing of it has area.
    fn geometry_of_mesh(&mut self, record: &ShapeRecord, needs: Needs, mut mesh: Mesh) -> Result<Option<Geometry>, SceneError> {
        let spot = &record.entity.spot;
        mesh.drop_degenerate_faces();
        if mesh.faces.is_empty() {
            self.drop(spot, "mesh without a face that has area", "it is left out");
            return Ok(None);
        }
        if !needs.looks.is_textured && !needs.looks.is_bent {
            mesh.uvs.clear();
        }
        let mesh = Arc::new(mesh);
        self.placed_mesh(record, mesh).map(Some)
    }

    fn placed_mesh(&mut self, record: &ShapeRecord, mesh: Arc<Mesh>) -> Result<Geometry, SceneError> {
        let spot = &record.entity.spot;
        self.counted(spot, mesh.faces.len() as u64)?;
        let areas = if record.light.is_some() { areas_of(&mesh, &record.maps[0]) } else { Vec::new() };
        let entry = ShapeEntry::Mesh(mesh_shape::Keys::of(mesh, &spot.place()));
        Ok(Geometry { entry, map: DAffine3::IDENTITY, areas })
    }
}

/// Turns the front of a shape, of which no more than its two sides is seen, away from what it encloses. True where it was turned.
fn turn_outwards(record: &ShapeRecord, entry: &mut ShapeEntry) -> bool {
    let Some(mesh) = mesh_of(entry) else { return !matches!(entry, ShapeEntry::Disk(_)) && orientation::is_flipped(record) };
    let corner = |index: u32| mesh.positions[index as usize].as_dvec3();
    let volume = |face: &[u32; 3]| {
        let [a, b, c] = face.map(corner);
        a.dot(b.cross(c))
    };
    let is_inward = mesh.faces.iter().map(volume).sum::<f64>() < 0.0;
    if !is_inward || record.maps[0].matrix3.determinant() < 0.0 {
        return false;
    }
    let mut turned = Mesh::clone(mesh);
    turn_inside_out(&mut turned);
    *entry = ShapeEntry::Mesh(mesh_shape::Keys::of(Arc::new(turned), &record.entity.spot.place()));
    true
}

/// The areas of a mesh's triangles where a map puts them.
fn areas_of(mesh: &Mesh, map: &DAffine3) -> Vec<f64> {
    let corner = |index: u32| map.transform_point3(mesh.positions[index as usize].as_dvec3());
    let area = |face: &[u32; 3]| {
        let [a, b, c] = face.map(corner);
        0.5 * (b - a).cross(c - a).length()
    };
    mesh.faces.iter().map(area).collect()
}

/// Lets the fronts of faces be where the normals of their corners point.
fn face_normals(mesh: &mut Mesh) {
    if mesh.normals.is_empty() {
        return;
    }
    for index in 0..mesh.faces.len() {
        let face = mesh.faces[index];
        let sum: DVec3 = face.iter().map(|corner| mesh.normals[*corner as usize].as_dvec3()).sum();
        if mesh.face_normal(face).is_some_and(|normal| normal.dot(sum) < 0.0) {
            mesh.faces[index].swap(1, 2);
        }
    }
}

/// A shape at its place, as groups hold it.
pub fn at_place(converter: &Converter<'_>, surface: &Surface, entity: &Entity) -> Result<Located<ShapeEntry>, SceneError> {
    let mut entry = surface.entry.clone();
    *entry.common_mut().transform = converter.transform(&(surface.maps[0] * surface.own), &entity.spot)?;
    Ok(entity.spot.place().at(entry))
}
