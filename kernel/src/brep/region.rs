//! Groups the loops of one surface into the regions that they bound.
//!
//! From each loop a path runs over the surface to its end: along a line of a plane, a ruling of a
//! cylinder or a cone, a meridian of a torus that reaches its axis, a great circle of a sphere to a
//! fixed point. Between entering the boundary
//! and leaving it the path is in one region, so the two loops that it crosses bound the same
//! region. Every loop of these surfaces separates the surface (Jordan), so these pairs connect all
//! loops of a region. On a ring torus both circles through each loop are followed, and paths to the
//! first loop.

mod torus;

use super::arcs::Arcs;
use super::surface_path::{CrossingSense, DirectedArc, PathCrossing, SurfacePath};
use super::topology::Sense;
use crate::geometry::frame::perpendicular;
use crate::geometry::surface::Surface;
use crate::geometry::vector::{Length, rounded};
use crate::number::float::Float;
use crate::number::predicates::Compare;
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

/// What a path over the surface determines.
struct FollowedPath {
    /// The loop through which the path entered the region in which it is.
    inside: Option<usize>,
    /// The same at the start of the last leg.
    before: Option<usize>,
    /// The pairs of loops that bound a common region.
    joined: Vec<[usize; 2]>,
}

impl FollowedPath {
    /// The path with its last region joined to the goal, if it ends in one.
    fn ended_in(mut self, goal: usize) -> Self {
        self.joined.extend(self.inside.map(|from| [from, goal]));
        self
    }
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
    // One entry per loop, and one for each attempt's fixed point of a sphere or a cone.
    let parent = (0..loops.len() + ATTEMPTS).collect();
    let mut sorter = Sorter {
        surface,
        outward,
        arcs,
        owner,
        firsts,
        resolution,
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
        for start in self.starts(ring) {
            place = rounded(&start.point);
            if self.walk_from(ring, &start, attempt) {
                return None;
            }
        }
        Some(RegionError { place })
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
                && self.follow_down(ring, start, vec![walk], attempt)
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
        let mut goal = None;
        if let Some(apex) = lowest(self.surface)
            && let Some(down) = legs.pop()
        {
            let height = down.at(&apex);
            let around = self.arcs.around(&apex);
            let passed = around
                .into_iter()
                .any(|i| self.arcs.ends_at(i, &apex, self.resolution));
            if passed {
                let near = (self.resolution / height).approximate_root(2 + attempt as u32);
                let height = height * (N::ONE - near);
                let corner = down.point(height);
                let round =
                    SurfacePath::parallel(self.surface, &corner, Sense::Along, self.resolution);
                legs.push(down.upto(height));
                legs.extend(round);
            } else {
                goal = Some(self.parent.len() - 1);
                legs.push(down.upto(height));
            }
        }
        self.follow(ring, start.arc, &start.point, &start.left, &legs, goal)
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
                self.follow(ring, *arc, point, left, &[walk], Some(goal))
            }
            Surface::Plane(plane) => {
                let f = &plane.frame;
                let angle = N::from_f64(0.7) + N::from_f64(1.9) * N::from_f64(attempt as f64);
                let d = f.x * angle.cos() + f.y * angle.sin();
                let walk = SurfacePath::straight(plane, point, d).toward(point, left);
                self.follow(ring, *arc, point, left, &[walk], None)
            }
            Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => false,
        }
    }

    /// Follows the legs of a path and joins the loops that it crosses; `goal` is joined if the path
    /// ends inside. The path starts into the region of the loop. A path downwards may also
    /// start into the region on the other side of the edge, if there is one. Returns false if
    /// anything is unclear.
    fn follow(
        &mut self,
        ring: usize,
        arc: usize,
        p: &Point3<N>,
        left: &Vector3<N>,
        legs: &[SurfacePath<N>],
        goal: Option<usize>,
    ) -> bool {
        let heading = legs[0].direction(p).dot(left);
        // A leg that ends close to the arc has not left it; the next leg may lead to its other
        // side.
        let leaves = legs.len() == 1 || legs[0].length().is_beyond(self.start());
        if !leaves {
            return false;
        }
        let Some(inside) = self.entered(ring, arc, heading) else {
            return false;
        };
        let followed = self.followed(inside, arc, legs);
        let ended = match goal {
            Some(goal) => followed.map(|path| path.ended_in(goal)),
            None => followed.and_then(|path| self.closed(path, arc, legs)),
        };
        let Some(path) = ended else {
            return false;
        };
        for [a, b] in path.joined {
            self.join(a, b);
        }
        true
    }

    /// The loop whose region a path enters first, if it enters one; `None` if the path runs along
    /// its starting arc.
    fn entered(&self, ring: usize, arc: usize, heading: N) -> Option<Option<usize>> {
        let is_ruled = leads_down(self.surface);
        if heading.reaches(N::from_f64(SLANT)) {
            Some(Some(ring))
        } else if is_ruled && (-heading).reaches(N::from_f64(SLANT)) {
            Some(self.twin(arc).map(|twin| self.owner[twin]))
        } else {
            None
        }
    }

    /// Follows the legs of a path that starts in a region; `None` if anything is unclear.
    fn followed(
        &self,
        inside: Option<usize>,
        arc: usize,
        legs: &[SurfacePath<N>],
    ) -> Option<FollowedPath> {
        let mut path = FollowedPath {
            inside,
            before: inside,
            joined: Vec::new(),
        };
        for (k, leg) in legs.iter().enumerate() {
            path.before = path.inside;
            for c in self.crossings(leg, (k == 0).then_some(arc))? {
                let passed = self.owner[c.arc];
                match (path.inside, c.passage) {
                    (Some(from), CrossingSense::Leaving) => {
                        path.joined.push([from, passed]);
                        path.inside = None;
                    }
                    (None, CrossingSense::Entering) => path.inside = Some(passed),
                    _ => return None,
                }
            }
        }
        Some(path)
    }

    /// The path with the regions joined in which it returns to its start, if it does; `None` if
    /// that is unclear.
    fn closed(
        &self,
        mut path: FollowedPath,
        arc: usize,
        legs: &[SurfacePath<N>],
    ) -> Option<FollowedPath> {
        match legs {
            // The path returns to its start from the other side: the face bounds itself there.
            [round] if round.closes() => {
                if let Some(from) = path.inside {
                    path.joined.push([from, self.owner[self.twin(arc)?]]);
                }
            }
            // The path returns to the start of its last leg, which is not on an arc.
            [_, .., round] if round.closes() => match (path.inside, path.before) {
                (Some(from), Some(to)) => path.joined.push([from, to]),
                (None, None) => {}
                _ => return None,
            },
            _ => {}
        }
        Some(path)
    }

    /// The distance from a path's start within which its starting arc lies.
    fn start(&self) -> N {
        N::from_f64(64.0) * self.resolution
    }

    /// The arc over the same edge in the opposite direction.
    fn twin(&self, arc: usize) -> Option<usize> {
        let a = &self.arcs.all[arc];
        let mut all = self.arcs.all.iter();
        all.position(|b| a.shares_edge(b) && a.sense != b.sense)
    }

    /// The crossings of a leg in order, without its start on an arc; `None` if one is unclear.
    fn crossings(
        &self,
        walk: &SurfacePath<N>,
        start: Option<usize>,
    ) -> Option<Vec<PathCrossing<N>>> {
        let mut found: Vec<PathCrossing<N>> = Vec::new();
        let mut clear = true;
        self.arcs.hit_by(walk, self.resolution, &mut |i, ranges| {
            // The rest is not needed.
            if !clear {
                return;
            }
            let arc = &self.arcs.all[i];
            // Arcs of both senses run over the starting edge if a face bounds itself there.
            let own = start.is_some_and(|start| arc.shares_edge(&self.arcs.all[start]));
            let mut note = |at: N, t: N, passage: CrossingSense| {
                let here = own && (at.is_at_most(self.start()) || self.is_full_turn(walk, at));
                if !here {
                    clear &= passage != CrossingSense::Unclear;
                    found.push(PathCrossing {
                        at,
                        arc: i,
                        t,
                        passage,
                    });
                }
            };
            walk.intersections(
                self.surface,
                self.outward,
                arc,
                ranges,
                self.resolution,
                &mut note,
            );
        });
        if !clear {
            return None;
        }
        found.sort_by(|a, b| a.at.total_cmp(&b.at).then(a.arc.cmp(&b.arc)));
        // Where faces of one surface share an edge, the path leaves one before it enters the other.
        for k in 1..found.len() {
            let together = (found[k].at - found[k - 1].at).is_at_most(self.resolution);
            if together
                && found[k - 1].passage == CrossingSense::Entering
                && found[k].passage == CrossingSense::Leaving
            {
                found.swap(k - 1, k);
            }
        }
        Some(found)
    }

    /// Whether a closed path is back at its start.
    fn is_full_turn(&self, walk: &SurfacePath<N>, at: N) -> bool {
        let away = (walk.point(at) - walk.point(N::ZERO)).length();
        away.is_within(self.start())
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
