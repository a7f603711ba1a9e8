//! The primitives in their own frames: point membership and intersection with a line.

use crate::primitive::Primitive;
use nalgebra::Vector3;
use premio_kernel::number::rational::{Rational, to_f64};

/// A primitive in its own frame, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) enum Shape {
    Block([f64; 3]),
    Wedge([f64; 3]),
    /// rho <= base + slope z between z = 0 and the height.
    Frustum {
        base: f64,
        slope: f64,
        height: f64,
        widest: f64,
    },
    Sphere(f64),
    Torus {
        major: f64,
        minor: f64,
    },
}

/// Clips `range` to the part where `a + b t <= 0`; returns false if it is empty.
pub(super) fn clip(range: &mut [f64; 2], a: f64, b: f64) -> bool {
    if b > 0.0 {
        range[1] = range[1].min(-a / b);
    } else if b < 0.0 {
        range[0] = range[0].max(-a / b);
    } else if a > 0.0 {
        return false;
    }
    range[0] <= range[1]
}

impl Shape {
    pub fn new(primitive: &Primitive) -> Self {
        let edges = |size: &[Rational; 3]| [0, 1, 2].map(|i| to_f64(&size[i]));
        match primitive {
            Primitive::Block { size } => Self::Block(edges(size)),
            Primitive::Wedge { size } => Self::Wedge(edges(size)),
            Primitive::Cylinder { radius, height } => Self::frustum(radius, radius, height),
            Primitive::Frustum { base, top, height } => Self::frustum(base, top, height),
            Primitive::Sphere { radius } => Self::Sphere(to_f64(radius)),
            Primitive::Torus { major, minor } => Self::Torus {
                major: to_f64(major),
                minor: to_f64(minor),
            },
        }
    }

    fn frustum(base: &Rational, top: &Rational, height: &Rational) -> Self {
        Self::Frustum {
            base: to_f64(base),
            slope: to_f64(&((top - base) / height)),
            height: to_f64(height),
            widest: to_f64(base).max(to_f64(top)),
        }
    }

    /// The least and the greatest corner of the bounding box.
    pub fn bounds(&self) -> [[f64; 3]; 2] {
        match *self {
            Self::Block(size) | Self::Wedge(size) => [[0.0; 3], size],
            Self::Frustum { height, widest, .. } => {
                [[-widest, -widest, 0.0], [widest, widest, height]]
            }
            Self::Sphere(r) => [[-r; 3], [r; 3]],
            Self::Torus { major, minor } => {
                let r = major + minor;
                [[-r, -r, -minor], [r, r, minor]]
            }
        }
    }

    /// A function that is negative inside, for points of the bounding box.
    pub fn level(&self, p: &Vector3<f64>) -> f64 {
        match *self {
            Self::Block(_) => -1.0,
            Self::Wedge([x, _, z]) => p.x / x + p.z / z - 1.0,
            Self::Frustum { base, slope, .. } => p.x.hypot(p.y) - (base + slope * p.z),
            Self::Sphere(r) => p.norm() - r,
            Self::Torus { major, minor } => (p.x.hypot(p.y) - major).hypot(p.z) - minor,
        }
    }

    pub fn contains(&self, p: &Vector3<f64>) -> bool {
        let [lo, hi] = self.bounds();
        (0..3).all(|i| lo[i] <= p[i] && p[i] <= hi[i]) && self.level(p) <= 0.0
    }

    /// Adds the intervals of t in which `o + t d` is inside, in order.
    pub fn spans(&self, o: &Vector3<f64>, d: &Vector3<f64>, spans: &mut Vec<[f64; 2]>) {
        let [lo, hi] = self.bounds();
        let mut range = [f64::NEG_INFINITY, f64::INFINITY];
        let boxed = (0..3)
            .all(|i| clip(&mut range, lo[i] - o[i], -d[i]) && clip(&mut range, o[i] - hi[i], d[i]));
        // A line of direction zero is either inside for all t or never: no interval.
        if !boxed || !(range[1] - range[0]).is_finite() {
            return;
        }
        // Relative to the middle of the box, numbers have the size of the primitive.
        let middle = 0.5 * (range[0] + range[1]);
        let half = 0.5 * (range[1] - range[0]);
        let c = o + d * middle;
        let mut cuts = vec![-half];
        self.crossings(&c, d, half, &mut cuts);
        cuts.push(half);
        let mut open: Option<f64> = None;
        for pair in cuts.windows(2) {
            let inside = self.level(&(c + d * (0.5 * (pair[0] + pair[1])))) <= 0.0;
            match (inside, open) {
                (true, None) => open = Some(pair[0]),
                (false, Some(start)) => {
                    spans.push([middle + start, middle + pair[0]]);
                    open = None;
                }
                _ => {}
            }
        }
        if let Some(start) = open {
            spans.push([middle + start, middle + half]);
        }
    }

