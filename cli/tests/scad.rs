//! `.scad` files: the program `openscad` on the path flattens them.
#![cfg(unix)]

use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

/// A stand-in for OpenSCAD: it writes a block whose length the last `-D` sets.
const STAND_IN: &str = r#"#!/bin/sh
length=1
while [ $# -gt 1 ]; do
  case "$1" in
    -o) target="$2"; shift 2 ;;
    -D) length="${2#L=}"; shift 2 ;;
    *) exit 3 ;;
  esac
done
echo "ECHO: \"from $(basename "$1")\"" >&2
grep -q broken "$1" && { echo "ERROR: Parser error" >&2; exit 1; }
echo "cube(size = [$length, 2, 3], center = false);" > "$target"
"#;

/// Runs `premio` in a folder with only a stand-in on the path.
fn run(folder: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_premio"))
        .args(arguments)
        .current_dir(folder)
        .env("PATH", format!("{}:/usr/bin:/bin", folder.display()))
        .output()
        .unwrap()
}

fn stand_in(folder: &Path) {
    let program = folder.join("openscad");
    std::fs::write(&program, STAND_IN).unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    std::fs::write(folder.join("part.scad"), "L = 1; cube([L, 2, 3]);\n").unwrap();
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The volume that `info` states.
fn volume(output: &Output) -> f64 {
    let stated = text(&output.stdout);
    let value = stated.split_whitespace().nth(1).unwrap();
    value.parse().unwrap()
}

#[test]
fn a_scad_file_is_flattened() {
    let folder = tempfile::tempdir().unwrap();
    stand_in(folder.path());
    let plain = run(folder.path(), &["info", "part.scad"]);
    let said = text(&plain.stderr);
    assert!(plain.status.success(), "{said}");
    assert!((volume(&plain) - 6.0).abs() < 1e-12);
    assert!(said.contains("ECHO: \"from part.scad\""), "{said}");
    let longer = run(folder.path(), &["info", "part.scad", "-D", "L=5"]);
    assert!((volume(&longer) - 30.0).abs() < 1e-12);
    let converted = run(folder.path(), &["convert", "part.scad", "part.padl"]);
    assert!(converted.status.success(), "{}", text(&converted.stderr));
    let padl = std::fs::read_to_string(folder.path().join("part.padl")).unwrap();
    assert!(padl.contains("BLO(X=1, Y=2, Z=3)"), "{padl}");
}

#[test]
fn failures_say_why() {
    let folder = tempfile::tempdir().unwrap();
    stand_in(folder.path());
    std::fs::write(folder.path().join("bad.scad"), "broken(\n").unwrap();
    for (file, why) in [
        ("bad.scad", "Parser error"),
        ("missing.scad", "missing.scad: No such file"),
    ] {
        let failed = run(folder.path(), &["info", file]);
        let said = text(&failed.stderr);
        assert_eq!(failed.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{said}");
    }
    std::fs::remove_file(folder.path().join("openscad")).unwrap();
    let alone = Command::new(env!("CARGO_BIN_EXE_premio"))
        .args(["info", "part.scad"])
        .current_dir(folder.path())
        .env("PATH", folder.path())
        .output()
        .unwrap();
    let said = text(&alone.stderr);
    assert_eq!(alone.status.code(), Some(2));
    assert!(said.contains("openscad -o part.csg part.scad"), "{said}");
}
