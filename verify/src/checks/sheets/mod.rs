//! Checks that a sheet shows what it should: it is written as SVG and as DXF, read back and
//! compared with the contours.
//!
//! Every stroke must lie on a contour of its kind and visibility. Every drawn contour must lie on a
//! stroke, and a visible one on a visible stroke. No two strokes may overlap. Both formats must
//! have the same lengths.

mod dxf;
mod svg;

use super::images::Images;
use super::strokes::Strokes;
use super::window::Window;
use nalgebra::Point2;
use premio_drawing::sheet::{self, Sheet, SheetError, SheetView};
use premio_drawing::{Drawing, Layer, Stroke, StrokeShape};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::unit::Unit;
use premio_visibility::Contours;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::ImageCurve;
use std::fmt;

/// The fractions of a stroke at which it is compared with contours and other strokes. The middle is
/// avoided: there others cross a symmetric stroke.
const ON_STROKES: [f64; 10] = [
    0.003, 0.031, 0.08, 0.17, 0.31, 0.57, 0.79, 0.92, 0.963, 0.996,
];
/// The fractions of a contour's piece at which it is compared with strokes.
const ON_PIECES: [f64; 5] = [0.07, 0.23, 0.47, 0.71, 0.94];
/// The length over which touching curves are within the tolerance, in multiples of the square root
/// of tolerance times size: their distance grows quadratically.
const TOUCHING: f64 = 4.0;
/// Lines that coincide do so within this fraction of the drawing's tolerance. Lines that nearly
/// coincide are two if their ends are farther from each other than that.
const TOGETHER: f64 = 1.0 / 64.0;
/// The largest number of strokes examined.
const MOST: usize = 600;
/// The deviation of polylines from their curves here, relative to the drawing's size.
const FINE: f64 = 1.0 / (1u32 << 24) as f64;
/// The resolution of lengths on paper, in millimetres.
const DIGITS: f64 = 1.0 / 8192.0;
/// The number of faults that are reported individually.
const NAMED: usize = 5;

/// A fault of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetFault {
    /// A stroke lies on no contour of its kind.
    Stray(Point2<f64>),
    /// A drawn contour is on no stroke, or a visible one on hidden strokes only.
    Undrawn {
        /// The position in the drawing.
        place: Point2<f64>,
        /// The contour.
        contour: u32,
        /// The index of its piece.
        piece: usize,
    },
    /// Two strokes overlap.
    Twice(Point2<f64>),
    /// The length read back differs from the one drawn.
    Length {
        /// The format.
        format: &'static str,
        /// The length drawn.
        drawn: f64,
        /// The length read back.
        read: f64,
    },
    /// The sheet cannot be read back.
    Unreadable(String),
}

/// The result for a sheet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SheetReport {
    /// The number of points of strokes and contours that are right.
    pub right: usize,
    /// The faults.
    pub faults: Vec<SheetFault>,
}

/// The tolerances on a sheet, in image units.
struct Scale {
    /// The error of written coordinates.
    tolerance: f64,
    /// The distance from which on two lines are certainly distinct; none if too few digits are
    /// written.
    apart: Option<f64>,
    /// The drawing's size.
    size: f64,
}

/// The position of a stroke's view on a sheet, to convert to the drawing's coordinates.
struct Placing {
    at: Point2<f64>,
    factor: f64,
}

impl SheetReport {
    /// Draws contours on a sheet, with and without smooth edges, and reads it back. `size` is that
    /// of the drawing.
    pub fn new(seen: &Contours, bounds: &Aabb, size: f64) -> Self {
        let mut report = Self::default();
        for smooth in [false, true] {
            let options = premio_drawing::DrawingOptions {
                smooth,
                distance: Some(size * FINE),
                ..premio_drawing::DrawingOptions::default()
            };
            report.drawing(seen, bounds, Drawing::new(seen, &options), size);
        }
        report
    }

