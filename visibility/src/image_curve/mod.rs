//! Curves in the image: exact lines and conics where the curve in space is one.
//!
//! Notation: the homogeneous image of a line or a conic is h(t) = M b(t), where M is a constant
//! matrix and b(t) is (t, 1) for a line, (cos t, sin t, 1), (x(t), t, 1) or (cosh t, sinh t, 1) for
//! a conic. The conic is hᵀ C h = 0 with C = M⁻ᵀ B M⁻¹, B the conic of b; it is also the cone of
//! sight, the lines from the eye through the curve. A line's cone of sight is the plane l·h = 0.

pub(crate) mod edgewise;
pub(crate) mod image_box;
pub(crate) mod monotone_arc;
pub(crate) mod polynomial;

use crate::camera::projection::Projection;
use crate::image_curve::edgewise::Edgewise;
use nalgebra::{Matrix3, Point3, Vector3};
use premio_kernel::geometry::curve::{Conic, Curve};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use std::f64::consts::TAU;

/// The functions that a conic's parameter enters through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Basis {
    /// cos t, sin t, 1.
    Circular,
    /// x(t), t, 1 of a conic about a point of it: (2 κ m², 2 m, 1 + 2 β m + κ α m²), up to a
    /// factor, over its chord m.
    Graph(Conic),
    /// cosh t, sinh t, 1.
    Hyperbolic,
}

impl Basis {
    /// The values at t.
    pub fn at(self, t: f64) -> Vector3<f64> {
        match self {
            Self::Circular => {
                let (s, c) = t.sin_cos();
                Vector3::new(c, s, 1.0)
            }
            Self::Graph(c) => Vector3::new(c.height(t), t, 1.0),
            Self::Hyperbolic => Vector3::new(t.cosh(), t.sinh(), 1.0),
        }
    }

    /// B: the form that vanishes on the basis' points.
    pub fn conic(self) -> Matrix3<f64> {
        match self {
            Self::Circular => Matrix3::from_diagonal(&Vector3::new(1.0, 1.0, -1.0)),
            Self::Graph(c) => {
                let (k, b, a) = (c.curvature, c.shear, c.flatness);
                Matrix3::new(a, b, -1.0, b, k, 0.0, -1.0, 0.0, 0.0)
            }
            Self::Hyperbolic => Matrix3::from_diagonal(&Vector3::new(1.0, -1.0, -1.0)),
        }
    }

    /// The parameter of the point (u, v, w) of the basis' conic, up to a factor; none on the other
    /// branch of a hyperbola, or where a graph has come to its end.
    fn parameter(self, b: &Vector3<f64>) -> Option<f64> {
        match self {
            Self::Circular => Some((b.y * b.z.signum()).atan2(b.x * b.z.signum())),
            Self::Graph(c) => {
                let (x, y) = (b.x / b.z, b.y / b.z);
                let is_on_graph = (c.shear * y + c.flatness * x).is_short_of(1.0);
                is_on_graph.then_some(y)
            }
            Self::Hyperbolic => (b.x / b.z).is_above_zero().then(|| (b.y / b.z).asinh()),
        }
    }
}

/// The image of a curve.
#[derive(Clone, Debug)]
pub(crate) enum Image {
    /// The curve is a line of sight.
    Point,
    /// A line: h = origin + t direction, and the line's coefficients, with l·h a distance in the
    /// plane at depth one.
    Line {
        /// The image of the parameter 0.
        origin: Vector3<f64>,
        /// The image of the direction.
        direction: Vector3<f64>,
        /// l.
        line: Vector3<f64>,
    },
    /// A proper conic.
    Conic {
        /// The basis of the parameter.
        basis: Basis,
        /// M.
        map: Matrix3<f64>,
        /// M⁻¹.
        inverse: Matrix3<f64>,
        /// C.
        conic: Matrix3<f64>,
    },
    /// A conic seen edge-on, on a line.
    Flat {
        /// The basis of the parameter.
        basis: Basis,
        /// M.
        map: Matrix3<f64>,
        /// The line's coefficients.
        line: Vector3<f64>,
    },
    /// Neither a line nor a conic, on a cylinder seen along its axis.
    Edgewise(Edgewise),
    /// Neither a line nor a conic.
    General,
}

