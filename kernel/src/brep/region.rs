//! Groups the loops of one surface into the regions that they bound.
//!
//! From each loop a path runs over the surface: along a line of a plane, a ruling of a cylinder or a
//! cone, a meridian of a torus that reaches its axis, a great circle of a sphere to a fixed point. On a
//! plane or a cylinder with many edges it ends at the next loop, otherwise at the end of the surface.
//! Between entering the boundary and leaving it the path is in one region, so the two loops that it
//! crosses bound the same region. Every loop of these surfaces separates the surface (Jordan), so these pairs connect all
//! loops of a region. On a ring torus both circles through each loop are followed, and paths to the
//! first loop.

mod following;
mod torus;

use super::arcs::{Arcs, reaches_from_above};
use super::surface_path::{DirectedArc, SurfacePath};
use super::topology::Sense;
use crate::geometry::bounds::Aabb;
use crate::geometry::frame::perpendicular;
use crate::geometry::surface::{Plane, Surface};
use crate::geometry::vector::{Length, rounded};
use crate::number::float::Float;
use crate::number::predicates::Compare;
use following::PathEnd;
use nalgebra::{Point3, Rotation3, Unit, Vector3};
use torus::Turns;

/// A region: the loops that bound it, by index, and its Euler characteristic.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Region {
    /// The loops, in increasing order.
    pub loops: Vec<usize>,
    /// 2 minus the number of loops, for a part of a sphere.
    pub euler: i32,
}

/// The loops of a surface cannot be grouped into regions.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("the loops of a surface around ({:.9}, {:.9}, {:.9}) bound no regions", place[0], place[1], place[2])]
pub struct RegionError {
    /// A point of one of them.
    pub place: [f64; 3],
}

/// The least sine of the angle between a path and the arc that it leaves.
const SLANT: f64 = 0.02;

/// The fractions of an arc at which a path may start.
const STARTS: [f64; 7] = [0.5, 0.31, 0.73, 0.11, 0.87, 0.42, 0.66];

/// The number of directions tried.
const ATTEMPTS: usize = 4;

/// A point of a loop from which paths start.
struct Start<N: Float = f64> {
    arc: usize,
    point: Point3<N>,
    /// The direction into the face.
    left: Vector3<N>,
}

struct Sorter<'a, N: Float = f64> {
    surface: &'a Surface<N>,
    outward: Sense,
    arcs: Arcs<'a, N>,
    /// The loop of each arc.
    owner: Vec<usize>,
    /// The first arc of each loop, and one past the last.
    firsts: Vec<usize>,
    resolution: N,
    /// The size of all arcs.
    size: f64,
    parent: Vec<usize>,
    /// Whether a loop on a torus winds around the axis and around the tube.
    winding: [bool; 2],
}

/// The regions of `surface` bounded by `loops`, the region to the left of each, seen from outside.
pub(super) fn regions<'a, N: Float>(
    surface: &'a Surface<N>,
    outward: Sense,
    loops: &[Vec<DirectedArc<'a, N>>],
    resolution: N,
) -> Result<Vec<Region>, RegionError> {
    let mut owner = Vec::new();
    let mut arcs = Vec::new();
    let mut firsts = vec![0];
    for (i, ring) in loops.iter().enumerate() {
        owner.extend(ring.iter().map(|_| i));
        arcs.extend(ring.iter().copied());
        firsts.push(arcs.len());
    }
    let arcs = Arcs::new(arcs, resolution);
    let all = arcs.boxes.iter().fold(Aabb::EMPTY, |all, b| all.hull(b));
    // One entry per loop, and one for each attempt's fixed point of a sphere or a cone.
    let parent = (0..loops.len() + ATTEMPTS).collect();
    let mut sorter = Sorter {
        surface,
        outward,
        arcs,
        owner,
        firsts,
        resolution,
        size: all.diagonal(),
        parent,
        winding: [false; 2],
    };
    if surface.is_ring_torus() {
        for ring in loops {
            let [around, along] = sorter.turns(ring).winds;
            sorter.winding[0] |= around;
            sorter.winding[1] |= along;
        }
    }
    if loops.len() > 1 {
        sorter.connect_all(loops.len())?;
    }
    let mut lists: Vec<Vec<usize>> = vec![Vec::new(); loops.len() + 1];
    for i in 0..loops.len() {
        let root = sorter.find(i);
        lists[root].push(i);
    }
    let mut regions = Vec::new();
    for list in lists.into_iter().filter(|l| !l.is_empty()) {
        let euler = sorter.euler(loops, &list);
        regions.push(Region { loops: list, euler });
    }
    Ok(regions)
}

