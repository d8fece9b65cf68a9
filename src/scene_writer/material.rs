//! `[[material]]`

use super::value::{colour, line, number};
use super::writer::Writer;
use crate::scene::{
    BlendWeight, Channel, ChannelInput, ColorInput, ConductorFresnel, Emission, Masking, MaterialId, MaterialKind,
    MicrofacetDistribution, Microfacets, PlasticInterface, Principled,
};

impl Writer<'_> {
    pub fn material(&self, id: MaterialId) -> String {
        let material = &self.scene.materials[id];
        let type_name = material.kind.type_name();
        let mut out = format!("\n[[material]]\nname = {}\ntype = \"{type_name}\"\n", self.materials.quoted(id));
        out += &self.kind(&material.kind);
        if let Some(texture) = material.normal_map {
            out += &line("normal_map", &self.textures.quoted(texture));
        }
        let emits = matches!(material.kind, MaterialKind::Emissive);
        match material.emission {
            Some(Emission { radiance, two_sided }) => {
                let [radiance_key, sides_key] =
                    if emits { ["radiance", "two_sided"] } else { ["emission", "emission_two_sided"] };
                out += &line(radiance_key, &self.input(radiance));
                if two_sided {
                    out += &line(sides_key, "true");
                }
            }
            None if emits => out += &line("radiance", "0"),
            None => {}
        }
        if !material.two_sided {
            out += &line("two_sided", "false");
        }
        out
    }

    /// The keys of the type alone.
    fn kind(&self, kind: &MaterialKind) -> String {
        let input = |key: &str, input: &ColorInput| line(key, &self.input(*input));
        match kind {
            MaterialKind::Diffuse { reflectance } | MaterialKind::Mirror { reflectance } => input("reflectance", reflectance),
            MaterialKind::Glossy { reflectance, exponent } => input("reflectance", reflectance) + &input("exponent", exponent),
            MaterialKind::Phong { diffuse, specular, exponent } => {
                input("diffuse", diffuse) + &input("specular", specular) + &input("exponent", exponent)
            }
            MaterialKind::Glass { ior, reflectance, transmittance, thin } => {
                let tints = input("reflectance", reflectance) + &input("transmittance", transmittance);
                line("ior", &number(*ior)) + &tints + thin_line(*thin)
            }
            MaterialKind::RoughGlass { ior, facets, reflectance, transmittance, thin } => {
                let tints = input("reflectance", reflectance) + &input("transmittance", transmittance);
                line("ior", &number(*ior)) + &self.facets(facets) + &tints + thin_line(*thin)
            }
            MaterialKind::Plastic { interface, reflectance, specular_reflectance, nonlinear } => {
                let colours = input("reflectance", reflectance) + &input("specular_reflectance", specular_reflectance);
                let nonlinear = if *nonlinear { line("nonlinear", "true") } else { String::new() };
                self.interface(interface) + &colours + &nonlinear
            }
            MaterialKind::Principled(principled) => self.principled(principled),
            MaterialKind::Conductor { fresnel, facets, specular_reflectance } => {
                let fresnel = match fresnel {
                    ConductorFresnel::Complex { eta, k } => line("eta", &colour(*eta)) + &line("k", &colour(*k)),
                    ConductorFresnel::Reflectance(reflectance) => input("reflectance", reflectance),
                };
                let factor = match *specular_reflectance == ColorInput::grey(1.0) {
                    true => String::new(),
                    false => input("specular_reflectance", specular_reflectance),
                };
                let is_smooth = *facets == Microfacets::ggx(ColorInput::grey(0.0));
                fresnel + &if is_smooth { line("alpha", "0") } else { self.facets(facets) } + &factor
            }
            MaterialKind::Blend { materials, weight } => {
                let [first, second] = materials.map(|part| self.materials.quoted(part));
                line("materials", &format!("[{first}, {second}]")) + &line("weight", &self.weight(weight))
            }
            MaterialKind::Emissive | MaterialKind::Pass => String::new(),
        }
    }

    /// Widths, distribution and masking of microfacets, or the exponent of Phong's distribution.
    fn facets(&self, facets: &Microfacets) -> String {
        let Microfacets { alpha, alpha_v, distribution, masking } = *facets;
        if distribution == MicrofacetDistribution::Phong {
            return line("exponent", &self.input(alpha));
        }
        let widths = match alpha_v {
            None => self.alpha(alpha),
            Some(across) if alpha.is_squared() || across.is_squared() => {
                line("roughness_u", &self.roughness(alpha)) + &line("roughness_v", &self.roughness(across))
            }
            Some(across) => line("alpha_u", &self.input(alpha)) + &line("alpha_v", &self.input(across)),
        };
        widths + &distribution_line(distribution) + &masking_line(masking)
    }

    /// The root of a width.
    fn roughness(&self, alpha: ColorInput) -> String {
        match alpha {
            ColorInput::Constant(value) => colour(value.map(f64::sqrt)),
            other => self.input(other),
        }
    }

    fn interface(&self, interface: &PlasticInterface) -> String {
        let ior = line("ior", &number(interface.ior));
        if !interface.is_rough() {
            return ior;
        }
        let rough = distribution_line(interface.distribution) + &masking_line(interface.masking);
        ior + &line("alpha", &number(interface.alpha)) + &rough
    }

    fn principled(&self, principled: &Principled) -> String {
        let input = |key: &str, input: &ColorInput| line(key, &self.input(*input));
        let mut out = input("base_color", &principled.base_color)
            + &input("metallic", &principled.metallic)
            + &input("roughness", &principled.roughness)
            + &line("ior", &number(principled.ior))
            + &input("specular", &principled.specular)
            + &input("specular_color", &principled.specular_color)
            + &input("transmission", &principled.transmission)
            + thin_line(principled.thin)
            + &input("clearcoat", &principled.clearcoat)
            + &input("clearcoat_roughness", &principled.clearcoat_roughness);
        if let Some(anisotropy) = &principled.anisotropy {
            out += &input("anisotropy", anisotropy);
            out += &line("anisotropy_rotation", &number(principled.anisotropy_rotation_degrees));
        }
        if principled.masking == Masking::HeightCorrelated {
            out += &line("masking", "\"height_correlated\"");
        }
        out
    }

    /// A width of microfacets: the square of a texture is what `roughness` means.
    fn alpha(&self, alpha: ColorInput) -> String {
        match alpha {
            ColorInput::SquaredTexture(id) => line("roughness", &self.input(ColorInput::Texture(id))),
            ColorInput::Channel(input) if input.is_squared => line("roughness", &self.input(alpha)),
            other => line("alpha", &self.input(other)),
        }
    }

    fn input(&self, input: ColorInput) -> String {
        match input {
            ColorInput::Constant(value) => colour(value),
            ColorInput::Texture(id) | ColorInput::SquaredTexture(id) => format!("{{ texture = {} }}", self.textures.quoted(id)),
            ColorInput::ScaledTexture(id, scale) => {
                format!("{{ texture = {}, factor = {} }}", self.textures.quoted(id), colour(scale))
            }
            ColorInput::Channel(ChannelInput { texture, channel, factor, .. }) => format!(
                "{{ texture = {}, channel = \"{}\", factor = {} }}",
                self.textures.quoted(texture),
                channel_name(channel),
                colour(factor)
            ),
        }
    }

    fn weight(&self, weight: &BlendWeight) -> String {
        match weight {
            BlendWeight::Constant { value } => format!("{{ type = \"constant\", value = {} }}", number(*value)),
            BlendWeight::Facing { power } => format!("{{ type = \"facing\", power = {} }}", number(*power)),
            BlendWeight::Fresnel { ior, exact } => format!("{{ type = \"fresnel\", ior = {}, exact = {exact} }}", number(*ior)),
            BlendWeight::Texture { texture } => format!("{{ type = \"texture\", texture = {} }}", self.textures.quoted(*texture)),
            BlendWeight::Channel { texture, channel, factor } => format!(
                "{{ type = \"texture\", texture = {}, channel = \"{}\", factor = {} }}",
                self.textures.quoted(*texture),
                channel_name(*channel),
                number(*factor)
            ),
            BlendWeight::Reverse { of } => format!("{{ type = \"reverse\", of = {} }}", self.weight(of)),
            BlendWeight::Threshold { tau, of } => {
                format!("{{ type = \"threshold\", tau = {}, of = {} }}", number(*tau), self.weight(of))
            }
        }
    }
}

fn thin_line(thin: bool) -> &'static str {
    if thin { "thin = true\n" } else { "" }
}

/// Nothing where it is what is meant without the key.
fn distribution_line(distribution: MicrofacetDistribution) -> String {
    match distribution {
        MicrofacetDistribution::Beckmann => line("distribution", "\"beckmann\""),
        MicrofacetDistribution::Ggx | MicrofacetDistribution::Phong => String::new(),
    }
}

/// The same.
fn masking_line(masking: Masking) -> String {
    match masking {
        Masking::Separable => line("masking", "\"separable\""),
        Masking::HeightCorrelated => String::new(),
    }
}

fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::R => "r",
        Channel::G => "g",
        Channel::B => "b",
        Channel::A => "a",
    }
}
