//! Comparison of another kernel with this one on random and realistic parts.

use crate::progress::Progress;
use crate::{Expression, Result};
use premio_csg::reader::Format;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::shrink::shrink;
use premio_verify::generator::write::{self, write};
use premio_verify::trial::{TrialConfig, TrialMeasures, Verdict, guarded};
use std::fmt;
use std::ops::Range;

pub use premio_verify::generator::profile::Profile;

/// The part of a profile and a seed. It is the same part on every machine.
///
/// # Errors
/// The part is beyond a limit of the reader.
///
/// # Examples
///
/// ```
/// use premio::fuzz::{Profile, random_part};
///
/// let part = random_part(Profile::Parts, 3)?;
/// assert_eq!(part.tree()?, random_part(Profile::Parts, 3)?.tree()?);
/// # Ok::<(), premio::Error>(())
/// ```
pub fn random_part(profile: Profile, seed: u64) -> Result<Expression> {
    expression(&profile.model(seed))
}

fn expression(model: &PartModel) -> Result<Expression> {
    let format = write::format(model, Format::Json);
    crate::read_text(&write(model, format), format)
}

/// The measures of a part by another kernel.
///
/// # Examples
///
/// ```
/// use premio::fuzz::KernelMeasures;
///
/// let cube = KernelMeasures::from_volume(8.0);
/// assert_eq!(cube.area, None);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelMeasures {
    /// The volume, in cubic units.
    pub volume: f64,
    /// The area, in square units, where the kernel has it.
    pub area: Option<f64>,
}

impl KernelMeasures {
    /// The volume alone.
    ///
    /// # Examples
    ///
    /// ```
    /// assert_eq!(premio::fuzz::KernelMeasures::from_volume(8.0).volume, 8.0);
    /// ```
    pub fn from_volume(volume: f64) -> Self {
        Self { volume, area: None }
    }
}

/// The options of a comparison with another kernel.
///
/// # Examples
///
/// ```
/// use premio::fuzz::{KernelTrial, Profile};
///
/// let trial = KernelTrial { tolerance: 1e-3, ..KernelTrial::new(Profile::Grid) };
/// assert_eq!(trial.profile.name(), "grid");
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KernelTrial {
    /// The kind of parts.
    pub profile: Profile,
    /// The tolerance: the relative difference of volumes and areas that is accepted.
    pub tolerance: f64,
    /// The most smaller parts that are tried to shrink one that fails.
    pub tries: usize,
}

impl KernelTrial {
    /// Volumes and areas to a millionth.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::fuzz::{KernelTrial, Profile};
    ///
    /// assert_eq!(KernelTrial::new(Profile::Parts).tolerance, 1e-6);
    /// ```
    pub fn new(profile: Profile) -> Self {
        Self {
            profile,
            tolerance: 1.0 / 1_000_000.0,
            tries: 200,
        }
    }

