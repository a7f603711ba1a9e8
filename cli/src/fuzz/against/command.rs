//! The words of the other program, with the places for its files.

use premio_verify::against::result_file::ResultFormat;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The place of the model's file.
const MODEL: &str = "{}";

/// The begin of the place of the file that the program writes, and its end.
const OUTPUT: &str = "{out.";
const END: char = '}';

/// A command whose words name the model's file and perhaps an output.
#[derive(Clone, Debug, PartialEq)]
pub struct AgainstCommand {
    words: Vec<String>,
    /// The format of the file that it writes.
    pub output: Option<ResultFormat>,
}

/// Why a text is no command.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CommandError {
    /// A quote is not closed, or there is no word.
    #[error("expected words as a shell has them, every quote closed")]
    Words,
    /// No word has the place of the model.
    #[error("expected `{{}}` where the model's file shall be")]
    NoModel,
    /// An output has an unknown ending, or there are several.
    #[error(
        "found `{found}`, expected one of `{{out.stl}}`, `{{out.off}}`, `{{out.obj}}`, `{{out.step}}`"
    )]
    Output {
        /// What was found.
        found: String,
    },
    /// The program does not exist.
    #[error("the program {program} is not found")]
    Absent {
        /// Its name.
        program: String,
    },
}

impl AgainstCommand {
    /// The words of a text, split as a shell splits them; no shell is started.
    pub fn new(text: &str) -> Result<Self, CommandError> {
        let words = shlex::split(text).filter(|words| !words.is_empty());
        let words = words.ok_or(CommandError::Words)?;
        if !words.iter().any(|word| word.contains(MODEL)) {
            return Err(CommandError::NoModel);
        }
        let mut output = None;
        for word in &words {
            for (at, _) in word.match_indices(OUTPUT) {
                let found = &word[at..];
                let end = found.find(END).map_or(found.len(), |end| end + 1);
                let found = &found[..end];
                let is_of = |format: &ResultFormat| found == placeholder(*format);
                let format = ResultFormat::ALL.into_iter().find(is_of);
                if format.is_none() || output.is_some_and(|known| Some(known) != format) {
                    let found = found.to_owned();
                    return Err(CommandError::Output { found });
                }
                output = format;
            }
        }
        Ok(Self { words, output })
    }

    /// Checks that the program exists, in the folders of `PATH` if its name has no folder.
    pub fn check(&self) -> Result<(), CommandError> {
        let program = &self.words[0];
        let is_there = match program.contains(std::path::MAIN_SEPARATOR) {
            true => Path::new(program).is_file(),
            false => {
                let folders = std::env::var_os("PATH").unwrap_or_default();
                let name = |folder: PathBuf| folder.join(program).is_file();
                std::env::split_paths(&folders).any(name) || cfg!(windows)
            }
        };
        match is_there {
            true => Ok(()),
            false => Err(CommandError::Absent {
                program: program.clone(),
            }),
        }
    }

    /// The words with the names of files in their places.
    pub fn words(&self, model: &Path, output: &Path) -> Vec<OsString> {
        let filled = |word: &String| {
            let mut word = word.replace(MODEL, &model.to_string_lossy());
            if let Some(format) = self.output {
                word = word.replace(&placeholder(format), &output.to_string_lossy());
            }
            OsString::from(word)
        };
        self.words.iter().map(filled).collect()
    }
}

fn placeholder(format: ResultFormat) -> String {
    format!("{OUTPUT}{format}{END}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_split_and_filled() {
        let command = AgainstCommand::new("run --in={} 'a b' -o {out.stl}").unwrap();
        assert_eq!(command.output, Some(ResultFormat::ALL[0]));
        let words = command.words(Path::new("/t/m.csg"), Path::new("/t/o.stl"));
        assert_eq!(words, ["run", "--in=/t/m.csg", "a b", "-o", "/t/o.stl"]);
        // Other braces are the program's own.
        let command = AgainstCommand::new("run '{a}' {}").unwrap();
        let words = command.words(Path::new("m"), Path::new("o"));
        assert_eq!(words, ["run", "{a}", "m"]);
    }

    #[test]
    fn what_is_no_command_is_an_error() {
        let error = |text: &str| AgainstCommand::new(text).unwrap_err();
        assert_eq!(error(""), CommandError::Words);
        assert_eq!(error("run '{}"), CommandError::Words);
        assert_eq!(error("run"), CommandError::NoModel);
        for found in ["{out.dwg}", "{out.}", "{out.stl"] {
            let output = CommandError::Output {
                found: found.to_owned(),
            };
            assert_eq!(error(&format!("run {{}} {found}")), output);
        }
        assert!(matches!(
            error("run {} {out.stl} {out.off}"),
            CommandError::Output { .. }
        ));
        let absent = AgainstCommand::new("no-such-program {}").unwrap().check();
        assert!(matches!(absent, Err(CommandError::Absent { .. })));
    }
}
