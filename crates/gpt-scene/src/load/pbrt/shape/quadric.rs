//! Spheres, disks and cylinders, whole ones and parts of them.

use std::f64::consts::TAU;
use std::sync::Arc;

use glam::{DAffine3, DMat3, DVec3};

use super::orientation::is_flipped;
use super::{Geometry, Needs};
use crate::load::error::SceneError;
use crate::load::file::shape::{ShapeEntry, cylinder, disk, sphere};
use crate::load::import::{is_uniform, sheet, turn_inside_out};
use crate::load::pbrt::converter::Converter;
use crate::load::pbrt::parameter::Entity;
use crate::load::pbrt::world::ShapeRecord;
use crate::scene::Mesh;

/// Columns of the triangles of a whole turn.
const COLUMNS: f64 = 128.0;

/// How a part of a round shape is made of triangles, and what reports say of it.
struct Part {
    key: String,
    what: String,
}

impl Converter<'_> {
    pub(super) fn sphere(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Geometry, SceneError> {
        let entity = &record.entity;
        let radius = positive(entity, "radius", 1.0)?;
        let [low, high] = ordered(entity, ["zmin", "zmax"], [-radius, radius])?.map(|z| z.clamp(-radius, radius));
        let turn = turn_of(entity)?;
        let area = turn * radius * (high - low);
        let [from, to] = [low, high].map(|z| (z / radius).acos());
        let is_whole = turn == TAU && low == -radius && high == radius;
        if is_whole && self.stays_round(record, needs) {
            let entry = ShapeEntry::Sphere(entity.possible(sphere::Keys::of(DVec3::ZERO, radius))?);
            // Texture coordinates turn about +Y here, from −Z over +X, and about +Z there, from +X over +Y.
            let axes = DMat3::from_cols(DVec3::NEG_Z, DVec3::X, DVec3::Y).transpose();
            let map = if needs.looks.is_textured { DAffine3::from_mat3(axes) } else { DAffine3::IDENTITY };
            return Ok(Geometry { entry, map, areas: vec![area] });
        }
        let part = self.part(record, needs, is_whole, &format!("{turn} {from} {to}"));
        let place = |u: f64, v: f64| {
            let ((sine, cosine), (across, height)) = ((turn * u).sin_cos(), (from + (to - from) * v).sin_cos());
            let at = DVec3::new(across * cosine, across * sine, height);
            (at, at)
        };
        let map = DAffine3::from_scale(DVec3::splat(radius));
        self.round_mesh(record, part, map, area, || sheet(columns(turn), 64, place))
    }

    pub(super) fn disk(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Geometry, SceneError> {
        let entity = &record.entity;
        let radius = positive(entity, "radius", 1.0)?;
        let (height, inner, turn) = (entity.float_or("height", 0.0)?, entity.float_or("innerradius", 0.0)?, turn_of(entity)?);
        if !(0.0..radius).contains(&inner) {
            return Err(entity.spot_of("innerradius").error("`innerradius` is at least 0 and below `radius`"));
        }
        let area = 0.5 * turn * (radius * radius - inner * inner);
        let center = DVec3::Z * height;
        let is_whole = turn == TAU && inner == 0.0;
        let has_coordinates = needs.looks.is_textured || needs.looks.is_bent;
        if is_whole && !has_coordinates && !needs.as_mesh && is_uniform(&record.maps[0]) {
            let normal = if is_flipped(record) { DVec3::NEG_Z } else { DVec3::Z };
            let entry = ShapeEntry::Disk(entity.possible(disk::Keys::of(center, normal, radius, &entity.spot.place()))?);
            return Ok(Geometry { entry, map: DAffine3::IDENTITY, areas: vec![area] });
        }
        let part = self.part(record, needs, is_whole, &format!("{turn} {}", inner / radius));
        let place = |u: f64, v: f64| {
            let (sine, cosine) = (turn * u).sin_cos();
            let across = 1.0 - v * (1.0 - inner / radius);
            (DVec3::new(across * cosine, across * sine, 0.0), DVec3::Z)
        };
        let map = DAffine3::from_translation(center) * DAffine3::from_scale(DVec3::splat(radius));
        self.round_mesh(record, part, map, area, || {
            let mut mesh = sheet(columns(turn), 1, place);
            mesh.normals.clear();
            mesh.smooth = false;
            mesh
        })
    }

    pub(super) fn cylinder(&mut self, record: &ShapeRecord, needs: Needs) -> Result<Geometry, SceneError> {
        let entity = &record.entity;
        let radius = positive(entity, "radius", 1.0)?;
        let [low, high] = ordered(entity, ["zmin", "zmax"], [-1.0, 1.0])?;
        let turn = turn_of(entity)?;
        let area = turn * radius * (high - low);
        let is_whole = turn == TAU;
        if is_whole && self.stays_round(record, needs) {
            let ends = [low, high].map(|z| DVec3::Z * z);
            let keys = cylinder::Keys::of(ends[0], ends[1], radius, &entity.spot.place());
            let entry = ShapeEntry::Cylinder(entity.possible(keys)?);
            // Texture coordinates go round from x towards y there, and from x away from y here.
            let scale = if needs.looks.is_textured { DVec3::new(1.0, -1.0, 1.0) } else { DVec3::ONE };
            return Ok(Geometry { entry, map: DAffine3::from_scale(scale), areas: vec![area] });
        }
        let part = self.part(record, needs, is_whole, &format!("{turn}"));
        let place = |u: f64, v: f64| {
            let (sine, cosine) = (turn * u).sin_cos();
            (DVec3::new(cosine, sine, v), DVec3::new(cosine, sine, 0.0))
        };
        let map = DAffine3::from_translation(DVec3::Z * low) * DAffine3::from_scale(DVec3::new(radius, radius, high - low));
        self.round_mesh(record, part, map, area, || sheet(columns(turn), 1, place))
    }

    /// True where a whole sphere or cylinder can be one.
    fn stays_round(&self, record: &ShapeRecord, needs: Needs) -> bool {
        let is_turned = needs.flips && is_flipped(record);
        !is_turned && !needs.looks.is_bent && !needs.as_mesh && record.maps.iter().all(is_uniform)
    }

    fn part(&self, record: &ShapeRecord, needs: Needs, is_whole: bool, form: &str) -> Part {
        let name = &record.entity.name;
        let flips = is_flipped(record);
        let why = if !is_whole {
            "in part"
        } else if !record.maps.iter().all(is_uniform) {
            "scaled unevenly"
        } else if needs.looks.is_bent {
            "with a map of normals or heights"
        } else if needs.as_mesh {
            "of an object with many instances"
        } else if name == "disk" {
            "with a texture"
        } else {
            "turned inside out"
        };
        Part { key: format!("({name}) {flips} {form}"), what: format!("Shape `{name}` {why}") }
    }

    /// A round shape of triangles that is made once.
    fn round_mesh(
        &mut self,
        record: &ShapeRecord,
        part: Part,
        map: DAffine3,
        area: f64,
        make: impl FnOnce() -> Mesh,
    ) -> Result<Geometry, SceneError> {
        let mesh = match self.meshes.get(&part.key) {
            Some(known) => known.clone(),
            None => {
                let mut mesh = make();
                if is_flipped(record) {
                    turn_inside_out(&mut mesh);
                }
                self.meshes.entry(part.key).or_insert(Arc::new(mesh)).clone()
            }
        };
        let spot = &record.entity.spot;
        let smooth = if mesh.smooth { " with interpolated normals" } else { "" };
        self.approximate(spot, part.what, format!("{} triangles{smooth}", mesh.faces.len()));
        let geometry = self.placed_mesh(record, mesh)?;
        // pbrt has one shape, whatever triangles it is made of here.
        Ok(Geometry { map, areas: vec![area], ..geometry })
    }
}

fn columns(turn: f64) -> u32 {
    (COLUMNS * turn / TAU).ceil().max(1.0) as u32
}

fn positive(entity: &Entity, name: &str, default: f64) -> Result<f64, SceneError> {
    let number = entity.float_or(name, default)?;
    if number > 0.0 { Ok(number) } else { Err(entity.spot_of(name).error(format!("`{name}` is above 0, and not {number}"))) }
}

/// Two heights, the lower one first.
fn ordered(entity: &Entity, names: [&str; 2], defaults: [f64; 2]) -> Result<[f64; 2], SceneError> {
    let (a, b) = (entity.float_or(names[0], defaults[0])?, entity.float_or(names[1], defaults[1])?);
    if a == b {
        return Err(entity.error(format!("{} has no height: `{}` is `{}`", entity.title(), names[0], names[1])));
    }
    Ok([a.min(b), a.max(b)])
}

/// The angle up to which a shape goes round.
fn turn_of(entity: &Entity) -> Result<f64, SceneError> {
    let degrees = entity.float_or("phimax", 360.0)?;
    if degrees > 0.0 {
        return Ok(if degrees >= 360.0 { TAU } else { degrees.to_radians() });
    }
    Err(entity.spot_of("phimax").error(format!("`phimax` is above 0 degrees, and not {degrees}")))
}
