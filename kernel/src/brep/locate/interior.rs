//! Finds a point inside a face.
//!
//! A path leads from a boundary point into the face, up to where it clearly leaves it. Its points
//! in between are inside. The midpoint is avoided, because symmetric parts touch themselves there.

use super::FaceLocator;
use crate::brep::surface_path::{CrossingSense, DirectedArc, SurfacePath};
use crate::brep::topology::Sense;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};

/// The fractions of an arc at which paths start.
const STARTS: [f64; 3] = [0.47, 0.21, 0.83];

/// The number of arcs from which paths start.
const ARCS: usize = 6;

/// The fraction of the path at which the interior point is taken.
const INSIDE: f64 = 0.381_966;

/// The least sine of the angle between a path and its arc.
const SLANT: f64 = 0.1;

/// The distance from its start, in multiples of the resolution, within which a path may intersect
/// its own arc.
const NEXT: f64 = 64.0;

/// The distance from the boundary, in multiples of the resolution, that is large enough to end the
/// search.
const LONG: f64 = (1 << 20) as f64;

/// A path into a face.
struct Way<N: Float = f64> {
    /// The distance along it.
    length: N,
    /// The point there.
    point: Point3<N>,
}

impl<N: Float> FaceLocator<'_, N> {
    /// A point inside the face, at least `away` from its boundary along a path. `None` for a face
    /// without edges, and if no path finds one.
    pub fn interior(&self, away: N) -> Option<Point3<N>> {
        let step = (self.arcs.all.len() / ARCS).max(1);
        let starts = STARTS.into_iter().flat_map(|part| {
            let arcs = self.arcs.all.iter().step_by(step).take(ARCS);
            arcs.map(move |arc| (arc, N::from_f64(part)))
        });
        let mut best: Option<Way<N>> = None;
        for way in starts.flat_map(|(arc, part)| self.ways_from(arc, part)) {
            let length = way.length;
            if best.as_ref().is_none_or(|b| length.is_beyond(b.length)) {
                best = Some(way);
            }
            // Usually the first one is.
            if length.is_beyond(N::from_f64(LONG) * self.resolution) {
                break;
            }
        }
        Some(best.filter(|b| b.length.is_beyond(away))?.point)
    }

    /// The paths from a point of an arc into the face.
    fn ways_from(&self, arc: &DirectedArc<'_, N>, part: N) -> Vec<Way<N>> {
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
                let point = walk.point(length);
                ways.push(Way { length, point });
            }
        }
        ways
    }

    /// The paths of the surface's standard kinds through a point of it.
    fn walks_through(&self, p: &Point3<N>, towards: Vector3<N>) -> Vec<SurfacePath<N>> {
        let parallel = || SurfacePath::parallel(self.surface, p, Sense::Along, self.resolution);
        let mut walks = Vec::new();
        match self.surface {
            Surface::Plane(s) => walks.push(SurfacePath::straight(s, p, towards)),
            Surface::Sphere(_) | Surface::Ellipsoid(_) => {
                let away = (p - self.surface.frame().origin).length();
                let target = p + towards * away;
                walks.extend(SurfacePath::central(self.surface, p, &target));
            }
            Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => {
                walks.extend(parallel());
                let down = SurfacePath::ruling_through(self.surface, p, Sense::Along);
                walks.extend(down);
            }
            Surface::Torus(s) if s.is_ring() => {
                walks.extend(parallel());
                walks.push(SurfacePath::tube(s, p, Sense::Along));
            }
            Surface::Torus(s) => {
                walks.extend(parallel());
                let both = [Sense::Along, Sense::Against];
                let both = both.map(|sense| SurfacePath::meridian(s, p, sense));
                let leads_in = |walk: &SurfacePath<N>| walk.direction(p).dot(&towards);
                walks.extend(
                    both.into_iter()
                        .filter(|walk| leads_in(walk).reaches(N::ZERO)),
                );
            }
        }
        walks
    }

    /// The length at which a path from the boundary clearly leaves the face, without any other
    /// crossing before.
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
            .filter(|crossing| crossing.1 == CrossingSense::Leaving)
            .map(|crossing| crossing.0)
    }
}
