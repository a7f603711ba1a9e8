//! Conversion of geometry from any precision to f64.

use super::bivariate_trig_poly::BivariateTrigPoly;
use super::curve::{Circle, Conic, Curve, Ellipse, Hyperbola, Line};
use super::ellipsoid::Ellipsoid;
use super::elliptic_surface::{EllipticCone, EllipticCylinder};
use super::frame::Frame;
use super::quadric_curve::{Along, Height, QuadricCurve, Ruled, Sweep};
use super::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use super::torus_curve::{SegmentEquation, TorusCurve, TorusCurveSegment};
use crate::number::double_double::F106;
use crate::number::float::Float;

impl<N: Float> Frame<N> {
    /// The frame rounded to f64.
    pub(crate) fn to_f64(self) -> Frame {
        Frame {
            origin: self.origin.map(N::rounded),
            x: self.x.map(N::rounded),
            y: self.y.map(N::rounded),
            z: self.z.map(N::rounded),
        }
    }
}

impl<N: Float> Cylinder<N> {
    fn to_f64(self) -> Cylinder {
        Cylinder {
            frame: self.frame.to_f64(),
            radius: self.radius.rounded(),
        }
    }
}

impl<N: Float> Cone<N> {
    fn to_f64(self) -> Cone {
        Cone {
            frame: self.frame.to_f64(),
            sin: self.sin.rounded(),
            cos: self.cos.rounded(),
        }
    }
}

impl<N: Float> Torus<N> {
    pub(crate) fn to_f64(self) -> Torus {
        Torus {
            frame: self.frame.to_f64(),
            major: self.major.rounded(),
            minor: self.minor.rounded(),
        }
    }
}

impl<N: Float> EllipticCylinder<N> {
    fn to_f64(self) -> EllipticCylinder {
        EllipticCylinder {
            frame: self.frame.to_f64(),
            radii: self.radii.map(N::rounded),
        }
    }
}

impl<N: Float> EllipticCone<N> {
    fn to_f64(self) -> EllipticCone {
        EllipticCone {
            frame: self.frame.to_f64(),
            slopes: self.slopes.map(N::rounded),
        }
    }
}

impl<N: Float> Ellipsoid<N> {
    fn to_f64(self) -> Ellipsoid {
        Ellipsoid {
            frame: self.frame.to_f64(),
            radii: self.radii.map(N::rounded),
            axes: self.axes.map(|axis| axis.map(N::rounded)),
        }
    }
}

impl<N: Float> Surface<N> {
    /// The surface rounded to f64.
    pub fn to_f64(&self) -> Surface {
        match self {
            Self::Plane(s) => Surface::Plane(Plane {
                frame: s.frame.to_f64(),
            }),
            Self::Cylinder(s) => Surface::Cylinder(s.to_f64()),
            Self::Cone(s) => Surface::Cone(s.to_f64()),
            Self::Sphere(s) => Surface::Sphere(Sphere {
                frame: s.frame.to_f64(),
                radius: s.radius.rounded(),
            }),
            Self::Torus(s) => Surface::Torus(s.to_f64()),
            Self::EllipticCylinder(s) => Surface::EllipticCylinder(s.to_f64()),
            Self::EllipticCone(s) => Surface::EllipticCone(s.to_f64()),
            Self::Ellipsoid(s) => Surface::Ellipsoid(s.to_f64()),
        }
    }
}

impl<N: Float> BivariateTrigPoly<N> {
    pub(super) fn to_f64(&self) -> BivariateTrigPoly {
        BivariateTrigPoly(self.0.map(|row| row.map(N::rounded)))
    }
}

impl<N: Float> Curve<N> {
    /// The curve rounded to f64 for bounds that are enlarged by more than rounding moves it: on a torus
    /// without F in extended precision.
    pub(super) fn to_f64_for_bounds(&self) -> Curve {
        match self {
            Self::Toric(c) => Curve::Toric(Box::new(c.to_f64_form())),
            _ => self.to_f64(),
        }
    }

    /// The curve rounded to f64.
    pub fn to_f64(&self) -> Curve {
        match self {
            Self::Line(c) => Curve::Line(Line {
                origin: c.origin.map(N::rounded),
                direction: c.direction.map(N::rounded),
            }),
            Self::Circle(c) => Curve::Circle(Circle {
                frame: c.frame.to_f64(),
                radius: c.radius.rounded(),
            }),
            Self::Ellipse(c) => Curve::Ellipse(Ellipse {
                frame: c.frame.to_f64(),
                a: c.a.rounded(),
                b: c.b.rounded(),
            }),
            Self::Hyperbola(c) => Curve::Hyperbola(Hyperbola {
                frame: c.frame.to_f64(),
                a: c.a.rounded(),
                b: c.b.rounded(),
            }),
            Self::Conic(c) => Curve::Conic(Conic {
                frame: c.frame.to_f64(),
                curvature: c.curvature.rounded(),
                shear: c.shear.rounded(),
                flatness: c.flatness.rounded(),
            }),
            Self::Quartic(c) => Curve::Quartic(Box::new(c.to_f64())),
            Self::Toric(c) => Curve::Toric(Box::new(c.to_f64())),
        }
    }
}

