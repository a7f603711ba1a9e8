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

/// The projection of a point of a curve: its image in pixels and its depth.
pub type Shown = (Point2<f64>, f64);

/// The image of `curve` over a range. A straight one has two points; another is halved until it is
/// within `fine` in the window. None where a point of it cannot be projected.
pub fn flatten(
    curve: impl Fn(f64) -> Option<Shown>,
    [from, to]: [f64; 2],
    straight: bool,
    (fine, window): (f64, &ImageWindow),
) -> Option<Polyline> {
    let mut line = Polyline::default();
    line.push(from, curve(from)?);
    let pieces = if straight { 1 } else { 8 };
    for k in 1..=pieces {
        let t = from + (to - from) * (f64::from(k) / f64::from(pieces));
        let end = curve(t)?;
        let start = line.last()?;
        if !straight {
            halve(
                &curve,
                [start, (t, end)],
                DEEPEST,
                (fine, window),
                &mut line,
            )?;
        }
        line.push(t, end);
    }
    Some(line)
}

/// Adds the points between two of a curve that are needed to be within `fine`.
fn halve(
    curve: &impl Fn(f64) -> Option<Shown>,
    [a, b]: [(f64, Shown); 2],
    deeper: u32,
    (fine, window): (f64, &ImageWindow),
    line: &mut Polyline,
) -> Option<()> {
    if deeper == 0 {
        return Some(());
    }
    let at = |part: f64| a.0 + (b.0 - a.0) * part;
    let t = at(0.5);
    let middle = curve(t)?;
    let [p, q] = [a.1.0, b.1.0];
    let off = |r: &Point2<f64>| off_chord(&[p.x, p.y], &[q.x, q.y], &[r.x, r.y]);
    let mut bend = off(&middle.0);
    if bend <= fine {
        // A curve with an inflection may have its middle on its chord.
        bend = bend.max(off(&curve(at(ASIDE))?.0));
    }
    let is_near = window.intersects(&[p.x, p.y], &[q.x, q.y], 4.0 * bend);
    if bend <= fine || !is_near {
        // The point is known: it makes the polyline finer by a factor of four.
        line.push(t, middle);
        return Some(());
    }
    halve(curve, [a, (t, middle)], deeper - 1, (fine, window), line)?;
    line.push(t, middle);
    halve(curve, [(t, middle), b], deeper - 1, (fine, window), line)
}

/// The distance of a point from a segment.
pub fn off_chord(a: &[f64; 2], b: &[f64; 2], p: &[f64; 2]) -> f64 {
    let (s, _) = nearest_on(a, b, p);
    let at = [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])];
    (p[0] - at[0]).hypot(p[1] - at[1])
}

