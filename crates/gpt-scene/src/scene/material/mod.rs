//! The materials of surfaces.

mod albedo;
mod blend_weight;
pub mod dispersion;
mod form;
mod kind;
mod layers;
mod microfacets;
mod numbers;
mod parameters;
mod plastic;
pub mod principled;
mod table;
pub mod thin_film;

pub use albedo::{
    ALBEDO_COLUMNS, ALBEDO_ROWS, AlbedoTable, FACET_KNEE, SHEEN_KNEE, SMALLEST_SHEEN_ROUGHNESS, sheen_distribution, sheen_lambda,
};
pub use blend_weight::{AXIS_STEPS, BlendWeight, rounded_axis};
pub use dispersion::{Dispersion, iors};
pub use kind::{
    ANISOTROPIC, BECKMANN, COAT_NORMAL_MAP, COAT_TEXEL_PARAMETER, COMPENSATED, COMPLEX_FRESNEL, ConductorFresnel,
    DIFFUSE_TRANSMITS, DIRECTED, DISPERSED, FORMS, LobeParameters, MaterialKind, NONLINEAR, RoughDiffuseModel, SEPARABLE_MASKING,
    SHEEN, SMALLEST_BEND, SQUARED_ACROSS, THIN_FILM, THIN_WALL, TRANSMITS, UNTINTED,
};
pub use layers::{LayerModel, LayerStack, MOST_INTERFACES, Slab};
pub use microfacets::{DELTA_ALPHA, Masking, MicrofacetDistribution, Microfacets, visible_slopes_below};
pub use parameters::{Parameter, ParameterType};
pub use plastic::{PlasticInterface, TRANSMITTANCE_NODES, diffuse_reflectance};
pub use principled::{Attenuation, CoatNormalMap, Principled, Subsurface};
#[doc(hidden)]
pub use table::material_table;
pub use table::{LobeKind, LobeSupport, MaterialId};

pub use thin_film::ThinFilm;

use super::medium::MediumId;
use super::texture::{ColorInput, TextureId};

#[derive(Debug, Clone)]
pub struct Material {
    pub name: String,
    pub kind: MaterialKind,
    /// Tangent-space normals; a texture whose colour space is linear.
    pub normal_map: Option<TextureId>,
    /// Radiance the surface sends out by itself, whatever it reflects.
    pub emission: Option<Emission>,
    /// Both sides scatter light. Else the back is black, whatever the material is made of.
    pub two_sided: bool,
    /// The medium within closed surfaces of the material, which is behind their fronts.
    pub interior: Option<MediumId>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emission {
    pub radiance: ColorInput,
    /// Emission leaves the front only, unless this is set.
    pub two_sided: bool,
}

impl Material {
    /// The material itself, not those it blends, sends light that comes from one direction into one direction or nearly, or through a body: no light
    /// sample of a surface beyond finds the light that it comes from.
    pub fn gathers_light(&self) -> bool {
        match &self.kind {
            MaterialKind::Mirror { .. } | MaterialKind::Glass { .. } | MaterialKind::RoughGlass { .. } => true,
            MaterialKind::Conductor { facets, .. } => facets.are_smooth(),
            MaterialKind::Principled(principled) => principled.let_through() != ColorInput::grey(0.0),
            _ => false,
        }
    }

    /// Surfaces of it leave no trace in the picture: light goes straight on, and no medium begins or ends there.
    pub fn is_nothing(&self) -> bool {
        matches!(self.kind, MaterialKind::Pass) && self.interior.is_none()
    }

    /// Made of other materials.
    pub fn is_blend(&self) -> bool {
        matches!(self.kind, MaterialKind::Blend { .. })
    }

    /// The two materials of a blend, else none.
    pub fn parts(&self) -> &[MaterialId] {
        match &self.kind {
            MaterialKind::Blend { materials, .. } => materials,
            _ => &[],
        }
    }

    /// The media in the slabs of a stack.
    pub fn media_of_slabs(&self) -> impl Iterator<Item = MediumId> + '_ {
        let slabs = match &self.kind {
            MaterialKind::Layered(layers) => layers.slabs.as_slice(),
            _ => &[],
        };
        slabs.iter().filter_map(|slab| slab.medium)
    }

    /// The materials that it is made of: of a blend its parts, of a stack its interfaces; else none.
    pub fn components(&self) -> &[MaterialId] {
        match &self.kind {
            MaterialKind::Layered(layers) => &layers.interfaces,
            _ => self.parts(),
        }
    }

    /// The material itself, not those it blends, depends on the directions in which texture coordinates grow, where there are some.
    pub fn is_anisotropic(&self) -> bool {
        match &self.kind {
            MaterialKind::RoughGlass { facets, .. } | MaterialKind::Conductor { facets, .. } => facets.alpha_v.is_some(),
            MaterialKind::Principled(principled) => principled.anisotropy.is_some(),
            _ => false,
        }
    }

    /// The material itself, not those it blends, has a coat with a normal map of its own.
    pub fn has_coat_normal_map(&self) -> bool {
        matches!(&self.kind, MaterialKind::Principled(principled) if principled.is_coated() && principled.coat_normal_map.is_some())
    }

    /// The material itself, not those it blends, looks up a texture.
    pub fn uses_texture(&self) -> bool {
        let weight = matches!(&self.kind, MaterialKind::Blend { weight, .. } if weight.uses_texture());
        let of_lobe = self.kind.lobe().is_some_and(|lobe| lobe.inputs().any(|(_, input)| input.is_texture()));
        let of_emission = self.emission.is_some_and(|emission| emission.radiance.is_texture());
        let of_layers =
            matches!(&self.kind, MaterialKind::Layered(layers) if layers.slabs.iter().any(|slab| slab.thickness.is_texture()));
        weight || of_lobe || of_emission || of_layers || self.normal_map.is_some()
    }
}
