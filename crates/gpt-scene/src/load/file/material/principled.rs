//! `type = "principled"`

use super::dispersion::{IndexKeys, Sellmeier, write_index};
use super::keys::{MaterialKeys, material_keys};
use super::roughness::MaskingEntry;
use super::thin_film::{ThinFilmKeys, write_thin_film};
use crate::load::error::SceneError;
use crate::load::file::colour::{Colour, Rgb, Scalar};
use crate::load::file::reference::TextureName;
use crate::load::file::resolver::Resolver;
use crate::load::file::value::{
    Checked, FilmIndex, Fraction, IndexOfRefraction, Located, MeanCosine, NonNegative, Number, Positive, Vector,
};
use crate::load::file::writer::{self, Writer, flag, line, number};
use crate::load::place::Place;
use crate::scene::{Attenuation, CoatNormalMap, ColorInput, Masking, MaterialKind, Principled, Subsurface};
use crate::spectrum::Spectrum;

material_keys! {
    /// The metallic-roughness material of glTF 2.0 (Appendix B) with its extensions for the index of refraction, specular, transmission,
    /// volume, dispersion, clearcoat, sheen, anisotropy, diffuse transmission and iridescence.
    #[schemars(extend("allOf" = [
        { "dependentRequired": {
            "anisotropy_rotation": ["anisotropy"],
            "anisotropy_direction": ["anisotropy"],
            "thin": ["transmission"],
            "subsurface": ["subsurface_radius"],
            "subsurface_color": ["subsurface"],
            "subsurface_radius": ["subsurface"],
            "subsurface_anisotropy": ["subsurface"],
            "clearcoat_roughness": ["clearcoat"],
            "coat_normal_map": ["clearcoat"],
            "coat_normal_scale": ["coat_normal_map"],
            "sheen_roughness": ["sheen_color"],
            "attenuation_color": ["attenuation_distance"],
            "attenuation_distance": ["attenuation_color"],
            "diffuse_transmission_color": ["diffuse_transmission"],
            "thin_film": ["thin_film_thickness"],
            "thin_film_offset": ["thin_film_thickness"],
            "thin_film_ior": ["thin_film_thickness"],
        } },
        {
            "if": { "required": ["attenuation_color"] },
            "then": { "anyOf": [{ "required": ["transmission"] }, { "required": ["diffuse_transmission"] }] },
        },
        {
            "if": { "anyOf": [{ "required": ["abbe_number"] }, { "required": ["cauchy"] }, { "required": ["sellmeier"] }] },
            "then": {
                "properties": { "thin": { "const": false } },
                "anyOf": [{ "required": ["transmission"] }, { "required": ["subsurface"] }],
            },
        },
        { "not": { "anyOf": [
            { "required": ["cauchy", "sellmeier"] }, { "required": ["cauchy", "ior"] }, { "required": ["cauchy", "abbe_number"] },
            { "required": ["sellmeier", "ior"] }, { "required": ["sellmeier", "abbe_number"] },
        ] } },
        { "not": { "required": ["subsurface", "transmission"] } },
        { "not": { "required": ["subsurface", "diffuse_transmission"] } },
        { "not": { "required": ["attenuation_color", "thin"], "properties": { "thin": { "const": true } } } },
    ]))]
    {
        /// 1 when left out.
        base_color: Option<Colour<Fraction>>,
        /// 1 when left out.
        metallic: Option<Scalar<Fraction>>,
        /// Its square is the width of the microfacets. 1 when left out.
        roughness: Option<Scalar<Fraction>>,
        /// Index of refraction of the dielectric, 1.5 when left out.
        ior: Option<Located<Checked<IndexOfRefraction>>>,
        /// Abbe's number (n_d - 1)/(n_F - n_C), with `ior` the index n_d: light of each channel that goes through is bent by an index of its own. All are bent alike when left out.
        abbe_number: Option<Located<Checked<Positive>>>,
        /// In place of `ior`: coefficients of Cauchy's formula n = A + B/λ² + C/λ⁴, λ in micrometres.
        cauchy: Option<Located<Vector>>,
        /// In place of `ior`: coefficients of Sellmeier's formula n² = 1 + Σ bᵢ·λ²/(λ² - cᵢ), λ in micrometres.
        sellmeier: Option<Located<Sellmeier>>,
        /// Factor of what the dielectric reflects, 1 when left out.
        specular: Option<Scalar<Fraction>>,
        /// Its colour along the normal, 1 when left out; above 1 it reflects more than the index of refraction says, at most all light.
        specular_color: Option<Colour<NonNegative>>,
        /// Share of light that goes through the dielectric's base instead of being scattered back; 0 when left out.
        transmission: Option<Scalar<Fraction>>,
        /// In place of `transmission`: share of light that enters the body through the dielectric's base, is scattered below the surface, and leaves elsewhere; 0 when left out.
        subsurface: Option<Box<Located<Scalar<Fraction>>>>,
        /// Share of light that comes back from below, `base_color` when left out.
        subsurface_color: Option<Box<Located<Rgb<Fraction>>>>,
        /// With `subsurface`: how far light goes below the surface on average before it is scattered or absorbed, in scene units.
        subsurface_radius: Option<Box<Located<Rgb<Positive>>>>,
        /// Mean cosine between the directions before and after it is scattered there, from -0.999 to 0.999; 0 when left out.
        subsurface_anisotropy: Option<Located<Checked<MeanCosine>>>,
        /// Share of the light that the diffuse base would scatter back and scatters on instead, behind the surface; 0 when left out.
        diffuse_transmission: Option<Box<Scalar<Fraction>>>,
        /// The colour by which it does, 1 when left out.
        diffuse_transmission_color: Option<Located<Colour<Fraction>>>,
        /// Light goes through a wall without thickness, which does not bend it.
        thin: Option<Located<bool>>,
        /// Share of light left after `attenuation_distance` within the volume that the surface encloses.
        attenuation_color: Option<Located<Rgb<Fraction>>>,
        /// In units of the world.
        attenuation_distance: Option<Located<Checked<Positive>>>,
        /// 0 when left out.
        clearcoat: Option<Scalar<Fraction>>,
        /// 0 when left out.
        clearcoat_roughness: Option<Located<Scalar<Fraction>>>,
        /// A texture of tangent-space normals of the coat, whose color_space is "linear". Without it the coat lies as the surface does, whatever `normal_map` or `bump_map` makes of what is below.
        coat_normal_map: Option<Located<TextureName>>,
        /// With `coat_normal_map`: multiplies its red and green, after they are taken from 0 to 1 to -1 to 1; 1 when left out.
        coat_normal_scale: Option<Located<Number>>,
        /// Colour of fibres that stand on the surface, as on cloth; 0 when left out.
        sheen_color: Option<Box<Colour<Fraction>>>,
        /// 0 when left out.
        sheen_roughness: Option<Located<Scalar<Fraction>>>,
        /// How much wider microfacets are along one direction. 0 when left out.
        anisotropy: Option<Box<Scalar<Fraction>>>,
        /// A texture of that direction, whose color_space is "linear": red along the direction in which texture coordinate u grows, green across it towards that of v, each from 0 to 1 for -1 to 1. Along u when left out.
        anisotropy_direction: Option<Located<TextureName>>,
        /// Degrees by which it is turned further, from the direction in which texture coordinate u grows towards that of v.
        anisotropy_rotation: Option<Located<Number>>,
        /// Share of the surface that a thin film covers, 1 when left out.
        thin_film: Option<Located<Scalar<Fraction>>>,
        /// Thickness of a film on the surface in nanometres, which makes light interfere; no film when left out.
        thin_film_thickness: Option<Located<Scalar<NonNegative>>>,
        /// Nanometres that are added to the thickness, which is that much where its texture is 0.
        thin_film_offset: Option<Located<Checked<NonNegative>>>,
        /// Index of refraction of the film over that outside, 1.3 when left out.
        thin_film_ior: Option<Located<Checked<FilmIndex>>>,
        /// "separable" when left out.
        masking: Option<MaskingEntry>,
        /// Light that microfacets send to each other is not lost, as it is in glTF; false when left out.
        energy_compensation: Option<bool>,
    }
}

