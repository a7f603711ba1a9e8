//! Splines that approximate a curve within a stated distance, in space and in the parameters of
//! surfaces.
//!
//! Notation: s is the length along the curve, T its unit tangent, K its curvature vector. At each
//! knot the spline interpolates the curve's point, T and K, so it is C² and its pieces are quintic
//! Hermite. With knots at arc lengths its error is proportional to the sixth power of the knot
//! distance (Farin, Curves and Surfaces for CAGD, 2002, chapters 7 and 8).

use crate::parameters::ParameterWindow;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::jet::Jet;

/// The degree of all splines.
pub const DEGREE: usize = 5;

/// A spline of degree [`DEGREE`] with simple continuity C²: the knots between the ends count three
/// times, the ends six times.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline<const D: usize> {
    /// The distinct knots, increasing.
    pub knots: Vec<f64>,
    /// The control points.
    pub points: Vec<[f64; D]>,
}

/// The splines of one edge, over the same parameter.
#[derive(Clone, Debug, PartialEq)]
pub struct BezierSegments {
    /// In space.
    pub space: Spline<3>,
    /// In the parameters of each surface.
    pub on: Vec<Spline<2>>,
}

/// Why a curve cannot be approximated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SplineError {
    /// It needs too many pieces.
    #[error(
        "a curve next to ({:?}, {:?}, {:?}) takes more than {limit} pieces of a spline",
        place[0],
        place[1],
        place[2]
    )]
    TooMany {
        /// The location.
        place: [f64; 3],
        /// The largest number of pieces.
        limit: usize,
    },
    /// The curve jumps, so no spline with finite pieces connects its points.
    #[error("a curve jumps next to ({:?}, {:?}, {:?})", place[0], place[1], place[2])]
    Jump {
        /// The location.
        place: [f64; 3],
    },
}

/// The largest number of pieces of a spline.
const LIMIT: usize = 1 << 14;

/// The number of samples, less one, at which a piece is compared with the curve and the surfaces.
const PLACES: u32 = 8;

/// Additional samples close to the ends of a piece, where an angle may change rapidly close to an
/// axis.
const GRADED: [f64; 3] = [1.0 / 256.0, 1.0 / 64.0, 1.0 / 20.0];

/// A sample of the curve.
#[derive(Clone, Debug)]
struct Node {
    t: f64,
    space: [Jet<f64>; 3],
    on: Vec<[Jet<f64>; 2]>,
}

/// A quintic piece from the data at its ends, which are `length` apart.
struct Piece<'a, const D: usize> {
    ends: [&'a [Jet<f64>; D]; 2],
    length: f64,
}

impl<const D: usize> Piece<'_, D> {
    /// Its Bézier points.
    fn bezier(&self) -> [[f64; D]; 6] {
        let [a, b] = self.ends;
        let h = self.length;
        let each = |f: &dyn Fn(usize) -> f64| std::array::from_fn(f);
        [
            each(&|i| a[i].v),
            each(&|i| a[i].v + h * a[i].d / 5.0),
            each(&|i| a[i].v + h * (2.0 * a[i].d / 5.0 + h * a[i].dd / 20.0)),
            each(&|i| b[i].v - h * (2.0 * b[i].d / 5.0 - h * b[i].dd / 20.0)),
            each(&|i| b[i].v - h * b[i].d / 5.0),
            each(&|i| b[i].v),
        ]
    }

    /// The point at a fraction of its length, by de Casteljau's algorithm.
    fn at(&self, part: f64) -> [f64; D] {
        let mut points = self.bezier();
        for n in (0..DEGREE).rev() {
            for k in 0..=n {
                points[k] = std::array::from_fn(|i| {
                    points[k][i] + part * (points[k + 1][i] - points[k][i])
                });
            }
        }
        points[0]
    }
}

impl<const D: usize> Spline<D> {
    fn through(knots: Vec<f64>, nodes: &[&[Jet<f64>; D]]) -> Self {
        let pieces: Vec<[[f64; D]; 6]> = nodes
            .windows(2)
            .zip(knots.windows(2))
            .map(|(n, k)| {
                let piece = Piece {
                    ends: [n[0], n[1]],
                    length: k[1] - k[0],
                };
                piece.bezier()
            })
            .collect();
        let mut points = Vec::with_capacity(3 * pieces.len() + 3);
        points.extend(pieces.first().map(|b| [b[0], b[1]]).into_iter().flatten());
        for (k, b) in pieces.iter().enumerate() {
            points.extend([b[2], b[3]]);
            // The blossom at the knot before, three times at the joint, and the knot after.
            if let Some([before, at, after]) = knots.get(k..k + 3) {
                let on = (after - at) / (at - before);
                points.push(std::array::from_fn(|i| b[4][i] + on * (b[4][i] - b[3][i])));
            } else {
                points.extend([b[4], b[5]]);
            }
        }
        Self { knots, points }
    }

    /// The multiplicity of each knot.
    pub fn multiplicities(&self) -> impl Iterator<Item = usize> {
        let last = self.knots.len() - 1;
        (0..=last).map(move |k| match k == 0 || k == last {
            true => DEGREE + 1,
            false => DEGREE - 2,
        })
    }
}

