//! Ends the process with an exit code where memory is used up. Rust would abort it, which looks like a fault of the program.

use std::alloc::{GlobalAlloc, Layout, System};

use gpt::render::checkpoint::is_kept;

/// No device that the scene fits, as [`Exit::Device`](crate::cli): it would fail again.
const DOES_NOT_FIT: i32 = 4;
/// The rendered samples are saved, as [`Exit::DeviceLost`](crate::cli): another process may go on.
const BROKE_OFF: i32 = 5;

struct OrExit;

#[global_allocator]
static MEMORY: OrExit = OrExit;

impl OrExit {
    fn checked(pointer: *mut u8, size: usize) -> *mut u8 {
        if pointer.is_null() { out_of_memory(size) } else { pointer }
    }
}

// SAFETY: every request goes to the system's allocator as it came, and its answer back unless it is null.
unsafe impl GlobalAlloc for OrExit {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        // SAFETY: as the caller promises.
        Self::checked(unsafe { System.realloc(pointer, layout, new_size) }, new_size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

/// Says so and ends the process. Nothing here takes memory, and no handlers run that might: other threads may be anywhere.
#[cold]
fn out_of_memory(size: usize) -> ! {
    let mut digits = [0; 20];
    let message: [&[u8]; 3] =
        [b"Error: there is not enough memory: ", decimal(size as u64 >> 20, &mut digits), b" MiB more are needed at once"];
    message.iter().for_each(|part| write_to_stderr(part));
    if is_kept() {
        write_to_stderr(b"; the state of the render is saved, and --resume goes on from it\n");
        quit(BROKE_OFF)
    }
    write_to_stderr(b"\n");
    quit(DOES_NOT_FIT)
}

#[cfg(unix)]
fn write_to_stderr(bytes: &[u8]) {
    // SAFETY: the pointer and the length are those of a slice.
    unsafe { libc::write(2, bytes.as_ptr().cast(), bytes.len()) };
}

#[cfg(unix)]
fn quit(code: i32) -> ! {
    // SAFETY: it does not return.
    unsafe { libc::_exit(code) }
}

#[cfg(not(unix))]
fn write_to_stderr(bytes: &[u8]) {
    let _ = std::io::Write::write_all(&mut std::io::stderr(), bytes);
}

#[cfg(not(unix))]
fn quit(code: i32) -> ! {
    std::process::exit(code)
}

/// The number's digits, at the end of the buffer.
fn decimal(mut number: u64, buffer: &mut [u8; 20]) -> &[u8] {
    let mut start = buffer.len();
    loop {
        start -= 1;
        buffer[start] = b'0' + (number % 10) as u8;
        number /= 10;
        if number == 0 {
            return &buffer[start..];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_without_memory() {
        for number in [0, 7, 10, 123_456, u64::MAX] {
            assert_eq!(decimal(number, &mut [0; 20]), number.to_string().as_bytes());
        }
    }
}
