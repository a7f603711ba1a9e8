//! The self-checks across crates: the boundary and the contours are compared with the tree by ray
//! casting.

#[cfg(test)]
mod fixture;
mod images;
mod mesh;
mod outlines;
mod piece_ends;
mod recount;
mod shadow;
mod sheets;
pub(crate) mod step;
mod strokes;
pub mod views;
mod window;

pub(crate) use outlines::Outlines;
use piece_ends::displaced_ends;
pub(crate) use recount::Recount;
pub(crate) use shadow::ShadowOutline;
pub(crate) use sheets::SheetReport;

use premio_csg::evaluate::Evaluation;
use premio_csg::ray_casting::{Clearance, Estimate, RayOracle};
use premio_csg::tree::Tree;
use premio_drawing::Drawing;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::camera::projection::Projection;
use premio_visibility::{Contours, ViewCamera, contours};
use std::fmt;

/// The allowed deviation of a measured volume, in standard errors.
pub(crate) const DEVIATIONS: f64 = 5.0;

/// The factor by which more rays are cast if the first ones disagree.
const AGAIN: usize = 16;

/// The number of rays that look for material outside the box.
const AROUND: usize = 2000;

/// The subject of a check.
#[derive(Clone, Debug, PartialEq)]
pub enum CheckSubject {
    /// The rules of the boundary representation.
    Topology,
    /// The volume of the boundary against the tree's by rays.
    Volume,
    /// The bounding box of the boundary against the points where rays hit the tree.
    Bounds,
    /// The quantitative invisibility of every piece of a view against rays on the tree.
    View(String),
    /// The contours of a view against the changes between neighbouring lines of sight.
    Contours(String),
    /// The boundary of the part's shadow in a view against the visible strokes of its drawing.
    Outline(String),
    /// The sheet of a view, written and read back, against its contours.
    Sheet(String),
    /// The STEP file of the boundary, read back.
    Step,
    /// The files of its mesh, read back.
    Mesh,
}

/// The result of a check.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Finding {
    /// The check passed.
    Passes,
    /// The check failed.
    Fails,
    /// Too little could be examined for a decision, and nothing of that is wrong.
    Undetermined,
}

/// The outcome of one check.
#[derive(Clone, Debug, PartialEq)]
pub struct Check {
    /// The subject.
    pub subject: CheckSubject,
    /// The result.
    pub finding: Finding,
    /// The measured values, or what is wrong.
    pub detail: String,
}

/// The outcome of all checks.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CheckReport {
    /// The checks, in the order in which they were made.
    pub checks: Vec<Check>,
}

/// The checks to be made of a view.
#[derive(Clone, Copy, Debug)]
pub struct ViewChecks {
    /// Whether the pieces of its contours are recounted and missing contours are searched for.
    pub contours: bool,
    /// Whether its outline is followed and its sheet is read back.
    pub drawing: bool,
}

impl ViewChecks {
    /// All checks.
    pub const ALL: Self = Self {
        contours: true,
        drawing: true,
    };
    /// The checks of contours only.
    pub(crate) const CONTOURS: Self = Self {
        contours: true,
        drawing: false,
    };
}

/// A part to be checked.
#[derive(Debug)]
pub struct Checker<'a> {
    material: RayOracle,
    evaluation: &'a Evaluation,
    /// The bounding box of the boundary.
    bounds: Aabb,
}

impl CheckReport {
    /// Whether every check passes.
    pub fn passes(&self) -> bool {
        self.checks.iter().all(Check::passes)
    }

    /// The checks with a given result.
    pub fn checks_with(&self, finding: Finding) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(move |c| c.finding == finding)
    }

    /// The checks that do not pass: those that fail and those that are undetermined.
    pub fn failures(&self) -> impl Iterator<Item = &Check> {
        self.checks.iter().filter(|c| !c.passes())
    }
}

impl Check {
    /// Whether the result is that the check passed.
    pub fn passes(&self) -> bool {
        self.finding == Finding::Passes
    }
}

impl Finding {
    /// The result of a check that always decides.
    fn new(passes: bool) -> Self {
        match passes {
            true => Self::Passes,
            false => Self::Fails,
        }
    }
}

impl<'a> Checker<'a> {
    /// Prepares the checks of a tree and its boundary.
    pub fn new(tree: &Tree, evaluation: &'a Evaluation) -> Self {
        Self {
            material: RayOracle::new(tree),
            evaluation,
            bounds: evaluation.tight_bounds(),
        }
    }

