//! Checks that the outline is drawn: the boundary of the part's shadow must lie on visible strokes.
//!
//! The shadow is the region in which lines of sight hit material, which ray casting on the tree
//! determines. Lines are drawn across the image, and a small circle around every end of a visible
//! stroke. Where one of them enters or leaves the shadow, a visible stroke must pass that is not a
//! smooth edge.

use super::Finding;
use super::strokes::{Strokes, is_outline};
use nalgebra::{Point2, Vector2};
use premio_csg::ray_casting::{Ray, RayOracle};
use premio_drawing::Drawing;
use premio_kernel::number::predicates::ROUNDING;
use premio_visibility::camera::projection::{LineOfSight, Projection, ViewRay};
use std::f64::consts::{PI, TAU};
use std::fmt;

/// The number of lines drawn across the image, and of steps into which each is divided.
const LINES: usize = 48;
const STEPS: usize = 96;
/// The number of ends of strokes around which the outline is followed, and of steps.
const ENDS: usize = 64;
const AROUND: usize = 24;
/// The radius of these circles, relative to the drawing's size.
const RADIUS: f64 = 1.0 / 512.0;
/// The number of bisections of the position of a change.
const HALVINGS: u32 = 40;
/// Powers of the plastic number, the steps of Roberts's sequence in the unit square.
const SPREAD: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];
/// The error of a ray's intersections, in roundings of the part's size.
const ROUNDINGS: f64 = 64.0;
/// The number of positions that are reported individually.
const NAMED: usize = 5;

/// The result for the outline.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ShadowOutline {
    /// The number of points of the shadow's boundary on a visible stroke.
    pub drawn: usize,
    /// The number of points where the material is too thin to locate the boundary.
    pub unclear: usize,
    /// The points in the image without a visible stroke.
    pub missing: Vec<[f64; 2]>,
}

/// The shadow of a part, determined by lines of sight.
struct Shadow<'a> {
    material: &'a RayOracle,
    projection: &'a Projection,
    sliver: f64,
    /// Rays find slivers up to this length where two surfaces coincide and nothing is.
    rounding: f64,
}

/// A crossing of a path in the image with the boundary of the shadow: between the last point with
/// material thicker than a sliver and the first point without material.
struct Crossing {
    thick: Point2<f64>,
    /// None if thin material continues beyond the next step.
    none: Option<Point2<f64>>,
    /// The next step.
    outside: Point2<f64>,
}

/// The allowed distance of a stroke from the outline found by rays.
#[derive(Clone, Copy, Debug)]
pub struct Tolerance {
    /// In the image.
    pub image: f64,
    /// Slivers of material up to this length are ignored.
    pub sliver: f64,
}

impl Shadow<'_> {
    /// The material thicker than `least` on the line of sight of a drawing's point.
    fn hits(&self, p: &Point2<f64>, least: f64) -> impl Iterator<Item = [f64; 2]> {
        let LineOfSight { origin, direction } = self.projection.line_of_sight_y_up(p);
        let ray = Ray { origin, direction };
        let near = match self.projection.sight {
            ViewRay::Eye(_) => self.projection.near / direction.dot(&self.projection.axis()),
            ViewRay::Direction(_) => f64::NEG_INFINITY,
        };
        let hit = self.material.intervals(&ray, least);
        hit.into_iter().filter(move |[_, hi]| *hi > near)
    }

    /// Whether the line of sight of a drawing's point hits material thicker than `least`.
    fn covers(&self, p: &Point2<f64>, least: f64) -> bool {
        self.hits(p, least).next().is_some()
    }

    /// Whether a line of sight at a distance beyond `none`, towards the next step, hits any material: a
    /// sheet thinner than rounding, in front of the thick material or behind it.
    fn continues(&self, none: &Point2<f64>, outside: &Point2<f64>, distance: f64) -> bool {
        let step = outside - none;
        let part = (distance / step.norm()).min(1.0);
        self.hits(&(none + step * part), 0.0).next().is_some()
    }

    /// How far material thinner than rounding continues beyond `none`, if it thins in proportion to the
    /// distance from there.
    fn rest(&self, thin: &Point2<f64>, none: &Point2<f64>) -> f64 {
        let thickness = self.hits(thin, self.rounding).map(|[lo, hi]| hi - lo);
        let thickness = thickness.fold(0.0, f64::max);
        let distance = (none - thin).norm();
        match thickness > self.rounding {
            true => distance * self.rounding / (thickness - self.rounding),
            false => distance,
        }
    }
}

impl ShadowOutline {
    /// Undetermined if most points are unclear.
    pub fn finding(&self) -> Finding {
        match (self.missing.is_empty(), self.unclear > self.drawn) {
            (false, _) => Finding::Fails,
            (true, true) => Finding::Undetermined,
            (true, false) => Finding::Passes,
        }
    }

