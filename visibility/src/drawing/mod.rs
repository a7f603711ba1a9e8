//! Line drawings of contours: lines, circles and ellipses as such, the rest as polylines within a
//! stated distance.
//!
//! A drawing is kept in the camera's image units with y up; a camera with y down is turned over. It is
//! a page of its own, or one of the views on a sheet.

pub mod dxf;
pub mod sheet;
pub mod svg;

use crate::contour::{Contour, Contours, ImageCurve, JunctionKind, Kind, Piece};
use crate::projection::{Projection, Sight};
use nalgebra::{Point2, Vector2};
use premio_kernel::number::sign::ROUNDING;
use std::f64::consts::TAU;

/// What a stroke shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Layer {
    /// An edge where the normal jumps.
    Boundary,
    /// A limb.
    Limb,
    /// An edge where the normal does not jump.
    Smooth,
}

impl Layer {
    /// All layers.
    pub const ALL: [Self; 3] = [Self::Boundary, Self::Limb, Self::Smooth];

    /// The name used in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Boundary => "boundary",
            Self::Limb => "limb",
            Self::Smooth => "smooth",
        }
    }
}

/// The form of a stroke.
#[derive(Clone, Debug, PartialEq)]
pub enum Shape {
    /// A straight line.
    Line([Point2<f64>; 2]),
    /// An arc of an ellipse: centre + cos s major + sin s minor.
    Ellipse {
        /// The centre.
        centre: Point2<f64>,
        /// The half axis of the parameter 0.
        major: Vector2<f64>,
        /// The ratio of the other half axis, which is to the left of it.
        ratio: f64,
        /// Where the parameter starts.
        from: f64,
        /// How far it runs: positive, at most one turn.
        sweep: f64,
    },
    /// A polyline.
    Path(Vec<Point2<f64>>),
}

/// A stroke of a drawing.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Its form.
    pub shape: Shape,
    /// What it shows.
    pub layer: Layer,
    /// Whether nothing hides it.
    pub visible: bool,
}

/// What is drawn, and how finely.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Whether hidden lines are drawn too, dashed.
    pub hidden: bool,
    /// Whether boundaries are drawn along which the normal does not jump.
    pub smooth: bool,
    /// How far a polyline may be off its curve, in image units; none for a part of the drawing's
    /// size.
    pub distance: Option<f64>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            hidden: true,
            smooth: false,
            distance: None,
        }
    }
}

/// The default distance, as a part of the drawing's size.
const FINE: f64 = 1.0 / 10_000.0;
/// An ellipse thinner than this is drawn as a polyline.
const THIN: f64 = 1.0 / 4096.0;

/// A line drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The strokes, hidden ones first.
    pub strokes: Vec<Stroke>,
    /// The lower left and upper right corner of what is drawn.
    pub extent: [Point2<f64>; 2],
    /// The distance within which polylines follow their curves.
    pub distance: f64,
    /// Whether the image is in the part's unit.
    pub to_scale: bool,
}

impl Drawing {
    /// The drawing of contours.
    pub fn new(contours: &Contours, options: &Options) -> Self {
        let projection = Projection::new(&contours.camera, 1.0);
        let mut draft = Draft {
            contours,
            projection: &projection,
            distance: 0.0,
            strokes: Vec::new(),
        };
        let drawn: Vec<&Contour> = contours
            .contours
            .iter()
            .filter(|c| options.smooth || !c.smooth)
            .collect();
        let extent = draft.extent(&drawn);
        let size = (extent[1] - extent[0]).norm();
        draft.distance = options.distance.unwrap_or(size * FINE);
        for contour in drawn {
            draft.contour(contour, options.hidden);
        }
        let mut strokes = draft.strokes;
        strokes.sort_by_key(|s| s.visible);
        Self {
            strokes,
            extent,
            distance: draft.distance,
            to_scale: matches!(projection.sight, Sight::Direction(_)),
        }
    }
}