impl MaterialKeys for Keys {
    const EXAMPLES: &'static [&'static str] = &[
        "base_color = [0.8, 0.4, 0.1]\nmetallic = 0\nroughness = 0.5",
        "base_color = [0.9, 0.6, 0.3]\nroughness = 0.4\nmasking = \"height_correlated\"",
        "base_color = [0.8, 0.2, 0.1]\nmetallic = 0.3\nroughness = 0.6\nclearcoat = 0.8\nclearcoat_roughness = 0.2\nspecular = 0.7\nspecular_color = [0.5, 1, 2]",
        "base_color = [0.4, 0.8, 0.9]\nmetallic = 0.2\nroughness = 0.5\ntransmission = 0.7\nior = 1.4",
        "base_color = [0.4, 0.8, 0.9]\nmetallic = 0.1\nroughness = 0.5\ntransmission = 0.8\nthin = true\nclearcoat = 0.5",
        "base_color = [0.9, 0.6, 0.3]\nmetallic = 0.8\nroughness = 0.4\nanisotropy = 0.7\nanisotropy_rotation = 30",
        "base_color = [0.4, 0.8, 0.9]\nmetallic = 0\nroughness = 0\ntransmission = 1",
        "base_color = [0.3, 0.2, 0.25]\nmetallic = 0\nroughness = 0\nclearcoat = 1",
        "base_color = [0.3, 0.05, 0.1]\nmetallic = 0\nroughness = 0.8\nsheen_color = [0.9, 0.6, 0.7]\nsheen_roughness = 0.4",
        "base_color = [0.6, 0.5, 0.4]\nmetallic = 0.2\nroughness = 0\nior = 1.1\ntransmission = 1\nclearcoat = 0.5\nclearcoat_roughness = 0.3\nsheen_color = [0.2, 0.6, 0.5]\nsheen_roughness = 0.7",
        "base_color = [0.9, 0.6, 0.3]\nroughness = 0.8\nenergy_compensation = true",
        "base_color = [0.5, 0.9, 0.6]\nmetallic = 0.4\nroughness = 0.9\nanisotropy = 0.3\nmasking = \"height_correlated\"\nenergy_compensation = true\nsheen_color = 0.5\nsheen_roughness = 1",
        "base_color = [0.9, 0.9, 1]\nmetallic = 0\nroughness = 0.2\nior = 1.3\ntransmission = 1\nattenuation_color = [0.9, 0.4, 0.1]\nattenuation_distance = 0.5",
        "base_color = [0.7, 0.5, 0.2]\nmetallic = 0.1\nroughness = 0.4\ndiffuse_transmission = 0.6\ndiffuse_transmission_color = [0.3, 0.8, 0.2]",
        "base_color = [0.7, 0.5, 0.9]\nmetallic = 0\nroughness = 0.6\nior = 1.3\ntransmission = 0.4\ndiffuse_transmission = 0.7\ndiffuse_transmission_color = [0.9, 0.6, 0.3]\nsheen_color = 0.3\nsheen_roughness = 0.5",
        "base_color = [0.8, 0.4, 0.1]\nmetallic = 0.5\nroughness = 0.3\nthin_film_thickness = 400\nthin_film = 0.8",
        "base_color = [0.4, 0.8, 0.9]\nmetallic = 0\nroughness = 0\nior = 1.4\ntransmission = 1\nthin_film_thickness = 300\nthin_film_offset = 50\nthin_film_ior = 1.6",
        "base_color = [0.9, 0.6, 0.5]\nmetallic = 0\nroughness = 0.4\nsubsurface = 0.8\nsubsurface_radius = [0.2, 0.1, 0.05]",
        "base_color = [0.9, 0.8, 0.7]\nmetallic = 0\nroughness = 0\nior = 1.7\nabbe_number = 9\ntransmission = 1\nclearcoat = 0.5",
        "base_color = [0.7, 0.8, 0.9]\nmetallic = 0.1\nroughness = 0.5\ncauchy = [1.4, 0.03, 0.002]\ntransmission = 0.8\ndiffuse_transmission = 0.3",
    ];

    fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
        self.check_unused(resolver)?;
        let scalar = |written: &Option<Scalar<Fraction>>, otherwise: f64| {
            written.as_ref().map_or(Ok(ColorInput::grey(otherwise)), |written| resolver.scalar(written))
        };
        let anisotropy = self.anisotropy.as_ref().map(|written| resolver.scalar(written)).transpose()?;
        let anisotropy_direction = self
            .anisotropy_direction
            .as_ref()
            .map(|name| resolver.texture_of_directions(name, "an anisotropy_direction"))
            .transpose()?;
        let coat_normal_map = self.coat_normal_map.as_ref().map(|name| resolver.normal_map(name)).transpose()?;
        let coat_normal_scale = self.coat_normal_scale.as_ref().map_or(1.0, |scale| scale.value.0);
        let is_isotropic = anisotropy.is_none_or(|strength| strength == ColorInput::grey(0.0));
        let clearcoat_roughness = self.clearcoat_roughness.as_ref().map(|written| resolver.scalar(&written.value)).transpose()?;
        let sheen_roughness = self.sheen_roughness.as_ref().map(|written| resolver.scalar(&written.value)).transpose()?;
        let sheen_color = self.sheen_color.as_ref().map(|written| resolver.colour(written)).transpose()?;
        let diffuse_transmission = self.diffuse_transmission.as_ref().map(|written| resolver.scalar(written)).transpose()?;
        let diffuse_transmission_color =
            self.diffuse_transmission_color.as_ref().map(|written| resolver.colour(&written.value)).transpose()?;
        let subsurface = self.subsurface(resolver)?;
        let (ior, dispersion) = self.index().resolve(resolver)?;
        let film = ThinFilmKeys {
            thickness: self.thin_film_thickness.as_ref(),
            offset: self.thin_film_offset.as_ref(),
            ior: self.thin_film_ior.as_ref(),
        };
        let thin_film_share = self.thin_film.as_ref().map(|written| resolver.scalar(&written.value)).transpose()?;
        let attenuation = self.attenuation_color.as_ref().zip(self.attenuation_distance.as_ref());
        Ok(MaterialKind::Principled(Box::new(Principled {
            base_color: resolver.colour_or_white(&self.base_color)?,
            metallic: scalar(&self.metallic, 1.0)?,
            roughness: scalar(&self.roughness, 1.0)?,
            ior,
            dispersion,
            specular: scalar(&self.specular, 1.0)?,
            specular_color: resolver.colour_or_white(&self.specular_color)?,
            transmission: scalar(&self.transmission, 0.0)?,
            diffuse_transmission: diffuse_transmission.unwrap_or(ColorInput::grey(0.0)),
            diffuse_transmission_color: diffuse_transmission_color.unwrap_or(ColorInput::grey(1.0)),
            subsurface,
            thin: self.thin.as_ref().is_some_and(|thin| thin.value),
            attenuation: attenuation
                .map(|(color, distance)| Attenuation { color: color.value.0, distance: distance.value.0 })
                .filter(|attenuation| attenuation.color != Spectrum::WHITE),
            clearcoat: scalar(&self.clearcoat, 0.0)?,
            clearcoat_roughness: clearcoat_roughness.unwrap_or(ColorInput::grey(0.0)),
            coat_normal_map: coat_normal_map.map(|texture| CoatNormalMap { texture, scale: coat_normal_scale }),
            sheen_color: sheen_color.unwrap_or(ColorInput::grey(0.0)),
            sheen_roughness: sheen_roughness.unwrap_or(ColorInput::grey(0.0)),
            anisotropy_direction: anisotropy_direction.filter(|_| !is_isotropic),
            anisotropy: anisotropy.filter(|strength| *strength != ColorInput::grey(0.0)),
            anisotropy_rotation_degrees: self.anisotropy_rotation.as_ref().map_or(0.0, |degrees| degrees.value.0),
            thin_film: film.resolve(resolver)?,
            thin_film_share: thin_film_share.unwrap_or(ColorInput::grey(1.0)),
            masking: self.masking.map_or(Masking::Separable, Masking::from),
            energy_compensation: self.energy_compensation.unwrap_or(false),
        })))
    }

    fn write(kind: &MaterialKind, writer: &Writer<'_>) -> String {
        let MaterialKind::Principled(principled) = kind else { return String::new() };
        let mut out = writer.input("base_color", &principled.base_color)
            + &writer.input("metallic", &principled.metallic)
            + &writer.input("roughness", &principled.roughness)
            + &write_index(principled.ior, principled.dispersion.as_ref())
            + &writer.input("specular", &principled.specular)
            + &writer.input("specular_color", &principled.specular_color)
            + &if principled.subsurface.is_some() {
                String::new()
            } else {
                writer.input("transmission", &principled.transmission)
            }
            + &flag("thin", principled.thin)
            + &writer.input("clearcoat", &principled.clearcoat)
            + &writer.input("clearcoat_roughness", &principled.clearcoat_roughness);
        if let Some(CoatNormalMap { texture, scale }) = principled.coat_normal_map {
            out += &line("coat_normal_map", &writer.textures.quoted(texture));
            out += &line("coat_normal_scale", &number(scale));
        }
        if let Some(Subsurface { weight, color, radius, anisotropy }) = principled.subsurface {
            out += &writer.input("subsurface", &weight);
            out += &line("subsurface_color", &writer::colour(color));
            out += &line("subsurface_radius", &writer::colour(radius));
            out += &line("subsurface_anisotropy", &number(anisotropy));
        }
        if principled.diffuse_transmission != ColorInput::grey(0.0) {
            out += &writer.input("diffuse_transmission", &principled.diffuse_transmission);
            out += &writer.input("diffuse_transmission_color", &principled.diffuse_transmission_color);
        }
        if let Some(Attenuation { color, distance }) = principled.attenuation {
            out += &line("attenuation_color", &writer::colour(color));
            out += &line("attenuation_distance", &number(distance));
        }
        if principled.sheen_color != ColorInput::grey(0.0) {
            out += &writer.input("sheen_color", &principled.sheen_color);
            out += &writer.input("sheen_roughness", &principled.sheen_roughness);
        }
        if let Some(anisotropy) = &principled.anisotropy {
            out += &writer.input("anisotropy", anisotropy);
            if let Some(texture) = principled.anisotropy_direction {
                out += &line("anisotropy_direction", &writer.textures.quoted(texture));
            }
            out += &line("anisotropy_rotation", &number(principled.anisotropy_rotation_degrees));
        }
        if principled.thin_film.is_some() {
            out += &writer.input("thin_film", &principled.thin_film_share);
            out += &write_thin_film(principled.thin_film.as_ref(), writer);
        }
        if principled.masking == Masking::HeightCorrelated {
            out += &line("masking", "\"height_correlated\"");
        }
        out + &flag("energy_compensation", principled.energy_compensation)
    }
}

