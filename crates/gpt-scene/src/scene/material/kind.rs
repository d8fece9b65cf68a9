//! The types of materials, and the lobes that they scatter by.

use super::blend_weight::BlendWeight;
use super::dispersion::{Dispersion, iors};
use super::layers::LayerStack;
use super::microfacets::{Masking, MicrofacetDistribution, Microfacets};
use super::numbers::{Numbers, each};
use super::parameters::{self, ParameterType, place};
use super::plastic::{PlasticInterface, TRANSMITTANCE_NODES};
use super::principled::Principled;
use super::table::{LobeKind, MaterialId, material_table};
use super::thin_film::ThinFilm;
use crate::scene::texture::ColorInput;
use crate::spectrum::Spectrum;

/// The columns of the table of materials about their parameters.
macro_rules! kinds {
    (@slots $lobe:ident [] [$($name:ident),*]) => { None };
    (@slots $lobe:ident [($($slot:ident: $filling:ident),*)] [$($name:ident),*]) => {
        Some(LobeParameters {
            $($slot: (*$filling).into(),)*
            further: kinds!(@further $lobe $($name)*),
            ..LobeParameters::new(LobeKind::$lobe, ColorInput::grey(0.0))
        })
    };
    (@further $lobe:ident) => { Vec::new() };
    (@further $lobe:ident $($name:ident)+) => { parameters::$lobe { $($name: (*$name).into()),* }.list() };
    ($($(#[$doc:meta])* $material:ident $(($boxed:ident: $box_type:ty))? $({ $($field:ident: $type:ty),* $(,)? })? $type_name:ident {
        $($lobe:ident $file:ident $number:ident $support:ident $(($($slot:ident: $filling:ident),*))?
            $([$($name:ident: $parameter_type:ident $(= $default:literal)?),*])?)*
    })*) => {
        /// The material of a surface, with its parameters.
        #[derive(Debug, Clone)]
        pub enum MaterialKind {
            $($(#[$doc])* $material $(($box_type))? $({ $($field: $type),* })?,)*
        }

        impl MaterialKind {
            /// All types, as scene files write them.
            pub const TYPE_NAMES: &'static [&'static str] = &[$(stringify!($type_name)),*];

            /// The type's name in scene files.
            pub fn type_name(&self) -> &'static str {
                match self { $(Self::$material { .. } => stringify!($type_name)),* }
            }

            /// The lobe of a material whose row says what is in which slot.
            #[allow(unused_variables)] // of materials whose row does not
            fn lobe_by_slots(&self) -> Option<LobeParameters> {
                match self {
                    $(Self::$material $(($boxed))? $({ $($field),* })? => {
                        None$(.or(kinds!(@slots $lobe [$(($($slot: $filling),*))?] [$($($name),*)?])))*
                    })*
                }
            }
        }

        impl Numbers for MaterialKind {
            fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
                match self {
                    $(Self::$material $(($boxed))? $({ $($field),* })? => each!(visit: $($boxed)? $($($field),*)?),)*
                }
            }
        }
    };
}
material_table!(kinds);

/// How facets that Lambert's law holds for are seen together.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RoughDiffuseModel {
    /// Oren and Nayar's whole model: facets mask, shadow and light each other, once.
    Full,
    /// Their simpler one, without light from facet to facet.
    Qualitative,
    /// Fujii's form of it, with the light that it loses given back (Portsmouth, Kutz and Hill 2025).
    EnergyPreserving,
}

impl Numbers for RoughDiffuseModel {}

#[derive(Debug, Clone)]
pub enum ConductorFresnel {
    /// Complex index of refraction eta + ik, per RGB channel.
    Complex { eta: Spectrum, k: Spectrum },
    /// Schlick's approximation from the reflectance at normal incidence.
    Reflectance(ColorInput),
}

impl Numbers for ConductorFresnel {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        match self {
            Self::Complex { eta, k } => each!(visit: eta, k),
            Self::Reflectance(reflectance) => reflectance.each_number(visit),
        }
    }
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
    /// The first of the lobe's [further parameters](LobeKind::parameters); none where the defaults of all
    /// hold.
    pub further: Vec<ColorInput>,
    /// The [transmittance of rough plastic's surface](PlasticInterface::transmittance_table).
    pub table: Vec<f32>,
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
/// The coat has a normal map of its own.
pub const COAT_NORMAL_MAP: u32 = 2048;
/// The direction in which microfacets are wider comes from a texture.
pub const DIRECTED: u32 = 4096;
/// The diffuse base lets light through.
pub const DIFFUSE_TRANSMITS: u32 = 8192;
/// A film on the surface makes light interfere.
pub const THIN_FILM: u32 = 16384;
/// Light that the base lets in keeps its colour: the medium below gives it one.
pub const UNTINTED: u32 = 32768;
/// Channels have indices of refraction of their own.
pub const DISPERSED: u32 = 65536;
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
    | COAT_NORMAL_MAP
    | DIRECTED
    | DIFFUSE_TRANSMITS
    | THIN_FILM
    | UNTINTED
    | DISPERSED;

