//! Curves and surfaces as JSON: a type and exact parameters.

use super::centred_trigonometric::{CentredTrigonometric, TrigonometricMinimum};
use super::curve::Curve;
use super::frame::Frame;
use super::quadric_curve::{Height, QuadricCurve, Sweep};
use super::surface::Surface;
use super::torus_curve::TorusCurve;
use super::torus_parameter::TorusParameter;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

/// Writes a surface with its exact parameters.
///
/// # Errors
/// The serializer fails.
pub fn surface<S: Serializer>(surface: &Surface, serializer: S) -> Result<S::Ok, S::Error> {
    surface_value(surface).serialize(serializer)
}

/// The JSON of a surface: its type, its frame and its parameters, as in [`Surface`].
pub(crate) fn surface_value(surface: &Surface) -> Value {
    let name = surface.kind().name();
    let frame = surface.frame();
    match surface {
        Surface::Plane(_) => placed(name, "origin", frame),
        Surface::Cylinder(s) => with(placed(name, "origin", frame), &[("radius", s.radius)]),
        Surface::Cone(s) => with(
            placed(name, "apex", frame),
            &[("sin", s.sin), ("cos", s.cos)],
        ),
        Surface::Sphere(s) => with(placed(name, "center", frame), &[("radius", s.radius)]),
        Surface::Torus(s) => with(
            placed(name, "center", frame),
            &[("major", s.major), ("minor", s.minor)],
        ),
        Surface::EllipticCylinder(s) => {
            let [a, b] = s.radii;
            with(placed(name, "origin", frame), &[("a", a), ("b", b)])
        }
        Surface::EllipticCone(s) => {
            let [a, b] = s.slopes;
            with(placed(name, "apex", frame), &[("a", a), ("b", b)])
        }
        Surface::Ellipsoid(s) => {
            let [a, b, c] = s.radii;
            with(
                placed(name, "center", frame),
                &[("a", a), ("b", b), ("c", c)],
            )
        }
    }
}

/// Writes a curve with its exact parameters.
///
/// # Errors
/// The serializer fails.
pub fn curve<S: Serializer>(curve: &Curve, serializer: S) -> Result<S::Ok, S::Error> {
    value(curve).serialize(serializer)
}

fn three(v: impl Into<[f64; 3]>) -> [f64; 3] {
    v.into()
}

fn placed(name: &str, at: &str, f: &Frame) -> Value {
    let mut v = json!({"type": name, "x": three(f.x), "y": three(f.y), "normal": three(f.z)});
    v[at] = json!(three(f.origin));
    v
}

fn with(mut v: Value, more: &[(&str, f64)]) -> Value {
    for (key, x) in more {
        v[*key] = json!(x);
    }
    v
}

/// The JSON of a curve: its type and its parameters. [`Curve`] documents the point at a parameter.
pub(crate) fn value(curve: &Curve) -> Value {
    match curve {
        Curve::Line(c) => {
            json!({"type": "line", "origin": three(c.origin), "direction": three(c.direction)})
        }
        Curve::Circle(c) => with(
            placed("circle", "center", &c.frame),
            &[("radius", c.radius)],
        ),
        Curve::Ellipse(c) => with(
            placed("ellipse", "center", &c.frame),
            &[("a", c.a), ("b", c.b)],
        ),
        Curve::Hyperbola(c) => with(
            placed("hyperbola", "center", &c.frame),
            &[("a", c.a), ("b", c.b)],
        ),
        Curve::Conic(c) if c.is_parabola() => with(
            placed("parabola", "vertex", &c.frame),
            &[("focal", 0.5 / c.curvature)],
        ),
        Curve::Conic(c) => with(
            placed("conic", "point", &c.frame),
            &[
                ("curvature", c.curvature),
                ("shear", c.shear),
                ("flatness", c.flatness),
            ],
        ),
        Curve::Quartic(q) => quartic(q),
        Curve::Toric(c) => toric(c),
    }
}

fn quartic(q: &QuadricCurve) -> Value {
    let base = surface_value(&q.base.surface());
    let sweep = match q.sweep {
        Sweep::Round { turns } => json!({"turns": turns}),
        Sweep::Oval { mid, half } => json!({"mid": mid, "half": half}),
    };
    let height = match &q.height {
        Height::Whole {
            along,
            radicand,
            sign,
        } => json!({"form": "whole", "lead": along.lead, "linear": along.linear,
            "radicand": radicand.coefficients(), "minima": minima(radicand), "sign": sign}),
        Height::Deflated {
            along,
            rest,
            node,
            sign,
        } => {
            json!({"form": "deflated", "lead": along.lead, "linear": along.linear, "rest": linear_coefficients(rest), "minima": minima(rest),
            "node": node, "sign": sign})
        }
        Height::Rational { linear, constant } => {
            json!({"form": "rational", "linear": linear, "constant": constant})
        }
        Height::Cubic { linear, constant } => {
            json!({"form": "cubic", "linear": linear, "constant": constant})
        }
    };
    json!({"type": "quartic", "base": base, "sweep": sweep, "height": height})
}

/// The minima of a polynomial. About one of them it is least + v (a + b sin τ + c v), where τ is the
/// angle from it, v = 1 - cos τ, and a, b and c are the rise.
fn minima(polynomial: &CentredTrigonometric) -> Vec<Value> {
    let [first, second] = polynomial.minima;
    let count = if first == second { 1 } else { 2 };
    let minimum =
        |m: &TrigonometricMinimum| json!({"angle": m.angle, "least": m.least, "rise": m.rise});
    polynomial.minima[..count].iter().map(minimum).collect()
}

/// The coefficients of 1, cos u and sin u of a polynomial of degree one.
fn linear_coefficients(rest: &CentredTrigonometric) -> [f64; 3] {
    let [mean, cos, sin, _, _] = rest.coefficients();
    [mean, cos, sin]
}

fn toric(c: &TorusCurve) -> Value {
    let torus = with(
        placed("torus", "center", &c.torus.frame),
        &[("major", c.torus.major), ("minor", c.torus.minor)],
    );
    let segments: Vec<Value> = c
        .segments
        .iter()
        .enumerate()
        .map(|(i, s)| {
            let [[theta0, phi0], [theta1, phi1]] = c.ends(i);
            match s.axis {
                TorusParameter::Around => json!({"along": "theta", "from": theta0, "to": theta1,
                    "ends": [phi0, phi1]}),
                TorusParameter::Tube => json!({"along": "phi", "from": phi0, "to": phi1,
                    "ends": [theta0, theta1]}),
            }
        })
        .collect();
    json!({"type": "toric", "torus": torus, "form": c.form.0, "closed": c.closed,
        "segments": segments})
}
