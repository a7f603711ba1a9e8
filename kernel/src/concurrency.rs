//! Parallel maps whose results do not depend on the number of threads.
//!
//! The number of threads is a property of the caller: [`with_threads`] sets it for everything that a
//! function computes. The threads belong to no thread pool: all workers of a pool may be waiting for
//! this result.

use std::cell::Cell;
use std::num::NonZeroUsize;
use std::panic::resume_unwind;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, Builder};

thread_local! {
    /// The number of threads that this thread may use, with itself; `None` for one per core.
    static THREADS: Cell<Option<NonZeroUsize>> = const { Cell::new(None) };
}

/// The result of `work`, which uses at most `threads` threads. Without this function it uses one per
/// core.
///
/// # Examples
/// ```
/// use premio_kernel::concurrency::{map, with_threads};
///
/// let squares = || map(&[1, 2, 3], 1, |x| x * x);
/// let one = std::num::NonZeroUsize::MIN;
/// assert_eq!(with_threads(one, squares), squares());
/// ```
pub fn with_threads<R>(threads: NonZeroUsize, work: impl FnOnce() -> R) -> R {
    /// Sets the number back, also when `work` panics.
    struct Restore(Option<NonZeroUsize>);
    impl Drop for Restore {
        fn drop(&mut self) {
            THREADS.set(self.0);
        }
    }
    let _restore = Restore(THREADS.replace(Some(threads)));
    work()
}

/// The result of `work`, which starts no other thread: for work that runs on one of several threads
/// already.
pub fn on_one_thread<R>(work: impl FnOnce() -> R) -> R {
    with_threads(NonZeroUsize::MIN, work)
}

/// The number of threads that this thread may use, with itself.
pub fn threads() -> usize {
    static CORES: OnceLock<usize> = OnceLock::new();
    let cores = || *CORES.get_or_init(|| thread::available_parallelism().map_or(1, usize::from));
    THREADS.get().map_or_else(cores, usize::from)
}

/// The results of `work` on every item, in order. At most one thread runs for each `grain` items; the
/// work on an item starts no other thread where there are several.
///
/// # Panics
/// `work` panics.
pub fn map<T: Sync, R: Send>(items: &[T], grain: usize, work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let most = threads().min(items.len() / grain.max(1));
    if most < 2 {
        return items.iter().map(work).collect();
    }
    // Sixteen chunks a thread balance uneven work.
    let chunk = (items.len() / (most * 16)).max(1);
    let next = AtomicUsize::new(0);
    let take = || {
        let mut results: Vec<(usize, Vec<R>)> = Vec::new();
        loop {
            let from = next.fetch_add(chunk, Ordering::Relaxed);
            if from >= items.len() {
                return results;
            }
            let part = &items[from..items.len().min(from + chunk)];
            results.push((from, part.iter().map(&work).collect()));
        }
    };
    let take = || on_one_thread(take);
    let mut results = thread::scope(|scope| {
        // Where no thread can be started, this one does all the work.
        let start = |_| Builder::new().spawn_scoped(scope, take).ok();
        let others: Vec<_> = (1..most).filter_map(start).collect();
        let mut results = take();
        for other in others {
            match other.join() {
                Ok(own) => results.extend(own),
                Err(panic) => resume_unwind(panic),
            }
        }
        results
    });
    results.sort_unstable_by_key(|(from, _)| *from);
    results.into_iter().flat_map(|(_, part)| part).collect()
}

#[cfg(test)]
mod tests {
    use super::{map, threads, with_threads};
    use std::num::NonZeroUsize;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..100).collect();
        let uneven = |x: &u64| (0..1000 * (100 - x)).fold(x * x, |y, _| std::hint::black_box(y));
        let squares: Vec<u64> = items.iter().map(|x| x * x).collect();
        for count in 1..5 {
            let count = NonZeroUsize::new(count).unwrap();
            assert_eq!(with_threads(count, || map(&items, 1, uneven)), squares);
        }
        assert_eq!(map(&[], 1, uneven), Vec::<u64>::new());
    }

    #[test]
    fn work_on_a_thread_starts_no_others() {
        let three = NonZeroUsize::new(3).unwrap();
        let items = [(); 6];
        with_threads(three, || {
            assert_eq!(map(&items, 2, |()| threads()), [1; 6]);
            assert_eq!(map(&items, 4, |()| threads()), [3; 6]);
            assert_eq!(threads(), 3);
        });
    }

    #[test]
    #[should_panic(expected = "item 7")]
    fn a_panic_is_passed_on() {
        let items: Vec<u32> = (0..20).collect();
        with_threads(NonZeroUsize::new(2).unwrap(), || {
            map(&items, 1, |x| assert_ne!(*x, 7, "item 7"));
        });
    }
}
