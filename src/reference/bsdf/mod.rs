//! How surfaces scatter light: a file a lobe, all with the contract of `Scatter`.
//!
//! A surface is a weighted list of lobes, one per material of its blend, and follows the same contract as a single one: see [`Bsdf`].

pub mod blend;
mod blend_weight;
mod cosine_power;
mod dielectric;
mod fresnel;
mod hemisphere;
mod lobe;
mod lookup;
mod microfacet;
mod mixture;
mod scatter;
mod sheen;
mod view;

/// A module a lobe.
macro_rules! lobe_modules {
    ($($material:ident $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $([$($parameters:tt)*])?)* })*) => { $($(mod $file;)*)* };
}
crate::scene::material::material_table!(lobe_modules);

pub use lookup::Lookup;
pub use mixture::Bsdf;
pub use scatter::{BsdfSample, Density, Evaluation};
pub use view::View;

#[cfg(test)]
mod tests;
