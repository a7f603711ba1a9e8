//! `premio match` and `premio track`: the part in pictures.

use crate::arguments::{MatchOptions, SoughtOptions, StrategyName, TrackOptions};
use crate::diagnostics::CliError;
use crate::input::{self, EvaluatedPart, PinholeFile};
use crate::interrupt::stop;
use crate::model::file::ReadModel;
use crate::output::Outputs;
use crate::session::Session;
use crate::{imaging, output};
use premio::{
    CancelToken, DetectabilityPrior, Detector, Format, Grey, PartFinder, PictureMatch, Pinhole,
    Progress, SearchOptions, Strategy, default_detector,
};
use premio_matching::output::report::{BOP, BopIds};
use premio_predict::model::file::ModelFile;
use premio_predict::model::record::Record;
use std::fmt::Write;
use std::path::Path;

/// The part and the options of the search.
struct Sought {
    name: String,
    described: EvaluatedPart,
    resolution: f64,
    records: Vec<Record>,
    detector: Detector,
    camera: PinholeFile,
    options: SearchOptions,
}

/// Runs `match`.
pub fn find(options: &MatchOptions, session: Session) -> Result<(), CliError> {
    let sought = read(&options.sought, session)?;
    let stop = CancelToken::from(stop()?);
    let finder = sought.finder(&options.sought, &stop)?;
    let look = |picture: Grey, camera: Pinhole, name: &str| {
        let found = finder.find_with(picture, camera, name, |matcher| matcher.find())?;
        Ok(match options.explain {
            true => found.with_measures(),
            false => found,
        })
    };
    let told = |found: &PictureMatch| options.explain.then(|| found.explained());
    each(&options.sought, &sought.camera, look, told, session)
}

/// Runs `track`.
pub fn track(options: &TrackOptions, session: Session) -> Result<(), CliError> {
    let sought = read(&options.sought, session)?;
    let stop = CancelToken::from(stop()?);
    let finder = sought.finder(&options.sought, &stop)?;
    let mut tracker = finder.track();
    let look =
        |picture: Grey, camera: Pinhole, name: &str| tracker.next_with(picture, camera, name);
    each(&options.sought, &sought.camera, look, |_| None, session)
}

impl Sought {
    fn prior(&self, options: &SoughtOptions) -> DetectabilityPrior {
        match (options.uniform, self.records.is_empty()) {
            (true, _) => DetectabilityPrior::uniform(),
            (false, true) => DetectabilityPrior::nothing(),
            (false, false) => DetectabilityPrior::new(&self.records, self.described.solid.brep()),
        }
    }

    /// The finder of the part, which an interrupt stops.
    fn finder(
        &self,
        options: &SoughtOptions,
        stop: &CancelToken,
    ) -> Result<PartFinder<'_>, CliError> {
        let (brep, detector) = (self.described.solid.brep(), self.detector.clone());
        let finder = PartFinder::from_brep(brep, self.resolution, self.prior(options), detector);
        let finder = finder.map_err(CliError::library)?;
        let progress = Progress::new().with_token(stop);
        let finder = finder.with_name(&self.name).with_options(self.options);
        Ok(finder.with_progress(progress))
    }
}

