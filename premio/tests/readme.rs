//! The example of the README is the one that runs as the first doctest of the crate.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use std::fs;

/// The lines of the first block of Rust in a text.
fn first_block(text: &str, fence: &str) -> Vec<String> {
    let lines = text.lines().skip_while(|line| *line != fence).skip(1);
    let lines = lines.take_while(|line| *line != "```");
    let shown = lines.filter(|line| !line.starts_with("# "));
    shown.map(str::to_owned).collect()
}

#[test]
fn the_readme_has_the_first_doctest() {
    let folder = env!("CARGO_MANIFEST_DIR");
    let readme = fs::read_to_string(format!("{folder}/../README.md")).unwrap();
    let source = fs::read_to_string(format!("{folder}/src/lib.rs")).unwrap();
    let docs: Vec<&str> = source
        .lines()
        .filter_map(|line| line.strip_prefix("//!"))
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .collect();
    let shown = first_block(&readme, "```rust");
    assert_eq!(shown, first_block(&docs.join("\n"), "```"));
    assert_eq!(shown.len(), 7);
}

/// Expressions, solids, views and models go to other threads.
#[test]
fn values_go_to_other_threads() {
    fn is_shared<T: Send + Sync + Clone + std::fmt::Debug + 'static>() {}
    is_shared::<premio::Expression>();
    is_shared::<premio::Solid>();
    is_shared::<premio::View>();
    is_shared::<premio::Camera>();
    is_shared::<premio::TriangleMesh>();
    is_shared::<premio::Model>();
    is_shared::<premio::PictureMatch>();
    is_shared::<premio::CancelToken>();
    fn is_error<T: std::error::Error + Send + Sync + 'static>() {}
    is_error::<premio::Error>();
}
