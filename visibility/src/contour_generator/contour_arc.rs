//! Contours before they are cut at junctions: edges, and limbs trimmed by their faces.

use crate::image_curve::Image;
use crate::image_curve::image_box::ImageBox;
use crate::image_curve::monotone_arc::MonotoneArc;
use premio_kernel::brep::topology::{EdgeId, FaceId, Sense};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::predicates::Compare;

/// An unambiguous passage behind another contour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passing {
    /// The change of the quantitative invisibility.
    pub by: i32,
    /// The face turned towards the eye that begins to hide.
    pub entered: Option<FaceId>,
    /// The face turned towards the eye that ceases to hide.
    pub left: Option<FaceId>,
    /// How far the other contour lies in front of this one, along the line of sight.
    pub ahead: f64,
    /// The lateral distance from the other contour in the image per unit of this one's length.
    pub lateral: f64,
}

impl Passing {
    /// The same on the way back.
    pub fn reversed(&self) -> Self {
        Self {
            by: -self.by,
            entered: self.left,
            left: self.entered,
            ..*self
        }
    }
}

/// What a split does to the quantitative invisibility along the arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// It changes by the passage behind the other contour.
    Pass(Passing),
    /// The occluders follow from the faces at the junction, or are counted again.
    Correct,
}

/// A point at which an arc is cut.
#[derive(Clone, Copy, Debug)]
pub struct Split {
    /// The parameter.
    pub t: f64,
    /// The junction there.
    pub junction: u32,
    /// What happens to the quantitative invisibility.
    pub change: Change,
}

/// A junction on an arc.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ArcJunction {
    /// The parameter of the curve there.
    pub t: f64,
    /// The junction.
    pub junction: u32,
}

/// A face along an arc.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArcFace {
    /// The face.
    pub face: FaceId,
    /// The sense in which its loop runs along the arc.
    pub sense: Sense,
}

/// A connected piece of a contour beyond the near plane.
#[derive(Debug)]
pub struct ContourArc<'a> {
    /// The curve in space.
    pub curve: &'a Curve,
    /// The range of its parameter.
    pub range: [f64; 2],
    /// Whether the range is a whole period.
    pub closed: bool,
    /// The junctions at both ends.
    pub ends: [Option<u32>; 2],
    /// The contour it belongs to.
    pub contour: u32,
    /// Its edge; none for a limb.
    pub edge: Option<EdgeId>,
    /// The faces along it.
    pub faces: Vec<ArcFace>,
    /// Whether it is a limb, of its only face.
    pub limb: bool,
    /// Its image.
    pub image: Image,
    /// Where the image turns back on itself.
    pub turns: Vec<f64>,
    /// The monotone arcs of the image, where it is neither a line nor a conic.
    pub stretches: Vec<MonotoneArc>,
    /// A box that contains the image.
    pub hull: ImageBox,
    /// Where it is cut, in no order.
    pub splits: Vec<Split>,
}

impl ContourArc<'_> {
    /// The junctions known on it.
    pub fn junctions(&self) -> impl Iterator<Item = ArcJunction> {
        let ends = self.ends.iter().zip(self.range);
        let ends = ends.filter_map(|(id, t)| id.map(|junction| ArcJunction { t, junction }));
        ends.chain(self.splits.iter().map(|split| ArcJunction {
            t: split.t,
            junction: split.junction,
        }))
    }

    /// The approximate length of the image between the first and the last of some parameters.
    pub fn length_between(&self, t: &[f64]) -> f64 {
        let (Some(&lo), Some(&hi)) = (t.first(), t.last()) else {
            return 0.0;
        };
        let within = self.stretches.iter();
        within
            .filter(|s| s.range[1].is_beyond(lo) && s.range[0].is_short_of(hi))
            .map(|s| {
                let [p, q] = s.ends;
                (q[0] - p[0]).hypot(q[1] - p[1])
            })
            .sum()
    }

    /// The runs of monotone arcs whose images may intersect a box, each by its breaks.
    pub fn runs_next_to(&self, hull: &ImageBox) -> Vec<Vec<f64>> {
        let mut runs: Vec<Vec<f64>> = Vec::new();
        for stretch in self.stretches.iter().filter(|s| s.bounds.intersects(hull)) {
            let [lo, hi] = stretch.range;
            match runs.last_mut() {
                Some(run) if run.last().is_some_and(|end| end.is_exactly(lo)) => run.push(hi),
                _ => runs.push(vec![lo, hi]),
            }
        }
        runs
    }
}
