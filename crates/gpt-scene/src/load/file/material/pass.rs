//! `type = "pass"`

use super::keys::{CommonKeys, MaterialKeys, material_keys, only_for_reflecting};
use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::writer::Writer;
use crate::scene::{Emission, MaterialKind};

material_keys! {
    /// The ray goes on as if nothing were there.
    #[schemars(extend("not" = { "anyOf": [{ "required": ["emission"] }, { "required": ["two_sided"] }] }))]
    {}
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[""];

    fn kind(&self, _resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        Ok(MaterialKind::Pass)
    }

    fn two_sided(&self, common: &CommonKeys<'_>, resolver: &Resolver<'_>) -> Result<bool, SceneError> {
        match common.two_sided {
            Some(two_sided) => {
                Err(resolver.error(&two_sided.place, "`pass` is the same on both sides: it has no key `two_sided`"))
            }
            None => Ok(true),
        }
    }

    fn emission(&self, common: &CommonKeys<'_>, resolver: &Resolver<'_>) -> Result<Option<Emission>, SceneError> {
        match (common.emission, common.emission_two_sided) {
            (Some(emission), _) => Err(only_for_reflecting(emission, resolver)),
            (None, Some(two_sided)) => Err(resolver.error(&two_sided.place, "`emission_two_sided` needs the key `emission`")),
            (None, None) => Ok(None),
        }
    }

    /// No keys of its own.
    fn write(_kind: &MaterialKind, _writer: &Writer<'_>) -> String {
        String::new()
    }
}
