//! The relative position of two surfaces, as distances over the part's extent.
//!
//! Each measure is written once, over any `Enclosable` number. It is evaluated in f64 intervals first,
//! and from the exact coefficients with more bits where those are inconclusive. The constructions
//! use the decisions and compute in f64. Directions need not have unit length.

mod coefficients;
mod elliptic;

use super::region_of_interest::RegionOfInterest;
use super::surface::Surface;
use crate::number::enclosable::Enclosable;
use crate::number::float::Float;
use crate::number::interval::Interval;
use crate::number::predicates::CertifiedDistance;
use crate::number::rational::Rational;
use crate::number::rational_interval::RationalInterval;
use crate::number::separation_bound::SeparationBound;
pub use coefficients::Coefficients;
use coefficients::{SLACK, numbers};
pub use elliptic::ConjugateAxes;

/// The origin of a surface's numbers.
#[derive(Clone, Copy)]
enum Source<'a> {
    /// They are exact.
    Given,
    /// They were rounded from these.
    Rounded(&'a dyn Fn() -> Coefficients<Rational>),
    /// A construction computed them.
    Constructed,
}

/// A surface in f64, with access to its exact coefficients.
#[derive(Clone, Copy)]
pub struct Carrier<'a, N: Float = f64> {
    /// The surface; its numbers are the exact ones, rounded.
    pub(crate) surface: &'a Surface<N>,
    source: Source<'a>,
}

impl<'a, N: Float> Carrier<'a, N> {
    /// A surface whose f64 values are exact.
    pub fn given(surface: &'a Surface<N>) -> Self {
        Self {
            surface,
            source: Source::Given,
        }
    }

    /// A surface that was rounded from exact coefficients.
    pub fn rounded(surface: &'a Surface<N>, exact: &'a dyn Fn() -> Coefficients<Rational>) -> Self {
        Self {
            surface,
            source: Source::Rounded(exact),
        }
    }

    /// A surface computed by a construction. Its position is taken as exact and is not proven.
    pub(crate) fn constructed(surface: &'a Surface<N>) -> Self {
        Self {
            surface,
            source: Source::Constructed,
        }
    }

    /// Ranges that contain the exact coefficients: each number of a surface is within a few units
    /// in the last place, relative to its length.
    fn ranges(&self) -> Coefficients<Interval<N>> {
        numbers(self.surface, |x, size| {
            Interval::around(x, N::from_f64(SLACK) * N::EPSILON * size)
        })
    }

    /// The surface's own numbers.
    pub(crate) fn numbers(&self) -> Coefficients<N> {
        numbers(self.surface, |x, _| x)
    }

    /// The exact coefficients, for computation to so many bits.
    pub(crate) fn computed(&self, bits: usize) -> Coefficients<RationalInterval> {
        self.exact()
            .map(|c| RationalInterval::exact(c.clone(), bits))
    }

    fn exact(&self) -> Coefficients<Rational> {
        let number = |x: N, _| x.exact().unwrap_or_default();
        match self.source {
            Source::Rounded(exact) => exact(),
            Source::Given | Source::Constructed => numbers(self.surface, number),
        }
    }

    fn is_constructed(&self) -> bool {
        matches!(self.source, Source::Constructed)
    }
}

