//! Hits of rays and surfaces, in f64.

mod element;
mod hierarchy;
mod instances;
mod mesh_data;
mod normal_map;
mod owner;
mod pose;
mod ray;
mod seen;
mod shape;
mod world;

pub use hierarchy::PreparedRay;
pub use normal_map::{NormalTexel, Tangents, UvSet};
pub use owner::{Owner, SurfaceId};
pub use pose::{PathTime, Pose};
pub use ray::{Ray, SurfacePoint};
pub use seen::Outline;
pub use shape::Primitive;
pub use world::{Hit, PointAtRest, Surface, World};

#[cfg(test)]
mod tests;
