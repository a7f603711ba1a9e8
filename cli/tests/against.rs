//! `premio fuzz --against` from outside: other programs that are right, wrong, or worse.
#![cfg(unix)]

use crate::common::{PART, command, said};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::time::{Duration, Instant};

const PREMIO: &str = env!("CARGO_BIN_EXE_premio");

/// A run on one tree of a profile that has no ring.
const ONE: &str = "--profile grid --count 1 --from 1 --rays 100";

/// The output of a run against a command, with further words.
fn against(folder: &Path, program: &str, words: &str) -> Output {
    let mut command = command(folder, "fuzz --against");
    command.arg(program).args(words.split_whitespace());
    command.output().unwrap()
}

/// A script of the shell beside which the models are.
fn script(folder: &Path, text: &str) -> String {
    let path = folder.join("program.sh");
    fs::write(&path, text).unwrap();
    format!("sh '{}' {{}}", path.display())
}

/// The summary without its times.
fn summary(output: &Output) -> Value {
    let summary = serde_json::from_slice(&output.stdout);
    let mut summary: Value = summary.unwrap_or_else(|e| panic!("{e}: {output:?}"));
    summary.as_object_mut().unwrap().remove("seconds");
    summary
}

#[test]
fn a_right_program_is_right() {
    let folder = tempfile::tempdir().unwrap();
    let program = format!("'{PREMIO}' info --json {{}}");
    for form in ["padl", "csg", "json"] {
        let words = "--profile grid,parts,rounded --count 3 --rays 500";
        let words = format!("{words} --json --write-format {form}");
        let output = against(folder.path(), &program, &words);
        let found = summary(&output);
        assert_eq!(found["against"]["right"], 9, "{found:#}");
        assert!(output.status.success() && output.stderr.is_empty());
    }
    fs::write(folder.path().join("part.padl"), PART).unwrap();
    let step = format!("'{PREMIO}' export {{}} -o {{out.step}} --format step");
    let words = "--profile parts --count 4 --rays 100 --json";
    let found = summary(&against(folder.path(), &step, words));
    assert_eq!(found["against"]["right"], 4, "{found:#}");
    let output = against(folder.path(), &program, "part.padl --json");
    let found = summary(&output);
    assert_eq!(
        found["profiles"]["files"]["against"]["right"], 1,
        "{found:#}"
    );
    assert!(output.status.success());
}

/// A program that is wrong where a ring is taken from something.
#[test]
fn a_planted_fault_is_found_and_made_small() {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "if grep -q 'DIF TOR' \"$1\"; then
            echo '{{\"volume\": 1000, \"solids\": 1}}'
        else
            exec '{PREMIO}' info --json \"$1\"
        fi"
    );
    let program = script(folder.path(), &text);
    let words = "--profile grid,tangent --count 12 --rays 100 --shrink --json --threads";
    let [one, two] = [1, 2].map(|threads| {
        let output = against(folder.path(), &program, &format!("{words} {threads}"));
        assert_eq!(output.status.code(), Some(1), "{output:?}");
        summary(&output)
    });
    assert_eq!(one, two);
    let grid = &one["profiles"]["grid"]["against"];
    let faults = grid["faults"].as_array().unwrap();
    let volume = faults
        .iter()
        .find(|fault| fault["kind"] == "volume")
        .unwrap();
    let first = &volume["finds"][0];
    assert!(
        first["text"]
            .as_str()
            .unwrap()
            .contains("volume 1000, expected")
    );
    let small = first["shrunk"].as_str().unwrap();
    let leaves = ["BLO", "WED", "CYL", "CON", "SPH", "TOR"];
    let leaves = leaves.map(|word| small.matches(word).count());
    assert!(
        leaves.iter().sum::<usize>() <= 3 && small.contains("DIF TOR"),
        "{small}"
    );
    // The same seed alone gives the same.
    let seed = first["seed"].as_u64().unwrap();
    let words = format!("--profile grid --from {seed} --count 1 --rays 100 --shrink --json");
    let again = summary(&against(folder.path(), &program, &words));
    let again = &again["profiles"]["grid"]["against"]["faults"][0]["finds"][0];
    assert_eq!(again, first);
}