/// Reads the part, the camera and the detector.
fn read(options: &SoughtOptions, session: Session) -> Result<Sought, CliError> {
    let path = &options.model;
    let name = path.display().to_string();
    if options.overlay.is_some() && options.images.len() != 1 {
        let said = "--overlay takes one picture, and there are";
        return Err(CliError::input(format!("{said} {}", options.images.len())));
    }
    if let Some(path) = &options.overlay {
        imaging::format(path)?;
    }
    let camera = PinholeFile::read(&options.camera, session)?;
    let is_model = path.extension().is_some_and(|e| e == "model");
    let mut known = None;
    let define = &options.define;
    let (described, records) = match (is_model, Format::from_path(path)) {
        (true, _) if !define.overrides.is_empty() => {
            let said = "found `-D`, expected a .padl description, in which numbers have names";
            return Err(CliError::input(format!("{name}: {said}")));
        }
        (true, _) => {
            let model = ReadModel::read(path, session)?;
            let described = model.part(session)?;
            let ModelFile { head, records } = model.file;
            known = Some(head.setups.conditions.detector);
            (described, records)
        }
        (false, Some(_)) => (input::described(path, define, session)?, Vec::new()),
        (false, None) => {
            let expected =
                "expected a model (.model), or a description (.padl, .csg, .json, .asc or .pov)";
            let said = format!("{name}: found a file of an unknown kind, {expected}");
            return Err(CliError::input(said));
        }
    };
    let detector = match &options.detector {
        Some(path) => crate::setup::detector(path, session)?,
        None => known.unwrap_or_else(default_detector),
    };
    let resolution = input::view_resolution(&described)?;
    if described.solid.brep().topology.faces.is_empty() {
        return Err(CliError::input(format!(
            "{name}: the part is empty: there is nothing to find"
        )));
    }
    Ok(Sought {
        name,
        described,
        resolution,
        records,
        detector,
        camera,
        options: SearchOptions {
            strategy: match options.strategy {
                StrategyName::Bounded => Strategy::Bounded,
                StrategyName::Deepening => Strategy::Deepening,
                StrategyName::Stepped => Strategy::Stepped,
            },
            ..SearchOptions::default()
        },
    })
}

/// Searches every picture, and writes the results.
fn each(
    options: &SoughtOptions,
    camera: &PinholeFile,
    mut look: impl FnMut(Grey, Pinhole, &str) -> premio::Result<PictureMatch>,
    explain: impl Fn(&PictureMatch) -> Option<String>,
    session: Session,
) -> Result<(), CliError> {
    let voice = session.voice;
    let bar = voice.progress(options.images.len() as u64);
    let (mut lines, mut poses) = (String::new(), format!("{BOP}\n"));
    let mut outputs = Outputs::default();
    let (mut seen, mut failed) = (0, None);
    for (number, path) in (1..).zip(&options.images) {
        let found = match at(camera, path, &mut look, session) {
            Ok(found) => found,
            Err(CliError::Interrupted) => {
                bar.finish_and_clear();
                return Err(CliError::Interrupted);
            }
            // The other pictures are still searched.
            Err(failure) => {
                let said = failed.replace(failure);
                bar.suspend(|| said.map(|failure| voice.fail(failure)));
                bar.inc(1);
                continue;
            }
        };
        seen += 1;
        let report = found.report();
        bar.inc(1);
        if let Some(words) = explain(&found) {
            bar.suspend(|| voice.note(&report.image, &words));
        }
        let instances = report.instances.len();
        if instances > 1 {
            let said = format!(
                "{instances} instances of the part are found: this is the likeliest, and `instances` \
                 lists all that are known"
            );
            bar.suspend(|| voice.note(&report.image, &said));
        }
        let [scene, object] = options.ids;
        let image = numbered(path).unwrap_or(number);
        let ids = BopIds {
            scene,
            image,
            object,
        };
        if let Some(line) = report.bop(ids) {
            let _ = writeln!(poses, "{line}");
        }
        let json = match options.images.len() {
            1 => output::json_pretty(report)?,
            _ => output::json_text(report)?,
        };
        let _ = writeln!(lines, "{json}");
        if let Some(to) = &options.overlay
            && let Some(bytes) = imaging::matched(&found, to)?
        {
            outputs.add(bytes, Some(to))?;
        }
    }
    bar.finish_and_clear();
    if seen > 0 {
        if let Some(path) = &options.csv {
            outputs.add(poses.into_bytes(), Some(path))?;
        }
        outputs.add(lines.into_bytes(), options.output.as_deref())?;
        outputs.finish()?;
    }
    failed.map_or(Ok(()), Err)
}

/// Searches one picture.
fn at(
    camera: &PinholeFile,
    path: &Path,
    look: &mut impl FnMut(Grey, Pinhole, &str) -> premio::Result<PictureMatch>,
    session: Session,
) -> Result<PictureMatch, CliError> {
    let grey = imaging::read(path, session)?;
    let camera = camera.for_picture(path, [grey.width, grey.height])?;
    look(grey, camera, &path.display().to_string()).map_err(CliError::library)
}

/// The number at the end of a picture's name.
fn numbered(path: &Path) -> Option<u32> {
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[stem.len() - digits..].parse().ok()
}
