//! Learning about a scene before its first sample, by paths of the reference integrator.
//!
//! A trial run chooses settings that the scene leaves open, cells learn which lights reach them, and a guide learns where
//! light comes from. What is learned depends on the scene, its settings and the size of its film alone. So every device, every
//! part of a picture and every render that goes on has the same.

pub mod guide;
pub mod light_cells;
mod paths;
pub mod trial;
pub mod work_of_path;
