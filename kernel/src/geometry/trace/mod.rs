//! Traces all branches of F(θ, φ) = 0 on the parameter torus, with their singular points.
//!
//! The square of both angles is subdivided until in every cell F has no zero, or one of its partial
//! derivatives dominates the other, so that the curve in the cell is a graph of bounded slope
//! (Snyder 1992; Plantinga and Vegter 2004). The bounds are Taylor bounds with third derivatives
//! bounded over the cell. Cells are joined through the roots on their sides. Singular points, where
//! F and its gradient vanish within the resolution, are found first and get cells of their own.

pub(super) mod grid;
mod join;

use super::bivariate_trig_poly::{BivariateTrigPoly, Partials, Reaches};
use super::singular::{Critical, singular_points};
use super::surface::Torus;
use super::torus_curve::{TorusCurve, TorusParameter, wrap};
use super::trigonometric::Trigonometric;
use crate::number::float::Float;
use crate::number::roots::{RootKind, Roots, isolate};
use grid::{Cell, Layout};
use std::cell::Cell as Counter;

/// A point where the curve crosses itself, is tangent to itself or has a cusp, or an isolated
/// point.
#[derive(Clone, Debug, PartialEq)]
pub struct Singular<N: Float = f64> {
    /// (θ, φ).
    pub angles: [N; 2],
    /// The branches through it, as (index of the branch, parameter); empty for an isolated point.
    pub on: Vec<(usize, N)>,
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

/// The curve has a singular point of an unknown kind, or branches too close to be separated.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("a curve on a torus could not be resolved near the angles ({:.6}, {:.6})", angles[0], angles[1])]
pub struct Unresolved {
    /// (θ, φ).
    pub angles: [f64; 2],
}

impl Unresolved {
    pub(super) fn at<N: Float>(angles: [N; 2]) -> Self {
        Self {
            angles: angles.map(N::rounded),
        }
    }
}

/// Taylor bounds over a cell: the least |F|, and the ranges of |F_x| and |F_y|.
pub(super) struct Bounds<N: Float = f64> {
    /// The lower bound of |F|; negative where F may vanish.
    pub least: N,
    /// The lower and upper bound of |F_x|.
    pub x: [N; 2],
    /// The lower and upper bound of |F_y|.
    pub y: [N; 2],
    /// The values at the centre.
    pub at: Partials<N>,
    /// The angle along which the second derivative is larger over the cell.
    pub wide: usize,
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

pub(super) struct Tracer<'a, N: Float = f64> {
    pub form: &'a BivariateTrigPoly<N>,
    /// Bounds of the form's rows.
    pub reaches: Reaches<N>,
    /// A bound of the rounding error of the form.
    pub slop: N,
    pub resolution: N,
    /// The form rounded to f64, for extended precision.
    f64_form: Option<Box<BivariateTrigPoly>>,
    /// The number of cells that may still be examined.
    cells: Counter<u32>,
}

/// The number of cells of one form that are examined, in all layouts together. Branches closer to
/// each other than a millionth over their whole length would need impractically many. A cell takes
/// some hundred times longer in extended precision, where the curves of all named cases take up to
/// 2,200 cells.
fn cell_limit<N: Float>() -> u32 {
    match N::IS_DOUBLE {
        true => 1 << 17,
        false => 1 << 14,
    }
}

/// A bound of the rounding error of a form.
fn slop<N: Float>(form: &BivariateTrigPoly<N>) -> N {
    form.bound() * N::EPSILON * N::from_f64(64.0)
}

/// The depth at which an undecided cell is given up. Its sides are then about the square root of
/// the precision, in f64 1e-7 radians.
pub(super) fn deepest<N: Float>() -> u32 {
    let bits = -N::EPSILON.rounded().log2();
    bits as u32 - SPARED
}

/// The number of bits that remain below the deepest cells.
const SPARED: u32 = 4;

/// The largest slope of a graph in an accepted cell.
const STEEP: f64 = 2.0;

impl<'a, N: Float> Tracer<'a, N> {
    fn new(form: &'a BivariateTrigPoly<N>, resolution: N) -> Self {
        let slop = slop(form);
        Self {
            form,
            reaches: form.reaches(),
            slop,
            resolution: resolution.max(slop),
            f64_form: (!N::IS_DOUBLE).then(|| Box::new(form.to_f64())),
            cells: Counter::new(cell_limit::<N>()),
        }
    }

