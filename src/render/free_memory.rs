//! Memory that is free, and reserved for nobody.

/// Gives free memory back to the system where this is dropped, behind what took it.
///
/// The GNU C library keeps what a thread frees in an arena, for other threads that may come. A graphics driver has threads of its own for each device, and
/// they end with it: a program that renders many pictures, each on a device that is opened for it, would grow by some hundred kilobytes a picture.
pub struct FreeMemory;

impl Drop for FreeMemory {
    fn drop(&mut self) {
        #[cfg(all(target_os = "linux", target_env = "gnu"))]
        // SAFETY: it takes no pointer, and may be called at any time from any thread.
        unsafe {
            libc::malloc_trim(0);
        }
    }
}
