//! Memory that the triangles of an import take.

use crate::load::memory;

/// Bytes that a triangle takes once it is packed, with its share of the hierarchy.
const TRIANGLE_BYTES: u64 = 200;
/// Triangles from which on it is asked whether there is memory for them.
const MANY_TRIANGLES: u64 = 1 << 20;

/// Checks that there is memory for so many triangles, copies by instances counted.
///
/// # Errors
/// A sentence.
pub fn triangles_fit(triangles: u64) -> Result<(), String> {
    let needed = triangles.saturating_mul(TRIANGLE_BYTES);
    let available = memory::available();
    if triangles <= MANY_TRIANGLES || needed <= available {
        return Ok(());
    }
    let (needed, available) = (needed >> 20, available >> 20);
    Err(format!(
        "the scene does not fit: up to here it has {triangles} triangles, with each instance's copies, which take about {needed} MiB; \
         {available} MiB are free"
    ))
}
