//! `type = "environment"`

use std::sync::Arc;

use glam::{DMat3, DVec3};
use schemars::JsonSchema;
use serde::Deserialize;

use super::daylight::{DaylightKeys, sun_of};
use super::keys::LightKeys;
use crate::load::environment_map;
use crate::load::error::SceneError;
use crate::load::file::colour::Rgb;
use crate::load::file::keyframes::{EnvironmentKeyEntry, InterpolationName, WrittenLightTrack};
use crate::load::file::light_group::LightGroupName;
use crate::load::file::light_link::ReceiverNames;
use crate::load::file::reference::FileOr;
use crate::load::file::resolver::Resolver;
use crate::load::file::shape::TransformEntry;
use crate::load::file::value::{Checked, LARGEST, Located, NonNegative, Number};
use crate::load::file::writer::{Writer, colour, line, number, numbers, table};
use crate::load::image_file::EmbeddedFile;
use crate::load::place::Place;
use crate::picture_file::Envelope;
use crate::scene::animation::LightTrack;
use crate::scene::light::is_rotation;
use crate::scene::{DirectionalLight, Environment, EnvironmentRadiance, ImageData, ImageSource, MapRows};

/// Radiance from outside the scene: either `radiance`, `file` or `daylight`.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "EnvironmentLight")]
#[schemars(extend("allOf" = [{ "oneOf": [{ "required": ["radiance"] }, { "required": ["file"] }, { "required": ["daylight"] }] }], "dependentRequired" = { "interpolation": ["keyframes"] }))]
pub struct Keys {
    /// Radiance that is equal in all directions.
    pub radiance: Option<Located<Rgb<NonNegative>>>,
    /// A lat-long map, EXR or HDR: u = atan2(x, −z)/2π (mod 1), v = acos(y)/π from the top row, interpolated bilinearly.
    pub file: Option<Located<FileOr<EmbeddedFile>>>,
    /// A clear sky with its sun.
    pub daylight: Option<Located<DaylightKeys>>,
    /// Factor of the radiance, 1 when left out.
    pub scale: Option<Located<Checked<NonNegative>>>,
    /// Degrees about +Y, counter-clockwise seen from above.
    pub rotate: Option<Number>,
    /// Turns the map about any axis, after `rotate`: steps with `rotate` and `degrees`, or a matrix that is a rotation.
    pub transform: Option<Located<TransformEntry>>,
    /// Exchanges the map's left and right before it is turned; false when left out.
    pub mirror: Option<Located<bool>>,
    /// Position of the first and the last row of the map: half a row from the poles when left out.
    pub rows: Option<Rows>,
    /// Values at frames (`--frame`, `--frames`, `--time`); without a frame the other keys hold.
    #[schemars(extend("minItems" = 1))]
    pub keyframes: Option<Located<Vec<Located<EnvironmentKeyEntry>>>>,
    /// How keyframes lead from one to the next; "linear" when left out.
    pub interpolation: Option<Located<InterpolationName>>,
    /// The light group in which `--aov groups` keeps its light apart; "rest" when left out.
    pub light_group: Option<Located<LightGroupName>>,
    /// The receivers that the light lights, by the names that objects give them (`receiver`); all when left out.
    pub lights_only: Option<ReceiverNames>,
    /// In place of `lights_only`: the receivers that the light does not light.
    pub lights_all_but: Option<ReceiverNames>,
}

#[derive(Debug, Clone, Copy, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rows {
    /// Half a row from the poles: each row covers as much of the angle.
    Inside,
    /// On the poles, as in Mitsuba.
    ToPoles,
}

impl LightKeys for Keys {
    type Light = Environment;

