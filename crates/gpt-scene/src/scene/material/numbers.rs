//! The numbers in parts of materials that keyframes change: all but textures, and all that is one thing or another.

use super::blend_weight::BlendWeight;
use super::dispersion::Dispersion;
use super::layers::LayerStack;
use super::microfacets::{MicrofacetDistribution, Microfacets};
use super::plastic::PlasticInterface;
use super::principled::{Attenuation, CoatNormalMap, Principled, Subsurface};
use super::table::MaterialId;
use super::thin_film::ThinFilm;
use crate::scene::texture::{ChannelInput, ColorInput};
use crate::spectrum::Spectrum;

/// A part of a material that holds numbers, or none.
pub trait Numbers {
    /// Calls this with each number, which may be changed.
    fn each_number(&mut self, _visit: &mut dyn FnMut(&mut f64)) {}
}

/// Visits several parts one after the other.
macro_rules! each {
    ($visit:ident: $($part:expr),* $(,)?) => {{ $( $part.each_number($visit); )* }};
}
pub(super) use each;

impl Numbers for bool {}

impl Numbers for [MaterialId; 2] {}

impl Numbers for f64 {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(self);
    }
}

impl Numbers for Spectrum {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let mut channels = self.to_rgb();
        channels.iter_mut().for_each(visit);
        *self = Self::new(channels[0], channels[1], channels[2]);
    }
}

impl<T: Numbers> Numbers for Option<T> {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.iter_mut().for_each(|part| part.each_number(visit));
    }
}

impl<T: Numbers> Numbers for Box<T> {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.as_mut().each_number(visit);
    }
}

impl Numbers for ColorInput {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        match self {
            Self::Constant(color) | Self::ScaledTexture(_, color) | Self::Channel(ChannelInput { factor: color, .. }) => {
                color.each_number(visit);
            }
            Self::Texture(_) | Self::SquaredTexture(_) => {}
        }
    }
}

/// A width of microfacets goes evenly in the roughness, its square root, as it is seen.
fn each_root(width: &mut ColorInput, visit: &mut dyn FnMut(&mut f64)) {
    if let ColorInput::Constant(width) = width {
        width.each_number(&mut |number| {
            let mut root = number.sqrt();
            visit(&mut root);
            *number = root * root;
        });
    }
}

impl Numbers for Microfacets {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        if self.distribution == MicrofacetDistribution::Phong {
            return self.alpha.each_number(visit);
        }
        each_root(&mut self.alpha, visit);
        self.alpha_v.iter_mut().for_each(|across| each_root(across, visit));
    }
}

impl Numbers for PlasticInterface {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        let (mut ior, mut roughness) = (self.ior, self.alpha.sqrt());
        visit(&mut ior);
        visit(&mut roughness);
        if ior != self.ior || roughness != self.alpha.sqrt() {
            *self = Self::rough(ior.max(f64::MIN_POSITIVE), roughness * roughness, self.distribution, self.masking);
        }
    }
}

impl Numbers for ThinFilm {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        each!(visit: self.thickness, self.offset, self.ior);
    }
}

impl Numbers for Dispersion {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        match self {
            Self::Abbe(number) => visit(number),
            Self::Cauchy(numbers) => numbers.iter_mut().for_each(visit),
            Self::Sellmeier { b, c } => b.iter_mut().chain(c).for_each(visit),
        }
    }
}

impl Numbers for BlendWeight {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        match self {
            Self::Constant { value } => visit(value),
            Self::Facing { power } => visit(power),
            Self::Fresnel { ior, .. } => visit(ior),
            Self::Channel { factor, .. } => visit(factor),
            Self::Reverse { of } => of.each_number(visit),
            Self::Threshold { tau, of } => {
                visit(tau);
                of.each_number(visit);
            }
            Self::Up { power, .. } => visit(power),
            Self::Open { distance, power } => each!(visit: distance, power),
            Self::Front | Self::Camera | Self::Texture { .. } => {}
        }
    }
}

impl Numbers for Principled {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        each!(
            visit: self.base_color, self.metallic, self.roughness, self.ior, self.dispersion, self.specular, self.specular_color,
            self.transmission, self.diffuse_transmission, self.diffuse_transmission_color, self.subsurface, self.attenuation,
            self.clearcoat, self.clearcoat_roughness, self.coat_normal_map, self.sheen_color, self.sheen_roughness, self.anisotropy,
            self.anisotropy_rotation_degrees, self.thin_film, self.thin_film_share,
        );
    }
}

impl Numbers for Subsurface {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        each!(visit: self.weight, self.color, self.radius, self.anisotropy);
    }
}

impl Numbers for Attenuation {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        each!(visit: self.color, self.distance);
    }
}

impl Numbers for CoatNormalMap {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        visit(&mut self.scale);
    }
}

impl Numbers for LayerStack {
    fn each_number(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        self.slabs.iter_mut().for_each(|slab| slab.thickness.each_number(visit));
    }
}
