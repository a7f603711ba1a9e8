//! A written table is read back and compared with the JSON Lines of the same run.

use super::column::{COLUMNS, ColumnKind};
use ::parquet::file::reader::{FileReader, SerializedFileReader};
use ::parquet::record::Field;
use serde_json::{Map, Value, json};
use std::collections::BTreeSet;
use std::fs::{self, File};
use std::path::Path;
use std::process::ExitCode;

const PART: &str =
    "A = BLO(X=40, Y=30, Z=20)\nB = CYL(R=6, H=40) AT (MOVX=20, MOVY=15, MOVZ=-5)\nP = A DIF B\n";
const SETUPS: &str = "[viewing]\ncount = 8\n[illumination]\ncount = 2\n[sensor]\nfocal = 16\nfilm = [8.8, 6.6]\nresolution = [320, 240]\n";

fn run(folder: &Path, words: &[&str]) {
    let path = |word: &&str| match word.contains('.') {
        true => folder.join(word).into_os_string(),
        false => word.into(),
    };
    let arguments = std::iter::once("premio".into()).chain(words.iter().map(path));
    assert_eq!(crate::run(arguments), ExitCode::SUCCESS, "{words:?}");
}

/// The table of a file: its first record, and its rows.
fn table(path: &Path) -> (Value, Vec<Map<String, Value>>) {
    let reader = SerializedFileReader::new(File::open(path).unwrap()).unwrap();
    let known = reader.metadata().file_metadata().key_value_metadata();
    let head = &known.unwrap()[0];
    assert_eq!(head.key, "premio.model/1");
    let head = serde_json::from_str(head.value.as_ref().unwrap()).unwrap();
    let cells = |row: ::parquet::record::Row| {
        let columns = row.into_columns().into_iter();
        columns
            .map(|(name, field)| (name, value_of(&field)))
            .collect()
    };
    let rows = reader.get_row_iter(None).unwrap();
    (head, rows.map(|row| cells(row.unwrap())).collect())
}

fn value_of(field: &Field) -> Value {
    match field {
        Field::Null => Value::Null,
        Field::Long(n) => json!(n),
        Field::Double(x) => json!(x),
        Field::Str(text) => json!(text),
        Field::ListInternal(list) => list.elements().iter().map(value_of).collect(),
        other => panic!("found {other:?}"),
    }
}

/// The expected rows of a model, from its lines alone.
fn expected(lines: &[Value]) -> Vec<Value> {
    let tree = lines.iter().find(|l| l["record"] == "codetection").unwrap();
    let mut rows = Vec::new();
    for line in lines {
        let mut row = line.clone();
        match line["record"].as_str().unwrap() {
            "feature" => {
                let mut nodes = tree["tree"].as_array().unwrap().iter();
                let node = nodes.find(|n| n["feature"] == line["rank"]);
                row["together"] = node.cloned().unwrap_or_default();
                row["together"]["feature"].take();
            }
            "aspect" => {
                let features = row.as_object_mut().unwrap().remove("features").unwrap();
                rows.push(row);
                for feature in features.as_array().unwrap() {
                    let mut row = feature.clone();
                    row["record"] = json!("aspectfeature");
                    row["aspect"] = line["rank"].clone();
                    rows.push(row);
                }
                continue;
            }
            "tuple" => {}
            _ => continue,
        }
        rows.push(row);
    }
    rows
}

/// The leaf values of a value, by their keys; a list of lists as one list.
fn flat(value: &Value, pointer: &str, to: &mut Vec<(String, Value)>) {
    match value {
        Value::Null => {}
        Value::Object(map) => {
            for (key, value) in map {
                flat(value, &format!("{pointer}/{key}"), to);
            }
        }
        Value::Array(list) if COLUMNS.iter().any(|c| c.2 == pointer) => {
            let rows = list.iter().flat_map(|v| match v.as_array() {
                Some(row) => row.clone(),
                None => vec![v.clone()],
            });
            to.push((pointer.to_owned(), rows.collect()));
        }
        Value::Array(list) => {
            for (i, value) in list.iter().enumerate() {
                flat(value, &format!("{pointer}/{i}"), to);
            }
        }
        value => to.push((pointer.to_owned(), value.clone())),
    }
}

#[test]
fn a_table_holds_what_the_lines_hold() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("part.padl"), PART).unwrap();
    fs::write(folder.join("setups.toml"), SETUPS).unwrap();
    let of = ["model", "part.padl", "--setups", "setups.toml"];
    run(
        folder,
        &[&of[..], &["--shard", "1/1", "-o", "part.shard"]].concat(),
    );
    let merge = ["model", "merge", "part.shard", "-o"];
    run(folder, &[&merge[..], &["part.model"]].concat());
    run(folder, &[&merge[..], &["part.parquet"]].concat());
    run(
        folder,
        &[&merge[..], &["named.table", "--format", "parquet"]].concat(),
    );
    let [by_ending, by_name] =
        ["part.parquet", "named.table"].map(|name| fs::read(folder.join(name)).unwrap());
    assert!(by_ending == by_name);

    let text = fs::read_to_string(folder.join("part.model")).unwrap();
    let lines: Vec<Value> = text
        .lines()
        .map(|line| serde_json::from_str(line).unwrap())
        .collect();
    let (head, rows) = table(&folder.join("part.parquet"));
    assert_eq!(head, lines[0]);
    let expected = expected(&lines);
    assert_eq!(rows.len(), expected.len());
    let mut used = BTreeSet::new();
    for (row, expected) in rows.iter().zip(&expected) {
        let mut values = Vec::new();
        flat(expected, "", &mut values);
        // Every value of the lines has a column.
        for (pointer, value) in &values {
            let column = COLUMNS.iter().find(|c| c.2 == pointer);
            let name = column.unwrap_or_else(|| panic!("no column of {pointer}")).0;
            assert_eq!(&row[name], value, "{name} of {expected}");
            used.insert(name);
        }
        let value_of = row.values().filter(|v| !v.is_null()).count();
        assert_eq!(value_of, values.len(), "{row:?}");
    }
    let of_lists = COLUMNS.iter().filter(|c| c.1 == ColumnKind::Reals);
    assert!(of_lists.clone().all(|c| used.contains(c.0)), "{used:?}");
    for name in [
        "detectability_low",
        "accuracy_turn",
        "parent",
        "members",
        "chance",
    ] {
        assert!(used.contains(name), "{name} is in no row");
    }
}
