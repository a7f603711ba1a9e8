//! The image arcs of contours: runs of pieces with the same visibility, cut where the image folds
//! back.

use super::Layer;
use super::image_arc::{ImageArc, ImageEllipse};
use super::projected_arc::{ProjectedArc, Sample};
use super::supports::ordered;
use nalgebra::{Matrix3, Point2, Vector3};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::{Contour, ContourPiece, Contours, ImageCurve, JunctionKind};
use premio_visibility::image_curve::{folds_of_conic, map_of_ellipse};
use std::f64::consts::TAU;
use std::rc::Rc;

/// An image arc with its layer and visibility.
pub struct DrawnArc<'c> {
    /// Its form.
    pub arc: ImageArc<'c>,
    /// Its layer.
    pub layer: Layer,
    /// Whether nothing hides it.
    pub visible: bool,
}

/// An ellipse thinner than this is drawn as a polyline.
const THIN: f64 = 1.0 / 4096.0;

/// An arc of an ellipse with a half axis longer than this, in multiples of the drawing's size, is
/// drawn as a polyline: readers with single precision lose its middle.
const LARGE: f64 = 1024.0;

/// The fractions of an arc at which its ellipse is compared with its curve.
const COMPARED: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];

/// The share of the pieces before and after a junction that determines whether the image folds
/// there.
const NEXT_TO: f64 = 1.0 / 64.0;

/// The most halvings of an arc for its polyline.
const HALVINGS: u32 = 16;

/// The maker of image arcs.
pub struct ArcMaker<'c> {
    /// The contours.
    pub contours: &'c Contours,
    /// The projection of their camera.
    pub projection: &'c Projection,
    /// The greatest distance of a polyline from its curve.
    pub distance: f64,
    /// The drawing's size.
    pub size: f64,
    /// The greatest distance of an arc of an ellipse from its curve.
    pub tolerance: f64,
}

impl<'c> ArcMaker<'c> {
    /// The image of a point of a contour, with y up.
    pub fn point(&self, contour: &Contour, t: f64) -> Point2<f64> {
        self.projection.project_y_up(&contour.space_curve.point(t))
    }

    /// The image arcs of a contour. A contour seen end-on has none.
    pub fn arcs(&self, contour: &'c Contour, out: &mut Vec<DrawnArc<'c>>) {
        let layer = Layer::from_contour(contour);
        for Run { range, visible } in self.runs(contour) {
            let mut put = |arc| {
                out.push(DrawnArc {
                    arc,
                    layer,
                    visible,
                });
            };
            match &contour.image_curve {
                ImageCurve::Point { .. } => {}
                ImageCurve::Line { .. } => put(self.segment(contour, range)),
                ImageCurve::Conic { coefficients } => {
                    put(match self.elliptic(contour, coefficients, range) {
                        Some(arc) => arc,
                        None => self.projected(contour, range),
                    });
                }
                ImageCurve::Projected => put(self.projected(contour, range)),
            }
        }
    }

    /// Runs of neighbouring pieces with the same visibility, unless the image folds back between
    /// them.
    fn runs(&self, contour: &Contour) -> Vec<Run> {
        let mut runs: Vec<Run> = Vec::new();
        let mut before: Option<&ContourPiece> = None;
        for piece in &contour.pieces {
            let goes_on = before.is_some_and(|before| {
                before.visible == piece.visible
                    && before.range[1] == piece.range[0]
                    && !self.folds(contour, before, piece)
            });
            match runs.last_mut() {
                Some(run) if goes_on => run.range[1] = piece.range[1],
                _ => runs.push(Run {
                    range: piece.range,
                    visible: piece.visible,
                }),
            }
            before = Some(piece);
        }
        runs
    }

    /// Whether the image folds back from one piece to the next. On a line that makes no difference.
    fn folds(&self, contour: &Contour, before: &ContourPiece, after: &ContourPiece) -> bool {
        if matches!(contour.image_curve, ImageCurve::Line { .. }) {
            return false;
        }
        let junction = before
            .end
            .and_then(|id| self.contours.junctions.get(id as usize));
        if junction.is_some_and(|j| j.kind == JunctionKind::ImageTurn) {
            return true;
        }
        let t = before.range[1];
        let next_to = [
            t - (t - before.range[0]) * NEXT_TO,
            t + (after.range[1] - t) * NEXT_TO,
        ];
        let [p, q] = next_to.map(|s| self.point(contour, s));
        let at = self.point(contour, t);
        (at - p).dot(&(q - at)) < 0.0
    }