fn unit_line(l: Vector3<f64>) -> Vector3<f64> {
    l / l.x.hypot(l.y).max(l.z.abs())
}

/// The parameter beyond which a hyperbola is indistinguishable from its asymptotes: its conic loses
/// digits exponentially in its square.
const SHARP: f64 = 8.0;

/// The image of a curve over `range`; `resolution` is the resolution of the part.
pub(crate) fn image(
    curve: &Curve,
    range: [f64; 2],
    projection: &Projection,
    resolution: f64,
) -> Image {
    let conic = |frame: &Frame, a: f64, b: f64, basis: Basis| {
        conic_image(frame, a, b, basis, projection, resolution)
    };
    match curve {
        Curve::Line(c) => {
            // Near the curve's own middle, so that a far origin costs no digits.
            let origin = projection.homogeneous(&c.origin);
            let direction = projection.homogeneous_vector(&c.direction);
            let middle = c.origin + c.direction * (0.5 * (range[0] + range[1]));
            let towards = projection.towards_eye(&middle).direction;
            let width = towards.cross(&c.direction).norm() * (range[1] - range[0]);
            if width.is_at_most(resolution) {
                return Image::Point;
            }
            let line = unit_line(projection.homogeneous(&middle).cross(&direction));
            Image::Line {
                origin,
                direction,
                line,
            }
        }
        Curve::Circle(c) => conic(&c.frame, c.radius, c.radius, Basis::Circular),
        Curve::Ellipse(c) => conic(&c.frame, c.a, c.b, Basis::Circular),
        Curve::Conic(c) => conic(&c.frame, 1.0, 1.0, Basis::Graph(*c)),
        Curve::Hyperbola(c) => match conic(&c.frame, c.a, c.b, Basis::Hyperbolic) {
            Image::Conic { .. } if range.iter().any(|t| t.abs().is_beyond(SHARP)) => Image::General,
            image => image,
        },
        Curve::Quartic(_) | Curve::Toric(_) => Image::General,
    }
}

fn conic_image(
    frame: &Frame,
    a: f64,
    b: f64,
    basis: Basis,
    projection: &Projection,
    resolution: f64,
) -> Image {
    let map = map_of(frame, a, b, projection);
    let eye = projection.towards_eye(&frame.origin);
    let tilt = eye.direction.dot(&frame.z).abs();
    // The image is thinner than the resolution, or the plane is that near to the eye.
    let reach = match basis {
        Basis::Circular => a.max(b),
        _ if eye.distance.is_finite() => eye.distance,
        _ => resolution / ROUNDING,
    };
    let edge_on = (tilt * reach).is_at_most(resolution);
    match map.try_inverse() {
        Some(inverse) if !edge_on => {
            let conic = inverse.transpose() * basis.conic() * inverse;
            Image::Conic {
                basis,
                map,
                inverse,
                conic: conic / conic.amax(),
            }
        }
        _ => flat(map, basis),
    }
}

/// M of a circle or an ellipse; none of other curves.
pub fn map_of_ellipse(curve: &Curve, projection: &Projection) -> Option<Matrix3<f64>> {
    match curve {
        Curve::Circle(c) => Some(map_of(&c.frame, c.radius, c.radius, projection)),
        Curve::Ellipse(c) => Some(map_of(&c.frame, c.a, c.b, projection)),
        _ => None,
    }
}

/// M of a conic in a frame with half axes.
fn map_of(frame: &Frame, a: f64, b: f64, projection: &Projection) -> Matrix3<f64> {
    Matrix3::from_columns(&[
        projection.homogeneous_vector(&(frame.x * a)),
        projection.homogeneous_vector(&(frame.y * b)),
        projection.homogeneous(&frame.origin),
    ])
}

