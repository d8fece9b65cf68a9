//! `type = "point"`

use std::ops::Range;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{NonNegative, Rgb, Vector, vector};
use crate::scene::PointLight;

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
#[schemars(rename = "PointLight")]
pub struct Keys {
    position: Vector,
    /// W·sr⁻¹
    intensity: Rgb<NonNegative>,
}

impl Keys {
    pub fn resolve(&self, _: &mut Resolver<'_>, _: &Range<usize>) -> Result<PointLight, SceneError> {
        Ok(PointLight { position: vector(self.position), intensity: self.intensity.0 })
    }
}
