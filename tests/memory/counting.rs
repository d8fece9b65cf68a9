//! An allocator that counts the bytes in use, and the most there ever were.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

struct Counting;

static IN_USE: AtomicUsize = AtomicUsize::new(0);
static MOST: AtomicUsize = AtomicUsize::new(0);
static EVER: AtomicUsize = AtomicUsize::new(0);

impl Counting {
    fn add(size: usize) {
        let now = IN_USE.fetch_add(size, Ordering::Relaxed) + size;
        MOST.fetch_max(now, Ordering::Relaxed);
        EVER.fetch_add(size, Ordering::Relaxed);
    }
}

// SAFETY: every request goes to the system's allocator as it came.
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc(layout) }
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        Self::add(layout.size());
        // SAFETY: as the caller promises.
        unsafe { System.alloc_zeroed(layout) }
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, new_size: usize) -> *mut u8 {
        // Counted as if both were in use for a moment, which depends on where the allocator finds room.
        Self::add(new_size);
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.realloc(pointer, layout, new_size) }
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        IN_USE.fetch_sub(layout.size(), Ordering::Relaxed);
        // SAFETY: as the caller promises.
        unsafe { System.dealloc(pointer, layout) }
    }
}

#[global_allocator]
static MEMORY: Counting = Counting;

static TURN: Mutex<()> = Mutex::new(());

/// Held by a test while it measures. A test that failed leaves nothing behind that would disturb the next.
pub fn take_turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Bytes that were ever asked for, whether they are in use or not.
pub fn bytes_ever() -> usize {
    EVER.load(Ordering::Relaxed)
}

/// The most bytes in use since a moment, beyond those in use then.
pub struct Peak {
    before: usize,
}

impl Peak {
    pub fn from_now() -> Self {
        let before = IN_USE.load(Ordering::Relaxed);
        MOST.store(before, Ordering::Relaxed);
        Self { before }
    }

    pub fn bytes(&self) -> usize {
        MOST.load(Ordering::Relaxed).saturating_sub(self.before)
    }

    /// Bytes that are still in use.
    pub fn bytes_now(&self) -> usize {
        IN_USE.load(Ordering::Relaxed).saturating_sub(self.before)
    }
}

#[test]
fn what_is_allocated_and_freed_again_is_counted() {
    let _turn = take_turn();
    let peak = Peak::from_now();
    drop(std::hint::black_box(vec![1_u8; 10 << 20]));
    // The harness, on a thread of its own, takes and frees a little meanwhile.
    assert!(peak.bytes().abs_diff(10 << 20) < 1 << 20, "{}", peak.bytes());
}
