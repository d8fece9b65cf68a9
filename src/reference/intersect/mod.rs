//! Where rays meet surfaces, in f64.

mod element;
mod hierarchy;
mod instances;
mod mesh_data;
mod normal_map;
mod pose;
mod ray;
mod shape;
mod world;

pub use hierarchy::PreparedRay;
pub use normal_map::Tangents;
pub use pose::{Moment, Pose};
pub use ray::{Ray, SurfacePoint};
pub use shape::Primitive;
pub use world::{Owner, Surface, SurfaceId, World};

#[cfg(test)]
mod tests;