/// A measure of two surfaces, always a distance. Angles are measured by the separation that they
/// cause at the extent's radius.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PairMeasure {
    /// The separation of two surfaces of one kind over the extent; they are identical where it is
    /// zero.
    Apart,
    /// The angle between two directions.
    Drift,
    /// The deviation from a right angle between two normals or axes.
    Lean,
    /// The distance between the points: centres or apexes.
    Between,
    /// The height of the second's point above the first, a plane.
    Height,
    /// The distance of the second's point from the axis of the first.
    OffAxis,
    /// The distance between two parallel axes at the extent's centre.
    BetweenAxes,
    /// The distance between two axes close to the extent's centre, for any angle between them.
    OffLine,
    /// The difference of the radii of two tubes.
    Tubes,
    /// The difference of the second's size and the radius of the first's tube.
    SizeOfTube,
    /// The distance of the outer (`true`) or the inner rim of a torus, the second, from the size of
    /// the first's tube.
    RimOfTube(bool),
    /// The distance of the second's point from the spine of a torus, the first.
    OffSpine,
    /// The angle between the second's axis and the spine of a torus, the first, on which the
    /// second's point lies.
    AcrossSpine,
    /// The gap between a plane and a sphere or an ellipsoid; negative where they intersect.
    PlaneOnBall,
    /// The gap between a cylinder and a plane parallel to its axis.
    PlaneOnCylinder,
    /// The tilt of the circle in which a plane cuts a cylinder across.
    PlaneAcrossCylinder,
    /// The angle by which a plane through a cone's apex misses tangency along a ruling.
    PlaneOnRuling,
    /// The angle between a plane and the nearer (`false`) or the farther ruling of a round cone.
    PlaneAlongRuling(bool),
    /// Two spheres: the gap between them.
    AdjacentSpheres,
    /// Two spheres: the gap by which one contains the other.
    SphereInSphere,
    /// Two parallel cylinders: the gap between them.
    AdjacentCylinders,
    /// Two parallel cylinders: the gap by which one contains the other.
    CylinderInCylinder,
    /// The distance of the second's point from the first: a quadric, of which a cone has both
    /// nappes.
    PointOnQuadric,
    /// The tilt of a plane's normal or an axis against a torus, the first, at its rim.
    Tilt,
    /// The angle between a plane and the axis of a torus, the first, at its rim.
    Upright,
    /// The gap by which a plane through the centre of a torus, the first, misses tangency at two
    /// points.
    PlaneOnBothSides,
    /// The gap between the tube of a torus, the first, and the profile of a coaxial surface: the
    /// line of a plane, a cylinder or a cone.
    LineOnTube,
    /// The distance between the centres of the tube and of the coaxial sphere or the other tube, in
    /// the profile.
    BetweenTubes,
    /// The gap between the tube and the coaxial sphere or the other tube.
    NextToTube,
    /// The gap by which one of them contains the other.
    InTube,
}

fn minus<R: Enclosable>(a: &[R; 3], b: &[R; 3]) -> [R; 3] {
    [0, 1, 2].map(|i| a[i].clone() - b[i].clone())
}

fn dot<R: Enclosable>(a: &[R; 3], b: &[R; 3]) -> R {
    let [x, y, z] = [0, 1, 2].map(|i| a[i].clone() * b[i].clone());
    x + y + z
}

fn cross<R: Enclosable>(a: &[R; 3], b: &[R; 3]) -> [R; 3] {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| a[i].clone() * b[j].clone() - a[j].clone() * b[i].clone())
}

fn norm<R: Enclosable>(a: &[R; 3]) -> R {
    dot(a, a).sqrt()
}

/// The coefficients of both surfaces, and the extent.
struct Over<R> {
    a: Coefficients<R>,
    b: Coefficients<R>,
    centre: [R; 3],
    radius: R,
}

impl<R: Enclosable> Over<R> {
    /// The sine of the angle between the directions.
    fn sine(&self) -> R {
        let (a, b) = (&self.a.direction, &self.b.direction);
        norm(&cross(a, b)).over(norm(a) * norm(b))
    }

    /// The cosine of the angle between the directions.
    fn cosine(&self) -> R {
        let (a, b) = (&self.a.direction, &self.b.direction);
        dot(a, b).over(norm(a) * norm(b))
    }

    /// The vector from the first's point to the second's.
    fn away(&self) -> [R; 3] {
        minus(&self.b.point, &self.a.point)
    }

    /// The component of a vector along the first's direction.
    fn along(&self, v: &[R; 3]) -> R {
        dot(v, &self.a.direction).over(norm(&self.a.direction))
    }

    /// The length of a vector's component perpendicular to the first's direction.
    fn across(&self, v: &[R; 3]) -> R {
        norm(&cross(v, &self.a.direction)).over(norm(&self.a.direction))
    }

    /// The point of the second's axis at the height of the extent's centre.
    fn foot(&self) -> [R; 3] {
        let d = &self.b.direction;
        let up = dot(&minus(&self.centre, &self.b.point), d).over(dot(d, d));
        [0, 1, 2].map(|i| self.b.point[i].clone() + d[i].clone() * up.clone())
    }

    /// The distance of parallel axes, measured at the extent's centre.
    fn between_axes(&self) -> R {
        self.across(&minus(&self.foot(), &self.a.point))
    }

