//! Curves in space, as polylines in the image that keep their parameters.

use nalgebra::{Point2, Point3};

/// The greatest distance of a polyline from its curve, in pixels: the mixture of both sides in a
/// pixel is then correct to one percent.
pub const FINE: f64 = 1.0 / 64.0;
/// The fraction of a range at which a curve is tested besides its middle.
const ASIDE: f64 = 0.21;
/// The most times that a range is halved.
const DEEPEST: u32 = 14;

/// A polyline in the image.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Polyline {
    /// Its points in pixels.
    pub points: Vec<[f64; 2]>,
    /// The parameter of the curve at each.
    pub parameters: Vec<f64>,
    /// The depth at each along the optical axis.
    pub depths: Vec<f64>,
}

/// The window of the image within which a polyline has to be fine.
#[derive(Clone, Copy, Debug)]
pub struct ImageWindow {
    /// Its least corner in pixels.
    pub min: [f64; 2],
    /// Its greatest.
    pub max: [f64; 2],
}

impl ImageWindow {
    /// An image with this many pixels, and some beyond.
    pub fn new([width, height]: [usize; 2]) -> Self {
        let margin = 32.0;
        Self {
            min: [-margin; 2],
            max: [width as f64 + margin, height as f64 + margin],
        }
    }

    /// Whether the box of two points, grown by `by`, intersects it.
    fn intersects(&self, a: &[f64; 2], b: &[f64; 2], by: f64) -> bool {
        (0..2).all(|i| a[i].min(b[i]) - by <= self.max[i] && a[i].max(b[i]) + by >= self.min[i])
    }
}

/// The projection of a point of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProjectedPoint {
    /// Its image in pixels.
    pub image: Point2<f64>,
    /// Its depth along the optical axis.
    pub depth: f64,
}

/// How fine a polyline has to be, and where.
#[derive(Clone, Copy, Debug)]
pub struct FlatteningTolerance<'w> {
    /// The greatest distance from the curve in pixels.
    pub fine: f64,
    /// Where this distance matters.
    pub window: &'w ImageWindow,
}

/// A point of a polyline. Points are ordered along the polyline.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct PolylinePoint {
    /// The index of the segment.
    pub segment: usize,
    /// The fraction along the segment.
    pub fraction: f64,
}

/// The point of a polyline that is nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestPoint {
    /// The point.
    pub at: PolylinePoint,
    /// The squared distance from the given point, in square pixels.
    pub square: f64,
}

/// The point of a segment that is nearest to a given point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestOnSegment {
    /// The fraction along the segment, from 0 to 1.
    pub fraction: f64,
    /// The squared distance from the given point.
    pub square: f64,
}

/// A point of a curve with its parameter.
#[derive(Clone, Copy)]
struct CurvePoint {
    t: f64,
    shown: ProjectedPoint,
}

/// The image of `curve` over a range. A straight one has two points; another is halved until it is
/// as fine as required. None where a point of it cannot be projected.
pub fn flatten(
    curve: impl Fn(f64) -> Option<ProjectedPoint>,
    [from, to]: [f64; 2],
    straight: bool,
    tolerance: FlatteningTolerance<'_>,
) -> Option<Polyline> {
    let mut line = Polyline::default();
    line.push(from, curve(from)?);
    let pieces = if straight { 1 } else { 8 };
    for k in 1..=pieces {
        let t = from + (to - from) * (f64::from(k) / f64::from(pieces));
        let end = CurvePoint {
            t,
            shown: curve(t)?,
        };
        let start = line.last()?;
        if !straight {
            halve(&curve, [start, end], DEEPEST, tolerance, &mut line)?;
        }
        line.push(t, end.shown);
    }
    Some(line)
}

/// Adds the points between two of a curve that are needed to be within `fine`.
fn halve(
    curve: &impl Fn(f64) -> Option<ProjectedPoint>,
    [a, b]: [CurvePoint; 2],
    deeper: u32,
    tolerance: FlatteningTolerance<'_>,
    line: &mut Polyline,
) -> Option<()> {
    if deeper == 0 {
        return Some(());
    }
    let FlatteningTolerance { fine, window } = tolerance;
    let at = |part: f64| a.t + (b.t - a.t) * part;
    let t = at(0.5);
    let middle = CurvePoint {
        t,
        shown: curve(t)?,
    };
    let [p, q] = [a.shown.image, b.shown.image];
    let off = |r: &Point2<f64>| off_chord(&[p.x, p.y], &[q.x, q.y], &[r.x, r.y]);
    let mut bend = off(&middle.shown.image);
    if bend <= fine {
        // A curve with an inflection may have its middle on its chord.
        bend = bend.max(off(&curve(at(ASIDE))?.image));
    }
    let is_near = window.intersects(&[p.x, p.y], &[q.x, q.y], 4.0 * bend);
    if bend <= fine || !is_near {
        // The point is known: it makes the polyline finer by a factor of four.
        line.push(t, middle.shown);
        return Some(());
    }
    halve(curve, [a, middle], deeper - 1, tolerance, line)?;
    line.push(t, middle.shown);
    halve(curve, [middle, b], deeper - 1, tolerance, line)
}

