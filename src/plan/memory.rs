//! How much device memory a plan takes, array by array.

use std::fmt;

pub use super::choices::FILM_BYTES;
use super::error::PlanError;
use super::limits::DeviceLimits;
use super::path_state::QUEUES;
use crate::packed::attributes::TriangleAttributes;
use crate::packed::primitive::Primitive;

/// Bytes of a path's places in the queues.
pub const QUEUE_BYTES: u64 = 4 * QUEUES as u64;

/// Bytes per pixel of a band in the list of pixels, where pixels are listed.
pub const LIST_BYTES: u64 = 4;

/// Bytes of a primitive, and of a triangle's attributes.
pub const PRIMITIVE_BYTES: u64 = size_of::<Primitive>() as u64;
pub const ATTRIBUTE_BYTES: u64 = size_of::<TriangleAttributes>() as u64;

/// Bytes of a device's own acceleration structure per primitive. No driver tells before it builds one: an estimate, and what it
/// takes while it builds comes on top. Lavapipe takes 104 for a triangle.
pub const ACCELERATION_BYTES: u64 = 128;

/// Names of the arrays that can be cut into chunks.
pub const PRIMITIVES: &str = "primitives";
pub const NODES: &str = "hierarchy";
pub const ATTRIBUTES: &str = "normals and texture coordinates";
pub const INSTANCES: &str = "instances";

/// From where light arrives.
pub const GUIDE: &str = "guide";

/// Which lights reach which part of the scene.
pub const LIGHT_CELLS: &str = "light cells";

/// Images and maps.
pub const TEXELS: &str = "texels";

/// The two halves of the film.
pub(super) const FILM_SUM: &str = "film sum";
pub(super) const FILM_COMPENSATION: &str = "film compensation";

/// Name of materials, lights and textures together.
pub const TABLES: &str = "tables";

/// Name of the structure that the device builds for ray queries.
pub const ACCELERATION: &str = "acceleration structure";
pub(super) const ESTIMATED_ACCELERATION: &str = "acceleration structure by estimate";

/// Named arrays and their sizes in bytes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Memory {
    pub arrays: Vec<(&'static str, u64)>,
}

impl Memory {
    /// Bytes of the array with that name; 0 where there is none.
    pub fn bytes(&self, name: &str) -> u64 {
        self.arrays.iter().find(|(array, _)| *array == name).map_or(0, |(_, bytes)| *bytes)
    }

    pub fn total(&self) -> u64 {
        self.arrays.iter().map(|(_, bytes)| bytes).sum()
    }

    /// # Errors
    /// [`PlanError::DoesNotFit`] for the first array larger than the device can bind, of those that are never cut into chunks.
    pub fn check(&self, limits: &DeviceLimits) -> Result<(), PlanError> {
        let limit = limits.max_storage_binding.min(limits.max_buffer);
        // These are cut, or no storage bindings.
        let cut = [PRIMITIVES, NODES, ATTRIBUTES, INSTANCES, TEXELS, ESTIMATED_ACCELERATION, FILM_SUM, FILM_COMPENSATION];
        match self.arrays.iter().find(|(name, bytes)| *bytes > limit && !cut.contains(name)) {
            Some((name, bytes)) => Err(PlanError::DoesNotFit(format!(
                "its {name} need {}, and the device can bind {} at once",
                megabytes(*bytes),
                megabytes(limit)
            ))),
            None => Ok(()),
        }
    }
}

pub(super) fn megabytes(bytes: u64) -> String {
    format!("{:.1} MiB", bytes as f64 / f64::from(1 << 20))
}

impl fmt::Display for Memory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", megabytes(self.total()))?;
        let parts: Vec<String> = self.arrays.iter().map(|(name, bytes)| format!("{name} {}", megabytes(*bytes))).collect();
        write!(f, " ({})", parts.join(", "))
    }
}
