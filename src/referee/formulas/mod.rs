//! Closed forms in double precision, written from their sources and not from the renderer's code: a referee does not ask the player.

mod fresnel;
mod irradiance;
mod quadrature;
mod reflection;
mod vector;

pub use fresnel::{conductor, dielectric, plate, schlick};
pub use irradiance::{directional, disk, point, polygon, sphere};
pub use quadrature::{gauss_legendre, integrate};
pub use reflection::{ggx_reflection, gltf, oren_nayar_qualitative};
pub use vector::{cross, dot, length as vector_length, normalized, sub};
