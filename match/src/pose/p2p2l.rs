//! The pose from a chain of three lines: two points and a direction at each (P2P2L).
//!
//! Notation: A and B are the corners of the chain, u the direction of its middle line from A to B
//! in the camera's frame, d the direction of an outer line in the part, R the rotation of the part,
//! and n the unit normal of the plane through the eye and the image of an outer line.
//!
//! u lies in the plane of the lines of sight of A and B; let w be the normal of that plane and v =
//! w × u. The distance of A and B gives their depths. About u the part can be rotated by an angle
//! ψ. Each outer line satisfies n · R d = 0 with R d = c u + s (cos ψ v + sin ψ w). That gives two
//! equations A cos ψ + B sin ψ + C = 0. Eliminating ψ leaves one equation in the angle of u.

use crate::part::PartChain;
use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use std::f64::consts::PI;

/// A chain of three lines in an image, prepared to be solved for many chains of the part.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageChain {
    /// The lines of sight of A and B, of length one, in the camera's frame.
    rays: [Vector3<f64>; 2],
    /// The angle between them.
    between: f64,
    /// Unit vectors of the plane of the middle line, and its normal.
    plane: [Vector3<f64>; 3],
    /// The unit normals of the planes of the outer lines.
    normals: [Vector3<f64>; 2],
    /// By outer line: the components of its normal along the axes of the plane.
    along: [[f64; 3]; 2],
    /// The sampled directions of the middle line: their angles, cosines and sines.
    steps: Vec<[f64; 3]>,
}

/// The number of sampled directions of the middle line, between which roots are bracketed.
const STEPS: usize = 48;
/// The most steps of the secant method in an interval.
const ROUNDS: usize = 40;
/// The least angle, in radians, between the middle line and a line of sight. Smaller angles do not
/// determine the depth.
const STEEPEST: f64 = 1.0 / 32.0;
/// The accuracy of an angle, in radians.
const FINE: f64 = 1.0 / (1 << 20) as f64;
/// An outer line is perpendicular to the middle line below this cosine. The equations then have a
/// lower degree.
const SQUARE: f64 = 1.0 / 1024.0;

impl ImageChain {
    /// The chain with the lines of sight of A and B, and two further lines of sight of points on
    /// its outer lines, on the side to which these leave; all of length one. None where they do not
    /// span planes.
    pub fn new(rays: [Vector3<f64>; 2], beyond: [Vector3<f64>; 2]) -> Option<Self> {
        let across = rays[0].cross(&rays[1]);
        let between = across.norm().atan2(rays[0].dot(&rays[1]));
        let w = across.try_normalize(0.0)?;
        let plane = [rays[0], w.cross(&rays[0]), w];
        let normal = |i: usize| rays[i].cross(&beyond[i]).try_normalize(0.0);
        let normals = [normal(0)?, normal(1)?];
        // A and B lie in front of the camera between these angles.
        let [from, to] = [between + STEEPEST, PI - STEEPEST];
        let step = |k: usize| {
            let angle = from + (to - from) * k as f64 / STEPS as f64;
            [angle, angle.cos(), angle.sin()]
        };
        Some(Self {
            rays,
            between,
            along: normals.map(|n| plane.map(|axis| n.dot(&axis))),
            plane,
            normals,
            steps: (0..=STEPS).map(step).collect(),
        })
    }
}

/// The equations of a part's chain and an image's.
struct Equations<'a> {
    image: &'a ImageChain,
    /// By outer line: the components of its direction along A to B, and along two axes
    /// perpendicular to that.
    parts: [[f64; 3]; 2],
    /// Whether both are perpendicular: the equations have no C.
    square: bool,
    length: f64,
    /// The axes perpendicular to A to B, and that direction, as columns.
    frame: Matrix3<f64>,
}

impl<'a> Equations<'a> {
    fn new(part: &PartChain, image: &'a ImageChain) -> Option<Self> {
        let along = part.points[1] - part.points[0];
        let length = along.norm();
        let z = along / length;
        let across = part.away[0] - z * z.dot(&part.away[0]);
        let x = across.try_normalize(SQUARE * SQUARE)?;
        let y = z.cross(&x);
        let parts = part.away.map(|d| [z.dot(&d), x.dot(&d), y.dot(&d)]);
        let flat = |c: f64| c.abs() < SQUARE;
        Some(Self {
            image,
            parts,
            square: flat(parts[0][0]) && flat(parts[1][0]),
            length,
            frame: Matrix3::from_columns(&[x, y, z]),
        })
    }

    /// A, B, C of both equations for a cosine and a sine of the middle line's angle.
    fn coefficients(&self, cos: f64, sin: f64) -> [[f64; 3]; 2] {
        [self.of_line(0, cos, sin), self.of_line(1, cos, sin)]
    }

    fn of_line(&self, i: usize, cos: f64, sin: f64) -> [f64; 3] {
        let ([n1, n2, nw], [c, x, y]) = (self.image.along[i], self.parts[i]);
        // v = w × u.
        let (nu, nv) = (n1 * cos + n2 * sin, n2 * cos - n1 * sin);
        [x * nv + y * nw, x * nw - y * nv, c * nu]
    }

