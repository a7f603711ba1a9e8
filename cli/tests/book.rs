//! The README and the book: their commands run and print what is shown, their references are
//! complete.
//!
//! A block with the language `console` or `sh` is an example. A line that begins with `premio ` or
//! `$ premio ` is a command. The lines after `$ premio` are its output, in which `…` stands for
//! anything. `parse-only` in the info string only parses the command; `status=N` expects another
//! exit status. A block after a line that ends with the name of a file, as in "`plate.padl`:", is
//! that file.

use crate::common;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// The wildcard of an output.
const ANYTHING: char = '…';

/// A page of Markdown.
struct Page {
    name: String,
    text: String,
}

/// A fenced block.
struct Block<'a> {
    /// The words after the fence.
    info: Vec<&'a str>,
    /// The line of the fence, from 1.
    line: usize,
    /// The file that the paragraph before it names.
    file: Option<&'a str>,
    lines: Vec<&'a str>,
}

/// A command of an example.
struct Example<'a> {
    line: usize,
    /// The words after `premio`.
    words: Vec<String>,
    output: Vec<&'a str>,
    status: i32,
    parse_only: bool,
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn page(path: &Path) -> Page {
    let name = path.file_name().unwrap().to_string_lossy().into_owned();
    let text = fs::read_to_string(path).unwrap();
    Page { name, text }
}

/// The README and the chapters of the book.
fn pages() -> Vec<Page> {
    let chapters = fs::read_dir(root().join("docs/src")).unwrap();
    let mut paths: Vec<_> = chapters.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths.insert(0, root().join("README.md"));
    paths.iter().map(|path| page(path)).collect()
}

fn chapter(name: &str) -> Page {
    page(&root().join("docs/src").join(name))
}

/// The file that a line names: the line ends with its name in backquotes and a colon.
fn named_file(line: &str) -> Option<&str> {
    let (_, name) = line.strip_suffix("`:")?.rsplit_once('`')?;
    Some(name)
}

impl Page {
    fn blocks(&self) -> Vec<Block<'_>> {
        let mut blocks = Vec::new();
        let (mut open, mut before): (Option<Block<'_>>, &str) = (None, "");
        for (i, line) in self.text.lines().enumerate() {
            match (open.as_mut(), line.strip_prefix("```")) {
                (None, Some(info)) => {
                    open = Some(Block {
                        info: info.split_whitespace().collect(),
                        line: i + 1,
                        file: named_file(before),
                        lines: Vec::new(),
                    });
                }
                (Some(_), Some(_)) => blocks.extend(open.take()),
                (Some(block), None) => block.lines.push(line),
                (None, None) if line.is_empty() => (),
                (None, None) => before = line,
            }
            if line.starts_with("```") {
                before = "";
            }
        }
        assert!(open.is_none(), "{}: a block is not closed", self.name);
        blocks
    }

    fn examples(&self) -> Vec<Example<'_>> {
        self.blocks().iter().flat_map(Block::examples).collect()
    }
}

impl<'a> Block<'a> {
    fn is_example(&self) -> bool {
        matches!(self.info.first(), Some(&"console" | &"sh"))
    }

    fn examples(&self) -> Vec<Example<'a>> {
        let mut examples: Vec<Example<'a>> = Vec::new();
        if !self.is_example() {
            return examples;
        }
        let parse_only = self.info.contains(&"parse-only");
        let status = self.info.iter().find_map(|w| w.strip_prefix("status="));
        let status = status.map_or(0, |digits| digits.parse().unwrap());
        // Whether lines are the output of the last command.
        let mut shows = false;
        for (i, &line) in self.lines.iter().enumerate() {
            let command = line.strip_prefix("$ ").unwrap_or(line);
            if let Some(words) = command.strip_prefix("premio ") {
                examples.push(Example {
                    line: self.line + i + 1,
                    words: split(words),
                    output: Vec::new(),
                    status,
                    parse_only,
                });
                shows = line.starts_with("$ ");
            } else if line.starts_with("$ ") {
                shows = false;
            } else if shows && let Some(last) = examples.last_mut() {
                last.output.push(line);
            }
        }
        examples
    }
}

