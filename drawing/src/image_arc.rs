//! Arcs in the image that do not fold back on themselves: segments, arcs of ellipses, and arcs of
//! projected curves.

use super::StrokeShape;
use super::projected_arc::{Nearest, ProjectedArc};
use nalgebra::{Matrix3, Point2, Vector2};
use std::f64::consts::TAU;

/// An ellipse: centre + cos s major + sin s minor, the minor half axis to the left of the major
/// one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImageEllipse {
    /// The centre.
    pub centre: Point2<f64>,
    /// The longer half axis, of the parameter 0.
    pub major: Vector2<f64>,
    /// The ratio of the other half axis.
    pub ratio: f64,
}

impl ImageEllipse {
    /// The image of the unit circle (cos t, sin t, 1) under a map to homogeneous coordinates; none
    /// where that is another conic.
    ///
    /// Notation: m1, m2, m3 are the columns of the map. C* = m1 m1ᵀ + m2 m2ᵀ - m3 m3ᵀ is the dual
    /// conic. Its last column is the centre. About the centre, its first four elements over the
    /// last one are the sum of the outer squares of the half axes. Unlike the coefficients of the
    /// point conic, it keeps its digits where the ellipse is thin.
    pub fn from_map(map: &Matrix3<f64>) -> Option<Self> {
        let tangents = |m: &Matrix3<f64>| {
            let product = |i: usize| m.column(i) * m.column(i).transpose();
            product(0) + product(1) - product(2)
        };
        let dual = tangents(map);
        let last = dual[(2, 2)];
        if last >= 0.0 {
            return None;
        }
        let centre = Point2::new(dual[(0, 2)] / last, dual[(1, 2)] / last);
        let shift = Matrix3::new_translation(&-centre.coords);
        let about = tangents(&(shift * map));
        let squares = |i: usize, j: usize| -about[(i, j)] / about[(2, 2)];
        let [a, b, c] = [squares(0, 0), squares(0, 1), squares(1, 1)];
        // a + c and a c - b² are the sum and the product of the squared half axes.
        let long = 0.5 * (a + c) + (0.5 * (a - c)).hypot(b);
        let short = (a * c - b * b) / long;
        let turn = 0.5 * (2.0 * b).atan2(a - c);
        let is_ellipse = long > 0.0 && short > 0.0 && long.is_finite();
        is_ellipse.then(|| Self {
            centre,
            major: Vector2::new(turn.cos(), turn.sin()) * long.sqrt(),
            ratio: (short / long).sqrt(),
        })
    }

    /// The ellipse of the six coefficients a x² + b x y + c y² + d x + e y + f = 0; none for other
    /// conics.
    pub fn from_coefficients(&[a, b, c, d, e, f]: &[f64; 6]) -> Option<Self> {
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
        (long.is_finite() && short.is_finite()).then(|| Self {
            centre: Point2::new(x, y),
            major: Vector2::new(turn.cos(), turn.sin()) * long,
            ratio: short / long,
        })
    }

    fn minor(&self) -> Vector2<f64> {
        Vector2::new(-self.major.y, self.major.x) * self.ratio
    }

    /// The point with a parameter.
    pub fn point(&self, s: f64) -> Point2<f64> {
        self.centre + self.major * s.cos() + self.minor() * s.sin()
    }

    /// The coordinates of a point in units of the half axes.
    fn coordinates(&self, p: &Point2<f64>) -> Vector2<f64> {
        let (d, minor) = (p - self.centre, self.minor());
        let along = |axis: &Vector2<f64>| d.dot(axis) / axis.norm_squared();
        Vector2::new(along(&self.major), along(&minor))
    }

    /// The parameter of a point on the ellipse.
    pub fn angle(&self, p: &Point2<f64>) -> f64 {
        let q = self.coordinates(p);
        q.y.atan2(q.x)
    }

    /// The distance of a point from the ellipse, to first order.
    pub fn distance(&self, p: &Point2<f64>) -> f64 {
        let q = self.coordinates(p);
        let (long, short) = (self.major.norm(), self.major.norm() * self.ratio);
        let slope = 2.0 * (q.x / long).hypot(q.y / short);
        (q.norm_squared() - 1.0).abs() / slope
    }
}

/// An arc in the image, with a parameter over a range.
#[derive(Clone)]
pub enum ImageArc<'c> {
    /// A straight segment; the parameter runs from 0 to 1.
    Segment([Point2<f64>; 2]),
    /// An arc of an ellipse, by its parameters.
    Elliptic {
        /// The ellipse.
        ellipse: ImageEllipse,
        /// The parameters, increasing by at most one turn.
        range: [f64; 2],
    },
    /// The projection of an arc in space, by its parameter.
    Projected(ProjectedArc<'c>),
}

