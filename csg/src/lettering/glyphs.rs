//! The contours of a glyph: lines and Bézier curves.

use super::PIXEL;
use crate::figure::FigurePoint;
use premio_kernel::number::rational::{Rational, to_f64};
use skrifa::outline::OutlinePen;

/// The parts of a unit of the font in which points are kept.
pub(super) const HALVES: i32 = 2;

/// A point in halves of the units of the font.
type UnitPoint = [i32; 2];

/// A piece of a contour, from the end of the last one.
#[derive(Debug, Clone)]
enum GlyphSegment {
    Line(UnitPoint),
    Quadratic([UnitPoint; 2]),
    Cubic([UnitPoint; 3]),
}

impl GlyphSegment {
    /// Its control points, of which the last one is its end.
    fn points(&self) -> &[UnitPoint] {
        match self {
            Self::Line(end) => std::slice::from_ref(end),
            Self::Quadratic(points) => points,
            Self::Cubic(points) => points,
        }
    }
}

/// A contour: its start and its segments.
#[derive(Debug, Clone)]
struct GlyphContour {
    start: UnitPoint,
    segments: Vec<GlyphSegment>,
}

/// The contours of a glyph.
#[derive(Debug, Clone, Default)]
pub(super) struct Glyph {
    contours: Vec<GlyphContour>,
    /// The outline units of a unit of the font.
    scale: Rational,
}

impl Glyph {
    /// The box of its control points in outline units, rounded outwards to whole pixels; `None` if it
    /// is empty.
    pub fn pixels(&self) -> Option<[[i32; 2]; 2]> {
        let all = self.contours.iter().flat_map(|contour| {
            let segments = contour.segments.iter().flat_map(GlyphSegment::points);
            std::iter::once(&contour.start).chain(segments)
        });
        let bounds = all.fold(None, |bounds: Option<[UnitPoint; 2]>, p| {
            let [lo, hi] = bounds.unwrap_or([*p; 2]);
            Some([
                [lo[0].min(p[0]), lo[1].min(p[1])],
                [hi[0].max(p[0]), hi[1].max(p[1])],
            ])
        });
        let [lo, hi] = bounds?;
        let scaled =
            |x: i32| to_f64(&Rational::from((Rational::from(x) * &self.scale).round())) as i32;
        let down = |x: i32| x.div_euclid(PIXEL) * PIXEL;
        let bounds = [lo.map(|x| down(scaled(x))), hi.map(|x| -down(-scaled(x)))];
        let has_area = (0..2).all(|i| bounds[0][i] != bounds[1][i]);
        has_area.then_some(bounds)
    }

    /// Its contours as polygons in outline units: a curve has a number of segments of equal
    /// parameter.
    pub fn polygons(&self, segments: u32) -> Vec<Vec<FigurePoint>> {
        let contours = self.contours.iter().map(|contour| {
            let mut corners = vec![self.scaled(exact(&contour.start))];
            let mut from = contour.start;
            for segment in &contour.segments {
                let points = segment.points();
                let count = if points.len() > 1 { segments } else { 1 };
                for k in 1..=count {
                    let t = Rational::from(k) / Rational::from(count);
                    corners.push(self.scaled(on_curve(&from, points, &t)));
                }
                from = points[points.len() - 1];
            }
            corners
        });
        contours.collect()
    }
}

impl Glyph {
    fn scaled(&self, p: FigurePoint) -> FigurePoint {
        p.map(|x| x * &self.scale)
    }
}

fn exact(p: &UnitPoint) -> FigurePoint {
    p.map(Rational::from)
}

/// The point of a Bézier curve at a parameter (de Casteljau 1959).
fn on_curve(from: &UnitPoint, points: &[UnitPoint], t: &Rational) -> FigurePoint {
    let mut all: Vec<FigurePoint> = std::iter::once(from).chain(points).map(exact).collect();
    while all.len() > 1 {
        let between = all
            .windows(2)
            .map(|pair| std::array::from_fn(|i| &pair[0][i] + (&pair[1][i] - &pair[0][i]) * t));
        all = between.collect();
    }
    all.remove(0)
}

/// Collects the contours of a glyph.
#[derive(Debug, Default)]
pub(super) struct GlyphPen {
    contours: Vec<GlyphContour>,
}

impl GlyphPen {
    /// The glyph, of which a unit has so many outline units.
    pub fn glyph(self, scale: &Rational) -> Glyph {
        let mut contours = self.contours;
        contours.retain(|contour| !contour.segments.is_empty());
        let scale = scale.clone();
        Glyph { contours, scale }
    }

    fn add(&mut self, segment: GlyphSegment) {
        if let Some(contour) = self.contours.last_mut() {
            contour.segments.push(segment);
        }
    }
}

/// A point in the units of the font, of which the midpoints between control points may be halves.
fn units(x: f32, y: f32) -> UnitPoint {
    [x, y].map(|x| (x * HALVES as f32).round() as i32)
}

impl OutlinePen for GlyphPen {
    fn move_to(&mut self, x: f32, y: f32) {
        self.contours.push(GlyphContour {
            start: units(x, y),
            segments: Vec::new(),
        });
    }

    fn line_to(&mut self, x: f32, y: f32) {
        self.add(GlyphSegment::Line(units(x, y)));
    }

    fn quad_to(&mut self, cx: f32, cy: f32, x: f32, y: f32) {
        self.add(GlyphSegment::Quadratic([units(cx, cy), units(x, y)]));
    }

    fn curve_to(&mut self, cx0: f32, cy0: f32, cx1: f32, cy1: f32, x: f32, y: f32) {
        let points = [units(cx0, cy0), units(cx1, cy1), units(x, y)];
        self.add(GlyphSegment::Cubic(points));
    }

    fn close(&mut self) {}
}