    fn drawing(&mut self, seen: &Contours, bounds: &Aabb, drawing: Drawing, size: f64) {
        let how = sheet::SheetOptions {
            title: String::new(),
            unit: Unit::Millimetre,
            paper: sheet::Paper::A0,
            scale: None,
            angle: sheet::Angle::First,
        };
        let sheet = match Sheet::new(
            vec![SheetView {
                view: None,
                drawing,
            }],
            how,
        ) {
            Ok(sheet) => sheet,
            // Nothing is drawn.
            Err(SheetError::Size { .. }) => return,
            Err(error) => return self.faults.push(SheetFault::Unreadable(error.to_string())),
        };
        let drawing = &sheet.views[0].drawing;
        let paper = Placing {
            at: sheet.views[0].at,
            factor: sheet.factor,
        };
        let mut scale = Scale {
            tolerance: drawing.tolerance + drawing.distance + DIGITS / sheet.factor,
            apart: None,
            size,
        };
        let texts = [
            svg::read(
                &premio_drawing::svg::write_sheet(&sheet),
                sheet.size.y,
                &paper,
            ),
            dxf::read(&premio_drawing::dxf::write_sheet(&sheet), &sheet, &paper),
        ];
        for (read, format) in texts.into_iter().zip(["SVG", "DXF"]) {
            match read {
                Ok(strokes) => {
                    self.lengths(drawing, &strokes, format, scale.tolerance);
                    self.strokes(seen, bounds, &strokes, &scale);
                    scale.apart = Some(drawing.tolerance * TOGETHER);
                }
                Err(text) => self
                    .faults
                    .push(SheetFault::Unreadable(format!("{format}: {text}"))),
            }
        }
    }

    /// Compares the lengths read back with those drawn.
    fn lengths(
        &mut self,
        drawing: &Drawing,
        read: &[Stroke],
        format: &'static str,
        tolerance: f64,
    ) {
        for visible in [true, false] {
            for layer in Layer::ALL {
                let length = |strokes: &[Stroke]| -> f64 {
                    let mine = strokes
                        .iter()
                        .filter(|s| s.visible == visible && s.layer == layer);
                    mine.map(|s| s.shape.length()).sum()
                };
                let (drawn, read_back) = (length(&drawing.strokes), length(read));
                let points: usize = read.iter().map(|s| corners(&s.shape)).sum();
                match (drawn - read_back).abs() <= tolerance * points as f64 {
                    true => self.right += 1,
                    false => self.faults.push(SheetFault::Length {
                        format,
                        drawn,
                        read: read_back,
                    }),
                }
            }
        }
    }

    fn strokes(&mut self, seen: &Contours, bounds: &Aabb, read: &[Stroke], scale: &Scale) {
        let Scale {
            tolerance,
            apart,
            size,
        } = *scale;
        let projection = Projection::new(&seen.camera, 1.0);
        let window = Window::around(&projection, bounds);
        let images = Images::new(seen, &window);
        let strokes = Strokes::new(read);
        let touching = TOUCHING * (tolerance * size).sqrt();
        let place = |p: &Point2<f64>| window.of_drawing(&projection, p);
        let nearness = |p: &Point2<f64>| {
            let lateral = p + nalgebra::Vector2::new(tolerance, 0.0);
            let [a, b] = [place(p), place(&lateral)];
            (b[0] - a[0]).hypot(b[1] - a[1])
        };
        for (i, stroke) in read
            .iter()
            .enumerate()
            .step_by(read.len().div_ceil(MOST).max(1))
        {
            let places = ON_STROKES.map(|part| stroke.shape.point(part));
            for p in &places {
                let on_contour = images.any(place(p), nearness(p), |passing| {
                    passing.visible == stroke.visible && passing.layer == stroke.layer
                });
                match on_contour {
                    true => self.right += 1,
                    false => self.faults.push(SheetFault::Stray(*p)),
                }
            }
            let Some(apart) = apart else { continue };
            let others = |p: &Point2<f64>| -> Vec<usize> {
                let passing = strokes.passing(p, apart).map(|(j, _)| j);
                passing.filter(|&j| j != i).collect()
            };
            let passing = places.each_ref().map(others);
            for (k, row) in passing.windows(3).enumerate() {
                // Three consecutive points exclude a mere crossing or touching.
                let all = row[0]
                    .iter()
                    .any(|j| row[1..].iter().all(|r| r.contains(j)));
                if all && (places[k + 2] - places[k]).norm() > touching {
                    self.faults.push(SheetFault::Twice(places[k]));
                }
            }
        }
        self.pieces(seen, &projection, &strokes, tolerance, read);
    }