    const EXAMPLES: &'static [&'static str] = &[
        "radiance = [0.2, 0.5, 1]",
        "daylight = { to_sun = [1, 1.5, -0.6], turbidity = 4 }\nrotate = 70",
        "file = \"map.exr\"\nscale = 1.5\nrotate = 40",
        "file = \"map.exr\"\nrows = \"to_poles\"\nmirror = true",
        "file = \"map.exr\"\nrotate = 20\ntransform = [{ rotate = [1, 0, 0], degrees = 90 }, { rotate = [1, 2, -0.5], degrees = 35 }]",
    ];
    const STRENGTH: &'static str = "radiance";

    fn resolve(&self, resolver: &mut Resolver<'_>, span: &Place) -> Result<Environment, SceneError> {
        let scale = self.scale.as_ref().map_or(1.0, |scale| scale.value.0);
        let rotation_degrees = self.rotate.map_or(0.0, |rotate| rotate.0);
        let mirrored = self.mirror.as_ref().is_some_and(|mirror| mirror.value);
        let turn = self.transform.as_ref().map(|written| turn(resolver, written)).transpose()?;
        let radiance = match (&self.radiance, &self.file, &self.daylight) {
            (None, None, Some(keys)) => {
                let daylight = keys.value.daylight(resolver, &keys.place)?;
                let map = keys.place.at(FileOr::InMemory(daylight.map(keys.value.has_sun()).into()));
                return Ok(Environment { turn, ..self.map(resolver, &map, (scale, rotation_degrees, mirrored))? });
            }
            (Some(radiance), None, None) => EnvironmentRadiance::Constant(radiance.value.0 * scale),
            (None, Some(file), None) => {
                return Ok(Environment { turn, ..self.map(resolver, file, (scale, rotation_degrees, mirrored))? });
            }
            (None, None, None) => {
                return Err(resolver.error(span, "an environment needs the key `radiance`, `file` or `daylight`"));
            }
            (radiance, ..) => {
                let place = radiance.as_ref().map_or(span, |radiance| &radiance.place);
                return Err(resolver.error(place, "an environment has either `radiance`, `file` or `daylight`"));
            }
        };
        Ok(Environment { radiance, rotation_degrees, turn, rows: self.rows.map_or(MapRows::Inside, MapRows::from), mirrored })
    }

    fn track(&self, resolver: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        let keyframes = self.keyframes.as_ref();
        if let (Some(keyframes), Some(_)) = (keyframes, &self.daylight) {
            return Err(resolver.error(&keyframes.place, "an environment with `daylight` has no `keyframes`"));
        }
        let mut of_keys = keyframes.iter().flat_map(|keys| &keys.value).filter_map(|entry| entry.value.radiance.as_ref());
        if let Some(radiance) = of_keys.next().filter(|_| self.radiance.is_none()) {
            return Err(resolver.error(&radiance.place, "only keyframes of an environment with `radiance` state `radiance`"));
        }
        let interpolation = self.interpolation.as_ref();
        let mut track = resolver.light_track(WrittenLightTrack { keyframes, interpolation, node: None })?;
        let scale = self.scale.as_ref().map_or(1.0, |scale| scale.value.0);
        track.iter_mut().flat_map(|track| &mut track.strength.keys).for_each(|key| key.value *= scale);
        Ok(track)
    }

    fn write(environment: &Environment, writer: &mut Writer<'_>) -> String {
        let mut out = match &environment.radiance {
            EnvironmentRadiance::Constant(radiance) => line("radiance", &colour(*radiance)),
            EnvironmentRadiance::Map(image) => {
                let (file, _, scale) = writer.image(image);
                let scale = if scale == 1.0 { String::new() } else { line("scale", &number(scale)) };
                line("file", &file) + &scale
            }
        };
        if environment.rotation_degrees != 0.0 {
            out += &line("rotate", &number(environment.rotation_degrees));
        }
        if let Some(turn) = environment.turn {
            let row = |row: usize| turn.row(row).extend(0.0).to_array();
            let rows = [row(0), row(1), row(2), [0.0, 0.0, 0.0, 1.0]].concat();
            out += &line("transform", &table([("matrix", numbers(&rows))]));
        }
        if environment.rows == MapRows::ToPoles {
            out += &line("rows", "\"to_poles\"");
        }
        if environment.mirrored {
            out += &line("mirror", "true");
        }
        out
    }
}

