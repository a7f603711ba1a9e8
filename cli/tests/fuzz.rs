//! `premio fuzz` from outside: exit status, summary, models, and continuing a run.

use crate::common::{command, premio};
use serde_json::Value;
use std::fs;
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

/// The summary without times, and with it the exit status.
fn summary(output: &Output) -> (Value, Option<i32>) {
    let mut value: Value = serde_json::from_slice(&output.stdout).unwrap();
    let times = value.as_object_mut().unwrap().remove("seconds");
    assert!(times.unwrap()["total"].as_f64().unwrap() >= 0.0);
    (value, output.status.code())
}

const SMALL: &str = "fuzz --profile grid,near,tangent --count 4 --rays 2000";

#[test]
fn a_few_trees_of_each_profile_are_right() {
    let folder = tempfile::tempdir().unwrap();
    let [mut one, two] = [1, 2].map(|threads| {
        let words = format!("{SMALL} --threads {threads} --json");
        summary(&premio(folder.path(), &words))
    });
    assert_eq!(one, two);
    assert_eq!(one.1, Some(0));
    // The close calls change with every better algorithm.
    for part in one.0["profiles"].as_object_mut().unwrap().values_mut() {
        part["close_calls"] = "counts".into();
    }
    insta::assert_snapshot!("summary", serde_json::to_string_pretty(&one.0).unwrap());
    let again = premio(folder.path(), &format!("{SMALL} --unfiltered"));
    assert!(again.status.success(), "{again:?}");
    let large = premio(
        folder.path(),
        "fuzz --profile deep,wide --count 2 --rays 2000",
    );
    let text = String::from_utf8(large.stdout).unwrap();
    assert!(text.ends_with("0 wrong, 0 refused\n"), "{text}");
    assert!(large.status.success() && large.stderr.is_empty());
}

/// A tree with a time limit of zero is wrong, and refused ones are counted by reason.
#[test]
fn findings_are_reported() {
    let folder = tempfile::tempdir().unwrap();
    let slow = premio(
        folder.path(),
        "fuzz --profile deep --count 1 --limit 0.001 --json",
    );
    let (slow, status) = summary(&slow);
    assert_eq!((slow["wrong"].as_u64(), status), (Some(1), Some(1)));
    assert_eq!(slow["profiles"]["deep"]["faults"][0]["kind"], "time");
    let words = format!("{SMALL} --resolution 1000 --shrink --json");
    let (refused, status) = summary(&premio(folder.path(), &words));
    assert_eq!((refused["refused"].as_u64(), status), (Some(12), Some(0)));
    let kind = &refused["profiles"]["grid"]["refusals"][0];
    let reason = kind["kind"].as_str().unwrap();
    assert!(reason.contains("resolution") && !reason.contains(char::is_numeric));
    let small = kind["finds"][0]["shrunk"].as_str().unwrap();
    assert_eq!(small.lines().count(), 1, "{small}");
}

#[test]
fn models_are_written_with_their_measures() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("{SMALL} --write models --write-format padl,csg,json -o out.txt");
    let output = premio(folder.path(), &words);
    assert!(output.status.success() && output.stdout.is_empty());
    assert!(folder.path().join("out.txt").is_file());
    let manifest = fs::read_to_string(folder.path().join("models/manifest.jsonl")).unwrap();
    assert_eq!(manifest.lines().count(), 12);
    for line in manifest.lines() {
        let line: Value = serde_json::from_str(line).unwrap();
        assert_eq!(line["verdict"], "right");
        let volume = line["measures"]["volume"].as_f64().unwrap();
        for file in line["files"].as_array().unwrap() {
            let name = file["file"].as_str().unwrap();
            if file["same_tree"] == false {
                assert!(name.ends_with(".csg"), "{name}");
                continue;
            }
            let info = premio(folder.path(), &format!("info models/{name} --json"));
            let info: Value = serde_json::from_slice(&info.stdout).unwrap();
            let read = info["volume"].as_f64().unwrap();
            assert!((read - volume).abs() < 1e-12, "{name}: {read} {volume}");
        }
    }
}

#[test]
fn a_run_goes_on_where_it_ended() {
    let folder = tempfile::tempdir().unwrap();
    let words = format!("{SMALL} --state run.json --json");
    let first = summary(&premio(folder.path(), &words));
    // All is done: nothing is tried again, and the summary is the same.
    assert_eq!(summary(&premio(folder.path(), &words)), first);
    let other = premio(folder.path(), &format!("{words} --from 1"));
    assert_eq!(other.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&other.stderr).contains("other arguments"));
}

#[cfg(unix)]
#[test]
fn an_interrupt_saves_the_state() {
    let folder = tempfile::tempdir().unwrap();
    let words = "fuzz --profile grid --count 1000000 --threads 2 --state run.json --json";
    let mut command = command(folder.path(), words);
    let child = command.stdout(Stdio::piped()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1500));
    let told = Instant::now();
    let mut kill = Command::new("kill");
    kill.args(["-INT", &child.id().to_string()]);
    assert!(kill.status().unwrap().success());
    let output = child.wait_with_output().unwrap();
    assert!(told.elapsed() < Duration::from_secs(1));
    let (summary, status) = summary(&output);
    assert_eq!(status, Some(130));
    assert_eq!(summary["complete"], false);
    let state = fs::read_to_string(folder.path().join("run.json")).unwrap();
    let state: Value = serde_json::from_str(&state).unwrap();
    let right = state["tallies"]["grid"]["right"].as_u64().unwrap();
    assert!(right > 0 && right == summary["right"].as_u64().unwrap());
}

#[test]
fn wrong_arguments_end_with_2() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("text"), "no state").unwrap();
    for words in [
        "fuzz --profile round",
        "fuzz --count many",
        "fuzz --threads 0",
        "fuzz --limit 0",
        "fuzz --limit 1e300",
        "fuzz --write-format padl",
        "fuzz --write m --write-format step",
        "fuzz --write text/m",
        "fuzz --state text",
        "fuzz --count 1 --state no/such/folder/state.json",
        "fuzz --from 18446744073709551615 --count 2",
        "fuzz --worker nonsense",
    ] {
        let output = premio(folder.path(), words);
        assert_eq!(output.status.code(), Some(2), "{words}");
        assert!(output.stdout.is_empty() && !output.stderr.is_empty());
    }
}
