//! The types of materials, and the table that all their representations hang on.

use glam::DVec3;

use super::blend_weight::BlendWeight;
use super::microfacets::{Masking, MicrofacetDistribution, Microfacets};
use super::plastic::{PlasticInterface, TRANSMITTANCE_NODES};
use super::principled::Principled;
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
/// `material_table!(what)` calls `what!` with all rows. Dispatch and constants elsewhere are made from them; modules are declared where they stand.
#[doc(hidden)]
#[macro_export]
macro_rules! material_table {
    ($what:ident) => {
        $what! {
            Diffuse diffuse { Diffuse diffuse DIFFUSE Hemisphere }
            Mirror mirror { Mirror mirror MIRROR Delta }
            Glossy glossy { Glossy glossy GLOSSY Hemisphere }
            Phong phong { Phong phong PHONG Hemisphere }
            Glass glass { Glass glass GLASS Delta ThinGlass thin_glass THIN_GLASS Delta }
            RoughGlass rough_glass {
                RoughGlass rough_glass ROUGH_GLASS Sphere
                PhongGlass phong_glass PHONG_GLASS Sphere
                RoughThinGlass rough_thin_glass ROUGH_THIN_GLASS Sphere
            }
            Plastic plastic { Plastic plastic PLASTIC Hemisphere RoughPlastic rough_plastic ROUGH_PLASTIC Hemisphere }
            Conductor conductor { Conductor conductor CONDUCTOR Hemisphere }
            Principled principled { Principled principled PRINCIPLED Sphere }
            Emissive emissive {}
            Blend blend {}
            Pass pass { Null null NULL_SURFACES Delta }
        }
    };
}
#[doc(hidden)]
pub use material_table;

/// The material of a surface, with its parameters.
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
    /// Smooth dielectric with exact Fresnel equations. `ior` is inside over outside, the outside being where the normal points; a `thin` one
    /// is a plate of both boundaries, which light crosses without changing its direction.
    Glass { ior: f64, reflectance: ColorInput, transmittance: ColorInput, thin: bool },
    /// Rough dielectric; of a `thin` one every microfacet is a thin plate.
    RoughGlass { ior: f64, facets: Microfacets, reflectance: ColorInput, transmittance: ColorInput, thin: bool },
    /// A diffuse base below a dielectric surface; `nonlinear` takes account of how the colour deepens as light goes up and down within.
    Plastic { interface: PlasticInterface, reflectance: ColorInput, specular_reflectance: ColorInput, nonlinear: bool },
    /// Conductor of microfacets, smooth where their width is 0. What it reflects is multiplied by `specular_reflectance`.
    Conductor { fresnel: ConductorFresnel, facets: Microfacets, specular_reflectance: ColorInput },
    /// The material of glTF 2.0's Appendix B.
    Principled(Box<Principled>),
    /// Reflects nothing; what it emits is the material's `emission`.
    Emissive,
    /// w0·first + (1 − w0)·second.
    Blend { materials: [MaterialId; 2], weight: BlendWeight },
    /// The ray goes on as if nothing were there.
    Pass,
}

#[derive(Debug, Clone)]
pub enum ConductorFresnel {
    /// Complex index of refraction eta + ik, per RGB channel.
    Complex { eta: DVec3, k: DVec3 },
    /// Schlick's approximation from the reflectance at normal incidence.
    Reflectance(ColorInput),
}