    /// Whether every drawn piece is on a stroke.
    fn pieces(
        &mut self,
        seen: &Contours,
        projection: &Projection,
        strokes: &Strokes<'_>,
        tolerance: f64,
        read: &[Stroke],
    ) {
        let smooth = read.iter().any(|s| s.layer == Layer::Smooth);
        let drawn = seen.contours.iter().filter(|c| {
            (smooth || !c.smooth) && !matches!(c.image_curve, ImageCurve::Point { .. })
        });
        let pieces: Vec<_> = drawn
            .flat_map(|c| c.pieces.iter().enumerate().map(move |piece| (c, piece)))
            .collect();
        let mut undrawn = Vec::new();
        for &(contour, (index, piece)) in pieces.iter().step_by(pieces.len().div_ceil(MOST).max(1))
        {
            let [lo, hi] = piece.range;
            let at = |part: f64| {
                projection.project_y_up(&contour.space_curve.point(lo + (hi - lo) * part))
            };
            let suits = |s: &Stroke| s.visible || !piece.visible;
            let is_drawn = |p: &Point2<f64>| strokes.passing(p, tolerance).any(|(_, s)| suits(s));
            let missing: Vec<_> = ON_PIECES
                .map(at)
                .into_iter()
                .filter(|p| !is_drawn(p))
                .collect();
            self.right += ON_PIECES.len() - missing.len();
            if !missing.is_empty() {
                undrawn.push(UndrawnPiece {
                    contour: contour.id,
                    index,
                    ends: [piece.start, piece.end],
                    extent: [0.0, 0.5, 1.0].map(at),
                    missing,
                });
            }
        }
        let faults = connected(undrawn).into_iter().filter(|group| {
            // A dot: what is connected is smaller than what is drawn.
            let points = || group.iter().flat_map(|piece| piece.extent);
            points().any(|a| points().any(|b| (a - b).norm() > tolerance))
        });
        self.faults
            .extend(faults.flatten().flat_map(UndrawnPiece::faults));
    }
}

/// A piece of a contour that is not on a stroke everywhere.
struct UndrawnPiece {
    /// The contour.
    contour: u32,
    /// The index of the piece in the contour.
    index: usize,
    /// The junctions at its ends.
    ends: [Option<u32>; 2],
    /// Its ends and its middle, in the drawing.
    extent: [Point2<f64>; 3],
    /// Where it is not drawn.
    missing: Vec<Point2<f64>>,
}

impl UndrawnPiece {
    /// A fault for each place that is not drawn.
    fn faults(self) -> impl Iterator<Item = SheetFault> {
        let (contour, piece) = (self.contour, self.index);
        let fault = move |place| SheetFault::Undrawn {
            place,
            contour,
            piece,
        };
        self.missing.into_iter().map(fault)
    }
}

/// Pieces in groups that are connected by junctions.
fn connected(pieces: Vec<UndrawnPiece>) -> Vec<Vec<UndrawnPiece>> {
    let mut groups: Vec<Vec<UndrawnPiece>> = Vec::new();
    for piece in pieces {
        let touches = |other: &UndrawnPiece| {
            let ends = piece.ends.iter().flatten();
            ends.into_iter().any(|id| other.ends.contains(&Some(*id)))
        };
        let (joined, apart) = groups
            .into_iter()
            .partition::<Vec<_>, _>(|group| group.iter().any(touches));
        groups = apart;
        groups.push(joined.into_iter().flatten().chain([piece]).collect());
    }
    groups
}

