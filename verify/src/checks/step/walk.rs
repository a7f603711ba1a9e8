//! The integrals over a face along its loops, which are followed in the parameters of the surface.

use super::curve::{StepCurve, StepCurvePoint};
use super::shape::{StepEdge, StepEdgeUse, StepFace, StepShape};
use super::surface::{FaceQuantity, Pole, StepSurface};
use nalgebra::Point3;
use std::f64::consts::{PI, TAU};

/// What is integrated, with the scale of the part.
#[derive(Clone, Copy, Debug)]
pub struct FaceIntegral {
    pub quantity: FaceQuantity,
    /// The point about which the volume is integrated.
    pub about: Point3<f64>,
    /// The diagonal of the part's bounding box.
    pub size: f64,
}

/// The integral along a loop.
#[derive(Clone, Copy, Debug)]
pub struct LoopIntegral {
    /// The integral; none if an edge passes through a pole.
    pub sum: Option<f64>,
    /// The gap in both parameters, if the loop is open by more than its accuracy.
    pub open: Option<[f64; 2]>,
}

impl FaceIntegral {
    /// The integral along a loop of a face.
    pub fn along(&self, shape: &StepShape, face: &StepFace, ring: &[StepEdgeUse]) -> LoopIntegral {
        let surface = &shape.surfaces[&face.surface];
        // The integral along a loop that closes in the parameters does not depend on the v₀ at which P
        // is zero. With v₀ next to the loop, P is small on a short loop, and its rounding too. Where
        // the loop passes a pole, v₀ is at that pole: there the angle is less accurate, and P is zero. The
        // surface's formulas start at the south pole.
        let next_to_loop = ring.first().map(|used| {
            let edge = &shape.edges[&used.edge];
            let [from, to] = edge.range;
            surface.parameters(&edge.curve.at(0.5 * (from + to)).point)[1]
        });
        let walk = self.walk(shape, face, ring, next_to_loop);
        let walk = match walk.passed {
            [false, false] => walk,
            [false, true] => self.walk(shape, face, ring, surface.north_of_sheet()),
            [true, _] => self.walk(shape, face, ring, None),
        };
        let Walk { flow, is_clear, .. } = walk;
        let open = walk.gap;
        let is_open = open[0].abs() > GAP * if surface.has_angle() { 1.0 } else { self.size }
            || open[1].abs() > GAP * self.size.max(1.0);
        LoopIntegral {
            sum: is_clear.then_some(flow),
            open: (is_clear && is_open).then_some(open),
        }
    }

    /// The walk along a loop, with P zero at v₀, or where the surface's formulas have its zero.
    fn walk<'s>(
        &self,
        shape: &'s StepShape,
        face: &StepFace,
        ring: &[StepEdgeUse],
        zero: Option<f64>,
    ) -> Walk<'s> {
        let surface = &shape.surfaces[&face.surface];
        let scale = match self.quantity {
            FaceQuantity::Volume => self.size.powi(3),
            FaceQuantity::Area => self.size.powi(2),
        };
        let mut walk = Walk {
            surface,
            quantity: self.quantity,
            about: self.about,
            at: None,
            first: None,
            flow: 0.0,
            pole: None,
            first_from_pole: None,
            cusp: None,
            along: face.along,
            tolerance: self.size * POLE,
            fine: scale * FINE,
            is_clear: true,
            zero,
            passed: [false; 2],
            gap: [0.0; 2],
        };
        for used in ring {
            walk.add(&shape.edges[&used.edge], *used);
        }
        walk.gap = walk.close();
        walk
    }
}

/// The end of an edge at a pole.
#[derive(Clone, Copy)]
struct PoleArrival {
    pole: Pole,
    /// The parameter u with which the edge arrives.
    u: f64,
    used: StepEdgeUse,
}

/// A pole at which two edges meet.
#[derive(Clone, Copy)]
struct PoleCusp {
    pole: Pole,
    /// The parameter u with which the first edge arrives.
    u: f64,
}

/// The integral of P du along a piece of a curve.
#[derive(Clone, Copy)]
struct PieceIntegral {
    sum: f64,
    /// The parameters at the end of the piece.
    end: [f64; 2],
}