/// What a script leads to: the key of the counts, and words of the summary.
fn verdict(text: &str, output: &str, more: &str) -> (String, String) {
    let folder = tempfile::tempdir().unwrap();
    let program = script(folder.path(), text) + output;
    let found = against(folder.path(), &program, &format!("{ONE} --json {more}"));
    let counts = &summary(&found)["against"];
    let counted = counts.as_object().unwrap_or_else(|| panic!("{found:?}"));
    let key = counted.iter().find(|(_, count)| **count == 1);
    let text = String::from_utf8(found.stdout).unwrap();
    (key.unwrap().0.clone(), text)
}

#[test]
fn nothing_that_a_program_says_is_trusted() {
    let nested = "printf '{\"volume\":'; head -c 100000 /dev/zero | tr '\\0' '['";
    let open = "printf 'OFF 3 1 0 0 0 0 1 0 0 0 1 0' > \"$2\"";
    let open_lines = "printf 'OFF 3 1 0\\n0 0 0\\n1 0 0\\n0 1 0\\n3 0 1 2\\n' > \"$2\"";
    let off = " {out.off}";
    for (text, output, key, words) in [
        ("", "", "unread", "no line of the output"),
        ("echo '{\"volume\": NaN}'", "", "unread", "line of JSON"),
        ("echo '{\"volume\": 1e999}'", "", "unread", "out of range"),
        (
            "echo '{\"bounds\": [[1, 2, 3]]}'",
            "",
            "unread",
            "line of JSON",
        ),
        (nested, "", "unread", "line of JSON"),
        ("", off, "unread", "the file off"),
        (open, off, "unread", "the file off: line 1"),
        (open_lines, off, "unread", "not closed"),
        ("ln -s /dev/zero \"$2\"", off, "unread", "the file off"),
        ("yes '{\"volume\": 1}'", "", "unread", "more than 256 MiB"),
        (
            "echo '{\"volume\": -5}'",
            "",
            "wrong",
            "volume -5, expected",
        ),
        (
            "echo '{\"error\": \"I \\u001b[31m will not\"}'",
            "",
            "refused",
            "will not",
        ),
        (
            "echo 'no such shape' >&2; exit 3",
            "",
            "refused",
            "status 3: no such shape",
        ),
        ("kill -SEGV $$", "", "crashed", "signal 11"),
    ] {
        let (found, summary) = verdict(text, output, "");
        assert_eq!(found, key, "{text}: {summary}");
        assert!(summary.contains(words), "{text}: {summary}");
    }
}

#[test]
fn limits_of_time_and_memory_end_a_program() {
    let started = Instant::now();
    let (found, summary) = verdict("sleep 1000 & sleep 1000", "", "--limit 1");
    assert_eq!(found, "slow", "{summary}");
    // One that leaves a process behind with its output keeps nobody waiting.
    let text = "sleep 1000 & echo '{\"volume\": -1}'";
    let (found, summary) = verdict(text, "", "--limit 100");
    assert_eq!(found, "wrong", "{summary}");
    assert!(started.elapsed() < Duration::from_secs(60));
    // A line without end is kept whole.
    let text = "head -c 400000000 /dev/zero | tail -n 1 >/dev/null";
    let (found, summary) = verdict(text, "", "--memory 64");
    assert_eq!(found, "memory", "{summary}");
}

