//! How the wavefront keeps paths in flight and their queues.

use crate::shader::shared::shared_constants;

shared_constants!(constants {
    /// Invocations of a workgroup of every stage but `prepare`.
    pub const WORKGROUP: u32 = 64;
    /// Flag beside the primitive of a hit in an instance, which has the instance's number in place of the distance; primitives have 24 bits.
    pub const HIT_IN_INSTANCE: u32 = 1 << 31;
    /// Queues of paths: one is read while the other is filled.
    pub const QUEUES: u32 = 2;
    /// Counts: paths in queue 0 and 1; paths with shadow rays of vertices that read queue 0 and 1; where paths have several, all shadow
    /// rays of a vertex.
    pub const COUNTS: u32 = 5;
    pub const COUNT_OF_SHADOW_RAYS: u32 = 4;
    // Index of each stage's workgroup counts among the dispatch sizes, three words each.
    pub const SHADE_SIZE: u32 = 0;
    pub const EXTEND_SIZE: u32 = 3;
    pub const CONNECT_SIZE: u32 = 6;
    /// Words of all dispatch sizes.
    pub const DISPATCH_SIZE_WORDS: u32 = 9;
});

/// One vec4 of the state of a path in flight; the states of all paths have a plane of them.
#[derive(Debug, Clone, Copy)]
pub struct Plane {
    /// The constant that kernels know the plane's first element by.
    pub name: &'static str,
    /// The switch of kernels that have the plane; None: all have it.
    pub switch: Option<&'static str>,
}

/// The planes of the path state, in their order:
///
/// - the ray's origin, and as bits the pixel within the pass (within the band where pixels are listed) below the sample in the pass, in 24 and 8 bits;
/// - the ray's direction and its density;
/// - the throughput, and the scale of roulette;
/// - the radiance, and as bits the number of vertices at null surfaces below the facing of the surface from which light was last sampled, in 28 and 4 bits; with light links
///   the surface's receiver between both, in 22, 6 and 4 bits;
/// - the hit;
/// - the reference point of the last light sample;
/// - the media that the ray is in, as bits.
pub const PLANES: &[Plane] = &[
    Plane { name: "PLANE_ORIGIN", switch: None },
    Plane { name: "PLANE_DIRECTION", switch: None },
    Plane { name: "PLANE_THROUGHPUT", switch: None },
    Plane { name: "PLANE_RADIANCE", switch: None },
    Plane { name: "PLANE_HIT", switch: None },
    Plane { name: "PLANE_REFERENCE_POINT", switch: Some("TRANSPARENT_SHADOWS") },
    Plane { name: "PLANE_MEDIA", switch: Some("MEDIA") },
];

/// Bytes of the state of a path that has every plane.
pub const MOST_PATH_STATE_BYTES: u64 = 16 * PLANES.len() as u64;

/// Bytes of the state of a path in flight, in kernels with the switches that `has` tells.
pub fn path_state_bytes(has: impl Fn(&str) -> bool) -> u64 {
    16 * planes(has).filter(|(_, is_there)| *is_there).count() as u64
}

/// vec4s of a shadow ray, in kernels with the switches that `has` tells: where it begins, where it leads, what it carries, and where it crosses
/// boundaries of media, those around its origin.
pub fn shadow_ray_words(has: impl Fn(&str) -> bool) -> u32 {
    if has("OPEN_BOUNDARIES") { 4 } else { 3 }
}

/// The first elements of all planes of `capacity` paths. A plane that kernels do not have begins where the next one does.
pub fn plane_constants(has: impl Fn(&str) -> bool, capacity: u32) -> Vec<(&'static str, u32)> {
    let mut first = 0;
    let placed = planes(has).map(|(plane, is_there)| {
        let constant = (plane.name, first);
        first += if is_there { capacity } else { 0 };
        constant
    });
    placed.collect()
}

fn planes(has: impl Fn(&str) -> bool) -> impl Iterator<Item = (&'static Plane, bool)> {
    PLANES.iter().map(move |plane| (plane, plane.switch.is_none_or(&has)))
}
