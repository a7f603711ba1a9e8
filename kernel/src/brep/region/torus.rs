//! Paths between the loops of a torus: both circles through each loop, then paths to the first
//! loop.

use super::following::PathEnd;
use super::{STARTS, Sorter};
use crate::brep::surface_path::{DirectedArc, SurfacePath};
use crate::brep::topology::Sense;
use crate::geometry::surface::Torus;
use crate::geometry::torus_curve::wrap;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

impl<N: Float> Sorter<'_, N> {
    /// Both circles through a point of the loop, and a path to the first loop.
    pub(super) fn walk_torus(
        &mut self,
        t: Torus<N>,
        ring: usize,
        arc: usize,
        p: &Point3<N>,
        left: &Vector3<N>,
    ) -> bool {
        let (mut tubes, mut rounds) = (false, false);
        for sense in [Sense::Along, Sense::Against] {
            let tube = SurfacePath::tube(&t, p, sense);
            tubes |= self.follow(ring, arc, p, left, &[tube], PathEnd::Surface);
            if let Some(round) = SurfacePath::parallel(self.surface, p, sense, self.resolution) {
                rounds |= self.follow(ring, arc, p, left, &[round], PathEnd::Surface);
            }
        }
        // Every circle of the tube crosses a loop that winds around the axis, and every parallel
        // one that winds around the tube. Then no other path is needed.
        let [around, along] = self.winding;
        if around || along {
            let direct = (around && tubes) || (along && rounds);
            return direct || self.turn_to_winding(&t, ring, arc, p, left);
        }
        (tubes || rounds) && (ring == 0 || self.way_to_first(t, ring, arc, p, left))
    }

    /// A path along one circle to another that crosses the winding loops, for where the circles
    /// through the point itself run along edges.
    fn turn_to_winding(
        &mut self,
        t: &Torus<N>,
        ring: usize,
        arc: usize,
        p: &Point3<N>,
        left: &Vector3<N>,
    ) -> bool {
        let [around, along] = self.winding;
        for turn in [N::from_f64(0.4), N::from_f64(2.6), N::from_f64(4.3)] {
            for sense in [Sense::Along, Sense::Against] {
                let leg = SurfacePath::tube(t, p, sense).upto(turn * t.minor);
                let corner = leg.point(turn * t.minor);
                if let (true, Some(round)) = (
                    along,
                    SurfacePath::parallel(self.surface, &corner, sense, self.resolution),
                ) && self.follow(ring, arc, p, left, &[leg, round], PathEnd::Surface)
                {
                    return true;
                }
                let Some(round) = SurfacePath::parallel(self.surface, p, sense, self.resolution)
                else {
                    continue;
                };
                let radius = t.frame.coordinates(p).xy().length();
                let leg = round.upto(turn * radius);
                let tube = SurfacePath::tube(t, &leg.point(turn * radius), sense);
                if around && self.follow(ring, arc, p, left, &[leg, tube], PathEnd::Surface) {
                    return true;
                }
            }
        }
        false
    }

    /// A path around the axis, then around the tube, to a point of the first loop.
    fn way_to_first(
        &mut self,
        t: Torus<N>,
        ring: usize,
        arc: usize,
        p: &Point3<N>,
        left: &Vector3<N>,
    ) -> bool {
        let heights = [
            Height::First,
            Height::Last,
            Height::At(N::from_f64(0.4)),
            Height::At(N::from_f64(2.6)),
            Height::At(N::from_f64(4.3)),
        ];
        for &fraction in &STARTS {
            for goal in 0..self.firsts[1] {
                let q = self.start_on(goal, N::from_f64(fraction));
                // The path ends just before the first loop: within its face, or on its other side,
                // where the face at the same edge belongs to another loop.
                for height in heights {
                    let Some(legs) = self.legs(&t, p, &q.point, height) else {
                        continue;
                    };
                    let from_left =
                        |leg: &SurfacePath<N>| leg.direction(&q.point).dot(&q.left).is_below_zero();
                    let is_left = legs.last().is_some_and(from_left);
                    let twin = self.twin(goal).filter(|_| !is_left);
                    let end = PathEnd::Arc {
                        ring: self.owner[twin.unwrap_or(goal)],
                        is_inside: is_left || twin.is_some(),
                    };
                    if self.follow(ring, arc, p, left, &legs, end) {
                        return true;
                    }
                }
            }
        }
        false
    }

    /// A path from `p` almost to `q`: along a circle of the tube, a parallel and a circle of the
    /// tube. The parallel lies at the tube angle of one of the two points, or at another one.
    fn legs(
        &self,
        t: &Torus<N>,
        p: &Point3<N>,
        q: &Point3<N>,
        height: Height<N>,
    ) -> Option<Vec<SurfacePath<N>>> {
        let ([u, v], [x, y]) = (self.surface.parameters(p), self.surface.parameters(q));
        let toward = |a: N| {
            if a.is_above_zero() {
                Sense::Along
            } else {
                Sense::Against
            }
        };
        let turn = wrap(x - u);
        let round = |w: N| {
            let from = self.surface.point(u, w);
            let walk = SurfacePath::parallel(self.surface, &from, toward(turn), self.resolution)?;
            Some((walk, turn.abs() * (t.major + t.minor * w.cos())))
        };
        let tube = |from: &Point3<N>, rise: N| {
            let walk = SurfacePath::tube(t, from, toward(rise));
            (walk, rise.abs() * t.minor)
        };
        let mut legs = match height {
            Height::First => vec![round(v)?, tube(&self.surface.point(x, v), wrap(y - v))],
            Height::Last => vec![tube(p, wrap(y - v)), round(y)?],
            Height::At(w) => vec![
                tube(p, wrap(w - v)),
                round(w)?,
                tube(&self.surface.point(x, w), wrap(y - w)),
            ],
        };
        if let Some((_, length)) = legs.last_mut() {
            *length -= N::from_f64(64.0) * self.resolution;
        }
        let cut = |(walk, length): (SurfacePath<N>, N)| walk.upto(length.max(N::ZERO));
        Some(legs.into_iter().map(cut).collect())
    }

    /// The winding of a loop in the two angles of a torus.
    pub(super) fn turns(&self, ring: &[DirectedArc<'_, N>]) -> Turns<N> {
        let mut at = [N::ZERO; 2];
        let mut runs = Vec::with_capacity(ring.len());
        for arc in ring {
            let run = Run::along(&self.angles_along(arc), at);
            at = run.ends[1];
            runs.push(run);
        }
        let swept = ring.iter().zip(&runs).map(|(a, run)| {
            let is_back = |b: &DirectedArc<'_, N>| a.shares_edge(b) && a.sense != b.sense;
            match ring.iter().position(is_back) {
                Some(back) => run.swept_with(&runs[back]),
                None => run.swept,
            }
        });
        Turns {
            winds: at.map(|turn| turn.abs().is_beyond(N::TAU / N::TWO)),
            area: swept.sum::<N>() * self.outward.sign::<N>(),
        }
    }

    /// The angles of points along an arc, including its ends.
    fn angles_along(&self, arc: &DirectedArc<'_, N>) -> [[N; 2]; 33] {
        let [from, to] = match arc.sense {
            Sense::Along => arc.range,
            Sense::Against => [arc.range[1], arc.range[0]],
        };
        std::array::from_fn(|k| {
            let part = N::whole(k as u32) / N::from_f64(32.0);
            let t = from + part * (to - from);
            self.surface.parameters(&arc.curve.point(t))
        })
    }
}

