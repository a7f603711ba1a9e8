//! No manifest names a dependency that its sources do not use.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use toml::{Table, Value};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn manifest(folder: &Path) -> Table {
    let path = folder.join("Cargo.toml");
    let text = fs::read_to_string(&path);
    let text = text.unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    text.parse().unwrap()
}

/// The packages of the workspace, and that of the fuzz targets.
fn packages() -> Vec<PathBuf> {
    let members = manifest(&root())["workspace"]["members"].clone();
    let members: Vec<String> = members.try_into().unwrap();
    let all = members.iter().map(String::as_str).chain(["fuzz"]);
    all.map(|member| root().join(member)).collect()
}

/// The names of dependencies, each with whether tests alone may use it.
fn dependencies(manifest: &Table) -> Vec<(String, bool)> {
    let targets = manifest.get("target").and_then(Value::as_table);
    let targets = targets.into_iter().flat_map(Table::values);
    let tables = std::iter::once(manifest).chain(targets.filter_map(Value::as_table));
    let kinds = [("dependencies", false), ("dev-dependencies", true)];
    let named = tables.flat_map(|table| {
        kinds.into_iter().flat_map(|(kind, is_for_tests)| {
            let names = table.get(kind).and_then(Value::as_table);
            let names = names.into_iter().flat_map(Table::keys);
            names.map(move |name| (name.clone(), is_for_tests))
        })
    });
    named.collect()
}

/// The code of all Rust files below a folder, without lines of comments.
fn code(folder: &Path) -> String {
    let Ok(entries) = fs::read_dir(folder) else {
        return String::new();
    };
    let each = entries.map(|entry| {
        let path = entry.unwrap().path();
        match path.extension() {
            _ if path.is_dir() => code(&path),
            Some(ending) if ending == "rs" => {
                let text = fs::read_to_string(path).unwrap();
                let lines = text.lines();
                let lines = lines.filter(|line| !line.trim_start().starts_with("//"));
                lines.map(|line| format!("{line}\n")).collect()
            }
            _ => String::new(),
        }
    });
    each.collect()
}

/// Whether a path in the code starts with the crate, or an import names it.
fn is_used(name: &str, code: &str) -> bool {
    let name = name.replace('-', "_");
    let is_word = |letter: char| letter.is_alphanumeric() || letter == '_';
    code.match_indices(&name).any(|(at, _)| {
        let (before, after) = (&code[..at], &code[at + name.len()..]);
        // `::png` is the crate, and `imaging::png` is not.
        let before = match before.strip_suffix("::") {
            Some(start) if start.ends_with(is_word) => return false,
            Some(start) => start,
            None => before,
        };
        let is_import = before.ends_with("use ") && after.starts_with([';', ' ']);
        !before.ends_with(is_word) && (after.starts_with("::") || is_import)
    })
}

#[test]
fn every_dependency_is_used() {
    let mut unused = Vec::new();
    let mut count = 0;
    for folder in packages() {
        let manifest = manifest(&folder);
        let name = manifest["package"]["name"].as_str().unwrap();
        let of = |places: &[&str]| -> String {
            places
                .iter()
                .map(|place| code(&folder.join(place)))
                .collect()
        };
        // A package of tests has no other users of its dependencies.
        let is_for_tests = ["premio-tests", "premio-fuzz"].contains(&name);
        let library = of(&["src"]);
        let all = of(&["src", "tests", "benches", "examples", "fuzz_targets"]);
        for (dependency, dev) in dependencies(&manifest) {
            count += 1;
            let code = if dev || is_for_tests { &all } else { &library };
            if !is_used(&dependency, code) {
                unused.push(format!("{name} does not use {dependency}"));
            }
        }
    }
    assert!(count > 100, "{count}");
    assert!(unused.is_empty(), "{}", unused.join("\n"));
}

#[test]
fn every_dependency_of_the_workspace_is_taken() {
    let known = manifest(&root())["workspace"]["dependencies"].clone();
    let known: BTreeSet<String> = known.as_table().unwrap().keys().cloned().collect();
    let packages = packages();
    let taken = packages.iter().flat_map(|p| dependencies(&manifest(p)));
    let taken: BTreeSet<String> = taken.map(|(name, _)| name).collect();
    let left: Vec<_> = known.difference(&taken).collect();
    assert!(left.is_empty(), "no package takes {left:?}");
}

#[test]
fn a_word_is_no_use() {
    for used in [
        "use image::Rgb;",
        "    image::load(x)",
        "use image;",
        "use image as pictures;",
        "use ::image::Rgb;",
        "fn f(x: &image::Rgb) {}",
    ] {
        assert!(is_used("image", used), "{used}");
    }
    for other in [
        "use crate::image::Rgb;",
        "let image = 3;",
        "my_image::load(x)",
        "use images::Rgb;",
        "mod image;",
    ] {
        assert!(!is_used("image", other), "{other}");
    }
    assert!(is_used("zune-jpeg", "use zune_jpeg::JpegDecoder;"));
}
