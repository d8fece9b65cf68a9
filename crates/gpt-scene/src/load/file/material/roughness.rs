//! The microfacets of a surface: how wide they are spread, by whichever of the keys for it are written, and how.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::error::SceneError;
use crate::load::file::colour::Scalar;
use crate::load::file::reference::NamesTextures;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{Fraction, Located};
use crate::load::file::writer::{Writer, colour, line};
use crate::load::place::Place;
use crate::scene::{ColorInput, Masking, MicrofacetDistribution, Microfacets};

type Key<'a> = Option<&'a Located<Scalar<Fraction>>>;

/// The GGX width from `alpha`, or from `roughness`, whose square it is. None where neither is written.
pub fn ggx_alpha(alpha: Key<'_>, roughness: Key<'_>, resolver: &Resolver<'_>) -> Result<Option<ColorInput>, SceneError> {
    match (alpha, roughness) {
        (Some(_), Some(roughness)) => Err(resolver.error(&roughness.place, "either `alpha` or `roughness`")),
        (Some(alpha), None) => resolver.scalar(&alpha.value).map(Some),
        (None, Some(roughness)) => Ok(Some(resolver.scalar(&roughness.value)?.squared())),
        (None, None) => Ok(None),
    }
}

/// Slopes of microfacets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DistributionEntry {
    /// Long tails: a halo around highlights.
    Ggx,
    /// Normally distributed slopes.
    Beckmann,
}

impl NamesTextures for DistributionEntry {}
impl NamesTextures for MaskingEntry {}

impl From<DistributionEntry> for MicrofacetDistribution {
    fn from(entry: DistributionEntry) -> Self {
        match entry {
            DistributionEntry::Ggx => Self::Ggx,
            DistributionEntry::Beckmann => Self::Beckmann,
        }
    }
}

/// How the visibility of microfacets from two directions goes together.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MaskingEntry {
    /// High points of the surface are seen from both directions.
    HeightCorrelated,
    /// One has nothing to do with the other, as in Mitsuba and in glTF's model.
    Separable,
}

impl From<MaskingEntry> for Masking {
    fn from(entry: MaskingEntry) -> Self {
        match entry {
            MaskingEntry::HeightCorrelated => Self::HeightCorrelated,
            MaskingEntry::Separable => Self::Separable,
        }
    }
}