/// Entries that the transmittance of rough plastic takes.
const TRANSMITTANCE_ENTRIES: usize = TRANSMITTANCE_NODES.div_ceil(3);

impl LobeParameters {
    /// A lobe with one colour.
    fn new(lobe: LobeKind, color0: ColorInput) -> Self {
        Self { lobe, form: 0, color0, color1: None, roughness: None, ior: None, further: Vec::new(), table: Vec::new() }
    }

    /// The lobe with microfacets, but for their width across the tangent, which is a further parameter.
    fn with_facets(self, facets: &Microfacets) -> Self {
        let form = if facets.distribution == MicrofacetDistribution::Beckmann { BECKMANN } else { 0 }
            | if facets.masking == Masking::Separable { SEPARABLE_MASKING } else { 0 }
            | if facets.alpha_v.is_some() { ANISOTROPIC } else { 0 }
            | if facets.alpha_v.is_some_and(|across| across.is_squared()) { SQUARED_ACROSS } else { 0 };
        Self { roughness: Some(facets.alpha), form: self.form | form, ..self }
    }

    /// All parameters that may come from textures.
    pub fn inputs(&self) -> impl Iterator<Item = (ParameterType, ColorInput)> {
        let colors = [Some(self.color0), self.color1].into_iter().flatten().map(|color| (ParameterType::Color, color));
        let further = self.lobe.parameters().iter().map(|parameter| parameter.parameter_type).zip(self.further.iter().copied());
        colors.chain(self.roughness.map(|roughness| (ParameterType::Scalar, roughness))).chain(further)
    }
}

