//! Real layers.

use super::Writer;
use super::directive::{Directive, Number};
use super::made::{Made, Relief};
use crate::scene::{ConductorFresnel, LayerStack, MaterialId, MaterialKind};
use crate::scene_writer::inputs::{Colour, Scalar};

/// Optical thickness of the layer between a coat and its base, where light is lost even if nothing scatters it.
const LAYER: f64 = 1e-6;
/// Reflections between a coat and its base that are followed.
const MOST_WITHIN: i64 = 64;

impl Writer<'_> {
    /// A coat over a diffuse or a metal base where the stack is one; else the lowest interface stands for all.
    pub fn stack(&mut self, id: MaterialId, layers: &LayerStack, relief: Option<Relief>) -> Made {
        let place = self.place_of(id);
        let Some(&base) = layers.interfaces.last() else { return Made::nothing() };
        let scene = self.scene;
        if let [coat, base] = layers.interfaces[..]
            && let Some((ior, alphas)) = self.coat(&scene.materials[coat].kind, &place)
            && let Some(directive) = self.coated_base(&scene.materials[base].kind, ior, alphas, &place)
        {
            let slab = layers.slabs.first();
            if slab.is_some_and(|slab| slab.medium.is_some()) {
                self.drop("medium between two layers", &place, "nothing is between them");
            }
            self.approximate("material of type `layered`", &place, "a coated surface is taken");
            let wanted = self.materials.get(id).to_owned();
            return Made::opaque(self.define(&wanted, directive, relief, &place));
        }
        self.approximate("material of type `layered`", &place, "its lowest interface alone is there");
        self.material(base, relief)
    }

    /// The index of refraction and the microfacets of an interface that is a dielectric one.
    fn coat(&mut self, kind: &MaterialKind, place: &str) -> Option<(f64, [Number; 2])> {
        match kind {
            MaterialKind::Glass { ior, thin: false, film: None, dispersion: None, .. } if *ior >= 1.0 => {
                Some((*ior, [Number::Constant(0.0), Number::Constant(0.0)]))
            }
            MaterialKind::RoughGlass { ior, facets, thin: false, film: None, dispersion: None, .. } if *ior >= 1.0 => {
                Some((*ior, self.alphas(facets, place)))
            }
            _ => None,
        }
    }

    fn coated_base(
        &mut self,
        kind: &MaterialKind,
        ior: f64,
        alphas: [Number; 2],
        place: &str,
    ) -> Option<Box<dyn FnOnce(Directive) -> Directive>> {
        match kind {
            MaterialKind::Diffuse { reflectance } => Some(self.coated(Colour::of(*reflectance), alphas, ior, place)),
            MaterialKind::Conductor { fresnel, facets, film: None, .. } => {
                let own = self.alphas(facets, place);
                Some(match fresnel {
                    ConductorFresnel::Complex { eta, k } => {
                        // Here they are over the coat's index, there over that of air.
                        let (eta, k) = (*eta * ior, *k * ior);
                        Box::new(move |directive| {
                            let directive =
                                directive.string("type", "coatedconductor").rgb("conductor.eta", eta).rgb("conductor.k", k);
                            coat_of_metal(directive, ior, &alphas, &own)
                        })
                    }
                    ConductorFresnel::Reflectance(reflectance) => {
                        self.coated_metal(Colour::of(*reflectance), own, (ior, alphas), place)
                    }
                })
            }
            _ => None,
        }
    }

    /// A diffuse base below a dielectric surface.
    pub fn coated(
        &mut self,
        reflectance: Colour,
        alphas: [Number; 2],
        ior: f64,
        place: &str,
    ) -> Box<dyn FnOnce(Directive) -> Directive> {
        let reflectance = self.albedo(reflectance, place);
        Box::new(move |directive| {
            let directive = directive.string("type", "coateddiffuse").tint("reflectance", &reflectance);
            let directive = directive.float("eta", ior).float("thickness", LAYER).integer("maxdepth", MOST_WITHIN);
            directive.rough("", &alphas)
        })
    }

    /// A metal of that reflectance along the normal below a dielectric surface of that index of refraction.
    pub fn coated_metal(
        &mut self,
        reflectance: Colour,
        own: [Number; 2],
        (ior, alphas): (f64, [Number; 2]),
        place: &str,
    ) -> Box<dyn FnOnce(Directive) -> Directive> {
        let reflectance = self.albedo(reflectance, place);
        Box::new(move |directive| {
            let directive = directive.string("type", "coatedconductor").tint("reflectance", &reflectance);
            coat_of_metal(directive, ior, &alphas, &own)
        })
    }

    /// The width of microfacets of a roughness.
    pub fn alpha_of_roughness(&mut self, roughness: Scalar, place: &str) -> Number {
        match roughness {
            Scalar::Constant(roughness) => Number::Constant(roughness * roughness),
            Scalar::Map(map) => {
                let square = |texel| map.of_texel(texel).powi(2);
                self.number_map(map.texture, &format!("square {map:?}"), place, &square)
            }
        }
    }
}

fn coat_of_metal(directive: Directive, ior: f64, alphas: &[Number; 2], own: &[Number; 2]) -> Directive {
    let directive = directive.float("interface.eta", ior).rough("interface.", alphas);
    let directive = directive.float("thickness", LAYER).integer("maxdepth", MOST_WITHIN);
    directive.rough("conductor.", own)
}
