//! The messages for empty parts, and for eyes and lights that see nothing.

use crate::common::{SETUP, assert_says, folder, premio, said};
use std::fs;
use std::path::Path;

/// The message of a command that ends with a status.
#[track_caller]
fn ends(folder: &Path, words: &str, status: i32) -> String {
    let output = premio(folder, words);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(status), "{words}: {text}");
    text
}

#[test]
fn an_empty_part_is_said_to_be_empty() {
    let folder = folder(&[
        (
            "apart.padl",
            "A = BLO(X=60, Y=40, Z=20)\nPART = A INT BLO(X=6, Y=4, Z=2) AT (MOVX=100)\n",
        ),
        ("nothing.csg", "group();\n"),
        ("none.json", "{\"op\": \"union\", \"children\": []}\n"),
    ]);
    let path = folder.path();
    for name in ["apart.padl", "nothing.csg", "none.json"] {
        for words in [
            format!("info {name}"),
            format!("contours {name} -o out.svg"),
            format!("export {name} -o out.json"),
        ] {
            assert_says(&ends(path, &words, 0), &[name, "the part is empty"]);
        }
    }
    let words = "convert nothing.csg out.json";
    assert_says(&ends(path, words, 0), &["the part is empty"]);
}

/// Exact lengths distinguish every sliver from an empty solid, however thin; rotations are rounded
/// to f64 values.
#[test]
fn a_sliver_is_told_from_rounding() {
    let block = "A = BLO(X=1000, Y=1000, Z=1000)\n";
    let folder = folder(&[
        (
            "moved.padl",
            &format!("{block}PART = A DIF (A AT (MOVX=0.0000000000001))\n"),
        ),
        (
            "ball.padl",
            "PART = SPH(R=100) DIF SPH(R=99.9999999999999)\n",
        ),
        (
            "turned.padl",
            &format!("{block}PART = (A AT (ROTZ=30, ROTZ=60)) DIF (A AT (ROTZ=90))\n"),
        ),
    ]);
    let path = folder.path();
    for name in ["moved.padl", "ball.padl"] {
        assert_says(
            &ends(path, &format!("info {name}"), 0),
            &["1.000e-13 apart"],
        );
        ends(path, &format!("info {name} --strict"), 3);
    }
    ends(path, "info turned.padl --strict", 0);
}

#[test]
fn an_eye_in_the_part_is_refused_at_its_place() {
    let folder = folder(&[
        (
            "inside.json",
            "{\"projection\": \"perspective\",\n \"eye\": [1, 1, 1], \"target\": [9, 9, 9], \"up\": [0, 0, 1], \"focal\": 1}",
        ),
        ("setup.toml", SETUP),
    ]);
    let path = folder.path();
    let text = ends(path, "contours part.padl --camera inside.json -o a.svg", 2);
    assert_says(
        &text,
        &["inside.json:2:2", "`eye` lies inside the material"],
    );
    let text = ends(path, "contours part.padl --eye 1,1,1 -o a.svg", 2);
    assert_says(&text, &["--eye", "inside"]);
    assert!(!path.join("a.svg").exists());
    let predict = |eye: &str, light: &str| {
        let text = SETUP
            .replace("eye = [15, -16, 12]", &format!("eye = {eye}"))
            .replace("position = [4, -16, 30]", &format!("position = {light}"));
        fs::write(path.join("wrong.toml"), text).unwrap();
        ends(path, "predict part.padl --setup wrong.toml -o a.json", 2)
    };
    // In the middle of the part, which the camera looks at; on its faces.
    fs::write(path.join("part.padl"), "PART = BLO(X=6, Y=4, Z=2)\n").unwrap();
    let light = "[4, -16, 30]";
    assert_says(&predict("[3, 2, 1]", light), &["wrong.toml:3:1", "inside"]);
    assert_says(&predict("[3, 0, 1]", light), &["wrong.toml:3:1", "inside"]);
    let text = predict("[15, -16, 12]", "[3, 0, 1]");
    assert_says(&text, &["wrong.toml:5:1", "inside"]);
}

#[test]
fn a_light_without_radiance_is_none() {
    let dark = "position = [4, -16, 30]\nparallel = 0\nperpendicular = 0";
    let dark = SETUP.replace("position = [4, -16, 30]", dark);
    let folder = folder(&[("dark.toml", &dark)]);
    let text = ends(
        folder.path(),
        "predict part.padl --setup dark.toml -o out.json",
        0,
    );
    assert_says(&text, &["dark.toml", "no `[[light]]` that shines"]);
}

/// The eye is next to the part, so that the surface that reflects the light extends far outside the
/// image.
#[test]
fn a_highlight_far_outside_the_image_is_left() {
    let setup = SETUP
        .replace(
            "eye = [15, -16, 12]",
            "eye = [0.5, 4.3, 1.8]\ntarget = [3, 2, 1]",
        )
        .replace("position = [4, -16, 30]", "position = [-26.5, 29, 1]")
        .replace("[8.8, 6.6]", "[0.01, 0.01]");
    let folder = folder(&[("near.toml", &setup)]);
    let output = premio(
        folder.path(),
        "predict part.padl --setup near.toml -o out.json",
    );
    assert!(output.status.code().is_some_and(|s| s == 0 || s == 2));
}
