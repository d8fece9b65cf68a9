//! For each type of material the principled one that is nearest.

use super::Writer;
use crate::scene::texture::mean_of_channel;
use crate::scene::{
    ChannelInput, ColorInput, ConductorFresnel, LayerStack, Masking, MaterialKind, MicrofacetDistribution, Microfacets,
    Principled,
};
use crate::scene_writer::inputs::{Colour, Scalar};
use crate::spectrum::Spectrum;

/// Indices of refraction that glTF's readers take.
const IORS: [f64; 2] = [1.0, 10.0];

const ZERO: ColorInput = ColorInput::Constant(Spectrum::BLACK);
const ONE: ColorInput = ColorInput::Constant(Spectrum::WHITE);

/// The material of which the file says nothing but that it is no metal.
pub fn plain() -> Principled {
    Principled {
        base_color: ONE,
        metallic: ZERO,
        roughness: ONE,
        ior: 1.5,
        dispersion: None,
        specular: ONE,
        specular_color: ONE,
        transmission: ZERO,
        diffuse_transmission: ZERO,
        diffuse_transmission_color: ONE,
        subsurface: None,
        thin: false,
        attenuation: None,
        clearcoat: ZERO,
        clearcoat_roughness: ZERO,
        coat_normal_map: None,
        sheen_color: ZERO,
        sheen_roughness: ZERO,
        anisotropy: None,
        anisotropy_direction: None,
        anisotropy_rotation_degrees: 0.0,
        thin_film: None,
        thin_film_share: ONE,
        masking: Masking::Separable,
        energy_compensation: false,
    }
}

/// Lambert's law alone.
fn diffuse(reflectance: ColorInput) -> Principled {
    Principled { base_color: reflectance, specular: ZERO, ..plain() }
}