/// The rotation that a transform is.
fn turn(resolver: &Resolver<'_>, written: &Located<TransformEntry>) -> Result<DMat3, SceneError> {
    let map = resolver.transform(written)?.to_affine();
    if map.translation == DVec3::ZERO && is_rotation(&map.matrix3) {
        return Ok(map.matrix3);
    }
    Err(resolver
        .error(&written.place, "the `transform` of an environment only turns it: it has no scale, no translation and no mirror")
        .with_help("`scale` changes the radiance, and `mirror = true` exchanges the map's left and right"))
}

impl From<Rows> for MapRows {
    fn from(rows: Rows) -> Self {
        match rows {
            Rows::Inside => Self::Inside,
            Rows::ToPoles => Self::ToPoles,
        }
    }
}

impl Keys {
    /// An environment whose radiance is equal in all directions.
    pub fn constant(radiance: Located<Rgb<NonNegative>>) -> Self {
        Self {
            radiance: Some(radiance),
            file: None,
            daylight: None,
            scale: None,
            rotate: None,
            transform: None,
            mirror: None,
            rows: None,
            keyframes: None,
            interpolation: None,
            light_group: None,
            lights_only: None,
            lights_all_but: None,
        }
    }

    /// The sun of `daylight`, turned as the sky is.
    pub(super) fn sun(&self, resolver: &Resolver<'_>, environment: &Environment) -> Option<DirectionalLight> {
        let keys = self.daylight.as_ref().filter(|keys| keys.value.has_sun())?;
        let daylight = keys.value.daylight(resolver, &keys.place).ok()?;
        Some(sun_of(&daylight, environment, self.scale.as_ref().map_or(1.0, |scale| scale.value.0)))
    }

    fn map(
        &self,
        resolver: &mut Resolver<'_>,
        file: &Located<FileOr<EmbeddedFile>>,
        (scale, rotation_degrees, mirrored): (f64, f64, bool),
    ) -> Result<Environment, SceneError> {
        let (image, integer_bits) = resolver.image_and_bits(file, None)?;
        let source = resolver.picture_source(&file.value);
        let hints = resolver.hints(&source, None);
        for note in environment_map::notes(integer_bits, &hints) {
            resolver.scene.warnings.push(format!("{source}: {note}"));
        }
        // Whoever says where rows lie does not ask the file.
        let asks = self.rows.is_none() || hints.envelope == Some(Envelope::Cube);
        let converted = if asks { environment_map::converted(&image, &hints) } else { Ok(None) };
        let converted = converted.map_err(|reason| resolver.error(&file.place, format!("{source}: {reason}")))?;
        let (image, rows, turned) = match converted {
            Some(map) => (Arc::new(map.image), map.rows, map.rotation_degrees),
            None => (image, self.rows.map_or(MapRows::Inside, MapRows::from), 0.0),
        };
        // A mirror turns the other way what lies behind it.
        let rotation_degrees = rotation_degrees + if mirrored { -turned } else { turned };
        if scale == 1.0 && !mirrored {
            return Ok(Environment { radiance: EnvironmentRadiance::Map(image), rotation_degrees, turn: None, rows, mirrored });
        }
        let mut texels: Vec<_> = image.texels.colors().map(|texel| texel * scale as f32).collect();
        if mirrored {
            texels.chunks_mut(image.width as usize).for_each(|row| row.reverse());
        }
        if let Some(written) = &self.scale
            && texels.iter().any(|texel| texel.max_element() > LARGEST as f32)
        {
            let message = format!("the map's radiance times {scale} is too large: more than 1e18");
            return Err(resolver.error(&written.place, message));
        }
        let scaled =
            Arc::new(ImageData { texels: texels.into(), width: image.width, height: image.height, has_alpha: image.has_alpha });
        if let Some(source) = resolver.scene.sources.image(&image).cloned() {
            resolver.scene.sources.add_image(&scaled, ImageSource { scale, ..source });
        }
        Ok(Environment { radiance: EnvironmentRadiance::Map(scaled), rotation_degrees, turn: None, rows, mirrored })
    }
}
