//! Descriptions in several files, and values from the command line: what is measured, and what is
//! refused where.

use crate::common::{SETUPS, assert_says, command, folder, premio, refused, said};
use serde_json::Value;
use std::fs;
use std::path::Path;

const HOLES: &str = "# Holes along z.
HOLE(D, L=20) = CYL(R=D/2, H=L) AT (MOVZ=-L/2)
";

/// A plate with holes in its corners.
const PLATE: &str = "INCLUDE \"lib/holes.padl\"
L = 60
N = 2
PLATE = BLO(X=L, Y=40, Z=4)
PART = PLATE DIF FOR i=0..N-1: FOR j=0..1:
  HOLE(D=6) AT (MOVX=10 + i*(L-20), MOVY=10 + 20*j)
";

/// The area of its holes.
const HOLE: f64 = 9.0 * std::f64::consts::PI;

fn plate() -> tempfile::TempDir {
    let folder = folder(&[("plate.padl", PLATE), ("setups.toml", SETUPS)]);
    fs::create_dir(folder.path().join("lib")).unwrap();
    fs::write(folder.path().join("lib/holes.padl"), HOLES).unwrap();
    folder
}

#[track_caller]
fn volume(folder: &Path, words: &str) -> f64 {
    let output = premio(folder, &format!("info {words} --json"));
    assert!(output.status.success(), "{words}: {}", said(&output));
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    value["volume"].as_f64().unwrap()
}

#[track_caller]
fn assert_volume(folder: &Path, words: &str, expected: f64) {
    let found = volume(folder, words);
    assert!(
        (found - expected).abs() < 1e-9 * expected,
        "{words}: {found}, not {expected}"
    );
}

#[test]
fn files_are_included_and_values_overridden() {
    let folder = plate();
    let path = folder.path();
    let expected = |l: f64, holes: f64| 4.0 * (l * 40.0 - holes * HOLE);
    assert_volume(path, "plate.padl", expected(60.0, 4.0));
    assert_volume(path, "plate.padl -D L=80", expected(80.0, 4.0));
    assert_volume(path, "plate.padl -DL=2*45 -D N=1", expected(90.0, 2.0));
    assert_volume(
        path,
        "plate.padl --define N=max(1,0) --part PART",
        expected(60.0, 2.0),
    );
    // The file is named from another folder.
    fs::create_dir(path.join("other")).unwrap();
    let other = path.join("other");
    assert_volume(&other, "../plate.padl", expected(60.0, 4.0));
}

#[test]
fn every_language_is_written_from_it() {
    let folder = plate();
    let path = folder.path();
    for language in ["padl", "json", "csg"] {
        let words = format!("convert plate.padl out.{language} --exact -D L=70");
        let output = premio(path, &words);
        assert!(output.status.success(), "{words}: {}", said(&output));
        let expected = 4.0 * (70.0 * 40.0 - 4.0 * HOLE);
        assert_volume(path, &format!("out.{language}"), expected);
    }
    let written = fs::read_to_string(path.join("out.padl")).unwrap();
    assert!(
        !written.contains("INCLUDE") && !written.contains("FOR"),
        "{written}"
    );
}

#[test]
fn a_model_needs_no_other_file() {
    let folder = plate();
    let path = folder.path();
    let words = "model plate.padl --setups setups.toml -D L=80 -o plate.model";
    let output = premio(path, words);
    assert!(output.status.success(), "{}", said(&output));
    fs::remove_file(path.join("lib/holes.padl")).unwrap();
    let text = fs::read_to_string(path.join("plate.model")).unwrap();
    let head: Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    let description = head["description"]["text"].as_str().unwrap();
    fs::write(path.join("again.padl"), description).unwrap();
    assert_volume(path, "again.padl", 4.0 * (80.0 * 40.0 - 4.0 * HOLE));
    assert_says(description, &["HOLE(D, L=20)", "L = (80)"]);
    assert!(!description.contains("INCLUDE"), "{description}");
}

#[test]
fn what_cannot_be_included_is_refused() {
    let folder = plate();
    let path = folder.path();
    fs::create_dir(path.join("folder.padl")).unwrap();
    fs::write(path.join("binary.padl"), b"A = 1\nB = \x00\xff\xfe").unwrap();
    fs::write(path.join("cycle.padl"), "INCLUDE \"./part.padl\"\n").unwrap();
    fs::write(path.join("long.padl"), "# ".repeat(500)).unwrap();
    let include = |name: &str, options: &str| {
        fs::write(
            path.join("part.padl"),
            format!("A = 1\n INCLUDE \"{name}\"\nP = SPH(R=1)\n"),
        )
        .unwrap();
        refused(path, &format!("info part.padl {options}"))
    };
    for (name, words) in [
        (
            "none.padl",
            ["part.padl:2:10: found `none.padl`", "No such file"],
        ),
        (
            "folder.padl",
            ["part.padl:2:10: found `folder.padl`", "a folder"],
        ),
        (
            "binary.padl",
            [
                "binary.padl:2:6: found the byte 0xff",
                "on line 2 of part.padl",
            ],
        ),
        (
            "cycle.padl",
            [
                "cycle.padl:1:9: found `./part.padl`",
                "part.padl, cycle.padl",
            ],
        ),
        (
            "part.padl",
            ["part.padl:2:10: found `part.padl`", "includes itself"],
        ),
        (
            "/etc/passwd",
            ["part.padl:2:10: found `/etc/passwd`", "relative"],
        ),
        (
            "../../../../etc/passwd",
            ["part.padl:2:10: found", "ends in `.padl`"],
        ),
        ("", ["part.padl:2:10: found ``", "ends in `.padl`"]),
    ] {
        let said = include(name, "");
        assert_says(&said, &words);
        assert_says(&said, &["^"]);
    }
    assert_says(
        &include("long.padl", "--max-input 200"),
        &["part.padl:2:10: ", "--max-input"],
    );
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("loop.padl", path.join("loop.padl")).unwrap();
        assert_says(
            &include("loop.padl", ""),
            &["part.padl:2:10: ", "symbolic links"],
        );
    }
}