struct Draft<'p> {
    contours: &'p Contours,
    projection: &'p Projection,
    distance: f64,
    strokes: Vec<Stroke>,
}

impl Draft<'_> {
    fn point(&self, contour: &Contour, t: f64) -> Point2<f64> {
        let p = self.projection.project(&contour.curve3.point(t));
        if self.projection.y_down {
            Point2::new(p.x, -p.y)
        } else {
            p
        }
    }

    fn extent(&self, contours: &[&Contour]) -> [Point2<f64>; 2] {
        let mut lo = Point2::new(f64::INFINITY, f64::INFINITY);
        let mut hi = -lo;
        for contour in contours {
            for piece in &contour.pieces {
                for k in 0..=16 {
                    let [a, b] = piece.t;
                    let p = self.point(contour, a + (b - a) * f64::from(k) / 16.0);
                    lo = lo.inf(&p);
                    hi = hi.sup(&p);
                }
            }
        }
        if lo.x > hi.x {
            return [Point2::origin(), Point2::new(1.0, 1.0)];
        }
        [lo, hi]
    }

    fn contour(&mut self, contour: &Contour, hidden: bool) {
        let layer = match (contour.kind, contour.smooth) {
            (Kind::Limb, _) => Layer::Limb,
            (Kind::Boundary, true) => Layer::Smooth,
            (Kind::Boundary, false) => Layer::Boundary,
        };
        for (range, visible) in runs(self.contours, &contour.pieces) {
            if !visible && !hidden {
                continue;
            }
            // Nobody sees what is shorter than the distance, but a whole contour is no dot too many.
            let part = contour.pieces.len() > 1;
            let shape = self.shape(contour, range);
            if let Some(shape) = shape.filter(|s| !part || self.shows(s)) {
                self.strokes.push(Stroke {
                    shape,
                    layer,
                    visible,
                });
            }
        }
    }

    /// Whether a polyline is as long as the distance within which it follows its curve.
    fn shows(&self, shape: &Shape) -> bool {
        match shape {
            Shape::Path(points) => points
                .iter()
                .any(|p| (p - points[0]).norm() > self.distance),
            Shape::Line([a, b]) => (b - a).norm() > self.distance,
            Shape::Ellipse { .. } => true,
        }
    }

    fn shape(&self, contour: &Contour, [lo, hi]: [f64; 2]) -> Option<Shape> {
        let (a, b) = (self.point(contour, lo), self.point(contour, hi));
        match &contour.curve2 {
            ImageCurve::Point { .. } => None,
            // A conic seen edge-on is on a line too, but only its ends may turn back.
            ImageCurve::Line { .. } => Some(Shape::Line([a, b])),
            ImageCurve::Conic { coefficients } => Some(
                self.ellipse(contour, coefficients, [lo, hi])
                    .unwrap_or_else(|| self.path(contour, [lo, hi])),
            ),
            ImageCurve::Projected => Some(self.path(contour, [lo, hi])),
        }
    }

    fn ellipse(&self, contour: &Contour, k: &[f64; 6], [lo, hi]: [f64; 2]) -> Option<Shape> {
        let flip = if self.projection.y_down { -1.0 } else { 1.0 };
        let six = [k[0], k[1] * flip, k[2], k[3], k[4] * flip, k[5]];
        let (centre, major, ratio) = half_axes(&six)?;
        (ratio > THIN).then_some(())?;
        let minor = Vector2::new(-major.y, major.x) * ratio;
        let angle = |t: f64| {
            let d = self.point(contour, t) - centre;
            (d.dot(&minor) / minor.norm_squared()).atan2(d.dot(&major) / major.norm_squared())
        };
        let closed = contour
            .curve3
            .period()
            .is_some_and(|p| hi - lo >= p * (1.0 - ROUNDING));
        let (from, middle) = (
            angle(lo),
            (angle(0.5 * (lo + hi)) - angle(lo)).rem_euclid(TAU),
        );
        if closed {
            return Some(Shape::Ellipse {
                centre,
                major,
                ratio,
                from,
                sweep: TAU,
            });
        }
        let sweep = (angle(hi) - from).rem_euclid(TAU);
        // Run backwards, if the middle is not between the ends.
        let (from, sweep) = if middle <= sweep {
            (from, sweep)
        } else {
            (from + sweep, TAU - sweep)
        };
        Some(Shape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        })
    }

    fn path(&self, contour: &Contour, [lo, hi]: [f64; 2]) -> Shape {
        let mut points = vec![self.point(contour, lo)];
        for pair in contour.curve3.breaks(lo, hi).windows(2) {
            self.refine(contour, [pair[0], pair[1]], 0, &mut points);
        }
        Shape::Path(points)
    }

    fn refine(&self, contour: &Contour, [a, b]: [f64; 2], depth: u32, out: &mut Vec<Point2<f64>>) {
        let (p, q) = (self.point(contour, a), self.point(contour, b));
        let chord = q - p;
        let square = chord.norm_squared();
        // From the chord, not from its line: next to a cusp the image runs on and comes back.
        let off = |part: f64| {
            let d = self.point(contour, a + (b - a) * part) - p;
            let foot = if square > 0.0 {
                d.dot(&chord) / square
            } else {
                0.0
            };
            (d - chord * foot.clamp(0.0, 1.0)).norm()
        };
        let worst = [0.25, 0.5, 0.75].into_iter().map(off).fold(0.0, f64::max);
        // Half the distance: the largest deviation lies between the three places.
        if depth >= 16 || (depth >= 1 && worst <= 0.5 * self.distance) {
            out.push(q);
            return;
        }
        let m = 0.5 * (a + b);
        self.refine(contour, [a, m], depth + 1, out);
        self.refine(contour, [m, b], depth + 1, out);
    }
}

