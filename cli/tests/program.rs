//! The program from outside: exit status, messages, output.

use crate::common::{self, command, premio};
use serde_json::Value;
use std::fs;
use std::process::{Output, Stdio};

fn folder() -> tempfile::TempDir {
    common::folder(&[])
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).unwrap()
}

#[test]
fn info_measures_the_solid() {
    let folder = folder();
    let info = json(&premio(folder.path(), "info part.padl --json"));
    let volume = 48.0 - 2.0 * std::f64::consts::PI;
    assert!((info["volume"].as_f64().unwrap() - volume).abs() < 1e-10);
    assert_eq!(info["schema"], "premio.info/1");
    assert_eq!(info["genus"], serde_json::json!([1]));
    assert_eq!(info["faces_by_surface"]["plane"], 6);
    let base = json(&premio(folder.path(), "info part.padl --json --part BASE"));
    assert!((base["volume"].as_f64().unwrap() - 48.0).abs() < 1e-10);
}

#[test]
fn an_empty_solid_is_no_error() {
    let folder = folder();
    let text = "A = SPH(R=1)\nB = A INT A AT (MOVX=3)\n";
    fs::write(folder.path().join("empty.padl"), text).unwrap();
    let info = json(&premio(folder.path(), "info empty.padl --json"));
    assert_eq!(
        (info["volume"].as_f64(), info["faces"].as_u64()),
        (Some(0.0), Some(0))
    );
    assert!(premio(folder.path(), "check empty.padl").status.success());
}

#[test]
fn contours_and_drawings() {
    let folder = folder();
    let view = "contours part.padl --eye 20,-15,12 --target 3,2,1";
    let contours = json(&premio(
        folder.path(),
        &format!("{view} --format json --samples 2"),
    ));
    assert_eq!(contours["schema"], "premio.contours/1");
    let piece = &contours["contours"][0]["pieces"][0];
    assert_eq!(piece["samples"].as_array().unwrap().len(), 2);
    for format in ["svg", "dxf"] {
        let out = premio(
            folder.path(),
            &format!("{view} --format {format} -o out.{format}"),
        );
        assert!(out.status.success() && out.stdout.is_empty());
        let text = fs::read_to_string(folder.path().join(format!("out.{format}"))).unwrap();
        assert!(!text.is_empty());
    }
}

#[test]
fn the_object_model_relates_faces_and_arcs() {
    let folder = folder();
    let model = json(&premio(folder.path(), "export part.padl --format json"));
    let edges = model["relations"]["edge"].as_array().unwrap();
    assert_eq!(edges.len(), model["arcs"].as_array().unwrap().len());
    assert!(
        edges
            .iter()
            .all(|e| e["faces"].as_array().unwrap().len() == 2)
    );
    let vertices = model["relations"]["vertex"].as_array().unwrap();
    assert!(
        vertices.len() == 8
            && vertices
                .iter()
                .all(|v| v["arcs"].as_array().unwrap().len() == 3)
    );
}

#[test]
fn check_holds() {
    let folder = folder();
    let out = premio(folder.path(), "check part.padl");
    assert!(
        out.status.success(),
        "{}",
        String::from_utf8_lossy(&out.stdout)
    );
}

#[test]
fn wrong_input_ends_with_2() {
    let folder = folder();
    fs::write(
        folder.path().join("bad.padl"),
        "A = SPH(R=1)\nB = A DUF A\n",
    )
    .unwrap();
    let out = premio(folder.path(), "info bad.padl");
    let said = String::from_utf8_lossy(&out.stderr).into_owned();
    assert_eq!(out.status.code(), Some(2));
    assert!(
        said.contains("bad.padl:2:7") && said.contains("B = A DUF A") && said.contains('^'),
        "{said}"
    );
    for words in [
        "",
        "info",
        "info absent.padl",
        "info part.step",
        "info part.padl --part NONE",
        "info part.padl --resolution -1",
        "contours part.padl",
        "contours part.padl --format json --target 0,0,0",
        "contours part.padl --format json --eye 0,0,0 --target 0,0,0",
        "contours part.padl --format json --eye 9,9,9 --target 0,0,0 --up 0,0,0",
        "export part.padl --format json -o no/such/folder/out.json",
        "contours part.padl --views front --format json",
        "contours part.padl --views front --scale 1000:1 --format svg",
        "contours part.padl --eye 9,9,9 --target 0,0,0 --scale 1:1 --format svg",
        "man nothing",
        "completions tcsh",
        "export part.padl --format stl --unit mm",
        "export part.padl --format step --deviation 0.1",
        "export part.padl --format glb --accuracy 0.1",
        "export part.padl --format 3mf --angle 0",
    ] {
        let out = premio(folder.path(), words);
        assert_eq!(out.status.code(), Some(2), "{words}");
        assert!(out.stdout.is_empty() && !out.stderr.is_empty(), "{words}");
    }
}

