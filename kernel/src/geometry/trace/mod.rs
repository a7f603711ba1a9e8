//! Traces all branches of F(θ, φ) = 0 on the parameter torus, with their singular points.
//!
//! The square of both angles is subdivided until in every cell F has no zero, or one of its partial
//! derivatives dominates the other, so that the curve in the cell is a graph of bounded slope
//! (Snyder 1992; Plantinga and Vegter 2004). The bounds are Taylor bounds with third derivatives
//! bounded over the cell. A deep cell in which F is monotone along one angle is narrowed to a strip
//! that contains the curve (`contraction`). Cells are joined through the roots on their sides.
//! Singular points, where F and its gradient vanish within the resolution, are found first and get
//! cells of their own.

mod contraction;
mod join;

use super::bivariate_trig_poly::BivariateTrigPoly;
use super::singular::{Critical, singular_points};
use super::surface::Torus;
use super::torus_curve::TorusCurve;
use super::torus_grid::{Cell, Layout};
use super::torus_parameter::TorusParameter;
use super::tracer::{Bounds, Tracer, deepest};
use super::trigonometric::Trigonometric;
use super::unresolved::Unresolved;
use crate::number::float::Float;
use crate::number::roots::{RootKind, Roots, isolate};

/// A point where the curve crosses itself, is tangent to itself or has a cusp, or an isolated
/// point.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular<N: Float = f64> {
    /// (θ, φ).
    pub angles: [N; 2],
    /// The branches through it; empty for an isolated point.
    pub on: Vec<BranchPosition<N>>,
}

/// A point of a branch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BranchPosition<N: Float = f64> {
    /// The index of the branch.
    pub branch: usize,
    /// The parameter.
    pub t: N,
}

/// The zero set of F.
#[derive(Clone, Debug, Default)]
pub struct Traced<N: Float = f64> {
    /// The branches, all closed.
    pub branches: Vec<TorusCurve<N>>,
    /// The singular points.
    pub singular: Vec<Singular<N>>,
    /// The angles of the critical points of F that are singular points or near misses.
    pub close: Vec<[N; 2]>,
}

/// The part of the curve in a cell.
enum Holds {
    Nothing,
    /// A graph over one angle, with a bound of its slope.
    Graph {
        axis: TorusParameter,
        steep: f64,
    },
    Unknown,
}

impl<N: Float> Bounds<N> {
    fn contains(&self) -> Holds {
        let graph = |axis, along: N, across: N| {
            let steep = (along / across).above();
            Holds::Graph { axis, steep }
        };
        let [x, y] = [self.x, self.y];
        if self.least > N::ZERO {
            Holds::Nothing
        } else if y[0] > N::ZERO && x[1] <= N::from_f64(STEEP) * y[0] {
            graph(TorusParameter::Around, x[1], y[0])
        } else if x[0] > N::ZERO && y[1] <= N::from_f64(STEEP) * x[0] {
            graph(TorusParameter::Tube, y[1], x[0])
        } else {
            Holds::Unknown
        }
    }
}

/// A cell in which the curve is a graph.
struct Leaf<N: Float = f64> {
    cell: Cell<N>,
    /// The angle over which the graph runs.
    axis: TorusParameter,
    /// A bound of its slope.
    steep: f64,
}

/// The largest slope of a graph in an accepted cell.
const STEEP: f64 = 2.0;

impl<N: Float> Tracer<'_, N> {
    /// The cells that contain a piece of the curve, as graphs.
    fn leaves(&self, cells: Vec<Cell<N>>) -> Result<Vec<Leaf<N>>, Unresolved> {
        let mut leaves = Vec::new();
        let mut stack: Vec<(Cell<N>, u32)> = cells.into_iter().map(|c| (c, 0)).collect();
        let rounded_f64 = self.to_f64();
        while let Some((cell, depth)) = stack.pop() {
            self.look_at(&cell)?;
            let in_f64 = rounded_f64.as_ref().map(|f| f.part(&cell.to_f64(), depth));
            let part = match in_f64 {
                Some(part) if cell.is_coarse() || !matches!(part.content, Holds::Unknown) => part,
                _ => self.part(&cell, depth),
            };
            match part.content {
                Holds::Nothing => {}
                Holds::Graph { axis, steep } => leaves.push(Leaf { cell, axis, steep }),
                Holds::Unknown if depth >= deepest::<N>() => {
                    return Err(Unresolved::at(cell.centre()));
                }
                Holds::Unknown => stack.extend(cell.halves(part.wide).map(|c| (c, depth + 1))),
            }
        }
        Ok(leaves)
    }

    /// The roots of F on a side of a cell; the side has one angle `fixed`, at the value `at`, and
    /// the other in [lo, hi].
    fn roots_on(&self, fixed: usize, at: N, lo: N, hi: N) -> Option<Vec<N>> {
        let f = Trigonometric::new(&self.form.section(fixed == 0, at).0);
        match isolate(&f, &[lo, hi], self.slop) {
            Roots::At { roots, .. } if roots.iter().all(|r| r.contact == RootKind::Simple) => {
                Some(roots.into_iter().map(|r| r.t).collect())
            }
            _ => None,
        }
    }
}