/// The parameters in a range at which the image of a conic that is seen edge-on folds back.
pub fn folds_of_conic(curve: &Curve, range: [f64; 2], projection: &Projection) -> Vec<f64> {
    // An infinite resolution makes it edge-on.
    image(curve, range, projection, f64::INFINITY).turns(range)
}

/// The line that the three columns lie on.
fn flat(map: Matrix3<f64>, basis: Basis) -> Image {
    let c = [map.column(0), map.column(1), map.column(2)];
    let products = [c[0].cross(&c[1]), c[1].cross(&c[2]), c[2].cross(&c[0])];
    let [a, b, d] = products;
    let largest = [a, b, d]
        .into_iter()
        .max_by(|x, y| x.norm().total_cmp(&y.norm()))
        .unwrap_or(a);
    Image::Flat {
        basis,
        map,
        line: unit_line(largest),
    }
}

impl Image {
    /// Where the image turns back on itself: the parameters at which the derivative of the image
    /// of a conic seen edge-on vanishes.
    pub fn turns(&self, range: [f64; 2]) -> Vec<f64> {
        let (basis, map, line) = match self {
            Image::Flat { basis, map, line } => (basis, map, line),
            Image::Edgewise(image) => return image.turns.clone(),
            _ => return Vec::new(),
        };
        let along = Vector3::new(-line.y, line.x, 0.0);
        let (p, q) = (map.tr_mul(&along), map.tr_mul(&Vector3::z()));
        let found = Self::turns_of(*basis, &p, &q);
        let mut turns: Vec<f64> = found.into_iter().flatten().collect();
        let [lo, hi] = range;
        let within = |t: f64| match basis {
            Basis::Circular => lo + (t - lo).rem_euclid(TAU),
            _ => t,
        };
        turns.iter_mut().for_each(|t| *t = within(*t));
        turns.retain(|t| t.lies_in([lo, hi]));
        turns
    }

    /// Where the derivative of (p·b)/(q·b) vanishes: (p·b')(q·b) = (p·b)(q·b').
    pub fn turns_of(basis: Basis, p: &Vector3<f64>, q: &Vector3<f64>) -> [Option<f64>; 2] {
        // With b = (f, g, 1) that is k0 (f' g - f g') + k1 f' + k2 g' = 0.
        let k0 = p.x * q.y - p.y * q.x;
        let k1 = p.x * q.z - p.z * q.x;
        let k2 = p.y * q.z - p.z * q.y;
        let roots = |a: f64, b: f64, c: f64| {
            let radicand = b * b - a * c;
            let k = -(b + radicand.sqrt().copysign(b));
            [k / a, c / k]
        };
        let found = match basis {
            // f' g - f g' = -1, f' = -sin, g' = cos.
            Basis::Circular => {
                let size = k1.hypot(k2);
                let middle = (-k1).atan2(k2);
                let half = (k0 / size).acos();
                [middle - half, middle + half]
            }
            // With s = 1 - β t - α x: f' g - f g' = x/s, f' = (κ t + β x)/s, g' = 1; a quadratic in
            // m.
            Basis::Graph(c) => {
                let t = |m: f64| c.end_of_chord(m).unwrap_or(f64::NAN);
                let square = 2.0 * (k0 + c.shear * k1) - c.flatness * k2;
                roots(c.curvature * square, c.curvature * k1, k2).map(t)
            }
            // f' g - f g' = -1, f' = sinh, g' = cosh: with e = exp t, a quadratic.
            Basis::Hyperbolic => roots(k1 + k2, -k0, k2 - k1).map(f64::ln),
        };
        found.map(|t| t.is_finite().then_some(t))
    }

