//! The intersection curve of two quadrics, parameterised over the rulings of one of them.
//!
//! Notation: a ruling of a cylinder is r(u) + w z, one of a cone's nappe (1/w) d(u) from its apex,
//! with u the angle, the eccentric one of an elliptic surface. Along a ruling the other quadric is k w^2 + 2 B(u) w + C(u) = 0, with constant
//! k, B of degree one and C of degree two in (cos u, sin u). Hence w = (-B ± √Δ)/k with Δ = B^2 - k
//! C. At a simple real root of Δ a ruling is tangent to the other quadric; at a double root the
//! curve crosses itself. The parameter t is chosen so that √Δ is analytic in it. Over an arc
//! between two simple roots u = mid - half cos t, and √Δ changes sign with sin t. At a double root
//! √Δ changes sign. After Levin (1976) and Dupont, Lazard, Lazard, Petitjean (2008).

use super::centred_trigonometric::{CentredTrigonometric, ComplexAngle};
use super::elliptic_surface::{EllipticCone, EllipticCylinder, eccentric_angle};
use super::frame::Frame;
use super::surface::{Cone, Cylinder, Surface};
use super::trigonometric::{Trig1, Trig2, trig1};
use crate::number::float::{Analytic, Float, harmonic};
use nalgebra::Point3;

/// The surface whose rulings carry the curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Ruled<N: Float = f64> {
    /// A cylinder; w is the height.
    Cylinder(Cylinder<N>),
    /// A cone's nappe; 1/w is the height above the apex.
    Cone(Cone<N>),
    /// An elliptic cylinder.
    EllipticCylinder(EllipticCylinder<N>),
    /// An elliptic cone's nappe.
    EllipticCone(EllipticCone<N>),
}

impl<N: Float> Ruled<N> {
    /// A surface with rulings; `None` for other surfaces.
    pub(super) fn new(surface: &Surface<N>) -> Option<Self> {
        Some(match surface {
            Surface::Cylinder(s) => Self::Cylinder(*s),
            Surface::Cone(s) => Self::Cone(*s),
            Surface::EllipticCylinder(s) => Self::EllipticCylinder(*s),
            Surface::EllipticCone(s) => Self::EllipticCone(*s),
            Surface::Plane(_) | Surface::Sphere(_) | Surface::Torus(_) | Surface::Ellipsoid(_) => {
                return None;
            }
        })
    }

    /// The surface.
    pub(super) fn surface(&self) -> Surface<N> {
        match self {
            Self::Cylinder(s) => Surface::Cylinder(*s),
            Self::Cone(s) => Surface::Cone(*s),
            Self::EllipticCylinder(s) => Surface::EllipticCylinder(*s),
            Self::EllipticCone(s) => Surface::EllipticCone(*s),
        }
    }

    /// The surface's frame.
    pub(super) fn frame(&self) -> &Frame<N> {
        match self {
            Self::Cylinder(s) => &s.frame,
            Self::Cone(s) => &s.frame,
            Self::EllipticCylinder(s) => &s.frame,
            Self::EllipticCone(s) => &s.frame,
        }
    }

    /// Whether the rulings pass through an apex.
    pub(super) fn is_cone(&self) -> bool {
        match self {
            Self::Cone(_) | Self::EllipticCone(_) => true,
            Self::Cylinder(_) | Self::EllipticCylinder(_) => false,
        }
    }

    /// The radii along x and y of the cross section; of a cone at the height 1.
    pub(super) fn radii(&self) -> [N; 2] {
        match self {
            Self::Cylinder(s) => [s.radius; 2],
            Self::Cone(s) => [s.sin / s.cos; 2],
            Self::EllipticCylinder(s) => s.radii,
            Self::EllipticCone(s) => s.slopes,
        }
    }

    /// The angle of the ruling through a point.
    pub(super) fn angle(&self, p: &Point3<N>) -> N {
        let q = self.frame().coordinates(p);
        match self {
            Self::Cylinder(_) | Self::Cone(_) => q.y.atan2(q.x),
            Self::EllipticCylinder(_) | Self::EllipticCone(_) => {
                eccentric_angle([q.x, q.y], self.radii())
            }
        }
    }
}