    /// The distance of the second's point from the first's spine.
    fn off_spine(&self) -> R {
        let away = self.away();
        let (out, up) = (self.across(&away) - self.a.size.clone(), self.along(&away));
        (out.clone() * out + up.clone() * up).sqrt()
    }

    /// The sine of the angle between the second's axis and the first's spine at the second's point.
    fn across_spine(&self) -> R {
        let along = cross(&self.a.direction, &self.away());
        let d = &self.b.direction;
        norm(&cross(&along, d)).over(norm(&along) * norm(d))
    }

    /// The sine and the cosine of a cone's half angle.
    fn half_angle(tangent: &R) -> (R, R) {
        let square = tangent.clone() * tangent.clone();
        let cos = R::constant(1.0).over((R::constant(1.0) + square).sqrt());
        (tangent.clone() * cos.clone(), cos)
    }

    /// The gap between two circles outside one another; `between` is the distance of their centres.
    fn outer_gap(between: R, [r, s]: [R; 2]) -> R {
        between - (r + s)
    }

    /// The gap by which one of two circles contains the other.
    fn within(between: R, [r, s]: [R; 2]) -> R {
        (r - s).abs() - between
    }

    fn sizes(&self) -> [R; 2] {
        [self.a.size.clone(), self.b.size.clone()]
    }

    /// The outer radius of the torus, the first: spine plus tube.
    fn rim(&self) -> R {
        self.a.size.clone() + self.a.tube.clone()
    }

    /// The radius of the tube and that of the other circle in the profile.
    fn profile<N: Float>(&self, other: &Surface<N>) -> [R; 2] {
        let radius = match other {
            Surface::Torus(_) => &self.b.tube,
            _ => &self.b.size,
        };
        [self.a.tube.clone(), radius.clone()]
    }

    /// The distance between the centres of the tube and of the other circle in the profile.
    fn between_tubes<N: Float>(&self, other: &Surface<N>) -> R {
        let out = match other {
            Surface::Torus(_) => self.a.size.clone() - self.b.size.clone(),
            _ => self.a.size.clone(),
        };
        let up = self.along(&self.away());
        (out.clone() * out + up.clone() * up).sqrt()
    }

    /// The distance of the tube's centre from the line of the other's profile.
    fn line_on_tube<N: Float>(&self, other: &Surface<N>) -> R {
        let up = self.along(&self.away());
        let off = match other {
            Surface::Cylinder(_) => self.b.size.clone() - self.a.size.clone(),
            Surface::Cone(_) => {
                let (sin, cos) = Self::half_angle(&self.b.size);
                self.a.size.clone() * self.cosine() * cos + up * sin
            }
            _ => up,
        };
        off.abs() - self.a.tube.clone()
    }

    /// The separation of two surfaces of the same kind.
    fn apart<N: Float>(&self, kind: &Surface<N>) -> R {
        let between = norm(&self.away());
        let drift = self.sine() * self.radius.clone();
        let sizes = (self.a.size.clone() - self.b.size.clone()).abs();
        match kind {
            Surface::Plane(_) => self.between_planes().abs() + drift,
            Surface::Cylinder(_) => self.between_axes() + drift + sizes,
            Surface::Cone(_) => between + drift + self.half_angles().abs(),
            Surface::Sphere(_) => between + sizes,
            Surface::Torus(_) => {
                let tubes = (self.a.tube.clone() - self.b.tube.clone()).abs();
                between + self.sine() * self.a.size.clone() + sizes + tubes
            }
            Surface::EllipticCylinder(_) | Surface::EllipticCone(_) | Surface::Ellipsoid(_) => {
                self.elliptic_apart(kind)
            }
        }
    }

    /// The separation of two elliptic surfaces of the same kind.
    fn elliptic_apart<N: Float>(&self, kind: &Surface<N>) -> R {
        let (Some(first), Some(second)) = (&self.a.axes, &self.b.axes) else {
            return norm(&self.away());
        };
        match kind {
            Surface::EllipticCone(_) => {
                norm(&self.away()) + elliptic::cones_apart(first, second) * self.radius.clone()
            }
            Surface::Ellipsoid(_) => norm(&self.away()) + elliptic::ellipsoids_apart(first, second),
            _ => {
                let drift = self.sine() * self.radius.clone();
                self.between_axes() + drift + elliptic::sections_apart(first, second)
            }
        }
    }

