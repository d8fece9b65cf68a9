//! Limits of a device that the plan has to know.

use super::choices::{FILM_BYTES, FilmStorage};
use super::error::PlanError;
use super::path_state::MOST_PATH_STATE_BYTES;
use crate::film::MOST_FILM_PIXELS;

/// Bytes that the queue of shadow rays takes at most: five million of them keep any device busy.
const MOST_SHADOW_RAY_BYTES: u64 = 256 << 20;

/// Paths in flight: a software device's fit its caches; on hardware the last vertices of a pass, to which few paths come, still fill the card.
const SOFTWARE_PATHS: u64 = 1 << 18;
const HARDWARE_PATHS: u64 = 1 << 21;
/// Least number of paths in flight, where a device has no memory for more.
const FEWEST_PATHS: u32 = 1 << 18;

/// Pixels of a band where the device has no memory for more, which take 32 MiB.
const FEWEST_FILM_PIXELS: u64 = 1 << 20;
/// Most pixels of a film whose pixels are listed: a path's state has 24 bits for its pixel.
const MOST_LISTED_PIXELS: u64 = 1 << 24;

/// Limits in bytes unless the name says otherwise.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct DeviceLimits {
    pub max_storage_binding: u64,
    pub max_uniform_binding: u32,
    pub max_buffer: u64,
    /// Bytes of an array that one binding can have.
    pub max_array: u64,
    /// Paths in flight: enough to fill the device, few enough for its caches and for the largest binding.
    pub path_capacity: u32,
    /// Pixels of a film that is rendered at once.
    pub film_pixels: u64,
    /// Storage buffers that one stage can bind.
    pub max_storage_buffers: u32,
    /// In pixels.
    pub max_texture_side: u32,
    pub max_workgroups: u32,
    pub read_write_rgba32float: bool,
    /// The device is the CPU in disguise: its memory is the machine's, and its caches reward small working sets.
    pub software: bool,
    /// Threads that share a dispatch on a software device; 1 on others.
    pub threads: u32,
    /// Invocations of a subgroup can exchange values, however many they are.
    pub subgroups: bool,
    /// Invocations of a subgroup, where all subgroups have as many and can exchange values.
    pub subgroup_size: Option<u32>,
    /// A software device loads for all lanes of a subgroup at once, wherever their addresses lie, and not lane by lane.
    pub gathers: bool,
    /// Limits of acceleration structures, where kernels can use them.
    pub ray_queries: Option<RayQueryLimits>,
    /// Use of ray queries where no option asks for them.
    pub ray_query_default: RayQueryDefault,
}

/// Kernels of this build can use ray queries: it has the cargo feature `ray-query`.
pub const BUILD_HAS_RAY_QUERIES: bool = cfg!(feature = "ray-query");

/// Use of ray queries where no option asks for them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum RayQueryDefault {
    /// Another way is asked for, there are none, or the device is a software one, which follows them more slowly than it walks nodes.
    #[default]
    No,
    /// Hardware has them, and nobody has verified them with this driver.
    Unverified,
    /// Hardware has them, and verification passed with this driver.
    Verified,
}

/// Limits of acceleration structures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RayQueryLimits {
    /// Vertices of triangles, or boxes, of one part.
    pub max_primitives: u32,
}

impl Default for DeviceLimits {
    /// The limits that WebGPU guarantees.
    fn default() -> Self {
        Self {
            max_storage_binding: 128 << 20,
            max_uniform_binding: 64 << 10,
            max_buffer: 256 << 20,
            max_array: 128 << 20,
            path_capacity: 1 << 20,
            film_pixels: MOST_FILM_PIXELS,
            max_storage_buffers: 8,
            max_texture_side: 8192,
            max_workgroups: 65_535,
            read_write_rgba32float: false,
            software: false,
            threads: 1,
            subgroups: false,
            subgroup_size: None,
            gathers: false,
            ray_queries: None,
            ray_query_default: RayQueryDefault::No,
        }
    }
}

