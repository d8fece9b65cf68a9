//! How surfaces scatter light: a file a lobe, all with the contract of `Scatter`.
//!
//! A surface is a weighted list of lobes, one per material of its blend, and follows the same contract as a single one: see [`Bsdf`].

pub mod blend;
mod blend_weight;
mod channels;
mod conductor;
mod cosine_power;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod dust;
mod energy_preserving_oren_nayar;
mod fresnel;
mod glass;
mod glossy;
mod hemisphere;
mod lobe;
mod lookup;
mod microfacet;
mod mirror;
mod mixture;
mod null;
mod oren_nayar;
mod phong;
mod phong_glass;
mod phong_lobe;
mod phong_study;
mod plastic;
mod principled;
mod principled_layers;
mod qualitative_oren_nayar;
mod rough_diffuse;
mod rough_glass;
mod rough_plastic;
mod rough_spectral_glass;
mod rough_thin_glass;
mod scatter;
mod sheen;
mod spectral_dielectric;
mod spectral_glass;
mod thin_film;
mod thin_glass;
mod view;

pub use fresnel::{conductor_reflectance, refract};
pub use lookup::Lookup;
pub use mixture::{Bsdf, pick};
pub use scatter::{BsdfSample, Density, Evaluation};
pub use view::View;

#[cfg(test)]
mod tests;
