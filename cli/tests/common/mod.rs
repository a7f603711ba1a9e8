//! Common functions of the tests of the program from outside.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A block with a bore.
pub const PART: &str = "BASE = BLO(X=6, Y=4, Z=2)
PART = BASE DIF CYL(R=1, H=4) AT (MOVX=3, MOVY=2, MOVZ=-1)
";

/// A setup for it.
pub const SETUP: &str = "material = \"plastic\"
[camera]
eye = [15, -16, 12]
[[light]]
position = [4, -16, 30]
[sensor]
focal = 16
film = [8.8, 6.6]
resolution = [160, 120]
[detector]
threshold = 10
";

/// Setups for it.
pub const SETUPS: &str = "[viewing]
count = 4
radius = 25
[illumination]
count = 2
radius = 40
[sensor]
resolution = [160, 120]
";

/// A camera for its pictures.
pub const CAMERA: &str = r#"{"K": [[290.9, 0, 79.5], [0, 290.9, 59.5], [0, 0, 1]]}"#;

/// A JPEG of 160 by 120 grey pixels, written by libjpeg.
pub const JPEG: &[u8] = include_bytes!("../pictures/grey.jpg");

/// The program with arguments, in a folder.
pub fn command(folder: &Path, words: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_premio"));
    command.current_dir(folder).args(words.split_whitespace());
    command
}

/// The output of the program.
pub fn premio(folder: &Path, words: &str) -> Output {
    command(folder, words).output().unwrap()
}

/// The standard error of the program.
pub fn said(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).unwrap()
}

/// Asserts that a text has all these words.
#[track_caller]
pub fn assert_says(text: &str, words: &[&str]) {
    for word in words {
        assert!(text.contains(word), "`{word}` is not in: {text}");
    }
}

/// A folder with the part, and with more files.
pub fn folder(more: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in [("part.padl", PART)].iter().chain(more) {
        fs::write(folder.path().join(name), text).unwrap();
    }
    folder
}

/// A folder with a part, its setups, its model, a camera and a picture.
pub fn prepared() -> TempDir {
    let folder = folder(&[
        ("setup.toml", SETUP),
        ("setups.toml", SETUPS),
        ("camera.json", CAMERA),
    ]);
    for words in [
        "model part.padl --setups setups.toml -o part.model",
        "render part.padl --setup setup.toml -o photo.png",
    ] {
        let output = premio(folder.path(), words);
        assert!(output.status.success(), "{output:?}");
    }
    folder
}

/// The message about wrong arguments; all files must stay unchanged.
#[track_caller]
pub fn refused(folder: &Path, words: &str) -> String {
    let files = || {
        let all = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().path());
        let mut all: Vec<_> = all.map(|path| (fs::read(&path).ok(), path)).collect();
        all.sort();
        all
    };
    let before = files();
    let output = premio(folder, words);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(2), "{words}: {text}");
    assert!(!text.contains("panicked"), "{words}: {text}");
    assert!(
        before == files(),
        "{words}: a file is changed, lost or left"
    );
    text
}

/// The published schema of a format, compared with the one that the program prints.
pub fn published(folder: &Path, format: &str) -> jsonschema::Validator {
    let output = premio(folder, &format!("schema {format}"));
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8(output.stdout).unwrap();
    let file = format!(
        "{}/../docs/{format}.schema.json",
        env!("CARGO_MANIFEST_DIR")
    );
    assert_eq!(fs::read_to_string(&file).unwrap(), text, "{file} is old");
    let schema: serde_json::Value = serde_json::from_str(&text).unwrap();
    jsonschema::validator_for(&schema).unwrap()
}