/// All keys of a surface's microfacets.
pub struct FacetKeys<'a> {
    pub alpha: Key<'a>,
    pub roughness: Key<'a>,
    /// Along and across the direction in which texture coordinate u grows.
    pub alphas: [Key<'a>; 2],
    pub roughnesses: [Key<'a>; 2],
    pub distribution: Option<&'a Located<DistributionEntry>>,
    pub masking: Option<&'a Located<MaskingEntry>>,
}

impl FacetKeys<'_> {
    /// None where no width is written.
    pub fn resolve(&self, resolver: &Resolver<'_>) -> Result<Option<Microfacets>, SceneError> {
        let pair = self.pair(resolver)?;
        let single = self.alpha.or(self.roughness);
        if let (Some(single), Some(_)) = (single, &pair) {
            let message = "one width, or two: either `alpha` or `roughness`, or both of `alpha_u` and `alpha_v` or of `roughness_u` and `roughness_v`";
            return Err(resolver.error(&single.place, message));
        }
        let widths = match pair {
            // Equal ones have no direction.
            Some([along, across]) => Some((along, Some(across).filter(|across| *across != along))),
            None => ggx_alpha(self.alpha, self.roughness, resolver)?.map(|alpha| (alpha, None)),
        };
        let Some((alpha, alpha_v)) = widths else {
            let unused = self.distribution.map(|key| ("distribution", &key.place));
            return match unused.or(self.masking.map(|key| ("masking", &key.place))) {
                Some((name, span)) => {
                    Err(resolver.error(span, format!("`{name}` is for rough surfaces: it needs `alpha` or `roughness`")))
                }
                None => Ok(None),
            };
        };
        Ok(Some(Microfacets {
            alpha_v,
            distribution: self.distribution.map_or(MicrofacetDistribution::Ggx, |key| key.value.into()),
            masking: self.masking.map_or(Masking::HeightCorrelated, |key| key.value.into()),
            ..Microfacets::ggx(alpha)
        }))
    }

    /// Both widths, by either of the names for them.
    fn pair(&self, resolver: &Resolver<'_>) -> Result<Option<[ColorInput; 2]>, SceneError> {
        let [alphas, roughnesses] = [self.alphas, self.roughnesses];
        let is_written = |keys: [Key<'_>; 2]| keys.iter().any(Option::is_some);
        if is_written(alphas) && is_written(roughnesses) {
            let span = roughnesses.into_iter().flatten().next().map_or_else(Place::default, |key| key.place.clone());
            return Err(resolver.error(&span, "either `alpha_u` and `alpha_v` or `roughness_u` and `roughness_v`"));
        }
        for (keys, [u, v]) in [(alphas, ["alpha_u", "alpha_v"]), (roughnesses, ["roughness_u", "roughness_v"])] {
            match keys {
                [Some(key), None] => return Err(resolver.error(&key.place, format!("`{u}` needs `{v}`"))),
                [None, Some(key)] => return Err(resolver.error(&key.place, format!("`{v}` needs `{u}`"))),
                _ => {}
            }
        }
        if let [Some(along), Some(across)] = alphas {
            return Ok(Some([resolver.scalar(&along.value)?, resolver.scalar(&across.value)?]));
        }
        match roughnesses {
            [Some(along), Some(across)] => {
                let squared = |key| Ok(ggx_alpha(None, Some(key), resolver)?.unwrap_or(ColorInput::grey(0.0)));
                Ok(Some([squared(along)?, squared(across)?]))
            }
            _ => Ok(None),
        }
    }
}

/// Widths, distribution and masking of microfacets as a scene file has them, or the exponent of Phong's distribution.
pub fn write_facets(facets: &Microfacets, writer: &Writer<'_>) -> String {
    let Microfacets { alpha, alpha_v, distribution, masking } = *facets;
    if distribution == MicrofacetDistribution::Phong {
        return writer.input("exponent", &alpha);
    }
    let widths = match alpha_v {
        None => write_alpha(alpha, writer),
        Some(across) if alpha.is_squared() || across.is_squared() => {
            line("roughness_u", &write_root(alpha, writer)) + &line("roughness_v", &write_root(across, writer))
        }
        Some(across) => writer.input("alpha_u", &alpha) + &writer.input("alpha_v", &across),
    };
    widths + &write_distribution(distribution) + &write_masking(masking)
}

/// A width of microfacets: the square of a texture is what `roughness` means.
fn write_alpha(alpha: ColorInput, writer: &Writer<'_>) -> String {
    match alpha {
        ColorInput::SquaredTexture(id) => writer.input("roughness", &ColorInput::Texture(id)),
        ColorInput::Channel(input) if input.is_squared => writer.input("roughness", &alpha),
        other => writer.input("alpha", &other),
    }
}

/// The root of a width.
fn write_root(alpha: ColorInput, writer: &Writer<'_>) -> String {
    match alpha {
        ColorInput::Constant(value) => colour(value.map(f64::sqrt)),
        other => writer.value_of(other),
    }
}

/// Nothing where it is what is meant without the key.
pub fn write_distribution(distribution: MicrofacetDistribution) -> String {
    match distribution {
        MicrofacetDistribution::Beckmann => line("distribution", "\"beckmann\""),
        MicrofacetDistribution::Ggx | MicrofacetDistribution::Phong => String::new(),
    }
}

/// Name of the masking in a scene file.
pub fn write_masking(masking: Masking) -> String {
    match masking {
        Masking::Separable => line("masking", "\"separable\""),
        Masking::HeightCorrelated => String::new(),
    }
}
