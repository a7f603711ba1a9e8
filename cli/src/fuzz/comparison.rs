//! The examiner of trees by ourselves and by another program.

use super::against::command::AgainstCommand;
use super::against::launch::ProgramLimits;
use super::against::process::{ProgramEnd, run};
use super::against::tally::{AgainstOutcome, AgainstTimes};
use super::against::verdict::{AgainstVerdict, ProgramResult, result};
use super::examine::{Examine, Examined, ModelOrigin};
use super::item::{FileModel, Item, TreeSource};
use super::worker::Worker;
use premio_verify::against::comparison::KnownPart;
use premio_verify::against::template::ModelTemplate;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::profile::rounded::{CoordinateRounding, meant};
use premio_verify::generator::write::{Format, description, format, write};
use premio_verify::trial::{TrialMeasures, Verdict};
use std::io;
use std::sync::atomic::AtomicBool;

/// The form in which the program gets a model.
#[derive(Clone, Debug, PartialEq)]
pub enum ModelForm {
    /// A description.
    Description(Format),
    /// A program of a template.
    Program(ModelTemplate),
}

impl ModelForm {
    fn ending(&self, model: &PartModel) -> &'static str {
        match self {
            Self::Description(wanted) => format(model, *wanted).ending(),
            Self::Program(template) => template.ending(),
        }
    }

    /// The text of a model; `None` if the program's language has no words for it.
    fn text(&self, model: &PartModel) -> Option<String> {
        match self {
            Self::Description(format) => Some(write(model, *format)),
            Self::Program(template) => template.program(model),
        }
    }
}

/// The configuration of runs of another program.
#[derive(Clone, Debug, PartialEq)]
pub struct AgainstConfig {
    /// The program.
    pub command: AgainstCommand,
    /// The form of the models.
    pub form: ModelForm,
    /// The limits of the program.
    pub limits: ProgramLimits,
    /// The relative tolerance of volume, area and bounds.
    pub tolerance: f64,
}

/// An examiner that runs our own trial first, and the program where our result is right.
#[derive(Debug)]
pub struct AgainstExaminer<'a> {
    worker: Worker<'a>,
    config: &'a AgainstConfig,
    files: &'a [FileModel],
    stop: &'a AtomicBool,
}

impl<'a> AgainstExaminer<'a> {
    /// An examiner with a worker for our own trials.
    pub fn new(
        worker: Worker<'a>,
        config: &'a AgainstConfig,
        files: &'a [FileModel],
        stop: &'a AtomicBool,
    ) -> Self {
        Self {
            worker,
            config,
            files,
            stop,
        }
    }

    /// The measures that the program should find. A whole part of the profile `rounded` is compared
    /// with the part that was meant.
    fn expected(
        &mut self,
        origin: &ModelOrigin,
        ours: &Verdict,
    ) -> io::Result<Option<TrialMeasures>> {
        let measures = |verdict: &Verdict| match verdict {
            Verdict::Right(measures) => Some(*measures),
            Verdict::Refused(_) | Verdict::Wrong(_) => None,
        };
        match origin.item.source {
            TreeSource::Profile(Profile::Rounded) if origin.is_whole => {
                let whole = meant(origin.item.seed);
                let examined = self.worker.examine(&whole, origin)?;
                Ok(examined.and_then(|e| measures(&e.outcome.verdict)))
            }
            _ => Ok(measures(ours)),
        }
    }

    /// The result of the program for the text of a model; none where the run shall stop.
    fn program(&self, model: &PartModel, text: &str) -> io::Result<Option<(ProgramResult, f64)>> {
        let folder = tempfile::tempdir()?;
        let config = self.config;
        let input = folder
            .path()
            .join("model")
            .with_extension(config.form.ending(model));
        std::fs::write(&input, text)?;
        let format = config.command.output;
        let ending = format.map_or("none", |format| format.ending());
        let output = folder.path().join("out").with_extension(ending);
        let words = config.command.words(&input, &output);
        let mut report = run(&words, &config.limits, self.stop)?;
        if report.end == ProgramEnd::Stopped {
            return Ok(None);
        }
        // The name of the folder is another one every time.
        for text in [&mut report.output, &mut report.errors] {
            *text = text.replace(&*folder.path().to_string_lossy(), ".");
        }
        let file = format.map(|format| (output.as_path(), format));
        Ok(Some((result(&report, file), report.seconds)))
    }
}

impl Examine for AgainstExaminer<'_> {
    fn examine(&mut self, model: &PartModel, origin: &ModelOrigin) -> io::Result<Option<Examined>> {
        let Some(mut examined) = self.worker.examine(model, origin)? else {
            return Ok(None);
        };
        let expected = self.expected(origin, &examined.outcome.verdict)?;
        let mut times = AgainstTimes {
            ours: examined.outcome.seconds,
            ..AgainstTimes::default()
        };
        let verdict = match expected.zip(self.config.form.text(model)) {
            None => AgainstVerdict::Unknown,
            Some((measures, text)) => {
                let Some((result, seconds)) = self.program(model, &text)? else {
                    return Ok(None);
                };
                times.program = seconds;
                times.stated = seconds;
                match result {
                    ProgramResult::Verdict(verdict) => verdict,
                    ProgramResult::Measures(stated) => {
                        let said = stated.seconds.filter(|s| (0.0..seconds).contains(s));
                        times.stated = said.unwrap_or(seconds);
                        let displacement = displacement(origin.item, self.files, &measures);
                        let known = KnownPart::new(model, measures, displacement);
                        let found = known.differences(&stated, self.config.tolerance);
                        match found.is_empty() {
                            true => AgainstVerdict::Right,
                            false => AgainstVerdict::Wrong(found),
                        }
                    }
                }
            }
        };
        examined.against = Some(AgainstOutcome { verdict, times });
        Ok(Some(examined))
    }
}

/// The distance by which rounded coordinates move a primitive.
fn displacement(item: Item, files: &[FileModel], measures: &TrialMeasures) -> f64 {
    match item.source {
        TreeSource::Files => item.file(files).map_or(0.0, |file| file.displacement),
        TreeSource::Profile(Profile::Rounded) => {
            // The farthest coordinate has the coarsest digits.
            let corners = measures.bounds.into_iter().flatten().flatten();
            let reach = corners.fold(1.0, |reach: f64, x| reach.max(x.abs()));
            let decimals = CoordinateRounding::new(item.seed).decimals(reach);
            10f64.powi(-(decimals as i32))
        }
        TreeSource::Profile(_) => 0.0,
    }
}

/// The model of a file, with the effect of its rounding.
pub fn file_model(model: PartModel) -> FileModel {
    let tree = description(&model).map(|read| read.tree);
    let recovery = tree
        .ok()
        .and_then(|tree| premio_csg::recover::recovered(&tree));
    FileModel {
        model,
        displacement: recovery.map_or(0.0, |recovery| recovery.furthest),
    }
}
