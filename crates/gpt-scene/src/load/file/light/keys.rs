//! The contract of every type of light.

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::writer::Writer;
use crate::load::place::Place;
use crate::scene::animation::LightTrack;

/// Meaning of a light's keys.
pub trait LightKeys {
    /// The light in the scene.
    type Light;

    /// Tables without their `type`, which tests render. Each lights the origin; a picture that one names is the lat-long map `map.exr`.
    const EXAMPLES: &'static [&'static str];

    /// The key of its strength, which keyframes change.
    const STRENGTH: &'static str;

    /// The light; `span` is its whole table.
    fn resolve(&self, resolver: &mut Resolver<'_>, span: &Place) -> Result<Self::Light, SceneError>;

    /// Values at frames of the light that becomes the scene's next one; None where they never change.
    fn track(&self, _: &Resolver<'_>) -> Result<Option<LightTrack>, SceneError> {
        Ok(None)
    }

    /// The keys that say a light, a line each.
    fn write(light: &Self::Light, writer: &mut Writer<'_>) -> String;
}