/// The angle u as a function of the parameter t.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Sweep<N: Float = f64> {
    /// u = t, closed after the given number of turns.
    Round {
        /// 1, or 2 if the curve closes after two turns.
        turns: u8,
    },
    /// u = mid - half cos t: forward on one branch, back on the other.
    Oval {
        /// The middle of the interval of angles.
        mid: N,
        /// Half the length of the interval.
        half: N,
    },
}

/// The other quadric along the rulings: k w^2 + 2 B(u) w + C(u).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Along<N: Float = f64> {
    /// k.
    pub lead: N,
    /// B.
    pub linear: Trig1<N>,
    /// C, if k is so small relative to B that -B and ±√Δ may cancel.
    pub constant: Option<Trig2<N>>,
}

/// The ratio of |k C| to B^2 below which digits would be lost.
const CANCELLING: f64 = 1.0 / 256.0;

impl<N: Float> Along<N> {
    pub(super) fn new(lead: N, linear: Trig1<N>, constant: Trig2<N>) -> Self {
        let size = |k: &[N]| k.iter().map(|c| c.abs()).sum::<N>();
        let cancels =
            lead.abs() * size(&constant) <= N::from_f64(CANCELLING) * size(&linear).powi(2);
        Self {
            lead,
            linear,
            constant: cancels.then_some(constant),
        }
    }

    /// (-B + r)/k for a square root r of Δ, as (numerator, denominator). C/(-B - r) is equal and
    /// may be used instead.
    fn quotient<S: Analytic<Float = N>>(&self, root: S, at: (S, S)) -> (S, S) {
        let linear = trig1(&self.linear, at);
        match &self.constant {
            Some(constant) if root.is_like(linear) => (harmonic(constant, at), -(linear + root)),
            _ => (root - linear, S::constant(self.lead)),
        }
    }
}

/// The height w as a function of the angle u.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Height<N: Float = f64> {
    /// (-B ± √Δ)/k with Δ positive everywhere.
    Whole {
        /// k, B and C.
        along: Along<N>,
        /// Δ.
        radicand: CentredTrigonometric<N>,
        /// +1 or -1.
        sign: N,
    },
    /// (-B + s √q)/k, where s vanishes at the ends of the sweep and at `node`.
    Deflated {
        /// k, B and C.
        along: Along<N>,
        /// q, of degree one, positive over the sweep.
        rest: CentredTrigonometric<N>,
        /// The angle at which the curve crosses itself.
        node: Option<N>,
        /// +1 or -1.
        sign: N,
    },
    /// -C/(2 B): k = 0.
    Rational {
        /// B.
        linear: Trig1<N>,
        /// C.
        constant: Trig2<N>,
    },
    /// -C/(2 B) with a common ruling divided out of B and C, in half angles.
    Cubic {
        /// B / sin((u-u0)/2): cos(u/2), sin(u/2).
        linear: [N; 2],
        /// C / sin((u-u0)/2): cos(u/2), sin(u/2), cos(3u/2), sin(3u/2).
        constant: [N; 4],
    },
}

/// A branch of the intersection of two quadrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadricCurve<N: Float = f64> {
    /// The surface whose rulings carry it.
    pub(crate) base: Ruled<N>,
    /// The run of the angle.
    pub(crate) sweep: Sweep<N>,
    /// The height over the angle.
    pub(crate) height: Height<N>,
}

impl<N: Float> QuadricCurve<N> {
    /// The parameter's period, if the branch is closed. All branches are, except rational ones with
    /// a pole.
    pub(crate) fn period(&self) -> Option<N> {
        match (self.height, self.sweep) {
            (Height::Rational { linear, .. }, _) => {
                let [mean, cos, sin] = linear;
                (mean.abs() > cos.hypot(sin)).then_some(N::TAU)
            }
            (Height::Cubic { .. }, _) => None,
            (_, Sweep::Round { turns }) => Some(N::TAU * N::whole(turns)),
            (_, Sweep::Oval { .. }) => Some(N::TAU),
        }
    }

    /// The angle u at t.
    pub(crate) fn angle<S: Analytic<Float = N>>(&self, t: S) -> S {
        match self.sweep {
            Sweep::Round { .. } => t,
            Sweep::Oval { mid, half } => S::constant(mid) - t.sin_cos().1.scale(half),
        }
    }

