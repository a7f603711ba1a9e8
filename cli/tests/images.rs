//! The commands about images from outside: exit status, messages, files.

use crate::common::{self, premio};
use serde_json::Value;
use std::fs;
use std::process::Output;

const SETUP: &str = "
[camera]
eye = [14, -11, 12]
[[light]]
position = [9, -20, 25]
[sensor]
resolution = [160, 120]
";

const SETUPS: &str = "
[viewing]
count = 6
[illumination]
count = 3
cones = [{ axis = [0, 0, 1], half_angle = 70 }]
[sensor]
resolution = [96, 72]
electrons = 8000
[features]
draws = 2
";

fn folder() -> tempfile::TempDir {
    common::folder(&[("setup.toml", SETUP), ("setups.toml", SETUPS)])
}

fn done(output: &Output) {
    assert!(output.status.success(), "{output:?}");
}

#[test]
fn a_prediction_has_five_levels_with_their_relations() {
    let folder = folder();
    let words = "predict part.padl --setup setup.toml -o out.json --overlay out.svg";
    done(&premio(folder.path(), words));
    let text = fs::read_to_string(folder.path().join("out.json")).unwrap();
    let value: Value = serde_json::from_str(&text).unwrap();
    assert_eq!(value["schema"], "premio.prediction/1");
    let count = |key: &str| value[key].as_array().unwrap().len() as u64;
    let number = |v: &Value| v.as_u64().unwrap();
    for region in value["regions"].as_array().unwrap() {
        for boundary in region["boundaries"].as_array().unwrap() {
            let boundary = &value["boundaries"][number(boundary) as usize];
            assert_eq!(boundary["region"], region["id"]);
            let arcs = boundary["arcs"].as_array().unwrap();
            assert!(arcs.iter().all(|arc| number(arc) < count("arcs")));
        }
    }
    // Three faces of the block are visible, and the wall of the bore; the edges of its top are
    // whole or have the reason why they are not.
    for arc in value["arcs"].as_array().unwrap() {
        let told =
            arc["state"] == "whole" || arc["smooth"] == true || arc["reason"]["why"].is_string();
        assert!(told, "{arc}");
    }
    assert!(!value["object"]["holes"].as_array().unwrap().is_empty());
    let drawing = fs::read_to_string(folder.path().join("out.svg")).unwrap();
    assert!(drawing.starts_with("<?xml") && drawing.ends_with("</svg>\n"));
    // The same again, byte for byte.
    done(&premio(
        folder.path(),
        "predict part.padl --setup setup.toml -o again.json",
    ));
    assert_eq!(
        fs::read_to_string(folder.path().join("again.json")).unwrap(),
        text
    );
}

#[test]
fn predictions_are_as_the_published_schema_says() {
    let folder = folder();
    let validator = common::published(folder.path(), "prediction");
    let output = premio(folder.path(), "predict part.padl --setup setup.toml");
    done(&output);
    let prediction: Value = serde_json::from_slice(&output.stdout).unwrap();
    let errors: Vec<String> = validator
        .iter_errors(&prediction)
        .map(|e| e.to_string())
        .collect();
    assert!(errors.is_empty(), "{errors:?}");
    // The schema is effective: an arc's state is one of three.
    let mut wrong = prediction;
    wrong["arcs"][0]["state"] = "seen".into();
    assert!(!validator.is_valid(&wrong));
}

#[test]
fn a_rendered_picture_is_compared() {
    let folder = folder();
    done(&premio(
        folder.path(),
        "render part.padl --setup setup.toml -o picture.png",
    ));
    let words = "compare part.padl --setup setup.toml --image picture.png --json --overlay o.png";
    let output = premio(folder.path(), words);
    done(&output);
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(value["schema"], "premio.comparison/1");
    assert!(value["outlines"]["same"].as_f64().unwrap() > 0.9, "{value}");
    let other = SETUP.replace("160, 120", "80, 60");
    fs::write(folder.path().join("small.toml"), other).unwrap();
    let output = premio(
        folder.path(),
        "compare part.padl --setup small.toml --image picture.png",
    );
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        said.contains("160 x 120") && said.contains("80 x 60"),
        "{said}"
    );
    let output = premio(
        folder.path(),
        "render part.padl --setup setup.toml -o picture.bmp",
    );
    assert_eq!(output.status.code(), Some(2));
    assert!(!folder.path().join("picture.bmp").exists());
}

