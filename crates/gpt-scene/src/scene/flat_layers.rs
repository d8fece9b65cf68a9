//! The interfaces of a scene's stacks, one after the other, and the rules that they keep.

use super::material::{
    BlendWeight, LobeSupport, MOST_INTERFACES, Material, MaterialId, MaterialKind, MicrofacetDistribution, Microfacets, Slab,
};
use super::medium::MediumId;
use super::model::Scene;
use super::texture::ColorInput;

/// One interface of a stack without stacks in it, and the slab below it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlatLayer {
    pub interface: MaterialId,
    /// Nothing below the last interface.
    pub slab: Slab,
    /// How widely the interface scatters at most, from 0, single directions, to 1, evenly.
    pub breadth: f64,
    /// How widely the slab scatters; 0 where it does not.
    pub slab_breadth: f64,
    /// Index of refraction below it over that above it, by which smooth surfaces would bend light; 1 where light is not bent.
    pub ior: f64,
}

impl Scene {
    /// The interfaces of a stack, those of stacks in it in their places. None of a material that is no stack.
    ///
    /// # Errors
    /// A sentence about a stack that has too many interfaces, as one has that is within itself.
    #[doc(hidden)]
    pub fn flat_layers(&self, material: MaterialId) -> Result<Option<Vec<FlatLayer>>, String> {
        let MaterialKind::Layered(_) = &self.materials[material].kind else { return Ok(None) };
        let mut flat: Vec<FlatLayer> = Vec::new();
        let mut to_visit = vec![(material, Slab::NOTHING)];
        let mut visited = 0;
        while let Some((id, below)) = to_visit.pop() {
            visited += 1;
            if visited > 2 * MOST_INTERFACES || flat.len() >= MOST_INTERFACES {
                return Err(format!("`{}` has more than {MOST_INTERFACES} interfaces", self.materials[material].name));
            }
            match &self.materials[id].kind {
                MaterialKind::Layered(layers) => {
                    let slabs = layers.slabs.iter().copied().chain([below]);
                    let own: Vec<_> = layers.interfaces.iter().copied().zip(slabs).collect();
                    to_visit.extend(own.into_iter().rev());
                }
                _ => flat.push(self.flat_layer(id, below)),
            }
        }
        Ok(Some(flat))
    }

    fn flat_layer(&self, interface: MaterialId, slab: Slab) -> FlatLayer {
        let of_medium = |id: MediumId| {
            let medium = &self.media[id];
            let lobes = medium.phase.0.iter().filter(|lobe| lobe.weight > 0.0);
            let widest = lobes.map(|lobe| lobe.kind.evenness()).fold(0.0, f64::max);
            if medium.scattering.is_black() { 0.0 } else { widest.max(1e-3) }
        };
        FlatLayer {
            interface,
            slab,
            breadth: self.breadth(interface),
            slab_breadth: slab.medium.map_or(0.0, of_medium),
            ior: self.bend(interface),
        }
    }

    /// How widely a material that is no stack scatters at most, its smooth ways left out. A texture counts as its factor.
    fn breadth(&self, material: MaterialId) -> f64 {
        let of_input = |input: &ColorInput| match input {
            ColorInput::Constant(factor) | ColorInput::ScaledTexture(_, factor) => factor.r(),
            ColorInput::Texture(_) | ColorInput::SquaredTexture(_) | ColorInput::Channel(_) => 0.5,
        };
        let of_facets = |facets: &Microfacets| {
            if facets.are_smooth() {
                0.0
            } else if facets.distribution == MicrofacetDistribution::Phong {
                of_exponent(of_input(&facets.alpha))
            } else {
                facets.alpha_v.iter().chain([&facets.alpha]).map(of_input).fold(1e-4, f64::max).min(1.0)
            }
        };
        match &self.materials[material].kind {
            MaterialKind::Glossy { exponent, .. } => of_exponent(of_input(exponent)),
            MaterialKind::RoughGlass { facets, .. } | MaterialKind::Conductor { facets, .. } => of_facets(facets),
            MaterialKind::Principled(principled) => match principled.metallic {
                ColorInput::Constant(metallic) if metallic.r() >= 1.0 && !principled.is_coated() => {
                    of_input(&principled.roughness).powi(2).clamp(1e-4, 1.0)
                }
                _ => 1.0,
            },
            MaterialKind::Blend { materials, .. } => materials.iter().map(|&part| self.breadth(part)).fold(0.0, f64::max),
            other => match other.lobe().map(|lobe| lobe.lobe.support()) {
                None | Some(LobeSupport::Delta) => 0.0,
                Some(LobeSupport::Hemisphere | LobeSupport::Broad | LobeSupport::Sphere) => 1.0,
            },
        }
    }