impl Writer<'_> {
    /// The principled material for a type that scatters light by itself.
    pub fn nearest(&mut self, kind: &MaterialKind, place: &str) -> Principled {
        let name = format!("material of type `{}`", kind.type_name());
        let mut near = |instead: &str| self.approximate(name.clone(), place, instead);
        match kind {
            MaterialKind::Diffuse { reflectance } => diffuse(*reflectance),
            MaterialKind::Emissive | MaterialKind::Blend { .. } | MaterialKind::Pass => diffuse(ZERO),
            MaterialKind::Dust { base, .. } => {
                near("the surface below the dust alone is there");
                diffuse(*base)
            }
            MaterialKind::Phong { diffuse: base, specular, exponent } => {
                near("a rough dielectric is taken");
                let roughness = self.roughness_of_exponent(*exponent, place);
                let specular_color = over_reflectance(*specular, 1.5);
                Principled { base_color: *base, roughness, specular_color, ..plain() }
            }
            MaterialKind::Glossy { reflectance, exponent } => {
                near("a rough metal is taken");
                let roughness = self.roughness_of_exponent(*exponent, place);
                Principled { base_color: *reflectance, metallic: ONE, roughness, ..plain() }
            }
            MaterialKind::Mirror { reflectance } => {
                near("a smooth metal is taken, which reflects more at grazing angles");
                Principled { base_color: *reflectance, metallic: ONE, roughness: ZERO, ..plain() }
            }
            MaterialKind::DiffuseTransmission { reflectance, transmittance } => self.sheet(*reflectance, *transmittance, place),
            MaterialKind::Glass { ior, reflectance, transmittance, thin, film, dispersion } => {
                near("a principled dielectric is taken");
                let glass = Principled {
                    base_color: *transmittance,
                    specular_color: *reflectance,
                    roughness: ZERO,
                    transmission: ONE,
                    ior: self.possible_ior(*ior, place),
                    dispersion: *dispersion,
                    thin: *thin,
                    ..plain()
                };
                Principled { thin_film: *film, ..glass }
            }
            MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin, film, dispersion } => {
                near("a principled dielectric is taken");
                let ior = self.possible_ior(*ior, place);
                let glass = Principled {
                    base_color: *transmittance,
                    specular_color: *reflectance,
                    transmission: ONE,
                    ior,
                    dispersion: *dispersion,
                    thin: *thin,
                    thin_film: *film,
                    ..plain()
                };
                self.with_facets(glass, facets, place)
            }
            MaterialKind::Plastic { interface, reflectance, specular_reflectance, .. } => {
                near("a principled dielectric is taken, which lets less light through to its base");
                Principled {
                    base_color: *reflectance,
                    specular_color: *specular_reflectance,
                    roughness: ColorInput::grey(interface.alpha.sqrt()),
                    ior: self.possible_ior(interface.ior, place),
                    ..plain()
                }
            }
            MaterialKind::Conductor { fresnel, facets, specular_reflectance, film } => {
                near("a principled metal is taken");
                let base_color = match fresnel {
                    ConductorFresnel::Reflectance(reflectance) => *reflectance,
                    ConductorFresnel::Complex { eta, k } => ColorInput::Constant(normal_reflectance(*eta, *k)),
                };
                if !Colour::of(*specular_reflectance).is(Spectrum::WHITE) {
                    self.drop("specular_reflectance of a metal", place, "it reflects as it does by itself");
                }
                let metal = Principled { base_color, metallic: ONE, thin_film: *film, ..plain() };
                self.with_facets(metal, facets, place)
            }
            MaterialKind::Principled(principled) => {
                if principled.masking == Masking::HeightCorrelated {
                    self.approximate("masking = \"height_correlated\"", place, "glTF leaves it to its readers");
                }
                if principled.energy_compensation {
                    self.drop("energy_compensation", place, "light between microfacets is lost");
                }
                (**principled).clone()
            }
            MaterialKind::Layered(layers) => {
                near("a principled surface is taken");
                self.stack(layers, place)
            }
            other => {
                near("Lambert's law is taken");
                diffuse(other.lobe().map_or(ZERO, |lobe| lobe.color0))
            }
        }
    }

    /// The lowest interface below the coat that the highest one is, if it is a dielectric.
    fn stack(&mut self, LayerStack { interfaces, .. }: &LayerStack, place: &str) -> Principled {
        let scene = self.scene;
        let (Some(&top), Some(&base)) = (interfaces.first(), interfaces.last()) else { return diffuse(ZERO) };
        let base = match &scene.materials[base].kind {
            // A stack or a blend within the stack.
            MaterialKind::Layered(_) | MaterialKind::Blend { .. } | MaterialKind::Pass => diffuse(ZERO),
            kind => self.nearest(kind, place),
        };
        let roughness = match &scene.materials[top].kind {
            _ if interfaces.len() < 2 => return base,
            MaterialKind::Glass { .. } => ZERO,
            MaterialKind::RoughGlass { facets, .. } => self.roughness(facets.alpha, place),
            _ => return base,
        };
        Principled { clearcoat: ONE, clearcoat_roughness: roughness, ..base }
    }

    /// A sheet that scatters light diffusely to both sides.
    fn sheet(&mut self, reflectance: ColorInput, transmittance: ColorInput, place: &str) -> Principled {
        let [up, down] = [reflectance, transmittance].map(|input| Colour::of(input).constant());
        let (share, [up, down]) = match (up, down) {
            (Some(up), Some(down)) => {
                // A sum of more than 1 divides both.
                let most = (up + down).map(|sum| sum.max(1.0));
                let (up, down) = (up / most, down / most);
                let [largest_up, largest_down] = [up, down].map(Spectrum::max_component);
                let sum = largest_up + largest_down;
                let share = if sum > 0.0 { largest_down / sum } else { 0.0 };
                let part = |color: Spectrum, share: f64| if share > 0.0 { color / share } else { Spectrum::BLACK };
                (share, [ColorInput::Constant(part(up, 1.0 - share)), ColorInput::Constant(part(down, share))])
            }
            _ => (0.5, [reflectance, transmittance].map(|input| input.scaled(Spectrum::grey(2.0)))),
        };
        if let (ColorInput::Constant(up), ColorInput::Constant(down)) = (up, down)
            && up.max(down).max_component() > 1.0 + 1e-9
        {
            self.approximate("sheet that scatters more of one colour", place, "it scatters no more than all light");
        }
        Principled { diffuse_transmission: ColorInput::grey(share), diffuse_transmission_color: down, ..diffuse(up) }
    }

    fn with_facets(&mut self, surface: Principled, facets: &Microfacets, place: &str) -> Principled {
        if facets.distribution == MicrofacetDistribution::Phong {
            return Principled { roughness: self.roughness_of_exponent(facets.alpha, place), ..surface };
        }
        let Some(across) = facets.alpha_v else {
            return Principled { roughness: self.roughness(facets.alpha, place), ..surface };
        };
        let (Some(along), Some(across)) = (Scalar::of(facets.alpha).constant(), Scalar::of(across).constant()) else {
            self.drop("two widths of microfacets by textures", place, "they are as wide along all directions");
            return Principled { roughness: self.roughness(facets.alpha, place), ..surface };
        };
        // The narrower one is that of the roughness; the other is wider by the square of the anisotropy.
        let (narrow, wide, rotation) = if along >= across { (across, along, 0.0) } else { (along, across, 90.0) };
        let anisotropy = if narrow < 1.0 { ((wide - narrow) / (1.0 - narrow)).max(0.0).sqrt() } else { 0.0 };
        Principled {
            roughness: ColorInput::grey(narrow.sqrt()),
            anisotropy: (anisotropy > 0.0).then(|| ColorInput::grey(anisotropy)),
            anisotropy_rotation_degrees: rotation,
            ..surface
        }
    }

    /// The root of a width.
    fn roughness(&mut self, alpha: ColorInput, place: &str) -> ColorInput {
        match alpha {
            ColorInput::Constant(alpha) => ColorInput::grey(alpha.r().max(0.0).sqrt().min(1.0)),
            ColorInput::SquaredTexture(texture) => ColorInput::Texture(texture),
            ColorInput::Channel(input) if input.is_squared => ColorInput::Channel(ChannelInput { is_squared: false, ..input }),
            ColorInput::Texture(_) | ColorInput::ScaledTexture(..) | ColorInput::Channel(_) => {
                self.approximate("texture of the width of microfacets", place, "the root of its mean is taken");
                let Scalar::Map(map) = Scalar::of(alpha) else { return ONE };
                let mean = mean_of_channel(&self.scene.textures, map.texture, map.channel);
                ColorInput::grey((mean * map.factor).max(0.0).sqrt().min(1.0))
            }
        }
    }

    /// The roughness of microfacets that reflect about as a power of a cosine does.
    fn roughness_of_exponent(&mut self, exponent: ColorInput, place: &str) -> ColorInput {
        let exponent = match Scalar::of(exponent) {
            Scalar::Constant(exponent) => exponent,
            Scalar::Map(map) => {
                self.approximate("exponent by a texture", place, "its mean is taken");
                mean_of_channel(&self.scene.textures, map.texture, map.channel) * map.factor
            }
        };
        ColorInput::grey((2.0 / (exponent.max(0.0) + 2.0)).powf(0.25))
    }

    fn possible_ior(&mut self, ior: f64, place: &str) -> f64 {
        let possible = ior.clamp(IORS[0], IORS[1]);
        if possible != ior {
            self.approximate("index of refraction beyond 1 to 10", place, "the nearest possible one is taken");
        }
        possible
    }
}

/// The colour of reflection of a dielectric that reflects so much along the normal.
fn over_reflectance(reflected: ColorInput, ior: f64) -> ColorInput {
    let own = ((ior - 1.0) / (ior + 1.0)).powi(2);
    reflected.scaled(Spectrum::grey(1.0 / own))
}

/// The reflectance along the normal of a metal.
fn normal_reflectance(eta: Spectrum, k: Spectrum) -> Spectrum {
    let one = Spectrum::WHITE;
    ((eta - one) * (eta - one) + k * k) / ((eta + one) * (eta + one) + k * k)
}