/// The distance of a point from a segment.
pub fn off_chord(a: &[f64; 2], b: &[f64; 2], p: &[f64; 2]) -> f64 {
    let s = nearest_on(a, b, p).fraction;
    let at = [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
    (p[0] - at[0]).hypot(p[1] - at[1])
}

/// The point of a segment that is nearest to `p`.
pub fn nearest_on(a: &[f64; 2], b: &[f64; 2], p: &[f64; 2]) -> NearestOnSegment {
    let d = [b[0] - a[0], b[1] - a[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let along = (p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1];
    let s = if square > 0.0 {
        (along / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [a[0] + s * d[0] - p[0], a[1] + s * d[1] - p[1]];
    NearestOnSegment {
        fraction: s,
        square: off[0] * off[0] + off[1] * off[1],
    }
}

impl Polyline {
    /// Adds a point at its end.
    pub(crate) fn add(&mut self, t: f64, [x, y]: [f64; 2], depth: f64) {
        let image = Point2::new(x, y);
        self.push(t, ProjectedPoint { image, depth });
    }

    fn push(&mut self, t: f64, shown: ProjectedPoint) {
        self.points.push([shown.image.x, shown.image.y]);
        self.parameters.push(t);
        self.depths.push(shown.depth);
    }

    fn last(&self) -> Option<CurvePoint> {
        let i = self.points.len().checked_sub(1)?;
        let [x, y] = self.points[i];
        Some(CurvePoint {
            t: self.parameters[i],
            shown: ProjectedPoint {
                image: Point2::new(x, y),
                depth: self.depths[i],
            },
        })
    }

    /// The segments, each by its end points.
    pub(crate) fn segments(&self) -> impl Iterator<Item = (usize, [[f64; 2]; 2])> + '_ {
        self.points.windows(2).map(|w| [w[0], w[1]]).enumerate()
    }

    /// Its length in pixels.
    pub(crate) fn length(&self) -> f64 {
        self.segments()
            .map(|(_, [a, b])| (b[0] - a[0]).hypot(b[1] - a[1]))
            .sum()
    }

    /// The parameter at a point: equal steps in space have shorter images the deeper they are.
    pub(crate) fn parameter(&self, at: PolylinePoint) -> f64 {
        let (i, s) = (at.segment, at.fraction);
        let [z0, z1] = [self.depths[i], self.depths[i + 1]];
        let [t0, t1] = [self.parameters[i], self.parameters[i + 1]];
        let share = s * z0 / ((1.0 - s) * z1 + s * z0);
        match share.is_finite() {
            true => t0 + (t1 - t0) * share,
            false => t0 + (t1 - t0) * s,
        }
    }

    /// The position of a point.
    pub(crate) fn position(&self, at: PolylinePoint) -> [f64; 2] {
        let (i, s) = (at.segment, at.fraction);
        let [a, b] = [self.points[i], self.points[i + 1]];
        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
    }

    /// The point at a length along the polyline, in pixels; the end beyond.
    pub(crate) fn place_at(&self, along: f64) -> PolylinePoint {
        let mut left = along.max(0.0);
        for (i, [a, b]) in self.segments() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if left <= length && length > 0.0 {
                return PolylinePoint {
                    segment: i,
                    fraction: left / length,
                };
            }
            left -= length;
        }
        PolylinePoint {
            segment: self.points.len().saturating_sub(2),
            fraction: 1.0,
        }
    }

    /// The parameter at a length along it, in pixels.
    pub(crate) fn parameter_at(&self, along: f64) -> f64 {
        self.parameter(self.place_at(along))
    }

    /// The position at a length along it, in pixels.
    pub(crate) fn point_at(&self, along: f64) -> [f64; 2] {
        self.position(self.place_at(along))
    }

    /// The point nearest to a given one.
    pub(crate) fn nearest(&self, p: &[f64; 2]) -> Option<NearestPoint> {
        let mut best: Option<NearestPoint> = None;
        for (i, [a, b]) in self.segments() {
            let NearestOnSegment { fraction, square } = nearest_on(&a, &b, p);
            if best.is_none_or(|known| square < known.square) {
                let at = PolylinePoint {
                    segment: i,
                    fraction,
                };
                best = Some(NearestPoint { at, square });
            }
        }
        best
    }

    /// The depth at a point.
    fn depth(&self, at: PolylinePoint) -> f64 {
        let (i, s) = (at.segment, at.fraction);
        1.0 / ((1.0 - s) / self.depths[i] + s / self.depths[i + 1])
    }

    /// Inserts the position of a point of the curve.
    pub(crate) fn insert(&mut self, at: PolylinePoint, p: [f64; 2]) {
        let t = self.parameter(at);
        let depth = self.depth(at);
        let i = at.segment;
        self.points.insert(i + 1, p);
        self.parameters.insert(i + 1, t);
        self.depths.insert(i + 1, depth);
    }

    /// The part from one point to another.
    pub(crate) fn part(&self, from: PolylinePoint, to: PolylinePoint) -> Self {
        let mut part = Self::default();
        let mut add = |place: PolylinePoint| {
            let [x, y] = self.position(place);
            part.add(self.parameter(place), [x, y], self.depth(place));
        };
        add(from);
        for segment in from.segment + 1..=to.segment {
            let start = PolylinePoint {
                segment,
                fraction: 0.0,
            };
            if start > from && start < to {
                add(start);
            }
        }
        add(to);
        part
    }

    /// The point at half its length.
    pub(crate) fn middle(&self) -> Option<PolylinePoint> {
        let mut left = 0.5 * self.length();
        for (i, [a, b]) in self.segments() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length >= left && length > 0.0 {
                return Some(PolylinePoint {
                    segment: i,
                    fraction: left / length,
                });
            }
            left -= length;
        }
        (self.points.len() > 1).then_some(PolylinePoint {
            segment: 0,
            fraction: 0.5,
        })
    }
}

/// The projection of a point in space.
pub fn shown(
    projection: &premio_visibility::camera::projection::Projection,
    p: &Point3<f64>,
) -> ProjectedPoint {
    ProjectedPoint {
        image: projection.project(p),
        depth: projection.scale(p),
    }
}