/// A lobe and its parameters, in the slots that tables of materials have for them.
#[derive(Debug, Clone, PartialEq)]
pub struct LobeParameters {
    pub lobe: LobeKind,
    /// Which of its forms the lobe has, where it has several: bits.
    pub form: u32,
    /// The reflected colour; a diffuse share of it; or the real part of a complex index of refraction.
    pub color0: ColorInput,
    /// The transmitted colour; a specular share of the reflected one; or the imaginary part of a complex
    /// index of refraction.
    pub color1: Option<ColorInput>,
    /// The width of a distribution of microfacets, or the exponent of a power of a cosine.
    pub roughness: Option<ColorInput>,
    pub ior: Option<f64>,
    /// The further parameters of the lobe; none where the lobe's own defaults hold:
    ///
    /// - of a conductor, and of rough glass, thin or not, the width across the tangent, and a factor of what is reflected;
    /// - of the principled lobe, metallic, specular, transmission, clearcoat, its roughness, anisotropy, and 1 plus the cosine and the sine of
    ///   its rotation; where it has a form that needs more, the extinction of what it encloses, and the colour and the roughness of its sheen;
    ///   where its coat has normals of its own, their texels, and their scale: how far it is above 0, and how far below; and where the direction of
    ///   its anisotropy comes from a texture, the texels;
    /// - of plastic, the share of light from within that the surface sends back;
    /// - of rough plastic, the same, and then what the surface lets through, three angles an entry.
    pub further: Vec<ColorInput>,
    /// How many of those may come from textures, the first ones.
    pub looked_up: usize,
}

/// Bits of [`LobeParameters::form`]: the colours of a conductor are its complex index of refraction.
pub const COMPLEX_FRESNEL: u32 = 1;
/// The slopes of the microfacets are normally distributed.
pub const BECKMANN: u32 = 2;
/// Microfacets are masked from one side whether or not they are from the other.
pub const SEPARABLE_MASKING: u32 = 4;
/// The colour of plastic deepens as light goes up and down within.
pub const NONLINEAR: u32 = 8;
/// The width across the tangent is the square of the texture.
pub const SQUARED_ACROSS: u32 = 16;
/// Microfacets have two widths, one of them across the tangent.
pub const ANISOTROPIC: u32 = 32;
/// The flag of a wall without thickness that lets light through.
pub const THIN_WALL: u32 = 64;
/// The lobe lets light through.
pub const TRANSMITS: u32 = 128;
/// Light that microfacets send to each other is not lost.
pub const COMPENSATED: u32 = 256;
/// Fibres stand on the surface.
pub const SHEEN: u32 = 512;
/// The flag of a surface whose inside takes light.
pub const ATTENUATES: u32 = 1024;
/// The coat has a normal map of its own.
pub const COAT_NORMAL_MAP: u32 = 2048;
/// The direction in which microfacets are wider comes from a texture.
pub const DIRECTED: u32 = 4096;
/// All of these.
pub const FORMS: u32 = COMPLEX_FRESNEL
    | BECKMANN
    | SEPARABLE_MASKING
    | NONLINEAR
    | SQUARED_ACROSS
    | ANISOTROPIC
    | THIN_WALL
    | TRANSMITS
    | COMPENSATED
    | SHEEN
    | ATTENUATES
    | COAT_NORMAL_MAP
    | DIRECTED;

/// Entries that the transmittance of rough plastic takes.
const TRANSMITTANCE_ENTRIES: usize = TRANSMITTANCE_NODES.div_ceil(3);

impl LobeParameters {
    /// A lobe with one colour.
    fn new(lobe: LobeKind, color0: ColorInput) -> Self {
        Self { lobe, form: 0, color0, color1: None, roughness: None, ior: None, further: Vec::new(), looked_up: 0 }
    }

    /// The lobe with microfacets, and with the reflected colour multiplied by `factor`.
    fn with_facets(mut self, facets: &Microfacets, factor: ColorInput) -> Self {
        self.roughness = Some(facets.alpha);
        self.form |= if facets.distribution == MicrofacetDistribution::Beckmann { BECKMANN } else { 0 }
            | if facets.masking == Masking::Separable { SEPARABLE_MASKING } else { 0 }
            | if facets.alpha_v.is_some() { ANISOTROPIC } else { 0 };
        if facets.alpha_v.is_some() || factor != ColorInput::grey(1.0) {
            let across = facets.alpha_v.unwrap_or(facets.alpha);
            self.form |= if across.is_squared() { SQUARED_ACROSS } else { 0 };
            self.further = vec![across, factor];
            self.looked_up = 2;
        }
        self
    }

    /// All parameters that may come from textures.
    pub fn inputs(&self) -> impl Iterator<Item = ColorInput> {
        [Some(self.color0), self.color1, self.roughness].into_iter().flatten().chain(self.further.iter().copied())
    }
}

