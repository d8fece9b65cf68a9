//! How much device memory a plan takes, array by array.

use std::fmt;

use super::path_state::{PATH_STATE_WORDS, QUEUES, SHADOW_RAY_WORDS};
use super::{Plan, StageMode, has_attributes, limits::DeviceLimits};
use crate::packed::PackedScene;
use crate::packed::primitive::{Primitive, TriangleAttributes};
use crate::renderer::RenderError;

/// Bytes of state per path: ray, throughput, radiance, hit (`shaders/stages/wavefront.wgsl`).
pub const PATH_STATE_BYTES: u64 = 16 * PATH_STATE_WORDS as u64;
/// Bytes per shadow ray; a path has as many at a time as a surface takes light samples.
pub const SHADOW_RAY_BYTES: u64 = 16 * SHADOW_RAY_WORDS as u64;
/// Bytes of a path's places in the queues.
pub const QUEUE_BYTES: u64 = 4 * QUEUES as u64;
/// Bytes of film per pixel of a band: sum and compensation.
pub const FILM_BYTES: u64 = 2 * 16;

/// Bytes per pixel of a band in the list of pixels, where pixels are listed.
pub const LIST_BYTES: u64 = 4;

/// Bytes of a primitive, and of a triangle's attributes.
pub const PRIMITIVE_BYTES: u64 = size_of::<Primitive>() as u64;
pub const ATTRIBUTE_BYTES: u64 = size_of::<TriangleAttributes>() as u64;

/// Bytes of a device's own acceleration structure per primitive. No driver tells before it builds one: an estimate, and what it
/// takes while it builds comes on top. Lavapipe takes 104 for a triangle.
pub const ACCELERATION_BYTES: u64 = 128;

/// What the arrays are called that can be cut into chunks.
pub const PRIMITIVES: &str = "primitives";
pub const NODES: &str = "hierarchy";
pub const ATTRIBUTES: &str = "normals and texture coordinates";

/// What materials, lights and textures are called together.
pub const TABLES: &str = "tables";

/// What the device builds where ray queries find hits.
pub const ACCELERATION: &str = "acceleration structure";
const ESTIMATED_ACCELERATION: &str = "acceleration structure by estimate";

/// Named arrays and their sizes in bytes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Memory {
    pub arrays: Vec<(&'static str, u64)>,
}

impl Memory {
    pub fn new(packed: &PackedScene, plan: &Plan, width: u32) -> Self {
        let tables = packed.tables().words;
        let pixels = u64::from(width) * u64::from(plan.band_rows);
        let mut arrays = vec![
            (PRIMITIVES, PRIMITIVE_BYTES * packed.primitives.len() as u64),
            (TABLES, 16 * tables.len() as u64),
            ("film sum", pixels * FILM_BYTES / 2),
            ("film compensation", pixels * FILM_BYTES / 2),
        ];
        if plan.switches.enabled.contains("RAY_QUERY") {
            arrays.push((ESTIMATED_ACCELERATION, ACCELERATION_BYTES * u64::from(packed.hierarchy.primitive_count)));
        }
        if plan.has_nodes() {
            arrays.push((NODES, size_of_val(&packed.hierarchy.nodes[..]) as u64));
        }
        if has_attributes(packed) {
            arrays.push((ATTRIBUTES, ATTRIBUTE_BYTES * packed.attributes.len() as u64));
        }
        if !packed.textures.texels.is_empty() {
            arrays.push(("texels", 4 * packed.textures.texels.len() as u64));
        }
        if plan.switches.enabled.contains("PIXEL_LIST") {
            arrays.push(("pixels", pixels * LIST_BYTES));
        }
        if plan.stages == StageMode::Wavefront {
            let paths = u64::from(plan.path_capacity);
            arrays.push(("path state", paths * PATH_STATE_BYTES));
            arrays.push(("queues", paths * QUEUE_BYTES));
            if plan.samples_lights() {
                arrays.push(("shadow rays", paths * plan.shadow_ray_bytes()));
            }
        }
        Self { arrays }
    }

    /// Of the array of that name; 0 where there is none.
    pub fn bytes(&self, name: &str) -> u64 {
        self.arrays.iter().find(|(array, _)| *array == name).map_or(0, |(_, bytes)| *bytes)
    }

    pub fn total(&self) -> u64 {
        self.arrays.iter().map(|(_, bytes)| bytes).sum()
    }

    /// # Errors
    /// [`RenderError::DoesNotFit`] for the first array larger than the device can bind, of those that are never cut into chunks.
    pub fn check(&self, limits: &DeviceLimits) -> Result<(), RenderError> {
        let limit = limits.max_storage_binding.min(limits.max_buffer);
        // These are cut, or bound as a whole by the device itself.
        let cut = [PRIMITIVES, NODES, ATTRIBUTES, ESTIMATED_ACCELERATION];
        match self.arrays.iter().find(|(name, bytes)| *bytes > limit && !cut.contains(name)) {
            Some((name, bytes)) => Err(RenderError::DoesNotFit(format!(
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