#[test]
fn a_model_is_the_same_for_any_shards_and_threads() {
    let folder = folder();
    done(&premio(
        folder.path(),
        "model part.padl --setups setups.toml -o whole.model",
    ));
    let whole = fs::read(folder.path().join("whole.model")).unwrap();
    done(&premio(
        folder.path(),
        "model part.padl --setups setups.toml --threads 1 -o one.model",
    ));
    assert_eq!(fs::read(folder.path().join("one.model")).unwrap(), whole);
    for shard in ["1/3", "2/3", "3/3"] {
        let name = shard.replace('/', "-");
        let words = format!("model part.padl --setups setups.toml --shard {shard} -o {name}.shard");
        done(&premio(folder.path(), &words));
    }
    done(&premio(
        folder.path(),
        "model merge 3-3.shard 1-3.shard 2-3.shard -o merged.model",
    ));
    assert_eq!(fs::read(folder.path().join("merged.model")).unwrap(), whole);
    let first: Value =
        serde_json::from_slice(whole.split(|b| *b == b'\n').next().unwrap()).unwrap();
    assert_eq!(
        (&first["schema"], &first["count"]),
        (&"premio.model/1".into(), &18.into())
    );
    // A shard that is missing, of another run, or cut off.
    let refused = |words: &str, why: &str| {
        let output = premio(folder.path(), words);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(why), "{said}");
    };
    refused(
        "model merge 1-3.shard 2-3.shard -o no.model",
        "expected 3 shards",
    );
    let other = SETUPS.replace("8000", "9000");
    fs::write(folder.path().join("others.toml"), other).unwrap();
    done(&premio(
        folder.path(),
        "model part.padl --setups others.toml --shard 3/3 -o other.shard",
    ));
    refused(
        "model merge 1-3.shard 2-3.shard other.shard -o no.model",
        "another run",
    );
    let text = fs::read_to_string(folder.path().join("2-3.shard")).unwrap();
    let cut = text.lines().take(3).collect::<Vec<_>>().join("\n");
    fs::write(folder.path().join("2-3.shard"), cut).unwrap();
    refused(
        "model merge 1-3.shard 2-3.shard 3-3.shard -o no.model",
        "2-3.shard:3:1: found the end of the shard, expected setup 8",
    );
    assert!(!folder.path().join("no.model").exists());
}

#[test]
fn an_interrupted_run_goes_on() {
    let folder = folder();
    done(&premio(
        folder.path(),
        "model part.padl --setups setups.toml -o whole.model",
    ));
    let parts = folder.path().join("next.model.parts");
    fs::create_dir(&parts).unwrap();
    let refused = premio(
        folder.path(),
        "model part.padl --setups setups.toml -o next.model",
    );
    assert_eq!(refused.status.code(), Some(2));
    let said = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(said.contains("--resume"), "{said}");
    done(&premio(
        folder.path(),
        "model part.padl --setups setups.toml -o next.model --resume",
    ));
    let read = |name: &str| fs::read(folder.path().join(name)).unwrap();
    assert_eq!(read("next.model"), read("whole.model"));
    assert!(!parts.exists());
}

#[test]
fn advice_is_given_with_what_it_costs() {
    let folder = folder();
    let words = "advise part.padl --setups setups.toml --top 3 --json";
    let output = premio(folder.path(), words);
    done(&output);
    let value: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(
        (&value["schema"], &value["tried"]),
        (&"premio.advice/1".into(), &18.into())
    );
    let best = value["best"].as_array().unwrap();
    assert_eq!(best.len(), 4);
    let expected = |i: usize| best[i]["expected"].as_f64().unwrap();
    assert!((1..4).all(|i| expected(i) <= expected(i - 1)), "{value}");
    assert_eq!(best[0]["cost"]["features"], 0.0);
}

#[test]
fn what_is_wrong_with_a_setup_is_told_with_its_place() {
    let folder = folder();
    let camera = "[camera]\neye = [14, -11, 12]\n";
    let light = "[[light]]\nposition = [9, -20, 25]\n";
    for (text, why) in [
        (
            format!("{camera}{light}[sensor]\nresolution = [0, 480]\n"),
            "bad.toml:6:1",
        ),
        (format!("{camera}far = 3\n{light}"), "bad.toml:3:1"),
        (format!("material = \"gold\"\n{camera}{light}"), "aluminium"),
        (
            format!(
                "material = {{ ambient = 1, s = 0.9, d = 0.4, m = 0.2, n = 1.5, k = 0 }}\n{camera}{light}"
            ),
            "at most 1",
        ),
        (
            format!("{camera}[[light]]\nposition = [1, 1, 1]\n"),
            "light[0].position",
        ),
        (format!("{camera}[[light]]\n"), "light[0].position"),
        (format!("ambient = 0\n{camera}"), "no light"),
        (
            format!("{camera}target = [28, -22, 24]\n{light}"),
            "behind the camera",
        ),
        (
            format!("{camera}{light}[detector]\nthreshold = 0\n"),
            "threshold",
        ),
        ("[camera\n".to_owned(), "bad.toml:1:8"),
        (light.to_owned(), "camera"),
    ] {
        fs::write(folder.path().join("bad.toml"), &text).unwrap();
        let output = premio(
            folder.path(),
            "predict part.padl --setup bad.toml -o out.json",
        );
        assert_eq!(output.status.code(), Some(2), "{text}");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(said.contains(why), "{text}: {said}");
        assert!(!folder.path().join("out.json").exists(), "{text}");
    }
}