#[test]
fn a_close_call_ends_with_3_under_strict() {
    let folder = folder();
    let text = "A = BLO(X=1, Y=1, Z=1)\nB = A UN A AT (MOVX=1.0000000001)\n";
    fs::write(folder.path().join("close.padl"), text).unwrap();
    assert!(premio(folder.path(), "info close.padl").status.success());
    let strict = premio(folder.path(), "info close.padl --strict");
    assert_eq!(strict.status.code(), Some(3));
    assert!(strict.stdout.is_empty());
    assert!(String::from_utf8_lossy(&strict.stderr).contains("apart at"));
}

#[test]
fn what_nearly_coincides_is_apart_by_exact() {
    let folder = folder();
    let text = "A = BLO(X=1, Y=1, Z=1)\nB = A UN A AT (MOVX=1.00000000000000000001)\n";
    fs::write(folder.path().join("close.padl"), text).unwrap();
    let solids = |words: &str| {
        let info = premio(folder.path(), &format!("info close.padl --json {words}"));
        let info: serde_json::Value = serde_json::from_slice(&info.stdout).unwrap();
        info["solids"].as_u64()
    };
    assert_eq!((solids(""), solids("--exact")), (Some(1), Some(2)));
    let both = premio(folder.path(), "info close.padl --exact --resolution 1");
    assert_eq!(both.status.code(), Some(2));
}

#[test]
fn no_decision_is_in_doubles_where_none_is_to_be() {
    let folder = folder();
    let info = |words: &str| -> serde_json::Value {
        let told = premio(folder.path(), &format!("info part.padl --json {words}"));
        serde_json::from_slice(&told.stdout).unwrap()
    };
    let (plain, again) = (info(""), info("--unfiltered"));
    let count = |info: &serde_json::Value, kind: &str| info["decisions"][kind].as_u64().unwrap();
    assert!(count(&plain, "filtered") > 0 && count(&again, "filtered") == 0);
    assert!(count(&again, "refined") > 0 && count(&again, "exact") == 0);
    for same in [
        "solids",
        "faces",
        "edges",
        "loops",
        "vertices",
        "resolution",
    ] {
        assert_eq!(plain[same], again[same], "{same}");
    }
}

#[test]
fn nobody_has_to_read_to_the_end() {
    let folder = folder();
    let mut child = command(folder.path(), "export part.padl --format json")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let out = child.wait_with_output().unwrap();
    assert!(!String::from_utf8_lossy(&out.stderr).contains("panicked"));
    assert!(out.status.code().is_some());
}

#[test]
fn manual_pages_and_completions_are_of_the_commands() {
    let folder = folder();
    let said = |words: &str| {
        let out = premio(folder.path(), words);
        assert!(out.status.success(), "{words}");
        String::from_utf8(out.stdout).unwrap()
    };
    assert!(said("man").contains(".TH premio 1"));
    let page = said("man contours");
    assert!(page.contains(".TH premio-contours 1") && page.contains("views"));
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        assert!(
            said(&format!("completions {shell}")).contains("contours"),
            "{shell}"
        );
    }
}

/// The lines of standard error, each a message for programs.
fn messages(output: &Output) -> Vec<Value> {
    let text = String::from_utf8(output.stderr.clone()).unwrap();
    let lines = text.lines().map(|line| serde_json::from_str(line).unwrap());
    lines
        .inspect(|line: &Value| assert_eq!(line["schema"], "premio.message/1"))
        .collect()
}