/// Neighbouring pieces of one visibility taken together, unless the image turns back there.
fn runs(contours: &Contours, pieces: &[Piece]) -> Vec<([f64; 2], bool)> {
    let turns = |id: Option<u32>| {
        let kind = id
            .and_then(|id| contours.junctions.get(id as usize))
            .map(|j| j.kind);
        kind == Some(JunctionKind::Turn)
    };
    let mut runs: Vec<([f64; 2], bool)> = Vec::new();
    for piece in pieces {
        match runs.last_mut() {
            Some((range, visible))
                if *visible == piece.visible && range[1] == piece.t[0] && !turns(piece.start) =>
            {
                range[1] = piece.t[1];
            }
            _ => runs.push((piece.t, piece.visible)),
        }
    }
    runs
}

/// Centre, major half axis and ratio of the ellipse of six coefficients; none for other conics.
fn half_axes(&[a, b, c, d, e, f]: &[f64; 6]) -> Option<(Point2<f64>, Vector2<f64>, f64)> {
    let det = 4.0 * a * c - b * b;
    if det <= 0.0 {
        return None;
    }
    let x = (b * e - 2.0 * c * d) / det;
    let y = (b * d - 2.0 * a * e) / det;
    let level = -(f + 0.5 * (d * x + e * y));
    let mean = 0.5 * (a + c);
    let spread = (0.5 * (a - c)).hypot(0.5 * b);
    let sign = level.signum();
    let (small, large) = (sign * mean - spread, sign * mean + spread);
    if small <= 0.0 || level == 0.0 {
        return None;
    }
    // The smaller eigenvalue belongs to the longer axis.
    let turn = 0.5 * (sign * b).atan2(sign * (a - c)) + TAU / 4.0;
    let long = (level.abs() / small).sqrt();
    let short = (level.abs() / large).sqrt();
    let major = Vector2::new(turn.cos(), turn.sin()) * long;
    (long.is_finite() && short.is_finite()).then(|| (Point2::new(x, y), major, short / long))
}