    /// The index of refraction by which a smooth surface of the material would bend light; of a blend, the first of its parts'.
    fn bend(&self, material: MaterialId) -> f64 {
        match &self.materials[material].kind {
            MaterialKind::Glass { ior, thin: false, .. } | MaterialKind::RoughGlass { ior, thin: false, .. } => *ior,
            MaterialKind::Principled(principled) if !principled.thin && principled.let_through() != ColorInput::grey(0.0) => {
                principled.ior
            }
            MaterialKind::Blend { materials, .. } => {
                materials.iter().map(|&part| self.bend(part)).find(|&ior| ior != 1.0).unwrap_or(1.0)
            }
            _ => 1.0,
        }
    }

    /// A weight of the material, or of a part of it, depends on the direction.
    pub(super) fn is_blended_by_direction(&self, material: MaterialId) -> bool {
        let by_direction =
            |material: &Material| matches!(&material.kind, MaterialKind::Blend { weight, .. } if depends_on_direction(weight));
        self.any_part(material, &by_direction)
    }

    /// A sentence about a medium that cannot fill a slab.
    pub(crate) fn check_slab(&self, medium: MediumId) -> Result<(), String> {
        let medium = &self.media[medium];
        if medium.grids.is_some() || !medium.emission.is_black() {
            return Err(format!("the medium `{}` of a slab must be the same everywhere, and give off no light", medium.name));
        }
        Ok(())
    }

    /// A sentence about an interface that cannot lie in a stack.
    pub(crate) fn check_interface(&self, material: MaterialId) -> Result<(), String> {
        let mut to_visit = vec![(material, true)];
        while let Some((id, is_interface)) = to_visit.pop() {
            let part = &self.materials[id];
            if part.emission.is_some() || matches!(part.kind, MaterialKind::Emissive) {
                return Err(format!("the interface `{}` gives off light: let the stack do so", part.name));
            }
            if part.interior.is_some() {
                return Err(format!("the interface `{}` has an `interior`: what is below it is a slab", part.name));
            }
            match &part.kind {
                MaterialKind::Layered(_) if !is_interface => {
                    return Err(format!("the interface `{}` blends the stack `{}`", self.materials[material].name, part.name));
                }
                MaterialKind::Principled(principled) if principled.attenuation.is_some() || principled.subsurface.is_some() => {
                    return Err(format!("the interface `{}` has a medium of its own: what is below it is a slab", part.name));
                }
                MaterialKind::Blend { materials, weight } => {
                    let bends = materials.iter().any(|&part| self.bend(part) != 1.0);
                    if bends && depends_on_direction(weight) {
                        return Err(format!(
                            "the interface `{}` bends light and is blended by the direction that it is seen from, which is another on either side",
                            part.name
                        ));
                    }
                    to_visit.extend(materials.iter().map(|&part| (part, false)));
                }
                _ => {}
            }
        }
        Ok(())
    }
}

fn depends_on_direction(weight: &BlendWeight) -> bool {
    match weight {
        BlendWeight::Reverse { of } | BlendWeight::Threshold { of, .. } => depends_on_direction(of),
        BlendWeight::Facing { .. } | BlendWeight::Fresnel { .. } | BlendWeight::Front | BlendWeight::Up { .. } => true,
        BlendWeight::Constant { .. }
        | BlendWeight::Camera
        | BlendWeight::Open { .. }
        | BlendWeight::Texture { .. }
        | BlendWeight::Channel { .. } => false,
    }
}

/// The width of a distribution of microfacets that is about as wide as a power of a cosine.
fn of_exponent(exponent: f64) -> f64 {
    (2.0 / (exponent.max(0.0) + 2.0)).sqrt()
}
