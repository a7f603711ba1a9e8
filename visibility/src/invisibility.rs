//! Quantitative invisibility of the pieces of contours (Appel 1967, Loutrel 1970; section 4.1.2
//! of the paper).

use crate::contour::Piece;
use crate::sight::{Count, Own, Scene};
use crate::strand::{Change, Passing, Split, Strand};
use nalgebra::Point3;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::surface::Surface;

/// How the quantitative invisibility of the pieces is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Counted once for each strand and carried along it.
    #[default]
    Carried,
    /// Counted for every piece.
    Counted,
}

/// Distances between points found on two ways, in multiples of the resolution.
const LOOSE: f64 = 16.0;
/// Where in a piece its faces in front are counted: the first place, and those asked where the
/// answer there was not plain.
const PLACES: [f64; 3] = [0.5, 0.31, 0.73];

/// The count for a piece of a strand over [lo, hi].
pub fn count(scene: &Scene<'_>, strand: &Strand<'_>, [lo, hi]: [f64; 2]) -> Count {
    let at = |part: f64| count_at(scene, strand, lo + (hi - lo) * part);
    let first = at(PLACES[0]);
    if first.plain {
        return first;
    }
    // Contours that fall on one another are unplain everywhere, and the three agree; a place that
    // happens to be next to something is outvoted.
    let mut three = [first, at(PLACES[1]), at(PLACES[2])];
    three.sort_by_key(|c| c.qi);
    three[1]
}

fn count_at(scene: &Scene<'_>, strand: &Strand<'_>, t: f64) -> Count {
    let p = &strand.curve.point(t);
    let (v, _) = scene.projection.towards_eye(p);
    let own = |face: FaceId| {
        if !strand.faces.iter().any(|f| f.0 == face) {
            return Own::No;
        }
        let surface = scene.brep.surface(face);
        // A limb that runs along the edge: the surface leaves the line of sight by less than the
        // band over this length.
        let bend = surface.normal_curvature(p, &v).abs();
        let grazing = surface.normal(p).dot(&v).abs() <= 4.0 * (scene.band * bend).sqrt();
        if strand.limb || grazing {
            Own::Tangent
        } else {
            Own::Through
        }
    };
    scene.count(p, &strand.curve.tangent(t), &own)
}

/// The splits of a strand in order, those at one point taken together.
fn ordered(strand: &mut Strand<'_>, near: f64) -> Vec<Split> {
    strand.splits.sort_by(|a, b| a.t.total_cmp(&b.t));
    let curve = strand.curve;
    let mut kept: Vec<Split> = Vec::with_capacity(strand.splits.len());
    for &split in &strand.splits {
        match kept.last_mut() {
            Some(last)
                if last.t == split.t
                    || (split.t - last.t) * curve.derivative(split.t).norm() <= near =>
            {
                last.change = Change::Recount;
            }
            _ => kept.push(split),
        }
    }
    kept
}

/// Cuts a strand at its splits and finds the quantitative invisibility of each piece.
pub fn pieces(
    scene: &Scene<'_>,
    strand: &mut Strand<'_>,
    method: Method,
    near: f64,
    out: &mut Vec<Piece>,
) {
    let splits = ordered(strand, near);
    let [lo, hi] = strand.range;
    // (start, junction there, what happens on entering).
    let mut starts: Vec<(f64, Option<u32>, Change)> = Vec::with_capacity(splits.len() + 1);
    let (end, last) = match (strand.closed, splits.first()) {
        (true, Some(first)) => (first.t + (hi - lo), Some(first.junction)),
        _ => {
            starts.push((lo, strand.ends[0], Change::Recount));
            (hi, strand.ends[1])
        }
    };
    starts.extend(splits.iter().map(|s| (s.t, Some(s.junction), s.change)));
    let mut carried: Option<Count> = None;
    for (k, &(t, junction, change)) in starts.iter().enumerate() {
        let (until, then) = starts
            .get(k + 1)
            .map_or((end, last), |next| (next.0, next.1));
        let range = [t, until];
        let known = match (method, change, carried) {
            (Method::Carried, Change::Pass(passing), Some(before)) => {
                carry(scene, &strand.curve.point(t), before, &passing)
            }
            _ => None,
        };
        let now = known.unwrap_or_else(|| count(scene, strand, range));
        carried = Some(now);
        out.push(Piece {
            t: range,
            visible: now.qi == 0,
            qi: now.qi,
            occluder: now.occluder,
            start: junction,
            end: then,
            samples: None,
        });
    }
}

/// The count after a passage behind another contour at `p`, where it follows from the count
/// before.
fn carry(scene: &Scene<'_>, p: &Point3<f64>, before: Count, passing: &Passing) -> Option<Count> {
    let qi = before.qi.checked_add_signed(passing.by)?;
    let occluder = match (qi, before.occluder) {
        (0, _) => None,
        (_, None) => Some(passing.entered?),
        (_, Some(first)) => Some(nearest(scene, p, first, passing)?),
    };
    Some(Count {
        qi,
        occluder,
        plain: true,
    })
}

/// The face nearest to the eye after the passage, if it was `first` before.
fn nearest(scene: &Scene<'_>, p: &Point3<f64>, first: FaceId, passing: &Passing) -> Option<FaceId> {
    if passing.left == Some(first) || passing.entered == Some(first) {
        // A plane is met once, so it is the one that ends here.
        let plane = matches!(scene.brep.surface(first), Surface::Plane(_));
        return match (passing.left, passing.entered) {
            (Some(left), Some(entered)) if plane && left == first => Some(entered),
            _ => None,
        };
    }
    let margin = LOOSE * scene.band;
    let (mut before, mut behind) = (false, false);
    scene.depths(p, first, &mut |s| {
        before |= s > passing.ahead - margin;
        behind |= s < passing.ahead + margin;
    });
    match (before, behind) {
        (true, false) => Some(first),
        (false, true) if passing.left.is_none() => passing.entered,
        _ => None,
    }
}