/// The course of an arc in the two angles of a torus, continued without jumps from the loop's
/// start.
struct Run<N> {
    ends: [[N; 2]; 2],
    /// Twice the area between the arc and the loop's start.
    swept: N,
}

impl<N: Float> Run<N> {
    fn along(angles: &[[N; 2]], start: [N; 2]) -> Self {
        let ([mut x, mut y], mut swept) = (start, N::ZERO);
        for pair in angles.windows(2) {
            let (p, q) = (pair[0], pair[1]);
            let (dx, dy) = (wrap(q[0] - p[0]), wrap(q[1] - p[1]));
            swept += x * dy - y * dx;
            x += dx;
            y += dy;
        }
        Self {
            ends: [start, [x, y]],
            swept,
        }
    }

    /// Half of the area swept by two opposite runs over one arc. It is zero except for whole turns
    /// of the loop between them. If they were summed separately, rounding would leave an area of
    /// either sign.
    fn swept_with(&self, back: &Self) -> N {
        let [from, to] = self.ends;
        let apart = |i: usize| ((from[i] - back.ends[1][i]) / N::TAU).round() * N::TAU;
        let way = |i: usize| to[i] - from[i];
        N::HALF * (apart(0) * way(1) - apart(1) * way(0))
    }
}

/// The tube angle at which a path on a torus goes around the axis.
#[derive(Clone, Copy)]
enum Height<N: Float = f64> {
    /// That of the path's start.
    First,
    /// That of the path's end.
    Last,
    At(N),
}

