//! A parallel map.

use std::panic::resume_unwind;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, Builder};

/// The results of `work` on every item, in order. It runs on as many threads as the machine has
/// cores. They belong to no thread pool: all workers of a pool may be waiting for this result.
pub(super) fn map<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let take = || {
        let mut results = Vec::new();
        loop {
            let index = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(index) else {
                return results;
            };
            results.push((index, work(item)));
        }
    };
    let most = thread::available_parallelism().map_or(1, usize::from);
    let others = most.min(items.len()).saturating_sub(1);
    let mut results = thread::scope(|scope| {
        // Where no thread can be started, this one does all the work.
        let start = |_| Builder::new().spawn_scoped(scope, take).ok();
        let others: Vec<_> = (0..others).filter_map(start).collect();
        let mut results = take();
        for other in others {
            match other.join() {
                Ok(own) => results.extend(own),
                Err(panic) => resume_unwind(panic),
            }
        }
        results
    });
    results.sort_by_key(|(index, _)| *index);
    results.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::map;

    #[test]
    fn results_are_in_the_order_of_the_items() {
        let items: Vec<u64> = (0..100).collect();
        let uneven = |x: &u64| (0..1000 * (100 - x)).fold(x * x, |y, _| std::hint::black_box(y));
        let squares: Vec<u64> = items.iter().map(|x| x * x).collect();
        assert_eq!(map(&items, uneven), squares);
        assert_eq!(map(&[], uneven), Vec::<u64>::new());
    }

    #[test]
    #[should_panic(expected = "item 7")]
    fn a_panic_is_passed_on() {
        let items: Vec<u32> = (0..20).collect();
        map(&items, |x| assert_ne!(*x, 7, "item 7"));
    }
}
