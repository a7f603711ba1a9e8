//! Surface-surface intersection: all components of the curve, with their singular points.
//!
//! Whether two surfaces are parallel, coaxial, tangent or equal in radius is measured as a distance
//! over the part's extent and decided by the [`Predicates`]. The constructions use the decisions.

mod contact;
mod ellipsoid;
mod elliptic;
mod plane;
mod quadric;
mod rulings;
mod sphere;
mod torus;

use super::curve::Curve;
use super::frame::Frame;
use super::region_of_interest::RegionOfInterest;
use super::surface::{Surface, SurfaceKind, Torus};
use super::surface_pair::{Carrier, PairMeasure, SurfacePair};
use super::trace::BranchPosition;
use super::unresolved::Unresolved;
use super::vector::rounded as place;
use crate::geometry::sense::Sense;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::function::Function;
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::predicates::Predicates;
use crate::number::roots::{Roots, isolate};
use contact::meridian;
use nalgebra::Point3;

/// One component of an intersection.
#[derive(Clone, Debug, PartialEq)]
pub struct Branch<N: Float = f64> {
    /// The curve.
    pub curve: Curve<N>,
    /// The range of its parameter.
    pub range: [N; 2],
    /// Whether the range is one whole period of a closed curve.
    pub closed: bool,
    /// Whether the surfaces are tangent along all of it.
    pub tangent: bool,
}

impl<N: Float> Branch<N> {
    /// A parameter of the curve, moved to an end of the range that it passes by rounding or a
    /// whole period only.
    fn in_range(&self, t: N) -> N {
        let Some(period) = self.curve.period().filter(|_| !self.closed) else {
            return t;
        };
        let [lo, hi] = self.range;
        let turned = [-period, N::ZERO, period].map(|turn| t + turn);
        let clamped = turned.map(|t| (t, t.max(lo).min(hi)));
        let away = |(t, end): &(N, N)| (*t - *end).abs();
        let best = clamped
            .into_iter()
            .min_by(|a, b| away(a).total_cmp(&away(b)));
        best.map_or(t, |(_, end)| end)
    }
}

/// A singular point of an intersection: a self-crossing, a cusp or an isolated point.
#[derive(Clone, Debug, PartialEq)]
pub struct Node<N: Float = f64> {
    /// The location.
    pub point: Point3<N>,
    /// The branches through it; empty for an isolated point.
    pub on: Vec<BranchPosition<N>>,
}

/// The intersection of two surfaces.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SurfaceIntersection<N: Float = f64> {
    /// The curves.
    pub branches: Vec<Branch<N>>,
    /// The singular points.
    pub nodes: Vec<Node<N>>,
}

/// Why an intersection is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum IntersectionError {
    /// The curve has a singular point of an unknown kind.
    #[error("two surfaces intersect in a curve with a singular point of an unknown kind, {0}")]
    Toric(#[from] Unresolved),
    /// Two quadrics intersect in a curve with a cusp.
    #[error("two quadrics intersect in a curve with a cusp near ({:.6}, {:.6}, {:.6})", place[0], place[1], place[2])]
    Cusp {
        /// The approximate location of the cusp.
        place: [f64; 3],
    },
    /// Two quadrics intersect in a curve that the precision does not determine.
    #[error("two quadrics intersect in a curve that the rounding does not determine near ({:.6}, {:.6}, {:.6})", place[0], place[1], place[2])]
    Undetermined {
        /// A point of one of them.
        place: [f64; 3],
    },
}

impl<N: Float> SurfaceIntersection<N> {
    fn nothing() -> Self {
        Self::default()
    }

    fn touch(point: Point3<N>) -> Self {
        Self {
            branches: Vec::new(),
            nodes: vec![Node {
                point,
                on: Vec::new(),
            }],
        }
    }

    /// Adds a whole curve, clipped to the extent.
    fn add(&mut self, curve: Curve<N>, tangent: bool, extent: &RegionOfInterest<N>) {
        if let Some(range) = curve.range_within(&extent.centre, extent.radius) {
            let closed = curve.period().is_some();
            self.branches.push(Branch {
                curve,
                range,
                closed,
                tangent,
            });
        }
    }