#[test]
fn programs_are_told_in_json() {
    let folder = folder();
    fs::write(
        folder.path().join("bad.padl"),
        "A = SPH(R=1)\nB = SPG(R=2)\n",
    )
    .unwrap();
    let output = premio(folder.path(), "info bad.padl --json");
    assert_eq!(output.status.code(), Some(2));
    let [error] = &messages(&output)[..] else {
        panic!("{output:?}")
    };
    assert_eq!(
        (&error["level"], &error["status"]),
        (&"error".into(), &2.into())
    );
    assert_eq!(
        (&error["file"], &error["line"], &error["column"]),
        (&"bad.padl".into(), &2.into(), &5.into())
    );
    // Before the command, and whatever it writes.
    let output = premio(folder.path(), "--json export none.padl --format step");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(messages(&output).len(), 1);
    let output = premio(
        folder.path(),
        "contours part.padl --json --format svg --ortho",
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(
        messages(&output)[0]["text"]
            .as_str()
            .unwrap()
            .contains("--camera")
    );
    // Close calls have their places.
    let near = "PART = BLO(X=1, Y=1, Z=1) UN BLO(X=1, Y=1, Z=1) AT (MOVX=1.0000000001)\n";
    fs::write(folder.path().join("near.padl"), near).unwrap();
    let output = premio(folder.path(), "info near.padl --strict --json");
    assert_eq!(output.status.code(), Some(3));
    let calls = messages(&output)[0]["close_calls"]
        .as_array()
        .unwrap()
        .len();
    assert!(calls > 0);
    let output = premio(folder.path(), "info near.padl --json");
    assert!(output.status.success());
    assert_eq!(messages(&output)[0]["level"], "note");
}

#[test]
fn checks_for_programs() {
    let folder = folder();
    let report = json(&premio(folder.path(), "check part.padl --rays 2000 --json"));
    assert_eq!(
        (&report["schema"], &report["holds"]),
        (&"premio.check/1".into(), &true.into())
    );
    assert_eq!(report["checks"][0]["subject"], "topology");
}

#[test]
fn descriptions_are_converted() {
    let folder = folder();
    let path = |name: &str| folder.path().join(name);
    let volume =
        |file: &str| json(&premio(folder.path(), &format!("info {file} --json")))["volume"].clone();
    let there = premio(folder.path(), "convert part.padl part.json");
    assert!(there.status.success() && there.stderr.is_empty() && there.stdout.is_empty());
    let back = premio(folder.path(), "convert part.json again.padl --exact");
    assert!(back.status.success(), "{back:?}");
    assert_eq!(volume("again.padl"), volume("part.padl"));
    // Numbers that a language cannot express are reported, or refused.
    fs::write(path("third.padl"), "P = SPH(R=1/3) UN BLO(X=1, Y=1, Z=1)\n").unwrap();
    let near = premio(folder.path(), "convert third.padl third.json");
    let said = String::from_utf8(near.stderr).unwrap();
    assert!(
        near.status.success() && said.contains("1 primitive of 2 cannot be held exactly by .json"),
        "{said}"
    );
    let refused = premio(folder.path(), "convert third.padl exact.json --exact");
    assert_eq!(refused.status.code(), Some(3));
    assert!(!path("exact.json").exists());
    // Faces that differ in six digits coincide in a .csg only.
    let turned = |offset: &str| {
        format!("multmatrix([[0.866025,-0.5,0,{offset},[0,0,1,0],[0,0,0,1]]) {{ cube(10); }}\n")
    };
    let six = turned("0],[0.5,0.866025,0,0]") + &turned("8.66025],[0.5,0.866025,0,5]");
    fs::write(path("six.csg"), six).unwrap();
    let said = premio(folder.path(), "convert six.csg six.padl").stderr;
    assert!(
        String::from_utf8(said)
            .unwrap()
            .contains("numbers of few digits")
    );
    let refused = premio(folder.path(), "convert six.csg six.json --exact");
    assert_eq!(refused.status.code(), Some(3));
    // Other languages are read only.
    let scene = "#declare R = 2;\ndifference { box { -R, R } sphere { 0, R } cylinder { -3*y, 3*y, 1 rotate 90*x } }";
    fs::write(path("scene.pov"), scene).unwrap();
    let there = premio(folder.path(), "convert scene.pov scene.padl");
    assert!(there.status.success(), "{there:?}");
    assert_eq!(volume("scene.padl"), volume("scene.pov"));
    assert_eq!(
        premio(folder.path(), "convert part.padl part.pov")
            .status
            .code(),
        Some(2)
    );
    assert_eq!(
        premio(folder.path(), "convert part.padl part.txt")
            .status
            .code(),
        Some(2)
    );
    assert_eq!(
        premio(folder.path(), "convert scene.pov one.padl --part R")
            .status
            .code(),
        Some(2)
    );
}

/// A plate with enough holes, and balls that overlap, for several threads at every stage.
#[test]
fn the_bytes_are_the_same_for_any_number_of_threads() {
    let folder = tempfile::tempdir().unwrap();
    let text = "PLATE = BLO(X=60, Y=60, Z=4)
PART = (PLATE
  DIF FOR i=0..6: FOR j=0..6: CYL(R=2, H=6) AT (MOVX=8*i+6, MOVY=8*j+6, MOVZ=-1)
  UN FOR i=0..9: SPH(R=3+i/10) AT (MOVX=5*i+5, MOVY=2*i+20, MOVZ=9-i/3)
  DIF TOR(RMAJ=20, RMIN=1.5) AT (MOVX=30, MOVY=30, MOVZ=4))
";
    fs::write(folder.path().join("part.padl"), text).unwrap();
    let of = |threads: u32| {
        let run = |words: &str| {
            let output = premio(folder.path(), &format!("{words} --threads {threads}"));
            assert!(output.status.success(), "{output:?}");
            output.stdout
        };
        [
            "export part.padl --format json",
            "export part.padl --format step",
            "contours part.padl --views front,top,iso --hidden --format svg",
        ]
        .map(run)
    };
    let one = of(1);
    assert!(one.iter().all(|bytes| bytes.len() > 10_000));
    for threads in [2, 5] {
        assert!(of(threads) == one, "{threads} threads");
    }
}
