//! Structural rules: no dependencies that run backwards or in a circle, no tolerances outside their
//! place, no disabled tests, no overlong files.

mod modules;

use modules::{Arrow, Modules, circles};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Each package, with the workspace packages on which it may depend.
const LAYERS: &[(&str, &str, &[&str])] = &[
    ("text", "premio-text", &[]),
    ("memory", "premio-memory", &[]),
    ("kernel", "premio-kernel", &[]),
    ("csg", "premio-csg", &["premio-kernel", "premio-text"]),
    (
        "visibility",
        "premio-visibility",
        &["premio-kernel", "premio-text"],
    ),
    (
        "drawing",
        "premio-drawing",
        &["premio-visibility", "premio-kernel", "premio-text"],
    ),
    ("detect", "premio-detect", &["premio-text"]),
    // Its tests make boundaries of descriptions.
    (
        "exchange",
        "premio-exchange",
        &["premio-kernel", "premio-text", "premio-csg"],
    ),
    (
        "predict",
        "premio-predict",
        &[
            "premio-visibility",
            "premio-detect",
            "premio-kernel",
            "premio-text",
        ],
    ),
    // Its tests make boundaries of descriptions.
    (
        "match",
        "premio-matching",
        &[
            "premio-predict",
            "premio-detect",
            "premio-visibility",
            "premio-kernel",
            "premio-text",
            "premio-csg",
        ],
    ),
    (
        "verify",
        "premio-verify",
        &[
            "premio-kernel",
            "premio-csg",
            "premio-visibility",
            "premio-drawing",
            "premio-exchange",
        ],
    ),
    (
        "premio",
        "premio",
        &[
            "premio-verify",
            "premio-kernel",
            "premio-text",
            "premio-csg",
            "premio-visibility",
            "premio-drawing",
            "premio-detect",
            "premio-exchange",
            "premio-predict",
            "premio-matching",
        ],
    ),
    (
        "cli",
        "premio-cli",
        &[
            "premio",
            "premio-verify",
            "premio-kernel",
            "premio-memory",
            "premio-text",
            "premio-csg",
            "premio-visibility",
            "premio-drawing",
            "premio-detect",
            "premio-exchange",
            "premio-predict",
            "premio-matching",
        ],
    ),
];

/// The stages inside crates, in order. A module may depend on those before it in the same line or
/// in an earlier one.
const STAGES: &[(&str, &[&[&str]])] = &[
    (
        "kernel",
        &[
            &["unit", "colour", "concurrency", "hash", "random", "number"],
            &["motion"],
            &["geometry"],
            &["proof", "brep"],
            &["tessellation"],
        ],
    ),
    (
        "visibility",
        &[
            &["camera"],
            &["image_curve"],
            &["scene"],
            &["contour_generator"],
            &["junction"],
            &["ray_casting"],
            &["invisibility"],
            &["contours"],
        ],
    ),
    (
        "match",
        &[
            &["camera"],
            &["image"],
            &["part"],
            &["pose"],
            &["hypothesis"],
            &["correspondence"],
            &["search"],
            &["verification"],
            &["matcher"],
            &["tracker"],
            &["output"],
        ],
    ),
];

/// The circles that remain: the crate, the modules that use each other, and the reason.
const CIRCLES: &[(&str, &[&str], &str)] = &[
    (
        "premio",
        &[
            "camera",
            "error",
            "expression",
            "mesh",
            "model",
            "picture",
            "predict",
            "read",
            "solid",
            "view",
            "write",
        ],
        "the facade: its types make each other by methods, and one error has the errors of all",
    ),
    (
        "visibility",
        &[
            "junction::intersect",
            "junction::intersect_general",
            "junction::overlap",
        ],
        "pairs of curves: the general case has the types of the others, and these call it",
    ),
    (
        "drawing",
        &["image_arcs", "once", "supports"],
        "the arcs of a drawing, their order and the supports on which they are united",
    ),
    (
        "match",
        &[
            "verification::part_match",
            "verification::scoring",
            "verification::shape_evidence",
        ],
        "a match has its scores, and these are computed of the match",
    ),
];

/// The number of lines above which a file should be split.
const LONG: usize = 600;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

#[test]
fn dependencies_flow_one_way() {
    for (folder, package, allowed) in LAYERS {
        let Ok(manifest) = fs::read_to_string(root().join(folder).join("Cargo.toml")) else {
            continue;
        };
        for name in dependencies(&manifest) {
            assert!(
                allowed.contains(&name.as_str()),
                "{package} must not depend on {name}"
            );
        }
    }
}