    /// Follows the boundary of the shadow of a drawing's part.
    pub fn new(
        material: &RayOracle,
        projection: &Projection,
        drawing: &Drawing,
        tolerance: Tolerance,
    ) -> Self {
        let shadow = Shadow {
            material,
            projection,
            sliver: tolerance.sliver,
            rounding: ROUNDINGS * ROUNDING * material.bounds().diagonal(),
        };
        let strokes = Strokes::new(&drawing.strokes);
        let mut outline = Self::default();
        let mut follow = |course: &dyn Fn(f64) -> Point2<f64>, steps: usize| {
            for crossing in shadow.crossings(course, steps) {
                let Crossing { thick, none, .. } = crossing;
                let Some(none) = none else {
                    outline.unclear += 1;
                    continue;
                };
                let place = nalgebra::center(&thick, &none);
                // Rays lose material that is thinner than rounding before it ends.
                let rest = 2.0 * shadow.rest(&place, &none);
                if shadow.continues(&none, &crossing.outside, tolerance.image + rest) {
                    outline.unclear += 1;
                    continue;
                }
                let near = tolerance.image + (none - place).norm() + rest;
                let mut passing = strokes.passing(&place, near);
                match passing.any(|(_, stroke)| is_outline(stroke)) {
                    true => outline.drawn += 1,
                    false => outline.missing.push(place.into()),
                }
            }
        };
        let [lo, hi] = drawing.extent;
        let (centre, size) = (nalgebra::center(&lo, &hi), (hi - lo).norm());
        for line in 0..LINES {
            let part = |i: usize| ((line as f64 + 0.5) * SPREAD[i]).fract();
            let (sin, cos) = (PI * part(0)).sin_cos();
            let off = 2.0 * part(1) - 1.0;
            let half = (1.0 - off * off).sqrt();
            let radius = 0.5 * size;
            let course = |t: f64| {
                let along = half * (2.0 * t - 1.0);
                centre + Vector2::new(off * cos - along * sin, off * sin + along * cos) * radius
            };
            follow(&course, STEPS);
        }
        let visible = drawing.strokes.iter().filter(|s| is_outline(s));
        let ends = visible.flat_map(|s| [0.0, 1.0].map(|part| s.shape.point(part)));
        let ends: Vec<Point2<f64>> = ends.collect();
        for end in ends.iter().step_by(ends.len().div_ceil(ENDS).max(1)) {
            let course = |t: f64| {
                let (sin, cos) = (TAU * t + 1.0).sin_cos();
                end + Vector2::new(cos, sin) * (RADIUS * size)
            };
            follow(&course, AROUND);
        }
        outline
    }
}

impl Shadow<'_> {
    /// The crossings of a path over [0, 1] with the boundary of the shadow.
    fn crossings(&self, course: &dyn Fn(f64) -> Point2<f64>, steps: usize) -> Vec<Crossing> {
        let t = |k: usize| k as f64 / steps as f64;
        let is_thick = |t: f64| self.covers(&course(t), self.sliver);
        let covered: Vec<bool> = (0..=steps).map(|k| is_thick(t(k))).collect();
        let mut found = Vec::new();
        for k in 0..steps {
            let [inside, outside] = match (covered[k], covered[k + 1]) {
                (true, false) => [t(k), t(k + 1)],
                (false, true) => [t(k + 1), t(k)],
                _ => continue,
            };
            let thick = last(inside, outside, is_thick);
            let is_any = |t: f64| self.covers(&course(t), self.rounding);
            let none = (!is_any(outside)).then(|| course(last(thick, outside, is_any)));
            let thick = course(thick);
            let outside = course(outside);
            found.push(Crossing {
                thick,
                none,
                outside,
            });
        }
        found
    }
}

/// The last parameter at which a condition is true, between one at which it is true and one at
/// which it is false.
fn last(mut from: f64, mut to: f64, holds: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..HALVINGS {
        let middle = 0.5 * (from + to);
        match holds(middle) {
            true => from = middle,
            false => to = middle,
        }
    }
    from
}