    /// Half the width of a cylinder, the second, along the normal of a plane, the first.
    fn half_width(&self) -> R {
        match &self.b.axes {
            Some(axes) => elliptic::half_width(axes, &self.a.direction),
            None => self.b.size.clone(),
        }
    }

    /// Half the width of a sphere or an ellipsoid, the second, along the normal of a plane, the first.
    fn half_width_of_ball(&self) -> R {
        match &self.b.axes {
            Some(axes) => elliptic::half_width_of_ellipsoid(axes, &self.a.direction),
            None => self.b.size.clone(),
        }
    }

    fn half_angles(&self) -> R {
        let (sin, cos) = Self::half_angle(&self.a.size);
        let (sine, cosine) = Self::half_angle(&self.b.size);
        (sin * cosine - cos * sine) * self.radius.clone()
    }

    fn between_planes(&self) -> R {
        let n = &self.a.direction;
        let up = dot(&minus(&self.centre, &self.a.point), n).over(dot(n, n));
        let foot = [0, 1, 2].map(|i| self.centre[i].clone() - n[i].clone() * up.clone());
        dot(&minus(&foot, &self.b.point), &self.b.direction).over(norm(&self.b.direction))
    }

    /// The distance of two axes at the extent's centre, less the separation that their angle allows
    /// over the distance from there.
    fn off_line(&self) -> R {
        let away = self.away();
        let to_centre = minus(&self.centre, &self.a.point);
        let along = (self.along(&to_centre) - self.along(&away)).abs();
        self.across(&away) - self.sine() * along
    }

    fn plane_on_ruling(&self) -> R {
        if let Some(axes) = &self.b.axes {
            return elliptic::off_tangency(axes, &self.a.direction) * self.radius.clone();
        }
        let (sin, cos) = Self::half_angle(&self.b.size);
        (self.cosine().abs() * cos - self.sine() * sin) * self.radius.clone()
    }

    fn plane_along_ruling(&self, far: bool) -> R {
        let (sin, cos) = Self::half_angle(&self.b.size);
        let (up, out) = (self.cosine() * cos, self.sine() * sin);
        let rate = if far { up - out } else { up + out };
        rate * self.radius.clone()
    }

    fn point_on_quadric<N: Float>(&self, quadric: &Surface<N>) -> R {
        let away = self.away();
        if let Some(axes) = &self.a.axes {
            return elliptic::distance(axes, &away, quadric);
        }
        match quadric {
            Surface::Sphere(_) => norm(&away) - self.a.size.clone(),
            Surface::Cone(_) => {
                let (sin, cos) = Self::half_angle(&self.a.size);
                self.across(&away) * cos - self.along(&away).abs() * sin
            }
            _ => self.across(&away) - self.a.size.clone(),
        }
    }

    fn distance<N: Float>(&self, relation: PairMeasure, [first, second]: [&Surface<N>; 2]) -> R {
        let (a, b) = (&self.a, &self.b);
        match relation {
            PairMeasure::Apart => self.apart(first),
            PairMeasure::Drift => self.sine() * self.radius.clone(),
            PairMeasure::Lean => self.cosine() * self.radius.clone(),
            PairMeasure::Between => norm(&self.away()),
            PairMeasure::Height => self.along(&self.away()),
            PairMeasure::OffAxis => self.across(&self.away()),
            PairMeasure::BetweenAxes => self.between_axes(),
            PairMeasure::OffLine => self.off_line(),
            PairMeasure::Tubes => a.tube.clone() - b.tube.clone(),
            PairMeasure::SizeOfTube => b.size.clone() - a.tube.clone(),
            PairMeasure::RimOfTube(outer) => {
                let rim = match outer {
                    true => b.size.clone() + b.tube.clone(),
                    false => b.size.clone() - b.tube.clone(),
                };
                rim - a.tube.clone()
            }
            PairMeasure::OffSpine => self.off_spine(),
            PairMeasure::AcrossSpine => self.across_spine() * self.radius.clone(),
            PairMeasure::PlaneOnBall => self.along(&self.away()).abs() - self.half_width_of_ball(),
            PairMeasure::PlaneOnCylinder => {
                self.along(&minus(&self.foot(), &a.point)).abs() - self.half_width()
            }
            PairMeasure::PlaneAcrossCylinder => self.sine() * b.size.clone(),
            PairMeasure::PlaneOnRuling => self.plane_on_ruling(),
            PairMeasure::PlaneAlongRuling(far) => self.plane_along_ruling(far),
            PairMeasure::AdjacentSpheres => Self::outer_gap(norm(&self.away()), self.sizes()),
            PairMeasure::SphereInSphere => Self::within(norm(&self.away()), self.sizes()),
            PairMeasure::AdjacentCylinders => Self::outer_gap(self.between_axes(), self.sizes()),
            PairMeasure::CylinderInCylinder => Self::within(self.between_axes(), self.sizes()),
            PairMeasure::PointOnQuadric => self.point_on_quadric(first),
            PairMeasure::Tilt => self.sine() * self.rim(),
            PairMeasure::Upright => self.cosine() * self.rim(),
            PairMeasure::PlaneOnBothSides => self.sine() * a.size.clone() - a.tube.clone(),
            PairMeasure::LineOnTube => self.line_on_tube(second),
            PairMeasure::BetweenTubes => self.between_tubes(second),
            PairMeasure::NextToTube => {
                Self::outer_gap(self.between_tubes(second), self.profile(second))
            }
            PairMeasure::InTube => Self::within(self.between_tubes(second), self.profile(second)),
        }
    }
}