/// The share of light from within that a plastic's surface sends back, and what a rough one lets through.
fn interface_parameters(interface: &PlasticInterface) -> Vec<ColorInput> {
    let mut further = vec![ColorInput::grey(interface.internal_reflectance())];
    if let Some(table) = interface.transmittance_table() {
        let at = |node: usize| f64::from(table[node.min(TRANSMITTANCE_NODES - 1)]);
        let entry = |first: usize| ColorInput::Constant(DVec3::new(at(first), at(first + 1), at(first + 2)));
        further.extend((0..TRANSMITTANCE_ENTRIES).map(|index| entry(3 * index)));
    }
    further
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
            Self::Glass { ior, reflectance, transmittance, thin } => LobeParameters {
                color1: Some(transmittance),
                ior: Some(ior),
                ..LobeParameters::new(if thin { LobeKind::ThinGlass } else { LobeKind::Glass }, reflectance)
            },
            Self::RoughGlass { ior, facets, reflectance, transmittance, thin } => {
                let lobe = match (facets.distribution, thin) {
                    (MicrofacetDistribution::Phong, _) => LobeKind::PhongGlass,
                    (_, true) if facets.are_smooth() => LobeKind::ThinGlass,
                    (_, true) => LobeKind::RoughThinGlass,
                    (_, false) if facets.are_smooth() || (ior - 1.0).abs() < SMALLEST_BEND => LobeKind::Glass,
                    (_, false) => LobeKind::RoughGlass,
                };
                let glass =
                    LobeParameters { color1: Some(transmittance), ior: Some(ior), ..LobeParameters::new(lobe, reflectance) };
                match lobe {
                    LobeKind::Glass | LobeKind::ThinGlass => LobeParameters { roughness: Some(facets.alpha), ..glass },
                    _ => glass.with_facets(&facets, ColorInput::grey(1.0)),
                }
            }
            Self::Plastic { ref interface, reflectance, specular_reflectance, nonlinear } => {
                let lobe = if interface.is_rough() { LobeKind::RoughPlastic } else { LobeKind::Plastic };
                let facets = Microfacets {
                    alpha: ColorInput::grey(interface.alpha),
                    alpha_v: None,
                    distribution: interface.distribution,
                    masking: interface.masking,
                };
                let mut plastic = LobeParameters::new(lobe, reflectance).with_facets(&facets, ColorInput::grey(1.0));
                plastic.form |= if nonlinear { NONLINEAR } else { 0 };
                let further = interface_parameters(interface);
                LobeParameters { color1: Some(specular_reflectance), ior: Some(interface.ior), further, looked_up: 1, ..plastic }
            }
            Self::Conductor { ref fresnel, facets, specular_reflectance } => {
                let (form, color0, color1) = match *fresnel {
                    ConductorFresnel::Complex { eta, k } => {
                        (COMPLEX_FRESNEL, ColorInput::Constant(eta), Some(ColorInput::Constant(k)))
                    }
                    ConductorFresnel::Reflectance(reflectance) => (0, reflectance, None),
                };
                LobeParameters { form, color1, ..LobeParameters::new(LobeKind::Conductor, color0) }
                    .with_facets(&facets, specular_reflectance)
            }
            Self::Principled(ref principled) => principled.lobe(),
            Self::Pass => LobeParameters::new(LobeKind::Null, ColorInput::grey(0.0)),
            Self::Emissive | Self::Blend { .. } => return None,
        })
    }
}

/// The place of the extinction inside the surface among the further parameters of the principled lobe.
pub const EXTINCTION_PARAMETER: usize = 7;

/// The place of the texels of its coat's normals; their scale is the next.
pub const COAT_NORMAL_PARAMETER: usize = EXTINCTION_PARAMETER + 3;

/// The place of the texels of its anisotropy's direction.
pub const DIRECTION_PARAMETER: usize = COAT_NORMAL_PARAMETER + 2;

/// How many further parameters the principled lobe has.
fn further_of_principled(form: u32) -> usize {
    match form {
        form if form & DIRECTED != 0 => DIRECTION_PARAMETER + 1,
        form if form & COAT_NORMAL_MAP != 0 => DIRECTION_PARAMETER,
        form if form & (SHEEN | ATTENUATES) != 0 => COAT_NORMAL_PARAMETER,
        _ => EXTINCTION_PARAMETER,
    }
}

