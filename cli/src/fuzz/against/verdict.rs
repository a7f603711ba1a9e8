//! The verdict on another program's result for a tree.

use super::launch::LARGEST_FILE;
use super::process::{ProgramEnd, ProgramReport};
use premio_verify::against::answer::{
    AnswerError, StatedAnswer, StatedMeasures, last_answer, one_line,
};
use premio_verify::against::comparison::{ComparedMeasure, MeasureDifference};
use premio_verify::against::result_file::{ResultFormat, measures};
use premio_verify::trial::reason;
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// The verdict on a program's result.
#[derive(Clone, Debug, PartialEq)]
pub enum AgainstVerdict {
    /// Every stated measure is right.
    Right,
    /// These measures differ.
    Wrong(Vec<MeasureDifference>),
    /// There is no result, in the program's words.
    Refused(String),
    /// It failed otherwise.
    Failed(AgainstFailure, String),
    /// Our own result is refused or wrong, so nothing is known.
    Unknown,
}

/// A failure other than a wrong measure.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum AgainstFailure {
    /// A signal ended the program.
    Crashed,
    /// It had no answer within the limit of time.
    Slow,
    /// It had too little memory.
    Memory,
    /// Its answer or its file cannot be read.
    Unread,
}

impl AgainstFailure {
    /// The name, as it is written in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Crashed => "crashed",
            Self::Slow => "slow",
            Self::Memory => "memory",
            Self::Unread => "unread",
        }
    }
}

/// The kind of a finding.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(untagged)]
pub enum AgainstFindingKind {
    /// This measure differs.
    Measure(ComparedMeasure),
    /// The program failed.
    Failure(AgainstFailure),
}

impl AgainstFindingKind {
    /// The name, as it is written in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Measure(measure) => measure.name(),
            Self::Failure(failure) => failure.name(),
        }
    }
}

impl AgainstVerdict {
    /// Whether it has a finding of a kind.
    pub fn has(&self, kind: AgainstFindingKind) -> bool {
        match self {
            Self::Wrong(differences) => differences
                .iter()
                .any(|d| kind == AgainstFindingKind::Measure(d.measure)),
            Self::Failed(failure, _) => kind == AgainstFindingKind::Failure(*failure),
            Self::Right | Self::Refused(_) | Self::Unknown => false,
        }
    }

    /// Whether it is a refusal for a reason.
    pub fn is_refusal(&self, kind: &str) -> bool {
        matches!(self, Self::Refused(words) if reason(words) == kind)
    }
}

/// What a program has to say of its result.
#[derive(Clone, Debug, PartialEq)]
pub enum ProgramResult {
    /// These measures.
    Measures(StatedMeasures),
    /// No measures.
    Verdict(AgainstVerdict),
}

/// The signals of a processor time and of a file beyond the limit.
const OVER_TIME: i32 = 24;
const OVER_SIZE: i32 = 25;

/// The signal of a program that is ended from outside, as by a system without memory.
const KILLED: i32 = 9;

/// Words of programs that have no memory.
const NO_MEMORY: [&str; 7] = [
    "memoryerror",
    "bad_alloc",
    "out of memory",
    "cannot allocate memory",
    "memory exhausted",
    "memory allocation of",
    "memory: found no room",
];

/// The result in a program's output and in the file that it wrote.
pub fn result(report: &ProgramReport, file: Option<(&Path, ResultFormat)>) -> ProgramResult {
    use AgainstFailure::{Crashed, Memory, Slow, Unread};
    let failed = |failure, words| ProgramResult::Verdict(AgainstVerdict::Failed(failure, words));
    let said = last_line(&report.errors);
    match report.end {
        ProgramEnd::TooLong | ProgramEnd::Signalled(OVER_TIME) => {
            failed(Slow, "no answer within the limit of time".to_owned())
        }
        ProgramEnd::Signalled(OVER_SIZE) => {
            let most = LARGEST_FILE >> 20;
            failed(Unread, format!("it wrote more than {most} MiB"))
        }
        ProgramEnd::Stopped => ProgramResult::Verdict(AgainstVerdict::Unknown),
        _ if report.end != ProgramEnd::Exited(0) && has_no_memory(&report.errors) => {
            failed(Memory, said)
        }
        ProgramEnd::Signalled(KILLED) => failed(Memory, "it was killed".to_owned()),
        ProgramEnd::Signalled(signal) => failed(Crashed, format!("signal {signal}: {said}")),
        ProgramEnd::Exited(0) => answered(report, file),
        ProgramEnd::Exited(status) => {
            let words = match last_answer(&report.output) {
                Ok(StatedAnswer::Refusal(words)) => words,
                _ => format!("status {status}: {said}"),
            };
            ProgramResult::Verdict(AgainstVerdict::Refused(words))
        }
    }
}

fn has_no_memory(errors: &str) -> bool {
    let errors = errors.to_lowercase();
    NO_MEMORY.iter().any(|words| errors.contains(words))
}

fn last_line(errors: &str) -> String {
    let line = errors.lines().rev().find(|line| !line.trim().is_empty());
    one_line(line.unwrap_or_default())
}