/// A position in the parameters of a surface that moves along a loop.
struct Walk<'s> {
    surface: &'s StepSurface,
    quantity: FaceQuantity,
    about: Point3<f64>,
    /// u and v, continued without jumps; `None` at a pole before the first edge.
    at: Option<[f64; 2]>,
    first: Option<[f64; 2]>,
    /// Minus the integral of P du.
    flow: f64,
    /// The pole at which the last edge ended.
    pole: Option<PoleArrival>,
    /// The first edge, if it starts at a pole.
    first_from_pole: Option<StepEdgeUse>,
    /// A pole at which two edges meet. If they have the same direction, or turn away from it at
    /// once, one more or one less turn may lie between them.
    cusp: Option<PoleCusp>,
    /// Whether loops are counterclockwise as seen along the surface's normal.
    along: bool,
    /// The distance from a pole within which a point is at the pole.
    tolerance: f64,
    /// The allowed error of a piece's integral.
    fine: f64,
    is_clear: bool,
    /// The v at which P is zero, if it is not that of the surface's formulas.
    zero: Option<f64>,
    /// Whether an edge starts or ends at the south and the north pole.
    passed: [bool; 2],
    /// The gap in both parameters after the last edge.
    gap: [f64; 2],
}

/// The distance from a pole, relative to the size, within which a point is at the pole.
const POLE: f64 = 1.0 / (1u64 << 30) as f64;

/// The relative gap allowed in loops: vertices and curves are f64, and splines approximate.
const GAP: f64 = 1.0 / 1024.0;

/// The allowed relative error for a piece of an edge.
const FINE: f64 = 1.0 / (1u64 << 42) as f64;

/// Gauss's five-point rule: nodes and weights without the middle one.
const GAUSS: [[f64; 2]; 2] = [
    [0.538_469_310_105_683_1, 0.478_628_670_499_366_47],
    [0.906_179_845_938_664, 0.236_926_885_056_189_08],
];
/// The weight of the middle node.
const CENTRE: f64 = 128.0 / 225.0;

/// The fraction of an edge's first piece at which a point is near the edge's end.
const NEAR_END: f64 = 1.0 / 16.0;

/// The number of times that a piece is halved for the accuracy of its integral.
const HALVED: u32 = 12;

/// The number of times that a piece is halved until the angle turns little: next to an apex it turns
/// within a part of the piece as short as the distance from the apex.
const HALVED_FOR_TURNS: u32 = 40;

