//! The types of materials, and the table that all their representations hang on.

use glam::DVec3;

use super::blend_weight::BlendWeight;
use crate::scene::texture::ColorInput;

/// Index into [`crate::scene::Scene::materials`].
pub type MaterialId = usize;

/// The table of materials, one row each:
///
/// - the variant of [`MaterialKind`];
/// - its type in scene files, which is also the name of its module in `load::file::material`;
/// - the lobes that it scatters by, each with its variant of [`LobeKind`] and type in `reference::bsdf`, the name of its files there
///   and in `shaders/shading/bsdf/`, the name of its number and of its switch in shaders, and its [`LobeSupport`].
///
/// `material_table!(what)` calls `what!` with all rows. Modules, dispatch and constants elsewhere are made from them.
macro_rules! material_table {
    ($what:ident) => {
        $what! {
            Diffuse diffuse { Diffuse diffuse DIFFUSE Hemisphere }
            Mirror mirror { Mirror mirror MIRROR Delta }
            Glossy glossy { Glossy glossy GLOSSY Hemisphere }
            Phong phong { Phong phong PHONG Hemisphere }
            Glass glass { Glass glass GLASS Delta }
            RoughGlass rough_glass { RoughGlass rough_glass ROUGH_GLASS Sphere PhongGlass phong_glass PHONG_GLASS Sphere }
            Conductor conductor { Conductor conductor CONDUCTOR Hemisphere }
            Emissive emissive {}
            Blend blend {}
            Pass pass { Null null NULL_SURFACES Delta }
        }
    };
}
pub(crate) use material_table;

/// What a surface is made of, with its parameters.
#[derive(Debug, Clone)]
pub enum MaterialKind {
    /// Lambert: f = ρ/π.
    Diffuse { reflectance: ColorInput },
    /// Perfect mirror.
    Mirror { reflectance: ColorInput },
    /// Cosine-power lobe about the mirror direction: f = ρ (n+2)/(2π) cosⁿα.
    Glossy { reflectance: ColorInput, exponent: ColorInput },
    /// Modified Phong (Lafortune and Willems 1994).
    Phong { diffuse: ColorInput, specular: ColorInput, exponent: ColorInput },
    /// Smooth dielectric with exact Fresnel equations. `ior` is inside over outside, the outside being where the normal points.
    Glass { ior: f64, reflectance: ColorInput, transmittance: ColorInput },
    /// Rough dielectric; `alpha` is the GGX width or, for the Phong distribution, the exponent.
    RoughGlass {
        ior: f64,
        alpha: ColorInput,
        distribution: MicrofacetDistribution,
        reflectance: ColorInput,
        transmittance: ColorInput,
    },
    /// GGX conductor with height-correlated Smith shadowing; `alpha` 0 is a smooth metal.
    Conductor { fresnel: ConductorFresnel, alpha: ColorInput },
    /// Reflects nothing; what it emits is the material's `emission`.
    Emissive,
    /// w0·first + (1 − w0)·second.
    Blend { materials: [MaterialId; 2], weight: BlendWeight },
    /// The ray goes on as if nothing were there.
    Pass,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MicrofacetDistribution {
    Ggx,
    /// Cosine-power perturbation of the refracted direction (Honsdorf 2013, section 5.3).
    Phong,
}

#[derive(Debug, Clone)]
pub enum ConductorFresnel {
    /// Complex index of refraction eta + ik, per RGB channel.
    Complex { eta: DVec3, k: DVec3 },
    /// Schlick's approximation from the reflectance at normal incidence.
    Reflectance(ColorInput),
}

/// A lobe and its parameters, in the slots that tables of materials have for them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LobeParameters {
    pub lobe: LobeKind,
    /// Which of its forms the lobe has, where it has several.
    pub form: u32,
    /// What is reflected; a diffuse share of it; or the real part of a complex index of refraction.
    pub color0: ColorInput,
    /// What is transmitted; a specular share of what is reflected; or the imaginary part of a complex index of refraction.
    pub color1: Option<ColorInput>,
    /// The width of a distribution of microfacets, or the exponent of a power of a cosine.
    pub roughness: Option<ColorInput>,
    pub ior: Option<f64>,
}

/// [`LobeParameters::form`] of a conductor whose colours are its complex index of refraction.
pub const COMPLEX_FRESNEL: u32 = 1;

impl LobeParameters {
    /// Of a lobe with one colour.
    fn new(lobe: LobeKind, color0: ColorInput) -> Self {
        Self { lobe, form: 0, color0, color1: None, roughness: None, ior: None }
    }

