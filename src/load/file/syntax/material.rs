//! `[[material]]`

use schemars::JsonSchema;
use serde::Deserialize;

use crate::load::file::value::{
    Checked, Colour, Fraction, IndexOfRefraction, Located, NonNegative, Number, Positive, Rgb, Scalar,
};

/// A material's own keys and those that every material has.
macro_rules! materials {
    ($($(#[$doc:meta])* $variant:ident($name:ident) { $($(#[$field_doc:meta])* $field:ident : $type:ty),* $(,)? })*) => {
        /// What surfaces are made of.
        #[derive(Debug, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        #[schemars(tag = "type")]
        pub enum MaterialEntry { $($variant($name)),* }

        $(
            $(#[$doc])*
            #[derive(Debug, Deserialize, JsonSchema)]
            #[serde(deny_unknown_fields, expecting = "a table")]
            pub struct $name {
                /// What shapes and blends call it.
                pub name: Located<String>,
                $($(#[$field_doc])* pub $field: $type,)*
                /// A texture of tangent-space normals whose color_space is "linear".
                pub normal_map: Option<Located<String>>,
                /// Radiance the surface sends out by itself, besides what it reflects.
                pub emission: Option<Located<Colour<NonNegative>>>,
                /// Emission leaves the front only, unless this is true.
                pub emission_two_sided: Option<Located<bool>>,
            }
        )*

        impl MaterialEntry {
            pub fn common(&self) -> CommonMaterial<'_> {
                match self {
                    $(Self::$variant(material) => CommonMaterial {
                        name: &material.name,
                        normal_map: material.normal_map.as_ref(),
                        emission: material.emission.as_ref(),
                        emission_two_sided: material.emission_two_sided.as_ref(),
                    },)*
                }
            }
        }
    };
}

/// The keys every material has.
pub struct CommonMaterial<'a> {
    pub name: &'a Located<String>,
    pub normal_map: Option<&'a Located<String>>,
    pub emission: Option<&'a Located<Colour<NonNegative>>>,
    pub emission_two_sided: Option<&'a Located<bool>>,
}

materials! {
    /// Lambert: f = ρ/π.
    Diffuse(DiffuseMaterial) { reflectance: Colour<Fraction> }
    /// A perfect mirror.
    Mirror(MirrorMaterial) {
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
    }
    /// A cosine-power lobe about the mirror direction: f = ρ (n+2)/(2π) cosⁿα.
    Glossy(GlossyMaterial) { reflectance: Colour<Fraction>, exponent: Scalar<NonNegative> }
    /// Modified Phong (Lafortune and Willems 1994).
    Phong(PhongMaterial) { diffuse: Colour<Fraction>, specular: Located<Colour<Fraction>>, exponent: Scalar<NonNegative> }
    /// A smooth dielectric with exact Fresnel equations.
    Glass(GlassMaterial) {
        /// Inside over outside, 1.5 when left out.
        ior: Option<Checked<IndexOfRefraction>>,
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
    }
    /// A rough dielectric: one of `alpha`, `roughness` and `exponent`.
    RoughGlass(RoughGlassMaterial) {
        /// Inside over outside, 1.5 when left out.
        ior: Option<Checked<IndexOfRefraction>>,
        /// GGX width.
        alpha: Option<Located<Scalar<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Scalar<Fraction>>>,
        /// Of the Phong distribution.
        exponent: Option<Located<Scalar<Positive>>>,
        /// "ggx" when left out, but "phong" with an `exponent`.
        distribution: Option<Located<MicrofacetEntry>>,
        /// 1 when left out.
        reflectance: Option<Colour<Fraction>>,
        /// 1 when left out.
        transmittance: Option<Colour<Fraction>>,
    }
    /// GGX with height-correlated Smith shadowing: `eta` and `k`, a `preset`, or `reflectance`.
    Conductor(ConductorMaterial) {
        /// A metal whose eta and k are known.
        preset: Option<Located<MetalEntry>>,
        eta: Option<Located<Rgb<Positive>>>,
        k: Option<Located<Rgb<NonNegative>>>,
        /// At normal incidence (Schlick's approximation).
        reflectance: Option<Located<Colour<Fraction>>>,
        /// GGX width; 0, a smooth metal, when left out.
        alpha: Option<Located<Scalar<Fraction>>>,
        /// alpha = roughness²
        roughness: Option<Located<Scalar<Fraction>>>,
    }
    /// Emits and reflects nothing.
    Emissive(EmissiveMaterial) {
        radiance: Colour<NonNegative>,
        /// Emission leaves the front only, unless this is true.
        two_sided: Option<bool>,
    }
    /// w0·first + (1 − w0)·second; either may be another blend.
    Blend(Blend) {
        materials: [Located<String>; 2],
        /// The weight w0 of the first material.
        weight: Located<BlendWeightEntry>,
    }
    /// The ray goes on as if nothing were there.
    Pass(PassMaterial) {}
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MicrofacetEntry {
    Ggx,
    Phong,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum MetalEntry {
    Gold,
    Copper,
    Silver,
    Aluminium,
}

/// `alpha` and `roughness` of one material.
pub struct AlphaKeys<'a> {
    pub alpha: Option<&'a Located<Scalar<Fraction>>>,
    pub roughness: Option<&'a Located<Scalar<Fraction>>>,
}

/// The weight of a blend's first material.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(tag = "type")]
pub enum BlendWeightEntry {
    Constant(ConstantWeight),
    Facing(FacingWeight),
    Fresnel(FresnelWeight),
    Texture(TextureWeight),
    Reverse(ReverseWeight),
    Threshold(ThresholdWeight),
}

#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ConstantWeight {
    pub value: Checked<Fraction>,
}

/// w0 = clamp(|N·ωo|^power, 0, 1)
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FacingWeight {
    /// 1 when left out.
    pub power: Option<Checked<NonNegative>>,
}

/// w0 = 1 − R
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct FresnelWeight {
    /// 1.5 when left out.
    pub ior: Option<Checked<IndexOfRefraction>>,
    /// The dielectric equations instead of Schlick's approximation.
    #[serde(default)]
    pub exact: bool,
}

/// w0 = luminance of a texture
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct TextureWeight {
    pub texture: Located<String>,
}

/// w0' = 1 − w0
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ReverseWeight {
    pub of: Box<BlendWeightEntry>,
}

/// w0' = 1 where w0 >= tau, else 0
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, expecting = "a table")]
pub struct ThresholdWeight {
    pub tau: Number,
    pub of: Box<BlendWeightEntry>,
}