impl DeviceLimits {
    /// Paths in flight on a device that binds arrays of `max_array` bytes and dispatches so many workgroups.
    pub fn most_paths(software: bool, max_array: u64, max_workgroups: u32) -> u32 {
        let wanted = if software { SOFTWARE_PATHS } else { HARDWARE_PATHS };
        let possible = (max_array / MOST_PATH_STATE_BYTES).min(u64::from(max_workgroups) * 64);
        wanted.min(possible) as u32
    }

    /// The limits of ray queries.
    ///
    /// # Errors
    /// [`PlanError::DoesNotFit`] where the device, so called, has no ray queries, or this build does without.
    pub fn check_ray_queries(&self, device: &str) -> Result<RayQueryLimits, PlanError> {
        let missing = || {
            let what = match BUILD_HAS_RAY_QUERIES {
                true => format!("{device} has no ray queries, or its driver does not offer them"),
                false => {
                    "this gpt is built without ray queries, which `cargo build --release --features ray-query` has".to_owned()
                }
            };
            PlanError::DoesNotFit(format!("{what}; without `--traversal ray-query` it renders all the same"))
        };
        self.ray_queries.ok_or_else(missing)
    }

    /// Paths in flight, each with so many bytes of state and of shadow rays: as many as one binding holds of either.
    pub fn paths_with_shadow_rays(&self, state_bytes: u64, bytes: u64) -> u32 {
        let binding = self.max_storage_binding.min(self.max_buffer);
        let by_shadow_rays = binding.min(MOST_SHADOW_RAY_BYTES) / bytes.max(1);
        u64::from(self.path_capacity).min(binding / state_bytes).min(by_shadow_rays) as u32
    }

    /// Lower limits for a device that turned out to have no memory for a film of this size or for so many
    /// paths; None where lower ones would not help.
    pub fn with_less_memory(&self, [width, height]: [u32; 2]) -> Option<Self> {
        let is_large = u64::from(width) * u64::from(height) > FEWEST_FILM_PIXELS && self.film_pixels > FEWEST_FILM_PIXELS;
        (is_large || self.path_capacity > FEWEST_PATHS).then(|| Self {
            film_pixels: self.film_pixels.min(FEWEST_FILM_PIXELS),
            path_capacity: self.path_capacity.min(FEWEST_PATHS),
            ..self.clone()
        })
    }

    /// Rows of a band: all of the picture's, where memory and the device's limits allow it.
    pub fn band_rows(&self, size: [u32; 2], film: FilmStorage, pixels_are_listed: bool) -> u32 {
        let [width, height] = size;
        let most_pixels = if pixels_are_listed { self.film_pixels.min(MOST_LISTED_PIXELS) } else { self.film_pixels };
        let rows_of_storage = match film {
            FilmStorage::Texture => self.max_texture_side,
            FilmStorage::Buffer => (self.max_array / (FILM_BYTES / 2) / u64::from(width)).clamp(1, u64::from(u32::MAX)) as u32,
        };
        ((most_pixels / u64::from(width)) as u32).clamp(1, rows_of_storage).min(height)
    }

    /// True where textures can hold rows of a film of this size.
    pub fn film_fits_textures(&self, [width, _]: [u32; 2]) -> bool {
        self.read_write_rgba32float && width <= self.max_texture_side
    }

    /// The storage of the film: textures, unless they cannot hold it or buffers hold more of it.
    pub fn film_storage(&self, size: [u32; 2], pixels_are_listed: bool) -> FilmStorage {
        let rows = |film| self.band_rows(size, film, pixels_are_listed);
        if self.film_fits_textures(size) && rows(FilmStorage::Texture) >= rows(FilmStorage::Buffer) {
            FilmStorage::Texture
        } else {
            FilmStorage::Buffer
        }
    }
}
