//! Roots in closed form: of a line with a plane, a cylinder or a sphere, and of a circle or an
//! ellipse with a plane, a sphere, or a parallel cylinder.
//!
//! The level of the surface along the curve is a polynomial of degree two at most, or a constant
//! plus one wave. Its roots are given only where they are unambiguous: every extremum, and the level
//! at both ends, is farther from zero than any close call. All else is left to root isolation.

use super::CurveSurfaceRoots;
use crate::geometry::curve::{Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::roots::{Root, RootKind};
use nalgebra::Vector3;

/// The level of a surface along a curve.
enum Level<N> {
    /// c + 2 b t + a t², a ≥ 0.
    Polynomial { a: N, b: N, c: N },
    /// c + p cos t + q sin t.
    Wave { c: N, p: N, q: N },
}

/// The level, and the size of the numbers that cancel in it.
struct LevelOnCurve<N> {
    level: Level<N>,
    size: N,
}

/// The roots in a range; `None` where one of them, or a near miss, may be a close call. `reach` is
/// the largest level that is one.
pub(super) fn clear_roots<N: Float>(
    curve: &Curve<N>,
    [lo, hi]: [N; 2],
    surface: &Surface<N>,
    reach: N,
) -> Option<CurveSurfaceRoots<N>> {
    let LevelOnCurve { level, size } = level_on(curve, surface)?;
    let noise = N::from_f64(ROUNDINGS) * N::ROUNDING * size;
    if reach <= noise || noise.is_nan() {
        return None;
    }
    let is_clear = |value: N| value.abs() > reach;
    let ends = [lo, hi].map(|t| level.at(t));
    if !ends.into_iter().all(is_clear) {
        return None;
    }
    let found = level.roots(lo, is_clear)?.into_iter().flatten();
    let mut inside: Vec<N> = found.filter(|&t| t > lo && t < hi).collect();
    inside.sort_by(N::total_cmp);
    // The number of roots has to agree with the signs at the ends.
    let changes = (ends[0] > N::ZERO) != (ends[1] > N::ZERO);
    if changes != (inside.len() % 2 == 1) {
        return None;
    }
    let root = |t: N| Root {
        t,
        lo: t,
        hi: t,
        contact: RootKind::Simple,
        margin: None,
    };
    Some(CurveSurfaceRoots {
        roots: inside.into_iter().map(root).collect(),
        misses: Vec::new(),
    })
}

/// The number of roundings in a level.
const ROUNDINGS: f64 = 64.0;

impl<N: Float> Level<N> {
    fn at(&self, t: N) -> N {
        match *self {
            Self::Polynomial { a, b, c } => (a * t + N::TWO * b) * t + c,
            Self::Wave { c, p, q } => {
                let (sin, cos) = t.sin_cos();
                c + p * cos + q * sin
            }
        }
    }

    /// The roots, for a wave those of one turn from `lo`; `None` where an extremum is not clear.
    fn roots(&self, lo: N, is_clear: impl Fn(N) -> bool) -> Option<[Option<N>; 2]> {
        match *self {
            Self::Polynomial { a, b, c } if a == N::ZERO => {
                Some([(b != N::ZERO).then(|| -c / (N::TWO * b)), None])
            }
            Self::Polynomial { a, b, c } => {
                let least = c - b * b / a;
                if !is_clear(least) {
                    return None;
                }
                if least > N::ZERO {
                    return Some([None, None]);
                }
                let k = -(b + (b * b - a * c).sqrt().copysign(b));
                Some([Some(k / a), Some(c / k)])
            }
            Self::Wave { c, p, q } => {
                let size = p.hypot(q);
                if !(is_clear(c - size) && is_clear(c + size)) {
                    return None;
                }
                if c.abs() > size {
                    return Some([None, None]);
                }
                let top = q.atan2(p);
                let half = ((size - c) * (size + c)).sqrt().atan2(-c);
                let in_turn = |t: N| Some(lo + (t - lo).rem_euclid(N::TAU));
                Some([in_turn(top - half), in_turn(top + half)])
            }
        }
    }
}

/// The level of a surface along a curve; `None` for other curves and surfaces.
fn level_on<N: Float>(curve: &Curve<N>, surface: &Surface<N>) -> Option<LevelOnCurve<N>> {
    match curve {
        Curve::Line(line) => on_line(line, surface),
        Curve::Circle(c) => {
            let axes = [c.frame.x * c.radius, c.frame.y * c.radius];
            on_ellipse(&c.frame, axes, Some(c.radius), surface)
        }
        Curve::Ellipse(e) => {
            let axes = [e.frame.x * e.a, e.frame.y * e.b];
            on_ellipse(&e.frame, axes, None, surface)
        }
        Curve::Hyperbola(_) | Curve::Conic(_) | Curve::Quartic(_) | Curve::Toric(_) => None,
    }
}

fn on_line<N: Float>(line: &Line<N>, surface: &Surface<N>) -> Option<LevelOnCurve<N>> {
    let frame = surface.frame();
    let (o, d) = (
        frame.coordinates(&line.origin),
        frame.components(&line.direction),
    );
    let (o, d, radius) = match surface {
        Surface::Plane(_) => {
            let level = Level::Polynomial {
                a: N::ZERO,
                b: N::HALF * d.z,
                c: o.z,
            };
            let size = o.length();
            return Some(LevelOnCurve { level, size });
        }
        Surface::Cylinder(s) => {
            let flat = |v: Vector3<N>| Vector3::new(v.x, v.y, N::ZERO);
            (flat(o), flat(d), s.radius)
        }
        Surface::Sphere(s) => (o, d, s.radius),
        Surface::Cone(_)
        | Surface::Torus(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_)
        | Surface::Ellipsoid(_) => return None,
    };
    let a = d.dot(&d);
    // A line nearly along the axis has its nearest point too far away.
    if a < N::from_f64(STEEP) {
        return None;
    }
    let (b, away) = (o.dot(&d), o.dot(&o));
    let scale = N::HALF / radius;
    Some(LevelOnCurve {
        level: Level::Polynomial {
            a: a * scale,
            b: b * scale,
            c: (away - radius * radius) * scale,
        },
        size: (away + radius * radius) * scale,
    })
}

/// The least square of the sine of the angle between a line and an axis.
const STEEP: f64 = 1.0 / 256.0;

/// The level along the points centre + x cos t + y sin t; they are a circle if there is a radius.
fn on_ellipse<N: Float>(
    frame: &Frame<N>,
    [x, y]: [Vector3<N>; 2],
    radius: Option<N>,
    surface: &Surface<N>,
) -> Option<LevelOnCurve<N>> {
    let about = surface.frame();
    let o = frame.origin - about.origin;
    if let Surface::Plane(_) = surface {
        return Some(LevelOnCurve {
            level: Level::Wave {
                c: o.dot(&about.z),
                p: x.dot(&about.z),
                q: y.dot(&about.z),
            },
            size: o.length() + x.length(),
        });
    }
    let own = radius?;
    let (o, other) = match surface {
        Surface::Sphere(s) => (o, s.radius),
        Surface::Cylinder(s) if is_parallel(&frame.z, &about.z) => {
            (o - about.z * o.dot(&about.z), s.radius)
        }
        _ => return None,
    };
    let scale = N::HALF / other;
    let away = o.dot(&o);
    Some(LevelOnCurve {
        level: Level::Wave {
            c: (away + (own - other) * (own + other)) * scale,
            p: o.dot(&x) * N::TWO * scale,
            q: o.dot(&y) * N::TWO * scale,
        },
        size: (away + own * own + other * other) * scale,
    })
}

/// Whether two unit vectors are parallel up to their rounding.
fn is_parallel<N: Float>(a: &Vector3<N>, b: &Vector3<N>) -> bool {
    a.cross(b).length() <= N::from_f64(4.0) * N::ROUNDING
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::{Circle, Ellipse};
    use crate::geometry::curve_surface::Height;
    use crate::geometry::surface::{Cylinder, Plane, Sphere};
    use crate::number::roots::{Roots, isolate_closely};
    use nalgebra::Point3;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn frame(tilt: f64, [x, y, z]: [f64; 3]) -> Frame {
        let axis = Vector3::new(tilt.cos(), 0.7 * tilt.sin(), 0.4).normalize();
        Frame::toward(Point3::new(x, y, z), axis, Vector3::new(0.1, 1.0, 0.3))
    }

    proptest! {
        #[test]
        fn clear_roots_are_those_of_root_isolation(
            tilts in prop::array::uniform2(0.0..TAU),
            first in prop::array::uniform3(-1.0..1.0),
            second in prop::array::uniform3(-1.0..1.0),
            lo in -4.0..0.0,
            length in prop_oneof![0.1..6.0, Just(TAU)],
            [a, b] in prop::array::uniform2(0.2..2.0_f64),
            radius in 0.2..2.0,
        ) {
            let [f, g] = [frame(tilts[0], first), frame(tilts[1], second)];
            let [a, b] = [a.max(b), a.min(b)];
            let beside = Frame { origin: g.origin, ..f };
            let line = Curve::Line(Line { origin: f.origin, direction: f.z });
            let circle = Curve::Circle(Circle { frame: f, radius: a });
            let ellipse = Curve::Ellipse(Ellipse { frame: f, a, b });
            let plane = Surface::Plane(Plane { frame: g });
            let sphere = Surface::Sphere(Sphere { frame: g, radius });
            let cylinder = Surface::Cylinder(Cylinder { frame: g, radius });
            let parallel = Surface::Cylinder(Cylinder { frame: beside, radius });
            let cases = [
                (&line, plane), (&line, sphere), (&line, cylinder), (&circle, plane),
                (&circle, sphere), (&circle, parallel), (&ellipse, plane),
            ];
            for (i, (curve, surface)) in cases.into_iter().enumerate() {
                let range = [lo, lo + length];
                let Some(found) = clear_roots(curve, range, &surface, 1e-9) else {
                    continue;
                };
                let breaks = curve.breaks(range[0], range[1]);
                let known = isolate_closely(&Height::new(curve, &surface), &breaks, 1e-11);
                let Ok(Roots::At { roots, misses }) = known else {
                    return Err(TestCaseError::fail("no isolated roots"));
                };
                prop_assert!(misses.is_empty(), "case {i}");
                prop_assert_eq!(found.roots.len(), roots.len(), "case {}", i);
                for (x, y) in found.roots.iter().zip(&roots) {
                    prop_assert!((x.t - y.t).abs() <= 1e-9, "case {i}: {x:?} {y:?}");
                    prop_assert_eq!(x.contact, y.contact);
                }
            }
        }
    }

    /// A wave whose roots are two known angles: cos t = 1/2.
    #[test]
    fn a_circle_crosses_a_plane_at_sixty_degrees() {
        let circle = Curve::Circle(Circle {
            frame: Frame::world(),
            radius: 2.0,
        });
        let x = Vector3::x();
        let plane = Surface::Plane(Plane {
            frame: Frame::about(Point3::new(1.0, 0.0, 0.0), x),
        });
        let found = clear_roots(&circle, [-1.5, 1.5], &plane, 1e-9).map(|found| found.roots);
        let at: Vec<f64> = found.into_iter().flatten().map(|root| root.t).collect();
        assert_eq!(at.len(), 2);
        assert!((at[0] + TAU / 6.0).abs() < 1e-15 && (at[1] - TAU / 6.0).abs() < 1e-15);
    }

    /// Tangent curves and ends on the surface are left to root isolation.
    #[test]
    fn contacts_have_no_closed_form() {
        let frame = Frame::world();
        let circle = Curve::Circle(Circle { frame, radius: 2.0 });
        let at = |x: f64| {
            Surface::Plane(Plane {
                frame: Frame::about(Point3::new(x, 0.0, 0.0), Vector3::x()),
            })
        };
        for x in [2.0, 2.0 + 1e-10, -2.0] {
            assert!(clear_roots(&circle, [0.1, 4.0], &at(x), 1e-9).is_none());
        }
        assert!(clear_roots(&circle, [TAU / 4.0, 4.0], &at(0.0), 1e-9).is_none());
    }
}
