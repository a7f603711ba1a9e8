//! `premio match` and `premio track`: where the part is in pictures.

use crate::arguments::{MatchOptions, SoughtOptions, StrategyName, TrackOptions};
use crate::diagnostics::CliError;
use crate::input::{self, EvaluatedPart, PinholeFile};
use crate::interrupt::stop;
use crate::model::file::ReadModel;
use crate::output::Outputs;
use crate::session::Session;
use crate::{imaging, output};
use nalgebra::Isometry3;
use premio_csg::reader::Format;
use premio_detect::{Detector, Grey};
use premio_matching::camera::Pinhole;
use premio_matching::image::{ImageFeatures, detector, downsampled};
use premio_matching::matcher::Matcher;
use premio_matching::output::explain::explained;
use premio_matching::output::report::{BOP, MatchReport, MatchSeconds};
use premio_matching::part::SoughtPart;
use premio_matching::part::detectability_prior::DetectabilityPrior;
use premio_matching::search::Strategy;
use premio_matching::verification::part_match::{PartMatch, SearchOptions, SearchResult};
use premio_predict::model::file::ModelFile;
use premio_predict::model::record::Record;
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What is looked for.
struct Sought {
    name: String,
    described: EvaluatedPart,
    resolution: f64,
    records: Vec<Record>,
    detector: Detector,
    camera: PinholeFile,
    options: SearchOptions,
}

/// What was seen in one picture.
struct Sight {
    grey: Grey,
    picture: ImageFeatures,
    finding: SearchResult,
    report: MatchReport,
}

/// Runs `match`.
pub fn find(options: &MatchOptions, session: Session) -> Result<(), CliError> {
    let sought_for = read(&options.sought, session)?;
    let learned = sought_for.learned(&options.sought);
    let part = sought_for.part(&learned);
    let look = |picture: &ImageFeatures, camera: &Pinhole| {
        let look = sought_for.look(&part, &learned, picture, camera);
        (look.find(), None)
    };
    let told = |sight: &Sight| {
        let explain = options.explain;
        explain.then(|| explained(sight.finding.best(), &sight.report))
    };
    each(&options.sought, &sought_for, &part, look, told, session)
}

/// Runs `track`.
pub fn track(options: &TrackOptions, session: Session) -> Result<(), CliError> {
    let sought = read(&options.sought, session)?;
    let learned = sought.learned(&options.sought);
    let part = sought.part(&learned);
    let mut last: Option<Isometry3<f64>> = None;
    let look = |picture: &ImageFeatures, camera: &Pinhole| {
        let look = sought.look(&part, &learned, picture, camera);
        let (finding, anew) = look.next(last.as_ref());
        let accepted = finding.best().filter(|m| m.is_accepted());
        last = accepted.map(|m: &PartMatch| m.pose);
        (finding, Some(anew))
    };
    each(&options.sought, &sought, &part, look, |_| None, session)
}

impl Sought {
    fn learned(&self, options: &SoughtOptions) -> DetectabilityPrior {
        match (options.uniform, self.records.is_empty()) {
            (true, _) => DetectabilityPrior::uniform(),
            (false, true) => DetectabilityPrior::nothing(),
            (false, false) => {
                DetectabilityPrior::new(&self.records, &self.described.evaluation.brep)
            }
        }
    }

    fn part(&self, learned: &DetectabilityPrior) -> SoughtPart<'_> {
        SoughtPart::new(&self.described.evaluation.brep, self.resolution, learned)
    }

    /// The part looked for in a picture.
    fn look<'a>(
        &'a self,
        part: &'a SoughtPart<'a>,
        learned: &'a DetectabilityPrior,
        picture: &'a ImageFeatures,
        camera: &'a Pinhole,
    ) -> Matcher<'a> {
        Matcher {
            part,
            learned,
            picture,
            camera,
            options: &self.options,
        }
    }
}