#[test]
fn data_flows_down_the_stages() {
    for (folder, stages) in STAGES {
        let source = root().join(folder).join("src");
        let rank = |name: &str| stages.iter().position(|stage| stage.contains(&name));
        for path in sources() {
            let Ok(inside) = path.strip_prefix(&source) else {
                continue;
            };
            let first = inside.components().next().unwrap().as_os_str();
            let module = Path::new(first).with_extension("");
            let module = module.to_str().unwrap();
            if module == "lib" || is_for_tests(&path) {
                continue;
            }
            let own = rank(module);
            let own = own.unwrap_or_else(|| panic!("{folder}: {module} is no stage"));
            for (line, text) in code(&fs::read_to_string(&path).unwrap()) {
                for after in text.split("crate::").skip(1) {
                    let is_name = |c: char| c.is_alphanumeric() || c == '_';
                    let used = after.split(|c| !is_name(c)).next().unwrap();
                    assert!(
                        rank(used).is_none_or(|r| r <= own),
                        "{}:{line}: {module} must not depend on {used}",
                        path.display()
                    );
                }
            }
        }
    }
}

#[test]
fn modules_do_not_use_each_other_in_a_circle() {
    let mut wrong = String::new();
    for (folder, _, _) in LAYERS {
        let arrows = Modules::read(&root().join(folder).join("src")).arrows();
        let circles = circles(&arrows);
        for circle in &circles {
            if !CIRCLES.iter().any(|known| is_known(known, folder, circle)) {
                let places = circle.iter().map(|arrow| format!("\n    {}", arrow.place));
                wrong += &format!("\n  {folder}:{}", places.collect::<String>());
            }
        }
        for known in CIRCLES.iter().filter(|known| known.0 == *folder) {
            let (_, modules, _) = known;
            let used = circles.iter().any(|circle| is_known(known, folder, circle));
            assert!(used, "{folder}: there is no circle of {modules:?} any more");
        }
    }
    assert!(wrong.is_empty(), "circles of modules:{wrong}");
}

/// Whether a circle has no modules but those of an exception.
fn is_known(known: &(&str, &[&str], &str), folder: &str, circle: &[Arrow]) -> bool {
    let (crate_folder, modules, _) = known;
    let is_in = |path: &[String]| {
        let name = path.join("::");
        modules
            .iter()
            .any(|module| name == *module || name.starts_with(&format!("{module}::")))
    };
    *crate_folder == folder
        && circle
            .iter()
            .all(|arrow| is_in(&arrow.from) && is_in(&arrow.to))
}

#[test]
fn circles_are_found_through_imports_and_reexports() {
    let read = |text: &str| {
        let modules = Modules::from_items(&syn::parse_file(text).unwrap().items);
        let circles = circles(&modules.arrows());
        let names = |circle: &Vec<Arrow>| {
            let names = circle.iter().map(|arrow| arrow.from.join("::"));
            names
                .collect::<BTreeSet<_>>()
                .into_iter()
                .collect::<Vec<_>>()
                .join(" ")
        };
        circles.iter().map(names).collect::<Vec<_>>()
    };
    assert_eq!(
        read("mod a { use super::b::B; pub struct A; } mod b { pub struct B(super::a::A); }"),
        ["a b"]
    );
    // By the name of a module, a re-export, every name of a module, and a macro.
    assert_eq!(
        read(
            "pub use c::C;
             mod a { use crate::b; pub fn a() { b::b(); } }
             mod b { use super::*; pub fn b() { let _ = C; } }
             mod c { pub struct C; fn c() { assert!(crate::a::a() == ()); } }"
        ),
        ["a b c"]
    );
    // Modules with a circle inside, and one that tests alone close.
    assert_eq!(
        read(
            "mod a { mod x { use super::y::Y; pub struct X; } mod y { use super::x::X; pub struct Y; } }
             mod b { use crate::c::C; }
             mod c { pub struct C; #[cfg(test)] mod tests { use crate::b; } }"
        ),
        ["a::x a::y"]
    );
}

/// The workspace packages on which a manifest depends, including those of tests.
fn dependencies(manifest: &str) -> Vec<String> {
    let mut inside = false;
    let mut found = Vec::new();
    for line in manifest.lines().map(str::trim) {
        if line.starts_with('[') {
            inside = line.ends_with("dependencies]");
            let one = line.trim_matches(['[', ']']).rsplit_once("dependencies.");
            found.extend(one.map(|(_, name)| name.to_owned()));
        } else if inside {
            let name = line.split(['.', '=', ' ']).next().unwrap_or_default();
            found.push(name.to_owned());
        }
    }
    found.retain(|name| name.starts_with("premio"));
    found
}

/// The source files of the workspace, without build output.
fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            if path.is_dir() && name != "target" && !name.starts_with('.') {
                folders.push(path);
            } else if name.ends_with(".rs") {
                found.push(path);
            }
        }
    }
    found.sort();
    assert!(found.len() > 20);
    found
}

