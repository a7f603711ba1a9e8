//! Inconsistent models and shards with correct digests: refused at their lines.

use crate::common::{SETUPS, assert_says, premio, prepared, refused};
use sha2::{Digest, Sha256};
use std::fs;
use std::path::Path;

fn hexadecimal(bytes: &[u8]) -> String {
    let digest = Sha256::digest(bytes);
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A model's text with its own digest.
fn sealed_model(text: &str) -> String {
    const MEMBER: &str = "\"sha256\":\"";
    let first = text.lines().next().unwrap();
    let at = first.rfind(MEMBER).unwrap() + MEMBER.len();
    let with = |digits: &str| format!("{}{digits}{}", &text[..at], &text[at + 64..]);
    with(&hexadecimal(with(&"0".repeat(64)).as_bytes()))
}

/// Lines of a shard with their own last line.
fn sealed_shard(lines: &[String]) -> String {
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    let digest = hexadecimal(text.as_bytes());
    let lines = lines.len();
    format!("{text}{{\"lines\":{lines},\"sha256\":\"{digest}\"}}\n")
}

#[test]
fn a_sealed_model_that_cannot_be_is_refused() {
    let folder = prepared();
    let path = folder.path();
    let whole = fs::read_to_string(path.join("part.model")).unwrap();
    assert_eq!(sealed_model(&whole), whole);
    let check = |text: String, expected: &[&str]| {
        assert_ne!(text, whole);
        fs::write(path.join("bad.model"), sealed_model(&text)).unwrap();
        let words = "match bad.model photo.png --camera camera.json";
        assert_says(&refused(path, words), expected);
    };
    let replaced = |from: &str, to: &str| whole.replacen(from, to, 1);
    let lines: Vec<&str> = whole.lines().collect();
    assert!(lines[lines.len() - 1].contains("codetection"));
    let without_last = lines[..lines.len() - 1].join("\n") + "\n";
    check(without_last, &["bad.model:1:", "`codetection` in no line"]);
    check(
        replaced("\"edge\":", "\"edge\":77"),
        &["bad.model:2:", "edges", "`source.edge`"],
    );
    check(
        replaced(
            "\"kind\":\"edge\",\"edge\":",
            "\"kind\":\"highlight\",\"light\":0,\"face\":77",
        ),
        &["bad.model:2:", "faces", "`source.face`"],
    );
    check(
        replaced(
            "\"kind\":\"edge\",\"edge\":",
            "\"kind\":\"highlight\",\"light\":7,\"face\":",
        ),
        &["bad.model:2:", "lights", "`source.light`"],
    );
    check(
        replaced("\"language\":\"padl\"", "\"language\":\"exe\""),
        &["bad.model:1:", "`description.language`", "exe", "padl"],
    );
    for (value, said) in [("-1", "is -1"), ("0", "is 0")] {
        check(
            replaced(
                "\"exact\":false",
                &format!("\"resolution\":{value},\"exact\":false"),
            ),
            &["bad.model:1:", "`description.resolution`", said],
        );
    }
    check(
        replaced("\"tree\":[{", "\"tree\":[],\"x\":[{"),
        &["bad.model:"],
    );
}

/// Makes two shards of a run; the lines of the first one, but for its last.
fn shards(path: &Path) -> Vec<String> {
    for shard in 1..=2 {
        let words =
            format!("model part.padl --setups setups.toml --shard {shard}/2 -o {shard}.shard");
        assert!(premio(path, &words).status.success());
    }
    let text = fs::read_to_string(path.join("1.shard")).unwrap();
    let lines: Vec<String> = text.lines().map(str::to_owned).collect();
    assert_eq!(sealed_shard(&lines[..lines.len() - 1]), text);
    lines[..lines.len() - 1].to_vec()
}

const MERGE: &str = "model merge bad.shard 2.shard -o out.model";

#[test]
fn a_sealed_shard_that_cannot_be_is_not_merged() {
    let folder = prepared();
    let path = folder.path();
    let whole = shards(path);
    let check = |lines: &[String], expected: &[&str]| {
        assert_ne!(lines, whole);
        fs::write(path.join("bad.shard"), sealed_shard(lines)).unwrap();
        assert_says(&refused(path, MERGE), expected);
    };
    let replaced = |line: usize, from: &str, to: &str| {
        let mut lines = whole.clone();
        lines[line] = lines[line].replacen(from, to, 1);
        lines
    };
    let last = whole.len() + 1;
    let more = [&whole[..], &[whole[1].clone()]].concat();
    check(&more, &[&format!("bad.shard:{last}:")]);
    check(
        &whole[..1],
        &["bad.shard:2:", "end of the shard, expected setup 0"],
    );
    check(
        &replaced(1, "\"length\":", "\"length\":-"),
        &["bad.shard:2:", "`sights[0].length`", "above 0"],
    );
    check(
        &replaced(1, "\"share\":", "\"share\":1"),
        &["bad.shard:2:", "share`", "0 to 1"],
    );
    check(
        &replaced(2, "\"edge\":", "\"edge\":77"),
        &["bad.shard:3:", "`sights[0].source", "edges"],
    );
    check(
        &replaced(1, "\"members\":[", "\"members\":[777,"),
        &["bad.shard:2:", "members`", "777"],
    );
    check(
        &replaced(0, "\"language\":\"padl\"", "\"language\":\"exe\""),
        &["bad.shard:1:", "`description.language`", "exe"],
    );
    check(
        &replaced(0, "\"exact\":false", "\"resolution\":-1,\"exact\":false"),
        &["bad.shard:1:", "`description.resolution`"],
    );
    // Only the digest says that the shards are of one run.
    for (from, to) in [("X=6", "X=7"), ("radius = 25", "radius = 26")] {
        check(&replaced(0, from, to), &["another run", ".shard:1:"]);
    }
}

#[test]
fn a_shard_that_is_cut_or_no_text_is_refused_at_its_place() {
    let folder = prepared();
    let path = folder.path();
    let whole = shards(path);
    fs::write(path.join("bad.shard"), format!("{}\n", whole[0])).unwrap();
    assert_says(
        &refused(path, MERGE),
        &["bad.shard:1:1: ", "expected setup 0"],
    );
    let mut bytes = sealed_shard(&whole).into_bytes();
    bytes[whole[0].len() + 11] = 0xff;
    fs::write(path.join("bad.shard"), bytes).unwrap();
    assert_says(
        &refused(path, MERGE),
        &["bad.shard:2:11: ", "0xff", "UTF-8"],
    );
    #[cfg(unix)]
    {
        let words = "model merge /dev/null 2.shard -o out.model";
        assert_says(
            &refused(path, words),
            &["/dev/null", "read twice", "a pipe"],
        );
    }
}

#[test]
fn a_model_that_is_not_made_leaves_nothing() {
    let folder = prepared();
    let path = folder.path();
    // No folder of shards is made either.
    for words in [
        "model part.padl --setups setups.toml -o new/",
        "model part.padl --setups setups.toml --resume -o new/",
        "model part.padl --setups setups.toml -o new/.",
        "model part.padl --setups setups.toml --shard 1/2 -o new/",
    ] {
        assert_says(&refused(path, words), &["new/", "the path of a folder"]);
    }
    let inside = SETUPS.replace("radius = 25", "radius = 0.5");
    fs::write(path.join("inside.toml"), inside).unwrap();
    fs::write(path.join("block.padl"), "PART = BLO(X=6, Y=4, Z=2)\n").unwrap();
    refused(
        path,
        "model block.padl --setups inside.toml --resume -o out.model",
    );
}