    /// Adds the circle of a torus's tube at the angle θ, or the part of it from pole to pole.
    fn add_meridian(
        &mut self,
        torus: &Torus<N>,
        theta: N,
        tangent: bool,
        extent: &RegionOfInterest<N>,
    ) {
        let added = self.branches.len();
        self.add(Curve::Circle(meridian(torus, theta)), tangent, extent);
        let end = torus.pole_angle();
        if end >= N::PI {
            return;
        }
        for branch in &mut self.branches[added..] {
            branch.range = [-end, end];
            branch.closed = false;
        }
    }

    /// Adds a singular point, with its parameter on each branch through it.
    fn cross_at(&mut self, point: Point3<N>, predicates: &Predicates) {
        let on = self.branches.iter().enumerate();
        let on = on.map(|(i, branch)| BranchPosition {
            branch: i,
            t: branch.in_range(branch.curve.parameter(&point)),
        });
        let passed = |on: &BranchPosition<N>| {
            let there = self.branches[on.branch].curve.point(on.t);
            predicates.within((there - point).length())
        };
        let on = on.filter(passed).collect();
        self.nodes.push(Node { point, on });
    }
}

/// The intersection curves of two distinct surfaces within the extent.
///
/// # Errors
/// The intersection has a cusp or a singular point of an unknown kind.
pub fn intersect<N: Float>(
    a: Carrier<'_, N>,
    b: Carrier<'_, N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    use Surface as S;
    let pair = SurfacePair::new(a, b, extent);
    let turned = pair.turned();
    Ok(match (a.surface, b.surface) {
        (S::Plane(p), S::Plane(q)) => plane::plane_plane(p, q, &pair, predicates),
        (S::Plane(p), S::Sphere(s)) => plane::plane_sphere(p, s, &pair, predicates),
        (S::Sphere(s), S::Plane(p)) => plane::plane_sphere(p, s, &turned, predicates),
        (S::Plane(p), S::Cylinder(c)) => plane::plane_cylinder(p, c, &pair, predicates),
        (S::Cylinder(c), S::Plane(p)) => plane::plane_cylinder(p, c, &turned, predicates),
        (S::Plane(p), S::Cone(c)) => plane::plane_cone(p, c, &pair, predicates),
        (S::Cone(c), S::Plane(p)) => plane::plane_cone(p, c, &turned, predicates),
        (S::Plane(p), S::EllipticCylinder(c)) => {
            elliptic::plane_elliptic_cylinder(p, c, &pair, predicates)
        }
        (S::EllipticCylinder(c), S::Plane(p)) => {
            elliptic::plane_elliptic_cylinder(p, c, &turned, predicates)
        }
        (S::Plane(p), S::EllipticCone(c)) => elliptic::plane_elliptic_cone(p, c, &pair, predicates),
        (S::EllipticCone(c), S::Plane(p)) => {
            elliptic::plane_elliptic_cone(p, c, &turned, predicates)
        }
        (S::Plane(p), S::Ellipsoid(s)) => ellipsoid::plane_ellipsoid(p, s, &pair, predicates),
        (S::Ellipsoid(s), S::Plane(p)) => ellipsoid::plane_ellipsoid(p, s, &turned, predicates),
        (S::Sphere(s), S::Sphere(t)) => sphere::sphere_sphere(s, t, &pair, predicates),
        (S::Sphere(_) | S::Ellipsoid(_), S::Sphere(_) | S::Ellipsoid(_)) => {
            ellipsoid::balls(&pair, predicates)?
        }
        (S::Torus(t), S::Torus(o)) => torus::torus_torus(t, o, &pair, predicates)?,
        (S::Torus(t), _) => torus::torus_with(t, &pair, predicates)?,
        (_, S::Torus(t)) => torus::torus_with(t, &turned, predicates)?,
        _ => quadric::quadric_quadric(&pair, predicates)?,
    })
}

/// Whether the axes of two carriers coincide within the resolution.
fn same_line<N: Float>(
    pair: &SurfacePair<'_, N>,
    place: [f64; 3],
    predicates: &Predicates,
) -> bool {
    predicates.coincide("axes side by side", pair.how(PairMeasure::Drift), place)
        && predicates.coincide("axis on axis", pair.how(PairMeasure::OffLine), place)
}