    /// The resultant, which is zero at the angles of solutions.
    fn value(&self, cos: f64, sin: f64) -> f64 {
        let [[a, b, c], [a1, b1, c1]] = self.coefficients(cos, sin);
        let det = a * b1 - a1 * b;
        if self.square {
            return det;
        }
        let (cos, sin) = (b * c1 - c * b1, c * a1 - a * c1);
        cos * cos + sin * sin - det * det
    }

    fn value_at(&self, angle: f64) -> f64 {
        self.value(angle.cos(), angle.sin())
    }

    /// Adds the poses at an angle of the middle line whose outer lines leave their points in the
    /// right direction.
    fn poses(&self, part: &PartChain, angle: f64, found: &mut Vec<Isometry3<f64>>) {
        let (cos, sin) = (angle.cos(), angle.sin());
        let [[a, b, c], [a1, b1, c1]] = self.coefficients(cos, sin);
        let mut add = |x: f64, y: f64| {
            let length = x.hypot(y);
            if length > 0.0 {
                found.extend(self.pose(part, [angle, cos, sin], [x / length, y / length]));
            }
        };
        if self.square {
            let (a, b) = if a.hypot(b) >= a1.hypot(b1) {
                (a, b)
            } else {
                (a1, b1)
            };
            add(b, -a);
            add(-b, a);
        } else {
            let det = a * b1 - a1 * b;
            add(
                (b * c1 - c * b1) * det.signum(),
                (c * a1 - a * c1) * det.signum(),
            );
        }
    }

    fn pose(
        &self,
        part: &PartChain,
        [angle, cos, sin]: [f64; 3],
        turn: [f64; 2],
    ) -> Option<Isometry3<f64>> {
        let [e1, e2, w] = self.image.plane;
        let u = e1 * cos + e2 * sin;
        let v = e2 * cos - e1 * sin;
        let x = v * turn[0] + w * turn[1];
        let y = u.cross(&x);
        let rotation = Matrix3::from_columns(&[x, y, u]) * self.frame.transpose();
        for i in 0..2 {
            let d = rotation * part.away[i];
            if self.image.rays[i].cross(&d).dot(&self.image.normals[i]) <= 0.0 {
                return None;
            }
        }
        // By the sines in the triangle of the eye, A and B.
        let near = (angle - self.image.between).sin() * self.length / self.image.between.sin();
        let at = self.image.rays[0] * near;
        let rotation = Rotation3::from_matrix_unchecked(rotation);
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        let shift = at - rotation * part.points[0].coords;
        (near > 0.0).then(|| Isometry3::from_parts(Translation3::from(shift), rotation))
    }
}

/// The poses of the part in the camera's frame at which its chain has the image of a given chain:
/// all solutions, up to eight.
pub fn poses(part: &PartChain, image: &ImageChain) -> Vec<Isometry3<f64>> {
    let mut found = Vec::new();
    let Some(equations) = Equations::new(part, image) else {
        return found;
    };
    let steps = &image.steps;
    let value = |[_, cos, sin]: &[f64; 3]| equations.value(*cos, *sin);
    let values: Vec<f64> = steps.iter().map(value).collect();
    for k in 0..STEPS {
        let (a, b) = (steps[k][0], steps[k + 1][0]);
        if values[k] * values[k + 1] <= 0.0 {
            let angle = root(&equations, [a, b], [values[k], values[k + 1]]);
            equations.poses(part, angle, &mut found);
        } else if k > 0 && touches(&values[k - 1..=k + 1]) {
            // Two nearby roots or a double one: the extremum of the parabola through three values.
            let [l, m, r] = [values[k - 1], values[k], values[k + 1]];
            let angle = a + (b - a) * 0.5 * (l - r) / (l - 2.0 * m + r);
            equations.poses(part, angle, &mut found);
        }
    }
    found
}

/// Whether the parabola through three values of one sign nearly reaches zero between them.
fn touches(values: &[f64]) -> bool {
    let [l, m, r] = [values[0], values[1], values[2]];
    let bend = l - 2.0 * m + r;
    if m * bend <= 0.0 || (l - r).abs() > 2.0 * bend.abs() {
        return false;
    }
    let least = m - (l - r) * (l - r) / (8.0 * bend);
    least * m <= 0.0 || least.abs() < 0.125 * l.abs().max(r.abs())
}

/// The root in an interval at whose ends values have different signs (regula falsi, Illinois).
fn root(equations: &Equations<'_>, [mut a, mut b]: [f64; 2], [mut fa, mut fb]: [f64; 2]) -> f64 {
    for _ in 0..ROUNDS {
        if fa == fb {
            break;
        }
        let c = (fa * b - fb * a) / (fa - fb);
        let fc = equations.value_at(c);
        if fc == 0.0 || (b - a).abs() < FINE {
            return c;
        }
        if fc * fb < 0.0 {
            (a, fa) = (b, fb);
        } else {
            fa *= 0.5;
        }
        (b, fb) = (c, fc);
    }
    b
}