impl Walk<'_> {
    /// Moves along an edge.
    fn add(&mut self, edge: &StepEdge, used: StepEdgeUse) {
        let along = used.along;
        let mut stops = edge.curve.stops(edge.range);
        if !along {
            stops.reverse();
        }
        let (start, end) = match along {
            true => (edge.points[0], edge.points[1]),
            false => (edge.points[1], edge.points[0]),
        };
        let ([first, second, ..], [.., before, last]) = (&stops[..], &stops[..]) else {
            return;
        };
        let inside = |a: f64, b: f64| edge.curve.at(a + NEAR_END * (b - a)).point;
        let poles = [
            (start, inside(*first, *second)),
            (end, inside(*last, *before)),
        ];
        let poles = poles.map(|(p, inner)| self.surface.pole(&p, &inner, self.tolerance));
        for pole in poles.into_iter().flatten() {
            self.passed[usize::from(pole == Pole::North)] = true;
        }
        for (k, pair) in stops.windows(2).enumerate() {
            // Between the ends, so that no angle is evaluated at a pole.
            let (is_first, is_last) = (k == 0, k + 2 == stops.len());
            let inner = (pair[1] - pair[0]) * self.surface.next_to_pole();
            let from = if is_first && poles[0].is_some() {
                pair[0] + inner
            } else {
                pair[0]
            };
            let to = if is_last && poles[1].is_some() {
                pair[1] - inner
            } else {
                pair[1]
            };
            if is_first {
                self.enter(&edge.curve, from, poles[0].map(|_| used));
            }
            self.piece(&edge.curve, [from, to], 0);
        }
        let ended = poles[1].zip(self.at);
        self.pole = ended.map(|(pole, [u, _])| PoleArrival { pole, u, used });
    }

    /// Moves to the start of an edge; `from_pole` is the edge if it starts at a pole.
    fn enter(&mut self, curve: &StepCurve, t: f64, from_pole: Option<StepEdgeUse>) {
        let p = curve.at(t).point;
        let there = self.surface.parameters(&p);
        let Some(at) = self.at else {
            self.at = Some(there);
            self.first = self.at;
            self.first_from_pole = from_pole;
            return;
        };
        let mut next = self.nearest_equivalent(there, at);
        if let (Some(last), Some(used)) = (self.pole, from_pole) {
            let is_seam = is_seam(last.used, used);
            next[0] = self.around_pole(last.pole, [last.u, there[0]], is_seam);
            next[1] = there[1];
        }
        self.at = Some(next);
    }

    /// The angle at which a loop leaves a pole: before the angle at which it arrived, as seen with
    /// the pole above. For a returning seam it is a whole turn.
    fn around_pole(&mut self, pole: Pole, [from, to]: [f64; 2], is_seam: bool) -> f64 {
        let down = self.down(pole);
        let mut turned = (down * (to - from)).rem_euclid(TAU);
        if is_seam {
            turned = TAU;
        } else {
            self.cusp = Some(PoleCusp { pole, u: from });
        }
        self.pass_pole(pole, from, down * turned)
    }

    /// The direction of u in which a loop turns at a pole.
    fn down(&self, pole: Pole) -> f64 {
        match (pole == Pole::North) == self.along {
            true => -1.0,
            false => 1.0,
        }
    }

    fn pass_pole(&mut self, pole: Pole, from: f64, turned: f64) -> f64 {
        let to = from + turned;
        // With another v₀, P is zero at the pole that the loop passes.
        if self.zero.is_none() {
            self.flow -= self
                .surface
                .flow_at_pole(self.quantity, pole, [from, to], &self.about);
        }
        to
    }

    /// The equivalent parameters closest to others.
    fn nearest_equivalent(&self, mut there: [f64; 2], at: [f64; 2]) -> [f64; 2] {
        use super::surface::SurfaceForm;
        let periodic = [
            self.surface.has_angle(),
            matches!(self.surface.form, SurfaceForm::Torus { .. }),
        ];
        for i in 0..2 {
            if periodic[i] {
                there[i] += TAU * ((at[i] - there[i]) / TAU).round();
            }
        }
        there
    }

    /// Moves along a piece of a curve. It is halved until it turns little and the quadrature of
    /// both halves agrees with that of the whole.
    fn piece(&mut self, curve: &StepCurve, range: [f64; 2], halved: u32) {
        let Some(at) = self.at else { return };
        let [from, to] = range;
        let middle = 0.5 * (from + to);
        let whole = self.integral(curve, range, at);
        let first = self.integral(curve, [from, middle], at);
        let second = self.integral(curve, [middle, to], first.end);
        let turn = (whole.end[0] - at[0])
            .abs()
            .max((first.end[0] - at[0]).abs());
        let is_fine = (first.sum + second.sum - whole.sum).abs() <= self.fine;
        let turns_little =
            (whole.end[0] - second.end[0]).abs() < 1.0 && (!self.surface.has_angle() || turn < 1.0);
        let is_last = match turns_little {
            true => is_fine || halved >= HALVED,
            false => halved >= HALVED_FOR_TURNS,
        };
        if is_last {
            if self.surface.has_angle() && turn > 0.5 * PI {
                self.is_clear = false;
            }
            self.flow -= first.sum + second.sum;
            self.at = Some(second.end);
            return;
        }
        self.piece(curve, [from, middle], halved + 1);
        self.piece(curve, [middle, to], halved + 1);
    }

    /// The integral along a piece that starts at given parameters.
    fn integral(&self, curve: &StepCurve, [a, b]: [f64; 2], mut at: [f64; 2]) -> PieceIntegral {
        let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
        let [[inner, inner_weight], [outer, outer_weight]] = GAUSS;
        let places = [
            (-outer, outer_weight),
            (-inner, inner_weight),
            (0.0, CENTRE),
            (inner, inner_weight),
            (outer, outer_weight),
        ];
        let mut sum = 0.0;
        for (x, weight) in places {
            let StepCurvePoint { point, derivative } = curve.at(middle + half * x);
            at = self.nearest_equivalent(self.surface.parameters(&point), at);
            let flow = self.potential(at);
            sum += weight * flow * self.surface.u_speed(&point, &derivative);
        }
        let there = self.surface.parameters(&curve.at(b).point);
        PieceIntegral {
            sum: half * sum,
            end: self.nearest_equivalent(there, at),
        }
    }

    /// P at parameters.
    fn potential(&self, [u, v]: [f64; 2]) -> f64 {
        let at = |v| self.surface.flow(self.quantity, [u, v], &self.about);
        at(v) - self.zero.map_or(0.0, at)
    }

    /// Returns to the start, and gives the gap in both parameters.
    fn close(&mut self) -> [f64; 2] {
        let (Some(first), Some(mut at)) = (self.first, self.at) else {
            return [0.0; 2];
        };
        if let (Some(last), Some(used)) = (self.pole, self.first_from_pole) {
            let is_seam = is_seam(last.used, used);
            let angle = self.around_pole(last.pole, [last.u, first[0]], is_seam);
            at = [angle, first[1]];
        }
        let mut open = [at[0] - first[0], at[1] - first[1]];
        if let Some(PoleCusp { pole, u }) = self.cusp {
            let turned = -open[0].signum() * TAU;
            if (open[0] + turned).abs() < GAP {
                self.pass_pole(pole, u, turned);
                open[0] += turned;
            }
        }
        open
    }
}

/// Whether a loop arrives at a pole along an edge and leaves it along the same edge, which is a
/// seam. A single edge from the pole back to it has one sense only.
fn is_seam(last: StepEdgeUse, next: StepEdgeUse) -> bool {
    last.edge == next.edge && last.along != next.along
}
