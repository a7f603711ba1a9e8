//! The general case: two points of the curve on each ruling where Δ is positive. The curve is two
//! conics if Δ is a square, otherwise a quartic.
//!
//! The number and kind of the zeros of Δ determine the structure. A double zero is a node; without
//! zeros there is a pair of closed branches. Each zero is classified by the distance of the ruling
//! from the other surface.

use super::{Rulings, apart, sampled_rulings};
use crate::geometry::centred_trigonometric::CentredTrigonometric;
use crate::geometry::curve::Curve;
use crate::geometry::intersect::{Branch, IntersectionError, Node, SurfaceIntersection, place};
use crate::geometry::quadric_curve::{Along, Height, QuadricCurve, Sweep};
use crate::geometry::trace::BranchPosition;
use crate::geometry::trigonometric::{Trig1, between, divide, trig1, zeros_of};
use crate::geometry::vector::Length;
use crate::number::analytic::harmonic_slope;
use crate::number::bisection::bisect;
use crate::number::float::{Float, harmonic};
use crate::number::predicates::{Predicates, Side};

/// The passage of a curve through a node.
#[derive(Clone, Copy)]
struct NodePassage<N: Float = f64> {
    /// The angle of the node.
    angle: N,
    /// The parameter of the curve.
    t: N,
}

/// A zero of Δ at which its sign changes.
#[derive(Clone, Copy)]
struct SignChange<N: Float = f64> {
    angle: N,
    /// Whether Δ is positive after it.
    rising: bool,
}

/// The sign of Δ at an extremum.
#[derive(Clone, Copy)]
struct ExtremumSide<N: Float = f64> {
    angle: N,
    side: Side,
}

/// A branch over the base, with the nodes that it passes.
struct QuarticBranch<N: Float> {
    curve: QuadricCurve<N>,
    passes: Vec<NodePassage<N>>,
}