impl MaterialKind {
    /// The lobe that the material scatters by; None of a material that scatters nothing, or by its parts.
    pub fn lobe(&self) -> Option<LobeParameters> {
        Some(match *self {
            Self::OrenNayar { reflectance, roughness, model } => {
                let lobe = match model {
                    RoughDiffuseModel::Full => LobeKind::OrenNayar,
                    RoughDiffuseModel::Qualitative => LobeKind::QualitativeOrenNayar,
                    RoughDiffuseModel::EnergyPreserving => LobeKind::EnergyPreservingOrenNayar,
                };
                LobeParameters { roughness: Some(roughness), ..LobeParameters::new(lobe, reflectance) }
            }
            Self::Glass { ior, reflectance, transmittance, thin, film: None, dispersion: None } => LobeParameters {
                color1: Some(transmittance),
                ior: Some(ior),
                ..LobeParameters::new(if thin { LobeKind::ThinGlass } else { LobeKind::Glass }, reflectance)
            },
            Self::Glass { ior, reflectance, transmittance, film, dispersion, .. } => {
                spectral_glass(ior, dispersion, film, [reflectance, transmittance])
            }
            Self::RoughGlass { ior, facets, reflectance, transmittance, thin, film: None, dispersion: None } => {
                let lobe = match (facets.distribution, thin) {
                    (MicrofacetDistribution::Phong, _) => LobeKind::PhongGlass,
                    (_, true) if facets.are_smooth() => LobeKind::ThinGlass,
                    (_, true) => LobeKind::RoughThinGlass,
                    (_, false) if facets.are_smooth() || (ior - 1.0).abs() < SMALLEST_BEND => LobeKind::Glass,
                    (_, false) => LobeKind::RoughGlass,
                };
                let glass =
                    LobeParameters { color1: Some(transmittance), ior: Some(ior), ..LobeParameters::new(lobe, reflectance) };
                if matches!(lobe, LobeKind::Glass | LobeKind::ThinGlass) {
                    return Some(LobeParameters { roughness: Some(facets.alpha), ..glass });
                }
                let further = facets.alpha_v.map(|width_across| match lobe {
                    LobeKind::RoughThinGlass => parameters::RoughThinGlass { width_across }.list(),
                    _ => parameters::RoughGlass { width_across }.list(),
                });
                LobeParameters { further: further.unwrap_or_default(), ..glass.with_facets(&facets) }
            }
            Self::RoughGlass { ior, facets, reflectance, transmittance, film, dispersion, .. } => {
                let glass = spectral_glass(ior, dispersion, film, [reflectance, transmittance]);
                if facets.are_smooth() {
                    return Some(LobeParameters { roughness: Some(facets.alpha), ..glass });
                }
                let [thin_film_thickness, thin_film] = further_of_film(film);
                let further = parameters::RoughSpectralGlass {
                    iors: ColorInput::Constant(iors(ior, dispersion)),
                    width_across: facets.alpha_v.unwrap_or(facets.alpha),
                    thin_film_thickness,
                    thin_film,
                };
                LobeParameters { lobe: LobeKind::RoughSpectralGlass, further: further.list(), ..glass }.with_facets(&facets)
            }
            Self::Plastic { ref interface, reflectance, specular_reflectance, nonlinear } => {
                let internal_reflectance = ColorInput::grey(interface.internal_reflectance());
                let (lobe, further) = match interface.is_rough() {
                    true => (LobeKind::RoughPlastic, parameters::RoughPlastic { internal_reflectance }.list()),
                    false => (LobeKind::Plastic, parameters::Plastic { internal_reflectance }.list()),
                };
                let facets = Microfacets {
                    alpha: ColorInput::grey(interface.alpha),
                    alpha_v: None,
                    distribution: interface.distribution,
                    masking: interface.masking,
                };
                LobeParameters {
                    form: if nonlinear { NONLINEAR } else { 0 },
                    color1: Some(specular_reflectance),
                    ior: Some(interface.ior),
                    further,
                    table: interface.transmittance_table().map_or_else(Vec::new, |table| table.to_vec()),
                    ..LobeParameters::new(lobe, reflectance)
                }
                .with_facets(&facets)
            }
            Self::Conductor { ref fresnel, facets, specular_reflectance, film } => {
                let (form, color0, color1) = match *fresnel {
                    ConductorFresnel::Complex { eta, k } => {
                        (COMPLEX_FRESNEL, ColorInput::Constant(eta), Some(ColorInput::Constant(k)))
                    }
                    ConductorFresnel::Reflectance(reflectance) => (0, reflectance, None),
                };
                let form = form | form_of_film(film);
                let has_defaults = facets.alpha_v.is_none() && specular_reflectance == ColorInput::grey(1.0);
                let width_across = facets.alpha_v.unwrap_or(facets.alpha);
                let [thin_film_thickness, thin_film] = further_of_film(film);
                let mut further =
                    parameters::Conductor { width_across, specular_reflectance, thin_film_thickness, thin_film }.list();
                if film.is_none() {
                    further.truncate(if has_defaults { 0 } else { FURTHER_OF_PLAIN_CONDUCTOR });
                }
                LobeParameters { form, color1, further, ..LobeParameters::new(LobeKind::Conductor, color0) }.with_facets(&facets)
            }
            Self::Principled(ref principled) => principled.lobe(),
            _ => return self.lobe_by_slots(),
        })
    }
}

/// Smooth glass whose channels are not reflected or refracted alike.
fn spectral_glass(ior: f64, dispersion: Option<Dispersion>, film: Option<ThinFilm>, colors: [ColorInput; 2]) -> LobeParameters {
    let [thin_film_thickness, thin_film] = further_of_film(film);
    let iors = ColorInput::Constant(iors(ior, dispersion));
    let further = parameters::SpectralGlass { iors, thin_film_thickness, thin_film };
    LobeParameters {
        form: form_of_film(film),
        color1: Some(colors[1]),
        ior: Some(ior),
        further: further.list(),
        ..LobeParameters::new(LobeKind::SpectralGlass, colors[0])
    }
}

/// The thickness of a film, and its index of refraction with what is added to the thickness.
fn further_of_film(film: Option<ThinFilm>) -> [ColorInput; 2] {
    let film = film.unwrap_or(ThinFilm { thickness: ColorInput::grey(0.0), offset: 0.0, ior: 1.0 });
    [film.thickness, ColorInput::Constant(Spectrum::new(film.ior, film.offset, 0.0))]
}

fn form_of_film(film: Option<ThinFilm>) -> u32 {
    if film.is_some() { THIN_FILM } else { 0 }
}

/// The number of further parameters of a conductor without a film, where it has some.
const FURTHER_OF_PLAIN_CONDUCTOR: usize = place!(Conductor.specular_reflectance) + 1;