impl ImageArc<'_> {
    /// The range of the parameter.
    pub fn range(&self) -> [f64; 2] {
        match self {
            Self::Segment(_) => [0.0, 1.0],
            Self::Elliptic { range, .. } => *range,
            Self::Projected(arc) => arc.range(),
        }
    }

    /// The point with a parameter.
    pub fn point(&self, t: f64) -> Point2<f64> {
        match self {
            Self::Segment([a, b]) => a + (b - a) * t,
            Self::Elliptic { ellipse, .. } => ellipse.point(t),
            Self::Projected(arc) => arc.point(t),
        }
    }

    /// Both ends.
    pub fn ends(&self) -> [Point2<f64>; 2] {
        self.range().map(|t| self.point(t))
    }

    /// The length, of a projected curve that of its polyline.
    pub fn length(&self) -> f64 {
        match self {
            Self::Segment([a, b]) => (b - a).norm(),
            Self::Elliptic { ellipse, range } => {
                // Ramanujan's approximation: it only determines which arc is longer.
                let (a, b) = (ellipse.major.norm(), ellipse.major.norm() * ellipse.ratio);
                let around = 3.0 * (a + b) - ((3.0 * a + b) * (a + 3.0 * b)).sqrt();
                0.5 * around * (range[1] - range[0])
            }
            Self::Projected(arc) => arc.length(),
        }
    }

    /// The parameters at fractions of the length between two parameters, approximately. Over a
    /// projected curve's parameter the speed may change by any factor.
    pub fn at_lengths<const N: usize>(&self, [lo, hi]: [f64; 2], parts: [f64; N]) -> [f64; N] {
        match self {
            Self::Projected(arc) => arc.at_lengths([lo, hi], parts),
            Self::Segment(_) | Self::Elliptic { .. } => parts.map(|part| lo + (hi - lo) * part),
        }
    }

    /// The approximate greatest distance of its points from its start.
    pub fn reach(&self) -> f64 {
        let [lo, hi] = self.range();
        let start = self.point(lo);
        let places = match self {
            Self::Projected(arc) => arc.samples().iter().map(|s| s.point).collect(),
            _ => vec![self.point(0.5 * (lo + hi)), self.point(hi)],
        };
        let away = places.iter().map(|p| (p - start).norm());
        away.fold(0.0, f64::max)
    }

    /// A bound of the distance between a projected curve and its polyline, from the angles between
    /// samples.
    pub fn deviation(&self) -> f64 {
        match self {
            Self::Projected(arc) => arc.deviation(),
            Self::Segment(_) | Self::Elliptic { .. } => 0.0,
        }
    }

    /// The lower left and the upper right corner of a box that contains the arc's polyline or
    /// ellipse.
    pub fn bounds(&self) -> [Point2<f64>; 2] {
        match self {
            Self::Segment([a, b]) => [a.inf(b), a.sup(b)],
            Self::Elliptic { ellipse, .. } => {
                let (m, n) = (ellipse.major, ellipse.minor());
                let reach = Vector2::new(m.x.hypot(n.x), m.y.hypot(n.y));
                [ellipse.centre - reach, ellipse.centre + reach]
            }
            Self::Projected(arc) => {
                let samples = arc.samples();
                let first = samples[0].point;
                let all = samples.iter().map(|s| s.point);
                all.fold([first, first], |[lo, hi], p| [lo.inf(&p), hi.sup(&p)])
            }
        }
    }

    /// The point of the arc that is nearest to `p`.
    pub fn nearest(&self, p: &Point2<f64>) -> Nearest {
        match self {
            Self::Segment([a, b]) => {
                let d = b - a;
                let t = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
                self.at(t, p)
            }
            Self::Elliptic { ellipse, range } => {
                let [lo, hi] = *range;
                let s = lo + (ellipse.angle(p) - lo).rem_euclid(TAU);
                // Beyond the end, the nearer of both ends.
                let ends = [lo, hi].map(|t| self.at(t, p));
                let end = match ends[0].distance <= ends[1].distance {
                    true => ends[0],
                    false => ends[1],
                };
                let inside = Nearest {
                    t: s,
                    distance: ellipse.distance(p),
                };
                match s <= hi && inside.distance <= end.distance {
                    true => inside,
                    false => end,
                }
            }
            Self::Projected(arc) => arc.nearest(p),
        }
    }

    /// The point that is nearest to another, if it is within a distance.
    pub fn nearest_within(&self, p: &Point2<f64>, distance: f64) -> Option<Nearest> {
        // A search on the curve takes far longer than one on its polyline.
        let is_projected = matches!(self, Self::Projected(_));
        if is_projected && self.approximate_distance(p) > distance + self.deviation() {
            return None;
        }
        Some(self.nearest(p)).filter(|near| near.distance <= distance)
    }

    fn at(&self, t: f64, p: &Point2<f64>) -> Nearest {
        Nearest {
            t,
            distance: (self.point(t) - p).norm(),
        }
    }

    /// The distance of a point from the arc's polyline, or from the arc where it is a segment or
    /// elliptic.
    pub fn approximate_distance(&self, p: &Point2<f64>) -> f64 {
        match self {
            Self::Projected(arc) => arc.approximate_distance(p),
            Self::Segment(_) | Self::Elliptic { .. } => self.nearest(p).distance,
        }
    }

    /// The arc over a part of its range.
    #[must_use]
    pub fn part(&self, [lo, hi]: [f64; 2]) -> Self {
        match self {
            Self::Segment(_) => Self::Segment([self.point(lo), self.point(hi)]),
            Self::Elliptic { ellipse, .. } => Self::Elliptic {
                ellipse: *ellipse,
                range: [lo, hi],
            },
            Self::Projected(arc) => Self::Projected(arc.part([lo, hi])),
        }
    }

    /// The shape of the arc.
    pub fn shape(&self) -> StrokeShape {
        match self {
            Self::Segment(ends) => StrokeShape::Line(*ends),
            Self::Elliptic { ellipse, range } => StrokeShape::Ellipse {
                centre: ellipse.centre,
                major: ellipse.major,
                ratio: ellipse.ratio,
                from: range[0],
                sweep: (range[1] - range[0]).min(TAU),
            },
            Self::Projected(arc) => {
                let samples = arc.samples();
                StrokeShape::Path(samples.iter().map(|s| s.point).collect())
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::projected_arc::Sample;
    use super::*;
    use nalgebra::Vector3;
    use std::rc::Rc;

    fn ellipse() -> ImageEllipse {
        ImageEllipse {
            centre: Point2::new(1.0, 2.0),
            major: Vector2::new(3.0, 4.0),
            ratio: 0.4,
        }
    }

    /// (x - 1)²/9 + (y + 2)²/4 = 1.
    #[test]
    fn an_ellipse_has_its_half_axes() {
        let six = [4.0, 0.0, 9.0, -8.0, 36.0, 4.0];
        let found = ImageEllipse::from_coefficients(&six).unwrap();
        assert!((found.centre - Point2::new(1.0, -2.0)).norm() < 1e-12);
        assert!((found.major.norm() - 3.0).abs() < 1e-12 && found.major.y.abs() < 1e-12);
        assert!((found.ratio - 2.0 / 3.0).abs() < 1e-12);
        assert!(ImageEllipse::from_coefficients(&[1.0, 0.0, -1.0, 0.0, 0.0, -1.0]).is_none());
    }

    /// A circle about (50, 40) seen so obliquely that its half axes are 2 and 2/1024.
    #[test]
    fn a_thin_ellipse_keeps_its_digits() {
        let (sin, cos) = 0.7f64.sin_cos();
        let ratio = 1.0 / 1024.0;
        let map = Matrix3::new(
            2.0 * cos,
            -2.0 * ratio * sin,
            50.0,
            2.0 * sin,
            2.0 * ratio * cos,
            40.0,
            0.0,
            0.0,
            1.0,
        );
        let found = ImageEllipse::from_map(&map).unwrap();
        assert!((found.centre - Point2::new(50.0, 40.0)).norm() < 1e-12);
        assert!((found.major - Vector2::new(cos, sin) * 2.0).norm() < 1e-9);
        assert!((found.ratio / ratio - 1.0).abs() < 1e-8);
        // In perspective: the points are those of the map.
        let tilted = Matrix3::new(1.0, 0.2, 3.0, 0.1, 0.7, -2.0, 0.05, -0.1, 1.0);
        let found = ImageEllipse::from_map(&tilted).unwrap();
        for k in 0..12 {
            let t = f64::from(k);
            let h = tilted * Vector3::new(t.cos(), t.sin(), 1.0);
            assert!(found.distance(&Point2::new(h.x / h.z, h.y / h.z)) < 1e-12);
        }
        let beyond = Matrix3::new(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 2.0, 0.0, 1.0);
        assert!(ImageEllipse::from_map(&beyond).is_none());
    }

    #[test]
    fn what_lies_on_an_arc_is_found_there() {
        let ellipse = ellipse();
        let elliptic = ImageArc::Elliptic {
            ellipse,
            range: [5.0, 8.0],
        };
        let samples = (0..=40).map(|k| {
            let t = 5.0 + 3.0 * f64::from(k) / 40.0;
            let point = ellipse.point(t);
            Sample { t, point }
        });
        let curve = Rc::new(move |t| ellipse.point(t));
        let projected = ImageArc::Projected(ProjectedArc::new(curve, samples.collect()));
        for arc in [elliptic, projected] {
            for t in [5.0, 5.3, 6.9, 7.77, 8.0] {
                let found = arc.nearest(&ellipse.point(t));
                assert!((found.t - t).abs() < 1e-6, "{t} {found:?}");
                assert!(found.distance < 1e-7);
            }
            // Beyond the end the end is the nearest.
            let found = arc.nearest(&ellipse.point(8.2));
            assert!((found.t - 8.0).abs() < 1e-6 && found.distance > 0.1);
        }
    }
}