impl fmt::Display for ShadowOutline {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            drawn,
            unclear,
            missing,
        } = self;
        write!(f, "{drawn} places of the shadow's boundary are drawn")?;
        if *unclear > 0 {
            write!(f, ", {unclear} are unclear")?;
        }
        if !missing.is_empty() {
            write!(f, ", {} are not", missing.len())?;
        }
        for [x, y] in missing.iter().take(NAMED) {
            write!(f, "; no visible line at ({x:.6}, {y:.6}) of the image")?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::checks::fixture::{FrontView, front_view, tree};
    use nalgebra::{Point3, Vector3};
    use premio_drawing::Layer;
    use premio_visibility::ViewCamera;

    /// A dome on its cylinder from the front, with the strokes that are kept.
    fn outline(keeps: impl Fn(Layer, usize) -> bool) -> ShadowOutline {
        let FrontView {
            tree,
            camera,
            mut drawing,
            bounds,
            ..
        } = front_view("P = CYL(R=10,H=10) UN SPH(R=10) AT (MOVZ=10)");
        let mut index = 0..;
        drawing
            .strokes
            .retain(|s| keeps(s.layer, index.next().unwrap_or(0)));
        let projection = Projection::new(&camera, bounds.diagonal());
        let tolerance = Tolerance {
            image: 2.0 * drawing.distance,
            sliver: 0.0,
        };
        ShadowOutline::new(&RayOracle::new(&tree), &projection, &drawing, tolerance)
    }

    /// A countersunk hole seen at an angle: where its cone leaves the plate both surfaces coincide, and
    /// rays through the hole find slivers of rounding.
    #[test]
    fn slivers_of_rounding_are_no_material() {
        let text = "P = (BLO(X=48.472, Y=36.734, Z=6.996)
            DIF CYL(R=3.894, H=8.996) AT (MOVX=38.103, MOVY=27.5505, MOVZ=-1)
            DIF CON(R=3.894, H=2.276, R2=6.17) AT (MOVX=38.103, MOVY=27.5505, MOVZ=4.72)
          ) AT (ROTY=45, ROTX=123.9, MOVX=-45.971, MOVY=-59.247, MOVZ=-31.455)";
        let FrontView {
            tree,
            camera,
            drawing,
            bounds,
            ..
        } = front_view(text);
        let projection = Projection::new(&camera, bounds.diagonal());
        let shadow = Shadow {
            material: &RayOracle::new(&tree),
            projection: &projection,
            sliver: 1e-8,
            rounding: ROUNDINGS * ROUNDING * bounds.diagonal(),
        };
        let [lo, hi] = drawing.extent;
        let mut crossings = 0;
        for k in 0..200 {
            let part = (k as f64 * SPREAD[0]).fract();
            let y = lo.y + (hi.y - lo.y) * part;
            let course = |t: f64| Point2::new(lo.x - 1.0 + (hi.x - lo.x + 2.0) * t, y);
            for Crossing { thick, none, .. } in shadow.crossings(&course, 64) {
                let none = none.unwrap();
                assert!((none - thick).norm() < 1e-6, "{thick:?} {none:?}");
                crossings += 1;
            }
        }
        assert!(crossings >= 400, "{crossings}");
    }

    /// Material between two planes at an angle of 6.5e-11, which meet at x = 0: rays see none of it next
    /// to the outline.
    #[test]
    fn a_thin_wedge_ends_at_its_edge() {
        let text = "P = (BLO(X=3, Y=9, Z=1) AT (MOVZ=-1) DIF BLO(X=20, Y=20, Z=5)
            AT (MOVX=-10, MOVY=-5, MOVZ=-5, ROTY=0.0000000037252902984619140625))";
        let (above, origin) = (Point3::new(0.0, 0.0, 9.0), Point3::origin());
        let camera = ViewCamera::orthographic(above, origin, Vector3::y()).unwrap();
        let size = 12.0;
        let shadow = Shadow {
            material: &RayOracle::new(&tree(text)),
            projection: &Projection::new(&camera, size),
            sliver: 3e-12,
            rounding: ROUNDINGS * ROUNDING * size,
        };
        let course = |t: f64| Point2::new(4.0 * t - 1.5, 4.5);
        let all = shadow.crossings(&course, 17);
        assert_eq!(all.len(), 1);
        let edge = &all[0];
        let none = edge.none.unwrap();
        let place = nalgebra::center(&edge.thick, &none);
        let rest = shadow.rest(&place, &none);
        assert!(none.x > 0.5 * rest && none.x < 2.0 * rest, "{none} {rest}");
    }

    /// A block behind a sheet that is thinner than rounding.
    #[test]
    fn a_thin_sheet_continues_beyond_a_block() {
        let text = "P = (BLO(X=1, Y=1, Z=1) AT (MOVZ=-1) UN (BLO(X=3, Y=3, Z=1)
            DIF BLO(X=5, Y=5, Z=1) AT (MOVX=-1, MOVY=-1, MOVZ=0.0000000000005)))";
        let (above, origin) = (Point3::new(0.0, 0.0, 9.0), Point3::origin());
        let camera = ViewCamera::orthographic(above, origin, Vector3::y()).unwrap();
        let shadow = Shadow {
            material: &RayOracle::new(&tree(text)),
            projection: &Projection::new(&camera, 4.0),
            sliver: 1e-10,
            rounding: 1e-12,
        };
        let course = |y: f64| move |t: f64| Point2::new(2.0 * t + 0.5, y);
        for (y, count) in [(0.5, 1), (2.0, 0), (-0.5, 0)] {
            let all = shadow.crossings(&course(y), 17);
            assert_eq!(all.len(), count, "{y}");
            for crossing in all {
                let none = crossing.none.unwrap();
                assert!(shadow.continues(&none, &crossing.outside, 1e-3));
                let (inner, outer) = (Point2::new(2.9, y), Point2::new(3.1, y));
                assert!(shadow.continues(&inner, &outer, 0.05));
                assert!(!shadow.continues(&inner, &outer, 0.15));
            }
        }
    }

    #[test]
    fn every_stroke_of_an_outline_is_missed() {
        let whole = outline(|_, _| true);
        assert!(whole.missing.is_empty() && whole.drawn > 60, "{whole}");
        // The dome's arc, two sides, and the line of the base.
        for left_out in 0..4 {
            let found = outline(|_, index| index != left_out);
            assert!(!found.missing.is_empty(), "{left_out}: {found}");
        }
    }
}
