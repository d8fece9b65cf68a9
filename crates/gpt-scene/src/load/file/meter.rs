//! `[[meter]]`: places where `gpt measure` measures light.

use glam::{DAffine3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::resolver::Resolver;
use super::value::{Checked, Exactly, Located, NonNegative, Positive, Vector, vector};
use super::writer::{self, Writer, line, text};
use crate::load::error::SceneError;
use crate::load::place::Place;
use crate::scene::{Meter, MeterKind};

/// A place where `gpt measure` measures light. The picture does not change by it.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(rename = "key:type", rename_all = "snake_case")]
#[schemars(tag = "type", rename = "MeterEntry")]
pub enum MeterEntry {
    Irradiance(IrradianceKeys),
    Radiance(RadianceKeys),
    Distant(DistantKeys),
}

/// Light from the hemisphere about a normal, in W·m⁻²: at a point, or on average over a disk, a rectangle, or the outside of a sphere.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "IrradianceMeter", extend("oneOf" = [
    { "required": ["position", "normal"], "not": { "anyOf": [
        { "required": ["corner"] }, { "required": ["edge_u"] }, { "required": ["edge_v"] }, { "required": ["center"] }, { "required": ["radius"] },
    ] } },
    { "required": ["corner", "edge_u", "edge_v"], "not": { "anyOf": [
        { "required": ["position"] }, { "required": ["normal"] }, { "required": ["center"] }, { "required": ["radius"] },
    ] } },
    { "required": ["center", "radius"], "not": { "anyOf": [
        { "required": ["position"] }, { "required": ["corner"] }, { "required": ["edge_u"] }, { "required": ["edge_v"] },
    ] } },
]))]
pub struct IrradianceKeys {
    pub name: Located<String>,
    /// The point.
    pub position: Option<Vector>,
    /// Which way the point or the disk faces, of any length.
    pub normal: Option<Located<Vector>>,
    /// A corner of a rectangle.
    pub corner: Option<Vector>,
    /// Its edges, with a right angle between them. It faces where u × v points.
    pub edge_u: Option<Vector>,
    pub edge_v: Option<Located<Vector>>,
    /// The middle of a disk, which has a `normal`, or of a sphere.
    pub center: Option<Vector>,
    pub radius: Option<Checked<Positive>>,
    /// A `[[medium]]` that the meter is within; that of the camera when left out.
    pub medium: Option<Located<String>>,
}

/// Light along one ray, in W·m⁻²·sr⁻¹.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "RadianceMeter")]
pub struct RadianceKeys {
    pub name: Located<String>,
    pub position: Vector,
    /// The direction in which the meter looks, of any length.
    pub direction: Located<Vector>,
    /// A `[[medium]]` that the meter is within; that of the camera when left out.
    pub medium: Option<Located<String>>,
}

/// Light that leaves the scene along parallel rays, in W·m⁻²·sr⁻¹, on average over a square window.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "DistantMeter")]
pub struct DistantKeys {
    pub name: Located<String>,
    /// The direction in which the meter looks, from outside the scene, of any length.
    pub direction: Located<Vector>,
    /// The point in the middle of the window; [0, 0, 0] when left out.
    pub target: Option<Vector>,
    /// Width and height of the window; 0 when left out, which is one ray.
    pub size: Option<Checked<NonNegative>>,
}

impl MeterEntry {
    pub fn name_mut(&mut self) -> &mut Located<String> {
        match self {
            Self::Irradiance(keys) => &mut keys.name,
            Self::Radiance(keys) => &mut keys.name,
            Self::Distant(keys) => &mut keys.name,
        }
    }

    /// The name of the medium around it.
    pub fn medium_mut(&mut self) -> Option<&mut Option<Located<String>>> {
        match self {
            Self::Irradiance(keys) => Some(&mut keys.medium),
            Self::Radiance(keys) => Some(&mut keys.medium),
            Self::Distant(_) => None,
        }
    }

    /// Moves it with the scene that it is in.
    ///
    /// # Errors
    /// A sentence about a number that is out of range.
    pub fn transform_by(&mut self, map: &DAffine3) -> Result<(), String> {
        let point = |at: &mut Vector| Exactly::of(map.transform_point3(vector(*at)).to_array()).map(|moved| *at = moved);
        let edge = |along: &mut Vector| Exactly::of(map.transform_vector3(vector(*along)).to_array()).map(|moved| *along = moved);
        let normals = map.matrix3.inverse().transpose();
        let normal = |along: &mut Vector| Exactly::of((normals * vector(*along)).to_array()).map(|turned| *along = turned);
        match self {
            Self::Irradiance(keys) => {
                [&mut keys.position, &mut keys.corner, &mut keys.center].into_iter().flatten().try_for_each(point)?;
                let scale = map.matrix3.determinant().abs().cbrt();
                keys.radius = keys.radius.map(|radius| Checked::of(radius.0 * scale)).transpose()?;
                keys.normal.iter_mut().try_for_each(|turned| normal(&mut turned.value))?;
                keys.edge_u.iter_mut().chain(keys.edge_v.iter_mut().map(|located| &mut located.value)).try_for_each(edge)
            }
            Self::Radiance(keys) => {
                point(&mut keys.position)?;
                edge(&mut keys.direction.value)
            }
            Self::Distant(keys) => {
                // Left out, the target is the point (0, 0, 0) of its own scene.
                let target = keys.target.get_or_insert(Exactly::of([0.0; 3])?);
                point(target)?;
                edge(&mut keys.direction.value)?;
                let scale = map.matrix3.determinant().abs().cbrt();
                keys.size = keys.size.map(|size| Checked::of(size.0 * scale)).transpose()?;
                Ok(())
            }
        }
    }
}