/// The place of the texels of its coat's normals.
pub const COAT_TEXEL_PARAMETER: usize = place!(Principled.coat_texel);

/// The number of further parameters of the principled lobe in a form.
fn further_of_principled(form: u32) -> usize {
    let last = match form {
        form if form & DISPERSED != 0 => place!(Principled.iors),
        form if form & THIN_FILM != 0 => place!(Principled.thin_film),
        form if form & DIFFUSE_TRANSMITS != 0 => place!(Principled.diffuse_transmission_color),
        form if form & DIRECTED != 0 => place!(Principled.direction_texel),
        form if form & COAT_NORMAL_MAP != 0 => place!(Principled.coat_scale),
        form if form & SHEEN != 0 => place!(Principled.sheen_roughness),
        _ => place!(Principled.rotation),
    };
    last + 1
}

impl Principled {
    fn lobe(&self) -> LobeParameters {
        let zero = ColorInput::grey(0.0);
        let turned = self.anisotropy_rotation_degrees.to_radians();
        let direction = self.anisotropy_direction.filter(|_| self.anisotropy.is_some());
        let form = if self.masking == Masking::Separable { SEPARABLE_MASKING } else { 0 }
            | if self.anisotropy.is_some() { ANISOTROPIC } else { 0 }
            | if self.thin { THIN_WALL } else { 0 }
            | if self.let_through() == zero { 0 } else { TRANSMITS }
            | if self.subsurface.is_some() { UNTINTED } else { 0 }
            | if self.energy_compensation { COMPENSATED } else { 0 }
            | if self.sheen_color == zero { 0 } else { SHEEN }
            | if self.coat_normal_map.is_some() { COAT_NORMAL_MAP } else { 0 }
            | if direction.is_some() { DIRECTED } else { 0 }
            | if self.diffuse_transmission == zero { 0 } else { DIFFUSE_TRANSMITS }
            | if self.iors().is_some() { DISPERSED } else { 0 }
            | form_of_film(self.thin_film);
        let [thin_film_thickness, thin_film] = further_of_film(self.thin_film);
        let mut further = parameters::Principled {
            metallic: self.metallic,
            specular: self.specular,
            transmission: self.let_through(),
            coat: self.clearcoat,
            coat_roughness: self.clearcoat_roughness,
            anisotropy: self.anisotropy.unwrap_or(zero),
            rotation: ColorInput::Constant(Spectrum::new(turned.cos(), turned.sin(), 0.0)),
            sheen_color: self.sheen_color,
            sheen_roughness: self.sheen_roughness,
            coat_texel: self.coat_normal_map.map_or(zero, |map| ColorInput::Texture(map.texture)),
            coat_scale: self.coat_normal_map.map_or(zero, |map| ColorInput::grey(map.scale)),
            direction_texel: direction.map_or(zero, ColorInput::Texture),
            diffuse_transmission: self.diffuse_transmission,
            diffuse_transmission_color: self.diffuse_transmission_color,
            thin_film_share: self.thin_film_share,
            thin_film_thickness,
            thin_film,
            iors: ColorInput::Constant(self.iors().unwrap_or(Spectrum::grey(self.ior))),
        }
        .list();
        further.truncate(further_of_principled(form));
        LobeParameters {
            form,
            color1: Some(self.specular_color),
            roughness: Some(self.roughness),
            ior: Some(self.ior),
            further,
            ..LobeParameters::new(LobeKind::Principled, self.base_color)
        }
    }
}

/// An index of refraction nearer to 1 than this bends no ray that rounding would not: such glass sends light straight on, however rough.
pub const SMALLEST_BEND: f64 = 1e-4;

impl LobeKind {
    /// The number of [further parameters](LobeParameters::further) of a lobe in this
    /// [form](LobeParameters::form) where it has some, and of the entries that its
    /// [table](LobeParameters::table) takes behind them.
    pub fn further_counts(self, form: u32) -> [usize; 2] {
        match self {
            Self::Principled => [further_of_principled(form), 0],
            Self::Conductor if form & THIN_FILM == 0 => [FURTHER_OF_PLAIN_CONDUCTOR, 0],
            Self::RoughPlastic => [self.parameters().len(), TRANSMITTANCE_ENTRIES],
            _ => [self.parameters().len(), 0],
        }
    }

    /// The lobe cannot do without them.
    pub fn needs_further(self) -> bool {
        self.parameters().iter().any(|parameter| parameter.default.is_none())
    }
}
