//! Line drawings of contours: lines, circles and ellipses as such, the rest as polylines within a
//! stated distance.
//!
//! A drawing is in the camera's image units with y up; the image of a camera with y down is
//! flipped. It is a page of its own, or one of the views on a sheet.

pub mod dxf;
mod image_arc;
mod image_arcs;
mod intervals;
mod once;
mod projected_arc;
pub mod sheet;
mod supports;
pub mod svg;

use image_arc::ImageEllipse;
use image_arcs::ArcMaker;
use nalgebra::{Point2, Vector2};
use premio_visibility::camera::projection::{Projection, ViewRay};
use premio_visibility::contours::{Contour, ContourKind, Contours};

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

    /// The layer of a contour.
    pub fn from_contour(contour: &Contour) -> Self {
        match (contour.kind, contour.smooth) {
            (ContourKind::Limb, _) => Self::Limb,
            (ContourKind::Edge, true) => Self::Smooth,
            (ContourKind::Edge, false) => Self::Boundary,
        }
    }

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
pub enum StrokeShape {
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
    pub shape: StrokeShape,
    /// What it shows.
    pub layer: Layer,
    /// Whether nothing hides it.
    pub visible: bool,
}

/// Options of a drawing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DrawingOptions {
    /// Whether hidden lines are drawn too, dashed.
    pub hidden: bool,
    /// Whether smooth edges are drawn.
    pub smooth: bool,
    /// The greatest distance of a polyline from its curve, in image units; none for a fixed share
    /// of the drawing's size.
    pub distance: Option<f64>,
}

impl Default for DrawingOptions {
    fn default() -> Self {
        Self {
            hidden: true,
            smooth: false,
            distance: None,
        }
    }
}

/// The default distance, relative to the drawing's size.
const FINE: f64 = 1.0 / 10_000.0;
/// Lines are one if they are nearer to each other than this share of the drawing's size: on a sheet
/// they have the same digits.
const COINCIDENT: f64 = 1.0 / (1u32 << 22) as f64;

/// A line drawing.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// The strokes, hidden ones first. No two share a stretch.
    pub strokes: Vec<Stroke>,
    /// The lower left and upper right corner of the drawn lines.
    pub extent: [Point2<f64>; 2],
    /// The distance within which polylines follow their curves.
    pub distance: f64,
    /// The distance within which lines are one.
    pub tolerance: f64,
    /// Whether the image is in the part's unit.
    pub to_scale: bool,
}

impl Drawing {
    /// The drawing of contours: every line is drawn once, and is visible where any contour on it
    /// is.
    pub fn new(contours: &Contours, options: &DrawingOptions) -> Self {
        let projection = Projection::new(&contours.camera, 1.0);
        let drawn: Vec<&Contour> = contours
            .contours
            .iter()
            .filter(|c| options.smooth || !c.smooth)
            .collect();
        let extent = extent(&projection, &drawn);
        let size = (extent[1] - extent[0]).norm();
        let magnification = magnification(&projection, &drawn);
        let tolerance = (size * COINCIDENT).max(magnification * contours.resolution);
        let maker = ArcMaker {
            contours,
            projection: &projection,
            distance: options.distance.unwrap_or(size * FINE),
            size,
            tolerance,
        };
        let mut arcs = Vec::new();
        for contour in drawn {
            maker.arcs(contour, &mut arcs);
        }
        arcs.retain(|arc| arc.visible || options.hidden);
        let mut strokes = once::strokes(arcs, tolerance);
        strokes.sort_by_key(|s| s.visible);
        Self {
            strokes,
            extent,
            distance: maker.distance,
            tolerance,
            to_scale: matches!(projection.sight, ViewRay::Direction(_)),
        }
    }
}

/// The number of points of a piece of a contour that are used for the extent.
const PLACES: u32 = 16;

/// A point of a contour.
struct ContourPlace<'c> {
    contour: &'c Contour,
    /// The parameter on its curve.
    t: f64,
}

/// The points of contours from which their extent is computed.
fn places<'c>(contours: &'c [&Contour]) -> impl Iterator<Item = ContourPlace<'c>> {
    let of = |contour: &'c Contour| {
        let pieces = contour.pieces.iter();
        pieces.flat_map(move |piece| {
            let [a, b] = piece.range;
            (0..=PLACES).map(move |k| ContourPlace {
                contour,
                t: a + (b - a) * f64::from(k) / f64::from(PLACES),
            })
        })
    };
    contours.iter().flat_map(move |contour| of(contour))
}

fn extent(projection: &Projection, contours: &[&Contour]) -> [Point2<f64>; 2] {
    let mut lo = Point2::new(f64::INFINITY, f64::INFINITY);
    let mut hi = -lo;
    for ContourPlace { contour, t } in places(contours) {
        let p = projection.project_y_up(&contour.space_curve.point(t));
        lo = lo.inf(&p);
        hi = hi.sup(&p);
    }
    if lo.x > hi.x {
        return [Point2::origin(), Point2::new(1.0, 1.0)];
    }
    [lo, hi]
}

/// The greatest factor from a length in space to one in the image.
fn magnification(projection: &Projection, contours: &[&Contour]) -> f64 {
    let all = places(contours)
        .map(|ContourPlace { contour, t }| projection.magnification(&contour.space_curve.point(t)));
    all.fold(0.0, f64::max)
}

impl StrokeShape {
    /// The point at a fraction from 0 to 1: of the length, on an ellipse of the parameter.
    pub fn point(&self, fraction: f64) -> Point2<f64> {
        match self {
            Self::Line([a, b]) => a + (b - a) * fraction,
            Self::Path(points) => {
                let mut left = fraction * self.length();
                for side in points.windows(2) {
                    let step = (side[1] - side[0]).norm();
                    if left <= step && step > 0.0 {
                        return side[0] + (side[1] - side[0]) * (left / step);
                    }
                    left -= step;
                }
                points.last().copied().unwrap_or_default()
            }
            Self::Ellipse {
                centre,
                major,
                ratio,
                from,
                sweep,
            } => {
                let ellipse = ImageEllipse {
                    centre: *centre,
                    major: *major,
                    ratio: *ratio,
                };
                ellipse.point(from + sweep * fraction)
            }
        }
    }

    /// The length.
    pub fn length(&self) -> f64 {
        match self {
            Self::Line([a, b]) => (b - a).norm(),
            Self::Path(points) => points.windows(2).map(|p| (p[1] - p[0]).norm()).sum(),
            Self::Ellipse {
                major,
                ratio,
                from,
                sweep,
                ..
            } => {
                let long = major.norm();
                let speed = |s: f64| long * s.sin().hypot(ratio * s.cos());
                let step = sweep / f64::from(STEPS);
                // Simpson's rule.
                let at = |k: u32| speed(from + step * f64::from(k));
                let weight = |k: u32| match k {
                    0 | STEPS => 1.0,
                    k if k % 2 == 1 => 4.0,
                    _ => 2.0,
                };
                (0..=STEPS).map(|k| weight(k) * at(k)).sum::<f64>() * step / 3.0
            }
        }
    }
}

/// The number of Simpson steps for the length of arcs of ellipses.
const STEPS: u32 = 512;
