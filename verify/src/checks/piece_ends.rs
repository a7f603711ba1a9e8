//! Checks that pieces of contours end at the points of their junctions.

use nalgebra::Point3;
use premio_csg::ray_casting::Clearance;
use premio_visibility::Contours;
use std::fmt;

/// An end of a piece away from its junction.
#[derive(Clone, Debug, PartialEq)]
pub struct DisplacedEnd {
    /// The contour.
    pub contour: u32,
    /// The index of the piece in the contour.
    pub piece: usize,
    /// The junction.
    pub junction: u32,
    /// The distance from it.
    pub distance: f64,
}

/// The ends of pieces that are farther from their junctions than the position of a tangency may
/// be.
pub fn displaced_ends(seen: &Contours, clearance: &Clearance) -> Vec<DisplacedEnd> {
    let allowed = (clearance.lateral * clearance.size).sqrt();
    let mut displaced = Vec::new();
    for contour in &seen.contours {
        for (piece, of) in contour.pieces.iter().enumerate() {
            for (t, junction) in of.range.into_iter().zip([of.start, of.end]) {
                let Some(junction) = junction else { continue };
                let known = seen.junctions.get(junction as usize);
                let point = contour.space_curve.point(t);
                let distance = known.map_or(f64::NAN, |known| {
                    (point - Point3::from(known.space_point)).norm()
                });
                if distance.is_nan() || distance > allowed {
                    displaced.push(DisplacedEnd {
                        contour: contour.id,
                        piece,
                        junction,
                        distance,
                    });
                }
            }
        }
    }
    displaced
}

impl fmt::Display for DisplacedEnd {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            contour,
            piece,
            junction,
            distance,
        } = self;
        write!(
            f,
            "piece {piece} of contour {contour} ends {distance:.3e} from junction {junction}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fixture::front_view;

    /// Two blocks behind one another, one of which hides edges of the other.
    #[test]
    fn a_displaced_junction_is_found() {
        let text = "P = BLO(X=3, Y=1, Z=2) UN BLO(X=2, Y=1, Z=4) AT (MOVX=2, MOVY=2)";
        let mut seen = front_view(text).seen;
        let clearance = Clearance {
            sliver: 1e-9,
            lateral: 1e-7,
            shift: 0.0,
            size: 5.0,
        };
        assert_eq!(displaced_ends(&seen, &clearance), []);
        let used = seen.contours.iter().flat_map(|contour| &contour.pieces);
        let first = used.filter_map(|piece| piece.start).next().unwrap();
        seen.junctions[first as usize].space_point[0] += 0.01;
        let found = displaced_ends(&seen, &clearance);
        assert!(!found.is_empty());
        for displaced in found {
            assert_eq!(displaced.junction, first);
            assert!((displaced.distance - 0.01).abs() < 1e-6, "{displaced}");
        }
    }
}