/// The measures of the file, with what the line of JSON states of them; without a file those of the
/// line.
fn answered(report: &ProgramReport, file: Option<(&Path, ResultFormat)>) -> ProgramResult {
    let unread = |words: String| {
        let failure = AgainstFailure::Unread;
        ProgramResult::Verdict(AgainstVerdict::Failed(failure, words))
    };
    let line = match last_answer(&report.output) {
        Ok(StatedAnswer::Refusal(words)) => {
            return ProgramResult::Verdict(AgainstVerdict::Refused(words));
        }
        Ok(StatedAnswer::Measures(measures)) => Ok(measures),
        Err(error) => Err(error),
    };
    let Some((path, format)) = file else {
        return line.map_or_else(|e| unread(e.to_string()), ProgramResult::Measures);
    };
    let line = match line {
        Ok(line) => line,
        // Beside a file the line may state nothing.
        Err(AnswerError::Absent) => StatedMeasures::default(),
        Err(error) => return unread(error.to_string()),
    };
    let bytes = match bytes(path) {
        Ok(bytes) => bytes,
        Err(error) => return unread(format!("the file {format}: {}", error.kind())),
    };
    match measures(&bytes, format) {
        Ok(mut found) => {
            found.accuracy.relative += line.accuracy.relative;
            found.accuracy.volume += line.accuracy.volume;
            found.accuracy.area += line.accuracy.area;
            found.seconds = line.seconds;
            ProgramResult::Measures(found)
        }
        Err(error) => unread(format!("the file {format}: {error}")),
    }
}

/// The content of a file; it may be no file, or one without end.
fn bytes(path: &Path) -> std::io::Result<Vec<u8>> {
    if !std::fs::symlink_metadata(path)?.is_file() {
        return Err(std::io::ErrorKind::InvalidInput.into());
    }
    let mut bytes = Vec::new();
    File::open(path)?
        .take(LARGEST_FILE)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_csg::mesh_file::MeshFormat;

    fn of(end: ProgramEnd, output: &str, errors: &str) -> ProgramResult {
        let report = ProgramReport {
            end,
            output: output.to_owned(),
            errors: errors.to_owned(),
            seconds: 1.0,
        };
        result(&report, None)
    }

    #[test]
    fn every_end_has_a_verdict() {
        use ProgramEnd::{Exited, Signalled, TooLong};
        let measures = of(Exited(0), "{\"volume\": 2}\n", "a warning");
        assert!(matches!(measures, ProgramResult::Measures(m) if m.volume == Some(2.0)));
        let verdict = |end, output, errors| match of(end, output, errors) {
            ProgramResult::Verdict(verdict) => verdict,
            ProgramResult::Measures(measures) => panic!("{measures:?}"),
        };
        let refused = |words: &str| AgainstVerdict::Refused(words.to_owned());
        let error = "Traceback\n  line 3\nValueError: odd\n\n";
        assert_eq!(
            verdict(Exited(1), "", error),
            refused("status 1: ValueError: odd")
        );
        let line = "{\"error\": \"not valid\"}";
        assert_eq!(verdict(Exited(3), line, error), refused("not valid"));
        assert_eq!(verdict(Exited(0), line, ""), refused("not valid"));
        for (end, output, errors, kind) in [
            (
                Exited(0),
                "",
                "",
                AgainstFindingKind::Failure(AgainstFailure::Unread),
            ),
            (
                Exited(1),
                "",
                "MemoryError",
                AgainstFindingKind::Failure(AgainstFailure::Memory),
            ),
            (
                Signalled(6),
                "",
                "std::bad_alloc",
                AgainstFindingKind::Failure(AgainstFailure::Memory),
            ),
            (
                Signalled(11),
                "{\"volume\": 2}",
                "",
                AgainstFindingKind::Failure(AgainstFailure::Crashed),
            ),
            (
                TooLong,
                "{\"volume\": 2}",
                "",
                AgainstFindingKind::Failure(AgainstFailure::Slow),
            ),
            (
                Signalled(OVER_SIZE),
                "",
                "",
                AgainstFindingKind::Failure(AgainstFailure::Unread),
            ),
        ] {
            assert!(verdict(end, output, errors).has(kind), "{end:?}");
        }
    }

    #[test]
    fn an_output_may_be_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.off");
        let report = |output: &str| ProgramReport {
            end: ProgramEnd::Exited(0),
            output: output.to_owned(),
            errors: String::new(),
            seconds: 1.0,
        };
        let of = |output: &str| {
            result(
                &report(output),
                Some((&path, ResultFormat::Mesh(MeshFormat::Off))),
            )
        };
        let unread = |result: &ProgramResult| matches!(result, ProgramResult::Verdict(v) if v.has(AgainstFindingKind::Failure(AgainstFailure::Unread)));
        assert!(unread(&of("")));
        std::fs::write(&path, "OFF 0 0 0\n").unwrap();
        let ProgramResult::Measures(found) = of("{\"volume\": 7, \"tolerance\": 0.5}") else {
            panic!()
        };
        assert_eq!((found.volume, found.accuracy.relative), (Some(0.0), 0.5));
        std::fs::remove_file(&path).unwrap();
        std::fs::create_dir(&path).unwrap();
        assert!(unread(&of("")));
    }
}
