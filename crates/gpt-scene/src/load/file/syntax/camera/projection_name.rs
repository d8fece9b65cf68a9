//! Names of projections.

use schemars::JsonSchema;
use serde::Deserialize;

use crate::scene::camera::model::camera_table;

/// Declares the names, and lists them.
macro_rules! projection_names {
    ($($(#[$meta:meta])* $variant:ident $module:ident $switch:ident $($needed:ident)*,)*) => {
        #[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize, JsonSchema)]
        #[serde(rename_all = "snake_case")]
        pub enum ProjectionName {
            /// Rays through one point and a flat window.
            Perspective,
            /// Parallel rays.
            Orthographic,
            $($(#[$meta])* $variant,)*
        }

        impl ProjectionName {
            pub const ALL: &[Self] = &[Self::Perspective, Self::Orthographic, $(Self::$variant,)*];

            /// The name.
            pub fn name(self) -> &'static str {
                match self {
                    Self::Perspective => "perspective",
                    Self::Orthographic => "orthographic",
                    $(Self::$variant => stringify!($module),)*
                }
            }
        }
    };
}
camera_table!(projection_names);
