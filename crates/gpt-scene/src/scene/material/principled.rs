//! The material of glTF 2.0's Appendix B.

use crate::spectrum::Spectrum;

use super::dispersion::{Dispersion, iors};
use super::microfacets::Masking;
use super::thin_film::ThinFilm;
use crate::scene::medium::{Medium, Phase, PhaseKind};
use crate::scene::texture::{ColorInput, TextureId};

/// Largest share of the base's samples that the surface's reflection takes: facets that are turned away from the normal let
/// more through.
pub const MOST_REFLECTED: f64 = 0.95;
/// Least share of samples of a reflection that there is: other facets reflect more than one along the normal.
pub const LEAST_REFLECTED: f64 = 0.02;
/// Share of all light that white fibres reflect, about.
pub const SHEEN_WEIGHT: f64 = 0.1;
/// Reflectance of the coat along its normal: that of a film of refractive index 1.5.
pub const COAT_REFLECTANCE: f64 = 0.04;

/// The parameters of glTF 2.0's metallic-roughness material and of its extensions. Scalars are the first channel of their colour.
#[derive(Debug, Clone, PartialEq)]
pub struct Principled {
    pub base_color: ColorInput,
    pub metallic: ColorInput,
    /// Its square is the width of the microfacets.
    pub roughness: ColorInput,
    /// The index of refraction of the dielectric, inside over outside.
    pub ior: f64,
    /// The way in which it depends on the wavelength where light goes through; None: all channels are refracted alike.
    pub dispersion: Option<Dispersion>,
    /// Factor of what the dielectric reflects, and its colour along the normal.
    pub specular: ColorInput,
    pub specular_color: ColorInput,
    /// Share of the dielectric's base that lets light through instead of scattering it back.
    pub transmission: ColorInput,
    /// Share of the diffuse base that sends light on to the other side instead of back, and the colour by which it does.
    pub diffuse_transmission: ColorInput,
    pub diffuse_transmission_color: ColorInput,
    /// Light that enters the body and is scattered there, in place of what the base lets through.
    pub subsurface: Option<Subsurface>,
    /// True for a wall without thickness, which lets light through without bending it.
    pub thin: bool,
    /// The attenuation behind the surface; None where nothing takes light.
    pub attenuation: Option<Attenuation>,
    pub clearcoat: ColorInput,
    pub clearcoat_roughness: ColorInput,
    /// Bends the coat's own normal. None: the coat lies as the surface does, whatever bends the normals of what is below it.
    pub coat_normal_map: Option<CoatNormalMap>,
    /// Colour of the fibres that stand on the surface, and the root of the width of their distribution.
    pub sheen_color: ColorInput,
    pub sheen_roughness: ColorInput,
    /// How much wider microfacets are along the direction of the anisotropy, by the square; None: not at all.
    pub anisotropy: Option<ColorInput>,
    /// Red and green times 2 minus 1 are that direction: along the one in which texture coordinate u grows, and across it towards that of v. Its
    /// colour space is linear. None: along u.
    pub anisotropy_direction: Option<TextureId>,
    /// The angle of that direction, from the one in which texture coordinate u grows towards that of v.
    pub anisotropy_rotation_degrees: f64,
    /// A film on the surface, below the coat and the fibres, and the share of the surface that it covers.
    pub thin_film: Option<ThinFilm>,
    pub thin_film_share: ColorInput,
    pub masking: Masking,
    /// Light that microfacets send to each other is not lost.
    pub energy_compensation: bool,
}

/// Scattering below a surface (OpenPBR 1.1, "Subsurface"): light is refracted as it enters the body and as it leaves it, and scattered by the medium
/// within.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subsurface {
    /// Share of the dielectric's base that lets light in instead of scattering it back.
    pub weight: ColorInput,
    /// Share of light that comes back from a deep body whose boundary does not reflect.
    pub color: Spectrum,
    /// Mean free path in scene units.
    pub radius: Spectrum,
    /// Mean cosine between the directions before and after light is scattered.
    pub anisotropy: f64,
}

/// Tangent-space normals of a coat.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoatNormalMap {
    /// Its colour space is linear.
    pub texture: TextureId,
    /// Multiplies red and green, after they are taken from 0 to 1 to −1 to 1.
    pub scale: f64,
}

/// A volume that takes light and scatters none.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Attenuation {
    /// Share of light that is left after the distance.
    pub color: Spectrum,
    pub distance: f64,
}

impl Principled {
    /// Share of the dielectric's base that lets light through or in.
    pub fn let_through(&self) -> ColorInput {
        self.subsurface.map_or(self.transmission, |subsurface| subsurface.weight)
    }

    /// The indices of refraction of the channels, where they are not alike.
    pub fn iors(&self) -> Option<Spectrum> {
        let lets_through = self.let_through() != ColorInput::grey(0.0);
        self.dispersion.filter(|_| lets_through && !self.thin).map(|dispersion| iors(self.ior, Some(dispersion)))
    }

    /// Some of it may be coated.
    pub fn is_coated(&self) -> bool {
        self.clearcoat != ColorInput::grey(0.0)
    }
}

impl Subsurface {
    /// The medium within the body. Its albedo is that of which a deep body sends the colour back: van de Hulst's relation, inverted as OpenPBR 1.1 has
    /// it.
    pub fn medium(&self) -> Medium {
        let g = self.anisotropy;
        let single = |color: f64| {
            let s = 4.09712 + 4.20863 * color - (9.59217 + 41.6808 * color + 17.7126 * color * color).sqrt();
            ((1.0 - s * s) / (1.0 - g * s * s)).clamp(0.0, 1.0)
        };
        let extinction = Spectrum::WHITE / self.radius;
        let scattering = extinction * self.color.map(single);
        let phase = Phase::of(PhaseKind::HenyeyGreenstein { g });
        let name = String::new();
        Medium { name, absorption: extinction - scattering, scattering, emission: Spectrum::BLACK, phase, grids: None }
    }
}

/// Darker colours of a volume are taken for this.
const SMALLEST_ATTENUATION_COLOR: f64 = 1e-6;

impl Attenuation {
    /// Beer and Lambert's: light is left as exp(−extinction · distance).
    pub fn extinction(&self) -> Spectrum {
        let left = self.color.clamp(Spectrum::grey(SMALLEST_ATTENUATION_COLOR), Spectrum::WHITE);
        // Not −0.
        (left.map(f64::ln) / -self.distance).map(f64::abs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_that_send_all_light_back_absorb_none() {
        let of = |color: f64, anisotropy: f64| {
            let weight = ColorInput::grey(1.0);
            Subsurface { weight, color: Spectrum::grey(color), radius: Spectrum::grey(0.5), anisotropy }.medium()
        };
        for g in [-0.6, 0.0, 0.8] {
            let [white, black] = [of(1.0, g), of(0.0, g)];
            assert!(white.absorption.max_component() < 1e-4 && (white.scattering.r() - 2.0).abs() < 1e-4, "{white:?}");
            assert!(black.scattering.max_component() < 1e-4, "{black:?}");
        }
        // By the H function of Chandrasekhar 1960, a half space of albedo 0.9 sends back 0.4780 of light that comes from everywhere.
        let grey = of(0.478, 0.0);
        assert!((grey.scattering.r() / 2.0 - 0.9).abs() < 5e-3, "{grey:?}");
    }
}