/// Reads what is looked for.
fn read(options: &SoughtOptions, session: Session) -> Result<Sought, CliError> {
    let path = &options.model;
    let name = path.display().to_string();
    if options.overlay.is_some() && options.images.len() != 1 {
        let said = "--overlay is of one picture, and there are";
        return Err(CliError::input(format!("{said} {}", options.images.len())));
    }
    if let Some(path) = &options.overlay {
        imaging::format(path)?;
    }
    let camera = PinholeFile::read(&options.camera, session)?;
    let is_model = path.extension().is_some_and(|e| e == "model");
    let mut known = None;
    let (described, records) = match (is_model, Format::from_path(path)) {
        (true, _) => {
            let model = ReadModel::read(path, session)?;
            let described = model.part(session)?;
            let ModelFile { head, records } = model.file;
            known = Some(head.setups.conditions.detector);
            (described, records)
        }
        (false, Some(_)) => (input::described(path, session)?, Vec::new()),
        (false, None) => {
            let expected =
                "expected a model (.model), or a description (.padl, .csg, .json, .asc or .pov)";
            let said = format!("{name}: found a file of an unknown kind, {expected}");
            return Err(CliError::input(said));
        }
    };
    let detector = match &options.detector {
        Some(path) => crate::setup::detector(path, session)?,
        None => known.unwrap_or_else(detector),
    };
    let resolution = input::view_resolution(&described)?;
    if described.evaluation.brep.topology.faces.is_empty() {
        return Err(CliError::input(format!(
            "{name}: the part is empty: there is nothing to be found"
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

/// Looks at every picture, and hands on what is found.
fn each(
    options: &SoughtOptions,
    sought: &Sought,
    part: &SoughtPart<'_>,
    mut look: impl FnMut(&ImageFeatures, &Pinhole) -> (SearchResult, Option<bool>),
    told: impl Fn(&Sight) -> Option<String>,
    session: Session,
) -> Result<(), CliError> {
    let voice = session.voice;
    let stop = stop()?;
    let bar = voice.progress(options.images.len() as u64);
    let (mut lines, mut poses) = (String::new(), format!("{BOP}\n"));
    let mut outputs = Outputs::default();
    let (mut seen, mut failed) = (0, None);
    for (number, path) in (1..).zip(&options.images) {
        if stop.load(Ordering::Relaxed) {
            bar.finish_and_clear();
            return Err(CliError::Interrupted);
        }
        let sight = match at(sought, part, path, &mut look, session) {
            Ok(sight) => sight,
            // The other pictures are looked at all the same.
            Err(failure) => {
                let said = failed.replace(failure);
                bar.suspend(|| said.map(|failure| voice.fail(failure)));
                bar.inc(1);
                continue;
            }
        };
        seen += 1;
        bar.inc(1);
        if let Some(words) = told(&sight) {
            bar.suspend(|| voice.note(&sight.report.image, &words));
        }
        let instances = sight.report.instances.len();
        if instances > 1 {
            let said = format!(
                "{instances} instances of the part are found: this is the likeliest, and `instances` \
                 lists all that are known"
            );
            bar.suspend(|| voice.note(&sight.report.image, &said));
        }
        let [scene, object] = options.ids;
        let image = numbered(path).unwrap_or(number);
        if let Some(line) = sight.report.bop([scene, image, object]) {
            let _ = writeln!(poses, "{line}");
        }
        let json = match options.images.len() {
            1 => output::json_pretty(&sight.report)?,
            _ => output::json_text(&sight.report)?,
        };
        let _ = writeln!(lines, "{json}");
        if let (Some(to), Some(best)) = (&options.overlay, sight.finding.best()) {
            let bytes = imaging::matched(&sight.grey, &sight.picture, best, to)?;
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

/// Looks at one picture.
fn at(
    sought: &Sought,
    part: &SoughtPart<'_>,
    path: &Path,
    look: &mut impl FnMut(&ImageFeatures, &Pinhole) -> (SearchResult, Option<bool>),
    session: Session,
) -> Result<Sight, CliError> {
    let grey = imaging::read(path, session)?;
    let size = [grey.width, grey.height];
    let camera = sought.camera.for_picture(path, size)?;
    let started = Instant::now();
    let (grey, camera, scale) = downsampled(grey, camera);
    let picture = ImageFeatures::new(&grey, &sought.detector);
    let features = started.elapsed().as_secs_f64();
    let (finding, anew) = look(&picture, &camera);
    let seconds = MatchSeconds {
        features,
        matching: started.elapsed().as_secs_f64() - features,
    };
    let image = path.display().to_string();
    let names = [image.as_str(), sought.name.as_str()];
    let mut report = MatchReport::new(part, names, &picture, &finding, (scale, seconds));
    report.anew = anew;
    Ok(Sight {
        grey,
        picture,
        finding,
        report,
    })
}

/// The number that a picture's name ends in.
fn numbered(path: &Path) -> Option<u32> {
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[stem.len() - digits..].parse().ok()
}
