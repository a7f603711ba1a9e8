//! Outputs in the wrong place, states, cameras and numbers: refused with what was found and
//! expected.

use crate::common::{SETUP, assert_says, folder, premio, prepared, refused, said};
use std::fs;

#[test]
fn an_output_has_no_path_of_a_folder() {
    let folder = prepared();
    for words in [
        "export part.padl --format step -o new/",
        "convert part.padl new.padl/",
        "contours part.padl -o new.svg/",
        "predict part.padl --setup setup.toml --overlay new.svg/",
        "match part.model photo.png --camera camera.json --csv new/",
        "schema match -o new/",
    ] {
        assert_says(&refused(folder.path(), words), &["the path of a folder"]);
    }
}

#[test]
fn the_folder_of_models_holds_no_other_output() {
    let folder = folder(&[]);
    let path = folder.path();
    let fuzz = "fuzz --profile grid --count 1 --rays 100 --write w";
    for words in ["-o w", "--state w"] {
        assert_says(&refused(path, &format!("{fuzz} {words}")), &["`--write`"]);
    }
    fs::create_dir(path.join("w")).unwrap();
    for words in [
        "-o w/grid-0.padl",
        "--state w/grid-0.padl",
        "-o ./w/../w/out.txt",
        "--state w/manifest.jsonl",
    ] {
        let text = refused(path, &format!("{fuzz} {words}"));
        assert_says(&text, &["in the folder of `--write`", "outside"]);
    }
    assert_eq!(fs::read_dir(path.join("w")).unwrap().count(), 0);
}

#[test]
fn a_state_is_read_as_any_other_input() {
    let folder = folder(&[]);
    let path = folder.path();
    let fuzz = "fuzz --profile grid --count 1 --rays 100 --state run.json";
    assert!(premio(path, fuzz).status.success());
    let state = fs::read_to_string(path.join("run.json")).unwrap();
    let few = format!("{fuzz} --max-input 100");
    assert_says(&refused(path, &few), &["run.json", "--max-input"]);
    for (text, expected) in [
        ("{", "run.json:1:2: "),
        ("{\"schema\":\n 7}", "run.json:2:"),
        ("[]", "run.json:1:"),
        (&state.replace("state/1", "state/7"), "run.json:1:2: "),
        (&state.replace("\"right\":1", "\"right\":2"), "`done`"),
        (&state.replace("\"0\":1", "\"1\":0"), "`done`"),
    ] {
        fs::write(path.join("run.json"), text).unwrap();
        assert_says(&refused(path, fuzz), &[expected, "state of a run"]);
    }
    fs::write(path.join("run.json"), b"{\"schema\":\"\xff\"}").unwrap();
    assert_says(&refused(path, fuzz), &["run.json:1:12: ", "UTF-8"]);
}

#[test]
fn a_camera_that_took_no_such_picture_is_refused_at_its_place() {
    let folder = prepared();
    let path = folder.path();
    let matrix = |values: &str| format!("{{\n \"K\": {values}\n}}");
    for (text, expected) in [
        (
            matrix("[[290.9, 0, 79.5], [0, 290.9, 59.5], [0, 0, 1]], \"width\": 320"),
            ["bad.json:2:", "320 x 120 pixels"],
        ),
        (
            matrix("[[290.9, 0, 79.5], [0, 290.9, 59.5], [0, 0, 1]],\n\"height\": 90"),
            ["bad.json:3:1: ", "160 x 90 pixels"],
        ),
        (
            matrix("[[290.9, 0, 2000], [0, 290.9, 59.5], [0, 0, 1]]"),
            ["bad.json:2:2: ", "centre at (2000, 60)"],
        ),
        (
            // In millimetres.
            matrix("[[8, 0, 4.4], [0, 8, 3.3], [0, 0, 1]]"),
            [
                "bad.json:2:2: ",
                "8 pixels, for a picture of 160: expected 0.1 to 1000",
            ],
        ),
        (
            matrix("[[1e300, 0, 79.5], [0, 1e300, 59.5], [0, 0, 1]]"),
            ["bad.json:2:2: ", "1e300 pixels"],
        ),
        (
            matrix("[[290.9, 40, 79.5], [0, 290.9, 59.5], [0, 0, 1]]"),
            ["bad.json:2:2: ", "skew of 40 pixels"],
        ),
        (
            matrix("[[290.9, 0, 79.5], [0, 90, 59.5], [0, 0, 1]]"),
            ["bad.json:2:2: ", "290.9 and 90 pixels"],
        ),
    ] {
        fs::write(path.join("bad.json"), text).unwrap();
        let words = "match part.model photo.png --camera bad.json -o out.json";
        assert_says(&refused(path, words), &expected);
    }
    let words = "match part.jsonl photo.png --camera camera.json";
    assert_says(&refused(path, words), &["part.jsonl", ".model", ".padl"]);
}

#[test]
fn numbers_are_told_as_they_are_written() {
    let folder = prepared();
    let path = folder.path();
    for (from, to, expected) in [
        (
            "focal = 16",
            "focal = 1e300",
            ["bad.toml:7:1: ", "is 1e300 mm"],
        ),
        (
            "focal = 16",
            "focal = 1e-320",
            ["bad.toml:7:1: ", "is 1e-320 mm"],
        ),
        (
            "[160, 120]",
            "[1e9, 1e9]",
            [
                "found 1000000000.0",
                "from 0 to 18446744073709551615, written without",
            ],
        ),
        (
            "[160, 120]",
            "[320.0, 240.0]",
            ["found 320.0", "written without a point"],
        ),
        (
            "threshold = 10",
            "threshold = 10\n[features]\nreach = 1e300",
            ["is 1e300, ", "0.5 to 8 pixels"],
        ),
    ] {
        let text = SETUP.replace(from, to);
        assert_ne!(text, SETUP);
        fs::write(path.join("bad.toml"), text).unwrap();
        let text = refused(path, "predict part.padl --setup bad.toml -o out.json");
        assert_says(&text, &expected);
    }
    let output = premio(
        path,
        "contours part.padl --views front --scale 1e300:1 -o out.svg",
    );
    assert_eq!(output.status.code(), Some(2));
    assert_says(&said(&output), &["at 1e300:1 the views take 6e300 mm"]);
}