/// The number of rounded points by which a shape is written.
fn corners(shape: &StrokeShape) -> usize {
    match shape {
        StrokeShape::Path(points) => points.len(),
        StrokeShape::Line(_) => 2,
        // Centre, half axes and ends, twice over: the length is about a sum of these.
        StrokeShape::Ellipse { .. } => 8,
    }
}

impl Placing {
    /// The point of the drawing at a point of the paper, y up.
    fn back(&self, x: f64, y: f64) -> Point2<f64> {
        Point2::new((x - self.at.x) / self.factor, (y - self.at.y) / self.factor)
    }
}

impl fmt::Display for SheetFault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut at = |text: &str, p: &Point2<f64>| write!(f, "{text} at ({:.6}, {:.6})", p.x, p.y);
        match self {
            Self::Stray(p) => at("a stroke on no contour of its kind", p),
            Self::Undrawn {
                place,
                contour,
                piece,
            } => at(
                &format!("piece {piece} of contour {contour} is not drawn"),
                place,
            ),
            Self::Twice(p) => at("two strokes on one another", p),
            Self::Length {
                format,
                drawn,
                read,
            } => write!(
                f,
                "{format} has a length of {read:.6} in place of {drawn:.6}"
            ),
            Self::Unreadable(text) => write!(f, "unreadable: {text}"),
        }
    }
}

impl fmt::Display for SheetReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} places are right", self.right)?;
        if !self.faults.is_empty() {
            write!(f, ", {} are wrong", self.faults.len())?;
        }
        for fault in self.faults.iter().take(NAMED) {
            write!(f, "; {fault}")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fixture::{FrontView, front_view};

    /// The report on a changed front view of a block with a blind hole.
    fn report(change: impl Fn(&mut Vec<Stroke>)) -> SheetReport {
        let block = "P = BLO(X=60,Y=40,Z=20) DIF CYL(R=8,H=20) AT (MOVX=30,MOVY=20,MOVZ=8)";
        let FrontView {
            seen,
            mut drawing,
            bounds,
            ..
        } = front_view(block);
        change(&mut drawing.strokes);
        let mut report = SheetReport::default();
        let scale = Scale {
            tolerance: drawing.tolerance + drawing.distance,
            apart: Some(drawing.tolerance * TOGETHER),
            size: 60.0,
        };
        report.strokes(&seen, &bounds, &drawing.strokes, &scale);
        report
    }

    fn has(report: &SheetReport, is_it: impl Fn(&SheetFault) -> bool) -> bool {
        report.faults.iter().any(is_it)
    }

    #[test]
    fn a_right_sheet_is_right() {
        let right = report(|_| {});
        assert!(right.faults.is_empty() && right.right > 50, "{right}");
    }

    #[test]
    fn what_is_wrong_on_a_sheet_is_found() {
        let lost = report(|strokes| drop(strokes.pop()));
        assert!(
            has(&lost, |f| matches!(f, SheetFault::Undrawn { .. })),
            "{lost}"
        );
        // A hidden line under a visible one.
        let twice = report(|strokes| {
            let mut stroke = strokes[strokes.len() - 1].clone();
            stroke.visible = false;
            strokes.push(stroke);
        });
        assert!(
            has(&twice, |f| matches!(f, SheetFault::Twice(_))),
            "{twice}"
        );
        let stray = report(|strokes| {
            let shape = StrokeShape::Line([Point2::new(-20.0, -9.0), Point2::new(20.0, 7.0)]);
            strokes[0].shape = shape;
        });
        assert!(
            has(&stray, |f| matches!(f, SheetFault::Stray(_))),
            "{stray}"
        );
    }
}