impl Keys {
    fn index(&self) -> IndexKeys<'_> {
        IndexKeys {
            ior: self.ior.as_ref(),
            abbe_number: self.abbe_number.as_ref(),
            cauchy: self.cauchy.as_ref(),
            sellmeier: self.sellmeier.as_ref(),
        }
    }

    /// Nothing that is written goes without an effect.
    fn check_unused(&self, resolver: &Resolver<'_>) -> Result<(), SceneError> {
        if let (Some(attenuation), Some(thin)) = (&self.attenuation_color, &self.thin)
            && thin.value
        {
            return Err(resolver.error(&attenuation.place, "a `thin` wall encloses nothing that could take light"));
        }
        if let Some((name, place)) = self.index().place() {
            if self.thin.as_ref().is_some_and(|thin| thin.value) {
                return Err(resolver.error(place, format!("`{name}` has no effect: a `thin` wall does not bend light")));
            }
            if self.transmission.is_none() && self.subsurface.is_none() {
                return Err(resolver.error(place, format!("`{name}` needs the key `transmission` or `subsurface`")));
            }
        }
        if let Some(subsurface) = &self.subsurface {
            let others = [
                (self.transmission.is_some(), "transmission"),
                (self.diffuse_transmission.is_some(), "diffuse_transmission"),
                (self.attenuation_color.is_some(), "attenuation_color"),
                (self.thin.as_ref().is_some_and(|thin| thin.value), "thin"),
            ];
            if let Some((_, other)) = others.into_iter().find(|(is_there, _)| *is_there) {
                let message =
                    format!("a material has `subsurface` or `{other}`, not both: both say what becomes of light that goes in");
                return Err(resolver.error(&subsurface.place, message));
            }
        }
        let lets_light_in = self.transmission.is_some() || self.diffuse_transmission.is_some();
        let rows = [
            (span(&self.anisotropy_rotation), "anisotropy_rotation", self.anisotropy.is_some(), "anisotropy"),
            (span(&self.anisotropy_direction), "anisotropy_direction", self.anisotropy.is_some(), "anisotropy"),
            (boxed_span(&self.subsurface_color), "subsurface_color", self.subsurface.is_some(), "subsurface"),
            (boxed_span(&self.subsurface_radius), "subsurface_radius", self.subsurface.is_some(), "subsurface"),
            (span(&self.subsurface_anisotropy), "subsurface_anisotropy", self.subsurface.is_some(), "subsurface"),
            (boxed_span(&self.subsurface), "subsurface", self.subsurface_radius.is_some(), "subsurface_radius"),
            (span(&self.thin), "thin", self.transmission.is_some(), "transmission"),
            (span(&self.clearcoat_roughness), "clearcoat_roughness", self.clearcoat.is_some(), "clearcoat"),
            (span(&self.coat_normal_map), "coat_normal_map", self.clearcoat.is_some(), "clearcoat"),
            (span(&self.coat_normal_scale), "coat_normal_scale", self.coat_normal_map.is_some(), "coat_normal_map"),
            (span(&self.sheen_roughness), "sheen_roughness", self.sheen_color.is_some(), "sheen_color"),
            (span(&self.thin_film), "thin_film", self.thin_film_thickness.is_some(), "thin_film_thickness"),
            (span(&self.attenuation_color), "attenuation_color", lets_light_in, "transmission"),
            (
                span(&self.diffuse_transmission_color),
                "diffuse_transmission_color",
                self.diffuse_transmission.is_some(),
                "diffuse_transmission",
            ),
            (span(&self.attenuation_color), "attenuation_color", self.attenuation_distance.is_some(), "attenuation_distance"),
            (span(&self.attenuation_distance), "attenuation_distance", self.attenuation_color.is_some(), "attenuation_color"),
        ];
        let missing =
            rows.into_iter().find_map(|(span, name, is_there, needed)| Some((span.filter(|_| !is_there)?, name, needed)));
        match missing {
            Some((span, name, needed)) => Err(resolver.error(&span, format!("`{name}` needs the key `{needed}`"))),
            None => Ok(()),
        }
    }

    /// The body below the surface.
    fn subsurface(&self, resolver: &Resolver<'_>) -> Result<Option<Subsurface>, SceneError> {
        let (Some(weight), Some(radius)) = (&self.subsurface, &self.subsurface_radius) else { return Ok(None) };
        let color = match (&self.subsurface_color, resolver.colour_or_white(&self.base_color)?) {
            (Some(color), _) => color.value.0,
            (None, ColorInput::Constant(color)) => color,
            (None, _) => {
                let message =
                    "`subsurface` needs the key `subsurface_color` where `base_color` is a texture: a body has one colour";
                return Err(resolver.error(&weight.place, message));
            }
        };
        let weight = resolver.scalar(&weight.value)?;
        let anisotropy = self.subsurface_anisotropy.as_ref().map_or(0.0, |written| written.value.0);
        let is_some = weight != ColorInput::grey(0.0);
        Ok(is_some.then_some(Subsurface { weight, color, radius: radius.value.0, anisotropy }))
    }
}

/// Place of a key that is written.
fn span<T>(written: &Option<Located<T>>) -> Option<Place> {
    written.as_ref().map(|written| written.place.clone())
}

fn boxed_span<T>(written: &Option<Box<Located<T>>>) -> Option<Place> {
    written.as_ref().map(|written| written.place.clone())
}
