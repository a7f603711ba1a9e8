//! Intersections of ellipsoids: with planes in closed form, with spheres and with each other over the
//! rulings of a cone or a cylinder of their pencil.
//!
//! Notation: the first surface is the image of the unit sphere. In the unit sphere's space the second
//! has the centre d and the radii 1/√m_i along the axes e_i, with m₁ <= m₂ <= m₃; y are coordinates
//! along these. The pencil λ ↦ B - λ A of both forms is Σ q_i (y_i - t_i)² + f with q_i = m_i - λ,
//! t_i = m_i d_i/q_i and f(λ) = λ - 1 - λ Σ m_i d_i²/q_i. It is a cone about t where f = 0. Between m₁
//! and m₂, and between m₂ and m₃, f changes its sign, so each interval has a real cone about e₁ or e₃.
//! If d_i = 0, λ = m_i is a cylinder along e_i; where a second term vanishes too, it is two planes.
//! After Levin (1976).

mod conics;

use super::elliptic::circle_or_ellipse;
use super::quadric::over_first;
use super::{Branch, IntersectionError, RegionOfInterest, SurfaceIntersection, place};
use crate::geometry::ellipsoid::Ellipsoid;
use crate::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Plane, Surface};
use crate::geometry::surface_pair::{Carrier, PairMeasure, SurfacePair};
use crate::geometry::vector::Length;
use crate::number::bisection::bisect;
use crate::number::float::Float;
use crate::number::predicates::{Predicates, Side};
use nalgebra::{Point3, Vector3};

