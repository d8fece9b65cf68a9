//! The material of glTF: mixtures of a metal, a dielectric, and a coated diffuse surface.

use super::Writer;
use super::directive::{Directive, Number};
use super::glass::Glass;
use super::made::{Made, Relief};
use crate::scene::{ColorInput, Masking, Principled};
use crate::scene_writer::inputs::{Colour, Scalar};
use crate::spectrum::Spectrum;

/// The index of refraction of a coat.
const COAT: f64 = 1.5;

impl Writer<'_> {
    pub fn principled(&mut self, principled: &Principled, wanted: &str, relief: Option<Relief>, place: &str) -> Made {
        self.report_principled(principled, place);
        let [metallic, transmission] = [principled.metallic, principled.transmission].map(Scalar::of);
        let alphas = self.alphas_of_principled(principled, place);
        let metal = if metallic.is(0.0) { None } else { Some(self.metal_of_principled(principled, alphas.clone(), place)) };
        if metallic.is(1.0)
            && let Some(metal) = metal
        {
            return Made::opaque(self.define(wanted, metal, relief, place));
        }
        let opaque = if transmission.is(1.0) { None } else { Some(self.base(principled, alphas.clone(), place)) };
        let clear = if transmission.is(0.0) {
            None
        } else {
            let Principled { ior, thin, dispersion, .. } = *principled;
            let glass = Glass { ior, thin, film: false, dispersion };
            if !Colour::of(principled.base_color).is(Spectrum::WHITE) {
                self.drop("colour of light that goes through", place, "it is white");
            }
            Some(self.glass(glass, Some(alphas), place))
        };
        let part = |of: &str| format!("{wanted}: {of}");
        let dielectric = match (opaque, clear) {
            (Some(opaque), Some(clear)) => {
                let opaque = self.define(&part("base"), opaque, relief, place);
                let clear = self.define(&part("glass"), clear, relief, place);
                let wanted = if metal.is_some() { part("dielectric") } else { wanted.to_owned() };
                self.mixture(&wanted, [opaque, clear], transmission, place)
            }
            (Some(one), None) | (None, Some(one)) => {
                let wanted = if metal.is_some() { part("dielectric") } else { wanted.to_owned() };
                self.define(&wanted, one, relief, place)
            }
            (None, None) => return Made::nothing(),
        };
        let Some(metal) = metal else { return Made::opaque(dielectric) };
        let metal = self.define(&part("metal"), metal, relief, place);
        Made::opaque(self.mixture(wanted, [dielectric, metal], metallic, place))
    }

    fn report_principled(&mut self, principled: &Principled, place: &str) {
        let instead = "a mixture of a metal, a dielectric and a coated diffuse surface is taken";
        self.approximate("material of type `principled`", place, instead);
        let zero = ColorInput::grey(0.0);
        let lost = [
            (principled.sheen_color != zero, "sheen", "there are no fibres"),
            (principled.thin_film.is_some(), "thin film", "there is no film"),
            (principled.energy_compensation, "energy_compensation", "light between microfacets is lost"),
            (!Colour::of(principled.specular_color).is(Spectrum::WHITE), "specular_color", "it is white"),
            (principled.coat_normal_map.is_some(), "normal map of a coat", "the coat lies as the rest does"),
            (principled.anisotropy_direction.is_some(), "anisotropy_direction", "microfacets are wider along u"),
            (
                principled.anisotropy.is_some() && principled.anisotropy_rotation_degrees != 0.0,
                "anisotropy_rotation",
                "microfacets are wider along u",
            ),
        ];
        for (_, what, instead) in lost.into_iter().filter(|(is_there, ..)| *is_there) {
            self.drop(what, place, instead);
        }
        if principled.is_coated() && Scalar::of(principled.metallic).is(0.0) {
            self.drop("clearcoat", place, "there is no coat");
        }
        let specular = Scalar::of(principled.specular);
        if !specular.is(1.0) && !specular.is(0.0) {
            self.drop("specular", place, "it is 1");
        }
        if principled.masking == Masking::Separable {
            self.approximate("masking = \"separable\"", place, "it is height-correlated");
        }
    }

    /// The widths of the microfacets, along u and across: glTF widens them along u by the square of the anisotropy.
    fn alphas_of_principled(&mut self, principled: &Principled, place: &str) -> [Number; 2] {
        let alpha = self.alpha_of_roughness(Scalar::of(principled.roughness), place);
        let Some(anisotropy) = principled.anisotropy.map(Scalar::of) else { return [alpha.clone(), alpha] };
        match (&alpha, anisotropy) {
            (Number::Constant(across), Scalar::Constant(anisotropy)) => {
                let along = across + (1.0 - across) * anisotropy * anisotropy;
                [Number::Constant(along), alpha]
            }
            _ => {
                self.drop("anisotropy by a texture", place, "microfacets are as wide along all directions");
                [alpha.clone(), alpha]
            }
        }
    }

    fn metal_of_principled(
        &mut self,
        principled: &Principled,
        alphas: [Number; 2],
        place: &str,
    ) -> Box<dyn FnOnce(Directive) -> Directive> {
        let reflectance = Colour::of(principled.base_color);
        if !principled.is_coated() {
            return self.metal(reflectance, alphas, place);
        }
        if !Scalar::of(principled.clearcoat).is(1.0) {
            self.approximate("clearcoat below 1", place, "the metal is coated everywhere");
        }
        let coat = self.alpha_of_roughness(Scalar::of(principled.clearcoat_roughness), place);
        self.coated_metal(reflectance, alphas, (COAT, [coat.clone(), coat]), place)
    }

    /// The dielectric that lets no light through.
    fn base(&mut self, principled: &Principled, alphas: [Number; 2], place: &str) -> Box<dyn FnOnce(Directive) -> Directive> {
        let color = Colour::of(principled.base_color);
        match Scalar::of(principled.diffuse_transmission) {
            Scalar::Constant(0.0) => {}
            share => {
                let share = share.constant().unwrap_or_else(|| {
                    self.approximate("diffuse_transmission by a texture", place, "half of the light goes on");
                    0.5
                });
                self.approximate("reflection of a sheet that lets diffuse light through", place, "it does not reflect");
                let [reflected, passed] =
                    [color.times(1.0 - share), Colour::of(principled.diffuse_transmission_color).times(share)];
                let [reflected, passed] = [reflected, passed].map(|colour| self.albedo(colour, place));
                return Box::new(move |directive| {
                    let directive = directive.string("type", "diffusetransmission");
                    directive.tint("reflectance", &reflected).tint("transmittance", &passed)
                });
            }
        }
        if Scalar::of(principled.specular).is(0.0) || principled.ior <= 1.0 {
            return self.diffuse(color, place);
        }
        self.coated(color, alphas, principled.ior, place)
    }

    /// The second material by a share, the first by the rest.
    fn mixture(&mut self, wanted: &str, names: [String; 2], share: Scalar, place: &str) -> String {
        let amount = self.scalar(share, place);
        let [first, second] = names;
        let mix = |directive: Directive| {
            directive.string("type", "mix").strings("materials", &[&first, &second]).number("amount", &amount)
        };
        self.define(wanted, mix, None, place)
    }
}