/// Two carriers and the part's extent.
#[derive(Clone, Copy)]
pub struct SurfacePair<'a, N: Float = f64> {
    /// The first.
    pub(crate) a: Carrier<'a, N>,
    /// The second.
    pub(crate) b: Carrier<'a, N>,
    /// The extent.
    pub(crate) extent: &'a RegionOfInterest<N>,
}

impl<'a, N: Float> SurfacePair<'a, N> {
    /// Two carriers in the order in which the measures name them.
    pub fn new(a: Carrier<'a, N>, b: Carrier<'a, N>, extent: &'a RegionOfInterest<N>) -> Self {
        Self { a, b, extent }
    }

    /// The pair with its surfaces swapped.
    pub(crate) fn turned(&self) -> Self {
        Self {
            a: self.b,
            b: self.a,
            extent: self.extent,
        }
    }

    /// The measure in f64. It is accurate enough to exclude what is far from any decision.
    pub fn estimate(&self, relation: PairMeasure) -> N {
        let [a, b] = [&self.a, &self.b].map(|c| c.numbers());
        How {
            pair: *self,
            relation,
        }
        .over(a, b, |x| x)
    }

    /// The measure, certified.
    pub fn how(&self, relation: PairMeasure) -> impl CertifiedDistance + use<'a, N> {
        How {
            pair: *self,
            relation,
        }
    }
}

/// A measure of a pair, evaluated on demand.
struct How<'a, N: Float> {
    pair: SurfacePair<'a, N>,
    relation: PairMeasure,
}

impl<N: Float> How<'_, N> {
    fn over<R: Enclosable>(
        &self,
        a: Coefficients<R>,
        b: Coefficients<R>,
        of: impl Fn(N) -> R,
    ) -> R {
        let &RegionOfInterest { centre, radius } = self.pair.extent;
        let over = Over {
            a,
            b,
            centre: <[N; 3]>::from(centre).map(&of),
            radius: of(radius),
        };
        over.distance(self.relation, [self.pair.a.surface, self.pair.b.surface])
    }
}

impl<N: Float> CertifiedDistance for How<'_, N> {
    fn range(&self) -> Interval {
        let [a, b] = [&self.pair.a, &self.pair.b].map(Carrier::ranges);
        self.over(a, b, Interval::point).to_f64()
    }

    fn refined(&self, bits: usize) -> Option<RationalInterval> {
        let [a, b] = [&self.pair.a, &self.pair.b].map(|c| c.computed(bits));
        let exact = |x: N| RationalInterval::exact(x.exact().unwrap_or_default(), bits);
        Some(self.over(a, b, exact))
    }

    fn separation(&self) -> Option<usize> {
        let carriers = [&self.pair.a, &self.pair.b];
        if carriers.iter().any(|c| c.is_constructed()) {
            return None;
        }
        let [a, b] = carriers.map(|c| c.exact().map(exact_separation));
        let exact = |x: N| SeparationBound::exact(x.exact().unwrap_or_default());
        self.over(a, b, exact).bits()
    }
}

fn exact_separation(x: &Rational) -> SeparationBound {
    SeparationBound::exact(x.clone())
}