    /// The parameters at an angle, within one period of a closed branch. If the sweep does not
    /// reach the angle, the closest end of the sweep.
    pub(super) fn parameters_of(&self, u: N) -> Vec<N> {
        match self.sweep {
            Sweep::Round { turns } => (0..turns.max(1))
                .map(|turn| u.rem_euclid(N::TAU) + N::TAU * N::whole(turn))
                .collect(),
            Sweep::Oval { mid, half } => {
                let away = (u - mid + N::PI).rem_euclid(N::TAU) - N::PI;
                let t = (-away / half).clamp(-N::ONE, N::ONE).acos();
                vec![t, N::TAU - t]
            }
        }
    }

    /// The parameters at which a curve with one point on each ruling passes through the cone's
    /// apex: the zeros of B.
    pub(super) fn apex_parameters(&self) -> Vec<N> {
        match (self.base.is_cone(), self.height) {
            (true, Height::Rational { linear, .. }) => {
                let [mean, cos, sin] = linear;
                let (middle, size) = (sin.atan2(cos), cos.hypot(sin));
                let level = -mean / size;
                if level.abs() > N::ONE + N::HALF * N::from_f64(DOUBLE) * N::from_f64(DOUBLE) {
                    return Vec::new();
                }
                let half = level.clamp(-N::ONE, N::ONE).acos();
                let zeros = [middle - half, middle + half];
                zeros.map(|u| u.rem_euclid(N::TAU)).to_vec()
            }
            _ => Vec::new(),
        }
    }

    /// Whether the curve has a cusp at t: at the apex, where B has a double zero.
    pub(super) fn turns_back(&self, t: N) -> bool {
        let zeros = self.apex_parameters();
        let near = |u: &N| {
            let away = (t - *u).rem_euclid(N::TAU);
            away.min(N::TAU - away) < N::from_f64(DOUBLE)
        };
        !zeros.is_empty() && zeros.iter().all(near)
    }

    /// The parameters within one period at which the curve passes close to a node, a point where two
    /// branches would cross. It turns there within a short range of the parameter.
    pub(super) fn near_nodes(&self) -> Vec<N> {
        match &self.height {
            Height::Whole { radicand, .. } => radicand
                .narrow_minima(N::from_f64(SHORT_RANGE))
                .flat_map(|u| self.parameters_of(u))
                .collect(),
            Height::Deflated { rest, .. } => rest
                .complex_zeros()
                .into_iter()
                .filter(|zero| self.is_close(zero))
                .flat_map(|zero| self.parameters_of(zero.real))
                .collect(),
            Height::Rational { .. } | Height::Cubic { .. } => Vec::new(),
        }
    }

    /// Whether the parameter at a complex angle has a small imaginary part.
    fn is_close(&self, angle: &ComplexAngle<N>) -> bool {
        let range = N::from_f64(SHORT_RANGE);
        match self.sweep {
            Sweep::Round { .. } => angle.imaginary <= range,
            Sweep::Oval { mid, half } => {
                // The imaginary part of arccos z is arcosh of the mean distance of z from ±1.
                let away = (angle.real - mid + N::PI).rem_euclid(N::TAU) - N::PI;
                let [x, y] = [away / half, angle.imaginary / half];
                let mean = N::HALF * ((x - N::ONE).hypot(y) + (x + N::ONE).hypot(y));
                mean - N::ONE <= N::HALF * range.square()
            }
        }
    }

    /// The height w as (numerator, denominator).
    fn quotient<S: Analytic<Float = N>>(&self, t: S, u: S, at: (S, S)) -> (S, S) {
        match &self.height {
            Height::Whole {
                along,
                radicand,
                sign,
            } => along.quotient(radicand.at(u).root().scale(*sign), at),
            Height::Deflated {
                along,
                rest,
                node,
                sign,
            } => {
                let mut root = rest.at(u).root().scale(*sign);
                if let Some(node) = node {
                    root = root * (u - S::constant(*node)).times(0.5).sin_cos().0;
                }
                if let Sweep::Oval { half, .. } = self.sweep {
                    root = root * oval_factor(t, half);
                }
                along.quotient(root, at)
            }
            Height::Rational { linear, constant } => {
                (-harmonic(constant, at), trig1(linear, at).times(2.0))
            }
            Height::Cubic { linear, constant } => {
                let (s1, c1) = u.times(0.5).sin_cos();
                let (s3, c3) = u.times(1.5).sin_cos();
                let numerator = c1.scale(constant[0])
                    + s1.scale(constant[1])
                    + c3.scale(constant[2])
                    + s3.scale(constant[3]);
                (
                    -numerator,
                    (c1.scale(linear[0]) + s1.scale(linear[1])).times(2.0),
                )
            }
        }
    }

