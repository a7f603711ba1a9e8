//! The walls and ends of prisms and revolutions.

use super::pose::{Pose, up, zero};
use super::{EndRule, HalfSpace, Solid, index};
use crate::evaluate::region::WalledRegion;
use crate::evaluate::section::{Section, SectionEdge, SectionMap};
use crate::evaluate::walls::{self, Wall, WallKind};
use crate::figure::Figure;
use crate::primitive::RevolutionAngle;
use crate::tree::NodeId;
use nalgebra::Vector3;
use premio_kernel::geometry::vector::Length;
use premio_kernel::number::float::Float;
use premio_kernel::number::rational::Rational;

/// A prism with a height and the size of its top relative to its base.
pub(super) fn prism<N: Float>(
    leaf: NodeId,
    pose: &Pose<'_, N>,
    figure: &Figure,
    [height, top]: [&Rational; 2],
) -> Solid<N> {
    let growth = N::nearest(&((top - Rational::ONE) / height));
    let walls = walls::walls(&pose.placed.primitive);
    let map = SectionMap::Prism { growth };
    let section = Section::new(figure, &walls, map, pose.turn, pose.origin);
    let sweep = PrismSweep { pose, height, top };
    let mut sides: Vec<HalfSpace<N>> = Vec::with_capacity(walls.len() + 2);
    sides.extend(
        walls
            .iter()
            .map(|wall| sweep.side(wall, &section.edges[wall.edge])),
    );
    let whole = section.bounds();
    sides.push(sweep.end(whole, [&Rational::ZERO, &Rational::ONE], -N::ONE));
    if !top.is_zero() {
        sides.push(sweep.end(whole, [height, top], N::ONE));
    }
    let [lo, hi] = sweep.box_of(whole);
    Solid {
        leaf,
        index: index(&sides),
        sides,
        region: Some(WalledRegion::Section(section)),
        ends: EndRule::All,
        bounds: pose.boxed(lo, hi),
    }
}

/// The sweep of a figure to a scaled copy above it.
struct PrismSweep<'a, N: Float> {
    pose: &'a Pose<'a, N>,
    height: &'a Rational,
    /// The size of the top relative to the base.
    top: &'a Rational,
}

impl<N: Float> PrismSweep<'_, N> {
    /// The box that a rectangle of the figure's plane sweeps.
    fn box_of(&self, [lo, hi]: [[N; 2]; 2]) -> [[N; 3]; 2] {
        let k = N::nearest(self.top);
        let low: [N; 2] = std::array::from_fn(|i| lo[i].min(lo[i] * k));
        let high: [N; 2] = std::array::from_fn(|i| hi[i].max(hi[i] * k));
        [
            [low[0], low[1], N::ZERO],
            [high[0], high[1], N::nearest(self.height)],
        ]
    }

    /// The side along a wall.
    fn side(&self, wall: &Wall, edge: &SectionEdge<N>) -> HalfSpace<N> {
        let surface = self.pose.wall(wall);
        let [lo, hi] = self.box_of(edge.bounds());
        let hull = match wall.kind {
            WallKind::Plane => {
                let corners = edge.swept_corners(N::nearest(self.height), N::nearest(self.top));
                Some(self.pose.hull_of_polygon(corners.into_iter(), &surface))
            }
            _ => self.pose.hull_of_box(lo, hi),
        };
        HalfSpace {
            bounds: self.pose.boxed(lo, hi),
            hull,
            surface,
        }
    }

    /// The end at a height, with the size of the figure there and the direction of its normal.
    fn end(
        &self,
        whole: [[N; 2]; 2],
        [height, size]: [&Rational; 2],
        up_or_down: N,
    ) -> HalfSpace<N> {
        let (z, k) = (N::nearest(height), N::nearest(size));
        let [lo, hi] = whole.map(|[x, y]| [x * k, y * k, z]);
        HalfSpace {
            surface: self.pose.plane(up(height), Vector3::z() * up_or_down),
            bounds: self.pose.boxed(lo, hi),
            hull: self.pose.hull_of_box(lo, hi),
        }
    }
}

/// A revolution by an angle, or by a whole turn.
pub(super) fn revolution<N: Float>(
    leaf: NodeId,
    pose: &Pose<'_, N>,
    figure: &Figure,
    angle: Option<&RevolutionAngle>,
) -> Solid<N> {
    let primitive = &pose.placed.primitive;
    let walls = walls::walls(primitive);
    let section = Section::new(
        figure,
        &walls,
        SectionMap::Revolution,
        pose.turn,
        pose.origin,
    );
    let box_of = |[lo, hi]: [[N; 2]; 2]| [[-hi[0], -hi[0], lo[1]], [hi[0], hi[0], hi[1]]];
    let side = |surface, [lo, hi]: [[N; 3]; 2]| HalfSpace {
        surface,
        bounds: pose.boxed(lo, hi),
        hull: pose.hull_of_box(lo, hi),
    };
    let mut sides: Vec<HalfSpace<N>> = Vec::with_capacity(walls.len() + 2);
    sides.extend(walls.iter().map(|wall| {
        let edge = &section.edges[wall.edge];
        side(pose.wall(wall), box_of(edge.bounds()))
    }));
    let whole = box_of(section.bounds());
    sides.extend(walls::end_normals(primitive).iter().map(|normal| {
        let normal = Vector3::from(normal.each_ref().map(N::nearest));
        side(pose.plane(zero(), normal.unit()), whole)
    }));
    let [lo, hi] = whole;
    Solid {
        leaf,
        index: index(&sides),
        sides,
        region: Some(WalledRegion::Section(section)),
        ends: match angle.is_some_and(RevolutionAngle::is_reflex) {
            true => EndRule::Any,
            false => EndRule::All,
        },
        bounds: pose.boxed(lo, hi),
    }
}