    /// The parameter of the curve's point whose image is `h`, given that there is one; of a conic
    /// seen edge-on, both.
    pub fn parameters(&self, h: &Vector3<f64>, range: [f64; 2], found: &mut impl FnMut(f64)) {
        match self {
            Image::Point | Image::Edgewise(_) | Image::General => {}
            Image::Line {
                origin,
                direction,
                line,
            } => {
                // Across the line, through h: m·(origin + t direction) = 0.
                let m = h.cross(&Vector3::new(line.x, line.y, 0.0));
                found(-m.dot(origin) / m.dot(direction));
            }
            Image::Conic { basis, inverse, .. } => {
                let Some(t) = basis.parameter(&(inverse * h)) else {
                    return;
                };
                found(match basis {
                    Basis::Circular => range[0] + (t - range[0]).rem_euclid(TAU),
                    _ => t,
                });
            }
            Image::Flat { basis, map, line } => {
                let m = h.cross(&Vector3::new(line.x, line.y, 0.0));
                line_on_conic(*basis, &map.tr_mul(&m), range, found);
            }
        }
    }

    /// The coefficients of the line, if it is one.
    pub fn line(&self) -> Option<&Vector3<f64>> {
        match self {
            Image::Line { line, .. } | Image::Flat { line, .. } => Some(line),
            _ => None,
        }
    }
}

/// Where k·b(t) = 0 over the range.
pub(crate) fn line_on_conic(
    basis: Basis,
    k: &Vector3<f64>,
    range: [f64; 2],
    found: &mut impl FnMut(f64),
) {
    let lo = range[0];
    match basis {
        Basis::Circular => {
            let size = k.x.hypot(k.y);
            if k.z.abs().is_beyond(size) {
                return;
            }
            let middle = k.y.atan2(k.x);
            let half = ((size - k.z) * (size + k.z)).sqrt().atan2(-k.z);
            for t in [middle - half, middle + half] {
                found(lo + (t - lo).rem_euclid(TAU));
            }
        }
        Basis::Graph(c) => {
            let mut keep = |m: f64| c.end_of_chord(m).into_iter().for_each(&mut *found);
            let square = c.curvature * (2.0 * k.x + c.flatness * k.z);
            quadratic([k.z, 2.0 * (k.y + c.shear * k.z), square], &mut keep);
        }
        Basis::Hyperbolic => {
            let mut keep = |e: f64| {
                if e.is_above_zero() {
                    found(e.ln());
                }
            };
            // With e = exp t: (k.x + k.y) e² + 2 k.z e + (k.x - k.y) = 0.
            quadratic([k.x - k.y, 2.0 * k.z, k.x + k.y], &mut keep);
        }
    }
}

/// The real roots of `k[0] + k[1] t + k[2] t²`.
fn quadratic(k: [f64; 3], found: &mut impl FnMut(f64)) {
    let half = 0.5 * k[1];
    let radicand = half * half - k[0] * k[2];
    if radicand.is_below_zero() {
        return;
    }
    let q = -(half + radicand.sqrt().copysign(half));
    if q.is_exactly(0.0) {
        if !k[2].is_exactly(0.0) {
            found(0.0);
        }
        return;
    }
    if (k[2].abs() * f64::MAX.sqrt()).is_beyond(q.abs()) {
        found(q / k[2]);
    }
    found(k[0] / q);
}

/// The image of a point of a curve as a function over any scalar: (x, y) at depth one.
pub(crate) fn flat_point<S: Analytic<Float = f64>>(projection: &Projection, p: [S; 3]) -> [S; 2] {
    let [x, y, z] = projection.homogeneous_over(p);
    [x.over(z), y.over(z)]
}

/// The distance of the images of two points, as a distance in space at the first.
pub(crate) fn image_distance(projection: &Projection, p: &Point3<f64>, q: &Point3<f64>) -> f64 {
    let (x, y) = (flat_of(projection, p), flat_of(projection, q));
    (x[0] - y[0]).hypot(x[1] - y[1]) * projection.scale(p)
}

/// The normalised image point of a point in space.
pub(crate) fn flat_of(projection: &Projection, p: &Point3<f64>) -> [f64; 2] {
    let h = projection.homogeneous(p);
    [h.x / h.z, h.y / h.z]
}
