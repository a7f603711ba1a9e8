//! A point inside a face.
//!
//! From a point of the boundary a walk goes into the face, up to where it clearly leaves it: on the
//! way it is inside. Half way symmetric parts touch themselves.

use super::FaceLocator;
use crate::brep::surface_path::{CrossingSense, DirectedArc, SurfacePath};
use crate::brep::topology::Sense;
use crate::geometry::surface::Surface;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// Where on an arc a walk starts.
const STARTS: [f64; 3] = [0.47, 0.21, 0.83];

/// From how many arcs walks start.
const ARCS: usize = 6;

/// How far on a walk the point is, as a part of its length.
const INSIDE: f64 = 0.381_966;

/// The least sine of the angle under which a walk leaves its arc.
const SLANT: f64 = 0.1;

/// As far as this from its start, in bands, a walk may meet its own arc.
const NEXT: f64 = 64.0;

/// A point as far as this from the boundary, in bands, is well away from it: no other is looked for.
const LONG: f64 = (1 << 20) as f64;

impl<N: Float> FaceLocator<'_, N> {
    /// A point inside the face, at least `away` along a walk from its boundary; none of a face
    /// without a boundary, and where no walk tells one.
    pub fn interior(&self, away: N) -> Option<Point3<N>> {
        let step = (self.arcs.all.len() / ARCS).max(1);
        let starts = STARTS.into_iter().flat_map(|part| {
            let arcs = self.arcs.all.iter().step_by(step).take(ARCS);
            arcs.map(move |arc| (arc, N::from_f64(part)))
        });
        let mut best: Option<(N, Point3<N>)> = None;
        for (length, point) in starts.flat_map(|(arc, part)| self.ways_from(arc, part)) {
            if best.as_ref().is_none_or(|b| length.is_beyond(b.0)) {
                best = Some((length, point));
            }
            // Mostly the first one is.
            if length.is_beyond(N::from_f64(LONG) * self.resolution) {
                break;
            }
        }
        let (_, point) = best.filter(|b| b.0.is_beyond(away))?;
        Some(point)
    }

    /// The walks from a point of an arc into the face: how far along each, and the point.
    fn ways_from(&self, arc: &DirectedArc<'_, N>, part: N) -> Vec<(N, Point3<N>)> {
        let t = arc.range[0] + part * (arc.range[1] - arc.range[0]);
        let p = arc.curve.point(t);
        let tangent = arc.curve.tangent(t) * arc.sense.sign::<N>();
        let left = (self.surface.normal(&p) * self.side.sign::<N>()).cross(&tangent);
        let mut ways = Vec::new();
        for walk in self.walks_through(&p, left) {
            let walk = walk.toward(&p, &left);
            if walk.direction(&p).dot(&left).reaches(N::from_f64(SLANT))
                && let Some(length) = self.left_at(&walk)
            {
                let length = N::from_f64(INSIDE) * length;
                ways.push((length, walk.point(length)));
            }
        }
        ways
    }

    /// The walks of the surface's own kinds through a point of it.
    fn walks_through(&self, p: &Point3<N>, towards: Vector3<N>) -> Vec<SurfacePath<N>> {
        let parallel = || SurfacePath::parallel(self.surface, p, Sense::Along, self.resolution);
        let mut walks = Vec::new();
        match self.surface {
            Surface::Plane(s) => walks.push(SurfacePath::straight(s, p, towards)),
            Surface::Sphere(s) => {
                let target = p + towards * s.radius;
                walks.extend(SurfacePath::great_circle(&s.frame.origin, p, &target));
            }
            Surface::Cylinder(_) | Surface::Cone(_) => {
                walks.extend(parallel());
                let down = SurfacePath::ruling_through(self.surface, p, Sense::Along);
                walks.extend(down);
            }
            Surface::Torus(s) => {
                walks.extend(parallel());
                walks.push(SurfacePath::tube(s, p, Sense::Along));
            }
        }
        walks
    }

    /// Where a walk from the boundary clearly leaves the face, before it meets anything else.
    fn left_at(&self, walk: &SurfacePath<N>) -> Option<N> {
        let start = N::from_f64(NEXT) * self.resolution;
        let mut first: Option<(N, CrossingSense)> = None;
        self.arcs.hit_by(walk, self.resolution, &mut |i, ranges| {
            let arc = &self.arcs.all[i];
            let mut note = |at: N, _: N, passage: CrossingSense| {
                let is_first = first.is_none_or(|known| at.is_short_of(known.0));
                if at.is_beyond(start) && is_first {
                    first = Some((at, passage));
                }
            };
            walk.intersections(
                self.surface,
                self.side,
                arc,
                ranges,
                self.resolution,
                &mut note,
            );
        });
        first
            .filter(|met| met.1 == CrossingSense::Leaving)
            .map(|met| met.0)
    }
}