    /// All checks: the boundary's rules, the volume by `rays` rays, the files, and the views.
    pub fn all(&self, rays: usize) -> CheckReport {
        let mut report = self.solid(rays);
        report.checks.extend([self.step(), self.mesh()]);
        for view in views::around(&self.evaluation.bounds) {
            let checks = self.view_with(&view.name, &view.camera, ViewChecks::ALL);
            report.checks.extend(checks);
        }
        report
    }

    /// The checks of the solid alone.
    pub fn solid(&self, rays: usize) -> CheckReport {
        CheckReport {
            checks: vec![self.topology(), self.volume(rays), self.bounds()],
        }
    }

    fn topology(&self) -> Check {
        let violations = self.evaluation.violations();
        let texts: Vec<String> = violations.iter().map(ToString::to_string).collect();
        Check {
            subject: CheckSubject::Topology,
            finding: Finding::new(texts.is_empty()),
            detail: if texts.is_empty() {
                "no violation".to_owned()
            } else {
                texts.join("; ")
            },
        }
    }

    fn volume(&self, rays: usize) -> Check {
        let volume = self.evaluation.mass().volume;
        let mut estimate = self.material.volume(rays, 1);
        let mut off = self.deviation(&estimate, volume);
        // Chance alone sometimes exceeds the bound or misses a small part, so new rays decide.
        if off > DEVIATIONS {
            let more = rays.saturating_mul(AGAIN);
            estimate = self.material.volume_about(&self.bounds, more, 2);
            off = self.deviation(&estimate, volume);
        }
        let Estimate {
            value,
            standard_error,
        } = estimate;
        Check {
            subject: CheckSubject::Volume,
            finding: Finding::new(off <= DEVIATIONS),
            detail: format!(
                "{volume} of the boundary, {value} ± {standard_error:.1e} by rays: {off:.1} standard errors"
            ),
        }
    }

    fn bounds(&self) -> Check {
        let slack = self.clearance().sliver;
        let (given, hit) = (&self.bounds, self.material.extent(AROUND, slack));
        let beyond = |i: usize| (given.min[i] - hit.min[i]).max(hit.max[i] - given.max[i]);
        // If no ray hits anything the box is empty, and the differences are NaN or negative.
        let off = (0..3).map(beyond).fold(f64::NEG_INFINITY, f64::max);
        Check {
            subject: CheckSubject::Bounds,
            finding: Finding::new(off <= slack || hit == Aabb::EMPTY),
            detail: if off <= slack || hit == Aabb::EMPTY {
                format!("{AROUND} rays meet nothing outside the box")
            } else {
                format!("rays meet material {off:e} outside the box")
            },
        }
    }

    fn deviation(&self, estimate: &Estimate, volume: f64) -> f64 {
        let size = self.evaluation.bounds.diagonal();
        // A shell of the resolution's thickness over the entire surface is not a difference.
        let surface = size * size * 6.0;
        let rounding = surface * (self.evaluation.resolution + ROUNDING * size);
        estimate.deviation(volume, if rounding.is_finite() { rounding } else { 0.0 })
    }

    /// Counts the faces in front of every piece that a camera sees, and looks for missing contours.
    pub fn view(&self, name: &str, camera: &ViewCamera) -> Vec<Check> {
        self.view_with(name, camera, ViewChecks::CONTOURS)
    }

    /// The checks of a view that are requested.
    pub fn view_with(&self, name: &str, camera: &ViewCamera, checks: ViewChecks) -> Vec<Check> {
        let failed = |finding, detail| {
            let subject = CheckSubject::View(name.to_owned());
            vec![Check {
                subject,
                finding,
                detail,
            }]
        };
        if let Some(limit) = self.evaluation.view_limit() {
            return failed(Finding::Passes, format!("refused: {limit}"));
        }
        let known = self.evaluation.view_resolution();
        let resolution = known.unwrap_or_else(|| self.evaluation.rounded_view_resolution());
        let seen = match contours(&self.evaluation.brep, camera, resolution) {
            Ok(seen) => seen,
            Err(error) => return failed(Finding::Fails, error.to_string()),
        };
        if known.is_none() && self.contradiction(&seen).is_some() {
            let refused = "refused: surfaces are closer to each other than f64 resolves";
            return failed(Finding::Passes, refused.to_owned());
        }
        let mut made = Vec::new();
        if checks.contours {
            made.extend(self.contours(name, &seen));
        }
        if checks.drawing {
            made.extend(self.drawing(name, &seen));
        }
        made
    }

