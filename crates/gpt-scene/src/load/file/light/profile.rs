//! `profile` of a light: a photometric file, or its table.

use std::borrow::Cow;
use std::fmt;
use std::sync::Arc;

use glam::DVec3;
use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::de::value::MapAccessDeserializer;
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::load::error::{SceneError, show};
use crate::load::file::colour::any_of;
use crate::load::file::reference::FileOr;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Checked, Located, NonNegative, Vector, vector};
use crate::load::file::writer::{Writer, direction, line, list, numbers, table};
use crate::load::image_file::EmbeddedFile;
use crate::load::lm_63::{self, MOST_PROFILE_BYTES, Photometry};
use crate::load::model::Substitute;
use crate::scene::light::{AimedProfile, LightProfile, ProfileFault, ProfileList};

/// Least length of what is across of two directions of length 1 that differ.
const LEAST_ACROSS: f64 = 1e-6;

/// How a lamp's light differs from direction to direction.
#[derive(Debug, Clone)]
pub enum ProfileEntry {
    File(FileOr<EmbeddedFile>),
    Table(ProfileTable),
}

/// Candela by direction, interpolated bilinearly in the angles. Past the first and the last vertical angle there is no light.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "LightProfile")]
pub struct ProfileTable {
    /// Degrees from the light's direction, ascending within 0 to 180.
    #[schemars(extend("minItems" = 2))]
    pub vertical: Located<Vec<Checked<NonNegative>>>,
    /// Degrees about the direction, ascending: 0 alone (the same all around, and when left out), from 0 to 90 (four quarters alike), to 180 (two halves alike) or to 360, or from 90 to 270.
    #[schemars(extend("minItems" = 1))]
    pub horizontal: Option<Located<Vec<Checked<NonNegative>>>>,
    /// A list for each horizontal angle, with a number for each vertical one.
    #[schemars(extend("minItems" = 1))]
    pub candela: Located<Vec<Vec<Checked<NonNegative>>>>,
}

impl<'de> Deserialize<'de> for ProfileEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct FormVisitor;
        impl<'de> Visitor<'de> for FormVisitor {
            type Value = ProfileEntry;
            fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
                f.write_str("a photometric file (.ies) or { vertical = [...], candela = [[...]] }")
            }
            fn visit_str<E: Error>(self, path: &str) -> Result<Self::Value, E> {
                Ok(ProfileEntry::File(FileOr::Written(path.to_owned())))
            }
            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                ProfileTable::deserialize(MapAccessDeserializer::new(map)).map(ProfileEntry::Table)
            }
        }
        deserializer.deserialize_any(FormVisitor)
    }
}

impl JsonSchema for ProfileEntry {
    fn schema_name() -> Cow<'static, str> {
        "FileOrLightProfile".into()
    }
    fn inline_schema() -> bool {
        true
    }
    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        any_of(vec![generator.subschema_for::<String>(), generator.subschema_for::<ProfileTable>()])
    }
}

impl Resolver<'_> {
    /// The profile of a light that shines along `nadir`, with horizontal angle 0 on the side that `front` states, or else +X.
    pub(super) fn aimed_profile(
        &mut self,
        written: &Located<ProfileEntry>,
        nadir: DVec3,
        front: Option<&Located<Vector>>,
    ) -> Result<AimedProfile, SceneError> {
        let profile = match &written.value {
            ProfileEntry::File(file) => self.profile_of_file(written, file)?,
            ProfileEntry::Table(table) => Arc::new(self.written_profile(table)?),
        };
        let side = front.map_or(DVec3::X, |front| vector(front.value));
        let is_across = side.try_normalize().is_some_and(|side| side.cross(nadir).length() > LEAST_ACROSS);
        if is_across {
            return Ok(AimedProfile { profile, nadir, front: side });
        }
        if front.is_none() && !profile.varies_around() {
            return Ok(AimedProfile { profile, nadir, front: DVec3::Z });
        }
        let place = front.map_or(&written.place, |front| &front.place);
        let message =
            "`front` is zero or lies along the light's direction, so the side of the profile's horizontal angle 0 is not known";
        Err(self.error(place, message).with_help("`front` is a direction across the light's; [1, 0, 0] when left out"))
    }

    /// Reads a file, once for all lights that name it.
    fn profile_of_file(
        &mut self,
        written: &Located<ProfileEntry>,
        file: &FileOr<EmbeddedFile>,
    ) -> Result<Arc<LightProfile>, SceneError> {
        let source = self.picture_source(file);
        if let Some(profile) = self.profiles.get(&source) {
            return Ok(profile.clone());
        }
        let path = source.name().to_owned();
        let content = match file {
            FileOr::InMemory(content) => content.bytes.to_vec().into(),
            FileOr::Written(_) | FileOr::OnDisk(_) => self
                .files()
                .read(&path, MOST_PROFILE_BYTES)
                .map_err(|error| self.error(&written.place, format!("{}: cannot be read: {error}", show(&path))))?,
        };
        let read = lm_63::read(&content);
        let Photometry { profile, notes } =
            read.map_err(|mistake| SceneError::in_line(show(&path), mistake.line, mistake.message))?;
        for note in notes {
            self.substitute(&path, Substitute { line: Some(note.line), what: note.message })?;
        }
        let profile = Arc::new(profile);
        if !matches!(file, FileOr::InMemory(_)) {
            self.scene.sources.add_profile(&profile, path);
        }
        self.profiles.insert(source, profile.clone());
        Ok(profile)
    }

    fn written_profile(&self, table: &ProfileTable) -> Result<LightProfile, SceneError> {
        let of = |angles: &[Checked<NonNegative>]| angles.iter().map(|angle| angle.0).collect::<Vec<_>>();
        let vertical = of(&table.vertical.value);
        let horizontal = table.horizontal.as_ref().map_or(vec![0.0], |angles| of(&angles.value));
        let planes = &table.candela.value;
        if planes.len() != horizontal.len() || planes.iter().any(|plane| plane.len() != vertical.len()) {
            let message = format!(
                "`candela` has a list for each horizontal angle ({}), each with a number for each vertical one ({})",
                horizontal.len(),
                vertical.len()
            );
            return Err(self.error(&table.candela.place, message));
        }
        let candela = planes.iter().flat_map(|plane| of(plane)).collect();
        LightProfile::new(vertical, horizontal, candela).map_err(|ProfileFault { list, message, .. }| {
            let of_horizontal = table.horizontal.as_ref().map_or(&table.vertical.place, |angles| &angles.place);
            let place = match list {
                ProfileList::Vertical => &table.vertical.place,
                ProfileList::Horizontal => of_horizontal,
                ProfileList::Candela => &table.candela.place,
            };
            self.error(place, message)
        })
    }
}

/// The keys of a profile, a line each, but for the direction.
pub fn write_profile(aimed: &AimedProfile, writer: &mut Writer<'_>) -> String {
    let profile = &aimed.profile;
    let written = match writer.profile_file(profile) {
        Some(file) => file,
        None => {
            let planes = profile.candela().chunks(profile.vertical().len()).map(numbers);
            table([
                ("vertical", numbers(profile.vertical())),
                ("horizontal", numbers(profile.horizontal())),
                ("candela", list(planes)),
            ])
        }
    };
    line("profile", &written) + &line("front", &direction(aimed.front))
}