#[test]
fn the_place_of_an_error_is_in_its_file() {
    let folder = plate();
    let path = folder.path();
    fs::write(path.join("lib/holes.padl"), "HOLE(D) = CYL(R=D/2 -, H=9)\n").unwrap();
    assert_says(
        &refused(path, "info plate.padl"),
        &[
            "lib/holes.padl:1:22: found `,`",
            "1 | HOLE(D) = CYL(R=D/2 -, H=9)",
            "on line 1 of plate.padl",
        ],
    );
    fs::write(path.join("lib/holes.padl"), "HOLE(D) = CYL(R=D/2-3, H=9)\n").unwrap();
    let said = refused(path, "info plate.padl --json");
    let line: Value = serde_json::from_str(&said).unwrap();
    assert_eq!(
        (&line["file"], &line["line"]),
        (&"lib/holes.padl".into(), &1.into())
    );
    assert_eq!(line["column"], 17);
    assert_says(
        line["help"].as_str().unwrap(),
        &["in `HOLE` used on line 6 of plate.padl", "`i` is 0"],
    );
}

#[test]
fn a_wrong_value_is_refused() {
    let folder = plate();
    let path = folder.path();
    fs::write(path.join("ball.csg"), "sphere($fn = 100, r = 1);").unwrap();
    for (words, expected) in [
        (
            "plate.padl -D l=3",
            ["-D l:1:1: found no number called `l`", "`L`, `N`"],
        ),
        (
            "plate.padl -D L=3+",
            ["-D L:1:5: found the end of the value", "3 |"],
        ),
        (
            "plate.padl -D L=PLATE",
            ["-D L:1:3: found the unknown name", "`PLATE`"],
        ),
        (
            "plate.padl -D PLATE=3",
            ["plate.padl:4:1: found `PLATE`", "a solid"],
        ),
        (
            "plate.padl -D HOLE=3",
            ["holes.padl:2:1: found `HOLE`", "parameters"],
        ),
        (
            "plate.padl -D L=1 -D L=2",
            ["-D L:1:1: found `L` a second time", "one value"],
        ),
        (
            "plate.padl -D L=-80",
            ["plate.padl:4:15: found the value -80", "greater than zero"],
        ),
        ("plate.padl -D L", ["NAME=VALUE", "L=80"]),
        ("plate.padl -D =3", ["NAME=VALUE", "L=80"]),
        (
            "ball.csg -D L=3",
            ["ball.csg:1:1: found another value for `L`", "`.padl`"],
        ),
    ] {
        let said = refused(path, &format!("info {words}"));
        let [found, other] = expected;
        assert_says(&said, &[found]);
        assert!(said.contains(other) || other == "3 |", "{words}: {said}");
    }
    let said = command(path, "convert ball.csg ball.json -D L=3")
        .output()
        .unwrap();
    assert_eq!(said.status.code(), Some(2));
}

#[test]
fn an_output_is_no_included_file() {
    let folder = plate();
    let path = folder.path();
    for words in [
        "convert plate.padl lib/holes.padl",
        "convert plate.padl ./lib/../lib/holes.padl",
        "export plate.padl --format step -o lib/holes.padl",
    ] {
        let said = refused(path, words);
        assert_says(
            &said,
            &["plate.padl:1:9: found `lib/holes.padl`", "an output"],
        );
    }
    assert_eq!(
        fs::read_to_string(path.join("lib/holes.padl")).unwrap(),
        HOLES
    );
}

#[test]
fn rounding_is_said_once() {
    let folder = folder(&[]);
    let path = folder.path();
    let text = "A = 2\nP = SPH(R=sqrt(A)) UN (FOR i=1..5: SPH(R=cos(i)) AT (MOVX=5*i))\n";
    fs::write(path.join("root.padl"), text).unwrap();
    let output = premio(path, "info root.padl");
    assert!(output.status.success());
    let said = said(&output);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert_says(
        &said,
        &[
            "root.padl:2: note: this value of `sqrt`",
            "nearest f64",
            "5 times more",
        ],
    );
    let output = premio(path, "info root.padl -D A=4 --part A");
    assert_eq!(output.status.code(), Some(2));
}
