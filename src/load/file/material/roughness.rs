//! The width of a distribution of microfacets, by whichever of two keys is written.

use crate::load::error::SceneError;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Fraction, Located, Scalar};
use crate::scene::ColorInput;

type Key<'a> = Option<&'a Located<Scalar<Fraction>>>;

/// The GGX width from `alpha`, or from `roughness`, whose square it is. None where neither is written.
pub fn ggx_alpha(alpha: Key<'_>, roughness: Key<'_>, resolver: &Resolver<'_>) -> Result<Option<ColorInput>, SceneError> {
    match (alpha, roughness) {
        (Some(_), Some(roughness)) => Err(resolver.error(&roughness.span, "either `alpha` or `roughness`")),
        (Some(alpha), None) => resolver.scalar(&alpha.value).map(Some),
        (None, Some(roughness)) => Ok(Some(resolver.scalar(&roughness.value)?.squared())),
        (None, None) => Ok(None),
    }
}
