//! The quantitative invisibility of pieces, counted again by rays on the tree.

use super::Finding;
use nalgebra::{Point3, Vector3};
use premio_csg::ray_casting::{Clearance, RayOracle, SightEvidence};
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::Contours;
use premio_visibility::camera::projection::{Projection, ViewRay};
use premio_visibility::contours::{ContourKind, ImageCurve};
use std::fmt;

/// Where in a piece samples are taken, as parts of its range: not in the middle, where a contour of
/// a symmetric part may touch another face.
const SAMPLES: [f64; 3] = [0.21, 0.53, 0.83];

/// How many times the clearance a sample is away from the ends of its piece.
const NEAR: f64 = 10.0;

/// What disagrees is looked at again with rays that run closer and closer by this.
const CLOSER: f64 = 1.0 / 16.0;

/// The least share of samples that must be counted, where not many are.
const COUNTED: f64 = 1.0 / 8.0;

/// So many counted samples tell something of any view; of fewer in all no share is asked.
const FEW: usize = 24;

/// A piece whose invisibility is not what rays say.
#[derive(Clone, Debug, PartialEq)]
pub struct WrongPiece {
    /// The contour.
    pub contour: u32,
    /// What kind it is of.
    pub kind: ContourKind,
    /// The place of the piece in the contour.
    pub piece: usize,
    /// The sample.
    pub place: [f64; 3],
    /// The range of the piece.
    pub t: [f64; 2],
    /// What the piece says.
    pub given: u32,
    /// What the rays say.
    pub counted: u32,
}

/// The pieces of a view, counted again.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recount {
    /// How many pieces there are.
    pub pieces: usize,
    /// How many samples agree.
    pub agreed: usize,
    /// How many samples lie too close to something else to be counted.
    pub ambiguous: usize,
    /// The pieces that say something else than the rays.
    pub wrong: Vec<WrongPiece>,
}

impl Recount {
    /// Whether none is wrong, of enough samples that could be counted.
    pub fn finding(&self) -> Finding {
        match (self.wrong.is_empty(), self.suffices()) {
            (false, _) => Finding::Fails,
            (true, true) => Finding::Passes,
            (true, false) => Finding::Undetermined,
        }
    }

    /// Whether the samples that could be counted say something about the view.
    fn suffices(&self) -> bool {
        let samples = self.pieces * SAMPLES.len();
        let counted = samples.saturating_sub(self.ambiguous);
        // Along its axis a part may fall on itself almost everywhere; then many samples are few of
        // them, and still tell.
        samples < FEW || counted >= FEW || counted as f64 >= COUNTED * samples as f64
    }

    /// Counts every piece again, by lines of sight that run closer where too few tell something: in
    /// the image of a part that nearly falls on itself contours lie next to one another everywhere.
    pub fn telling(material: &RayOracle, seen: &Contours, clearance: &Clearance) -> Self {
        let first = Self::new(material, seen, clearance);
        let tells = |recount: &Self| recount.suffices() || !recount.wrong.is_empty();
        if tells(&first) {
            return first;
        }
        let closer = closer(clearance).into_iter();
        let mut again = closer.map(|c| Self::new(material, seen, &c));
        again.find(tells).unwrap_or(first)
    }

    /// Counts every piece again.
    fn new(material: &RayOracle, seen: &Contours, clearance: &Clearance) -> Self {
        let projection = Projection::new(&seen.camera, clearance.size);
        let sight = |p: &_| line_of_sight(&projection, p);
        let closer = closer(clearance);
        // No line of sight may tell anything else, however close it runs.
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
            let end_on = matches!(contour.curve2, ImageCurve::Point { .. });
            for (index, piece) in contour.pieces.iter().enumerate() {
                recount.pieces += 1;
                let [lo, hi] = piece.t;
                let ends = [lo, hi].map(|t| contour.curve3.point(t));
                let open = piece.start.is_some() || piece.end.is_some();
                let mut wrong = None;
                for part in SAMPLES {
                    let place = contour.curve3.point(lo + part * (hi - lo));
                    // Where a piece ends in the image, another contour is near.
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
                        // Seen end-on it has no two sides; the rays next to it may all miss what
                        // covers a narrow angle of its surroundings.
                        _ if end_on && counted != piece.qi => recount.ambiguous += 1,
                        _ if counted == piece.qi && piece.visible == (counted == 0) => {
                            recount.agreed += 1;
                        }
                        _ if folds && piece.qi == counted + 1 && !piece.visible => {
                            recount.ambiguous += 1;
                        }
                        // Depends on how far next to the rays run.
                        _ if !holds(&place, counted) => recount.ambiguous += 1,
                        _ => {
                            wrong = Some(WrongPiece {
                                t: piece.t,
                                contour: contour.id,
                                kind: contour.kind,
                                piece: index,
                                place: place.into(),
                                given: piece.qi,
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

/// Closer and closer clearances, down to half-way between the resolution and rounding.
fn closer(clearance: &Clearance) -> Vec<Clearance> {
    let finest = (clearance.sliver * CLOSER * CLOSER * clearance.size * ROUNDING).sqrt();
    let all = (1..).map(|k| clearance.closer(CLOSER.powi(k)));
    all.take_while(|c| c.lateral >= finest).collect()
}

/// The direction from a point to the eye, and how far it is to the eye or the near plane.
fn line_of_sight(projection: &Projection, p: &Point3<f64>) -> (Vector3<f64>, f64) {
    let (towards, length) = projection.towards_eye(p);
    let depth = projection.depth(p);
    let seen = depth - projection.near;
    let reach = match projection.sight {
        ViewRay::Eye(_) => length * (seen / depth),
        ViewRay::Direction(_) => seen,
    };
    (towards, reach)
}

/// How many wrong pieces are named.
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
            f.write_str(", too few to tell")?;
        }
        if !wrong.is_empty() {
            write!(f, ", {} pieces wrong", wrong.len())?;
        }
        for w in wrong.iter().take(NAMED) {
            let [x, y, z] = w.place;
            write!(
                f,
                "; contour {} ({:?}) piece {} over {:?}: {} for {} at ({x:.6}, {y:.6}, {z:.6})",
                w.contour, w.kind, w.piece, w.t, w.given, w.counted
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
        for told in [Recount::default(), of(7, 21), of(40, 80), of(216, 588)] {
            assert_eq!(told.finding(), Finding::Passes, "{told}");
        }
        for untold in [of(40, 120), of(40, 106)] {
            assert_eq!(untold.finding(), Finding::Undetermined, "{untold}");
        }
        assert!(of(40, 120).to_string().ends_with("too few to tell"));
    }
}
