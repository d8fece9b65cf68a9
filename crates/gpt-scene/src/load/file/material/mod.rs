//! `[[material]]`: a file for each type, with the keys it is written by and what they mean.

pub mod blend;
pub mod blend_weight;
pub mod conductor;
pub mod diffuse;
pub mod diffuse_transmission;
pub mod dispersion;
pub mod dust;
pub mod emissive;
pub mod glass;
pub mod glossy;
pub mod keyframes;
mod keys;
pub mod layered;
pub mod mirror;
pub mod opacity;
pub mod oren_nayar;
pub mod pass;
pub mod phong;
pub mod plastic;
pub mod principled;
pub mod rough_glass;
pub mod roughness;
pub mod thin_film;

use schemars::JsonSchema;
use serde::Deserialize;

pub use self::conductor::metal_symbol;
use self::keys::{CommonKeys, CommonKeysMut, MaterialKeys};
use super::colour::Colour;
use super::resolver::Resolver;
use super::value::{Located, NonNegative};
use super::writer::Writer;
use crate::load::error::SceneError;
use crate::scene::animation::MaterialTrack;
use crate::scene::material::material_table;
use crate::scene::{Emission, MaterialKind};

/// The entries of a scene file, by the rows of the table of materials.
macro_rules! entries {
    ($($(#[$doc:meta])* $material:ident $(($($boxed:tt)*))? $({$($fields:tt)*})? $module:ident { $($lobe:tt)* })*) => {
        /// Materials of surfaces.
        #[derive(Debug, Clone, Deserialize, JsonSchema)]
        #[serde(rename = "key:type", rename_all = "snake_case")]
        #[schemars(tag = "type", rename = "MaterialEntry")]
        pub enum MaterialEntry { $($material(Box<$module::Keys>),)* }

        // Keys are boxed, since some materials have very many and a scene may have very many materials.
        $(impl From<$module::Keys> for MaterialEntry {
            fn from(keys: $module::Keys) -> Self {
                Self::$material(Box::new(keys))
            }
        })*

        impl MaterialEntry {
            /// Each type, and tables of it without `name` and `type`.
            const EXAMPLES: &'static [(&'static str, &'static [&'static str])] =
                &[$((stringify!($module), $module::Keys::EXAMPLES),)*];

            pub fn common(&self) -> CommonKeys<'_> {
                match self { $(Self::$material(keys) => keys.common(),)* }
            }

            pub fn common_mut(&mut self) -> CommonKeysMut<'_> {
                match self { $(Self::$material(keys) => keys.common_mut(),)* }
            }

            /// Calls this with the name of each texture that the material looks up.
            pub fn each_texture(&mut self, visit: &mut dyn FnMut(&mut String)) {
                match self { $(Self::$material(keys) => keys.each_texture(visit),)* }
            }

            pub fn kind(&self, resolver: &Resolver<'_>) -> Result<MaterialKind, SceneError> {
                match self { $(Self::$material(keys) => keys.kind(resolver),)* }
            }

            pub fn emission(&self, resolver: &Resolver<'_>) -> Result<Option<Emission>, SceneError> {
                match self { $(Self::$material(keys) => keys.emission(&keys.common(), resolver),)* }
            }

            /// The material sends out light by itself, at some frame at least.
            pub fn gives_light(&self) -> bool {
                let by_frames = match self { $(Self::$material(keys) => keyframes::states(&**keys, "emission"),)* };
                by_frames || self.radiance().is_some()
            }

            pub fn two_sided(&self, resolver: &Resolver<'_>) -> Result<bool, SceneError> {
                match self { $(Self::$material(keys) => keys.two_sided(&keys.common(), resolver),)* }
            }

            /// The material of this index at frames, by its keyframes.
            pub fn track(&self, id: usize, resolver: &Resolver<'_>) -> Result<Option<MaterialTrack>, SceneError> {
                match self { $(Self::$material(keys) => keyframes::track(&**keys, id, resolver),)* }
            }

            pub fn check_parts(&self, resolver: &Resolver<'_>) -> Result<(), SceneError> {
                match self { $(Self::$material(keys) => keys.check_parts(resolver),)* }
            }
        }

        /// The keys of a material's type alone, as a scene file has them.
        pub fn write_kind(kind: &MaterialKind, writer: &Writer<'_>) -> String {
            match kind { $(MaterialKind::$material { .. } => $module::Keys::write(kind, writer),)* }
        }
    };
}
material_table!(entries);

impl MaterialEntry {
    pub fn name(&self) -> &str {
        &self.common().name.value
    }

    /// The light that it sends out by itself.
    pub fn radiance(&self) -> Option<&Colour<NonNegative>> {
        match self {
            Self::Emissive(keys) => Some(&keys.radiance),
            other => other.common().emission.map(|emission| &emission.value),
        }
    }

    /// The names of the materials that it is made of: parts of a blend, interfaces of a stack.
    pub fn parts(&self) -> &[Located<String>] {
        match self {
            Self::Blend(keys) => &keys.materials.0,
            Self::Layered(keys) => &keys.interfaces.0,
            _ => &[],
        }
    }

    pub fn parts_mut(&mut self) -> &mut [Located<String>] {
        match self {
            Self::Blend(keys) => &mut keys.materials.0,
            Self::Layered(keys) => &mut keys.interfaces.0,
            _ => &mut [],
        }
    }
}

/// Materials that examples of blends name, as TOML.
pub const EXAMPLE_PARTS: &str = r#"
[[material]]
name = "red"
type = "diffuse"
reflectance = [0.7, 0.1, 0.1]

[[material]]
name = "mirror"
type = "mirror"
"#;

/// Materials and a medium that examples of stacks of layers name besides.
const EXAMPLE_LAYERS: &str = r#"
[[medium]]
name = "pigment"
absorption = [0.5, 1, 2]
scattering = [3, 2, 1]

[[material]]
name = "varnish"
type = "glass"
ior = 1.5

[[material]]
name = "frost"
type = "rough_glass"
ior = 1.4
alpha = 0.3
"#;

/// Tables of all that examples of materials name, as TOML.
pub fn example_materials() -> String {
    [EXAMPLE_PARTS, EXAMPLE_LAYERS].concat()
}

/// `type` and keys, as TOML, of examples of every material, which go with [`example_materials`].
pub fn examples() -> impl Iterator<Item = (&'static str, String)> {
    let of_type = |&(name, examples): &(&'static str, &'static [&'static str])| {
        examples.iter().map(move |keys| (name, format!("type = \"{name}\"\n{keys}\n")))
    };
    MaterialEntry::EXAMPLES.iter().flat_map(of_type)
}
