//! `premio match` and `premio track`: where the part is in pictures.

use crate::arguments::{MatchOptions, SoughtOptions, StrategyName, TrackOptions};
use crate::diagnostics::{Failure, Voice};
use crate::input::{self, Part as Described};
use crate::interrupt::stop;
use crate::{imaging, output};
use nalgebra::Isometry3;
use premio_matching::camera::Pinhole;
use premio_matching::explain::explained;
use premio_matching::finding::{Finding, Match, Options};
use premio_matching::learned::Learned;
use premio_matching::look::Look;
use premio_matching::part::Part;
use premio_matching::picture::{Picture, detector, reduced};
use premio_matching::report::{BOP, Report, Seconds};
use premio_matching::search::Strategy;
use premio_predict::model::record::Record;
use premio_predict::processing::{Detector, Grey};
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::Instant;

/// What is looked for.
struct Sought {
    name: String,
    described: Described,
    band: f64,
    records: Vec<Record>,
    detector: Detector,
    options: Options,
}

/// What was seen in one picture.
struct Sight {
    grey: Grey,
    picture: Picture,
    finding: Finding,
    report: Report,
}

/// Runs `match`.
pub fn find(options: &MatchOptions, voice: Voice) -> Result<(), Failure> {
    let sought_for = read(&options.sought, voice)?;
    let learned = sought_for.learned(&options.sought);
    let part = sought_for.part(&learned);
    let look = |picture: &Picture, camera: &Pinhole| {
        let look = sought_for.look(&part, &learned, picture, camera);
        (look.find(), None)
    };
    let told = |sight: &Sight| {
        let explain = options.explain;
        explain.then(|| explained(sight.finding.best(), &sight.report))
    };
    each(&options.sought, &sought_for, &part, look, told, voice)
}

/// Runs `track`.
pub fn track(options: &TrackOptions, voice: Voice) -> Result<(), Failure> {
    let sought = read(&options.sought, voice)?;
    let learned = sought.learned(&options.sought);
    let part = sought.part(&learned);
    let mut last: Option<Isometry3<f64>> = None;
    let look = |picture: &Picture, camera: &Pinhole| {
        let look = sought.look(&part, &learned, picture, camera);
        let (finding, anew) = look.next(last.as_ref());
        let accepted = finding.best().filter(|m| m.is_accepted());
        last = accepted.map(|m: &Match| m.pose);
        (finding, Some(anew))
    };
    each(&options.sought, &sought, &part, look, |_| None, voice)
}

impl Sought {
    fn learned(&self, options: &SoughtOptions) -> Learned {
        match (options.uniform, self.records.is_empty()) {
            (true, _) => Learned::uniform(),
            (false, true) => Learned::nothing(),
            (false, false) => Learned::of(&self.records, &self.described.evaluation.brep),
        }
    }

    fn part(&self, learned: &Learned) -> Part<'_> {
        Part::new(&self.described.evaluation.brep, self.band, learned)
    }

    /// The part looked for in a picture.
    fn look<'a>(
        &'a self,
        part: &'a Part<'a>,
        learned: &'a Learned,
        picture: &'a Picture,
        camera: &'a Pinhole,
    ) -> Look<'a> {
        Look {
            part,
            learned,
            picture,
            camera,
            options: &self.options,
        }
    }
}

/// Reads what is looked for.
fn read(options: &SoughtOptions, voice: Voice) -> Result<Sought, Failure> {
    let path = &options.model;
    let name = path.display().to_string();
    if options.overlay.is_some() && options.images.len() != 1 {
        let said = "--overlay is of one picture, and there are";
        return Err(Failure::input(format!("{said} {}", options.images.len())));
    }
    let is_model = path.extension().is_some_and(|e| e == "model");
    let (described, records) = match is_model {
        true => {
            let records = records(path)?;
            let head = records.iter().find_map(|r| match r {
                Record::Model(head) => Some(head),
                _ => None,
            });
            let head = head.ok_or_else(|| Failure::input(format!("{name}: no model's head")))?;
            let written = head.description.clone();
            (input::part_of_model(&name, written, voice)?, records)
        }
        false => (input::described(path, voice)?, Vec::new()),
    };
    let known = records.iter().find_map(|r| match r {
        Record::Model(head) => Some(head.setups.conditions.detector.clone()),
        _ => None,
    });
    let detector = match &options.detector {
        Some(path) => crate::setup::detector(path)?,
        None => known.unwrap_or_else(detector),
    };
    let band = input::resolution_of_views(&described)?;
    if described.evaluation.brep.topology.faces.is_empty() {
        return Err(Failure::input(format!(
            "{name}: the part is empty: there is nothing to be found"
        )));
    }
    Ok(Sought {
        name,
        described,
        band,
        records,
        detector,
        options: Options {
            strategy: match options.strategy {
                StrategyName::Bounded => Strategy::Bounded,
                StrategyName::Deepening => Strategy::Deepening,
                StrategyName::Stepped => Strategy::Stepped,
            },
            ..Options::default()
        },
    })
}

