//! Tests which boxes a path may pass through, in f64 for paths of any precision. A box is excluded
//! if it is farther away than the resolution and rounding.

use super::{Branch, Track};
use crate::geometry::bounds::Aabb;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::{Compare, ROUNDING};
use nalgebra::{Point3, Vector3};

/// A half-space: the part above a plane, given by a point and the unit normal.
#[derive(Clone, Copy, Debug)]
struct Above {
    origin: Point3<f64>,
    normal: Vector3<f64>,
}

/// The side of a torus's middle circle on which a path lies.
#[derive(Clone, Copy, Debug)]
struct SideOfTorus {
    axis: Above,
    major: f64,
    side: f64,
}

/// A straight path from a point along a direction.
#[derive(Clone, Copy, Debug)]
struct StraightPath {
    /// The half-space ahead of the start.
    ahead: Above,
    length: f64,
}

/// A region that contains a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct Reach {
    /// The plane in which the path lies.
    plane: Above,
    half: Option<Above>,
    side_of_torus: Option<SideOfTorus>,
    /// A straight path.
    line: Option<StraightPath>,
    /// The box of a straight path of finite length; otherwise unbounded.
    extent: Aabb,
}

/// A box by its centre and half its sides.
struct Middle {
    centre: Point3<f64>,
    half: Vector3<f64>,
}

impl Above {
    fn new<N: Float>(origin: &Point3<N>, normal: &Vector3<N>) -> Self {
        Self {
            origin: origin.map(N::rounded),
            normal: normal.map(N::rounded),
        }
    }

    /// The height of a box's centre above the plane, and the amount by which its corners may be
    /// lower.
    fn span(&self, b: &Middle) -> [f64; 2] {
        let (n, h) = (self.normal.abs(), b.half);
        let half = n.x * h.x + n.y * h.y + n.z * h.z;
        let far = b.centre.coords.abs().sum() + self.origin.coords.abs().sum();
        [
            self.normal.dot(&(b.centre - self.origin)),
            half + ROUNDING * far,
        ]
    }
}

impl Reach {
    /// The region of a path in the plane through its start with the given normal.
    pub fn new<N: Float>(
        start: &Point3<N>,
        normal: &Vector3<N>,
        track: &Track<N>,
        branch: &Branch<N>,
        length: N,
    ) -> Self {
        let half = match branch {
            Branch::Half(o, side) => Some(Above::new(o, side)),
            Branch::Level(c, side) => Some(Above::new(&c.frame.origin, &(c.frame.z * *side))),
            Branch::Whole | Branch::Parallel(..) => None,
        };
        let side_of_torus = match branch {
            Branch::Parallel(t, side) => Some(SideOfTorus {
                axis: Above::new(&t.frame.origin, &t.frame.z),
                major: t.major.rounded(),
                side: side.rounded(),
            }),
            Branch::Whole | Branch::Half(..) | Branch::Level(..) => None,
        };
        let (line, extent) = match track {
            Track::Line(d) => {
                let ends = Aabb::new(start).hull(&Aabb::new(&(start + d * length)));
                let extent = if length.is_finite() { ends } else { Aabb::ALL };
                let path = StraightPath {
                    ahead: Above::new(start, d),
                    length: length.above(),
                };
                (Some(path), extent)
            }
            Track::Circle(..) | Track::Ellipse(..) => (None, Aabb::ALL),
        };
        Self {
            plane: Above::new(start, normal),
            half,
            side_of_torus,
            line,
            extent,
        }
    }

