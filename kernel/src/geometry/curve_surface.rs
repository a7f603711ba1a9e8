//! Intersections of a curve with a surface.

mod closed_form;

use super::bounds::Aabb;
use super::curve::Curve;
use super::implicit_on_curve::ImplicitOnCurve;
use super::surface::Surface;
use super::vector::Length;
use crate::number::float::Float;
use crate::number::function::{F64Filter, Function};
use crate::number::interval::Interval;
use crate::number::jet::Jet;
use crate::number::probes::probes;
use crate::number::roots::{
    Inseparable, NearMiss, Root, RootKind, Roots, isolate, isolate_closely,
};
use nalgebra::Point3;
use std::borrow::Cow;

/// The signed distance of a curve from a surface, to first order.
struct Height<'a, N: Float = f64> {
    curve: Cow<'a, Curve<N>>,
    surface: Cow<'a, Surface<N>>,
    /// The implicit polynomial along a line or circle. Coordinates may cancel there by more than
    /// halving can make up for.
    restriction: Option<ImplicitOnCurve<N>>,
    /// The f64 version, for extended precision.
    rounded_f64: Option<Box<Height<'static>>>,
}

impl<'a, N: Float> Height<'a, N> {
    fn new(curve: &'a Curve<N>, surface: &'a Surface<N>) -> Self {
        let rounded_f64 = || Height::over(curve.to_f64(), surface.to_f64());
        Self {
            curve: Cow::Borrowed(curve),
            surface: Cow::Borrowed(surface),
            restriction: ImplicitOnCurve::new(curve, surface),
            rounded_f64: (!N::IS_DOUBLE).then(|| Box::new(rounded_f64())),
        }
    }
}

impl Height<'static> {
    fn over(curve: Curve, surface: Surface) -> Self {
        Self {
            restriction: ImplicitOnCurve::new(&curve, &surface),
            curve: Cow::Owned(curve),
            surface: Cow::Owned(surface),
            rounded_f64: None,
        }
    }
}

impl<N: Float> Function<N> for Height<'_, N> {
    fn over(&self, t: Interval<N>) -> Jet<Interval<N>> {
        self.surface.level(self.curve.jet_over(t))
    }

    fn reach(&self, t: Interval<N>) -> Interval<N> {
        match self.curve.box_over(t) {
            Some(p) => {
                let level = self.surface.level(p);
                match &self.restriction {
                    Some(own) => level.intersection(own.level(t, &self.surface, p)),
                    None => level,
                }
            }
            None => Interval::ENTIRE,
        }
    }

    fn roughly(&self, piece: [N; 2]) -> Option<F64Filter<'_>> {
        let rounded_f64 = self.rounded_f64.as_deref()?;
        let away = |p: &Point3<N>| p.coords.length().rounded();
        let size = away(&self.surface.frame().origin) + away(&self.curve.point(piece[0]));
        Some(F64Filter::new(
            self,
            rounded_f64,
            piece,
            f64::ROUNDING * size,
        ))
    }

    fn at(&self, t: N) -> Jet<N> {
        self.surface.level(self.curve.jet(t))
    }

    fn value(&self, t: N) -> N {
        self.surface.level(self.curve.point(t).into())
    }
}

/// Intersects the curve over `range` of its parameter with the surface: isolated parameters with
/// their multiplicity, or everywhere if the curve lies on the surface.
pub fn cut<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> Roots<N> {
    if lies_on(curve, range, surface, resolution) {
        return Roots::Everywhere;
    }
    let breaks = curve.breaks(range[0], range[1]);
    match isolate(&Height::new(curve, surface), &breaks, resolution) {
        Roots::Everywhere => touching(range),
        zeros => zeros,
    }
}

/// The intersections of a curve with a surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct CurveSurfaceRoots<N: Float = f64> {
    /// The roots, in increasing order.
    pub roots: Vec<Root<N>>,
    /// The near misses that are close calls.
    pub misses: Vec<NearMiss<N>>,
}