    /// Counts an examined cell. Fails if there were too many.
    pub(super) fn look_at(&self, cell: &Cell<N>) -> Result<(), Unresolved> {
        let left = self.cells.get().checked_sub(1);
        self.cells.set(left.ok_or(Unresolved::at(cell.centre()))?);
        Ok(())
    }

    /// The form rounded to f64, for extended precision, and its rounding error.
    pub(super) fn f64_form(&self) -> Option<(&BivariateTrigPoly, f64)> {
        let form = self.f64_form.as_deref()?;
        Some((form, slop(form)))
    }

    /// A tracer in f64, for a form in extended precision. Its bounds are valid but may be looser.
    pub(super) fn to_f64(&self) -> Option<Tracer<'_>> {
        let (form, slop) = self.f64_form()?;
        Some(Tracer {
            form,
            reaches: self.reaches.to_f64(),
            slop,
            resolution: self.resolution.rounded(),
            f64_form: None,
            cells: Counter::default(),
        })
    }

    pub(super) fn bounds(&self, cell: &Cell<N>) -> Bounds<N> {
        let [hx, hy] = cell.half();
        let (p, thirds) = (self.form).partials_about(cell.centre(), cell.half(), &self.reaches);
        // The change of the second derivatives over the cell, from the third ones.
        let [xx, xy, yy] = thirds.seconds([hx, hy]);
        let third = xx * hx * hx + N::TWO * xy * hx * hy + yy * hy * hy;
        let bent = p.xx.abs() * hx * hx + N::TWO * p.xy.abs() * hx * hy + p.yy.abs() * hy * hy;
        let spread =
            p.x.abs() * hx + p.y.abs() * hy + N::HALF * bent + third / N::from_f64(6.0) + self.slop;
        let rx = p.xx.abs() * hx + p.xy.abs() * hy + N::HALF * (xx * hx + xy * hy) + self.slop;
        let ry = p.xy.abs() * hx + p.yy.abs() * hy + N::HALF * (xy * hx + yy * hy) + self.slop;
        let across = [(p.xx.abs() + xx) * hx * hx, (p.yy.abs() + yy) * hy * hy];
        Bounds {
            least: p.f.abs() - spread,
            x: [p.x.abs() - rx, p.x.abs() + rx],
            y: [p.y.abs() - ry, p.y.abs() + ry],
            at: p,
            wide: usize::from(across[1] > across[0]),
        }
    }

    /// The cells that contain a piece of the curve, as graphs.
    fn leaves(&self, cells: Vec<Cell<N>>) -> Result<Vec<Leaf<N>>, Unresolved> {
        let mut leaves = Vec::new();
        let mut stack: Vec<(Cell<N>, u32)> = cells.into_iter().map(|c| (c, 0)).collect();
        let rounded_f64 = self.to_f64();
        while let Some((cell, depth)) = stack.pop() {
            self.look_at(&cell)?;
            let f64_form = rounded_f64.as_ref().map(|f| f.bounds(&cell.to_f64()));
            let (holds, wide) = match f64_form.map(|b| (b.contains(), b.wide)) {
                Some(bounds) if cell.is_coarse() || !matches!(bounds.0, Holds::Unknown) => bounds,
                _ => {
                    let b = self.bounds(&cell);
                    (b.contains(), b.wide)
                }
            };
            match holds {
                Holds::Nothing => {}
                Holds::Graph { axis, steep } => leaves.push(Leaf { cell, axis, steep }),
                Holds::Unknown if depth >= deepest::<N>() => {
                    return Err(Unresolved::at(cell.centre()));
                }
                Holds::Unknown => stack.extend(cell.halves(wide).map(|c| (c, depth + 1))),
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

pub(super) fn near<N: Float>(a: &[N; 2], b: &[N; 2], reach: N) -> bool {
    wrap(a[0] - b[0]).abs() <= reach && wrap(a[1] - b[1]).abs() <= reach
}

/// All branches of `form` = 0 on the torus. `form` is a distance to first order.
pub fn trace<N: Float>(
    torus: &Torus<N>,
    form: &BivariateTrigPoly<N>,
    resolution: N,
) -> Result<Traced<N>, Unresolved> {
    let tracer = Tracer::new(form, resolution);
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
        let traced = trace(&torus, &form, 1e-11).unwrap();
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
