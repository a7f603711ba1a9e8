//! Snapshots of complete outputs: every change of an output is reviewed before it is accepted.
//!
//! Numbers are kept to nine digits, so that the last bits of a platform's sine do not count.

use crate::common;
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;

/// A block with a bore: lines, circles, ellipses.
const BLOCK: &str = "PART = BLO(X=6, Y=4, Z=2) DIF CYL(R=1, H=4) AT (MOVX=3, MOVY=2, MOVZ=-1)\n";
/// A ring on a ball: limbs, a curve that is neither a line nor a conic in the image.
const RING: &str = "PART = SPH(R=3) UN TOR(RMAJ=3, RMIN=1)\n";

const VIEW: &str = "--eye 20,-15,12 --target 3,2,1";

fn premio(name: &str, text: &[u8], words: &str) -> Output {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join(name), text).unwrap();
    common::premio(folder.path(), words)
}

fn said(text: &str, words: &str) -> String {
    let output = premio("part.padl", text.as_bytes(), words);
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

fn rounded(x: f64) -> f64 {
    let short: f64 = format!("{x:.8e}").parse().unwrap();
    // Zero to rounding has no digits to keep.
    if short.abs() < 1e-12 { 0.0 } else { short }
}

/// JSON without times, rounded and laid out.
fn json(text: &str) -> String {
    fn clean(value: &mut Value) {
        match value {
            Value::Number(n) if n.is_f64() => *value = rounded(n.as_f64().unwrap()).into(),
            Value::Array(all) => all.iter_mut().for_each(clean),
            Value::Object(all) => {
                all.remove("seconds");
                // The number of evaluated decisions changes with every better algorithm.
                for count in ["filtered", "refined", "exact", "coincident"] {
                    all.entry(count).and_modify(|n| *n = "a count".into());
                }
                all.values_mut().for_each(clean);
            }
            _ => {}
        }
    }
    let mut value: Value = serde_json::from_str(text).unwrap();
    clean(&mut value);
    serde_json::to_string_pretty(&value).unwrap()
}

/// DXF with its numbers rounded.
fn dxf(text: &str) -> String {
    let line = |line: &str| match line.parse::<f64>() {
        Ok(x) if line.contains('.') => format!("{:?}\n", rounded(x)),
        _ => format!("{line}\n"),
    };
    text.lines().map(line).collect()
}

#[test]
fn info() {
    insta::assert_snapshot!("info_block", json(&said(BLOCK, "info part.padl --json")));
    insta::assert_snapshot!("info_ring", json(&said(RING, "info part.padl --json")));
}

#[test]
fn contours() {
    for (name, text) in [("block", BLOCK), ("ring", RING)] {
        let written = |format: &str| {
            said(
                text,
                &format!("contours part.padl {VIEW} --hidden --format {format}"),
            )
        };
        insta::assert_snapshot!(format!("contours_{name}_json"), json(&written("json")));
        insta::assert_snapshot!(format!("contours_{name}_svg"), written("svg"));
        insta::assert_snapshot!(format!("contours_{name}_dxf"), dxf(&written("dxf")));
    }
}

#[test]
fn sheets() {
    let words = "contours part.padl --views front,top,right,iso --hidden --title 5<6 --format";
    let written = |format: &str| said(BLOCK, &format!("{words} {format}"));
    insta::assert_snapshot!("sheet_block_svg", written("svg"));
    insta::assert_snapshot!("sheet_block_dxf", dxf(&written("dxf")));
}

#[test]
fn export() {
    insta::assert_snapshot!(
        "export_block",
        json(&said(BLOCK, "export part.padl --format json"))
    );
}

#[test]
fn messages() {
    let mut all = String::new();
    for (name, text) in [
        ("name.padl", "A = SPH(R=1)\nB = A DUF A\n"),
        ("order.padl", "B = A UN A\nA = SPH(R=1)\n"),
        ("size.padl", "A = BLO(X=1, Y=-2, Z=3)\n"),
        ("ring.padl", "A = TOR(RMAJ=2, RMIN=0)\n"),
        ("open.padl", "A = (SPH(R=1) UN\n"),
        ("nothing.padl", "# only a comment\n"),
        (
            "key.json",
            "{\"prim\": \"sphere\", \"r\": 1, \"radius\": 2}",
        ),
        ("number.json", "{\"prim\": \"sphere\", \"r\": \"one\"}"),
        ("facets.csg", "rotate_extrude($fn = 8) { circle(r = 2); }\n"),
        ("node.csg", "group() { roof() { square(size = 1); } }\n"),
        (
            "skew.csg",
            "multmatrix([[1, 0, 0, 0], [0, 2, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { rotate_extrude() { multmatrix([[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) { circle(r = 1); } } }\n",
        ),
        ("bytes.padl", "A = \u{1}\u{7f}@\n"),
    ] {
        let output = premio(name, text.as_bytes(), &format!("info {name}"));
        assert!(output.stdout.is_empty());
        let status = output.status.code().unwrap();
        let said = String::from_utf8(output.stderr).unwrap();
        all += &format!("exit status {status}\n{said}\n");
    }
    insta::assert_snapshot!("messages", all);
}

/// The README's command, run from the repository's root, draws the README's picture.
#[test]
fn the_picture_in_the_readme() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let readme = fs::read_to_string(root.join("README.md")).unwrap();
    let command = "cargo run --release -p premio-cli -- ";
    let line = readme.lines().find_map(|l| l.strip_prefix(command));
    let (words, picture) = line.unwrap().split_once(" -o ").unwrap();
    let drawn = String::from_utf8(common::premio(&root, words).stdout).unwrap();
    assert!(readme.contains(&format!("]({picture})")));
    let kept = fs::read_to_string(root.join(picture)).unwrap();
    assert!(drawn == kept, "run the README's command again, and look");
}