impl<N: Float> Rulings<'_, N> {
    /// k ≠ 0: two points on each ruling where Δ > 0.
    pub(in crate::geometry::intersect) fn double(
        &self,
        predicates: &Predicates,
    ) -> Result<SurfaceIntersection<N>, IntersectionError> {
        let mut meeting = SurfaceIntersection::nothing();
        if let Some(root) = self.square_root(predicates) {
            self.add_conics(&root, predicates, &mut meeting);
        } else {
            self.add_quartic(predicates, &mut meeting)?;
        }
        self.add_apexes(predicates, &mut meeting);
        Ok(meeting)
    }

    /// The s of degree one with Δ = s² within the resolution, if there is one.
    fn square_root(&self, predicates: &Predicates) -> Option<Trig1<N>> {
        let [a0, c1, s1, c2, s2] = self.radicand;
        let rho = (N::TWO * c2.hypot(s2)).sqrt();
        let noise = (N::ROUNDING * self.scale).sqrt();
        let (sin, cos) = (N::HALF * s2.atan2(c2)).sin_cos();
        let root = if rho > noise {
            [(c1 * cos + s1 * sin) / (N::TWO * rho), rho * cos, rho * sin]
        } else {
            [a0.max(N::ZERO).sqrt(), N::ZERO, N::ZERO]
        };
        let both = |u: N| {
            let s = trig1(&root, u.sin_cos());
            let middle = trig1(&self.linear, u.sin_cos());
            vec![(s - middle) / self.lead, (-s - middle) / self.lead]
        };
        let is_one = self.conics_hold_all(&root) && self.meets_in_conics(predicates, both);
        is_one.then_some(root)
    }

    /// Whether the conics with Δ = s² contain every intersection of a ruling with the other
    /// surface. Close to a cone's apex one conic may be accurate and the other lost.
    fn conics_hold_all(&self, root: &Trig1<N>) -> bool {
        let is_held =
            |exact: N, approximate: N| !self.is_on_base(exact) || self.is_about_base(approximate);
        let mut crossed = sampled_rulings().filter(|&u| self.delta(u) > N::ZERO);
        crossed.all(|u| {
            let at = u.sin_cos();
            let linear = trig1(&self.linear, at);
            // One of the two sums does not cancel, and the product of the heights is known.
            let sums = |root: N| [root, -root].map(|r| -linear - r.copysign(r * linear));
            let [sum, _] = sums(self.delta(u).sqrt());
            let [first, second] = sums(trig1(root, at).abs()).map(|sum| sum / self.lead);
            let product = harmonic(&self.constant, at);
            is_held(sum / self.lead, first) && is_held(product / sum, second)
        })
    }

    fn add_conics(
        &self,
        root: &Trig1<N>,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let w = |sign: N| {
            let part = |i: usize| (sign * root[i] - self.linear[i]) / self.lead;
            [part(0), part(1), part(2)]
        };
        // If both conics coincide, the surfaces are tangent along them.
        let gap = (0..8)
            .map(|i| N::TAU * N::whole(i) / N::from_f64(8.0))
            .map(|u| (u, self.middle(u)))
            .filter(|(_, m)| self.is_on_base(*m))
            .map(|(u, m)| apart(self.other, &self.world(u, m)))
            .reduce(N::max);
        if gap.is_some_and(|g| predicates.within(g)) {
            return self.add_conic(&w(N::ZERO), true, predicates, meeting);
        }
        self.add_conic(&w(N::ONE), false, predicates, meeting);
        self.add_conic(&w(-N::ONE), false, predicates, meeting);
        // The conics cross where s vanishes.
        let whole = [root[0], root[1], root[2], N::ZERO, N::ZERO];
        for u in zeros_of(&whole) {
            let m = self.middle(u);
            let p = self.world(u, m);
            if self.is_on_base(m) && predicates.within(self.other.distance(&p)) {
                meeting.cross_at(p, predicates);
            }
        }
    }

    fn add_quartic(
        &self,
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) -> Result<(), IntersectionError> {
        let structure = self.structure(predicates)?;
        self.add_isolated(&structure.isolated, predicates, meeting);
        let whole_turns = structure.arcs.is_empty() && structure.positive;
        let around = whole_turns.then(|| self.branches_around(structure.nodes.first().copied()));
        let ovals = structure
            .arcs
            .iter()
            .map(|arc| self.oval(*arc, &structure.nodes));
        let branches: Vec<_> = around.into_iter().flatten().chain(ovals).collect();
        for branch in branches {
            self.add_clipped(branch.curve, &branch.passes, predicates, meeting);
        }
        Ok(())
    }

    /// Adds the points of contact at isolated double zeros of the radicand.
    fn add_isolated(
        &self,
        isolated: &[N],
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        for &u in isolated {
            let p = self.world(u, self.middle(u));
            if self.is_on_base(self.middle(u)) && predicates.within(self.other.distance(&p)) {
                meeting.nodes.push(Node {
                    point: p,
                    on: Vec::new(),
                });
            }
        }
    }

    /// A branch without passes through nodes, or with those given.
    fn branch(
        &self,
        sweep: Sweep<N>,
        height: Height<N>,
        passes: Vec<NodePassage<N>>,
    ) -> QuarticBranch<N> {
        let curve = QuadricCurve {
            base: self.base,
            sweep,
            height,
        };
        QuarticBranch { curve, passes }
    }

    /// Δ about its minima, where it is computed as B^2 - k C.
    fn centred_radicand(&self) -> CentredTrigonometric<N> {
        let value = |u: N| {
            let at = u.sin_cos();
            trig1(&self.linear, at).powi(2) - self.lead * harmonic(&self.constant, at)
        };
        CentredTrigonometric::new(&self.radicand, value).not_negative()
    }

    fn along(&self) -> Along<N> {
        Along::new(self.lead, self.linear, self.constant)
    }

    /// The branches that go around the base, where the radicand has no simple zero: two, or with a
    /// node one that goes around twice.
    fn branches_around(&self, node: Option<N>) -> Vec<QuarticBranch<N>> {
        let Some(node) = node else {
            let radicand = self.centred_radicand();
            let with_sign = |sign| {
                let height = Height::Whole {
                    along: self.along(),
                    radicand,
                    sign,
                };
                self.branch(Sweep::Round { turns: 1 }, height, Vec::new())
            };
            return [N::ONE, -N::ONE].map(with_sign).into();
        };
        let half = between(node, node).map(|k| -k);
        let height = Height::Deflated {
            along: self.along(),
            rest: CentredTrigonometric::linear(&divide(&self.radicand, &half)),
            node: Some(node),
            sign: N::ONE,
        };
        let pass = |t: N| NodePassage { angle: node, t };
        let passes = vec![pass(node), pass(node + N::TAU)];
        vec![self.branch(Sweep::Round { turns: 2 }, height, passes)]
    }

    /// The branch over an arc between two simple zeros of the radicand, with the node inside it, if
    /// there is one.
    fn oval(&self, [a, b]: [N; 2], nodes: &[N]) -> QuarticBranch<N> {
        let mut rest = divide(&self.radicand, &between(a, b));
        let node = nodes.iter().copied().find_map(|n| {
            let n = a + (n - a).rem_euclid(N::TAU);
            (n < b).then_some(n)
        });
        let (mid, half) = (N::HALF * (a + b), N::HALF * (b - a));
        let mut passes = Vec::new();
        if let Some(n) = node {
            // rest = K sin²((u - n)/2); only K is needed.
            rest = [N::TWO * rest[0], N::ZERO, N::ZERO];
            let t = ((mid - n) / half).clamp(-N::ONE, N::ONE).acos();
            let pass = |t: N| NodePassage { angle: n, t };
            passes = vec![pass(t), pass(N::TAU - t)];
        }
        let height = Height::Deflated {
            along: self.along(),
            rest: CentredTrigonometric::linear(&rest),
            node,
            sign: N::ONE,
        };
        self.branch(Sweep::Oval { mid, half }, height, passes)
    }

    /// Adds a branch, clipped to the base's nappe and the other surface's.
    fn add_clipped(
        &self,
        q: QuadricCurve<N>,
        nodes: &[NodePassage<N>],
        predicates: &Predicates,
        meeting: &mut SurfaceIntersection<N>,
    ) {
        let curve = Curve::Quartic(Box::new(q));
        let Some(period) = curve.period() else { return };
        let mut ranges = vec![[N::ZERO, period]];
        if self.base.is_cone() {
            ranges = self.nappe_ranges(&q, period);
        }
        for r in ranges {
            for range in self.on_other_nappe(&curve, r, predicates) {
                let closed = range == [N::ZERO, period];
                let branch = meeting.branches.len();
                meeting.branches.push(Branch {
                    curve: curve.clone(),
                    range,
                    closed,
                    tangent: false,
                });
                for &NodePassage { angle, t } in nodes {
                    let point = self.world(angle, self.middle(angle));
                    let t = range[0] + (t - range[0]).rem_euclid(period);
                    if t > range[1] {
                        continue;
                    }
                    let known = meeting
                        .nodes
                        .iter_mut()
                        .find(|n| predicates.within((n.point - point).length()));
                    match known {
                        Some(node) => node.on.push(BranchPosition { branch, t }),
                        None => meeting.nodes.push(Node {
                            point,
                            on: vec![BranchPosition { branch, t }],
                        }),
                    }
                }
            }
        }
    }

    /// The ranges of a closed branch over a cone that lie on the cone's nappe and within the
    /// extent. At their ends k w² + 2 B w + C is zero for the smallest w. The height itself is not
    /// used, because it divides by k, which may be close to zero.
    fn nappe_ranges(&self, q: &QuadricCurve<N>, period: N) -> Vec<[N; 2]> {
        let least = N::ONE / self.reach();
        let mut limit = self.constant;
        for (c, b) in limit.iter_mut().zip(&self.linear) {
            *c += N::TWO * least * *b;
        }
        limit[0] += self.lead * least * least;
        let angles = zeros_of(&limit).into_iter();
        let mut marks: Vec<N> = angles.flat_map(|u| q.parameters_of(u)).collect();
        marks.sort_by(N::total_cmp);
        let is_inside = |[a, b]: [N; 2]| q.height_at(N::HALF * (a + b)) > least;
        let next = |marks: &[N], i: usize| match marks.get(i + 1) {
            Some(&next) => next,
            None => marks[0] + period,
        };
        let inside: Vec<bool> = (0..marks.len())
            .map(|i| is_inside([marks[i], next(&marks, i)]))
            .collect();
        // Of the two points of a ruling, one may be at the limit while the curve passes through the
        // other.
        let n = marks.len();
        let ends = (0..n).filter(|&i| inside[i] != inside[(i + n - 1) % n]);
        let (ends, starts): (Vec<N>, Vec<bool>) = ends.map(|i| (marks[i], inside[i])).unzip();
        if ends.is_empty() {
            let whole = [N::ZERO, period];
            return if is_inside(whole) {
                vec![whole]
            } else {
                vec![]
            };
        }
        let begun = (0..ends.len()).filter(|&i| starts[i]);
        begun.map(|i| [ends[i], next(&ends, i)]).collect()
    }

    /// The zeros of Δ, by kind.
    fn structure(&self, predicates: &Predicates) -> Result<Structure<N>, IntersectionError> {
        let slope = harmonic_slope(&self.radicand);
        let flat = slope.iter().map(|c| c.abs()).sum::<N>() <= N::ROUNDING * self.scale;
        let extrema = if flat { Vec::new() } else { zeros_of(&slope) };
        let mut out = Structure::default();
        if extrema.is_empty() {
            out.positive = self.state(N::ZERO, predicates) == Side::Inside;
            return Ok(out);
        }
        let states: Vec<ExtremumSide<N>> = extrema
            .iter()
            .map(|&angle| ExtremumSide {
                angle,
                side: self.state(angle, predicates),
            })
            .collect();
        let n = states.len();
        let mut roots: Vec<SignChange<N>> = Vec::new();
        for i in 0..n {
            let (before, here, next) = (states[(i + n - 1) % n], states[i], states[(i + 1) % n]);
            let (u, s) = (here.angle, here.side);
            let (v, t) = (next.angle, next.side);
            let v = if i + 1 == n { v + N::TAU } else { v };
            if (s == Side::Inside) != (t == Side::Inside) && s != Side::On && t != Side::On {
                roots.push(SignChange {
                    angle: bisect(u, v, self.delta(u), |u| self.delta(u)),
                    rising: t == Side::Inside,
                });
            }
            if s == Side::On {
                match (before.side, t) {
                    (Side::Inside, Side::Inside) => out.nodes.push(u),
                    (Side::Outside, Side::Outside) => out.isolated.push(u),
                    _ => {
                        let p = self.world(u, self.middle(u));
                        return Err(IntersectionError::Cusp { place: place(&p) });
                    }
                }
            }
        }
        out.positive = roots.is_empty() && states.iter().any(|s| s.side == Side::Inside);
        for (i, root) in roots.iter().enumerate() {
            if root.rising {
                let (a, b) = (root.angle, roots[(i + 1) % roots.len()].angle);
                out.arcs.push([a, if b < a { b + N::TAU } else { b }]);
            }
        }
        Ok(out)
    }
}

/// The zeros of Δ, by kind.
#[derive(Default)]
struct Structure<N: Float = f64> {
    /// Whether Δ is positive everywhere.
    positive: bool,
    /// The intervals of angles, between simple zeros, on which Δ is positive.
    arcs: Vec<[N; 2]>,
    /// Double zeros with Δ positive on both sides.
    nodes: Vec<N>,
    /// Double zeros with Δ negative on both sides.
    isolated: Vec<N>,
}
