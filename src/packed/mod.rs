//! The scene as packed arrays for the device: pure data, built and checked without a GPU.
//!
//! Orders matter. Lights stand in the order in which the scene names them, so that a random choice picks the same light on the CPU;
//! primitives stand in the order of the hierarchy's leaves, those outside of it behind them.

pub mod attributes;
mod blend_parts;
pub mod blend_weight;
pub mod bvh4;
mod constants;
pub mod environment;
mod error;
pub mod grid;
pub mod guide;
pub mod hierarchy;
pub mod instance;
pub mod layers;
pub mod light;
pub mod light_cells;
pub mod links;
pub mod material;
pub mod medium;
pub mod motion;
pub mod object;
pub mod primitive;
pub mod ray_query;
mod scene;
pub mod shape;
mod tables;
pub mod texture;
pub mod tree;
pub mod validate;
pub mod view;
pub mod volume;
mod widening;
pub mod world;

pub use constants::NONE;
pub use error::PackError;
pub use scene::PackedScene;
pub use view::View;
