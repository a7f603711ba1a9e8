//! Names with escape sequences and control characters: no terminal obeys them, no file breaks.
#![cfg(unix)]

use crate::common::{self, SETUP, assert_says, folder, said};
use serde_json::Value;
use std::fs;

#[test]
fn no_name_steers_a_terminal_or_breaks_a_file() {
    let folder = folder(&[("setup.toml", SETUP)]);
    let path = folder.path();
    let name = "a<b>&\"c'\u{1b}[31m\u{7f}\u{9b}\u{202e}.padl";
    fs::write(path.join(name), common::PART).unwrap();
    let run = |arguments: &[&str]| common::command(path, "").args(arguments).output().unwrap();
    let steers = |c: char| c != '\n' && (c.is_control() || c == '\u{202e}');
    let wrong = "no\u{1b}[31m\u{9b}\u{202e}.padl";
    for arguments in [
        vec!["info", wrong],
        vec!["--json", "info", wrong],
        vec!["\u{1b}[31m"],
        vec!["info", name, "--part", "\u{1b}[31m"],
        vec!["info", name, "--\u{1b}[31m"],
    ] {
        let output = run(&arguments);
        assert_eq!(output.status.code(), Some(2), "{output:?}");
        assert!(!said(&output).contains(steers), "{output:?}");
    }
    for format in ["step", "stl", "obj", "glb", "3mf", "json"] {
        let file = format!("out.{format}");
        let output = run(&["export", name, "-o", &file]);
        assert!(output.status.success(), "{output:?}");
        let bytes = fs::read(path.join(&file)).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        match format {
            "step" => assert!(!text.contains(steers) && text.contains("c''\\X2\\001B")),
            "obj" => assert!(!text.contains(steers) && text.contains("o a<b>&\"c' [31m")),
            "json" => assert!(!text.contains(steers)),
            "glb" => {
                let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
                let json = std::str::from_utf8(&bytes[20..20 + length]).unwrap();
                assert!(!json.contains(steers), "{json}");
                let root: Value = serde_json::from_str(json).unwrap();
                let stem = name.strip_suffix(".padl").unwrap();
                assert_eq!(root["nodes"][0]["name"], stem);
            }
            _ => (),
        }
    }
    let title = ["contours", name, "--views", "front", "--title", name, "-o"];
    for file in ["out.svg", "out.dxf"] {
        let output = run(&[&title[..], &[file]].concat());
        assert!(output.status.success(), "{output:?}");
        let text = fs::read_to_string(path.join(file)).unwrap();
        assert!(!text.contains(steers), "{file}");
        let shown = if file == "out.svg" {
            "a&lt;b&gt;&amp;"
        } else {
            "\\U+001B"
        };
        assert_says(&text, &[shown]);
    }
}
