//! Random trees: none may be wrong in any way that can be told from outside.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use premio_tests::examine::{Depth, examine_within};
use premio_tests::random::tree;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;

/// Examines the trees of some seeds on two threads.
fn assert_all_right(from: u64, count: u64, views: bool) {
    let depth = Depth {
        rays: 20_000,
        views,
    };
    let next = AtomicU64::new(from);
    let wrong = Mutex::new(String::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let seed = next.fetch_add(1, Ordering::Relaxed);
                    if seed >= from + count {
                        return;
                    }
                    let json = tree(seed).to_string();
                    let found = examine_within(&json, depth, Duration::from_secs(60));
                    if !found.is_empty() {
                        let all = found.join("\n  ");
                        let mut wrong = wrong.lock().unwrap();
                        writeln!(wrong, "seed {seed}\n  {all}\n  {json}").unwrap();
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn solids() {
    assert_all_right(0, 300, false);
}

#[test]
fn views() {
    assert_all_right(0, 60, true);
}
