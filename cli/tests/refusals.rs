//! Outputs in the wrong place, states, cameras and numbers: refused with what was found and expected.
#![allow(clippy::unwrap_used, reason = "a test fails by it")]

mod common;

use common::{assert_says, folder, premio, refused};
use std::fs;

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