pub(super) fn plane_ellipsoid<N: Float>(
    p: &Plane<N>,
    s: &Ellipsoid<N>,
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> SurfaceIntersection<N> {
    let f = &s.frame;
    let level = (p.frame.origin - f.origin).dot(&p.frame.z);
    // In the unit sphere's space the plane is at the distance `height` along `normal`.
    let image = s.image(&f.components(&p.frame.z));
    let half_width = image.length();
    let (normal, height) = (image / half_width, level / half_width);
    let touch = f.origin + f.vector(&s.image(&(normal * N::ONE.copysign(level))));
    let side = pair.how(PairMeasure::PlaneOnBall);
    match predicates.classify_at_point("plane on ellipsoid", side, place(&touch)) {
        Side::Outside => SurfaceIntersection::nothing(),
        Side::On => SurfaceIntersection::touch(touch),
        Side::Inside => {
            let section = s.section(&normal, height);
            let [long, short] = section.radii;
            let frame = Frame::toward(section.centre, p.frame.z, long);
            let curve = circle_or_ellipse(frame, [long.length(), short.length()], predicates);
            let mut meeting = SurfaceIntersection::nothing();
            meeting.add(curve, false, pair.extent);
            meeting
        }
    }
}

/// Two surfaces of which each is a sphere or an ellipsoid.
pub(super) fn balls<N: Float>(
    pair: &SurfacePair<'_, N>,
    predicates: &Predicates,
) -> Result<SurfaceIntersection<N>, IntersectionError> {
    let (Some(first), Some(second)) = (as_ellipsoid(pair.a.surface), as_ellipsoid(pair.b.surface))
    else {
        return Ok(SurfaceIntersection::nothing());
    };
    let pencil = Pencil::new(first, &second);
    if let Some(conics) = pencil.conics(pair, predicates) {
        return Ok(conics);
    }
    if let Some(touches) = pencil.touches_in_symmetry(pair, predicates) {
        return Ok(touches);
    }
    pencil.over_rulings(pair, predicates)
}

/// Adds an intersection. A singular point that both have is one, with the branches of both.
fn append<N: Float>(
    meeting: &mut SurfaceIntersection<N>,
    other: SurfaceIntersection<N>,
    predicates: &Predicates,
) {
    let added = meeting.branches.len();
    meeting.branches.extend(other.branches);
    for mut node in other.nodes {
        for on in &mut node.on {
            on.branch += added;
        }
        let mut known = meeting.nodes.iter_mut();
        match known.find(|known| predicates.within((known.point - node.point).length())) {
            Some(known) => known.on.extend(node.on),
            None => meeting.nodes.push(node),
        }
    }
}

/// A sphere or an ellipsoid as an ellipsoid.
fn as_ellipsoid<N: Float>(surface: &Surface<N>) -> Option<Ellipsoid<N>> {
    match surface {
        Surface::Ellipsoid(s) => Some(*s),
        Surface::Sphere(s) => Some(Ellipsoid::new(s.frame, [s.radius; 3])),
        _ => None,
    }
}

/// The pencil of two ellipsoids, in the space in which the first is the unit sphere.
struct Pencil<N: Float> {
    first: Ellipsoid<N>,
    /// e₁, e₂, e₃.
    axes: [Vector3<N>; 3],
    /// m.
    forms: [N; 3],
    /// d.
    centre: [N; 3],
}

/// Surfaces with rulings that carry the curve.
struct RuledMembers<N: Float> {
    /// The distance of the apex or the axis, in radii of the unit sphere. Points over the rulings lose its
    /// square in rounding.
    away: N,
    surfaces: Vec<Surface<N>>,
}

/// The multiple of rounding by which points may be off.
const ROUNDINGS: f64 = 8.0;

/// A parameter of a branch.
fn sample<N: Float>(branch: &Branch<N>, i: i32) -> N {
    let part = (N::whole(i) + N::from_f64(0.3)) / N::whole(SAMPLES);
    branch.range[0] + (branch.range[1] - branch.range[0]) * part
}

/// A member of the pencil: λ by its distances q from the m_i, none of which cancels.
#[derive(Clone, Copy)]
struct Member<N: Float> {
    level: N,
    excess: [N; 3],
}

impl<N: Float> Pencil<N> {
    fn new(first: Ellipsoid<N>, second: &Ellipsoid<N>) -> Self {
        let unit = |v: &Vector3<N>| first.on_unit_sphere(v);
        let centre = unit(&first.frame.coordinates(&second.frame.origin));
        let f = &second.frame;
        let axes = [f.x, f.y, f.z].map(|axis| first.frame.components(&axis));
        let axes = std::array::from_fn(|i| unit(&(axes[i] * second.radii[i])));
        let image = Ellipsoid::with_axes(Point3::from(centre), axes);
        let f = image.frame;
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| image.radii[j].total_cmp(&image.radii[i]));
        let mut pencil = Self {
            first,
            axes: order.map(|i| [f.x, f.y, f.z][i]),
            forms: order.map(|i| N::ONE / (image.radii[i] * image.radii[i])),
            centre: [N::ZERO; 3],
        };
        for [i, j] in [[0, 1], [2, 1]] {
            if pencil.is_double(i, j) {
                pencil.turn_toward(&centre, [i, j]);
            }
        }
        // A component that is rounding is none.
        let known = |d: N| if d.abs() <= N::ROUNDING { N::ZERO } else { d };
        pencil.centre = pencil.axes.map(|axis| known(axis.dot(&centre)));
        pencil
    }

    /// Turns e_i and e_j so that the vector has no component along e_i.
    fn turn_toward(&mut self, v: &Vector3<N>, [i, j]: [usize; 2]) {
        let [x, y] = [i, j].map(|i| self.axes[i]);
        let (a, b) = (x.dot(v), y.dot(v));
        let size = a.hypot(b);
        if size > N::ROUNDING {
            self.axes[i] = (x * b - y * a) / size;
            self.axes[j] = (x * a + y * b) / size;
        }
    }

    /// The member at λ = m_i + s (m_j - m_i).
    fn member(&self, [i, j]: [usize; 2], s: N) -> Member<N> {
        let gap = self.forms[j] - self.forms[i];
        let level = self.forms[i] + s * gap;
        let mut excess = self.forms.map(|m| m - level);
        excess[i] = -s * gap;
        excess[j] = (N::ONE - s) * gap;
        Member { level, excess }
    }

    /// The point with the coordinates y.
    fn point(&self, y: [N; 3]) -> Point3<N> {
        let local: Vector3<N> = (0..3).map(|i| self.axes[i] * y[i]).sum();
        let frame = &self.first.frame;
        frame.origin + frame.vector(&self.first.image(&local))
    }

    /// The image of a vector along e_i.
    fn image(&self, i: usize, length: N) -> Vector3<N> {
        let axis = self.first.image(&(self.axes[i] * length));
        self.first.frame.vector(&axis)
    }

    /// t_i.
    fn apex(&self, member: &Member<N>, i: usize) -> N {
        match self.centre[i] == N::ZERO {
            true => N::ZERO,
            false => self.forms[i] * self.centre[i] / member.excess[i],
        }
    }

    /// f, without the term of `left`.
    fn rest(&self, member: &Member<N>, left: usize) -> N {
        let kept = (0..3).filter(|&i| i != left);
        let sum: N = kept.map(|i| self.apex(member, i) * self.centre[i]).sum();
        (member.level - N::ONE) - member.level * sum
    }

    /// Whether two m are equal but for rounding.
    fn is_double(&self, i: usize, j: usize) -> bool {
        (self.forms[j] - self.forms[i]).abs() <= N::ROUNDING * self.forms[j]
    }

    /// An axis along which the pencil has an elliptic cylinder or a line, with the others.
    fn cylinder_axis(&self) -> Option<(usize, [usize; 2])> {
        let axes = [(0, [1, 2]), (2, [0, 1])].into_iter();
        let mut axes = axes.filter(|&(i, others)| {
            self.centre[i] == N::ZERO && others.iter().all(|&j| !self.is_double(i, j))
        });
        axes.next()
    }

    /// The two points of contact in which a cylinder of the pencil is a line.
    fn touches_in_symmetry(
        &self,
        pair: &SurfacePair<'_, N>,
        predicates: &Predicates,
    ) -> Option<SurfaceIntersection<N>> {
        let (i, others) = self.cylinder_axis()?;
        let mut y = self.cylinder_centre(i, others).1;
        let square = N::ONE - y.iter().map(|y| *y * *y).sum::<N>();
        if square <= N::ZERO {
            return None;
        }
        let mut meeting = SurfaceIntersection::nothing();
        for side in [N::ONE, -N::ONE] {
            y[i] = side * square.sqrt();
            let point = self.point(y);
            if !predicates.within(pair.b.surface.distance(&point)) {
                return None;
            }
            meeting
                .nodes
                .extend(SurfaceIntersection::touch(point).nodes);
        }
        Some(meeting)
    }

    /// The curve over the rulings of a member.
    fn over_rulings(
        &self,
        pair: &SurfacePair<'_, N>,
        predicates: &Predicates,
    ) -> Result<SurfaceIntersection<N>, IntersectionError> {
        let origin = self.first.frame.origin;
        let at = place(&origin);
        let undetermined = IntersectionError::Undetermined { place: at };
        // The curve is on the first surface, all of which is in this extent.
        let RegionOfInterest { centre, radius } = *pair.extent;
        let whole = (origin - centre).length() + N::TWO * self.first.circumradius();
        let extent = RegionOfInterest {
            centre,
            radius: radius.max(whole),
        };
        let RuledMembers { away, surfaces } = self.ruled_members();
        let rounding = N::from_f64(ROUNDINGS) * N::EPSILON * self.first.circumradius();
        if !predicates.within(rounding * away * away) {
            return Err(undetermined);
        }
        let mut meeting = SurfaceIntersection::nothing();
        for ruled in &surfaces {
            let base = Carrier::constructed(ruled);
            let over = over_first(&SurfacePair::new(base, pair.a, &extent), predicates)?;
            append(&mut meeting, over, predicates);
        }
        let is_lost = meeting.branches.is_empty() && self.changes_side(pair, predicates);
        let is_vague = |branch: &Branch<N>| {
            let samples = (0..SAMPLES).map(|i| branch.curve.point(sample(branch, i)));
            let mut off = samples.map(|p| self.distance_to_curve(pair, &p));
            off.any(|off| !predicates.within(off))
        };
        match is_lost || meeting.branches.iter().any(is_vague) {
            true => Err(undetermined),
            false => Ok(meeting),
        }
    }

    /// How far a point of the first surface may be from the curve in which the second one crosses it: at a
    /// small angle a small distance from the second one, or rounding, moves the curve far along both.
    fn distance_to_curve(&self, pair: &SurfacePair<'_, N>, p: &Point3<N>) -> N {
        let [first, second] = [pair.a.surface, pair.b.surface];
        let sine = first.normal(p).cross(&second.normal(p)).length();
        let size = p.coords.length() + self.first.circumradius();
        let rounding = N::from_f64(ROUNDINGS) * N::EPSILON * size;
        second.distance(p).abs().max(rounding) / sine
    }

    /// Whether the first surface has points clearly inside and clearly outside the second: those with the
    /// least and the greatest value of B, where y_i = m_i d_i/(m_i - μ).
    fn changes_side(&self, pair: &SurfacePair<'_, N>, predicates: &Predicates) -> bool {
        let distance = |end: usize| {
            let square = |excess: N| {
                let y = self.extreme(end, excess);
                y.iter().map(|y| *y * *y).sum::<N>() - N::ONE
            };
            // Far from the m the sum is less than one.
            let size: N = (0..3).map(|i| self.forms[i] * self.centre[i].abs()).sum();
            let excess = bisect(N::ZERO, N::TWO * size, N::ONE, square);
            let mut y = self.extreme(end, excess);
            if !y.iter().all(|y| y.is_finite()) {
                y = [N::ZERO; 3];
            }
            // If the sum is less than one everywhere, the rest is along the axis of the end.
            let rest = N::ONE - y.iter().map(|y| *y * *y).sum::<N>();
            y[end] += rest.max(N::ZERO).sqrt();
            pair.b.surface.distance(&self.point(y))
        };
        let [least, greatest] = [distance(0), distance(2)];
        let is_clear = |off: N| !predicates.within(off);
        is_clear(least) && is_clear(greatest) && (least < N::ZERO) != (greatest < N::ZERO)
    }

    /// The y of μ below m₁ (`end` 0) or above m₃ (2) by an excess.
    fn extreme(&self, end: usize, excess: N) -> [N; 3] {
        let side = if end == 0 { N::ONE } else { -N::ONE };
        std::array::from_fn(|i| {
            let apart = self.forms[i] - self.forms[end] + side * excess;
            match self.centre[i] == N::ZERO {
                true => N::ZERO,
                false => self.forms[i] * self.centre[i] / apart,
            }
        })
    }

    /// The ruled member whose vertex is the closest to the surfaces: a cylinder, or both nappes of a
    /// cone.
    fn ruled_members(&self) -> RuledMembers<N> {
        if let Some((i, others)) = self.cylinder_axis() {
            let (_, y) = self.cylinder_centre(i, others);
            return RuledMembers {
                away: Vector3::from(y).length().max(N::ONE),
                surfaces: self.cylinder(i, others).into_iter().collect(),
            };
        }
        let cones = [[0, 1], [1, 2]].into_iter().filter_map(|ends| {
            let member = self.cone_member(ends)?;
            let apex: [N; 3] = std::array::from_fn(|i| self.apex(&member, i));
            let away = Vector3::from(apex).length();
            Some((away, member, apex))
        });
        let nearest = cones.min_by(|(a, ..), (b, ..)| a.total_cmp(b));
        match nearest {
            Some((away, member, apex)) => RuledMembers {
                away,
                surfaces: self.nappes(&member, apex).into(),
            },
            None => RuledMembers {
                away: N::ONE,
                surfaces: Vec::new(),
            },
        }
    }

    /// A zero of f between m_i and m_j: f times -q_i, if d_i is not zero, and times q_j, if d_j is not
    /// zero, has no pole at the ends. `None` if its sign does not change.
    fn cone_member(&self, [i, j]: [usize; 2]) -> Option<Member<N>> {
        if self.is_double(i, j) {
            return None;
        }
        let k = 3 - i - j;
        let value = |s: N| {
            let member = self.member([i, j], s);
            let pole = |i: usize| match self.centre[i] == N::ZERO {
                true => N::ONE,
                false => member.excess[i].abs(),
            };
            let [p, q] = [i, j].map(pole);
            let [a, b] = [i, j].map(|i| self.forms[i] * self.centre[i] * self.centre[i]);
            let third = self.apex(&member, k) * self.centre[k];
            let rest = member.level - N::ONE - member.level * third;
            rest * p * q + member.level * (a * q - b * p)
        };
        let [first, last] = [N::ZERO, N::ONE].map(value);
        if first * last >= N::ZERO {
            return None;
        }
        let member = self.member([i, j], bisect(N::ZERO, N::ONE, first, value));
        (member.excess[i] != N::ZERO && member.excess[j] != N::ZERO).then_some(member)
    }

    /// The member λ = m_i, and a point of its axis.
    fn cylinder_centre(&self, i: usize, [j, k]: [usize; 2]) -> (Member<N>, [N; 3]) {
        let mut member = self.member([i, j], N::ZERO);
        member.excess[k] = self.forms[k] - self.forms[i];
        let mut y = [N::ZERO; 3];
        y[j] = self.apex(&member, j);
        y[k] = self.apex(&member, k);
        (member, y)
    }

    /// The cylinder along e_i, over the ellipse q_j (y_j - t_j)² + q_k (y_k - t_k)² = -f.
    fn cylinder(&self, i: usize, [j, k]: [usize; 2]) -> Option<Surface<N>> {
        let (member, y) = self.cylinder_centre(i, [j, k]);
        let rest = self.rest(&member, i);
        let radii = [j, k].map(|j| (-rest / member.excess[j]).sqrt());
        if !radii.iter().all(|r| *r > N::ZERO) {
            return None;
        }
        let axes = [
            self.image(j, radii[0]),
            self.image(k, radii[1]),
            self.image(i, N::ONE),
        ];
        let cylinder = EllipticCylinder::with_axes(self.point(y), axes);
        Some(Surface::EllipticCylinder(cylinder))
    }

    /// Both nappes of the cone Σ q_i (y_i - t_i)² = 0. One q has another sign than the others; its axis
    /// is inside the cone.
    fn nappes(&self, member: &Member<N>, apex: [N; 3]) -> [Surface<N>; 2] {
        let q = member.excess;
        let i = if q[1] > N::ZERO { 0 } else { 2 };
        let [j, k] = if i == 0 { [1, 2] } else { [0, 1] };
        let slope = |j: usize| (-q[i] / q[j]).sqrt();
        [N::ONE, -N::ONE].map(|side| {
            let axes = [
                self.image(j, slope(j)),
                self.image(k, slope(k)),
                self.image(i, side),
            ];
            Surface::EllipticCone(EllipticCone::with_axes(self.point(apex), axes))
        })
    }
}

/// The number of points at which a curve is tested.
const SAMPLES: i32 = 24;
