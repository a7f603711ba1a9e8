//! The primitives in their own frames: point membership and intersection with a line.

use super::ellipsoid::EllipsoidShape;
use super::facets::FacetShape;
use super::oblique::ObliqueShape;
use super::polynomial::{quadratic, torus_crossings};
use super::section::SectionShape;
use crate::primitive::Primitive;
use nalgebra::Vector3;
use premio_kernel::number::rational::{Rational, to_f64};

/// A primitive in its own frame, in f64.
#[derive(Clone, Debug)]
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
    /// A prism or a revolution.
    Section(SectionShape),
    /// A polyhedron.
    Facets(FacetShape),
    /// An ellipsoid.
    Ellipsoid(EllipsoidShape),
    /// An oblique frustum.
    Oblique(ObliqueShape),
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
            Primitive::Prism {
                figure,
                height,
                top,
            } => Self::Section(SectionShape::prism(figure, height, top)),
            Primitive::Revolution { figure, angle } => {
                Self::Section(SectionShape::revolution(figure, angle.as_ref()))
            }
            Primitive::Polyhedron { polyhedron } => Self::Facets(FacetShape::new(polyhedron)),
            Primitive::ObliqueFrustum { frustum } => Self::Oblique(ObliqueShape::new(frustum)),
            Primitive::Ellipsoid { radii } => Self::Ellipsoid(EllipsoidShape::new(radii)),
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
        match self {
            &Self::Block(size) | &Self::Wedge(size) => [[0.0; 3], size],
            &Self::Frustum { height, widest, .. } => {
                [[-widest, -widest, 0.0], [widest, widest, height]]
            }
            &Self::Sphere(r) => [[-r; 3], [r; 3]],
            Self::Section(section) => section.bounds(),
            Self::Facets(facets) => facets.bounds(),
            Self::Oblique(frustum) => frustum.bounds,
            Self::Ellipsoid(ellipsoid) => [ellipsoid.reach.map(|r| -r), ellipsoid.reach],
            &Self::Torus { major, minor } => {
                let r = major + minor;
                [[-r, -r, -minor], [r, r, minor]]
            }
        }
    }

    /// A function that is negative inside, for points of the bounding box.
    pub fn level(&self, p: &Vector3<f64>) -> f64 {
        match self {
            Self::Block(_) => -1.0,
            &Self::Wedge([x, _, z]) => p.x / x + p.z / z - 1.0,
            &Self::Frustum { base, slope, .. } => p.x.hypot(p.y) - (base + slope * p.z),
            &Self::Sphere(r) => p.norm() - r,
            Self::Section(section) => match section.contains(p) {
                true => -1.0,
                false => 1.0,
            },
            Self::Facets(facets) => match facets.contains(p) {
                true => -1.0,
                false => 1.0,
            },
            &Self::Torus { major, minor } => (p.x.hypot(p.y) - major).hypot(p.z) - minor,
            Self::Oblique(frustum) => frustum.level(p),
            Self::Ellipsoid(ellipsoid) => ellipsoid.level(p),
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
        if let Self::Facets(facets) = self
            && let Some(clear) = facets.clear_spans(&c, d, half)
        {
            spans.extend(clear.iter().map(|span| span.map(|t| middle + t)));
            return;
        }
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
        match self {
            Self::Block(_) => {}
            &Self::Wedge([x, _, z]) => add((1.0 - o.x / x - o.z / z) / (d.x / x + d.z / z)),
            &Self::Frustum { base, slope, .. } => {
                let (r, k) = (base + slope * o.z, slope * d.z);
                let a = d.x * d.x + d.y * d.y - k * k;
                let b = o.x * d.x + o.y * d.y - r * k;
                let c = o.x * o.x + o.y * o.y - r * r;
                quadratic(a, b, c).into_iter().for_each(add);
            }
            &Self::Sphere(r) => {
                let c = o.norm_squared() - r * r;
                quadratic(d.norm_squared(), o.dot(d), c)
                    .into_iter()
                    .for_each(add);
            }
            Self::Section(section) => {
                section.crossings(o, d, half, &mut add);
                cuts.sort_by(f64::total_cmp);
            }
            Self::Facets(facets) => {
                facets.crossings(o, d, &mut add);
                cuts.sort_by(f64::total_cmp);
            }
            Self::Ellipsoid(ellipsoid) => ellipsoid.crossings(o, d).into_iter().for_each(add),
            Self::Oblique(frustum) => {
                frustum.crossings(o, d).into_iter().for_each(add);
                cuts.sort_by(f64::total_cmp);
            }
            &Self::Torus { major, minor } => {
                torus_crossings(o, d, [major, minor], half).for_each(add);
            }
        }
    }
}