impl Resolver<'_> {
    pub(super) fn meters(&mut self, written: &[Located<MeterEntry>]) {
        for entry in written {
            let meter = self.meter(entry);
            let meter = self.note(meter);
            self.scene.meters.extend(meter);
        }
    }

    fn meter(&self, entry: &Located<MeterEntry>) -> Result<Meter, SceneError> {
        let (name, kind, medium) = match &entry.value {
            MeterEntry::Irradiance(keys) => (&keys.name, self.irradiance(keys, &entry.place)?, &keys.medium),
            MeterEntry::Radiance(keys) => {
                let direction = self.unit(&keys.direction, "direction")?;
                (&keys.name, MeterKind::Radiance { position: vector(keys.position), direction }, &keys.medium)
            }
            MeterEntry::Distant(keys) => {
                let direction = self.unit(&keys.direction, "direction")?;
                let (target, size) = (keys.target.map_or(DVec3::ZERO, vector), keys.size.map_or(0.0, |size| size.0));
                (&keys.name, MeterKind::Distant { direction, target, size }, &None)
            }
        };
        if self.scene.meters.iter().any(|other| other.name == name.value) {
            return Err(self.error(&name.place, format!("there are two meters named `{}`", name.value)));
        }
        let medium = medium.as_ref().map(|name| self.medium_id(name)).transpose()?;
        Ok(Meter { name: name.value.clone(), kind, medium })
    }

    fn irradiance(&self, keys: &IrradianceKeys, place: &Place) -> Result<MeterKind, SceneError> {
        let IrradianceKeys { position, normal, corner, edge_u, edge_v, center, radius, .. } = keys;
        match (position, normal, corner, edge_u, edge_v, center, radius) {
            (&Some(position), Some(normal), None, None, None, None, None) => {
                Ok(MeterKind::Irradiance { position: vector(position), normal: self.unit(normal, "normal")? })
            }
            (None, None, &Some(corner), &Some(edge_u), Some(edge_v), None, None) => {
                let (corner, edge_u, v) = (vector(corner), vector(edge_u), vector(edge_v.value));
                let is_right = edge_u.length() > 0.0 && v.length() > 0.0 && edge_u.normalize().dot(v.normalize()).abs() < 1e-6;
                if !is_right {
                    return Err(self.error(&edge_v.place, "the edges of a meter's rectangle have a right angle between them"));
                }
                Ok(MeterKind::IrradianceOfRectangle { corner, edge_u, edge_v: v })
            }
            (None, Some(normal), None, None, None, &Some(center), Some(radius)) => {
                let normal = self.unit(normal, "normal")?;
                Ok(MeterKind::IrradianceOfDisk { center: vector(center), normal, radius: radius.0 })
            }
            (None, None, None, None, None, &Some(center), Some(radius)) => {
                Ok(MeterKind::IrradianceOfSphere { center: vector(center), radius: radius.0 })
            }
            _ => {
                let message = "a meter of irradiance has `position` and `normal` (a point); `corner`, `edge_u` and `edge_v` (a rectangle); \
                               `center`, `normal` and `radius` (a disk); or `center` and `radius` (a sphere)";
                Err(self.error(place, message))
            }
        }
    }

    fn unit(&self, written: &Located<Vector>, key: &str) -> Result<DVec3, SceneError> {
        let direction = vector(written.value).try_normalize();
        direction.ok_or_else(|| self.error(&written.place, format!("`{key}` is zero, so it points nowhere")))
    }
}

/// A meter's table in a scene file.
pub fn write(meter: &Meter, writer: &Writer<'_>) -> String {
    let vector = |key: &str, value: DVec3| line(key, &writer::vector(value));
    let direction = |key: &str, value: DVec3| line(key, &writer::direction(value));
    let keys = match meter.kind {
        MeterKind::Irradiance { position, normal } => vector("position", position) + &direction("normal", normal),
        MeterKind::IrradianceOfRectangle { corner, edge_u, edge_v } => {
            vector("corner", corner) + &vector("edge_u", edge_u) + &vector("edge_v", edge_v)
        }
        MeterKind::IrradianceOfDisk { center, normal, radius } => {
            vector("center", center) + &direction("normal", normal) + &line("radius", &writer::number(radius))
        }
        MeterKind::IrradianceOfSphere { center, radius } => vector("center", center) + &line("radius", &writer::number(radius)),
        MeterKind::Radiance { position, direction: along } => vector("position", position) + &direction("direction", along),
        MeterKind::Distant { direction: along, target, size } => {
            direction("direction", along) + &vector("target", target) + &line("size", &writer::number(size))
        }
    };
    let medium = meter.medium.map_or_else(String::new, |medium| line("medium", &writer.media.quoted(medium)));
    format!("\n[[meter]]\n{}{}{keys}{medium}", line("name", &text(&meter.name)), line("type", &text(meter.kind.name())))
}
