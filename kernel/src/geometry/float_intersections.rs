//! Geometry of any precision, rounded to doubles.

use super::bivariate_trig_poly::BivariateTrigPoly;
use super::curve::{Circle, Conic, Curve, Ellipse, Hyperbola, Line};
use super::frame::Frame;
use super::quadric_curve::{Along, Height, QuadricCurve, Ruled, Sweep};
use super::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use super::torus_curve::{TorusCurve, TorusCurveSegment};
use crate::number::float::Float;

impl<N: Float> Frame<N> {
    /// The same in doubles.
    pub fn in_doubles(&self) -> Frame {
        Frame {
            origin: self.origin.map(N::rounded),
            x: self.x.map(N::rounded),
            y: self.y.map(N::rounded),
            z: self.z.map(N::rounded),
        }
    }
}

impl<N: Float> Cylinder<N> {
    fn in_doubles(&self) -> Cylinder {
        Cylinder {
            frame: self.frame.in_doubles(),
            radius: self.radius.rounded(),
        }
    }
}

impl<N: Float> Cone<N> {
    fn in_doubles(&self) -> Cone {
        Cone {
            frame: self.frame.in_doubles(),
            sin: self.sin.rounded(),
            cos: self.cos.rounded(),
        }
    }
}

impl<N: Float> Torus<N> {
    fn in_doubles(&self) -> Torus {
        Torus {
            frame: self.frame.in_doubles(),
            major: self.major.rounded(),
            minor: self.minor.rounded(),
        }
    }
}

impl<N: Float> Surface<N> {
    /// The same in doubles.
    pub fn in_doubles(&self) -> Surface {
        match self {
            Self::Plane(s) => Surface::Plane(Plane {
                frame: s.frame.in_doubles(),
            }),
            Self::Cylinder(s) => Surface::Cylinder(s.in_doubles()),
            Self::Cone(s) => Surface::Cone(s.in_doubles()),
            Self::Sphere(s) => Surface::Sphere(Sphere {
                frame: s.frame.in_doubles(),
                radius: s.radius.rounded(),
            }),
            Self::Torus(s) => Surface::Torus(s.in_doubles()),
        }
    }
}

impl<N: Float> BivariateTrigPoly<N> {
    pub(super) fn in_doubles(&self) -> BivariateTrigPoly {
        BivariateTrigPoly(self.0.map(|row| row.map(N::rounded)))
    }
}

impl<N: Float> Curve<N> {
    /// The same in doubles.
    pub fn in_doubles(&self) -> Curve {
        match self {
            Self::Line(c) => Curve::Line(Line {
                origin: c.origin.map(N::rounded),
                direction: c.direction.map(N::rounded),
            }),
            Self::Circle(c) => Curve::Circle(Circle {
                frame: c.frame.in_doubles(),
                radius: c.radius.rounded(),
            }),
            Self::Ellipse(c) => Curve::Ellipse(Ellipse {
                frame: c.frame.in_doubles(),
                a: c.a.rounded(),
                b: c.b.rounded(),
            }),
            Self::Hyperbola(c) => Curve::Hyperbola(Hyperbola {
                frame: c.frame.in_doubles(),
                a: c.a.rounded(),
                b: c.b.rounded(),
            }),
            Self::Conic(c) => Curve::Conic(Conic {
                frame: c.frame.in_doubles(),
                curvature: c.curvature.rounded(),
                shear: c.shear.rounded(),
                flatness: c.flatness.rounded(),
            }),
            Self::Quartic(c) => Curve::Quartic(Box::new(c.in_doubles())),
            Self::Toric(c) => Curve::Toric(Box::new(c.in_doubles())),
        }
    }
}

impl<N: Float> Along<N> {
    fn in_doubles(&self) -> Along {
        Along {
            lead: self.lead.rounded(),
            linear: self.linear.map(N::rounded),
            constant: self.constant.map(|k| k.map(N::rounded)),
        }
    }
}

impl<N: Float> QuadricCurve<N> {
    fn in_doubles(&self) -> QuadricCurve {
        let base = match &self.base {
            Ruled::Cylinder(s) => Ruled::Cylinder(s.in_doubles()),
            Ruled::Cone(s) => Ruled::Cone(s.in_doubles()),
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
            height: self.height.in_doubles(),
        }
    }
}

impl<N: Float> Height<N> {
    fn in_doubles(&self) -> Height {
        match self {
            Self::Whole {
                along,
                radicand,
                sign,
            } => Height::Whole {
                along: along.in_doubles(),
                radicand: radicand.map(N::rounded),
                sign: sign.rounded(),
            },
            Self::Deflated {
                along,
                rest,
                node,
                sign,
            } => Height::Deflated {
                along: along.in_doubles(),
                rest: rest.map(N::rounded),
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
    fn in_doubles(&self) -> TorusCurve {
        TorusCurve {
            torus: self.torus.in_doubles(),
            form: self.form.in_doubles(),
            charts: self.charts.iter().map(|c| c.in_doubles()).collect(),
            segments: self
                .segments
                .iter()
                .map(TorusCurveSegment::in_doubles)
                .collect(),
            closed: self.closed,
        }
    }
}

impl<N: Float> TorusCurveSegment<N> {
    fn in_doubles(&self) -> TorusCurveSegment {
        TorusCurveSegment {
            axis: self.axis,
            from: self.from.rounded(),
            to: self.to.rounded(),
            ends: self.ends.map(N::rounded),
            slopes: self.slopes.map(N::rounded),
            steep: self.steep.rounded(),
            bracket: self.bracket.map(N::rounded),
            chart: self.chart,
        }
    }
}