    /// All parameters that may come from textures.
    pub fn inputs(self) -> impl Iterator<Item = ColorInput> {
        [Some(self.color0), self.color1, self.roughness].into_iter().flatten()
    }
}

impl MaterialKind {
    /// The lobe that the material scatters by; None of a material that scatters nothing, or by its parts.
    pub fn lobe(&self) -> Option<LobeParameters> {
        Some(match *self {
            Self::Diffuse { reflectance } => LobeParameters::new(LobeKind::Diffuse, reflectance),
            Self::Mirror { reflectance } => LobeParameters::new(LobeKind::Mirror, reflectance),
            Self::Glossy { reflectance, exponent } => {
                LobeParameters { roughness: Some(exponent), ..LobeParameters::new(LobeKind::Glossy, reflectance) }
            }
            Self::Phong { diffuse, specular, exponent } => LobeParameters {
                color1: Some(specular),
                roughness: Some(exponent),
                ..LobeParameters::new(LobeKind::Phong, diffuse)
            },
            Self::Glass { ior, reflectance, transmittance } => LobeParameters {
                color1: Some(transmittance),
                ior: Some(ior),
                ..LobeParameters::new(LobeKind::Glass, reflectance)
            },
            Self::RoughGlass { ior, alpha, distribution, reflectance, transmittance } => {
                let lobe = match distribution {
                    MicrofacetDistribution::Phong => LobeKind::PhongGlass,
                    MicrofacetDistribution::Ggx if is_smooth_glass(alpha, ior) => LobeKind::Glass,
                    MicrofacetDistribution::Ggx => LobeKind::RoughGlass,
                };
                LobeParameters {
                    color1: Some(transmittance),
                    roughness: Some(alpha),
                    ior: Some(ior),
                    ..LobeParameters::new(lobe, reflectance)
                }
            }
            Self::Conductor { fresnel: ConductorFresnel::Complex { eta, k }, alpha } => LobeParameters {
                form: COMPLEX_FRESNEL,
                color1: Some(ColorInput::Constant(k)),
                roughness: Some(alpha),
                ..LobeParameters::new(LobeKind::Conductor, ColorInput::Constant(eta))
            },
            Self::Conductor { fresnel: ConductorFresnel::Reflectance(reflectance), alpha } => {
                LobeParameters { roughness: Some(alpha), ..LobeParameters::new(LobeKind::Conductor, reflectance) }
            }
            Self::Pass => LobeParameters::new(LobeKind::Null, ColorInput::grey(0.0)),
            Self::Emissive | Self::Blend { .. } => return None,
        })
    }
}

/// GGX narrower than this is a delta lobe: f32 no longer resolves it.
pub const DELTA_ALPHA: f64 = 1e-4;
/// An index of refraction nearer to 1 than this bends no ray that rounding would not: such glass sends light straight on, however rough.
pub const SMALLEST_BEND: f64 = 1e-4;

/// Rough glass that is smooth all over the surface.
fn is_smooth_glass(alpha: ColorInput, ior: f64) -> bool {
    matches!(alpha, ColorInput::Constant(alpha) if alpha.x < DELTA_ALPHA) || (ior - 1.0).abs() < SMALLEST_BEND
}

/// The directions that a lobe scatters into.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LobeSupport {
    /// Single directions, which no light sample finds.
    Delta,
    /// The side of the surface that light leaves from.
    Hemisphere,
    /// Both sides.
    Sphere,
}

/// What the table of materials says of lobes and of names.
macro_rules! kinds {
    ($($material:ident $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident)* })*) => {
        /// The ways to scatter light that materials are made of.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum LobeKind { $($($lobe,)*)* }

        impl LobeKind {
            /// In the order of their numbers.
            pub const ALL: &'static [Self] = &[$($(Self::$lobe,)*)*];

            /// The name of the lobe's file in `shaders/shading/bsdf/`, and in the names of the functions there.
            pub fn file(self) -> &'static str {
                match self { $($(Self::$lobe => stringify!($file),)*)* }
            }

            /// What shaders name its number, and the switch that compiles it.
            pub fn switch(self) -> &'static str {
                match self { $($(Self::$lobe => stringify!($number),)*)* }
            }

            pub fn support(self) -> LobeSupport {
                match self { $($(Self::$lobe => LobeSupport::$support,)*)* }
            }
        }

        impl MaterialKind {
            /// All types, as scene files write them.
            pub const TYPE_NAMES: &'static [&'static str] = &[$(stringify!($type_name)),*];

            /// As scene files write the type.
            pub fn type_name(&self) -> &'static str {
                match self { $(Self::$material { .. } => stringify!($type_name)),* }
            }
        }
    };
}
material_table!(kinds);
