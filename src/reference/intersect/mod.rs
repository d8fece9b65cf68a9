//! Where rays meet surfaces, in f64.

mod hierarchy;
mod normal_map;
mod pose;
mod primitive;
mod ray;
mod triangle;
mod world;

pub use hierarchy::PreparedRay;
pub use pose::{Moment, Pose};
pub use primitive::{Primitive, Sphere};
pub use ray::{Local, Ray, SurfacePoint};
pub use world::{Owner, Surface, SurfaceId, World};

#[cfg(test)]
mod tests;
