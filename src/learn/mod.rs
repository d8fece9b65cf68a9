//! Learning about a scene before its first sample, by paths of the reference integrator.
//!
//! A trial run chooses settings that the scene leaves open, cells learn which lights reach them, and a guide
//! learns where light comes from. What is learned depends on the scene, its settings, the size of its film, and
//! whether a graphics card renders; with a time limit on the number of cores too. So every software device, every
//! part of a picture that states the whole's samples and every render that goes on has the same.

mod budget;
mod extent;
mod guide;
mod light_cells;
mod openness;
mod paths;
mod reasons;
mod settle;
mod trial;
pub mod work_of_path;

pub use budget::{Effort, Pace};
pub use reasons::Reasons;
pub use settle::{Settled, may_learn, settle, with_lights_settled};
