//! The lobe of any material.

use glam::DVec3;

use super::lookup::Lookup;
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::MaterialKind;

/// The lobes in the table of materials, and their contract handed on to each.
macro_rules! lobes {
    ($($material:ident $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $([$($parameters:tt)*])?)* })*) => {
        /// One of the lobes that materials scatter by.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Lobe { $($($lobe(super::$file::$lobe),)*)* }

        impl Lobe {
            /// Its row in the table.
            #[cfg(test)]
            pub fn kind(&self) -> crate::scene::LobeKind {
                match self { $($(Self::$lobe(_) => crate::scene::LobeKind::$lobe,)*)* }
            }
        }

        impl Lobe {
            /// The share of the lobe's samples that go in all directions above the surface, mostly evenly, which a guide may replace.
            pub fn broad_share(&self) -> f64 {
                match self {
                    Self::Diffuse(_)
                    | Self::OrenNayar(_)
                    | Self::QualitativeOrenNayar(_)
                    | Self::EnergyPreservingOrenNayar(_)
                    | Self::Dust(_)
                    | Self::Plastic(_)
                    | Self::RoughPlastic(_) => 1.0,
                    Self::Principled(lobe) => lobe.layers.broad_share(),
                    _ => 0.0,
                }
            }
        }

        impl Scatter for Lobe {
            fn of(kind: &MaterialKind, lookup: &Lookup) -> Option<Self> {
                $($(if let Some(lobe) = Scatter::of(kind, lookup) {
                    return Some(Self::$lobe(lobe));
                })*)*
                None
            }

            fn sampling_weight(&self) -> f64 {
                match self { $($(Self::$lobe(lobe) => lobe.sampling_weight(),)*)* }
            }

            fn is_delta(&self) -> bool {
                match self { $($(Self::$lobe(lobe) => lobe.is_delta(),)*)* }
            }

            fn evaluate(&self, view: &View, wi: DVec3) -> Evaluation {
                match self { $($(Self::$lobe(lobe) => lobe.evaluate(view, wi),)*)* }
            }

            fn sample(&self, view: &View, u_lobe: f64, u1: f64, u2: f64) -> Option<BsdfSample> {
                match self { $($(Self::$lobe(lobe) => lobe.sample(view, u_lobe, u1, u2),)*)* }
            }
        }
    };
}
crate::scene::material::material_table!(lobes);
