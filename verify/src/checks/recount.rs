//! Recounts the quantitative invisibility of pieces by ray casting on the tree.

use super::Finding;
use super::images::Images;
use super::window::Window;
use nalgebra::Point3;
use premio_csg::ray_casting::{Clearance, RayOracle, SightEvidence, SightSegment};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::Contours;
use premio_visibility::camera::projection::{Projection, ViewRay};
use premio_visibility::contours::{Contour, ContourKind, ContourPiece, ImageCurve};
use std::fmt;

/// The fractions of a piece's range at which samples are taken. The middle is avoided: there a
/// contour of a symmetric part may touch another face.
const SAMPLES: [f64; 3] = [0.21, 0.53, 0.83];

/// The distance of a sample from the ends of its piece, in multiples of the clearance.
const NEAR: f64 = 10.0;

/// The factor by which rays are moved closer where counts disagree.
const CLOSER: f64 = 1.0 / 16.0;

/// The least fraction of samples that must be counted, if only few are.
const COUNTED: f64 = 1.0 / 8.0;

/// The number of counted samples that suffices for any view. Views with fewer samples in all need
/// no minimum fraction.
const FEW: usize = 24;

/// A piece whose invisibility differs from the count by rays.
#[derive(Clone, Debug, PartialEq)]
pub struct WrongPiece {
    /// The contour.
    pub contour: u32,
    /// Its kind.
    pub kind: ContourKind,
    /// The index of the piece in the contour.
    pub piece: usize,
    /// The position of the sample.
    pub place: [f64; 3],
    /// The range of the piece.
    pub range: [f64; 2],
    /// The invisibility of the piece.
    pub given: u32,
    /// The count by rays.
    pub counted: u32,
}

/// The recount of a view's pieces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recount {
    /// The number of pieces.
    pub pieces: usize,
    /// The number of samples that agree.
    pub agreed: usize,
    /// The number of samples too close to something else to be counted.
    pub ambiguous: usize,
    /// The pieces that disagree with the rays.
    pub wrong: Vec<WrongPiece>,
}

impl Recount {
    /// Fails if a piece is wrong, and is undetermined if too few samples could be counted.
    pub fn finding(&self) -> Finding {
        match (self.wrong.is_empty(), self.suffices()) {
            (false, _) => Finding::Fails,
            (true, true) => Finding::Passes,
            (true, false) => Finding::Undetermined,
        }
    }

    /// Whether enough samples could be counted to judge the view.
    fn suffices(&self) -> bool {
        let samples = self.pieces * SAMPLES.len();
        let counted = samples.saturating_sub(self.ambiguous);
        // Seen along its axis a part may coincide with itself almost everywhere. Then many samples
        // are a small fraction, and still suffice.
        samples < FEW || counted >= FEW || counted as f64 >= COUNTED * samples as f64
    }

    /// Recounts every piece. If too few samples could be counted, the lines of sight are moved
    /// closer: in the image of a part that nearly coincides with itself, contours are close to one
    /// another everywhere.
    pub fn conclusive(
        material: &RayOracle,
        seen: &Contours,
        bounds: &Aabb,
        clearance: &Clearance,
    ) -> Self {
        let first = Self::new(material, seen, bounds, clearance);
        let is_conclusive = |recount: &Self| recount.suffices() || !recount.wrong.is_empty();
        if is_conclusive(&first) {
            return first;
        }
        let closer = closer(clearance).into_iter();
        let mut again = closer.map(|c| Self::new(material, seen, bounds, &c));
        again.find(is_conclusive).unwrap_or(first)
    }

    /// Recounts every piece.
    fn new(material: &RayOracle, seen: &Contours, bounds: &Aabb, clearance: &Clearance) -> Self {
        let projection = Projection::new(&seen.camera, clearance.size);
        let counter = Counter {
            material,
            seen,
            window: Window::around(&projection, bounds),
            projection,
            clearance,
            closer: closer(clearance),
        };
        let mut recount = Self::default();
        for contour in &seen.contours {
            for index in 0..contour.pieces.len() {
                recount.add(&counter, &SampledPiece::new(contour, index));
            }
        }
        recount
    }

