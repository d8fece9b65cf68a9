//! `type = "emissive"`

use super::keys::{CommonKeys, MaterialKeys, emission_of, material_keys, only_for_reflecting};
use crate::load::error::SceneError;
use crate::load::file::colour::Colour;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Located, NonNegative};
use crate::load::file::writer::Writer;
use crate::scene::{Emission, MaterialKind};

material_keys! {
    own two_sided
    /// Emits and reflects nothing.
    #[schemars(extend("not" = { "required": ["emission"] }))]
    {
        radiance: Colour<NonNegative>,
        /// Emission leaves the front only, unless this is true.
        two_sided: Option<Located<bool>>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["radiance = [8, 7, 6]"];

    fn kind(&self, _resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Emissive)
    }

    /// The key says where light is sent out; nothing is reflected on either side.
    fn two_sided(&self, _common: &CommonKeys<'_>, _resolver: &Resolver<'_>) -> Result<bool, SceneError> {
        Ok(true)
    }

    fn emission(&self, common: &CommonKeys<'_>, resolver: &Resolver<'_>) -> Result<Option<Emission>, SceneError> {
        match (common.emission, common.emission_two_sided) {
            (Some(emission), _) => Err(only_for_reflecting(emission, resolver)),
            (None, Some(two_sided)) => {
                let message = "`emission_two_sided` is for materials that reflect; an emissive one has `two_sided`";
                Err(resolver.error(&two_sided.place, message))
            }
            (None, None) => Ok(emission_of(
                resolver.colour(&self.radiance)?,
                self.two_sided.as_ref().is_some_and(|two_sided| two_sided.value),
            )),
        }
    }

    /// Nothing to write: emission is written as for every material.
    fn write(_kind: &MaterialKind, _writer: &Writer<'_>) -> String {
        String::new()
    }
}
