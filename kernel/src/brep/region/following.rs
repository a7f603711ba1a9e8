//! Follows paths from a loop over a surface, and joins the loops that bound a region with it.

use super::{SLANT, Sorter, Start, leads_down};
use crate::brep::surface_path::{CrossingSense, PathCrossing, SurfacePath};
use crate::geometry::bounds::Aabb;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// Where a path ends.
#[derive(Clone, Copy)]
pub(super) enum PathEnd {
    /// At its start, or at the end of the surface.
    Surface,
    /// At a fixed point, which may be in a region. The number stands for the region of that point.
    Point(usize),
    /// Next to an arc of a loop: in the region that the loop bounds, or on its other side.
    Arc {
        /// The loop.
        ring: usize,
        /// Whether it is in that region.
        is_inside: bool,
    },
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
    /// Whether the path ends in the region of a loop: it entered through a loop that is joined to
    /// that.
    fn is_in_region_of(&self, ring: usize) -> bool {
        let mut region = vec![ring];
        for [a, b] in &self.joined {
            if region.contains(a) {
                region.push(*b);
            }
        }
        self.inside.is_some_and(|inside| region.contains(&inside))
    }

    /// Passes a loop; `None` if that contradicts the region in which the path is.
    fn pass(&mut self, ring: usize, passage: CrossingSense) -> Option<()> {
        match (self.inside, passage) {
            (Some(from), CrossingSense::Leaving) => {
                self.joined.push([from, ring]);
                self.inside = None;
            }
            (None, CrossingSense::Entering) => self.inside = Some(ring),
            _ => return None,
        }
        Some(())
    }

    /// The path with its last region joined to that of the fixed point at its end, if it ends in one.
    fn ended_at(mut self, point: usize) -> Self {
        self.joined.extend(self.inside.map(|from| [from, point]));
        self
    }

    /// The path with its last region joined to that of the loop at its end; `None` if it does not end
    /// on the expected side of that loop. On the other side it has just left through it.
    fn ended_next_to(mut self, ring: usize, is_inside: bool) -> Option<Self> {
        match (self.inside, is_inside) {
            (Some(from), true) => self.joined.push([from, ring]),
            (None, false) if self.joined.last().is_some_and(|last| last[1] == ring) => {}
            _ => return None,
        }
        Some(self)
    }
}

impl<N: Float> Sorter<'_, N> {
    /// Follows the legs of a path and joins the loops that it crosses. The path starts into the region
    /// of the loop. A path downwards may also start into the region on the other side of the edge, if
    /// there is one. Returns false if anything is unclear.
    pub(super) fn follow(
        &mut self,
        ring: usize,
        arc: usize,
        p: &Point3<N>,
        left: &Vector3<N>,
        legs: &[SurfacePath<N>],
        end: PathEnd,
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
        let ended = followed.and_then(|path| match end {
            PathEnd::Surface => self.closed(path, arc, legs),
            PathEnd::Point(point) => Some(path.ended_at(point)),
            PathEnd::Arc { ring, is_inside } => path.ended_next_to(ring, is_inside),
        });
        let Some(path) = ended else {
            return false;
        };
        for [a, b] in path.joined {
            self.join(a, b);
        }
        true
    }

    /// Follows a straight path to the first exit from a region beyond the box of the starting loop.
    /// That point is outside the region of the loop. Joins the loops that the path crosses. Returns
    /// false if anything is unclear, or if the path ends in the region.
    ///
    /// This joins all loops of a region. All paths have one direction. Let the reach of a loop be
    /// its greatest coordinate in that direction. By Jordan's theorem, a path that leaves a region
    /// through a loop can return through that loop only. So the last loop through which the path
    /// left the region separates the region from the path's end. If that loop is neither the
    /// starting loop nor the outermost one, it encloses the end, and its reach is greater than that
    /// of the starting loop. If it is the starting loop, that is the outermost one. By induction from
    /// the greatest reach, every loop is joined to the outermost one.
    pub(super) fn follow_to_next(
        &mut self,
        ring: usize,
        start: &Start<N>,
        path: &SurfacePath<N>,
    ) -> bool {
        let is_straight = matches!(
            self.surface,
            Surface::Plane(_) | Surface::Cylinder(_) | Surface::EllipticCylinder(_)
        );
        let heading = path.direction(&start.point).dot(&start.left);
        if !is_straight || !self.arcs.are_many() {
            return false;
        }
        let Some(inside) = self.entered(ring, start.arc, heading) else {
            return false;
        };
        let reach = self.reach(ring, start, path) + N::TWO * self.start();
        let mut length = N::TWO * reach;
        while length.is_short_of(path.length()) && length.is_finite() {
            let Some(followed) = self.followed_beyond(reach, inside, start.arc, &path.upto(length))
            else {
                return false;
            };
            if !followed.is_in_region_of(ring) {
                for [a, b] in followed.joined {
                    self.join(a, b);
                }
                return true;
            }
            length *= N::TWO;
            if length.is_beyond(N::from_f64(self.size)) {
                return false;
            }
        }
        false
    }

    /// The distance at which a straight path has left the box of its loop.
    fn reach(&self, ring: usize, start: &Start<N>, path: &SurfacePath<N>) -> N {
        let own = &self.arcs.boxes[self.firsts[ring]..self.firsts[ring + 1]];
        let own = own.iter().fold(Aabb::EMPTY, |all, b| all.hull(b));
        let direction = path.direction(&start.point);
        let farthest = (0..3).map(|i| {
            let side = match direction[i].is_above_zero() {
                true => own.max[i],
                false => own.min[i],
            };
            (N::from_f64(side) - start.point[i]) * direction[i]
        });
        farthest.sum()
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
                path.pass(self.owner[c.arc], c.passage)?;
            }
        }
        Some(path)
    }

    /// Follows a path that starts in a region as far as its first exit from a region beyond `reach`,
    /// if there is one; `None` if anything is unclear.
    fn followed_beyond(
        &self,
        reach: N,
        inside: Option<usize>,
        arc: usize,
        leg: &SurfacePath<N>,
    ) -> Option<FollowedPath> {
        let mut path = FollowedPath {
            inside,
            before: inside,
            joined: Vec::new(),
        };
        for c in self.crossings(leg, Some(arc))? {
            path.pass(self.owner[c.arc], c.passage)?;
            if path.inside.is_none() && c.at.is_beyond(reach) {
                break;
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
    pub(super) fn twin(&self, arc: usize) -> Option<usize> {
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
}