#[test]
fn a_template_makes_programs() {
    let folder = tempfile::tempdir().unwrap();
    let template = "import json\n# {{model}}\nprint(json.dumps(model))\n";
    fs::write(folder.path().join("program.py"), template).unwrap();
    // The program is shown as its refusal.
    let program = "sh -c 'grep model \"$0\" >&2; exit 1' {}";
    let output = against(
        folder.path(),
        program,
        &format!("{ONE} --json --template program.py"),
    );
    assert!(String::from_utf8_lossy(&output.stdout).contains("print(json.dumps(model))"));
    let program = "sh -c 'grep -v json \"$0\" | tail -n 1 >&2; exit 1' {}";
    let output = against(
        folder.path(),
        program,
        &format!("{ONE} --json --template program.py"),
    );
    let found = summary(&output);
    let text = found["profiles"]["grid"]["against"]["refusals"][0]["finds"][0]["text"].as_str();
    let text = text.unwrap();
    assert!(
        text.contains("model = moved(") || text.contains("model = "),
        "{text}"
    );
}

#[test]
fn a_run_goes_on_with_the_same_command() {
    let folder = tempfile::tempdir().unwrap();
    let program = script(folder.path(), "echo '{\"solids\": 1}'");
    let words = format!("{ONE} --state run.json --json");
    let first = summary(&against(folder.path(), &program, &words));
    assert_eq!(summary(&against(folder.path(), &program, &words)), first);
    let other = against(folder.path(), &format!("{program} more"), &words);
    assert_eq!(other.status.code(), Some(2));
    assert!(said(&other).contains("other arguments"));
}

#[test]
fn wrong_uses_are_explained() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("part.padl"), PART).unwrap();
    fs::write(folder.path().join("none.py"), "model\n").unwrap();
    fs::write(folder.path().join("part.txt"), PART).unwrap();
    let turned = "{\"prim\":\"sphere\",\"r\":1,\"transform\":[{\"rotate\":[[1,1,0],30]}]}";
    fs::write(folder.path().join("turned.json"), turned).unwrap();
    for (program, words, message) in [
        ("true", "", "expected `{}` where"),
        ("true {} 'x", "", "every quote closed"),
        ("no-such-program {}", "", "no-such-program is not found"),
        ("true {} {out.dwg}", "", "found `{out.dwg}`"),
        ("true {}", "--write-format padl,csg", "one format"),
        ("true {}", "--template none.py", "expected one"),
        ("true {}", "--template part.txt", "ends with .py or .cpp"),
        ("true {}", "part.txt", "the ending of a description"),
        ("true {}", "absent.padl", "absent.padl"),
        ("true {}", "turned.json", "expected a coordinate axis"),
        ("true {}", "part.padl -o part.padl", "another file"),
    ] {
        let output = against(folder.path(), program, words);
        assert_eq!(
            output.status.code(),
            Some(2),
            "{program} {words}: {output:?}"
        );
        assert!(said(&output).contains(message), "{}", said(&output));
    }
    let alone = command(folder.path(), "fuzz part.padl").output().unwrap();
    assert!(said(&alone).contains("expected `--against`"), "{alone:?}");
    let alone = command(folder.path(), "fuzz --write-format csg")
        .output()
        .unwrap();
    assert!(said(&alone).contains("expected `--write`"), "{alone:?}");
}

#[test]
fn an_interrupt_ends_the_program() {
    let folder = tempfile::tempdir().unwrap();
    let mark = folder.path().join("pid");
    let text = format!("echo $$ > '{}'; exec sleep 1000", mark.display());
    let program = script(folder.path(), &text);
    let mut run = command(folder.path(), "fuzz --against");
    run.arg(&program).args(ONE.split_whitespace());
    run.stdout(std::process::Stdio::null());
    let mut run = run.spawn().unwrap();
    let started = Instant::now();
    while !fs::read_to_string(&mark).is_ok_and(|text| text.ends_with('\n')) {
        assert!(started.elapsed() < Duration::from_secs(60));
        std::thread::sleep(Duration::from_millis(10));
    }
    let kill = |words: &[&str]| {
        let status = std::process::Command::new("kill").args(words).output();
        status.unwrap().status.success()
    };
    assert!(kill(&["-INT", &run.id().to_string()]));
    let status = run.wait().unwrap();
    assert!(!status.success());
    assert!(started.elapsed() < Duration::from_secs(60));
    let pid = fs::read_to_string(&mark).unwrap();
    assert!(!kill(&["-0", pid.trim()]), "{pid} runs");
}
