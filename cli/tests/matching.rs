//! `premio match` and `premio track` from outside: exit status, messages, files.

use crate::common::{self, premio};
use serde_json::Value;
use std::fs;
use tempfile::TempDir;

const SETUP: &str = "
ambient = 0.4
background = 0.02
[camera]
K = [[380, 0, 159.5], [0, 380, 119.5], [0, 0, 1]]
R = [[0.6, 0.8, 0], [0.48, -0.36, -0.8], [-0.64, 0.48, -0.6]]
t = [-3.0, 1.0, 16.0]
[[light]]
position = [20, -4, 30]
[material]
ambient = 0.3
diffuse = 0.25
s = 0
d = 1
m = 0.3
n = 1.5
k = 0
[sensor]
resolution = [320, 240]
white = 200
electrons = 10000
read_noise = 1
";

const SETUPS: &str = "
ambient = 0.4
background = 0.02
[viewing]
count = 12
[illumination]
count = 2
[sensor]
resolution = [160, 120]
[detector]
mask = { gaussian = { sigma = 1.0 } }
threshold = 4
low = 1.5
";

const CAMERA: &str =
    r#"{"K": [[380, 0, 159.5], [0, 380, 119.5], [0, 0, 1]], "width": 320, "height": 240}"#;

fn folder() -> TempDir {
    let small = CAMERA.replace("320", "640");
    let bent = CAMERA.replace("{\"K\"", "{\"dist\": [0.1, 0], \"K\"");
    let files = [
        ("setup.toml", SETUP),
        ("setups.toml", SETUPS),
        ("camera.json", CAMERA),
        ("small.json", &small),
        ("bent.json", &bent),
        ("wide.json", &CAMERA.replace("380", "1e-9")),
        ("none.json", "{\"projection\": \"perspective\"}"),
        // A picture of nothing.
        (
            "blank.pgm",
            &format!("P2 320 240 255\n{}", "90 ".repeat(320 * 240)),
        ),
    ];
    let folder = common::folder(&files);
    let rendered = premio(
        folder.path(),
        "render part.padl --setup setup.toml -o picture.png",
    );
    assert!(rendered.status.success(), "{rendered:?}");
    folder
}

fn json(folder: &TempDir, name: &str) -> Value {
    serde_json::from_str(&fs::read_to_string(folder.path().join(name)).unwrap()).unwrap()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

#[test]
fn a_part_is_found_by_its_description_and_by_its_model() {
    let folder = folder();
    let made = premio(
        folder.path(),
        "model part.padl --setups setups.toml -o part.model",
    );
    assert!(made.status.success(), "{made:?}");
    let schema = common::published(folder.path(), "match");
    for part in ["part.padl", "part.model"] {
        let words = format!(
            "match {part} picture.png --camera camera.json -o pose.json --overlay pose.png --csv pose.csv"
        );
        let found = premio(folder.path(), &words);
        assert!(found.status.success(), "{found:?}");
        let report = json(&folder, "pose.json");
        assert_eq!(report["schema"], "premio.match/1");
        assert_eq!(report["found"], true, "{report:#}");
        assert!(schema.is_valid(&report), "{report:#}");
        // The schema is effective: a feature's state is one of three.
        let mut wrong = report.clone();
        wrong["features"][0]["state"] = "seen".into();
        assert!(!schema.is_valid(&wrong));
        // The block is 6 by 4 by 2 with its centre at (3, 2, 1): symmetric under half turns.
        let all = [&report]
            .into_iter()
            .chain(report["alternatives"].as_array().unwrap());
        let middle = |pose: &Value, i: usize| {
            let row = [0, 1, 2].map(|j| number(&pose["R"][i][j]));
            row[0] * 3.0 + row[1] * 2.0 + row[2] + number(&pose["t"][i])
        };
        // R m + t of the setup.
        let truth = [
            0.6 * 3.0 + 0.8 * 2.0 - 3.0,
            0.48 * 3.0 - 0.36 * 2.0 - 0.8 + 1.0,
            16.0 - 0.64 * 3.0 + 0.48 * 2.0 - 0.6,
        ];
        for pose in all {
            for (i, &t) in truth.iter().enumerate() {
                let at = middle(pose, i);
                assert!((at - t).abs() < 0.15, "{part}: {at} {t}");
            }
        }
        assert!(folder.path().join("pose.png").exists());
        let csv = fs::read_to_string(folder.path().join("pose.csv")).unwrap();
        let mut lines = csv.lines();
        assert_eq!(lines.next(), Some("scene_id,im_id,obj_id,score,R,t,time"));
        let line: Vec<&str> = lines.next().unwrap().split(',').collect();
        assert_eq!(line[..3], ["1", "1", "1"]);
        // The score is the probability.
        let score: f64 = line[3].parse().unwrap();
        assert_eq!(score, number(&report["probability"]));
    }
}

#[test]
fn a_sequence_is_tracked_from_the_first_picture_on() {
    let folder = folder();
    let words = "track part.padl picture.png picture.png --camera camera.json -o poses.jsonl";
    let found = premio(folder.path(), words);
    assert!(found.status.success(), "{found:?}");
    let text = fs::read_to_string(folder.path().join("poses.jsonl")).unwrap();
    let lines: Vec<Value> = text
        .lines()
        .map(|l| serde_json::from_str(l).unwrap())
        .collect();
    let anew: Vec<&Value> = lines.iter().map(|l| &l["anew"]).collect();
    assert_eq!(anew, [&Value::Bool(true), &Value::Bool(false)]);
    assert!(lines.iter().all(|l| l["found"] == true));
}

#[test]
fn what_is_not_there_is_told_with_why() {
    let folder = folder();
    let found = premio(
        folder.path(),
        "match part.padl blank.pgm --camera camera.json -o pose.json",
    );
    assert!(found.status.success(), "{found:?}");
    let report = json(&folder, "pose.json");
    assert_eq!(report["found"], false);
    assert_eq!(
        report["reason"],
        "the detector finds no segment in the picture"
    );
}

#[test]
fn errors_of_the_input_are_reported() {
    let folder = folder();
    let wrong = [
        (
            "match part.padl picture.png --camera small.json",
            "640 x 240 pixels",
        ),
        (
            "match part.padl picture.png --camera bent.json",
            "undistort",
        ),
        (
            "match part.padl picture.png --camera none.json",
            "none.json",
        ),
        (
            "match part.padl picture.png --camera absent.json",
            "absent.json",
        ),
        (
            "match part.padl part.padl --camera camera.json",
            "part.padl",
        ),
        (
            "match setups.toml picture.png --camera camera.json",
            "unknown kind",
        ),
        (
            "match part.padl picture.png blank.pgm --camera camera.json --overlay o.png",
            "one picture",
        ),
    ];
    for (words, told) in wrong {
        let output = premio(folder.path(), words);
        assert_eq!(output.status.code(), Some(2), "{words}: {output:?}");
        let said = String::from_utf8_lossy(&output.stderr).replace('\n', " ");
        let said: Vec<&str> = said.split_whitespace().filter(|w| *w != "│").collect();
        assert!(said.join(" ").contains(told), "{words}: {said:?}");
    }
    fs::write(folder.path().join("bad.model"), "{}\n").unwrap();
    let output = premio(
        folder.path(),
        "match bad.model picture.png --camera camera.json",
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&output.stderr).contains("bad.model:1"));
}
