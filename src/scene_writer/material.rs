//! `[[material]]`

use super::value::{colour, line, number};
use super::writer::Writer;
use crate::scene::{
    BlendWeight, Channel, ChannelInput, ColorInput, ConductorFresnel, Emission, MaterialId, MaterialKind, MicrofacetDistribution,
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
            MaterialKind::Glass { ior, reflectance, transmittance } => {
                line("ior", &number(*ior)) + &input("reflectance", reflectance) + &input("transmittance", transmittance)
            }
            MaterialKind::RoughGlass { ior, alpha, distribution, reflectance, transmittance } => {
                let width = match distribution {
                    MicrofacetDistribution::Ggx => self.alpha(*alpha),
                    MicrofacetDistribution::Phong => input("exponent", alpha),
                };
                line("ior", &number(*ior)) + &width + &input("reflectance", reflectance) + &input("transmittance", transmittance)
            }
            MaterialKind::Conductor { fresnel, alpha } => {
                let fresnel = match fresnel {
                    ConductorFresnel::Complex { eta, k } => line("eta", &colour(*eta)) + &line("k", &colour(*k)),
                    ConductorFresnel::Reflectance(reflectance) => input("reflectance", reflectance),
                };
                fresnel + &self.alpha(*alpha)
            }
            MaterialKind::Blend { materials, weight } => {
                let [first, second] = materials.map(|part| self.materials.quoted(part));
                line("materials", &format!("[{first}, {second}]")) + &line("weight", &self.weight(weight))
            }
            MaterialKind::Emissive | MaterialKind::Pass => String::new(),
        }
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

fn channel_name(channel: Channel) -> &'static str {
    match channel {
        Channel::R => "r",
        Channel::G => "g",
        Channel::B => "b",
        Channel::A => "a",
    }
}
