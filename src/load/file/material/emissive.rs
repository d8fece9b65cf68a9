//! `type = "emissive"`

use super::keys::{CommonKeys, MaterialKeys, emission_of, material_keys, only_for_reflecting};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Colour, NonNegative};
use crate::scene::{Emission, MaterialKind};

material_keys! {
    /// Emits and reflects nothing.
    {
        radiance: Colour<NonNegative>,
        /// Emission leaves the front only, unless this is true.
        two_sided: Option<bool>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &["radiance = [8, 7, 6]"];

    fn kind(&self, _resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Emissive)
    }

    fn emission(&self, common: &CommonKeys<'_>, resolver: &Resolver<'_>) -> Result<Option<Emission>, SceneError> {
        match common.emission {
            Some(emission) => Err(only_for_reflecting(emission, resolver)),
            None => Ok(emission_of(resolver.colour(&self.radiance)?, self.two_sided.unwrap_or(false))),
        }
    }
}