/// Intersects a part of a curve, however short, that does not lie on the surface: the roots, and
/// all near misses that are close calls.
///
/// # Errors
/// In extended precision: the curve runs so close to the surface that the roots cannot be
/// separated.
pub fn roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> Result<CurveSurfaceRoots<N>, Inseparable> {
    if let Some(known) = closed_form::clear_roots(curve, range, surface, resolution) {
        return Ok(known);
    }
    if let Some(known) = rounded_roots(curve, range, surface, resolution) {
        return Ok(known);
    }
    let breaks = curve.breaks(range[0], range[1]);
    let zeros = match isolate_closely(&Height::new(curve, surface), &breaks, resolution)? {
        Roots::Everywhere => touching(range),
        zeros => zeros,
    };
    Ok(match zeros {
        Roots::At { roots, misses } => CurveSurfaceRoots { roots, misses },
        Roots::Everywhere => CurveSurfaceRoots::default(),
    })
}

/// The roots of a curve in extended precision: isolated in f64, if the rounded curve is far closer
/// than the resolution, and then refined to full precision.
fn rounded_roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> Option<CurveSurfaceRoots<N>> {
    if N::IS_DOUBLE {
        return None;
    }
    let rounded = curve.to_f64();
    let follows = |part: N| {
        let t = range[0] + (range[1] - range[0]) * part;
        let p = curve.point(t);
        let away = (rounded.point(t.rounded()).map(N::from_f64) - p).length();
        let rounding = N::from_f64(f64::ROUNDING) * p.coords.length();
        (away + rounding) * N::from_f64(FOLLOWING) <= resolution
    };
    if !probes().step_by(4).all(follows) {
        return None;
    }
    let height = Height::new(curve, surface);
    let ends = range.map(N::rounded);
    let found = roots(&rounded, ends, &surface.to_f64(), resolution.rounded()).ok()?;
    let settled = |t: f64| {
        let mut t = N::from_f64(t);
        for _ in 0..STEPS {
            let at = height.at(t);
            t -= at.v / at.d;
        }
        t
    };
    let root = |r: Root| Root {
        t: match r.contact {
            RootKind::Simple => settled(r.t),
            RootKind::Touching | RootKind::Inflected => N::from_f64(r.t),
        },
        lo: N::from_f64(r.lo),
        hi: N::from_f64(r.hi),
        contact: r.contact,
        margin: r.margin.map(N::from_f64),
    };
    let miss = |m: NearMiss| NearMiss {
        t: N::from_f64(m.t),
        value: N::from_f64(m.value),
    };
    Some(CurveSurfaceRoots {
        roots: found.roots.into_iter().map(root).collect(),
        misses: found.misses.into_iter().map(miss).collect(),
    })
}

/// The factor by which the rounded curve must be closer to the exact one than the resolution.
const FOLLOWING: f64 = 64.0;
/// The number of Newton steps from f64 to 237 bits.
const STEPS: u32 = 3;

/// A single tangential root over the entire range.
fn touching<N: Float>([lo, hi]: [N; 2]) -> Roots<N> {
    Roots::At {
        roots: vec![Root {
            t: N::HALF * (lo + hi),
            lo,
            hi,
            contact: RootKind::Touching,
            margin: Some(N::ZERO),
        }],
        misses: Vec::new(),
    }
}

/// Whether a point of a box can be within `margin` of a surface, by the surface's distance and by
/// its implicit function.
pub fn comes_near<N: Float>(surface: &Surface<N>, b: &Aabb, margin: N) -> bool {
    // The distance from a surface changes by at most the length moved; f64 gives it up to rounding.
    let centre = b.centre();
    let rounding = f64::ROUNDING * (centre.coords.norm() + b.diagonal());
    let away = surface.distance(&centre.map(N::from_f64)).abs();
    if away > N::from_f64(0.5 * b.diagonal() + rounding) + margin {
        return false;
    }
    let level = surface
        .level([0, 1, 2].map(|i| Interval::new(N::from_f64(b.min[i]), N::from_f64(b.max[i]))));
    level.lo <= margin && level.hi >= -margin
}

/// Whether the curve lies on the surface, within the resolution.
pub fn lies_on<N: Float>(
    curve: &Curve<N>,
    [lo, hi]: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> bool {
    probes().all(|part| surface.distance(&curve.point(lo + (hi - lo) * part)).abs() <= resolution)
}