    /// Recounts the samples of a piece. Of several that disagree the last one is reported.
    fn add(&mut self, counter: &Counter<'_>, piece: &SampledPiece<'_>) {
        self.pieces += 1;
        let mut wrong = None;
        for part in SAMPLES {
            match counter.verdict(piece, &piece.at(part)) {
                SampleVerdict::Agrees => self.agreed += 1,
                SampleVerdict::Ambiguous => self.ambiguous += 1,
                SampleVerdict::Wrong(found) => wrong = Some(found),
            }
        }
        self.wrong.extend(wrong);
    }
}

/// A piece of a contour, of which samples are counted.
struct SampledPiece<'a> {
    contour: &'a Contour,
    /// The index of the piece in the contour.
    index: usize,
    piece: &'a ContourPiece,
    /// Whether the contour is seen end-on, as a point.
    end_on: bool,
    /// The points at both ends.
    ends: [Point3<f64>; 2],
}

impl<'a> SampledPiece<'a> {
    fn new(contour: &'a Contour, index: usize) -> Self {
        let piece = &contour.pieces[index];
        Self {
            contour,
            index,
            piece,
            end_on: matches!(contour.image_curve, ImageCurve::Point { .. }),
            ends: piece.range.map(|t| contour.space_curve.point(t)),
        }
    }

    /// The point at a fraction of the range.
    fn at(&self, part: f64) -> Point3<f64> {
        let [lo, hi] = self.piece.range;
        self.contour.space_curve.point(lo + part * (hi - lo))
    }

    /// Whether the piece ends at a junction.
    fn is_open(&self) -> bool {
        self.piece.start.is_some() || self.piece.end.is_some()
    }
}

/// What the rays close to a sample determine.
enum SampleVerdict {
    /// The count is the invisibility of the piece.
    Agrees,
    /// Something else is too close.
    Ambiguous,
    /// The count differs from the invisibility.
    Wrong(WrongPiece),
}

/// The faces in front of a sample.
struct SampleCount {
    counted: u32,
    /// Whether the sample lies on a fold of a contour that is no limb.
    folds: bool,
}

/// Counts the faces in front of samples.
struct Counter<'a> {
    material: &'a RayOracle,
    seen: &'a Contours,
    window: Window,
    projection: Projection,
    clearance: &'a Clearance,
    /// Smaller and smaller clearances.
    closer: Vec<Clearance>,
}

impl Counter<'_> {
    /// Compares a sample with the invisibility of its piece.
    fn verdict(&self, sampled: &SampledPiece<'_>, place: &Point3<f64>) -> SampleVerdict {
        let SampledPiece { contour, piece, .. } = *sampled;
        let Some(SampleCount { counted, folds }) = self.count(sampled, place) else {
            return SampleVerdict::Ambiguous;
        };
        let given = piece.quantitative_invisibility;
        if counted == given && piece.visible == (counted == 0) {
            return SampleVerdict::Agrees;
        }
        let is_on_fold = folds && given == counted + 1 && !piece.visible;
        // The count may depend on the distance of the rays.
        let is_behind_other = || given == counted + 1 && self.is_behind_contour(sampled, place);
        if is_on_fold || !self.is_stable(place, counted) || is_behind_other() {
            return SampleVerdict::Ambiguous;
        }
        SampleVerdict::Wrong(WrongPiece {
            range: piece.range,
            contour: contour.id,
            kind: contour.kind,
            piece: sampled.index,
            place: (*place).into(),
            given,
            counted,
        })
    }

    /// The faces in front of a sample; `None` if something else is too close.
    fn count(&self, sampled: &SampledPiece<'_>, place: &Point3<f64>) -> Option<SampleCount> {
        // Seen end-on, a contour has no two sides. All neighbouring rays may miss something that
        // covers a narrow angle around it.
        if sampled.end_on || (sampled.is_open() && self.is_near_end(sampled, place)) {
            return None;
        }
        match self.invisibility(place, self.clearance) {
            SightEvidence::Count(counted) => Some(SampleCount {
                counted,
                folds: false,
            }),
            // A limb is on its own fold.
            SightEvidence::Fold(counted) => Some(SampleCount {
                counted,
                folds: sampled.contour.kind != ContourKind::Limb,
            }),
            SightEvidence::Thin | SightEvidence::Mixed | SightEvidence::Close => None,
        }
    }

    /// Whether a sample is close to an end of its piece in the image. Another contour is close
    /// there.
    fn is_near_end(&self, sampled: &SampledPiece<'_>, place: &Point3<f64>) -> bool {
        let towards = line_of_sight(&self.projection, place).towards;
        let lateral = sampled.ends.map(|end| (end - place).cross(&towards).norm());
        lateral
            .iter()
            .any(|lateral| *lateral < NEAR * self.clearance.lateral)
    }

    /// Whether another contour in front of a limb sample has the same image, within the distance up
    /// to which slivers are ignored. A ray then hits both faces or neither, or the two contours
    /// cross there.
    fn is_behind_contour(&self, sampled: &SampledPiece<'_>, place: &Point3<f64>) -> bool {
        if sampled.contour.kind != ContourKind::Limb {
            return false;
        }
        let here = self.window.image(place);
        let near = self.clearance.sliver / self.window.scale(here.depth);
        let finest = self.closer.last().unwrap_or(self.clearance).lateral;
        Images::new(self.seen, &self.window).any(here.at, near, |passing| {
            passing.contour != sampled.contour.id && passing.depth[0] < here.depth - finest
        })
    }

    /// Whether all lines of sight give the same count, however close they are.
    fn is_stable(&self, place: &Point3<f64>, counted: u32) -> bool {
        self.closer
            .iter()
            .all(|clearance| match self.invisibility(place, clearance) {
                SightEvidence::Count(again) | SightEvidence::Fold(again) => again == counted,
                SightEvidence::Thin => true,
                SightEvidence::Mixed | SightEvidence::Close => false,
            })
    }

    fn invisibility(&self, place: &Point3<f64>, clearance: &Clearance) -> SightEvidence {
        let sight = |p: &_| line_of_sight(&self.projection, p);
        self.material.invisibility(place, sight, clearance)
    }
}