/// The words of a command; quotes keep spaces.
fn split(text: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut quoted = false;
    for c in text.chars() {
        match c {
            '"' => quoted = !quoted,
            ' ' if !quoted => words.push(String::new()),
            _ => words.last_mut().unwrap().push(c),
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

/// The files of a folder that a word with one `*` stands for, or the word itself.
fn expanded(folder: &Path, word: &str) -> Vec<String> {
    let Some((before, after)) = word.split_once('*') else {
        return vec![word.to_owned()];
    };
    let names = fs::read_dir(folder).unwrap();
    let names = names.map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let fits = |name: &String| {
        name.len() >= before.len() + after.len()
            && name.starts_with(before)
            && name.ends_with(after)
    };
    let mut names: Vec<String> = names.filter(fits).collect();
    assert!(!names.is_empty(), "no file is `{word}`");
    names.sort();
    names
}

/// Whether a line is as a pattern with `…` in it.
fn line_agrees(pattern: &str, line: &str) -> bool {
    let mut pieces = pattern.split(ANYTHING);
    let Some(mut rest) = line.strip_prefix(pieces.next().unwrap_or("")) else {
        return false;
    };
    let mut pieces: Vec<&str> = pieces.collect();
    let Some(last) = pieces.pop() else {
        return rest.is_empty();
    };
    for piece in pieces {
        let Some(at) = rest.find(piece) else {
            return false;
        };
        rest = &rest[at + piece.len()..];
    }
    rest.ends_with(last)
}

/// Whether lines are as a pattern, of which a line `…` stands for any number of lines.
fn agrees(pattern: &[&str], lines: &[&str]) -> bool {
    match pattern.split_first() {
        None => lines.is_empty(),
        Some((&"…", rest)) => (0..=lines.len()).any(|n| agrees(rest, &lines[n..])),
        Some((first, rest)) => lines
            .split_first()
            .is_some_and(|(line, others)| line_agrees(first, line) && agrees(rest, others)),
    }
}

fn premio(folder: &Path, words: &[String]) -> Output {
    let words = words.iter().flat_map(|word| expanded(folder, word));
    let mut command = Command::new(env!("CARGO_BIN_EXE_premio"));
    command.current_dir(folder).args(words).output().unwrap()
}

impl Example<'_> {
    /// The error of the command in a folder.
    fn failure(&self, folder: &Path) -> Option<String> {
        let mut words = self.words.clone();
        if self.parse_only {
            for word in words.iter_mut() {
                *word = word.replace('*', "1");
            }
            words.push("--help".to_owned());
        }
        let output = premio(folder, &words);
        let text = [output.stdout, output.stderr].concat();
        let text = String::from_utf8_lossy(&text);
        if output.status.code() != Some(self.status) {
            return Some(format!("{}\n{text}", output.status));
        }
        let lines: Vec<&str> = text.trim_end().lines().collect();
        let shown = !self.output.is_empty();
        (shown && !agrees(&self.output, &lines)).then(|| format!("it prints\n{text}"))
    }
}

/// All files that the pages show, by name, and those of `examples`.
fn files(pages: &[Page]) -> BTreeMap<String, String> {
    let mut files = BTreeMap::new();
    for page in pages {
        for block in page.blocks() {
            let Some(name) = block.file else {
                continue;
            };
            let text = block.lines.join("\n") + "\n";
            let known = files.insert(name.to_owned(), text.clone());
            let same = known.is_none_or(|known| known == text);
            assert!(same, "{}:{}: another {name}", page.name, block.line);
        }
    }
    for entry in fs::read_dir(root().join("examples")).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if path.is_file() {
            files.insert(name, fs::read_to_string(path).unwrap());
        }
    }
    files
}

/// The errors of the examples of a page, run in their order in a folder with all files.
fn failures(page: &Page, files: &BTreeMap<String, String>) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        fs::write(folder.path().join(name), text).unwrap();
    }
    let failure = |example: &Example<'_>| {
        let failure = example.failure(folder.path())?;
        let words = example.words.join(" ");
        Some(format!(
            "{}:{}: premio {words}: {failure}",
            page.name, example.line
        ))
    };
    page.examples().iter().filter_map(failure).collect()
}

