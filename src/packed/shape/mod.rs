//! Shapes as primitives in world space: a file for each shape.

mod cuboid;
mod cylinder;
mod disk;
mod element;
mod mesh;
mod placement;
mod plane;
mod rectangle;
mod sphere;

use glam::{DAffine3, DVec3, Vec3};

use super::attributes::TriangleAttributes;
use crate::emission_map::Unrolled;
use crate::scene::Geometry;
use crate::scene::shape::shape_table;
use crate::shader::shared::{Constant, Constants};
use element::Element;
pub use placement::Placement;

/// Dispatch over the rows of the table of shapes, which are a module each, and over their primitives.
macro_rules! modules {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        $($(pub use $module::$primitive;)?)*

        /// Hands over a shape's primitives, each with what else its texture coordinates and normals need, and the number of its face.
        pub fn add(placement: &Placement<'_>, push: &mut dyn FnMut(PrimitiveGeometry, Option<TriangleAttributes>, usize)) {
            match &placement.shape.geometry {
                $(Geometry::$variant(shape) => {
                    $module::add(shape, placement, &mut |primitive, attributes, face| push(primitive.into(), attributes, face));
                })*
            }
        }

        /// Kinds of primitives, as their records and kernels number them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        #[repr(u32)]
        pub enum PrimitiveKind {
            $($($primitive,)?)*
        }

        impl PrimitiveKind {
            pub const ALL: &'static [Self] = &[$($(Self::$primitive,)?)*];

            /// How points of it are drawn where it is a light or a portal.
            pub fn sampling(self) -> SurfaceSampling {
                match self {
                    $($(Self::$primitive => SurfaceSampling::$sampling,)?)*
                }
            }

            pub fn coordinates(self) -> SurfaceCoordinates {
                match self {
                    $($(Self::$primitive => SurfaceCoordinates::$coordinates,)?)*
                }
            }

            pub fn curvature(self) -> Curvature {
                match self {
                    $($(Self::$primitive => Curvature::$curvature,)?)*
                }
            }

            /// How whole ones of it are drawn by what they show, where they can be.
            pub fn unrolled(self) -> Option<Unrolled> {
                match self {
                    $($(Self::$primitive => <$module::$primitive as Element>::UNROLLED,)?)*
                }
            }

            /// Its name in the name of its file in `shaders/geometry/shape/`, and in those of the functions there.
            pub fn file(self) -> &'static str {
                match self {
                    $($(Self::$primitive => stringify!($file),)?)*
                }
            }

            /// The name of its number in shaders.
            pub fn number_name(self) -> &'static str {
                match self {
                    $($(Self::$primitive => concat!("KIND_", stringify!($capitals)),)?)*
                }
            }

            /// The switch that is on where the scene has any, be it as a portal.
            pub fn switch(self) -> &'static str {
                match self {
                    $($(Self::$primitive => concat!(stringify!($capitals), "S"),)?)*
                }
            }

            /// The switch that is on where the hierarchy holds any.
            pub fn switch_in_hierarchy(self) -> &'static str {
                match self {
                    $($(Self::$primitive => concat!(stringify!($capitals), "S_IN_HIERARCHY"),)?)*
                }
            }

            /// The switch that is on where any is a light or a portal.
            pub fn switch_of_lights(self) -> &'static str {
                match self {
                    $($(Self::$primitive => concat!(stringify!($capitals), "_LIGHTS"),)?)*
                }
            }
        }

        /// The geometry of a primitive, in world space.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum PrimitiveGeometry {
            $($($primitive($module::$primitive),)?)*
        }

        impl PrimitiveGeometry {
            pub fn kind(&self) -> PrimitiveKind {
                match self {
                    $($(Self::$primitive(_) => PrimitiveKind::$primitive,)?)*
                }
            }

            /// The primitive under a motion. Round ones are scaled by the same factor along every axis.
            pub fn moved(&self, map: &DAffine3) -> Self {
                match self {
                    $($(Self::$primitive(primitive) => Self::$primitive(primitive.moved(map)),)?)*
                }
            }

            /// Bounds in f32, grown past rounding. None: it is infinite.
            pub fn bounds(&self) -> Option<(Vec3, Vec3)> {
                match self {
                    $($(Self::$primitive(primitive) => primitive.bounds(),)?)*
                }
            }

            /// Lower and upper corner of the box around it. None: it is infinite.
            pub fn extent(&self) -> Option<[DVec3; 2]> {
                match self {
                    $($(Self::$primitive(primitive) => primitive.extent(),)?)*
                }
            }

            /// Surface area; infinite for a plane.
            pub fn area(&self) -> f64 {
                match self {
                    $($(Self::$primitive(primitive) => primitive.area(),)?)*
                }
            }

            /// The three points of its record.
            pub fn points(&self) -> [Vec3; 3] {
                match self {
                    $($(Self::$primitive(primitive) => primitive.points(),)?)*
                }
            }

            /// Its data as a light: its area, or the quantity that its shader takes instead, and three
            /// points. None: no density covers it evenly.
            pub fn light(&self) -> Option<(f64, [DVec3; 3])> {
                match self {
                    $($(Self::$primitive(primitive) => primitive.light(),)?)*
                }
            }

            /// Its normal as a light. None: it is not flat.
            pub fn light_normal(&self) -> Option<DVec3> {
                match self {
                    $($(Self::$primitive(primitive) => primitive.light_normal(),)?)*
                }
            }
        }

        $($(
            impl From<$module::$primitive> for PrimitiveGeometry {
                fn from(primitive: $module::$primitive) -> Self {
                    Self::$primitive(primitive)
                }
            }
        )?)*
    };
}
shape_table!(modules);

/// How points of a primitive are drawn where it is a light or a portal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceSampling {
    /// Evenly over its area.
    Area,
    /// By functions of its own.
    Own,
    /// Not at all: it has neither bounds nor an area.
    Infinite,
}

/// Origin of a primitive's texture coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SurfaceCoordinates {
    /// From places along two edges; attributes say what they are at the corners.
    Edges,
    /// From the normal, by functions of its own.
    Normal,
    None,
}

/// How often a ray can cross a primitive: both crossings of what is curved stand in the way of a shadow ray.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Curvature {
    /// Once.
    Flat,
    /// Twice.
    Curved,
}

/// Numbers of kinds, and what kernels share with the shapes' own files.
pub fn constants() -> Constants {
    let kinds = PrimitiveKind::ALL.iter().map(|&kind| (kind.number_name(), Constant::U32(kind as u32)));
    kinds.chain(rectangle::constants()).collect()
}

impl PrimitiveKind {
    /// True of a shape with neither bounds nor area: it is in no hierarchy, and is neither light nor portal.
    pub fn is_infinite(self) -> bool {
        self.sampling() == SurfaceSampling::Infinite
    }

    /// The kind of a record's number.
    pub fn of(number: u32) -> Option<Self> {
        Self::ALL.get(number as usize).copied()
    }
}
