//! The ways in which a camera sees.

use super::brown_conrady::BrownConrady;
use super::cube_map::CubeMap;
use super::cylindrical::Cylindrical;
use super::equirectangular::Equirectangular;
use super::fisheye::Fisheye;
use super::kannala_brandt::KannalaBrandt;
use super::model::{CameraModel, camera_table};

macro_rules! projections {
    ($($(#[$meta:meta])* $variant:ident $module:ident $switch:ident $($needed:ident)*,)*) => {
        /// How the picture's places become rays.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Projection {
            /// Rays through one point and a flat window.
            Perspective {
                vertical_fov_degrees: f64,
            },
            /// Parallel rays over a window `height` scene units high.
            Orthographic {
                height: f64,
            },
            $($(#[$meta])* $variant($variant),)*
        }

        impl Projection {
            /// The name that scene files have for it.
            pub fn name(&self) -> &'static str {
                match self {
                    Self::Perspective { .. } => "perspective",
                    Self::Orthographic { .. } => "orthographic",
                    $(Self::$variant(_) => stringify!($module),)*
                }
            }

            /// Its map from places to directions; None for rays through a flat window.
            pub fn model(&self) -> Option<&dyn CameraModel> {
                match self {
                    Self::Perspective { .. } | Self::Orthographic { .. } => None,
                    $(Self::$variant(model) => Some(model),)*
                }
            }

            /// The switches of shaders that its model needs, its own first.
            pub fn switches(&self) -> &'static [&'static str] {
                match self {
                    Self::Perspective { .. } | Self::Orthographic { .. } => &[],
                    $(Self::$variant(_) => &[stringify!($switch), $(stringify!($needed)),*],)*
                }
            }
        }
    };
}
camera_table!(projections);