#[test]
fn examples_run() {
    let pages = pages();
    let files = files(&pages);
    let failures: Vec<String> = std::thread::scope(|scope| {
        let (pages, files) = (&pages, &files);
        let runs: Vec<_> = pages
            .iter()
            .map(|page| scope.spawn(move || failures(page, files)))
            .collect();
        runs.into_iter()
            .flat_map(|run| run.join().unwrap())
            .collect()
    });
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn an_output_that_differs_is_seen() {
    let shown = ["volume  43978…", "…", "faces  7", "…"];
    assert!(agrees(
        &shown,
        &["volume  43978.7", "area  1", "faces  7", "end"]
    ));
    assert!(agrees(&shown, &["volume  43978", "faces  7"]));
    assert!(!agrees(&shown, &["volume  43979", "faces  7"]));
    assert!(!agrees(&shown, &["volume  43978", "faces  8"]));
    assert!(!agrees(&["a"], &["a", "b"]));
    assert!(!agrees(&["a", "b"], &["a"]));
    assert!(line_agrees("a…b…c", "a-b-b-c") && !line_agrees("a…b…c", "a-c-b"));
    let page = Page {
        name: "page".to_owned(),
        text:
            "Here is `a.padl`:\n\n```padl\nA = SPH(R=1)\n```\n\n```console status=2\n$ premio info \
               a.padl --title \"a b\"\nout\n$ premio x\n```\n"
                .to_owned(),
    };
    let files = files(std::slice::from_ref(&page));
    assert_eq!(files["a.padl"], "A = SPH(R=1)\n");
    let examples = page.examples();
    assert_eq!(examples.len(), 2);
    assert_eq!(
        examples[0].words,
        ["info", "a.padl", "--title", "a b"].map(String::from)
    );
    assert_eq!((examples[0].output.len(), examples[0].status), (1, 2));
    // Both are refused with another text than the one shown, or with another status.
    let folder = tempfile::tempdir().unwrap();
    assert!(examples[0].failure(folder.path()).is_some());
}

/// The help of a command.
fn help(words: &[&str]) -> String {
    let words: Vec<String> = words.iter().map(|&word| word.to_owned()).collect();
    let output = premio(&root(), &[words, vec!["--help".to_owned()]].concat());
    assert!(output.status.success(), "{output:?}");
    String::from_utf8(output.stdout).unwrap()
}

/// The commands of the program.
fn commands() -> Vec<String> {
    let help = help(&[]);
    let after = help.lines().skip_while(|line| *line != "Commands:").skip(1);
    let listed = after.take_while(|line| !line.is_empty());
    let names = listed.filter_map(|line| line.split_whitespace().next());
    let names: Vec<String> = names
        .filter(|name| *name != "help")
        .map(String::from)
        .collect();
    assert!(names.len() > 10, "{names:?}");
    names
}

/// The sections of a page, each from its heading `## `.
fn sections(text: &str) -> Vec<&str> {
    text.split("\n## ").collect()
}

#[test]
fn every_command_has_an_example_that_runs() {
    let page = chapter("command-line.md");
    let examples = page.examples();
    for command in commands() {
        let runs = |example: &&Example<'_>| example.words[0] == command && !example.parse_only;
        assert!(examples.iter().any(|e| runs(&e)), "{command} has none");
    }
}

#[test]
fn every_option_is_in_the_reference() {
    let page = chapter("command-line.md");
    let sections = sections(&page.text);
    let shared = sections.iter().filter(|s| s.starts_with("Options of"));
    let shared: String = shared.copied().collect();
    for command in commands() {
        let heading = format!("`premio {command}`");
        let section = sections.iter().find(|s| s.starts_with(&heading));
        let section = section.unwrap_or_else(|| panic!("no section {heading}"));
        let text = format!("{section}{shared}");
        for line in help(&[&command]).lines() {
            let words = line.split_whitespace();
            let is_option = line.trim_start().starts_with('-');
            let option = words.take(2).find(|word| word.starts_with("--"));
            if let Some(option) = option.filter(|_| is_option) {
                let known = ["`", " "].iter().any(|end| {
                    let name = format!("`{option}{end}");
                    text.contains(&name)
                });
                assert!(known, "{heading} has no {option}");
            }
        }
    }
}

/// The properties of a type of a schema, or of the schema's own.
fn properties(schema: &Value, name: Option<&str>) -> Vec<String> {
    let of = name.map_or(schema, |name| &schema["$defs"][name]);
    let properties = of["properties"].as_object();
    let properties = properties.unwrap_or_else(|| panic!("{name:?} has no properties"));
    properties.keys().cloned().collect()
}

fn schema(format: &str) -> Value {
    let output = common::premio(&root(), &format!("schema {format}"));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Whether a row of a table begins with a cell that names a key.
fn has_row(text: &str, key: &str) -> bool {
    let name = format!("`{key}`");
    let rows = text.lines().filter_map(|line| line.strip_prefix("| "));
    rows.filter_map(|row| row.split_once(" |"))
        .any(|(cell, _)| cell.contains(&name))
}

#[test]
fn every_key_is_in_the_reference() {
    let page = chapter("prediction.md");
    let schema_of_setups = schema("prediction");
    for (heading, name) in [
        ("Top level", "Setup"),
        ("Camera", "Viewpoint"),
        ("Lights", "Light"),
        ("Sensor", "Sensor"),
        ("Materials", "Constants"),
        ("Surfaces", "FacesFinish"),
        ("Detector", "Detector"),
        ("Features", "Criteria"),
    ] {
        let sections: Vec<&str> = page.text.split("\n### ").collect();
        let section = sections.iter().find(|s| s.starts_with(heading));
        let section = section.unwrap_or_else(|| panic!("no section {heading}"));
        for key in properties(&schema_of_setups, Some(name)) {
            assert!(has_row(section, &key), "{heading} has no `{key}`");
        }
    }
    let page = chapter("matching.md");
    for key in properties(&schema("match"), None) {
        assert!(has_row(&page.text, &key), "matching.md has no `{key}`");
    }
}

#[test]
fn the_book_is_whole() {
    let readme = root().join("README.md");
    assert!(fs::metadata(&readme).unwrap().len() <= 4500);
    let summary = chapter("SUMMARY.md").text;
    for page in pages() {
        let listed = page.name == "README.md" || page.name == "SUMMARY.md";
        let link = format!("]({})", page.name);
        assert!(listed || summary.contains(&link), "{link} is not listed");
    }
    let mut links = 0;
    let folders = [(root(), "README.md"), (root(), "CONTRIBUTING.md")];
    let chapters = pages().into_iter().skip(1);
    let chapters = chapters.map(|page| (root().join("docs/src"), page.text));
    let others = folders.map(|(folder, name)| (folder.clone(), page(&folder.join(name)).text));
    for (folder, text) in others.into_iter().chain(chapters) {
        for (_, after) in text
            .match_indices("](")
            .map(|(at, _)| text.split_at(at + 2))
        {
            let target = after.split(')').next().unwrap();
            let file = target.split('#').next().unwrap();
            if !file.is_empty() && !file.starts_with("http") {
                links += 1;
                assert!(folder.join(file).exists(), "{target} is not there");
            }
        }
    }
    assert!(links > 50, "{links} links");
}
