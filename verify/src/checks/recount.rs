//! Recounts the quantitative invisibility of pieces by ray casting on the tree.

use super::Finding;
use nalgebra::{Point3, Vector3};
use premio_csg::ray_casting::{Clearance, RayOracle, SightEvidence};
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::Contours;
use premio_visibility::camera::projection::{Projection, ViewRay};
use premio_visibility::contours::{ContourKind, ImageCurve};
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
    pub fn telling(material: &RayOracle, seen: &Contours, clearance: &Clearance) -> Self {
        let first = Self::new(material, seen, clearance);
        let is_conclusive = |recount: &Self| recount.suffices() || !recount.wrong.is_empty();
        if is_conclusive(&first) {
            return first;
        }
        let closer = closer(clearance).into_iter();
        let mut again = closer.map(|c| Self::new(material, seen, &c));
        again.find(is_conclusive).unwrap_or(first)
    }

    /// Recounts every piece.
    fn new(material: &RayOracle, seen: &Contours, clearance: &Clearance) -> Self {
        let projection = Projection::new(&seen.camera, clearance.size);
        let sight = |p: &_| line_of_sight(&projection, p);
        let closer = closer(clearance);
        // All lines of sight must give the same count, however close they are.
        let holds = |p: &_, counted: u32| {
            closer
                .iter()
                .all(|c| match material.invisibility(p, sight, c) {
                    SightEvidence::Count(again) | SightEvidence::Fold(again) => again == counted,
                    SightEvidence::Thin => true,
                    SightEvidence::Mixed | SightEvidence::Close => false,
                })
        };
        let mut recount = Self::default();
        for contour in &seen.contours {
            let end_on = matches!(contour.image_curve, ImageCurve::Point { .. });
            for (index, piece) in contour.pieces.iter().enumerate() {
                recount.pieces += 1;
                let [lo, hi] = piece.range;
                let ends = [lo, hi].map(|t| contour.space_curve.point(t));
                let open = piece.start.is_some() || piece.end.is_some();
                let mut wrong = None;
                for part in SAMPLES {
                    let place = contour.space_curve.point(lo + part * (hi - lo));
                    // Where a piece ends in the image, another contour is close.
                    let (towards, _) = sight(&place);
                    let lateral = ends.map(|e| (e - place).cross(&towards).norm());
                    let short = lateral.map(|lateral| lateral < NEAR * clearance.lateral);
                    let unclear = end_on || (open && short.contains(&true));
                    let counted = material.invisibility(&place, sight, clearance);
                    let (counted, folds) = match counted {
                        SightEvidence::Count(counted) if !unclear => (counted, false),
                        // A limb is on its own fold.
                        SightEvidence::Fold(counted) if !unclear => {
                            (counted, contour.kind != ContourKind::Limb)
                        }
                        _ => {
                            recount.ambiguous += 1;
                            continue;
                        }
                    };
                    match counted {
                        // Seen end-on, it has no two sides. All neighbouring rays may miss
                        // something that covers a narrow angle around it.
                        _ if end_on && counted != piece.quantitative_invisibility => {
                            recount.ambiguous += 1
                        }
                        _ if counted == piece.quantitative_invisibility
                            && piece.visible == (counted == 0) =>
                        {
                            recount.agreed += 1;
                        }
                        _ if folds
                            && piece.quantitative_invisibility == counted + 1
                            && !piece.visible =>
                        {
                            recount.ambiguous += 1;
                        }
                        // The count depends on the distance of the rays.
                        _ if !holds(&place, counted) => recount.ambiguous += 1,
                        _ => {
                            wrong = Some(WrongPiece {
                                range: piece.range,
                                contour: contour.id,
                                kind: contour.kind,
                                piece: index,
                                place: place.into(),
                                given: piece.quantitative_invisibility,
                                counted,
                            });
                        }
                    }
                }
                recount.wrong.extend(wrong);
            }
        }
        recount
    }
}

/// Smaller and smaller clearances, down to half-way between the resolution and rounding.
fn closer(clearance: &Clearance) -> Vec<Clearance> {
    let finest = (clearance.sliver * CLOSER * CLOSER * clearance.size * ROUNDING).sqrt();
    let all = (1..).map(|k| clearance.closer(CLOSER.powi(k)));
    all.take_while(|c| c.lateral >= finest).collect()
}

/// The direction from a point to the eye, and the distance to the eye or the near plane.
fn line_of_sight(projection: &Projection, p: &Point3<f64>) -> (Vector3<f64>, f64) {
    let eye = projection.towards_eye(p);
    let depth = projection.depth(p);
    let seen = depth - projection.near;
    let reach = match projection.sight {
        ViewRay::Eye(_) => eye.distance * (seen / depth),
        ViewRay::Direction(_) => seen,
    };
    (eye.direction, reach)
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