    /// The segment that an image on a line covers.
    fn segment(&self, contour: &Contour, [lo, hi]: [f64; 2]) -> ImageArc<'c> {
        let mut stops = vec![lo, hi];
        if !matches!(contour.space_curve, Curve::Line(_)) {
            stops.extend(folds_of_conic(
                &contour.space_curve,
                [lo, hi],
                self.projection,
            ));
        }
        let points: Vec<Point2<f64>> = stops.iter().map(|&t| self.point(contour, t)).collect();
        let pairs = points
            .iter()
            .flat_map(|p| points.iter().map(move |q| [*p, *q]));
        let longest = pairs.max_by(|a, b| {
            let length = |[p, q]: &[Point2<f64>; 2]| (q - p).norm();
            length(a).total_cmp(&length(b))
        });
        ImageArc::Segment(longest.unwrap_or([points[0]; 2]))
    }

    /// The arc of an ellipse; none of other conics and of an ellipse that is thin, large or not
    /// accurate. The centre of one that is nearly a parabola has no correct digits.
    fn elliptic(
        &self,
        contour: &Contour,
        k: &[f64; 6],
        [lo, hi]: [f64; 2],
    ) -> Option<ImageArc<'c>> {
        let flip = if self.projection.y_down { -1.0 } else { 1.0 };
        let up = Matrix3::from_diagonal(&Vector3::new(1.0, flip, 1.0));
        let ellipse = match map_of_ellipse(&contour.space_curve, self.projection) {
            Some(map) => ImageEllipse::from_map(&(up * self.projection.in_units(&map)))?,
            None => {
                let six = [k[0], k[1] * flip, k[2], k[3], k[4] * flip, k[5]];
                ImageEllipse::from_coefficients(&six)?
            }
        };
        let is_drawable = ellipse.ratio > THIN && ellipse.major.norm() < LARGE * self.size;
        is_drawable.then_some(())?;
        let is_whole = |p: f64| hi - lo >= p * (1.0 - ROUNDING);
        let is_conic = matches!(contour.space_curve, Curve::Circle(_) | Curve::Ellipse(_));
        let angle = |t: f64| ellipse.angle(&self.point(contour, t));
        let from = angle(lo);
        if is_conic && contour.space_curve.period().is_some_and(is_whole) {
            let range = [from, from + TAU];
            return Some(ImageArc::Elliptic { ellipse, range });
        }
        let is_accurate = |part: f64| {
            let t = lo + (hi - lo) * part;
            let on_ellipse = ellipse.point(angle(t));
            (on_ellipse - self.point(contour, t)).norm() <= self.tolerance
        };
        COMPARED.into_iter().all(is_accurate).then_some(())?;
        let range = ordered(from, angle(0.5 * (lo + hi)), angle(hi));
        Some(ImageArc::Elliptic { ellipse, range })
    }

    fn projected(&self, contour: &'c Contour, [lo, hi]: [f64; 2]) -> ImageArc<'c> {
        let refinement = Refinement {
            curve: &contour.space_curve,
            projection: self.projection,
            distance: self.distance,
        };
        let mut samples = vec![refinement.sample(lo)];
        for pair in contour.space_curve.breaks(lo, hi).windows(2) {
            let ends = [refinement.sample(pair[0]), refinement.sample(pair[1])];
            refinement.refine(ends, 0, &mut samples);
        }
        let (projection, curve) = (self.projection, &contour.space_curve);
        let image = move |t: f64| projection.project_y_up(&curve.point(t));
        ImageArc::Projected(ProjectedArc::new(Rc::new(image), samples))
    }
}

/// The refinement of a polyline until it follows the image of a curve.
struct Refinement<'c> {
    curve: &'c Curve,
    projection: &'c Projection,
    /// The greatest distance of the polyline from the image.
    distance: f64,
}

impl Refinement<'_> {
    fn sample(&self, t: f64) -> Sample {
        Sample {
            t,
            point: self.projection.project_y_up(&self.curve.point(t)),
        }
    }

    /// Adds the samples after the first of two, so that the polyline is within the distance.
    fn refine(&self, [a, b]: [Sample; 2], depth: u32, out: &mut Vec<Sample>) {
        let chord = b.point - a.point;
        let square = chord.norm_squared();
        // From the chord, not from its line: near a cusp the image overshoots and comes back.
        let deviation = |s: &Sample| {
            let d = s.point - a.point;
            let foot = match square > 0.0 {
                true => d.dot(&chord) / square,
                false => 0.0,
            };
            (d - chord * foot.clamp(0.0, 1.0)).norm()
        };
        let inner = [0.25, 0.5, 0.75].map(|part| self.sample(a.t + (b.t - a.t) * part));
        let worst = inner.iter().map(deviation).fold(0.0, f64::max);
        let worst = worst.max(self.overshoot(&a, &b));
        // Half the distance, because the largest deviation lies between the three points.
        if depth >= HALVINGS || (depth >= 1 && worst <= 0.5 * self.distance) {
            out.push(b);
            return;
        }
        let middle = inner[1];
        self.refine([a, middle], depth + 1, out);
        self.refine([middle, b], depth + 1, out);
    }

    /// The distance of the control points of the Hermite cubic between two samples beyond the ends
    /// of the chord, an upper bound of how far the cubic folds back. A fold may lie between two of
    /// the inner samples.
    fn overshoot(&self, a: &Sample, b: &Sample) -> f64 {
        let chord = b.point - a.point;
        let third = (b.t - a.t) / 3.0;
        let beyond = [a, b].map(|s| {
            let velocity = self
                .projection
                .velocity_y_up(&self.curve.point(s.t), &self.curve.derivative(s.t));
            match velocity.dot(&chord) < 0.0 {
                true => velocity.norm() * third,
                false => 0.0,
            }
        });
        beyond[0].max(beyond[1])
    }
}

/// A run of pieces that are drawn as one.
struct Run {
    range: [f64; 2],
    visible: bool,
}