    /// Whether the path may pass through a box, or within the resolution of it.
    pub fn may_intersect(&self, lo: &[f64; 3], hi: &[f64; 3], resolution: f64) -> bool {
        let Aabb { min, max } = &self.extent;
        let is_aside = |i: usize| {
            (lo[i] - resolution).is_beyond(max[i]) || (hi[i] + resolution).is_short_of(min[i])
        };
        if (0..3).any(is_aside) {
            return false;
        }
        let side = |i: usize, sign: f64| 0.5 * (hi[i] + sign * lo[i]);
        let b = Middle {
            centre: Point3::new(side(0, 1.0), side(1, 1.0), side(2, 1.0)),
            half: Vector3::new(side(0, -1.0), side(1, -1.0), side(2, -1.0)),
        };
        let [mid, half] = self.plane.span(&b);
        if mid.abs().is_beyond(half + resolution) {
            return false;
        }
        let is_below = |plane: &Above| {
            let [mid, half] = plane.span(&b);
            mid.is_short_of(-half - resolution)
        };
        let is_off = |side_of_torus: &SideOfTorus| side_of_torus.is_off(&b, resolution);
        if self.half.as_ref().is_some_and(is_below)
            || self.side_of_torus.as_ref().is_some_and(is_off)
        {
            return false;
        }
        self.line.as_ref().is_none_or(|path| {
            let [mid, half] = path.ahead.span(&b);
            mid.reaches(-half - resolution) && (mid - half - resolution).is_at_most(path.length)
        })
    }
}

impl SideOfTorus {
    /// Whether a box is clearly on the other side.
    fn is_off(&self, b: &Middle, resolution: f64) -> bool {
        let arm = b.centre - self.axis.origin;
        let [up, _] = self.axis.span(b);
        let across = (arm - self.axis.normal * up).length();
        let rounding = ROUNDING * (arm.length() + b.centre.coords.length());
        let beyond = (across - self.major) * self.side;
        beyond.is_short_of(-b.half.length() - resolution - rounding)
    }
}

#[cfg(test)]
mod tests {
    use crate::brep::surface_path::SurfacePath;
    use crate::brep::topology::Sense;
    use crate::geometry::bounds::Aabb;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Cylinder, Surface, Torus};
    use crate::number::extended::F237;
    use crate::number::float::Float;
    use nalgebra::Point3;

    fn walks<N: Float>() -> Vec<SurfacePath<N>> {
        let frame = Frame {
            origin: Point3::new(N::from_f64(1.1), N::from_f64(-0.3), N::from_f64(0.7)),
            ..Frame::world()
        };
        let torus = Torus {
            frame,
            major: N::from_f64(2.0),
            minor: N::from_f64(0.6),
        };
        let (ring, rod) = (
            Surface::Torus(torus),
            Cylinder {
                frame,
                radius: N::from_f64(0.9),
            },
        );
        let rod = Surface::Cylinder(rod);
        let mut all = Vec::new();
        for k in 0..12 {
            let [u, v] = [0.4, 0.55].map(|step| N::from_f64(step * f64::from(k)));
            let p = ring.point(u, v);
            all.push(SurfacePath::tube(&torus, &p, Sense::Along));
            all.extend(SurfacePath::parallel(
                &ring,
                &p,
                Sense::Against,
                N::from_f64(1e-11),
            ));
            let q = rod.point(u, v);
            all.extend(
                SurfacePath::ruling_through(&rod, &q, Sense::Along)
                    .map(|w| w.upto(N::from_f64(3.0))),
            );
        }
        all
    }

    fn holds<N: Float>() {
        for walk in walks::<N>() {
            let length = walk.length();
            let mut passed_over = 0;
            for k in 0..=100 {
                let p = walk.point(length * N::from_f64(f64::from(k) / 100.0));
                assert!(
                    walk.may_intersect_box(&Aabb::new(&p), N::ZERO),
                    "{walk:?} at {p:?}"
                );
                // Farther to the side than the box is wide.
                let lateral = p.map(|x| x + N::from_f64(0.1));
                passed_over +=
                    u32::from(!walk.may_intersect_box(&Aabb::new(&lateral), N::from_f64(1e-3)));
            }
            assert!(passed_over > 20, "{walk:?}");
        }
    }

    #[test]
    fn every_point_of_a_walk_is_met_and_what_is_aside_is_not() {
        holds::<f64>();
        holds::<F237>();
    }
}
