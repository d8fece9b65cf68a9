//! Materials.

use super::Writer;
use super::directive::{Directive, Number, Tint};
use super::glass::Glass;
use super::made::{Made, Relief};
use crate::load::file::metal_symbol;
use crate::scene::{
    ColorInput, ConductorFresnel, Masking, Material, MaterialId, MaterialKind, MicrofacetDistribution, Microfacets,
};
use crate::scene_writer::inputs::{Colour, Scalar};
use crate::spectrum::Spectrum;

impl Writer<'_> {
    /// Says a material once, and all that it is made of. `relief` bends the normals of what has no map of its own.
    pub fn material(&mut self, id: MaterialId, relief: Option<Relief>) -> Made {
        if let Some(made) = self.made.get(&(id, relief)) {
            return made.clone();
        }
        let material = &self.scene.materials[id];
        let place = self.place_of(id);
        if !material.two_sided && !matches!(material.kind, MaterialKind::Emissive | MaterialKind::Pass) {
            self.approximate("two_sided = false", &place, "both sides scatter light");
        }
        let relief_of = material.normal_map.or(relief);
        let made = match &material.kind {
            MaterialKind::Pass => Made::nothing(),
            MaterialKind::Blend { materials, weight } => self.blend(id, *materials, weight, relief_of),
            MaterialKind::Layered(layers) => self.stack(id, layers, relief_of),
            MaterialKind::Principled(principled) => {
                let wanted = self.materials.get(id).to_owned();
                self.principled(principled, &wanted, relief_of, &place)
            }
            _ => {
                let directive = self.scatterer(material, &place);
                let wanted = self.materials.get(id).to_owned();
                Made::opaque(self.define(&wanted, directive, relief_of, &place))
            }
        };
        self.made.insert((id, relief), made.clone());
        made
    }

    pub fn place_of(&self, id: MaterialId) -> String {
        format!("material `{}`", self.materials.get(id))
    }

    /// Writes a material under a name like the one that is wanted; its name.
    pub fn define(
        &mut self,
        wanted: &str,
        scatterer: impl FnOnce(Directive) -> Directive,
        relief: Option<Relief>,
        place: &str,
    ) -> String {
        let name = self.free_name(wanted);
        let directive = scatterer(Directive::new("MakeNamedMaterial", &[&name]));
        let directive = match relief {
            Some(relief) => self.bent(directive, relief, place),
            None => directive,
        };
        self.push(directive);
        name
    }

    /// The parameters of a material that is one there too.
    fn scatterer(&mut self, material: &Material, place: &str) -> Box<dyn FnOnce(Directive) -> Directive> {
        match &material.kind {
            MaterialKind::Mirror { reflectance } => {
                self.approximate(
                    "mirror",
                    place,
                    "a smooth metal of that reflectance is taken, which reflects more at grazing angles",
                );
                self.metal(Colour::of(*reflectance), [Number::Constant(0.0), Number::Constant(0.0)], place)
            }
            MaterialKind::Glossy { reflectance, exponent } => {
                self.approximate("material of type `glossy`", place, "a rough metal of that reflectance is taken");
                let alpha = self.alpha_of_exponent(*exponent, place);
                self.metal(Colour::of(*reflectance), [alpha.clone(), alpha], place)
            }
            MaterialKind::Phong { diffuse, .. } => {
                self.approximate("material of type `phong`", place, "its diffuse part alone is there");
                self.diffuse(Colour::of(*diffuse), place)
            }
            MaterialKind::Dust { base, .. } => {
                self.approximate("material of type `dust`", place, "the surface below the dust alone is there");
                self.diffuse(Colour::of(*base), place)
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance } => {
                let [mut reflected, mut passed] = [*reflectance, *transmittance].map(Colour::of);
                if let (Colour::Constant(up), Colour::Constant(down)) = (reflected, passed) {
                    let most = (up + down).map(|sum| sum.max(1.0));
                    (reflected, passed) = (Colour::Constant(up / most), Colour::Constant(down / most));
                }
                let [reflected, passed] = [reflected, passed].map(|colour| self.albedo(colour, place));
                Box::new(move |directive| {
                    let directive = directive.string("type", "diffusetransmission");
                    directive.tint("reflectance", &reflected).tint("transmittance", &passed)
                })
            }
            MaterialKind::Glass { ior, reflectance, transmittance, thin, film, dispersion } => {
                let glass = Glass { ior: *ior, thin: *thin, film: film.is_some(), dispersion: *dispersion };
                self.report_tints([*reflectance, *transmittance], place);
                self.glass(glass, None, place)
            }
            MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin, film, dispersion } => {
                let glass = Glass { ior: *ior, thin: *thin, film: film.is_some(), dispersion: *dispersion };
                self.report_tints([*reflectance, *transmittance], place);
                let alphas = self.alphas(facets, place);
                self.glass(glass, Some(alphas), place)
            }
            MaterialKind::Plastic { interface, reflectance, specular_reflectance, nonlinear } => {
                let how = if *nonlinear { "light between base and surface is traced" } else { "its colour deepens within" };
                self.approximate(
                    "material of type `plastic`",
                    place,
                    format!("a coated diffuse surface is taken, in which {how}"),
                );
                if !Colour::of(*specular_reflectance).is(Spectrum::WHITE) {
                    self.drop("specular_reflectance of plastic", place, "the surface reflects as its index of refraction says");
                }
                if interface.is_rough() && interface.distribution != MicrofacetDistribution::Ggx {
                    self.approximate("distribution of microfacets", place, "it is GGX of the same width");
                }
                let alpha = Number::Constant(interface.alpha);
                self.coated(Colour::of(*reflectance), [alpha.clone(), alpha], interface.ior, place)
            }
            MaterialKind::Conductor { fresnel, facets, specular_reflectance, film } => {
                if film.is_some() {
                    self.drop("thin film", place, "there is no film");
                }
                if !Colour::of(*specular_reflectance).is(Spectrum::WHITE) {
                    self.drop("specular_reflectance of a metal", place, "it reflects as its index of refraction says");
                }
                let alphas = self.alphas(facets, place);
                match fresnel {
                    ConductorFresnel::Complex { eta, k } => self.complex_metal([*eta, *k], alphas, place),
                    ConductorFresnel::Reflectance(reflectance) => {
                        let instead = "an index of refraction that reflects so much along the normal is taken";
                        self.approximate("reflectance of a metal", place, instead);
                        self.metal(Colour::of(*reflectance), alphas, place)
                    }
                }
            }
            MaterialKind::Diffuse { reflectance } => self.diffuse(Colour::of(*reflectance), place),
            // Shapes say what an emissive one gives off; others are made of parts.
            MaterialKind::Emissive
            | MaterialKind::Principled(_)
            | MaterialKind::Blend { .. }
            | MaterialKind::Layered(_)
            | MaterialKind::Pass => self.diffuse(Colour::Constant(Spectrum::BLACK), place),
            other => {
                self.approximate(format!("material of type `{}`", other.type_name()), place, "Lambert's law is taken");
                self.diffuse(Colour::of(other.lobe().map_or(ColorInput::grey(0.0), |lobe| lobe.color0)), place)
            }
        }
    }

    pub fn diffuse(&mut self, reflectance: Colour, place: &str) -> Box<dyn FnOnce(Directive) -> Directive> {
        let reflectance = self.albedo(reflectance, place);
        Box::new(move |directive| directive.string("type", "diffuse").tint("reflectance", &reflectance))
    }

    /// A metal by its reflectance along the normal.
    pub fn metal(&mut self, reflectance: Colour, alphas: [Number; 2], place: &str) -> Box<dyn FnOnce(Directive) -> Directive> {
        let reflectance = self.albedo(reflectance, place);
        Box::new(move |directive| directive.string("type", "conductor").tint("reflectance", &reflectance).rough("", &alphas))
    }

    fn complex_metal(
        &mut self,
        [eta, k]: [Spectrum; 2],
        alphas: [Number; 2],
        place: &str,
    ) -> Box<dyn FnOnce(Directive) -> Directive> {
        let known = metal_symbol(eta, k);
        match known {
            Some(_) => self.approximate("metal by name", place, "pbrt has its spectrum, and not three numbers"),
            None => {
                self.approximate("index of refraction of a metal", place, "it is a smooth spectrum through its three colours")
            }
        }
        Box::new(move |directive| {
            let directive = directive.string("type", "conductor");
            let directive = match known {
                Some(name) => {
                    let directive = directive.named_spectrum("eta", &format!("metal-{name}-eta"));
                    directive.named_spectrum("k", &format!("metal-{name}-k"))
                }
                None => directive.rgb("eta", eta).rgb("k", k),
            };
            directive.rough("", &alphas)
        })
    }

    /// The widths of microfacets, along u and across.
    pub fn alphas(&mut self, facets: &Microfacets, place: &str) -> [Number; 2] {
        if facets.distribution == MicrofacetDistribution::Phong {
            self.approximate("Phong's distribution of microfacets", place, "it is GGX of about the same width");
            let alpha = self.alpha_of_exponent(facets.alpha, place);
            return [alpha.clone(), alpha];
        }
        if !facets.are_smooth() {
            if facets.distribution != MicrofacetDistribution::Ggx {
                self.approximate("distribution of microfacets", place, "it is GGX of the same width");
            }
            if facets.masking != Masking::HeightCorrelated {
                self.approximate("masking = \"separable\"", place, "it is height-correlated");
            }
        }
        let along = self.scalar(Scalar::of(facets.alpha), place);
        let across = facets.alpha_v.map(|alpha| self.scalar(Scalar::of(alpha), place));
        [along.clone(), across.unwrap_or(along)]
    }

    /// The width of microfacets that reflect about as a power of a cosine does.
    fn alpha_of_exponent(&mut self, exponent: ColorInput, place: &str) -> Number {
        let alpha = |exponent: f64| (2.0 / (exponent.max(0.0) + 2.0)).sqrt();
        match Scalar::of(exponent) {
            Scalar::Constant(exponent) => Number::Constant(alpha(exponent)),
            Scalar::Map(map) => self.number_map(map.texture, "alpha of exponent", place, &|texel| alpha(map.of_texel(texel))),
        }
    }

    fn report_tints(&mut self, [reflectance, transmittance]: [ColorInput; 2], place: &str) {
        for (input, what) in [(reflectance, "reflectance of glass"), (transmittance, "transmittance of glass")] {
            if !Colour::of(input).is(Spectrum::WHITE) {
                self.drop(what, place, "it is white");
            }
        }
    }

    /// A colour from 0 to 1 in all channels.
    pub fn albedo(&mut self, colour: Colour, place: &str) -> Tint {
        match colour {
            Colour::Constant(value) => {
                let possible = value.clamp(Spectrum::BLACK, Spectrum::WHITE);
                if possible != value {
                    self.approximate("reflectance beyond 1", place, "1 is taken");
                }
                Tint::Constant(possible)
            }
            Colour::Map(map) => self.tint_map(map, place),
        }
    }
}