    /// The height w at t. For a cone it is the reciprocal of the height above the apex.
    pub(crate) fn height_at<S: Analytic<Float = N>>(&self, t: S) -> S {
        let u = self.angle(t);
        let (n, d) = self.quotient(t, u, u.sin_cos());
        n.over(d)
    }

    /// The point at t.
    pub(crate) fn at<S: Analytic<Float = N>>(&self, t: S) -> [S; 3] {
        let u = self.angle(t);
        let (sin, cos) = u.sin_cos();
        let (n, d) = self.quotient(t, u, (sin, cos));
        let [a, b] = self.base.radii();
        let frame = self.base.frame();
        if self.base.is_cone() {
            let v = d.over(n);
            frame.world_of([v.scale(a) * cos, v.scale(b) * sin, v])
        } else {
            frame.world_of([cos.scale(a), sin.scale(b), n.over(d)])
        }
    }
}

/// Zeros closer than this, in radians, are one double zero.
const DOUBLE: f64 = 1.0 / (1 << 20) as f64;

/// The largest imaginary part, in radians, of a branch point at which the curve turns sharply.
const SHORT_RANGE: f64 = 1.0 / 4.0;

/// √(sin((u-u0)/2) sin((u1-u)/2)) for u = mid - half cos t, analytic, with the sign of sin t.
fn oval_factor<N: Float, S: Analytic<Float = N>>(t: S, half: N) -> S {
    let (s, c) = t.times(0.5).sin_cos();
    let a = s.square().scale(half).sinc();
    let b = c.square().scale(half).sinc();
    (s * c).scale(half) * (a * b).root()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::Curve;
    use std::f64::consts::{FRAC_PI_2, PI, TAU};

    fn on_cylinder(sweep: Sweep, height: Height) -> QuadricCurve {
        let frame = Frame::about(Point3::origin(), nalgebra::Vector3::z());
        let base = Ruled::Cylinder(Cylinder { frame, radius: 1.0 });
        QuadricCurve {
            base,
            sweep,
            height,
        }
    }

    fn along() -> Along {
        Along {
            lead: 1.0,
            linear: [0.0; 3],
            constant: None,
        }
    }

    /// A cylinder along x about one of radius 1 along z: Δ = r² - sin² u.
    fn around(r: f64) -> QuadricCurve {
        let k = [r * r - 0.5, 0.0, 0.0, 0.5, 0.0];
        let height = Height::Whole {
            along: along(),
            radicand: CentredTrigonometric::new(&k, |u| (r - u.sin()) * (r + u.sin())),
            sign: 1.0,
        };
        on_cylinder(Sweep::Round { turns: 1 }, height)
    }

    #[test]
    fn a_branch_is_divided_where_it_passes_another() {
        let close = Curve::Quartic(Box::new(around(1.0 + 1e-9)));
        let breaks = close.breaks(1.0, 6.0);
        for node in [FRAC_PI_2, 3.0 * FRAC_PI_2] {
            assert!(breaks.iter().any(|t| (t - node).abs() < 1e-7), "{breaks:?}");
        }
        assert!(breaks.is_sorted());
        let [lo, hi] = [breaks[0], breaks[breaks.len() - 1]];
        assert_eq!([lo, hi], [1.0, 6.0]);
        assert_eq!(around(2.0).near_nodes(), Vec::<f64>::new());
    }

    /// q = cos u - cos w is zero at a distance w - 1 beyond both ends of an oval over |u| <= 1.
    #[test]
    fn an_oval_is_divided_next_to_another() {
        let oval = |w: f64| {
            let height = Height::Deflated {
                along: along(),
                rest: CentredTrigonometric::linear(&[-w.cos(), 1.0, 0.0]),
                node: None,
                sign: 1.0,
            };
            on_cylinder(
                Sweep::Oval {
                    mid: 0.0,
                    half: 1.0,
                },
                height,
            )
        };
        let mut nodes = oval(1.001).near_nodes();
        nodes.sort_by(f64::total_cmp);
        for t in [0.0, PI, TAU] {
            assert!(
                nodes.iter().any(|node| (node - t).abs() < 1e-9),
                "{nodes:?}"
            );
        }
        assert_eq!(oval(2.0).near_nodes(), Vec::<f64>::new());
    }
}