    /// The pieces of a view that rays contradict, and the contours that it lacks; `None` if there
    /// are none.
    pub fn contradiction(&self, seen: &Contours) -> Option<String> {
        let checks = self.contours("", seen).into_iter();
        checks
            .filter(|check| check.finding == Finding::Fails)
            .map(|check| check.detail)
            .next()
    }

    /// Counts the faces in front of every piece, and looks for missing contours.
    fn contours(&self, name: &str, seen: &Contours) -> [Check; 2] {
        let clearance = self.clearance();
        let counted =
            Recount::conclusive(&self.material, seen, &self.evaluation.bounds, &clearance);
        let outlines = Outlines::new(&self.material, seen, &clearance);
        let (finding, detail) = match displaced_ends(seen, &clearance).first() {
            Some(displaced) => (Finding::Fails, displaced.to_string()),
            None => (counted.finding(), counted.to_string()),
        };
        [
            Check {
                subject: CheckSubject::View(name.to_owned()),
                finding,
                detail,
            },
            Check {
                subject: CheckSubject::Contours(name.to_owned()),
                finding: Finding::new(outlines.missing.is_empty()),
                detail: outlines.to_string(),
            },
        ]
    }

    /// Draws the contours, follows the boundary of the shadow, and reads the sheet back.
    fn drawing(&self, name: &str, seen: &Contours) -> [Check; 2] {
        let clearance = self.clearance();
        let projection = Projection::new(&seen.camera, clearance.size);
        let drawing = Drawing::new(seen, &premio_drawing::DrawingOptions::default());
        let size = (drawing.extent[1] - drawing.extent[0]).norm();
        let centre = self.evaluation.bounds.centre();
        let near = projection.magnification(&centre) * clearance.shift.max(clearance.sliver);
        let tolerance = shadow::Tolerance {
            image: near + drawing.tolerance + 2.0 * drawing.distance,
            sliver: clearance.sliver,
        };
        let outline = ShadowOutline::new(&self.material, &projection, &drawing, tolerance);
        let sheet = SheetReport::new(seen, &self.evaluation.bounds, size);
        [
            Check {
                subject: CheckSubject::Outline(name.to_owned()),
                finding: outline.finding(),
                detail: outline.to_string(),
            },
            Check {
                subject: CheckSubject::Sheet(name.to_owned()),
                finding: Finding::new(sheet.faults.is_empty()),
                detail: sheet.to_string(),
            },
        ]
    }

    fn clearance(&self) -> Clearance {
        let size = self.evaluation.bounds.diagonal();
        let known = self.evaluation;
        // Rays are f64, however finely the boundary was evaluated.
        let resolution = known.f64_resolution();
        Clearance {
            sliver: 100.0 * resolution,
            // Between the resolution and the size, closer to the former.
            lateral: (size * ROUNDING.sqrt()).max(1000.0 * resolution),
            // The distance over which a surface of half the size as radius rises by the coincidence
            // distance.
            shift: (size * known.greatest_coincidence()).sqrt(),
            size,
        }
    }
}

impl fmt::Display for CheckSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Topology => f.write_str("topology"),
            Self::Volume => f.write_str("volume"),
            Self::Bounds => f.write_str("bounds"),
            Self::View(name) => write!(f, "view {name}"),
            Self::Contours(name) => write!(f, "contours in {name}"),
            Self::Outline(name) => write!(f, "outline in {name}"),
            Self::Sheet(name) => write!(f, "sheet of {name}"),
            Self::Step => f.write_str("step"),
            Self::Mesh => f.write_str("mesh"),
        }
    }
}

impl fmt::Display for Check {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let outcome = match self.finding {
            Finding::Passes => "ok",
            Finding::Fails => "FAILED",
            Finding::Undetermined => "UNTOLD",
        };
        write!(f, "{outcome:<6} {}: {}", self.subject, self.detail)
    }
}

impl fmt::Display for CheckReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for check in &self.checks {
            writeln!(f, "{check}")?;
        }
        let all = self.checks.len();
        let [failed, undetermined] =
            [Finding::Fails, Finding::Undetermined].map(|k| self.checks_with(k).count());
        match (failed, undetermined) {
            (0, 0) => writeln!(f, "all {all} checks hold"),
            (_, 0) => writeln!(f, "{failed} of {all} checks failed"),
            _ => writeln!(
                f,
                "{failed} of {all} checks failed, {undetermined} are undetermined"
            ),
        }
    }
}