/// The records of a model.
fn records(path: &Path) -> Result<Vec<Record>, Failure> {
    let name = path.display();
    let text = String::from_utf8(input::bytes(path)?);
    let text = text.map_err(|e| Failure::input(format!("{name}: {e}")))?;
    let lines = text.lines().enumerate();
    lines
        .map(|(i, line)| {
            let told = |e: serde_json::Error| {
                let expected = "expected a line of a model (premio.model/1)";
                Failure::input(format!("{name}:{}: {expected}: {e}", i + 1))
            };
            serde_json::from_str(line).map_err(told)
        })
        .collect()
}

/// Looks at every picture, and hands on what is found.
fn each(
    options: &SoughtOptions,
    sought: &Sought,
    part: &Part<'_>,
    mut look: impl FnMut(&Picture, &Pinhole) -> (Finding, Option<bool>),
    told: impl Fn(&Sight) -> Option<String>,
    voice: Voice,
) -> Result<(), Failure> {
    let stop = stop()?;
    let bar = voice.progress(options.images.len() as u64);
    let camera_text = text(&options.camera)?;
    let (mut lines, mut poses) = (String::new(), format!("{BOP}\n"));
    for (number, path) in (1..).zip(&options.images) {
        if stop.load(Ordering::Relaxed) {
            bar.finish_and_clear();
            return Err(Failure::Interrupted);
        }
        let sight = at(options, sought, part, path, &camera_text, &mut look)?;
        bar.inc(1);
        if let Some(words) = told(&sight) {
            bar.suspend(|| voice.note(&sight.report.image, &words));
        }
        let [scene, object] = options.ids;
        let image = numbered(path).unwrap_or(number);
        if let Some(line) = sight.report.bop([scene, image, object]) {
            let _ = writeln!(poses, "{line}");
        }
        let json = match options.images.len() {
            1 => serde_json::to_string_pretty(&sight.report),
            _ => serde_json::to_string(&sight.report),
        };
        let json = json.map_err(|e| Failure::input(e.to_string()))?;
        let _ = writeln!(lines, "{json}");
        if let (Some(to), Some(best)) = (&options.overlay, sight.finding.best()) {
            imaging::matched(&sight.grey, &sight.picture, best, to)?;
        }
    }
    bar.finish_and_clear();
    if let Some(path) = &options.csv {
        output::write(poses, Some(path))?;
    }
    output::write(lines, options.output.as_deref())
}

/// Looks at one picture.
fn at(
    options: &SoughtOptions,
    sought: &Sought,
    part: &Part<'_>,
    path: &Path,
    camera: &str,
    look: &mut impl FnMut(&Picture, &Pinhole) -> (Finding, Option<bool>),
) -> Result<Sight, Failure> {
    let grey = imaging::read(path)?;
    let camera = Pinhole::from_json(camera, [grey.width, grey.height]);
    let name = options.camera.display();
    let camera = camera.map_err(|e| Failure::input(format!("{name}: {e}")))?;
    let started = Instant::now();
    let (grey, camera, scale) = reduced(grey, camera);
    let picture = Picture::new(&grey, &sought.detector);
    let features = started.elapsed().as_secs_f64();
    let (finding, anew) = look(&picture, &camera);
    let seconds = Seconds {
        features,
        matching: started.elapsed().as_secs_f64() - features,
    };
    let image = path.display().to_string();
    let names = [image.as_str(), sought.name.as_str()];
    let mut report = Report::new(part, names, &picture, &finding, (scale, seconds));
    report.anew = anew;
    Ok(Sight {
        grey,
        picture,
        finding,
        report,
    })
}

fn text(path: &Path) -> Result<String, Failure> {
    let name = path.display();
    String::from_utf8(input::bytes(path)?).map_err(|e| Failure::input(format!("{name}: {e}")))
}

/// The number that a picture's name ends in.
fn numbered(path: &Path) -> Option<u32> {
    let stem = path.file_stem()?.to_str()?;
    let digits = stem.len() - stem.trim_end_matches(|c: char| c.is_ascii_digit()).len();
    stem[stem.len() - digits..].parse().ok()
}
