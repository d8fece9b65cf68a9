//! Limits of ray queries: the scenes that they can and cannot trace.

use super::error::PlanError;
use super::limits::{DeviceLimits, RayQueryLimits};
use super::memory::{ACCELERATION, PRIMITIVE_BYTES, megabytes};
use crate::packed::PackedScene;

/// Refuses scenes that ray queries cannot see, or that no structure can hold.
///
/// # Errors
/// [`PlanError::DoesNotFit`], saying what to do.
pub(super) fn check(packed: &PackedScene, limits: &DeviceLimits) -> Result<(), PlanError> {
    let RayQueryLimits { max_primitives } = limits.check_ray_queries("the device")?;
    let refuse =
        |why: String| Err(PlanError::DoesNotFit(format!("{why}; without `--traversal ray-query` it renders all the same")));
    if packed.moves() {
        return refuse("its shapes move, and acceleration structures hold a scene at rest".to_owned());
    }
    if !packed.instances.is_empty() {
        return refuse("it has instances, which this program keeps in a hierarchy of its own".to_owned());
    }
    let in_hierarchy = u64::from(packed.hierarchy.primitive_count);
    let boxes = packed.hierarchy.boxes.len() as u64;
    let triangles = in_hierarchy - boxes;
    // Limits count the vertices of triangles.
    if 3 * triangles > u64::from(max_primitives) || boxes > u64::from(max_primitives) {
        return refuse(format!(
            "it has {triangles} triangles and {boxes} other shapes, and an {ACCELERATION} holds {} or {max_primitives}",
            max_primitives / 3
        ));
    }
    let input = triangles * PRIMITIVE_BYTES;
    if input > limits.max_buffer {
        return refuse(format!(
            "an {ACCELERATION} of its triangles is built from {} at once, and a buffer holds {}",
            megabytes(input),
            megabytes(limits.max_buffer)
        ));
    }
    Ok(())
}