/// The places where small literals are allowed, with the reasons.
const EXCEPTIONS: &[(&str, &str)] = &[
    (
        "csg/src/reader/scad",
        "the rounding of numbers that a file gives with six digits",
    ),
    (
        "csg/src/reader/rigid_fit.rs",
        "the rounding of a matrix by the digits that it is written with",
    ),
    (
        "csg/src/reader/brlcad",
        "the rounding of vectors that stand for a solid of ours",
    ),
];

fn is_for_tests(path: &Path) -> bool {
    let inside = path.strip_prefix(root()).unwrap();
    let folder = |name: &str| inside.components().any(|c| c.as_os_str() == name);
    folder("tests")
        || folder("benches")
        || folder("fuzz")
        || folder("examples")
        || path.ends_with("tests.rs")
}

/// The lines of a file before its tests, without comments and the contents of strings.
fn code(text: &str) -> impl Iterator<Item = (usize, String)> {
    let lines = text
        .lines()
        .take_while(|line| line.trim() != "#[cfg(test)]");
    lines.enumerate().map(|(i, line)| {
        let mut shown = String::new();
        let mut quoted = false;
        let mut before = ' ';
        for c in line.chars() {
            if c == '"' && before != '\\' {
                quoted = !quoted;
            } else if !quoted {
                shown.push(c);
            }
            before = c;
        }
        let end = shown.find("//").unwrap_or(shown.len());
        (i + 1, shown[..end].to_owned())
    })
}

/// Whether a line contains a literal like 1e-9 or 0.00001.
fn has_small_float(line: &str) -> bool {
    let inside = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
    let mut rest = line;
    while let Some(at) = rest.find("e-").or_else(|| rest.find("E-")) {
        let (before, after) = (&rest[..at], &rest[at + 2..]);
        let start = before
            .char_indices()
            .rfind(|&(_, c)| !inside(c))
            .map_or(0, |(i, c)| i + c.len_utf8());
        let number = before[start..].starts_with(|c: char| c.is_ascii_digit() || c == '.');
        if number && after.starts_with(|c: char| c.is_ascii_digit()) {
            return true;
        }
        rest = after;
    }
    line.contains("0.0000")
}

#[test]
fn tolerances_have_one_place() {
    assert!(has_small_float("x < 1e-9"));
    assert!(has_small_float("x < 1.5E-12;"));
    assert!(has_small_float("1e-9"));
    assert!(has_small_float("size-1 < ×.5e-9_f64"));
    assert!(!has_small_float("value-1"));
    assert!(!has_small_float("some1e-2"));
    assert!(!has_small_float("1e9 - 0.5"));
    let mut allowed: Vec<PathBuf> = vec![root().join("kernel/src/number")];
    allowed.extend(EXCEPTIONS.iter().map(|(folder, _)| root().join(folder)));
    let mut wrong = Vec::new();
    for path in sources() {
        if is_for_tests(&path) || allowed.iter().any(|a| path.starts_with(a)) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        for (line, text) in code(&text).filter(|(_, l)| has_small_float(l)) {
            wrong.push(format!("{}:{line}: {}", path.display(), text.trim()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The unit tests of `csg` would compile the evaluation, half of the code of a build, once more.
#[test]
fn unit_tests_of_csg_neither_evaluate_nor_read() {
    let needs_evaluation = [
        "evaluate(",
        "evaluated(",
        "evaluated::<",
        "reader::{",
        "reader::read",
    ];
    for path in sources() {
        if !path.starts_with(root().join("csg/src")) {
            continue;
        }
        let text = fs::read_to_string(&path).unwrap();
        let tests = match is_for_tests(&path) {
            true => text.as_str(),
            false => text
                .split_once("#[cfg(test)]")
                .map_or("", |(_, tests)| tests),
        };
        for word in needs_evaluation {
            assert!(!tests.contains(word), "{}: {word}", path.display());
        }
    }
}

#[test]
fn no_test_is_switched_off() {
    let switched_off = concat!("#[", "ignore");
    for path in sources() {
        let text = fs::read_to_string(&path).unwrap();
        assert!(!text.contains(switched_off), "{}", path.display());
    }
}

#[test]
fn long_files_are_named() {
    for path in sources() {
        let lines = fs::read_to_string(&path).unwrap().lines().count();
        if lines > LONG {
            // A warning only: the length of a file is a hint, not a fault.
            let text = format!("warning: {} has {lines} lines\n", path.display());
            std::io::Write::write_all(&mut std::io::stderr(), text.as_bytes()).unwrap();
        }
    }
}