impl<N: Float> Along<N> {
    fn to_f64(self) -> Along {
        Along {
            lead: self.lead.rounded(),
            linear: self.linear.map(N::rounded),
            constant: self.constant.map(|k| k.map(N::rounded)),
        }
    }
}

impl<N: Float> QuadricCurve<N> {
    fn to_f64(self) -> QuadricCurve {
        let base = match &self.base {
            Ruled::Cylinder(s) => Ruled::Cylinder(s.to_f64()),
            Ruled::Cone(s) => Ruled::Cone(s.to_f64()),
            Ruled::EllipticCylinder(s) => Ruled::EllipticCylinder(s.to_f64()),
            Ruled::EllipticCone(s) => Ruled::EllipticCone(s.to_f64()),
        };
        let sweep = match self.sweep {
            Sweep::Round { turns } => Sweep::Round { turns },
            Sweep::Oval { mid, half } => Sweep::Oval {
                mid: mid.rounded(),
                half: half.rounded(),
            },
        };
        QuadricCurve {
            base,
            sweep,
            height: self.height.to_f64(),
        }
    }
}

impl<N: Float> Height<N> {
    fn to_f64(self) -> Height {
        match self {
            Self::Whole {
                along,
                radicand,
                sign,
            } => Height::Whole {
                along: along.to_f64(),
                radicand: radicand.to_f64(),
                sign: sign.rounded(),
            },
            Self::Deflated {
                along,
                rest,
                node,
                sign,
            } => Height::Deflated {
                along: along.to_f64(),
                rest: rest.to_f64(),
                node: node.map(N::rounded),
                sign: sign.rounded(),
            },
            Self::Rational { linear, constant } => Height::Rational {
                linear: linear.map(N::rounded),
                constant: constant.map(N::rounded),
            },
            Self::Cubic { linear, constant } => Height::Cubic {
                linear: linear.map(N::rounded),
                constant: constant.map(N::rounded),
            },
        }
    }
}

impl<N: Float> TorusCurve<N> {
    /// The curve rounded to f64, with F in extended precision where its rounding would move the
    /// curve.
    fn to_f64(&self) -> TorusCurve {
        let mut curve = self.to_f64_form();
        if N::IS_DOUBLE {
            return curve;
        }
        let equations: Vec<SegmentEquation> =
            curve.segments.iter().map(|s| curve.equation(s)).collect();
        if equations.contains(&SegmentEquation::ExtendedAngles) {
            let form = self.form.0.map(|row| row.map(to_double_double));
            curve.extended_form = Some(Box::new(BivariateTrigPoly(form)));
        }
        for (segment, equation) in curve.segments.iter_mut().zip(equations) {
            segment.equation = equation;
        }
        curve
    }

    /// The curve with F rounded to f64, of which points next to a near node are only known to about the
    /// square root of the rounding.
    fn to_f64_form(&self) -> TorusCurve {
        TorusCurve {
            torus: self.torus.to_f64(),
            form: self.form.to_f64(),
            extended_form: None,
            charts: self.charts.iter().map(|c| c.to_f64()).collect(),
            segments: self
                .segments
                .iter()
                .copied()
                .map(TorusCurveSegment::to_f64)
                .collect(),
            closed: self.closed,
        }
    }
}

impl TorusCurve {
    /// The equation with which rounding does not move a segment.
    fn equation(&self, s: &TorusCurveSegment) -> SegmentEquation {
        let size = self.torus.major.abs() + self.torus.minor;
        let moves = |tau: f64| {
            let by = self.form_error(s, tau);
            by.is_nan() || by > MOVED * size
        };
        match s.equation {
            SegmentEquation::Angles if [0.0, 0.5, 1.0].into_iter().any(moves) => {
                SegmentEquation::ExtendedAngles
            }
            equation => equation,
        }
    }
}

/// The movement of a curve by the rounding of F, relative to the rounding of its coordinates, above
/// which F is kept in extended precision.
const MOVED: f64 = 1024.0;

/// The leading 106 bits of a number.
fn to_double_double<N: Float>(x: N) -> F106 {
    let high = x.rounded();
    let low = (x - N::from_f64(high)).rounded();
    F106::from_f64(high) + F106::from_f64(low)
}

impl<N: Float> TorusCurveSegment<N> {
    fn to_f64(self) -> TorusCurveSegment {
        TorusCurveSegment {
            axis: self.axis,
            from: self.from.rounded(),
            to: self.to.rounded(),
            ends: self.ends.map(N::rounded),
            slopes: self.slopes.map(N::rounded),
            steep: self.steep.rounded(),
            bracket: self.bracket.map(N::rounded),
            equation: self.equation,
        }
    }
}