/// The parameterisation of a spline.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Pace {
    /// The length along the curve, from the start.
    Length,
    /// The curve's own parameter, for a curve that is written exactly.
    Parameter,
}

/// A curve to be approximated.
pub(crate) struct Follow<'a> {
    /// The splines' parameterisation.
    pub pace: Pace,
    /// The curve.
    pub curve: &'a Curve,
    /// The parameters at both ends.
    pub range: [f64; 2],
    /// The surfaces that contain it.
    pub windows: &'a [ParameterWindow],
    /// The largest distance of the splines from the curve and from each surface.
    pub accuracy: f64,
}

impl Follow<'_> {
    /// The splines.
    pub fn course(&self) -> Result<BezierSegments, SplineError> {
        let lo = self.range[0];
        let breaks = self.breaks();
        let first = [breaks[0], breaks[1]];
        let mut nodes = vec![self.node(first, lo, None)];
        for pair in breaks.windows(2) {
            let smooth = [pair[0], pair[1]];
            let end = self.node(smooth, pair[1], nodes.last());
            let mut waiting = vec![end];
            // Depth first: `waiting` has the ends of pieces, the next one on top.
            while let (Some(start), Some(end)) = (nodes.last(), waiting.pop()) {
                if self.follows(start, &end) {
                    nodes.push(end);
                    continue;
                }
                if nodes.len() + waiting.len() > LIMIT {
                    let place = self.curve.point(start.t).into();
                    return Err(SplineError::TooMany {
                        place,
                        limit: LIMIT,
                    });
                }
                let middle = self.node(smooth, 0.5 * (start.t + end.t), Some(start));
                let end = self.nearest_equivalent(end, &middle);
                waiting.extend([end, middle]);
            }
        }
        self.align(&mut nodes);
        let mut knots = match self.pace {
            Pace::Length => vec![0.0],
            Pace::Parameter => vec![lo],
        };
        for pair in nodes.windows(2) {
            let last = knots[knots.len() - 1];
            let next = last + self.length(pair[0].t, pair[1].t);
            if !next.is_finite() || next <= last {
                let place = self.curve.point(pair[0].t).into();
                return Err(SplineError::Jump { place });
            }
            knots.push(next);
        }
        let on = (0..self.windows.len()).map(|k| {
            let on: Vec<&[Jet<f64>; 2]> = nodes.iter().map(|n| &n.on[k]).collect();
            Spline::through(knots.clone(), &on)
        });
        let space: Vec<&[Jet<f64>; 3]> = nodes.iter().map(|n| &n.space).collect();
        Ok(BezierSegments {
            on: on.collect(),
            space: Spline::through(knots.clone(), &space),
        })
    }

    /// The ends of the smooth pieces of the curve, apart so far that the knots of a spline there are
    /// distinct for its readers.
    fn breaks(&self) -> Vec<f64> {
        let [lo, hi] = self.range;
        let all = self.curve.breaks(lo, hi);
        let apart = APART * (hi - lo);
        let inner = all.into_iter().filter(|t| t - lo > apart && hi - t > apart);
        let mut breaks: Vec<f64> = std::iter::once(lo).chain(inner).collect();
        breaks.dedup_by(|b, a| *b - *a <= apart);
        breaks.push(hi);
        breaks
    }

    /// Shifts the parameters into their windows.
    fn align(&self, nodes: &mut [Node]) {
        for (k, window) in self.windows.iter().enumerate() {
            for i in 0..2 {
                let middle = &nodes[nodes.len() / 2].on[k][i];
                let shift = window.shift(i, middle.v);
                for node in nodes.iter_mut() {
                    node.on[k][i].v += shift;
                }
            }
        }
    }

    /// The node with parameters shifted to be closest to another's.
    fn nearest_equivalent(&self, mut node: Node, other: &Node) -> Node {
        for (k, window) in self.windows.iter().enumerate() {
            for i in 0..2 {
                let near = other.on[k][i].v;
                node.on[k][i].v = window.nearest_equivalent(i, node.on[k][i].v, near);
            }
        }
        node
    }

    /// The node at a parameter of a smooth piece of the curve.
    fn node(&self, smooth: [f64; 2], t: f64, before: Option<&Node>) -> Node {
        let inner = self.inner(smooth, t);
        let space = self.space(t, inner);
        let near = self.space(inner, self.inner(smooth, inner));
        let windows = self.windows.iter();
        let on = windows.map(|w| self.on(w, space, near)).collect();
        let node = Node { t, space, on };
        match before {
            Some(other) => self.nearest_equivalent(node, other),
            None => node,
        }
    }

    /// The point, T and K. Where the curve's speed vanishes they are those of its chord to the parameter
    /// `inner`.
    fn space(&self, t: f64, inner: f64) -> [Jet<f64>; 3] {
        if self.pace == Pace::Parameter {
            return self.curve.jet(t);
        }
        let p = self.curve.point(t);
        let d = self.curve.derivative(t);
        let chord = (self.curve.point(inner) - p) * (inner - t).signum();
        let moves = d.norm() * (inner - t).abs();
        let (tangent, bend) = match moves > STILL * chord.norm() && !self.curve.turns_back(t) {
            true => (d.normalize(), self.curve.curvature(t)),
            false => (chord.normalize(), Vector3::zeros()),
        };
        std::array::from_fn(|i| Jet {
            v: p[i],
            d: tangent[i],
            dd: bend[i],
        })
    }

    /// A parameter close to `t`, towards the middle of a smooth piece: beyond the piece's end the curve
    /// may have turned.
    fn inner(&self, [from, to]: [f64; 2], t: f64) -> f64 {
        let [lo, hi] = self.range;
        let toward = match t < 0.5 * (from + to) {
            true => 1.0,
            false => -1.0,
        };
        t + toward * (INNER * (hi - lo)).min(0.25 * (to - from))
    }

    /// The parameters on a surface as functions of the length. On the surface's axis they are
    /// extrapolated by a Taylor series from a point nearby.
    fn on(
        &self,
        window: &ParameterWindow,
        space: [Jet<f64>; 3],
        near: [Jet<f64>; 3],
    ) -> [Jet<f64>; 2] {
        let step = (0..3)
            .map(|i| (space[i].v - near[i].v).powi(2))
            .sum::<f64>()
            .sqrt();
        let is_moderate = |on: &[Jet<f64>; 2]| {
            let turns = |x: &Jet<f64>| (x.d.abs() + step * x.dd.abs()) * step;
            matches!(window.surface, Surface::Plane(_)) || turns(&on[0]) <= STILL
        };
        if let Some(on) = window.along(space).filter(is_moderate) {
            return on;
        }
        let Some(on) = window.along(near) else {
            return [Jet::constant(0.0); 2];
        };
        let along = |f: &dyn Fn(usize) -> f64| (0..3).map(f).sum::<f64>();
        let away =
            along(&|i| (space[i].v - near[i].v) * near[i].d) / along(&|i| near[i].d * near[i].d);
        on.map(|x| Jet {
            v: x.v + away * (x.d + 0.5 * away * x.dd),
            d: x.d + away * x.dd,
            dd: x.dd,
        })
    }

    /// The length of the curve between two parameters, by five-point Gauss quadrature.
    fn length(&self, a: f64, b: f64) -> f64 {
        if self.pace == Pace::Parameter {
            return b - a;
        }
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let at = |x: f64| self.curve.speed(middle + half * x);
        let sum: f64 = GAUSS.iter().map(|[x, w]| w * (at(*x) + at(-*x))).sum();
        half * (sum + CENTRE * at(0.0))
    }

    /// Whether the splines between two nodes are within the accuracy: of the curve, at the same parameter
    /// if it is written exactly.
    fn follows(&self, a: &Node, b: &Node) -> bool {
        let length = self.length(a.t, b.t);
        let space = Piece {
            ends: [&a.space, &b.space],
            length,
        };
        let even = (1..PLACES).map(|k| f64::from(k) / f64::from(PLACES));
        let graded = GRADED.iter().flat_map(|&part| [part, 1.0 - part]);
        even.chain(graded).all(|part| {
            let p = Point3::from(space.at(part));
            let near = |q: &Point3<f64>| (p - q).norm() <= self.accuracy;
            let on_surfaces = self.windows.iter().enumerate().all(|(i, window)| {
                let piece = Piece {
                    ends: [&a.on[i], &b.on[i]],
                    length,
                };
                window.surface.distance(&p).abs() <= self.accuracy
                    && near(&window.point(piece.at(part)))
            });
            let on_curve = match self.pace {
                Pace::Length => self.nearest(&p, [a.t, b.t], part),
                Pace::Parameter => self.curve.point(a.t + part * (b.t - a.t)),
            };
            on_surfaces && near(&on_curve)
        })
    }

    /// The closest point of the curve between two parameters, starting at a fraction of that range.
    fn nearest(&self, p: &Point3<f64>, [a, b]: [f64; 2], part: f64) -> Point3<f64> {
        let mut t = a + part * (b - a);
        for _ in 0..4 {
            let d = self.curve.derivative(t);
            let step = (p - self.curve.point(t)).dot(&d) / d.norm_squared();
            if !step.is_finite() {
                break;
            }
            t = (t + step).clamp(a, b);
        }
        self.curve.point(t)
    }
}

/// The least distance of the ends of smooth pieces, relative to the range.
const APART: f64 = 1.0 / (1 << 30) as f64;

/// The distance from its ends, relative to the range, at which the curve is evaluated in their
/// place.
const INNER: f64 = 1.0 / (1 << 16) as f64;

/// The ratio of a curve's speed to that close by below which the speed counts as zero.
const STILL: f64 = 1.0 / 16.0;

/// The nodes and weights of Gauss's rule, without the middle one.
const GAUSS: [[f64; 2]; 2] = [
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
    [0.906_179_845_938_664, 0.236_926_885_056_189_08],
];
/// The weight of the middle node.
const CENTRE: f64 = 128.0 / 225.0;

#[cfg(test)]
mod tests;
