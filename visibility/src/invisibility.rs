//! Quantitative invisibility of the pieces of contours (Appel 1967, Loutrel 1970; section 4.1.2
//! of the paper).

use crate::contour::Piece;
use crate::sight::{Count, Own, Scene};
use crate::strand::{Change, Passing, Split, Strand};
use nalgebra::Point3;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::sign::ROUNDING;

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
/// answer there was not plain. Not in the middle: there a symmetric part has its special points.
const PLACES: [f64; 3] = [0.47, 0.31, 0.73];

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
    let [_, middle, _] = three;
    middle
}

fn count_at(scene: &Scene<'_>, strand: &Strand<'_>, t: f64) -> Count {
    let p = &strand.curve.point(t);
    let (v, _) = scene.projection.towards_eye(p);
    let own = |face: FaceId| {
        if !strand.faces.iter().any(|f| f.0 == face) {
            return Own::No;
        }
        let surface = scene.brep.surface(face);
        // A limb that runs along the edge is no farther away than points found on two ways are:
        // over this length the normal turns with the surface's bend.
        let bend = surface.normal_curvature(p, &v).abs();
        let turned = LOOSE * (scene.band * bend + ROUNDING);
        let grazing = surface.normal(p).dot(&v).abs() <= turned;
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
    let together = |from: f64, t: f64| from == t || (t - from) * curve.derivative(t).norm() <= near;
    let mut kept: Vec<Split> = Vec::with_capacity(strand.splits.len());
    for &split in &strand.splits {
        match kept.last_mut() {
            Some(last) if together(last.t, split.t) => last.change = Change::Recount,
            _ => kept.push(split),
        }
    }
    // Round a closed strand the last are next to the first.
    if let (true, [first, .., last]) = (strand.closed, kept.as_mut_slice()) {
        let [lo, hi] = strand.range;
        if together(last.t, first.t + (hi - lo)) {
            first.change = Change::Recount;
            kept.pop();
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
        let known = match (method, change, carried.take()) {
            (Method::Carried, Change::Pass(passing), Some(before)) => {
                carry(scene, &strand.curve.point(t), before, &passing)
            }
            _ => None,
        };
        let now = known.unwrap_or_else(|| count(scene, strand, range));
        out.push(Piece {
            t: range,
            visible: now.qi == 0,
            qi: now.qi,
            occluder: now.occluder(),
            start: junction,
            end: then,
            samples: None,
        });
        carried = Some(now);
    }
}

/// The count after a passage behind another contour at `p`, where it follows from the count
/// before.
///
/// Faces meet along edges only, so between passages those that hide keep their order.
fn carry(scene: &Scene<'_>, p: &Point3<f64>, before: Count, passing: &Passing) -> Option<Count> {
    let qi = before.qi.checked_add_signed(passing.by)?;
    let order = order_after(scene, p, before, passing)?;
    let known = order.len() as u32;
    let sound = known <= qi && (known > 0 || qi == 0);
    sound.then_some(Count {
        qi,
        order,
        plain: true,
    })
}

/// The order of the faces in front after a passage, as far as it is known.
fn order_after(
    scene: &Scene<'_>,
    p: &Point3<f64>,
    before: Count,
    passing: &Passing,
) -> Option<Vec<FaceId>> {
    let whole = before.is_whole();
    let mut order = before.order;
    let last = order.len();
    let Some(left) = passing.left else {
        let Some(entered) = passing.entered else {
            return Some(order);
        };
        match slot(scene, p, &order, passing.ahead) {
            Slot::Before(k) if k < last || whole => order.insert(k, entered),
            Slot::Before(_) => {}
            Slot::Unclear(k) => order.truncate(k),
        }
        return Some(order);
    };
    let Some(k) = order.iter().position(|&face| face == left) else {
        // It is behind all those known.
        let behind = !whole && slot(scene, p, &order, passing.ahead) == Slot::Before(last);
        return behind.then_some(order);
    };
    // A plane is met once; of another surface a second sheet may hide, and either may end here.
    let plane = matches!(scene.brep.surface(left), Surface::Plane(_));
    if !plane && (!whole || order[k + 1..].contains(&left)) {
        order.truncate(k);
        return Some(order);
    }
    match passing.entered {
        Some(entered) => order[k] = entered,
        None => {
            order.remove(k);
        }
    }
    Some(order)
}

/// Where in an order of faces something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    /// Just before the one with this index, behind all others before it.
    Before(usize),
    /// Behind those before this index; not plainly before or behind that one.
    Unclear(usize),
}

/// Where in the order of the faces before `p` the distance `ahead` belongs.
fn slot(scene: &Scene<'_>, p: &Point3<f64>, order: &[FaceId], ahead: f64) -> Slot {
    let margin = LOOSE * scene.band;
    for (k, &face) in order.iter().enumerate() {
        let (mut before, mut behind) = (false, false);
        scene.depths(p, face, &mut |s| {
            before |= s > ahead - margin;
            behind |= s < ahead + margin;
        });
        match (before, behind) {
            (true, false) => {}
            (false, true) => return Slot::Before(k),
            _ => return Slot::Unclear(k),
        }
    }
    Slot::Before(order.len())
}