/// The winding of a loop on a torus.
pub(super) struct Turns<N: Float = f64> {
    /// Whether it winds around the axis, and around the tube.
    pub winds: [bool; 2],
    /// For a loop that does not wind: positive if it is counterclockwise.
    pub area: N,
}

impl<N: Float> Turns<N> {
    /// Whether it winds at all.
    pub fn winds(&self) -> bool {
        self.winds.contains(&true)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brep::region::{Region, regions};
    use crate::geometry::curve::{Circle, Curve};
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::Surface;
    use std::f64::consts::TAU;

    fn torus() -> Torus {
        Torus {
            frame: Frame::world(),
            major: 2.0,
            minor: 0.75,
        }
    }

    fn parallel(phi: f64) -> Curve {
        let Torus {
            frame: f,
            major,
            minor,
        } = torus();
        Curve::Circle(Circle {
            frame: f.at(f.point(0.0, 0.0, minor * phi.sin())),
            radius: major + minor * phi.cos(),
        })
    }

    fn tube(theta: f64) -> Curve {
        let Torus {
            frame: f,
            major,
            minor: radius,
        } = torus();
        let radial = f.x * theta.cos() + f.y * theta.sin();
        let frame = Frame {
            origin: f.origin + radial * major,
            x: radial,
            y: f.z,
            z: radial.cross(&f.z),
        };
        Curve::Circle(Circle { frame, radius })
    }

    /// The loops of a torus without the part between two angles about its axis, and those of the
    /// hole between these angles.
    #[test]
    fn a_hole_in_a_torus_that_is_cut_through_belongs_to_what_is_left() {
        let arc = |curve, range, sense| DirectedArc {
            curve,
            range,
            sense,
        };
        let (start, end) = (tube(1.0), tube(5.0));
        let (low, high, a, b) = (parallel(0.4), parallel(1.2), tube(2.0), tube(3.0));
        let left = [
            vec![arc(&start, [0.0, TAU], Sense::Against)],
            vec![arc(&end, [0.0, TAU], Sense::Along)],
            vec![
                arc(&low, [2.0, 3.0], Sense::Against),
                arc(&a, [0.4, 1.2], Sense::Along),
                arc(&high, [2.0, 3.0], Sense::Along),
                arc(&b, [0.4, 1.2], Sense::Against),
            ],
        ];
        let surface = Surface::Torus(torus());
        for turn in 0..3 {
            let loops: Vec<_> = (0..3).map(|k| left[(turn + k) % 3].clone()).collect();
            let found = regions(&surface, Sense::Along, &loops, 1e-10).unwrap();
            let whole = Region {
                loops: vec![0, 1, 2],
                euler: -1,
            };
            assert_eq!(found, [whole]);
        }
    }

    /// Two holes next to the outer parallel, with a sliver of 40 resolutions between them. The circles
    /// through the start of the wide hole do not meet the other one, and the way to it ends 64
    /// resolutions before it, in the wide hole.
    #[test]
    fn holes_with_a_sliver_between_them_are_of_one_face() {
        const RESOLUTION: f64 = 1e-10;
        let apart = 20.0 * RESOLUTION / torus().minor;
        let holes = [([apart, 0.8], [4.3, 4.7]), ([-0.8, -apart], [1.0, 5.0])];
        let circles = holes.map(|(angles, turns)| (turns.map(tube), angles.map(parallel)));
        let [narrow, wide] = [0, 1].map(|k| {
            let ((angles, turns), (tubes, parallels)) = (holes[k], &circles[k]);
            let arc = |curve, range, sense| DirectedArc {
                curve,
                range,
                sense,
            };
            vec![
                arc(&tubes[0], angles, Sense::Along),
                arc(&parallels[1], turns, Sense::Along),
                arc(&tubes[1], angles, Sense::Against),
                arc(&parallels[0], turns, Sense::Against),
            ]
        });
        let surface = Surface::Torus(torus());
        for turn in 0..4 {
            let mut first = narrow.clone();
            first.rotate_left(turn);
            for loops in [[first.clone(), wide.clone()], [wide.clone(), first]] {
                let found = regions(&surface, Sense::Along, &loops, RESOLUTION).unwrap();
                let whole = Region {
                    loops: vec![0, 1],
                    euler: -2,
                };
                assert_eq!(found, [whole]);
            }
        }
    }
}
