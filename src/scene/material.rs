//! What surfaces are made of.

use glam::DVec3;

use super::texture::ColorInput;
use super::texture::TextureId;

/// Index into [`crate::scene::Scene::materials`].
pub type MaterialId = usize;

#[derive(Debug, Clone)]
pub struct Material {
    pub name: String,
    pub kind: MaterialKind,
    /// Tangent-space normals; a texture whose colour space is linear.
    pub normal_map: Option<TextureId>,
    /// Radiance the surface sends out by itself, whatever it reflects.
    pub emission: Option<Emission>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Emission {
    pub radiance: ColorInput,
    /// Emission leaves the front only, unless this is set.
    pub two_sided: bool,
}

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

impl Material {
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

    /// The material itself, not those it blends, looks up a texture.
    pub fn uses_texture(&self) -> bool {
        let weight = matches!(&self.kind, MaterialKind::Blend { weight, .. } if weight.uses_texture());
        let own = weight || self.kind.colors().any(|input| input.is_texture());
        own || self.normal_map.is_some() || self.emission.is_some_and(|emission| emission.radiance.is_texture())
    }
}

impl BlendWeight {
    /// The weight comes from a texture at some depth.
    pub fn uses_texture(&self) -> bool {
        match self {
            Self::Texture { .. } => true,
            Self::Reverse { of } | Self::Threshold { of, .. } => of.uses_texture(),
            Self::Constant { .. } | Self::Facing { .. } | Self::Fresnel { .. } => false,
        }
    }
}

/// The weight w0 of a blend's first material.
#[derive(Debug, Clone, PartialEq)]
pub enum BlendWeight {
    Constant {
        value: f64,
    },
    /// w0 = clamp(|N·ωo|^power, 0, 1)
    Facing {
        power: f64,
    },
    /// w0 = 1 − R; R by Schlick, or by the dielectric equations where `exact`.
    Fresnel {
        ior: f64,
        exact: bool,
    },
    /// w0 = luminance of the texture.
    Texture {
        texture: TextureId,
    },
    /// w0' = 1 − w0
    Reverse {
        of: Box<BlendWeight>,
    },
    /// w0' = 1 where w0 >= tau, else 0
    Threshold {
        tau: f64,
        of: Box<BlendWeight>,
    },
}

impl MaterialKind {
    /// Every parameter that may come from a texture.
    pub fn colors(&self) -> impl Iterator<Item = ColorInput> {
        let inputs: Vec<ColorInput> = match self {
            Self::Diffuse { reflectance } | Self::Mirror { reflectance } => vec![*reflectance],
            Self::Glossy { reflectance, exponent } => vec![*reflectance, *exponent],
            Self::Phong { diffuse, specular, exponent } => vec![*diffuse, *specular, *exponent],
            Self::Glass { reflectance, transmittance, .. } => vec![*reflectance, *transmittance],
            Self::RoughGlass { alpha, reflectance, transmittance, .. } => vec![*alpha, *reflectance, *transmittance],
            Self::Conductor { fresnel: ConductorFresnel::Reflectance(reflectance), alpha } => vec![*reflectance, *alpha],
            Self::Conductor { alpha, .. } => vec![*alpha],
            Self::Emissive | Self::Blend { .. } | Self::Pass => Vec::new(),
        };
        inputs.into_iter()
    }
}