/// Whether two surfaces coincide over the extent: `Along` with the same side inside, `Against` with
/// opposite sides, which is possible for planes only.
pub fn coincidence<N: Float>(
    a: Carrier<'_, N>,
    b: Carrier<'_, N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Option<Sense> {
    let kinds = [a, b].map(|c| c.surface.kind());
    let against = a.surface.frame().z.dot(&b.surface.frame().z) < N::ZERO;
    let is_cone = matches!(kinds[0], SurfaceKind::Cone | SurfaceKind::EllipticCone);
    if kinds[0] != kinds[1] || (against && is_cone) {
        return None;
    }
    let pair = SurfacePair::new(a, b, extent);
    // Most pairs are far from each other. Only those that could matter reach the predicates.
    if pair.estimate(PairMeasure::Apart) > N::TWO * predicates.reach() {
        return None;
    }
    let place = place(&a.surface.frame().origin);
    if !predicates.coincide("surface on surface", pair.how(PairMeasure::Apart), place) {
        return None;
    }
    Some(if against && kinds[0] == SurfaceKind::Plane {
        Sense::Against
    } else {
        Sense::Along
    })
}

/// The parts of a range on which a function along the curve is positive.
fn positive_parts<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    f: &impl Function<N>,
    resolution: N,
) -> Vec<[N; 2]> {
    let roots = match isolate(f, &curve.breaks(range[0], range[1]), resolution) {
        Roots::Everywhere => return Vec::new(),
        Roots::At { roots, .. } => roots,
    };
    let value = |t: N| f.at(t).v;
    if roots.is_empty() {
        let middle = range[0] + (range[1] - range[0]) * N::from_f64(0.618);
        return if value(middle) > N::ZERO {
            vec![range]
        } else {
            Vec::new()
        };
    }
    let mut marks: Vec<N> = roots.iter().map(|r| r.t).collect();
    if curve.period() == Some(range[1] - range[0]) {
        // A closed curve is cut open at a root.
        let (first, period) = (marks[0], range[1] - range[0]);
        marks.push(first + period);
    } else {
        marks.insert(0, range[0]);
        marks.push(range[1]);
    }
    let short = (range[1] - range[0]) * N::ROUNDING;
    marks
        .windows(2)
        .filter(|m| m[1] - m[0] > short && value(N::HALF * (m[0] + m[1])) > N::ZERO)
        .map(|m| [m[0], m[1]])
        .collect()
}

/// The parts of a curve on the implicit polynomial of a surface that lie on the surface: on the one
/// nappe of a cone, or the one sheet of a torus.
fn parts_on<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> Vec<[N; 2]> {
    match surface {
        Surface::Cone(_) | Surface::EllipticCone(_) => {
            let frame = surface.frame();
            positive_parts(curve, range, &AboveApex { curve, frame }, resolution)
        }
        Surface::Torus(torus) if !torus.is_ring() => {
            positive_parts(curve, range, &OnSheet { curve, torus }, resolution)
        }
        _ => vec![range],
    }
}

/// The height of a curve above a cone's apex, along the axis.
struct AboveApex<'a, N: Float = f64> {
    curve: &'a Curve<N>,
    /// The cone's.
    frame: &'a Frame<N>,
}

/// The distance of a curve from the poles of a torus, positive on its sheet.
struct OnSheet<'a, N: Float = f64> {
    curve: &'a Curve<N>,
    torus: &'a Torus<N>,
}

impl<N: Float> Function<N> for OnSheet<'_, N> {
    fn over(&self, t: Interval<N>) -> Jet<Interval<N>> {
        self.torus.sheet_level(self.curve.jet_over(t))
    }

    fn reach(&self, t: Interval<N>) -> Interval<N> {
        match self.curve.box_over(t) {
            Some(p) => self.torus.sheet_level(p),
            None => Interval::ENTIRE,
        }
    }

    fn at(&self, t: N) -> Jet<N> {
        self.torus.sheet_level(self.curve.jet(t))
    }

    fn value(&self, t: N) -> N {
        self.torus.sheet_level(self.curve.point(t).into())
    }
}

impl<N: Float> Function<N> for AboveApex<'_, N> {
    fn over(&self, t: Interval<N>) -> Jet<Interval<N>> {
        self.frame.local(self.curve.jet_over(t))[2]
    }

    fn reach(&self, t: Interval<N>) -> Interval<N> {
        match self.curve.box_over(t) {
            Some(p) => self.frame.local(p)[2],
            None => Interval::ENTIRE,
        }
    }

    fn at(&self, t: N) -> Jet<N> {
        self.frame.local(self.curve.jet(t))[2]
    }

    fn value(&self, t: N) -> N {
        self.frame.local(self.curve.point(t).into())[2]
    }
}
