//! An allocator that ends the program in good order where there is no memory left.
//!
//! The standard library aborts there, which leaves a core file and tells callers nothing.

use std::alloc::{GlobalAlloc, Layout, System};
use std::io::Write;
use std::sync::atomic::{AtomicU32, Ordering};

/// The system's allocator, which says that there is no memory and ends the program with
/// [`STATUS`], in place of telling its caller.
#[derive(Debug, Default)]
pub struct EndingAllocator {
    /// How many callers want to be told: [`EndingAllocator::telling`].
    told: AtomicU32,
}

/// The status of a program that ends for want of memory: that of a limit.
pub const STATUS: i32 = 3;

impl EndingAllocator {
    /// An allocator for `#[global_allocator]`.
    pub const fn new() -> Self {
        Self {
            told: AtomicU32::new(0),
        }
    }

    /// Does something that is told where there is no memory, as `Vec::try_reserve` is.
    pub fn telling<T>(&self, act: impl FnOnce() -> T) -> T {
        self.told.fetch_add(1, Ordering::SeqCst);
        let done = act();
        self.told.fetch_sub(1, Ordering::SeqCst);
        done
    }

    fn checked(&self, pointer: *mut u8, size: usize) -> *mut u8 {
        if pointer.is_null() && self.told.load(Ordering::SeqCst) == 0 {
            end(size);
        }
        pointer
    }
}

/// Ends the program; nothing in here allocates.
#[cold]
fn end(size: usize) -> ! {
    let mut text = [0u8; 96];
    let mut rest = &mut text[..];
    let _ = writeln!(
        rest,
        "memory: found no room for {size} bytes more: the limit is the system's"
    );
    let left = rest.len();
    let length = text.len() - left;
    let _ = std::io::stderr().write_all(&text[..length]);
    signal_hook::low_level::exit(STATUS)
}

// SAFETY: every call is handed on to the system's allocator, and so is what it returns.
#[allow(
    unsafe_code,
    reason = "the trait is unsafe; its calls are handed on as they are"
)]
unsafe impl GlobalAlloc for EndingAllocator {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        self.checked(unsafe { System.alloc(layout) }, layout.size())
    }

    unsafe fn alloc_zeroed(&self, layout: Layout) -> *mut u8 {
        self.checked(unsafe { System.alloc_zeroed(layout) }, layout.size())
    }

    unsafe fn realloc(&self, pointer: *mut u8, layout: Layout, size: usize) -> *mut u8 {
        self.checked(unsafe { System.realloc(pointer, layout, size) }, size)
    }

    unsafe fn dealloc(&self, pointer: *mut u8, layout: Layout) {
        unsafe { System.dealloc(pointer, layout) }
    }
}