    /// Adds the parameters in (-half, half) at which the line crosses the curved or slanted
    /// surface.
    fn crossings(&self, o: &Vector3<f64>, d: &Vector3<f64>, half: f64, cuts: &mut Vec<f64>) {
        let mut add = |t: f64| {
            if t > -half && t < half {
                cuts.push(t);
            }
        };
        match *self {
            Self::Block(_) => {}
            Self::Wedge([x, _, z]) => add((1.0 - o.x / x - o.z / z) / (d.x / x + d.z / z)),
            Self::Frustum { base, slope, .. } => {
                let (r, k) = (base + slope * o.z, slope * d.z);
                let a = d.x * d.x + d.y * d.y - k * k;
                let b = o.x * d.x + o.y * d.y - r * k;
                let c = o.x * o.x + o.y * o.y - r * r;
                quadratic(a, b, c).into_iter().for_each(add);
            }
            Self::Sphere(r) => {
                let c = o.norm_squared() - r * r;
                quadratic(d.norm_squared(), o.dot(d), c)
                    .into_iter()
                    .for_each(add);
            }
            Self::Torus { major, minor } => {
                let p = torus_quartic(o, d, major, minor);
                let level = |t: f64| self.level(&(o + d * t));
                quartic_crossings(&p, &level, half)
                    .into_iter()
                    .for_each(add);
            }
        }
    }
}

/// The real roots of a t² + 2 b t + c in increasing order; NaN if there are none.
fn quadratic(a: f64, b: f64, c: f64) -> [f64; 2] {
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return [f64::NAN; 2];
    }
    let q = -(b + discriminant.sqrt().copysign(b));
    let [s, t] = [q / a, c / q];
    if s <= t { [s, t] } else { [t, s] }
}

/// (|p|² + R² - r²)² - 4 R² rho² along the line, from the constant term up.
fn torus_quartic(o: &Vector3<f64>, d: &Vector3<f64>, major: f64, minor: f64) -> [f64; 5] {
    let [a, b, c] = [d.norm_squared(), 2.0 * o.dot(d), o.norm_squared()];
    let c = c + (major - minor) * (major + minor);
    let four = 4.0 * major * major;
    let across = [
        o.x * o.x + o.y * o.y,
        2.0 * (o.x * d.x + o.y * d.y),
        d.x * d.x + d.y * d.y,
    ];
    [
        c * c - four * across[0],
        2.0 * b * c - four * across[1],
        b * b + 2.0 * a * c - four * across[2],
        2.0 * a * b,
        a * a,
    ]
}

/// The simple roots in (-half, half) of a function with the sign of the quartic `p`. The roots of
/// each derivative separate those of the previous one, starting with the linear one.
fn quartic_crossings(p: &[f64; 5], sign: &dyn Fn(f64) -> f64, half: f64) -> Vec<f64> {
    let mut roots: Vec<f64> = Vec::new();
    for degree in 1..=4 {
        let derivative = differentiated(p, 4 - degree);
        let value = |t: f64| derivative.iter().rev().fold(0.0, |sum, &k| sum * t + k);
        let function: &dyn Fn(f64) -> f64 = if degree == 4 { sign } else { &value };
        let mut next = Vec::new();
        let mut lower = -half;
        for upper in roots.into_iter().chain([half]) {
            next.extend(bisect(function, lower, upper));
            lower = upper;
        }
        roots = next;
    }
    roots
}

fn differentiated(p: &[f64; 5], times: usize) -> Vec<f64> {
    let mut p = p.to_vec();
    for _ in 0..times {
        p = (1..p.len()).map(|i| p[i] * i as f64).collect();
    }
    p
}

/// The point between two others at which `f` changes sign, to the last digit.
fn bisect(f: &dyn Fn(f64) -> f64, mut lo: f64, mut hi: f64) -> Option<f64> {
    let rising = f(hi) > 0.0;
    if rising == (f(lo) > 0.0) {
        return None;
    }
    loop {
        let middle = 0.5 * (lo + hi);
        if middle <= lo || middle >= hi {
            return Some(middle);
        }
        if (f(middle) > 0.0) == rising {
            hi = middle;
        } else {
            lo = middle;
        }
    }
}