/// All branches of `form` = 0 on the torus. `form` is a distance to first order, except where
/// `is_on_curve` shows that a point of a small value is farther than the resolution from the curve.
///
/// # Errors
/// The curve has a singular point of an unknown kind, or branches that are too close to be
/// separated.
pub fn trace<N: Float>(
    torus: &Torus<N>,
    form: &BivariateTrigPoly<N>,
    resolution: N,
    is_on_curve: &dyn Fn(&[N; 2]) -> bool,
) -> Result<Traced<N>, Unresolved> {
    let tracer = Tracer::new(form, resolution, is_on_curve);
    let Critical {
        singular: points,
        close,
    } = singular_points(&tracer)?;
    let mut failed = None;
    for attempt in 0..ATTEMPTS {
        match tracer.assemble(torus, &points, &Layout::new(attempt)) {
            Ok(traced) => return Ok(Traced { close, ..traced }),
            Err(e) => failed = failed.or(Some(e)),
        }
    }
    let angles = points.first().map_or([N::ZERO; 2], |p| p.angles);
    Err(failed.unwrap_or(Unresolved::at(angles)))
}

/// The number of layouts tried.
const ATTEMPTS: usize = 24;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Cylinder, Plane, Surface};
    use nalgebra::{Point3, Vector3};

    fn traced(surface: &Surface, major: f64, minor: f64) -> Traced {
        let torus = Torus {
            frame: Frame::world(),
            major,
            minor,
        };
        let form = BivariateTrigPoly::interpolate(|x, y| {
            let p = Surface::Torus(torus).point(x, y);
            surface.level([p.x, p.y, p.z])
        });
        let traced = trace(&torus, &form, 1e-11, &|_| true).unwrap();
        for b in &traced.branches {
            for i in 0..(10 * b.segments.len()) {
                let p = b.point(i as f64 / 10.0);
                assert!(
                    surface.distance(&p).abs() < 1e-12,
                    "{}",
                    surface.distance(&p)
                );
            }
            for i in 0..b.segments.len() {
                let t = i as f64;
                let gap = (b.point(t + 1e-12) - b.point(t - 1e-12)).norm();
                assert!(gap < 1e-9, "gap {gap} at {t}");
            }
        }
        traced
    }

    fn plane(n: Vector3<f64>, d: f64) -> Surface {
        let n = n.normalize();
        Surface::Plane(Plane {
            frame: Frame::about(Point3::from(n * d), n),
        })
    }

    #[test]
    fn a_spiric_section_has_one_or_two_ovals_or_a_node() {
        // x = d across a torus (3, 1): two ovals for d < 2, a lemniscate at 2, one oval above.
        for (d, branches, singular) in [(0.7, 2, 0), (2.0, 1, 1), (2.5, 1, 0), (3.999, 1, 0)] {
            let t = traced(&plane(Vector3::x(), d), 3.0, 1.0);
            assert_eq!(
                (t.branches.len(), t.singular.len()),
                (branches, singular),
                "d = {d}"
            );
        }
        assert_eq!(
            traced(&plane(Vector3::x(), 4.0), 3.0, 1.0).singular.len(),
            1
        );
        assert!(
            traced(&plane(Vector3::x(), 4.001), 3.0, 1.0)
                .branches
                .is_empty()
        );
    }

    #[test]
    fn a_near_node_splits_on_either_side() {
        assert_eq!(
            traced(&plane(Vector3::x(), 2.0 - 1e-9), 3.0, 1.0)
                .branches
                .len(),
            2
        );
        assert_eq!(
            traced(&plane(Vector3::x(), 2.0 + 1e-9), 3.0, 1.0)
                .branches
                .len(),
            1
        );
    }

    /// A cylinder that is tangent to a torus (12/5, 1) from inside at φ with cos φ = 3/5. The
    /// torus's curvatures there are 1 and 1/5, and the cylinder's axis bisects the angle between
    /// their directions. For a radius ρ the curvatures differ by a form of determinant (1/5) -
    /// (3/5)/ρ.
    fn touching_cylinder(radius: f64) -> Surface {
        let (p, n) = (Point3::new(3.0, 0.0, 0.8), Vector3::new(0.6, 0.0, 0.8));
        let axis = Vector3::new(-0.8, 1.0, 0.6).normalize();
        let frame = Frame::about(p - n * radius, axis);
        Surface::Cylinder(Cylinder { frame, radius })
    }

    #[test]
    fn a_touching_cylinder_has_a_node_a_cusp_or_stands_alone() {
        let passes = |radius: f64| -> Vec<usize> {
            let t = traced(&touching_cylinder(radius), 2.4, 1.0);
            t.singular.iter().map(|s| s.on.len()).collect()
        };
        assert_eq!(passes(2.9), [2]);
        assert_eq!(passes(3.0), [1]);
        assert_eq!(passes(3.1), [0]);
    }

    #[test]
    fn a_cylinder_through_the_ring() {
        // Along x through the whole ring: into and out of the tube twice.
        let frame = Frame::about(Point3::origin(), Vector3::x());
        let c = Surface::Cylinder(Cylinder { frame, radius: 0.5 });
        assert_eq!(traced(&c, 3.0, 1.0).branches.len(), 4);
        // Parallel to the axis, as wide as the tube and centred on the spine: nodes on both
        // equators.
        let frame = Frame::about(Point3::new(5.0, 0.0, 0.0), Vector3::z());
        let c = Surface::Cylinder(Cylinder { frame, radius: 1.5 });
        assert_eq!(traced(&c, 5.0, 1.5).singular.len(), 2);
    }
}