impl Principled {
    fn lobe(&self) -> LobeParameters {
        let zero = ColorInput::grey(0.0);
        let turned = self.anisotropy_rotation_degrees.to_radians();
        let direction = self.anisotropy_direction.filter(|_| self.anisotropy.is_some());
        let form = if self.masking == Masking::Separable { SEPARABLE_MASKING } else { 0 }
            | if self.anisotropy.is_some() { ANISOTROPIC } else { 0 }
            | if self.thin { THIN_WALL } else { 0 }
            | if self.transmission == zero { 0 } else { TRANSMITS }
            | if self.energy_compensation { COMPENSATED } else { 0 }
            | if self.sheen_color == zero { 0 } else { SHEEN }
            | if self.attenuation.is_some() { ATTENUATES } else { 0 }
            | if self.coat_normal_map.is_some() { COAT_NORMAL_MAP } else { 0 }
            | if direction.is_some() { DIRECTED } else { 0 };
        let extinction = self.attenuation.map_or(DVec3::ZERO, |attenuation| attenuation.extinction());
        let [coat_normal, scale] = self.coat_normal_map.map_or([zero; 2], |map| {
            let scale = DVec3::new(map.scale.max(0.0), (-map.scale).max(0.0), 0.0);
            [ColorInput::Texture(map.texture), ColorInput::Constant(scale)]
        });
        let mut further = vec![
            self.metallic,
            self.specular,
            self.transmission,
            self.clearcoat,
            self.clearcoat_roughness,
            self.anisotropy.unwrap_or(zero),
            ColorInput::Constant(DVec3::new(1.0 + turned.cos(), 1.0 + turned.sin(), 0.0)),
            ColorInput::Constant(extinction),
            self.sheen_color,
            self.sheen_roughness,
            coat_normal,
            scale,
            direction.map_or(zero, ColorInput::Texture),
        ];
        further.truncate(further_of_principled(form));
        LobeParameters {
            form,
            color1: Some(self.specular_color),
            roughness: Some(self.roughness),
            ior: Some(self.ior),
            looked_up: further.len(),
            further,
            ..LobeParameters::new(LobeKind::Principled, self.base_color)
        }
    }
}

/// An index of refraction nearer to 1 than this bends no ray that rounding would not: such glass sends light straight on, however rough.
pub const SMALLEST_BEND: f64 = 1e-4;

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

impl LobeKind {
    /// How many [further parameters](LobeParameters::further) the lobe has in this [form](LobeParameters::form) where it has some, and how many
    /// of them are looked up.
    pub fn further_counts(self, form: u32) -> [usize; 2] {
        match self {
            Self::Conductor | Self::RoughGlass | Self::RoughThinGlass => [2, 2],
            Self::Plastic => [1, 1],
            Self::Principled => [further_of_principled(form); 2],
            Self::RoughPlastic => [1 + TRANSMITTANCE_ENTRIES, 1],
            _ => [0, 0],
        }
    }

    /// The lobe cannot do without them.
    pub fn needs_further(self) -> bool {
        matches!(self, Self::Plastic | Self::RoughPlastic | Self::Principled)
    }
}

/// The columns of the table of materials about lobes and names.
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

            /// The name of its number in shaders, and of the switch that compiles it.
            pub fn switch(self) -> &'static str {
                match self { $($(Self::$lobe => stringify!($number),)*)* }
            }

            /// The directions that it scatters into.
            pub fn support(self) -> LobeSupport {
                match self { $($(Self::$lobe => LobeSupport::$support,)*)* }
            }
        }

        impl MaterialKind {
            /// All types, as scene files write them.
            pub const TYPE_NAMES: &'static [&'static str] = &[$(stringify!($type_name)),*];

            /// The type's name in scene files.
            pub fn type_name(&self) -> &'static str {
                match self { $(Self::$material { .. } => stringify!($type_name)),* }
            }
        }
    };
}
material_table!(kinds);
