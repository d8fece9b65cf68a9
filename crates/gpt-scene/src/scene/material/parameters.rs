//! The further parameters of lobes, for which the slots that all lobes share have no room: by name, from the
//! table of materials.
//!
//! A lobe that has some has a struct of them here, by which [`super::kind`] fills them in, and one in
//! shaders, which `plan::lobes` writes.

use super::table::{LobeKind, material_table};
use crate::scene::texture::ColorInput;

/// The numbers that a parameter consists of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ParameterType {
    /// One that is not negative.
    Scalar,
    /// One of either sign.
    SignedScalar,
    /// Three that are not negative.
    Color,
    /// Three of either sign.
    Vector,
}

/// A further parameter of a lobe.
#[derive(Debug, Clone, Copy)]
pub struct Parameter {
    /// The name of the field in both structs.
    pub name: &'static str,
    /// The numbers that it consists of.
    pub parameter_type: ParameterType,
    /// The WGSL expression of `lobe` that stands for it in a lobe without it; None: no lobe of this kind goes
    /// without.
    pub default: Option<&'static str>,
}

macro_rules! parameters {
    (@default) => { None };
    (@default $default:literal) => { Some($default) };
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $type_name:ident { $($lobe:ident $file:ident $number:ident $support:ident $(($($slots:tt)*))?
        $([$($name:ident: $parameter_type:ident $(= $default:literal)?),*])?)* })*) => {
        $($($(
            #[doc = concat!("The further parameters of the lobe `", stringify!($file), "`.")]
            #[repr(C)]
            pub(super) struct $lobe { $(pub $name: ColorInput,)* }

            impl $lobe {
                /// All of them, in the table's order.
                pub fn list(self) -> Vec<ColorInput> {
                    vec![$(self.$name),*]
                }
            }
        )?)*)*

        impl LobeKind {
            /// The [further parameters](super::LobeParameters::further) that a lobe of this kind may have, in
            /// their order.
            pub fn parameters(self) -> &'static [Parameter] {
                match self {
                    $($(Self::$lobe => &[$($(Parameter {
                        name: stringify!($name),
                        parameter_type: ParameterType::$parameter_type,
                        default: parameters!(@default $($default)?),
                    },)*)?],)*)*
                }
            }
        }
    };
}
material_table!(parameters);

/// The place of a parameter among those of its lobe.
macro_rules! place {
    ($lobe:ident.$name:ident) => {
        std::mem::offset_of!(super::parameters::$lobe, $name) / size_of::<ColorInput>()
    };
}
pub(super) use place;