    /// Runs a kernel on the parts of a range of seeds. A step of the progress is a part.
    ///
    /// A part counts only where the result of this kernel passes its own checks: the rules of the
    /// boundary, the volume by rays and the sums of volumes. A part on which the kernel differs is
    /// shrunk as long as it differs.
    ///
    /// # Errors
    /// The work was cancelled.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::fuzz::{KernelMeasures, KernelTrial, Profile};
    /// use premio::prelude::*;
    ///
    /// // A kernel that takes boxes for parts.
    /// let boxes = |part: &Expression| {
    ///     let bounds = part.evaluate().map_err(|error| error.to_string())?.bounds();
    ///     let sides = (0..3).map(|i| bounds.max[i] - bounds.min[i]);
    ///     Ok(KernelMeasures::from_volume(sides.product()))
    /// };
    /// let report = KernelTrial::new(Profile::Grid).run(0..6, boxes, &Progress::new())?;
    /// assert!(!report.failures.is_empty());
    /// assert_eq!(report.failures.len() + report.agreed + report.skipped, 6);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn run(
        &self,
        seeds: Range<u64>,
        mut kernel: impl FnMut(&Expression) -> Result<KernelMeasures, String>,
        progress: &Progress<'_>,
    ) -> Result<KernelReport> {
        let counter = progress.counter(seeds.end.saturating_sub(seeds.start));
        let mut report = KernelReport::default();
        for seed in seeds {
            progress.check()?;
            let model = self.profile.model(seed);
            match self.judge(&model, &mut kernel) {
                Judgement::Unknown => report.skipped += 1,
                Judgement::Agrees => report.agreed += 1,
                Judgement::Differs(_) => {
                    let differs = |model: &PartModel| {
                        matches!(self.judge(model, &mut kernel), Judgement::Differs(_))
                    };
                    let smallest = shrink(&model, self.tries, differs);
                    if let Judgement::Differs(difference) = self.judge(&smallest, &mut kernel) {
                        let part = expression(&smallest)?;
                        let failure = KernelFailure {
                            seed,
                            part,
                            difference,
                        };
                        report.failures.push(failure);
                    }
                }
            }
            counter.add(1);
        }
        Ok(report)
    }

    fn judge(
        &self,
        model: &PartModel,
        kernel: &mut impl FnMut(&Expression) -> Result<KernelMeasures, String>,
    ) -> Judgement {
        let config = TrialConfig {
            rays: RAYS,
            ..TrialConfig::default()
        };
        let (Verdict::Right(expected), Ok(part)) =
            (guarded(model, &config).verdict, expression(model))
        else {
            return Judgement::Unknown;
        };
        let found = kernel(&part);
        match &found {
            Ok(found) if self.agree(&expected, found) => Judgement::Agrees,
            _ => Judgement::Differs(KernelDifference { expected, found }),
        }
    }

    fn agree(&self, expected: &TrialMeasures, found: &KernelMeasures) -> bool {
        let is_near = |a: f64, b: f64| (a - b).abs() <= self.tolerance * a.abs().max(b.abs());
        let areas = found.area.is_none_or(|area| is_near(expected.area, area));
        is_near(expected.volume, found.volume) && areas
    }
}

/// The number of rays that measure the volume of a part.
const RAYS: u32 = 500;

enum Judgement {
    Unknown,
    Agrees,
    Differs(KernelDifference),
}

/// A difference between the kernels.
///
/// # Examples
///
/// ```
/// use premio::fuzz::{KernelTrial, Profile};
/// use premio::{Expression, Progress};
///
/// let refuses = |_: &Expression| Err("not implemented".to_owned());
/// let trial = KernelTrial { tries: 5, ..KernelTrial::new(Profile::Grid) };
/// let report = trial.run(0..3, refuses, &Progress::new())?;
/// assert!(report.failures.iter().all(|failure| failure.difference.found.is_err()));
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct KernelDifference {
    /// The measures of this kernel.
    pub expected: TrialMeasures,
    /// The measures of the other kernel, or why it has none.
    pub found: Result<KernelMeasures, String>,
}

/// A part on which a kernel differs, shrunk as far as it still differs.
///
/// # Examples
///
/// ```
/// use premio::fuzz::{KernelTrial, Profile};
/// use premio::{Expression, Progress};
///
/// let refuses = |_: &Expression| Err("not implemented".to_owned());
/// let report = KernelTrial::new(Profile::Grid).run(0..2, refuses, &Progress::new())?;
/// for failure in &report.failures {
///     assert_eq!(failure.part.tree()?.leaves().count(), 1);
///     assert!(failure.to_string().contains("not implemented"));
/// }
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Debug)]
pub struct KernelFailure {
    /// The seed of the part that it was made from.
    pub seed: u64,
    /// The part.
    pub part: Expression,
    /// The difference.
    pub difference: KernelDifference,
}

/// One line with the measures.
impl fmt::Display for KernelFailure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (seed, expected) = (self.seed, self.difference.expected.volume);
        match &self.difference.found {
            Ok(found) => write!(
                f,
                "seed {seed}: volume {}, expected {expected}",
                found.volume
            ),
            Err(error) => write!(f, "seed {seed}: {error}, expected a volume of {expected}"),
        }
    }
}

/// The result of a comparison.
///
/// # Examples
///
/// ```
/// assert!(premio::fuzz::KernelReport::default().failures.is_empty());
/// ```
#[derive(Clone, Debug, Default)]
pub struct KernelReport {
    /// The number of parts on which the kernel agrees.
    pub agreed: usize,
    /// The number of parts that are not counted: beyond a limit, or failing this kernel's own
    /// checks.
    pub skipped: usize,
    /// The parts on which it differs.
    pub failures: Vec<KernelFailure>,
}