/// Smaller and smaller clearances, down to half-way between the resolution and rounding.
fn closer(clearance: &Clearance) -> Vec<Clearance> {
    let finest = (clearance.sliver * CLOSER * CLOSER * clearance.size * ROUNDING).sqrt();
    let all = (1..).map(|k| clearance.closer(CLOSER.powi(k)));
    all.take_while(|c| c.lateral >= finest).collect()
}

/// The line from a point to the eye or the near plane.
fn line_of_sight(projection: &Projection, p: &Point3<f64>) -> SightSegment {
    let eye = projection.towards_eye(p);
    let depth = projection.depth(p);
    let seen = depth - projection.near;
    let length = match projection.sight {
        ViewRay::Eye(_) => eye.distance * (seen / depth),
        ViewRay::Direction(_) => seen,
    };
    SightSegment {
        towards: eye.direction,
        length,
    }
}

/// The number of wrong pieces that are reported individually.
const NAMED: usize = 5;

impl fmt::Display for Recount {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            pieces,
            agreed,
            ambiguous,
            wrong,
        } = self;
        write!(
            f,
            "{pieces} pieces, {agreed} samples agree, {ambiguous} too close to another contour"
        )?;
        if !self.suffices() {
            f.write_str(", too few to decide")?;
        }
        if !wrong.is_empty() {
            write!(f, ", {} pieces wrong", wrong.len())?;
        }
        for w in wrong.iter().take(NAMED) {
            let [x, y, z] = w.place;
            write!(
                f,
                "; contour {} ({:?}) piece {} over {:?}: {} for {} at ({x:.6}, {y:.6}, {z:.6})",
                w.contour, w.kind, w.piece, w.range, w.given, w.counted
            )?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn too_few_samples_are_no_proof() {
        let of = |pieces: usize, ambiguous: usize| Recount {
            pieces,
            agreed: 3 * pieces - ambiguous,
            ambiguous,
            wrong: Vec::new(),
        };
        for conclusive in [Recount::default(), of(7, 21), of(40, 80), of(216, 588)] {
            assert_eq!(conclusive.finding(), Finding::Passes, "{conclusive}");
        }
        for inconclusive in [of(40, 120), of(40, 106)] {
            assert_eq!(
                inconclusive.finding(),
                Finding::Undetermined,
                "{inconclusive}"
            );
        }
        assert!(of(40, 120).to_string().ends_with("too few to decide"));
    }
}
