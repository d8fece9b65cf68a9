//! Learning about a scene before its first sample, by paths of the reference integrator.
//!
//! A trial run chooses settings that the scene leaves open, cells learn which lights reach them, and a guide
//! learns where light comes from. What is learned depends on the scene, its settings and the size of its film
//! alone. So every device, every part of a picture and every render that goes on has the same.

mod extent;
mod guide;
mod light_cells;
mod openness;
mod paths;
mod reasons;
mod settle;
pub mod trial;
pub mod work_of_path;

pub use reasons::Reasons;
pub use settle::{Settled, settle};