impl<N: Float> Sorter<'_, N> {
    fn find(&mut self, mut i: usize) -> usize {
        while self.parent[i] != i {
            self.parent[i] = self.parent[self.parent[i]];
            i = self.parent[i];
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        self.parent[a.max(b)] = a.min(b);
    }

    /// Joins all loops that bound a common region. All paths of an attempt lead to one goal, so
    /// they must all succeed in the same attempt.
    fn connect_all(&mut self, loops: usize) -> Result<(), RegionError> {
        let mut failed = None;
        for attempt in 0..ATTEMPTS {
            failed = (0..loops).find_map(|ring| self.connect(ring, attempt));
            if failed.is_none() {
                break;
            }
        }
        failed.map_or(Ok(()), Err)
    }

    /// Joins a loop to those that bound the same region. Returns `None` if a path was clear,
    /// otherwise an error at a point of the loop.
    fn connect(&mut self, ring: usize, attempt: usize) -> Option<RegionError> {
        if leads_down(self.surface) {
            return self.connect_ruled(ring, attempt);
        }
        let mut place = [0.0; 3];
        // All paths of an attempt in a plane should have one direction: those that lead into the
        // face are first.
        for leads_in in [true, false] {
            for &fraction in &STARTS {
                for arc in self.firsts[ring]..self.firsts[ring + 1] {
                    let start = self.start_on(arc, N::from_f64(fraction));
                    place = rounded(&start.point);
                    if self.leads_in(&start, attempt) == leads_in
                        && self.walk_from(ring, &start, attempt)
                    {
                        return None;
                    }
                }
            }
        }
        Some(RegionError { place })
    }

    /// Whether the direction of an attempt leads from a point of a loop into the face.
    fn leads_in(&self, start: &Start<N>, attempt: usize) -> bool {
        match self.surface {
            Surface::Plane(plane) => direction_in_plane(plane, attempt)
                .dot(&start.left)
                .reaches(N::from_f64(SLANT)),
            _ => true,
        }
    }

    /// The points of a loop from which paths may start.
    fn starts(&self, ring: usize) -> Vec<Start<N>> {
        let mut starts = Vec::new();
        for &fraction in &STARTS {
            let arcs = self.firsts[ring]..self.firsts[ring + 1];
            starts.extend(arcs.map(|arc| self.start_on(arc, N::from_f64(fraction))));
        }
        starts
    }

    /// The point of an arc at a fraction of its range.
    fn start_on(&self, arc: usize, fraction: N) -> Start<N> {
        let a = &self.arcs.all[arc];
        let t = a.range[0] + fraction * (a.range[1] - a.range[0]);
        let point = a.curve.point(t);
        let tangent = a.curve.tangent(t) * a.sense.sign::<N>();
        let normal = self.surface.normal(&point) * self.outward.sign::<N>();
        let left = normal.cross(&tangent);
        Start { arc, point, left }
    }

    /// Follows the rulings of a cylinder or a cone, or the meridians of a torus that reaches its axis,
    /// downwards to the lowest loop of the region. If
    /// the region does not lie below a starting point, the path starts on the loop's other side and
    /// reaches the region through the loop itself, unless the loop is the lowest. If all paths are
    /// unclear, or the loop consists of rulings, the path first turns along a parallel.
    fn connect_ruled(&mut self, ring: usize, attempt: usize) -> Option<RegionError> {
        let starts = self.starts(ring);
        let down = |start: &Start<N>| {
            let walk = self.down(&start.point)?;
            let heading = walk.direction(&start.point).dot(&start.left);
            Some((heading, walk))
        };
        let mut walks: Vec<_> = starts.iter().map(|s| (s, down(s))).collect();
        // Start with those below which the region lies.
        walks.sort_by_key(|(_, down)| !down.as_ref().is_some_and(|d| d.0.is_above_zero()));
        for (start, down) in walks {
            if let Some((_, walk)) = down
                && (self.follow_to_next(ring, start, &walk)
                    || self.follow_down(ring, start, vec![walk], attempt))
            {
                return None;
            }
        }
        let turn = N::HALF + N::from_f64(0.7) * N::from_f64(attempt as f64);
        let turned = starts
            .iter()
            .any(|start| self.turn_down(ring, start, turn, attempt));
        let place = starts.first().map_or([0.0; 3], |s| rounded(&s.point));
        (!turned).then_some(RegionError { place })
    }

    /// The path down the ruling or the meridian through a point.
    fn down(&self, p: &Point3<N>) -> Option<SurfacePath<N>> {
        if let Surface::Torus(torus) = self.surface {
            return Some(SurfacePath::meridian(torus, p, Sense::Against));
        }
        let [u, _] = self.surface.parameters(p);
        Some(SurfacePath::ruling(self.surface, p, u, Sense::Along)?.reversed())
    }

    /// Follows legs, the last of which leads downwards. Where loops pass through the apex below, the
    /// path goes around it just before it, to the loop that bounds the sector from which it
    /// came. The distance from the apex grows with each attempt, for loops that are tangent there.
    fn follow_down(
        &mut self,
        ring: usize,
        start: &Start<N>,
        mut legs: Vec<SurfacePath<N>>,
        attempt: usize,
    ) -> bool {
        let mut end = PathEnd::Surface;
        if let Some(apex) = lowest(self.surface)
            && let Some(down) = legs.pop()
        {
            let height = down.at(&apex);
            let mut ends: Vec<usize> = self.arcs.around(&apex).collect();
            ends.retain(|&i| self.arcs.ends_at(i, &apex, self.resolution));
            let is_passed = ends.iter().any(|&i| self.is_below(i, &apex));
            let near = match ends.is_empty() {
                true => N::ZERO,
                false => (self.resolution / height).approximate_root(2 + attempt as u32),
            };
            let height = height * (N::ONE - near);
            if is_passed {
                let corner = down.point(height);
                let Some(round) =
                    SurfacePath::parallel(self.surface, &corner, Sense::Along, self.resolution)
                else {
                    return false;
                };
                legs.extend([down.upto(height), round]);
            } else {
                end = PathEnd::Point(self.parent.len() - 1);
                legs.push(down.upto(height));
            }
        }
        self.follow(ring, start.arc, &start.point, &start.left, &legs, end)
    }

    /// Whether an arc that ends at the lowest point arrives there from where downward paths do. Both
    /// poles of a horn torus are one point, and an arc may reach it from above.
    fn is_below(&self, arc: usize, lowest: &Point3<N>) -> bool {
        let Surface::Torus(torus) = self.surface else {
            return true;
        };
        let DirectedArc { curve, range, .. } = self.arcs.all[arc];
        let arrives = |[end, other]: [N; 2]| {
            let gap = (curve.point(end) - lowest).length();
            gap.is_within(self.resolution) && !reaches_from_above(torus, curve, [end, other])
        };
        !torus.is_horn() || arrives(range) || arrives([range[1], range[0]])
    }

    /// A turn along the parallel into the face, then downwards.
    fn turn_down(&mut self, ring: usize, start: &Start<N>, turn: N, attempt: usize) -> bool {
        let p = &start.point;
        let Some(round) = SurfacePath::parallel(self.surface, p, Sense::Along, self.resolution)
        else {
            return false;
        };
        let round = round.toward(p, &start.left);
        let length = turn * self.surface.frame().coordinates(p).xy().length();
        match self.down(&round.point(length)) {
            Some(down) => {
                let legs = vec![round.upto(length), down];
                self.follow_down(ring, start, legs, attempt)
            }
            None => false,
        }
    }

    /// Follows a path from a point of a loop; false if it was unclear.
    fn walk_from(&mut self, ring: usize, start: &Start<N>, attempt: usize) -> bool {
        let Start { arc, point, left } = start;
        match self.surface {
            Surface::Torus(t) => self.walk_torus(*t, ring, *arc, point, left),
            Surface::Sphere(_) | Surface::Ellipsoid(_) => {
                let goal = self.parent.len() - ATTEMPTS + attempt;
                let target = pole(self.surface, attempt);
                let Some(walk) = SurfacePath::central(self.surface, point, &target) else {
                    return false;
                };
                let walk = walk.toward(point, left);
                let walk = walk.upto(walk.at(&target));
                self.follow(ring, *arc, point, left, &[walk], PathEnd::Point(goal))
            }
            Surface::Plane(plane) => {
                let d = direction_in_plane(plane, attempt);
                let walk = SurfacePath::straight(plane, point, d).toward(point, left);
                let is_reversed = walk.direction(point).dot(&d).is_below_zero();
                if !is_reversed && self.follow_to_next(ring, start, &walk) {
                    return true;
                }
                self.follow(ring, *arc, point, left, &[walk], PathEnd::Surface)
            }
            Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => false,
        }
    }

    /// The Euler characteristic of a region.
    fn euler(&self, loops: &[Vec<DirectedArc<'_, N>>], list: &[usize]) -> i32 {
        let n = list.len() as i32;
        if !self.surface.is_ring_torus() {
            return 2 - n;
        }
        // A region with a loop that is not contractible is an annulus with holes; one with a
        // counterclockwise loop is a disc with holes; any other is a torus with holes.
        let turns: Vec<Turns<N>> = list.iter().map(|&i| self.turns(&loops[i])).collect();
        let is_part_of_sphere = turns.iter().any(|t| t.winds() || t.area.is_above_zero());
        if is_part_of_sphere { 2 - n } else { -n }
    }
}

/// The direction of all paths of an attempt in a plane.
fn direction_in_plane<N: Float>(plane: &Plane<N>, attempt: usize) -> Vector3<N> {
    let angle = N::from_f64(0.7) + N::from_f64(1.9) * N::from_f64(attempt as f64);
    plane.frame.x * angle.cos() + plane.frame.y * angle.sin()
}

/// Whether paths down the rulings or the meridians of a surface connect its loops.
fn leads_down<N: Float>(surface: &Surface<N>) -> bool {
    match surface {
        Surface::Cylinder(_)
        | Surface::Cone(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_) => true,
        Surface::Torus(torus) => !torus.is_ring(),
        Surface::Plane(_) | Surface::Sphere(_) | Surface::Ellipsoid(_) => false,
    }
}

/// The point in which all paths downwards end: the apex of a cone, the lower pole of a torus.
fn lowest<N: Float>(surface: &Surface<N>) -> Option<Point3<N>> {
    surface.apexes().last()
}

/// A point of a sphere or an ellipsoid that is unlikely to be special; a different one for each
/// attempt.
fn pole<N: Float>(surface: &Surface<N>, attempt: usize) -> Point3<N> {
    let d = Vector3::new(0.379_2, -0.562_7, 0.734_6).unit();
    let about = Unit::new_normalize(perpendicular(&d) + d * 0.3);
    let d = Rotation3::from_axis_angle(&about, 1.1 * attempt as f64) * d;
    let (d, frame) = (d.map(N::from_f64).unit(), surface.frame());
    match surface {
        Surface::Sphere(s) => frame.origin + d * s.radius,
        Surface::Ellipsoid(s) => frame.origin + frame.vector(&s.image(&d)),
        _ => frame.origin,
    }
}

#[cfg(test)]
mod tests;
