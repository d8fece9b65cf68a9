//! Shapes as rays meet them: a file for each.

mod cuboid;
mod cylinder;
mod disk;
mod mesh;
mod placement;
mod plane;
mod primitive;
mod rectangle;
mod sphere;
mod triangle;

use crate::scene::Geometry;
use crate::scene::shape::shape_table;
pub use placement::Placement;
pub use primitive::Primitive;
pub use triangle::Triangle;

/// Dispatch over the rows of the table of shapes, which are a module each.
macro_rules! modules {
    ($($variant:ident($type:ty) $module:ident $name:literal $(=> $primitive:ident $file:ident $capitals:ident $sampling:ident $coordinates:ident $curvature:ident)?,)*) => {
        /// The primitives of a shape in the world, each with the number of the face it is: of a mesh, or of a box (−x +x −y +y −z +z).
        pub fn primitives(placement: &Placement<'_>) -> Vec<(usize, Primitive)> {
            match &placement.shape.geometry {
                $(Geometry::$variant(shape) => $module::elements(shape, placement),)*
            }
        }
    };
}
shape_table!(modules);