/// The fraction along a segment of the point nearest to `p`, from 0 to 1, with its squared
/// distance.
pub fn nearest_on(a: &[f64; 2], b: &[f64; 2], p: &[f64; 2]) -> (f64, f64) {
    let d = [b[0] - a[0], b[1] - a[1]];
    let square = d[0] * d[0] + d[1] * d[1];
    let along = (p[0] - a[0]) * d[0] + (p[1] - a[1]) * d[1];
    let s = if square > 0.0 {
        (along / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let off = [a[0] + s * d[0] - p[0], a[1] + s * d[1] - p[1]];
    (s, off[0] * off[0] + off[1] * off[1])
}

impl Polyline {
    /// Adds a point at its end.
    pub fn add(&mut self, t: f64, [x, y]: [f64; 2], depth: f64) {
        self.push(t, (Point2::new(x, y), depth));
    }

    fn push(&mut self, t: f64, (p, depth): Shown) {
        self.points.push([p.x, p.y]);
        self.parameters.push(t);
        self.depths.push(depth);
    }

    fn last(&self) -> Option<(f64, Shown)> {
        let i = self.points.len().checked_sub(1)?;
        let [x, y] = self.points[i];
        Some((self.parameters[i], (Point2::new(x, y), self.depths[i])))
    }

    /// The segments, each by its end points.
    pub fn segments(&self) -> impl Iterator<Item = (usize, [[f64; 2]; 2])> + '_ {
        self.points.windows(2).map(|w| [w[0], w[1]]).enumerate()
    }

    /// Its length in pixels.
    pub fn length(&self) -> f64 {
        self.segments()
            .map(|(_, [a, b])| (b[0] - a[0]).hypot(b[1] - a[1]))
            .sum()
    }

    /// The parameter at a fraction `s` of the segment `i`: equal steps in space have shorter images
    /// the deeper they are.
    pub fn parameter(&self, i: usize, s: f64) -> f64 {
        let [z0, z1] = [self.depths[i], self.depths[i + 1]];
        let [t0, t1] = [self.parameters[i], self.parameters[i + 1]];
        let share = s * z0 / ((1.0 - s) * z1 + s * z0);
        match share.is_finite() {
            true => t0 + (t1 - t0) * share,
            false => t0 + (t1 - t0) * s,
        }
    }

    /// The point at a fraction `s` of the segment `i`.
    pub fn at(&self, i: usize, s: f64) -> [f64; 2] {
        let [a, b] = [self.points[i], self.points[i + 1]];
        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
    }

    /// The segment and the fraction of it at a length along the polyline, in pixels; the end
    /// beyond.
    pub fn place_at(&self, along: f64) -> (usize, f64) {
        let mut left = along.max(0.0);
        for (i, [a, b]) in self.segments() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if left <= length && length > 0.0 {
                return (i, left / length);
            }
            left -= length;
        }
        (self.points.len().saturating_sub(2), 1.0)
    }

    /// The parameter at a length along it, in pixels.
    pub fn parameter_at(&self, along: f64) -> f64 {
        let (i, s) = self.place_at(along);
        self.parameter(i, s)
    }

    /// The point at a length along it, in pixels.
    pub fn point_at(&self, along: f64) -> [f64; 2] {
        let (i, s) = self.place_at(along);
        self.at(i, s)
    }

    /// The segment nearest to a point and the fraction of it, with the squared distance.
    pub fn nearest(&self, p: &[f64; 2]) -> Option<(usize, f64, f64)> {
        let mut best: Option<(usize, f64, f64)> = None;
        for (i, [a, b]) in self.segments() {
            let (s, square) = nearest_on(&a, &b, p);
            if best.is_none_or(|known| square < known.2) {
                best = Some((i, s, square));
            }
        }
        best
    }

    /// Inserts a point of the curve into the segment `i`, at a fraction `s` of it.
    pub fn insert(&mut self, i: usize, s: f64, p: [f64; 2]) {
        let t = self.parameter(i, s);
        let depth = 1.0 / ((1.0 - s) / self.depths[i] + s / self.depths[i + 1]);
        self.points.insert(i + 1, p);
        self.parameters.insert(i + 1, t);
        self.depths.insert(i + 1, depth);
    }

    /// The part from one point to another, each a segment with a fraction of it.
    pub fn part(&self, from: (usize, f64), to: (usize, f64)) -> Self {
        let mut part = Self::default();
        let depth =
            |(i, s): (usize, f64)| 1.0 / ((1.0 - s) / self.depths[i] + s / self.depths[i + 1]);
        let mut add = |place: (usize, f64)| {
            let [x, y] = self.at(place.0, place.1);
            let t = self.parameter(place.0, place.1);
            part.push(t, (Point2::new(x, y), depth(place)));
        };
        add(from);
        for i in from.0 + 1..=to.0 {
            if (i, 0.0) > from && (i, 0.0) < to {
                add((i, 0.0));
            }
        }
        add(to);
        part
    }

    /// The point at half its length, as a segment and a fraction of it.
    pub fn middle(&self) -> Option<(usize, f64)> {
        let mut left = 0.5 * self.length();
        for (i, [a, b]) in self.segments() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if length >= left && length > 0.0 {
                return Some((i, left / length));
            }
            left -= length;
        }
        (self.points.len() > 1).then_some((0, 0.5))
    }
}

/// The projection of a point in space.
pub fn shown(
    projection: &premio_visibility::camera::projection::Projection,
    p: &Point3<f64>,
) -> Shown {
    (projection.project(p), projection.scale(p))
}
