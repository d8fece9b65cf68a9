//! The lobe of any material.

use glam::DVec3;

use super::lookup::Lookup;
use super::scatter::{BsdfSample, Evaluation, Scatter};
use super::view::View;
use crate::scene::{LobeKind, LobeSupport, MaterialKind};

/// The lobes in the table of materials, and their contract handed on to each.
macro_rules! lobes {
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $(($($slots:tt)*))? $([$($parameters:tt)*])?)* })*) => {
        /// One of the lobes that materials scatter by.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Lobe { $($($lobe(super::$file::$lobe),)*)* }

        impl Lobe {
            /// Its row in the table.
            pub fn kind(&self) -> LobeKind {
                match self { $($(Self::$lobe(_) => LobeKind::$lobe,)*)* }
            }

            /// The share of the lobe's samples that go in all directions above the surface, mostly evenly, which a guide may replace.
            pub fn broad_share(&self) -> f64 {
                match self {
                    Self::Principled(lobe) => lobe.layers.broad_share(),
                    lobe if lobe.kind().support() == LobeSupport::Broad => 1.0,
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
