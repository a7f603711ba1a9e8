//! Input that is broken or hostile, from outside: the status, the message with its place, and files
//! that stay as they are.

use crate::common::{self, SETUP, SETUPS, assert_says, folder, premio, prepared, refused, said};
use serde_json::Value;
use std::fs;
use std::path::Path;

#[test]
fn an_output_is_no_input() {
    let folder = prepared();
    let path = folder.path();
    fs::hard_link(path.join("part.padl"), path.join("hard.padl")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink("part.padl", path.join("soft.padl")).unwrap();
    #[cfg(unix)]
    std::os::unix::fs::symlink(".", path.join("here")).unwrap();
    let matched = "match part.model photo.png --camera camera.json";
    let mut all = vec![
        "convert part.padl part.padl".to_owned(),
        "convert part.padl ./part.padl".to_owned(),
        "convert part.padl hard.padl".to_owned(),
        "export part.padl --format step -o part.padl".to_owned(),
        "contours part.padl --camera camera.json --format json -o camera.json".to_owned(),
        "predict part.padl --setup setup.toml -o setup.toml".to_owned(),
        "model part.padl --setups setups.toml -o setups.toml".to_owned(),
        "advise part.padl --setups setups.toml -o part.padl".to_owned(),
        "compare part.padl --setup setup.toml --image photo.png --overlay photo.png".to_owned(),
        format!("{matched} -o part.model"),
        format!("{matched} --csv camera.json"),
        format!("{matched} --overlay photo.png"),
    ];
    if cfg!(unix) {
        all.push("convert part.padl soft.padl".to_owned());
        all.push("convert soft.padl part.padl".to_owned());
        all.push("convert part.padl here/part.padl".to_owned());
    }
    for words in &all {
        assert_says(
            &refused(path, words),
            &["is the input", "expected another file"],
        );
    }
}

#[test]
fn two_outputs_are_two_files() {
    let folder = prepared();
    let path = folder.path();
    fs::write(path.join("old.svg"), "old").unwrap();
    for words in [
        "predict part.padl --setup setup.toml -o old.svg --overlay old.svg",
        "predict part.padl --setup setup.toml -o new.svg --overlay ./new.svg",
        "match part.model photo.png --camera camera.json -o a.png --overlay a.png",
        "match part.model photo.png --camera camera.json -o a.csv --csv a.csv",
        "fuzz --count 1 --state a.json -o a.json",
    ] {
        assert_says(&refused(path, words), &["one file", "a file for each"]);
    }
    // If one cannot be written, the other is not written either.
    let words = "predict part.padl --setup setup.toml --overlay a.svg -o none/a.json";
    assert_says(&refused(path, words), &["none/a.json"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_nothing() {
    let folder = prepared();
    for words in [
        "export part.padl --format step -o /dev/full",
        "predict part.padl --setup setup.toml --overlay a.svg -o /dev/full",
        "model part.padl --setups setups.toml -o /dev/full",
    ] {
        assert_says(&refused(folder.path(), words), &["/dev/full", "space"]);
    }
}

/// The model with its text changed.
fn altered(folder: &Path, change: impl Fn(&str) -> String) {
    let text = fs::read_to_string(folder.join("part.model")).unwrap();
    let other = change(&text);
    assert_ne!(other, text);
    fs::write(folder.join("bad.model"), other).unwrap();
}

#[test]
fn an_altered_model_is_not_matched_with() {
    let folder = prepared();
    let path = folder.path();
    let words = "match bad.model photo.png --camera camera.json";
    let check = |change: &dyn Fn(&str) -> String, expected: &[&str]| {
        altered(path, change);
        assert_says(&refused(path, words), expected);
    };
    check(&|t| t[..t.len() / 2].to_owned(), &["bad.model:"]);
    check(
        &|t| t[..t.len() - 1].to_owned(),
        &["bad.model:1:", "sha256"],
    );
    check(&|t| t[..t.len() - 2].to_owned(), &["bad.model:"]);
    check(&|_| String::new(), &["bad.model:1:1", "premio.model/1"]);
    check(
        &|t| t.replacen("premio.model/1", "premio.nodel/1", 1),
        &["bad.model:1:", "premio.model/1"],
    );
    check(
        &|t| t.replacen("X=6", "X=7", 1),
        &["bad.model:1:", "sha256", "altered"],
    );
    check(
        &|t| t.replacen("\"count\":8", "\"count\":9", 1),
        &["bad.model:1:", "`count` is 9"],
    );
    check(
        &|t| t.replacen("\"aspects\":", "\"aspects\":9", 1),
        &["bad.model:1:", "`aspects`"],
    );
    check(
        &|t| t.replacen("\"rank\":0", "\"rank\":1", 1),
        &["bad.model:2:", "`rank` is 1"],
    );
    check(
        &|t| t.replacen("\"share\":", "\"share\":1e999,\"x\":", 1),
        &["bad.model:2:", "finite"],
    );
    check(
        &|t| t.replacen("\"states\":[", "\"states\":[0,", 1),
        &["bad.model:2:", "`states`"],
    );
    let last = |t: &str| {
        let lines: Vec<&str> = t.lines().collect();
        lines[..lines.len() - 3].join("\n") + "\n"
    };
    check(&last, &["bad.model:1:", "follow"]);
}

#[test]
fn an_altered_shard_is_not_merged() {
    let folder = prepared();
    let path = folder.path();
    for shard in 1..=2 {
        let words =
            format!("model part.padl --setups setups.toml --shard {shard}/2 -o {shard}.shard");
        assert!(premio(path, &words).status.success());
    }
    let merge = "model merge 1.shard 2.shard -o all.model";
    assert!(premio(path, merge).status.success());
    let of = |name: &str| fs::read(path.join(name)).unwrap();
    assert_eq!(of("all.model"), of("part.model"));
    fs::remove_file(path.join("all.model")).unwrap();
    let whole = String::from_utf8(of("1.shard")).unwrap();
    for (other, expected) in [
        (whole.replacen("\"length\":", "\"length\":1", 1), "1.shard:"),
        (whole[..whole.len() - 1].to_owned(), "1.shard:"),
        (
            whole.replacen("\"setup\":1,", "\"setup\":2,", 1),
            "1.shard:3:",
        ),
        (
            whole.replacen("observations/2", "observations/7", 1),
            "1.shard:1:",
        ),
        (String::new(), "1.shard:1:1"),
    ] {
        assert_ne!(other, whole);
        fs::write(path.join("1.shard"), other).unwrap();
        assert_says(&refused(path, merge), &[expected]);
    }
}

#[test]
fn a_setup_is_refused_at_its_place() {
    let folder = prepared();
    let path = folder.path();
    let eye = "eye = [15, -16, 12]";
    let light = "position = [4, -16, 30]";
    for (from, to, expected) in [
        (eye, "eye = [1, 2, 3, 4]", ["bad.toml:3:7", "`camera.eye`"]),
        (eye, "eye = [1, inf, 3]", ["bad.toml:3:11", "finite"]),
        (eye, "eye = [1, 2, 1]", ["bad.toml:3:1", "inside the part"]),
        (
            eye,
            "eye = [1, 2, 9]\ntarget = [1, 2, 9]",
            ["bad.toml:4:1", "is the eye"],
        ),
        (
            eye,
            "eye = [1, 2, 9]\nup = [0, 0, 0]",
            ["bad.toml:4:1", "`camera.up`"],
        ),
        (
            eye,
            "eye = [1, 2, 9]\neye = [1, 2, 9]",
            ["bad.toml:4:1", "duplicate key"],
        ),
        (
            eye,
            "K = [[290,0,80],[0,290,60],[0,0,1]]\nR = [[1,0,0],[0,1,0],[0,0,-1]]\nt = [0,0,30]",
            ["bad.toml:4:1", "rotation"],
        ),
        (
            light,
            "position = [1, 2, 1]",
            ["bad.toml:5:1", "inside the part"],
        ),
        (
            light,
            "position = [1, 2]",
            ["bad.toml:5:12", "`light[0].position`"],
        ),
        ("focal = 16", "focal = -16", ["bad.toml:7:1", "above 0"]),
        (
            "focal = 16",
            "focal = 16\nfocal_lenght = 3",
            ["bad.toml:8:1", "did you mean `focal`"],
        ),
        (
            "film = [8.8, 6.6]",
            "film = [8.8, -6.6]",
            ["bad.toml:8:1", "film"],
        ),
        (
            "film = [8.8, 6.6]",
            "film = [1e-300, 6.6]",
            ["bad.toml:8:1", "film"],
        ),
        ("[160, 120]", "[0, 120]", ["bad.toml:9:1", "resolution"]),
        (
            "[160, 120]",
            "[160.5, 120]",
            ["bad.toml:9:15", "whole number"],
        ),
        ("[160, 120]", "[100000, 100000]", ["bad.toml:9:1", "pixels"]),
        (
            "[160, 120]",
            "[20000, 10000]",
            ["bad.toml:9:1", "--max-pixels"],
        ),
        (
            "threshold = 10",
            "threshold = \"ten\"",
            ["bad.toml:11:13", "expected a number"],
        ),
        (
            "threshold = 10",
            "threshold = -1",
            ["bad.toml:11:1", "threshold"],
        ),
        ("\"plastic\"", "\"plastik\"", ["bad.toml:1:1", "plastik"]),
    ] {
        let text = SETUP.replace(from, to);
        assert_ne!(text, SETUP);
        fs::write(path.join("bad.toml"), text).unwrap();
        let text = refused(path, "predict part.padl --setup bad.toml -o out.json");
        assert_says(&text, &expected);
    }
}

#[test]
fn a_camera_is_refused_at_its_place() {
    let folder = prepared();
    let path = folder.path();
    let matrix = r#""K": [[290.9, 0, 79.5], [0, 290.9, 59.5], [0, 0, 1]]"#;
    let looking =
        r#""projection": "perspective", "target": [0, 0, 0], "up": [0, 0, 1], "focal": 1"#;
    let contours = "contours part.padl --camera bad.json --format json -o out.json";
    let matched = "match part.model photo.png --camera bad.json -o out.json";
    for (words, text, expected) in [
        (
            contours,
            format!("{{{looking}, \"eye\": [1, 2, 3, 4]}}"),
            "`eye`",
        ),
        (
            contours,
            format!("{{{looking}, \"eye\": [0, 0, 0]}}"),
            "`target` is the eye",
        ),
        (
            contours,
            format!("{{{looking}, \"eye\": [1, 2, 1e999]}}"),
            "finite",
        ),
        (
            contours,
            format!("{{{looking}, \"eye\": [1, 2, 3], \"focal\": 2}}"),
            "twice",
        ),
        (
            contours,
            format!("{{{looking}, \"eye\": [1, 2, 3], \"naer\": 2}}"),
            "did you mean `near`",
        ),
        (contours, format!("{{{looking}}}"), "`eye` is missing"),
        (
            contours,
            format!("{{{looking},"),
            "found the end of the text",
        ),
        (
            contours,
            format!("{{{matrix}, \"R\": [[1,0,0],[0,1,0],[0,0,-1]], \"t\": [0,0,9]}}"),
            "`R` is not a rotation",
        ),
        (
            matched,
            format!("{{{matrix}, \"R\": [[1,0,0],[0,1,0],[0,0,-1]]}}"),
            "`R` is not a rotation",
        ),
        (
            matched,
            format!("{{{}}}", matrix.replacen("290.9", "-290.9", 1)),
            "focal length",
        ),
        (
            matched,
            format!("{{{matrix}, \"distorsion\": [0.1]}}"),
            "`distorsion`",
        ),
        (
            matched,
            format!("{{{matrix}, \"width\": 160.5}}"),
            "`width`",
        ),
        (matched, "{}".to_owned(), "`K` is missing"),
    ] {
        fs::write(path.join("bad.json"), text).unwrap();
        assert_says(&refused(path, words), &["bad.json:1:", expected]);
    }
}

#[test]
fn a_part_of_a_picture_is_none() {
    let folder = prepared();
    let path = folder.path();
    let photo = fs::read(path.join("photo.png")).unwrap();
    let words = |name: &str| format!("match part.model {name} --camera camera.json -o out.json");
    for end in [
        0,
        20,
        900,
        photo.len() - 20,
        photo.len() - 4,
        photo.len() - 1,
    ] {
        fs::write(path.join("bad.png"), &photo[..end]).unwrap();
        assert_says(&refused(path, &words("bad.png")), &["bad.png"]);
    }
    for header in [
        "P5\n0 0\n255\n",
        "P5\n100000 100000\n255\n",
        "P5\n160 120\n255\nx",
    ] {
        fs::write(path.join("bad.pgm"), header).unwrap();
        assert_says(&refused(path, &words("bad.pgm")), &["bad.pgm"]);
    }
    let few = words("photo.png") + " --max-pixels 1000";
    assert_says(&refused(path, &few), &["photo.png", "--max-pixels"]);
}

#[test]
fn a_jpeg_is_whole_or_none() {
    let folder = prepared();
    let path = folder.path();
    let bytes = common::JPEG;
    let words = "match part.model bad.jpg --camera camera.json -o out.json";
    for end in [
        bytes.len() / 2,
        bytes.len() - 200,
        bytes.len() - 2,
        bytes.len() - 1,
    ] {
        fs::write(path.join("bad.jpg"), &bytes[..end]).unwrap();
        assert_says(&refused(path, words), &["bad.jpg", "a part of a picture"]);
    }
    fs::write(path.join("bad.jpg"), bytes).unwrap();
    assert!(premio(path, words).status.success());
}

#[test]
fn a_picture_that_is_not_read_leaves_the_others() {
    let folder = prepared();
    let path = folder.path();
    fs::write(path.join("bad.png"), "none").unwrap();
    let words = "match part.model photo.png bad.png photo.png --camera camera.json -o out.jsonl";
    let output = premio(path, words);
    assert_eq!(output.status.code(), Some(2));
    assert_says(&said(&output), &["bad.png"]);
    let lines = fs::read_to_string(path.join("out.jsonl")).unwrap();
    assert_eq!(lines.lines().count(), 2, "{lines}");
    fs::remove_file(path.join("out.jsonl")).unwrap();
    // Without any, nothing is written.
    refused(
        path,
        "match part.model bad.png bad.png --camera camera.json -o out.jsonl",
    );
}

#[test]
fn no_more_is_read_than_the_limit() {
    let folder = prepared();
    let path = folder.path();
    for words in [
        "info part.padl --max-input 20",
        "match part.model photo.png --camera camera.json --max-input 1000",
        "predict part.padl --setup setup.toml --max-input 120",
    ] {
        assert_says(&refused(path, words), &["--max-input"]);
    }
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("/dev/zero", path.join("endless.padl")).unwrap();
        let output = premio(path, "info endless.padl --max-input 10MiB");
        assert_eq!(output.status.code(), Some(2));
        assert_says(&said(&output), &["endless.padl", "--max-input"]);
    }
}

#[test]
fn what_vanishes_is_said() {
    let folder = folder(&[
        ("thin.padl", "PART = BLO(X=1000, Y=1000, Z=0.00000000001)\n"),
        (
            "common.padl",
            "PART = BLO(X=1000, Y=1000, Z=1) INT (BLO(X=1000, Y=1000, Z=1) AT (MOVZ=0.99999999999))\n",
        ),
    ]);
    for name in ["thin.padl", "common.padl"] {
        let output = premio(folder.path(), &format!("info {name}"));
        assert!(output.status.success(), "{output:?}");
        assert_says(&said(&output), &["resolution", "--exact", "e-11 apart"]);
        let output = premio(folder.path(), &format!("info {name} --strict"));
        assert_eq!(output.status.code(), Some(3), "{output:?}");
        assert_says(&said(&output), &["resolution", "e-11 apart"]);
    }
    let output = premio(folder.path(), "info thin.padl --exact");
    assert!(
        output.status.success() && output.stderr.is_empty(),
        "{output:?}"
    );
}

#[test]
fn what_cannot_be_seen_is_said() {
    let folder = prepared();
    let path = folder.path();
    let dark = SETUP.replace("[[light]]\nposition = [4, -16, 30]\n", "");
    fs::write(path.join("dark.toml"), dark).unwrap();
    let output = premio(path, "predict part.padl --setup dark.toml -o out.json");
    assert!(output.status.success(), "{output:?}");
    assert_says(&said(&output), &["dark.toml", "no `[[light]]`"]);
    fs::remove_file(path.join("out.json")).unwrap();
    // A block without a bore, whose middle is inside.
    fs::write(path.join("block.padl"), "PART = BLO(X=6, Y=4, Z=2)\n").unwrap();
    let inside = |radius: &str| {
        let text = SETUPS.replace("radius = 25", &format!("radius = {radius}"));
        fs::write(path.join("inside.toml"), text).unwrap();
    };
    inside("0.5");
    let text = refused(path, "model block.padl --setups inside.toml -o out.model");
    assert_says(
        &text,
        &["inside.toml:3:1", "all 4 viewpoints inside the part"],
    );
    // A wide lens, so that near objects are visible.
    let wide = "[viewing]\ncount = 12\nradius = 2.8\n[sensor]\nfilm = [20, 15]\nresolution = [160, 120]\n\
        [[light]]\nposition = [40, -16, 30]\n";
    fs::write(path.join("inside.toml"), wide).unwrap();
    let output = premio(path, "model block.padl --setups inside.toml -o out.model");
    assert!(output.status.success(), "{output:?}");
    assert_says(
        &said(&output),
        &[
            "2 of 12 viewpoints are inside the part",
            "in 7 of 12 setups",
        ],
    );
}

#[test]
fn endings_and_views_say_what_is_meant() {
    let folder = folder(&[]);
    let path = folder.path();
    for words in [
        "contours part.padl -o a.svg",
        "contours part.padl -o b.svg --view iso",
        "contours part.padl -o top.svg --view top",
        "contours part.padl -o eye.json --eye 30,40,50",
        "contours part.padl -o middle.json --eye 30,40,50 --target 3,2,1",
        "export part.padl -o a.step",
        "export part.padl -o a.STP",
        "export part.padl -o a.3mf",
    ] {
        let output = premio(path, words);
        assert!(output.status.success(), "{words}: {output:?}");
    }
    let of = |name: &str| fs::read_to_string(path.join(name)).unwrap();
    assert_eq!(of("a.svg"), of("b.svg"));
    assert_ne!(of("a.svg"), of("top.svg"));
    assert!(of("a.STP").starts_with("ISO-10303-21"));
    let camera = |name: &str| serde_json::from_str::<Value>(&of(name)).unwrap()["camera"].clone();
    assert_eq!(camera("eye.json"), camera("middle.json"));
    let text = refused(path, "contours part.padl -o c.json --target 1,2,3");
    assert_says(&text, &["--camera", "--eye", "--view", "--views"]);
    assert_says(
        &refused(path, "export part.padl -o c.xyz"),
        &["c.xyz", "expected one of"],
    );
    let measures = |words: &str| {
        let output = premio(path, words);
        let value: Value = serde_json::from_slice(&output.stdout).unwrap();
        value["volume"].as_f64()
    };
    assert_eq!(
        measures("part.padl --json"),
        measures("info part.padl --json")
    );
}
